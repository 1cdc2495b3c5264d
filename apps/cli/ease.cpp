// ease: easing functions, and key frames.
#include "command.hpp"

#include <freiform/animate/easing.hpp>
#include <freiform/animate/keys.hpp>
#include <freiform/io/file.hpp>

namespace freiform::cli {

namespace {

struct EaseArguments {
    std::string name = "ease", keys;
    std::vector<double> handles, at;
    std::optional<double> rate;
};

// Key frames as JSON: {"keys": [{"time": 0, "value": [1, 2], "next": "bezier", ..}, ..], "outside": "repeat",
// "tangents": {"tension": 0, "continuity": 0, "bias": 0}}.
class KeyReader {
public:
    explicit KeyReader(const json::Tree& tree) : tree_(tree) {}

    struct Keys {
        std::vector<Key<4>> keys;
        int dim = 0;
        BeyondKeys outside = BeyondKeys::hold;
    };
    Result<Keys> read() {
        Keys out;
        std::optional<TensionContinuityBias> tangents;
        if (!tree_.root().is(json::Kind::object))
            return bad(tree_.root(), "an object with \"keys\" is expected");
        for (const json::Member& m : tree_.root().members()) {
            Result<void> ok;
            if (m.key == "keys")
                ok = keys(m.value, out);
            else if (m.key == "outside")
                ok = word(m.value, {"hold", "repeat", "mirror"}, out.outside);
            else if (m.key == "tangents")
                ok = scheme(m.value, tangents.emplace());
            else
                ok = bad(m.value, text("\"", m.key, "\" is not one of keys, outside, tangents"));
            if (!ok) return std::unexpected(ok.error());
        }
        if (out.keys.empty()) return bad(tree_.root(), "\"keys\" are expected, at least one");
        if (tangents) {
            for (std::size_t i = 1; i < out.keys.size(); ++i)
                if (!(out.keys[i].time > out.keys[i - 1].time))
                    return refuse(RefusalKind::invalid, text("keys[", i, "].time"),
                                  "times increase from key to key");
            set_tangents<4>(out.keys, {&*tangents, 1});
        }
        return out;
    }

private:
    std::unexpected<Refusal> bad(const json::Value& v, std::string why) const {
        return refuse(RefusalKind::unreadable, json::position(tree_.text(), v.offset()), std::move(why));
    }
    Result<void> number(const json::Value& v, double& out) const {
        if (!v.is(json::Kind::number)) return bad(v, text("a number is expected, not ", name_of(v.kind())));
        out = v.number();
        return {};
    }
    template <class Enum>
    Result<void> word(const json::Value& v, std::initializer_list<std::string_view> words, Enum& out) const {
        std::string all;
        int i = 0;
        for (const std::string_view w : words) {
            if (v.is(json::Kind::string) && v.string() == w) return out = Enum(i), Result<void>();
            all += text(i++ > 0 ? ", " : "", w);
        }
        return bad(v, text("one of ", all, " is expected"));
    }
    // A number, or an array of as many as those before.
    Result<void> vector(const json::Value& v, Vec<4>& out, int& dim) const {
        int n = 0;
        if (v.is(json::Kind::number)) {
            n = 1, out[0] = v.number();
        } else if (v.is(json::Kind::array)) {
            for (const json::Value& x : v.elements()) {
                if (n == 4) return bad(v, "values have at most four numbers");
                if (auto ok = number(x, out[n++]); !ok) return ok;
            }
        }
        if (n == 0 || (dim != 0 && n != dim))
            return bad(v, dim == 0 ? std::string("a number or an array of at most four is expected")
                                   : text(dim, " numbers are expected, as before"));
        dim = n;
        return {};
    }
    Result<void> handle(const json::Value& v, Key<4>::Handle& out, int& dim) const {
        if (!v.is(json::Kind::object)) return bad(v, "an object with time and value is expected");
        for (const json::Member& m : v.members()) {
            const auto ok = m.key == "time" ? number(m.value, out.time)
                            : m.key == "value"
                                ? vector(m.value, out.value, dim)
                                : Result<void>(bad(m.value, "only time and value are expected"));
            if (!ok) return ok;
        }
        return {};
    }
    Result<void> scheme(const json::Value& v, TensionContinuityBias& out) const {
        if (!v.is(json::Kind::object))
            return bad(v, "an object with tension, continuity and bias is expected");
        for (const json::Member& m : v.members()) {
            double* const to = m.key == "tension"      ? &out.tension
                               : m.key == "continuity" ? &out.continuity
                               : m.key == "bias"       ? &out.bias
                                                       : nullptr;
            if (!to) return bad(m.value, text("\"", m.key, "\" is not one of tension, continuity, bias"));
            if (auto ok = number(m.value, *to); !ok) return ok;
        }
        return {};
    }
    Result<void> keys(const json::Value& v, Keys& out) const {
        if (!v.is(json::Kind::array)) return bad(v, "an array is expected");
        for (const json::Value& k : v.elements()) {
            if (!k.is(json::Kind::object)) return bad(k, "an object is expected");
            Key<4> key;
            for (const json::Member& m : k.members()) {
                Result<void> ok;
                if (m.key == "time") {
                    ok = number(m.value, key.time);
                } else if (m.key == "value") {
                    ok = vector(m.value, key.value, out.dim);
                } else if (m.key == "arriving" || m.key == "leaving") {
                    ok = vector(m.value, m.key == "leaving" ? key.leaving : key.arriving, out.dim);
                } else if (m.key == "before" || m.key == "after") {
                    ok = handle(m.value, m.key == "after" ? key.after : key.before, out.dim);
                } else if (m.key == "next") {
                    ok = word(m.value, {"step", "linear", "hermite", "bezier", "eased"}, key.next);
                } else if (m.key == "easing") {
                    Vec<4> four;
                    int dim = 4;
                    ok = vector(m.value, four, dim);
                    key.easing = four.c;
                } else {
                    ok = bad(m.value, text("\"", m.key, "\" is not known"));
                }
                if (!ok) return ok;
            }
            out.keys.push_back(key);
        }
        return {};
    }

    const json::Tree& tree_;
};

Result<void> run_keys(const Context& context, const EaseArguments& o) {
    const auto bytes = read_file(o.keys, context.read_options().max_bytes);
    if (!bytes) return std::unexpected(bytes.error());
    const auto within = [&](Refusal r) {
        r.where = text(shown(o.keys), r.where.empty() ? "" : ": ", r.where);
        return std::unexpected(std::move(r));
    };
    const auto tree = json::parse(*bytes);
    if (!tree) return within(tree.error());
    auto keys = KeyReader(*tree).read();
    if (!keys) return within(keys.error());
    const auto track = Track<4>::make(std::move(keys->keys), keys->outside);
    if (!track) return within(track.error());
    std::vector<double> times = o.at;
    if (times.empty()) {
        const Interval all = track->times();
        const double rate = o.rate.value_or(30), n = std::ceil(all.length() * rate - 1e-9);
        if (!(n <= 1e6))
            return refuse(RefusalKind::limit, "--rate", text(n, " samples; the limit is 1000000"));
        for (double i = 0; i < n; ++i) times.push_back(all.lo + i / rate);
        times.push_back(all.hi);
    }
    std::vector<Vec<4>> values(times.size());
    std::vector<double> bounds(times.size());
    track->evaluate(times, values, bounds);
    std::string csv = "time";
    for (int d = 0; d < keys->dim; ++d) csv += text(",value", d);
    csv += ",bound\n";
    json::Writer w;
    w.begin_object().key("samples").begin_array();
    for (std::size_t i = 0; i < times.size(); ++i) {
        const std::span<const double> value(values[i].c.data(), std::size_t(keys->dim));
        w.new_line(1).begin_object().field("time", times[i]).key("value").array(value);
        w.field("bound", bounds[i]).end_object();
        append_text(csv, text(times[i]));
        for (const double x : value) append_text(csv, text(",", x));
        append_text(csv, text(",", bounds[i], "\n"));
    }
    w.end_array().end_object();
    return emit(context, context.json ? w.take() + "\n" : csv);
}

Result<void> run_ease(const Context& context, const EaseArguments& o) {
    if (!o.keys.empty()) return run_keys(context, o);
    if (!o.handles.empty() && o.handles.size() != 4) wrong_usage("--bezier needs four numbers: X1,Y1,X2,Y2");
    const std::vector<double>& h = o.handles;
    const auto easing =
        h.empty() ? CubicBezierEasing::named(o.name) : CubicBezierEasing::make(h[0], h[1], h[2], h[3]);
    if (!easing)
        wrong_usage(text(h.empty() ? "--named" : "--bezier", " ", easing.error().where, ": ",
                         easing.error().message));
    std::vector<double> at = o.at;
    if (at.empty())
        for (int i = 0; i <= 10; ++i) at.push_back(i / 10.0);
    json::Writer w;
    w.begin_object().key("handles").array(easing->handles()).key("values").begin_array();
    std::string lines;
    for (const double x : at) {
        const Bounded y = (*easing)(x);
        w.new_line(1)
            .begin_object()
            .field("at", x)
            .field("value", y.value)
            .field("bound", y.bound)
            .end_object();
        append_text(lines, text(x, " ", y.value, "\n"));
    }
    w.end_array().end_object();
    return emit(context, context.json ? w.take() + "\n" : lines);
}

}  // namespace

void add_ease(CommandLine& line) {
    const auto options = std::make_shared<EaseArguments>();
    const Command command = line.add(
        "ease", "Easing functions as of CSS, and key frames",
        "  freiform ease --bezier 0.25,0.1,0.25,1 --at 0.5\n"
        "  freiform ease --named ease-in-out\n"
        "  freiform ease --keys keys.json --rate 60 -o samples.csv\n"
        "Keys: {\"keys\": [{\"time\": 0, \"value\": [0, 1], \"next\": \"eased\"}, ..]}; next is step, "
        "linear,\nhermite (arriving, leaving), bezier (before, after: {time, value}) or eased "
        "(easing); outside is\nhold, repeat or mirror; tangents ({tension, continuity, bias}) "
        "makes those of hermite.");
    command.word("--named", options->name, "linear, ease, ease-in, ease-out or ease-in-out");
    command.numbers("--bezier", options->handles, "The points of the curve").shown_as("X1,Y1,X2,Y2");
    command.word("--keys", options->keys, "A file of key frames");
    command.numbers("--at", options->at, "Shares of the time, of keys: times").shown_as("T,T,..");
    command.positive("--rate", options->rate, "Samples for a second of key frames (default 30)");
    command.answer_file();
    command.action(options, run_ease);
}

}  // namespace freiform::cli

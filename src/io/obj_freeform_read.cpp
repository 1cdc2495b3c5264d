// Statements are read in one pass. The state (cstype, deg) holds until it is changed; an element (curv,
// curv2, surf) begins a body of parm, trim and hole statements, and `end` makes an object of it. Points are
// those read so far.
//
// A B-spline has n + degree + 1 knots, as ours. Bezier pieces have their breaks as parameters: each gets the
// full multiplicity of the degree.
//
// Why holes and trims are not told apart: which side of a loop is inside follows from the odd-even rule.
//
// References: the specification of the object file format in Wavefront's Advanced Visualizer manual, appendix
// B.
#include <freiform/core/scan.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/io/obj_freeform.hpp>

#include <algorithm>
#include <array>
#include <set>

namespace freiform {

namespace {

struct ObjPoint {
    Vec<3> at{};
    double weight = 1;
};

using PlaneCurve = std::variant<Curve<Vec<2>>, Curve<Hom<2>>>;

struct ObjElement {
    enum class Kind { none, curve, trimming, surface } kind = Kind::none;
    bool rational = false, bezier = false;
    std::array<int, 2> degree{};
    std::array<Interval, 2> on{};
    std::vector<long long> points;
    std::array<std::vector<double>, 2> parameters;
    std::vector<std::vector<CurveGeometry<2>>> loops;
};

class ObjFreeformReader {
public:
    Result<Document> read(std::string_view bytes) {
        for (std::size_t at = 0; at < bytes.size();) {
            std::string line = logical_line(bytes, at);
            std::string_view rest = line;
            const std::string_view key = next_word(rest);
            if (key.empty() || key[0] == '#') continue;
            any_ = any_ || std::ranges::find(kWords, key) != std::end(kWords);
            if (auto ok = statement(key, rest); !ok) return std::unexpected(ok.error());
        }
        if (element_.kind != ObjElement::Kind::none) return wrong("the file ends before `end`");
        if (document_.objects.empty() && !any_)
            return refuse(RefusalKind::unreadable, "",
                          "no line begins with a word of the format, such as v, f, curv or surf");
        if (document_.objects.empty())
            return refuse(RefusalKind::no_answer, "", "the file has no curves and surfaces (curv, surf)");
        return std::move(document_);
    }

private:
    using Done = Result<void>;
    // One of them is in every file of the format that is not empty.
    static constexpr std::string_view kWords[] = {"v", "vp", "f",      "l",    "p",
                                                  "o", "g",  "mtllib", "curv", "surf"};

    // Up to the end of a line that no backslash continues, without carriage returns.
    std::string logical_line(std::string_view bytes, std::size_t& at) {
        std::string line;
        line_ = next_line_;
        for (bool more = true; more && at < bytes.size();) {
            const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
            std::string_view part = bytes.substr(at, end - at);
            if (part.ends_with('\r')) part.remove_suffix(1);
            more = part.ends_with('\\');
            if (more) part.remove_suffix(1);
            line += part;
            line += ' ';
            at = end + 1, ++next_line_;
        }
        return line;
    }

    std::unexpected<Refusal> wrong(std::string message, RefusalKind kind = RefusalKind::unreadable) const {
        return refuse(kind, text("line ", line_), std::move(message));
    }

    Done statement(std::string_view key, std::string_view rest) {
        using Kind = ObjElement::Kind;
        if (key == "v") return vertex(rest, points_, 3);
        if (key == "vp") return vertex(rest, parameters_, 2);
        if (key == "o" || key == "g") return name_ = trimmed(rest), Done();
        if (key == "cstype") return type(rest);
        if (key == "deg") return degree(rest);
        if (key == "curv") return begin(Kind::curve, rest);
        if (key == "curv2") return begin(Kind::trimming, rest);
        if (key == "surf") return begin(Kind::surface, rest);
        if (key == "parm") return parameters(rest);
        if (key == "trim" || key == "hole") return loop(rest);
        if (key == "end") return finish();
        static constexpr std::string_view kHarmless[] = {"vn", "vt", "s", "mtllib", "usemtl", "bevel", "lod"};
        if (std::ranges::find(kHarmless, key) == std::end(kHarmless) && named_.size() < 20 &&
            named_.insert(std::string(key)).second)
            document_.left_out.push_back({RefusalKind::unsupported, text("line ", line_),
                                          text("`", key.substr(0, 20), "` is no free-form object")});
        return {};
    }

    Result<double> number(std::string_view word) const {
        const auto x = scan_number<double>(word);
        if (!x) return wrong(text("a number is expected, found \"", word.substr(0, 24), "\""));
        return *x;
    }
    Result<std::vector<double>> numbers(std::string_view rest) const {
        std::vector<double> all;
        for (std::string_view w = next_word(rest); !w.empty(); w = next_word(rest)) {
            const auto x = number(w);
            if (!x) return std::unexpected(x.error());
            all.push_back(*x);
        }
        return all;
    }

    // Coordinates and a weight.
    Done vertex(std::string_view rest, std::vector<ObjPoint>& to, std::size_t coords) {
        const auto x = numbers(rest);
        if (!x) return std::unexpected(x.error());
        const std::size_t least = coords == 2 ? 1 : 3;
        if (x->size() < least)
            return wrong(text("a point has ", coords, " coordinates, here are ", x->size()));
        ObjPoint p;
        for (std::size_t i = 0; i < std::min(coords, x->size()); ++i) p.at[int(i)] = (*x)[i];
        if (x->size() == coords + 1) p.weight = (*x)[coords];  // more are colours
        to.push_back(p);
        return {};
    }

    Done type(std::string_view rest) {
        std::string_view w = next_word(rest);
        state_.rational = w == "rat";
        if (state_.rational) w = next_word(rest);
        if (w != "bspline" && w != "bezier")
            return wrong(text("cstype ", w.substr(0, 24), "; bspline and bezier are read"),
                         RefusalKind::unsupported);
        state_.bezier = w == "bezier";
        return {};
    }

    Done degree(std::string_view rest) {
        const auto x = numbers(rest);
        if (!x) return std::unexpected(x.error());
        for (const double d : *x)
            if (x->size() > 2 || !(d >= 1 && d <= kMaxDegree && d == int(d)))
                return wrong(text("one or two degrees from 1 to ", kMaxDegree, " are expected"));
        if (x->empty()) return wrong("a degree is expected");
        state_.degree = {int(x->front()), int(x->back())};
        return {};
    }

    Done begin(ObjElement::Kind kind, std::string_view rest) {
        if (element_.kind != ObjElement::Kind::none) return wrong("the element before has no `end`");
        if (state_.degree[0] == 0) return wrong("`deg` is missing before it");
        element_ = state_;
        element_.kind = kind, element_.loops.clear();
        const int directions = kind == ObjElement::Kind::surface ? 2
                               : kind == ObjElement::Kind::curve ? 1
                                                                 : 0;
        for (int d = 0; d < directions; ++d) {
            const auto lo = number(next_word(rest)), hi = number(next_word(rest));
            if (!lo || !hi) return std::unexpected(lo ? hi.error() : lo.error());
            if (!(*lo < *hi)) return wrong(text("parameters from ", *lo, " to ", *hi));
            element_.on[std::size_t(d)] = {*lo, *hi};
        }
        const auto& points = kind == ObjElement::Kind::trimming ? parameters_ : points_;
        for (std::string_view w = next_word(rest); !w.empty(); w = next_word(rest)) {
            const auto i = scan_number<long long>(w.substr(0, w.find('/')));
            const long long count = (long long)(points.size());
            if (!i || *i == 0 || *i > count || *i < -count)
                return wrong(text("\"", w.substr(0, 24), "\" is no index of the ", count, " points so far"));
            element_.points.push_back(*i > 0 ? *i - 1 : count + *i);
        }
        return {};
    }

    Done parameters(std::string_view rest) {
        const std::string_view axis = next_word(rest);
        if (element_.kind == ObjElement::Kind::none || (axis != "u" && axis != "v"))
            return wrong("parm u or parm v belongs to a curv, curv2 or surf");
        auto x = numbers(rest);
        if (!x) return std::unexpected(x.error());
        element_.parameters[axis == "v"] = *std::move(x);
        return {};
    }

    Done loop(std::string_view rest) {
        if (element_.kind != ObjElement::Kind::surface) return wrong("trim and hole belong to a surf");
        std::vector<CurveGeometry<2>> curves;
        for (std::string_view w = next_word(rest); !w.empty(); w = next_word(rest)) {
            const auto lo = number(w), hi = number(next_word(rest));
            if (!lo || !hi) return std::unexpected(lo ? hi.error() : lo.error());
            const std::string_view word = next_word(rest);
            const auto i = scan_number<long long>(word);
            const long long count = (long long)(trimmings_.size());
            if (!i || *i == 0 || *i > count || *i < -count)
                return wrong(
                    text("\"", word.substr(0, 24), "\" is none of the ", count, " curves (curv2) so far"));
            const auto cut = visit_one(
                [&](const auto& c) -> Result<CurveGeometry<2>> {
                    return part(c, 0, {*lo, *hi});
                },
                trimmings_[std::size_t(*i > 0 ? *i - 1 : count + *i)]);
            if (!cut) return wrong(cut.error().message);
            curves.push_back(*cut);
        }
        if (curves.empty()) return wrong("a loop has curves");
        element_.loops.push_back(std::move(curves));
        return {};
    }

    // The part that is asked for; all of it to the bit.
    template <class S>
    static Result<S> part(const S& s, int axis, Interval on) {
        return s.basis(axis).domain() == on ? Result<S>(s) : restrict_to(s, axis, on);
    }

    Result<BSplineBasis> basis(int axis, std::size_t count) const {
        const int degree = element_.degree[std::size_t(axis)];
        std::vector<double> knots = element_.parameters[std::size_t(axis)];
        if (element_.bezier) {
            if (knots.size() < 2)
                return refuse(RefusalKind::unreadable, "", "two parameters at least are expected");
            std::vector<double> full{knots.front()};
            for (const double t : knots) full.insert(full.end(), std::size_t(degree), t);
            full.push_back(knots.back());
            knots = std::move(full);
        }
        if (knots.size() != count + std::size_t(degree) + 1)
            return refuse(RefusalKind::unreadable, "",
                          text("parm ", axis == 0 ? "u" : "v", " gives ", knots.size(), " knots, ", count,
                               " points of degree ", degree, " need ", count + std::size_t(degree) + 1));
        return BSplineBasis::make(degree, std::move(knots));
    }

    template <int D>
    Result<std::vector<Hom<D>>> coefficients(const std::vector<ObjPoint>& points) const {
        std::vector<Hom<D>> all;
        for (const long long i : element_.points) {
            const ObjPoint& p = points[std::size_t(i)];
            Vec<D> at;
            for (int k = 0; k < D; ++k) at[k] = p.at[k];
            const double w = element_.rational ? p.weight : 1;
            if (!(w > 0))
                return refuse(RefusalKind::unsupported, "", text("the weight ", w, "; weights are positive"));
            all.push_back(weighted(at, w));
        }
        return all;
    }

    // The patch of the element, rational or not, as `f` of it.
    template <int N, int D, class F>
    Done with_patch(const std::array<std::size_t, std::size_t(N)>& counts, std::vector<Hom<D>> net, F&& f) {
        std::array<BSplineBasis, std::size_t(N)> bases = filled_bases<N>();
        Index<std::size_t(N)> extent{};
        for (int d = 0; d < N; ++d) {
            auto b = basis(d, counts[std::size_t(d)]);
            if (!b) return wrong(b.error().message, b.error().kind);
            bases[std::size_t(d)] = *std::move(b), extent[std::size_t(d)] = int(counts[std::size_t(d)]);
        }
        const auto finish = [&](auto patch) -> Done {
            if (!patch) return wrong(patch.error().message, patch.error().kind);
            return f(*std::move(patch));
        };
        if (element_.rational)
            return finish(Patch<std::size_t(N), Hom<D>>::make(
                bases, Net<std::size_t(N), Hom<D>>(extent, std::move(net))));
        std::vector<Vec<D>> plain;
        for (const Hom<D>& h : net) plain.push_back(project(h));
        return finish(Patch<std::size_t(N), Vec<D>>::make(
            bases, Net<std::size_t(N), Vec<D>>(extent, std::move(plain))));
    }
    template <int N>
    static std::array<BSplineBasis, std::size_t(N)> filled_bases() {
        const auto any = *BSplineBasis::bezier(1);
        if constexpr (N == 1)
            return {any};
        else
            return {any, any};
    }

    Done finish() {
        using Kind = ObjElement::Kind;
        const Kind kind = element_.kind;
        if (kind == Kind::none) return wrong("`end` of nothing");
        const Done done = kind == Kind::surface ? surface() : kind == Kind::curve ? curve() : trimming();
        element_ = {};
        return done;
    }

    Done trimming() {
        auto net = coefficients<2>(parameters_);
        if (!net) return wrong(net.error().message, net.error().kind);
        return with_patch<1, 2>({element_.points.size()}, *std::move(net), [&](auto patch) -> Done {
            trimmings_.push_back(std::move(patch));
            return {};
        });
    }

    Done curve() {
        auto net = coefficients<3>(points_);
        if (!net) return wrong(net.error().message, net.error().kind);
        return with_patch<1, 3>({element_.points.size()}, *std::move(net), [&](auto patch) -> Done {
            auto cut = part(patch, 0, element_.on[0]);
            if (!cut) return wrong(cut.error().message, cut.error().kind);
            document_.objects.push_back({name_, *std::move(cut), {}});
            return {};
        });
    }

    // Ours has the second index fastest.
    Done surface() {
        auto net = coefficients<3>(points_);
        if (!net) return wrong(net.error().message, net.error().kind);
        const std::size_t given = element_.parameters[0].size(), degree = std::size_t(element_.degree[0]);
        const std::size_t columns = element_.bezier      ? (given > 1 ? (given - 1) * degree + 1 : 0)
                                    : given > degree + 1 ? given - degree - 1
                                                         : 0;
        if (columns == 0 || net->size() % columns != 0 || net->empty())
            return wrong(text(net->size(), " points are no grid of ", columns, " along u, as parm u says"));
        const std::size_t rows = net->size() / columns;
        std::vector<Hom<3>> turned(net->size());
        for (std::size_t i = 0; i < columns; ++i)
            for (std::size_t j = 0; j < rows; ++j) turned[i * rows + j] = (*net)[j * columns + i];
        return with_patch<2, 3>({columns, rows}, std::move(turned), [&](auto patch) -> Done {
            auto cut = part(patch, 0, element_.on[0]);
            if (cut) cut = part(*cut, 1, element_.on[1]);
            if (!cut) return wrong(cut.error().message, cut.error().kind);
            if (element_.loops.empty()) {
                document_.objects.push_back({name_, *std::move(cut), {}});
                return {};
            }
            auto made = TrimmedSurface::make(*std::move(cut), std::move(element_.loops));
            if (!made) return wrong(text(made.error().where, ": ", made.error().message), made.error().kind);
            document_.objects.push_back({name_, *std::move(made), {}});
            return {};
        });
    }

    Document document_;
    std::vector<ObjPoint> points_, parameters_;
    std::vector<PlaneCurve> trimmings_;
    ObjElement state_, element_;
    std::string name_;
    std::set<std::string> named_;
    std::size_t line_ = 0, next_line_ = 1;
    bool any_ = false;  // a word of the format
};

}  // namespace

Result<Document> read_obj_freeform(std::string_view text) { return ObjFreeformReader().read(text); }

}  // namespace freiform

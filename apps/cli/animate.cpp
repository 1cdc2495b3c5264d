// animate: a body that moves along a curve, or the animations of a glTF file, sampled or as a picture that
// moves.
#include "input.hpp"

#include <freiform/animate/motion.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/gltf_animation.hpp>
#include <freiform/path/path.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::cli {

namespace {

constexpr double kMostSamples = 1e6;

struct AnimateArguments {
    std::string file, object, facing = "fixed";
    std::vector<double> speeds, up;
    std::optional<double> speed, acceleration, across, jerk, duration, rate, accuracy;
};

std::string output_ending(const Context& context) {
    if (!context.to.empty()) return context.to;
    const std::size_t dot = context.output.rfind('.');
    return dot == std::string::npos ? "csv" : context.output.substr(dot + 1);
}

Result<Motion> motion_of(const AnimateArguments& o, double length, double accuracy) {
    if (o.duration) return Motion::uniform(length, *o.duration);
    if (o.speeds.empty())
        return Motion::limited(length, {o.speed.value_or(kInfinity), o.acceleration.value_or(kInfinity),
                                        o.jerk.value_or(kInfinity)});
    const int n = int(o.speeds.size()), degree = std::min(3, n - 1);
    std::vector<double> knots;
    for (int i = 0; i < n + degree + 1; ++i)
        knots.push_back(length * std::clamp(i - degree, 0, n - degree) / double(std::max(1, n - degree)));
    std::vector<Vec<1>> net;
    for (const double v : o.speeds) net.push_back({{v}});
    auto basis = BSplineBasis::make(degree, knots);
    if (!basis) return std::unexpected(basis.error());
    auto curve = Curve<Vec<1>>::make({*basis}, Net<1, Vec<1>>({n}, net));
    if (!curve) return refuse_within("speeds", curve.error());
    return Motion::with_speed(*curve, accuracy);
}

// Equally far apart, the last one at the end.
std::vector<double> sample_times(double duration, double rate) {
    std::vector<double> times;
    const double n = std::max(1.0, std::ceil(duration * rate - 1e-9));
    for (double i = 0; i < n; ++i) times.push_back(i / rate);
    times.push_back(duration);
    return times;
}

std::string as_csv(const std::vector<double>& times, const std::vector<Trajectory::State>& states) {
    std::string s = "time,distance,speed,acceleration,x,y,z,qx,qy,qz,qw,bound\n";
    for (std::size_t i = 0; i < times.size(); ++i) {
        const auto& a = states[i];
        const auto& [x, y, z, w] = a.facing;
        append_text(s,
                    text(times[i], ",", a.distance, ",", a.speed, ",", a.acceleration, ",", a.point[0], ",",
                         a.point[1], ",", a.point[2], ",", x, ",", y, ",", z, ",", w, ",", a.bound, "\n"));
    }
    return s;
}

Result<std::string> as_glb(const std::vector<double>& times, const std::vector<Trajectory::State>& states,
                           const std::string& name, double length, bool turns) {
    GltfMotion m;
    m.name = name.empty() ? "body" : name, m.size = length / 20, m.times = times;
    for (const auto& a : states) {
        m.places.push_back(a.point), m.velocities.push_back(a.speed * a.tangent), m.line.push_back(a.point);
        if (turns) m.facing.push_back(a.facing);
    }
    return to_animated_glb(m);
}

// The curve as a path, and an arrow on it by SMIL: key points are shares of the length.
template <class P>
Result<std::string> as_svg(const Curve<P>& curve, const std::vector<double>& times,
                           const std::vector<Trajectory::State>& states, double length, bool turns) {
    auto subpath = subpath_of(curve, 1e-5 * length);
    if (!subpath) return std::unexpected(subpath.error());
    const Path path = transformed({{std::move(subpath->subpath)}}, {{{{1, 0}, {0, -1}}}, {}});
    Box<2> box;
    for (const auto& a : states) box.add(Vec<2>{{a.point[0], -a.point[1]}});
    const double size = std::max(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1]), margin = 0.08 * size;
    std::string points, keys;
    for (std::size_t i = 0; i < times.size(); ++i) {
        const char* mark = i == 0 ? "" : ";";
        append_text(keys, text(mark, i + 1 == times.size() ? 1.0 : times[i] / times.back()));
        append_text(points, text(mark, std::min(1.0, states[i].distance / length)));
    }
    const double r = 0.03 * size;
    return text(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"", box.lo[0] - margin, " ", box.lo[1] - margin,
        " ", box.hi[0] - box.lo[0] + 2 * margin, " ", box.hi[1] - box.lo[1] + 2 * margin,
        "\">\n<path id=\"way\" fill=\"none\" stroke=\"#8899aa\" stroke-width=\"", size / 200, "\" d=\"",
        path_data(path), "\"/>\n<path fill=\"#c84018\" d=\"M ", r, " 0 L ", -r, " ", r / 1.6, " L ", -r / 2,
        " 0 L ", -r, " ", -r / 1.6, " Z\">\n<animateMotion dur=\"", times.back(),
        "s\" repeatCount=\"indefinite\" calcMode=\"linear\"", turns ? " rotate=\"auto\"" : "", " keyTimes=\"",
        keys, "\" keyPoints=\"", points, "\"><mpath href=\"#way\"/></animateMotion>\n</path>\n</svg>\n");
}

std::string as_html(const std::string& svg) {
    return text(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>freiform: a motion</title>\n"
        "<style>body { margin: 0; background: #f8f9fa } svg { width: 100vw; height: 100vh "
        "}</style></head>\n<body>\n",
        svg, "</body></html>\n");
}

std::string as_json(const std::vector<double>& times, const std::vector<Trajectory::State>& states,
                    const Measure& length) {
    double fastest = 0, strongest = 0, bound = 0;
    for (const auto& a : states) {
        fastest = std::max(fastest, a.speed), strongest = std::max(strongest, std::abs(a.acceleration));
        bound = std::max(bound, a.bound);
    }
    json::Writer w;
    w.begin_object().field("duration", times.back());
    w.key("length").begin_object().field("value", length.value).field("bound", length.bound).end_object();
    w.field("samples", times.size())
        .field("speed", fastest)
        .field("acceleration", strongest)
        .field("bound", bound);
    w.end_object();
    return w.take() + "\n";
}

template <class P>
Result<void> animate_curve(const Context& context, const AnimateArguments& o, const Curve<P>& curve,
                           const std::string& name) {
    const Measure rough = length(curve, 0);
    if (!(rough.value > 0))
        return refuse(RefusalKind::no_answer, "", "the curve has no length to move along");
    const double accuracy = o.accuracy.value_or(1e-9 * rough.value);
    auto motion = o.across ? Motion::along(curve,
                                           {o.speed.value_or(kInfinity), o.acceleration.value_or(kInfinity),
                                            *o.across, o.jerk.value_or(kInfinity)},
                                           accuracy)
                           : motion_of(o, rough.value, accuracy);
    if (!motion) return std::unexpected(motion.error());
    TrajectoryOptions how{accuracy, Facing::fixed, {{0, 0, 1}}};
    if (o.facing != "fixed") how.facing = o.facing == "upright" ? Facing::upright : Facing::least_turning;
    if (!o.up.empty()) how.up = {{o.up[0], o.up[1], o.up[2]}};
    auto trajectory = Trajectory::make(curve, *motion, how);
    if (!trajectory) return std::unexpected(trajectory.error());
    const double rate = o.rate.value_or(60);
    if (!(motion->duration() * rate <= kMostSamples))
        return refuse(RefusalKind::limit, "--rate",
                      text(motion->duration() * rate, " samples; the limit is ", kMostSamples));
    const std::vector<double> times = sample_times(motion->duration(), rate);
    std::vector<Trajectory::State> states;
    for (const double t : times) {
        const auto s = trajectory->at(t);
        if (!s) return std::unexpected(s.error());
        states.push_back(*s);
    }
    const std::string format = output_ending(context);
    const bool turns = how.facing != Facing::fixed;
    const std::string report = as_json(times, states, rough);
    if (context.json && context.output.empty()) return emit(context, report);
    Result<std::string> bytes = std::string();
    if (format == "csv") bytes = as_csv(times, states);
    if (format == "glb") bytes = as_glb(times, states, name, rough.value, turns);
    if (format == "svg" || format == "html") {
        if constexpr (Space<P>::kDim == 2)
            bytes = as_svg(curve, times, states, rough.value, turns);
        else
            bytes = refuse(RefusalKind::unsupported, "",
                           "SVG shows plane curves; .glb and .csv hold those in space");
        if (bytes && format == "html") bytes = as_html(*bytes);
    }
    if (!bytes) return std::unexpected(bytes.error());
    if (auto ok = emit(context, *bytes); !ok || !context.json) return ok;
    return emit({}, report);
}

Result<void> sample_gltf(const Context& context, const AnimateArguments& o) {
    const auto bytes = read_file(o.file, context.read_options().max_bytes);
    if (!bytes) return std::unexpected(bytes.error());
#if defined(__wasm__)
    const std::filesystem::path folder;  // there is none
#else
    const auto folder = std::filesystem::absolute(o.file).parent_path();
#endif
    const auto all = read_gltf_animations(*bytes, folder);
    if (!all) {
        Refusal r = all.error();
        r.where = text(shown(o.file), r.where.empty() ? "" : ": ", r.where);
        return std::unexpected(std::move(r));
    }
    if (all->empty()) return refuse(RefusalKind::no_answer, shown(o.file), "there is no animation in it");
    const double rate = o.rate.value_or(30);
    std::string csv = "animation,node,path,time,values\n";
    json::Writer w;
    w.begin_object().key("animations").begin_array();
    double samples = 0;
    for (std::size_t i = 0; i < all->size(); ++i) {
        const GltfAnimation& a = (*all)[i];
        w.new_line(1).begin_object().field("name", a.name).key("channels").begin_array();
        for (const GltfChannel& c : a.channels) {
            w.new_line(2).begin_object().field("node", c.node).field("path", name_of(c.path));
            w.field("interpolation", name_of(c.interpolation)).field("keys", c.times.size());
            w.field("from", c.times.front()).field("to", c.times.back()).end_object();
            if (context.json) continue;
            const double span = c.times.back() - c.times.front();
            if (!((samples += span * rate + 1) <= kMostSamples))
                return refuse(RefusalKind::limit, "--rate", text("more than ", kMostSamples, " samples"));
            std::vector<double> value(c.components);
            for (const double t : sample_times(span, rate)) {
                evaluate(c, c.times.front() + t, value);
                append_text(csv, text(a.name.empty() ? text(i) : a.name, ",", c.node, ",", name_of(c.path),
                                      ",", c.times.front() + t));
                for (const double x : value) append_text(csv, text(",", x));
                csv += "\n";
            }
        }
        w.end_array().end_object();
    }
    w.end_array().end_object();
    return emit(context, context.json ? w.take() + "\n" : csv);
}

Result<void> run_animate(const Context& context, const AnimateArguments& o) {
    const bool limited = o.speed || o.acceleration || o.across || o.jerk;
    if (o.file.ends_with(".glb") || o.file.ends_with(".gltf")) {
        if (limited || o.duration || !o.speeds.empty())
            wrong_usage("the animations of glTF files bring their own times");
        return sample_gltf(context, o);
    }
    if (int(limited) + int(o.duration.has_value()) + int(!o.speeds.empty()) != 1)
        wrong_usage(
            "one of --duration, --speeds, or limits (--speed, --acceleration, --across, --jerk) is expected");
    if (!o.up.empty() && o.up.size() != 3) wrong_usage("--up needs three numbers: X,Y,Z");
    if (!o.up.empty()) require_direction("--up", o.up);
    const std::string format = output_ending(context);
    if (format != "csv" && format != "glb" && format != "svg" && format != "html")
        wrong_usage(text("animate writes .csv, .glb, .svg and .html, not \"", format, "\""));
    const auto input = read_input(context, o.file, o.object);
    if (!input) return std::unexpected(input.error());
    if (input->chosen.size() > 1) wrong_usage("one curve is expected; --object chooses it");
    return each_curve(*input, "move along", [&](std::size_t i, const auto& curve) -> Result<void> {
        using P = typename std::remove_cvref_t<decltype(curve)>::Coefficients;
        if constexpr (Space<P>::kDim == 2 || Space<P>::kDim == 3)
            return animate_curve(context, o, curve, input->object(i).name);
        else
            return refuse(RefusalKind::unsupported, "", "a curve in the plane or in space is expected");
    });
}

}  // namespace

void add_animate(CommandLine& line) {
    const auto options = std::make_shared<AnimateArguments>();
    const Command command = line.add(
        "animate", "A body that moves along a curve, or the animations of a glTF file",
        "  freiform animate way.json --speed 2 --acceleration 1 --jerk 4 -o motion.csv\n"
        "  freiform animate way.json --speed 20 --acceleration 3 --across 4 --jerk 5 -o drive.csv\n"
        "  freiform animate way.json --duration 5 --facing least-turning -o motion.glb\n"
        "  freiform animate drawing.svg --object rim --speeds 1,3,1 --facing upright -o motion.html\n"
        "  freiform animate walk.glb --rate 30                  # all channels, sampled\n"
        "Without -o a table (CSV) is printed; with --json what it comes to.");
    command.file(options->file);
    command.positive("--duration", options->duration, "Constant speed, for so many seconds");
    command
        .numbers("--speeds", options->speeds,
                 "Speed by the way: control values of a spline from start to end, all positive")
        .shown_as("V,V,..");
    command.positive("--speed", options->speed, "From rest to rest as fast as limits allow: speed");
    command.positive("--acceleration", options->acceleration, "The same: acceleration along the way");
    command.positive("--across", options->across,
                     "The same: acceleration across the way, so that it is slow where the curve bends");
    command.positive("--jerk", options->jerk, "The same: change of the acceleration");
    command
        .word("--facing", options->facing,
              "How the body is turned: x along the way without turning about it, or z near --up")
        .one_of({"fixed", "least-turning", "upright"});
    command.numbers("--up", options->up, "Upwards (default 0,0,1)").shown_as("X,Y,Z");
    command.positive("--rate", options->rate, "Samples for a second (default 60; of glTF 30)");
    command.positive("--accuracy", options->accuracy,
                     "What places may be off along the way (default 1e-9 of it)");
    command.object(options->object);
    command.output("Where the motion goes (.csv, .glb, .svg, .html)");
    command.limits();
    command.action(options, run_animate);
}

}  // namespace freiform::cli

// R36: key frames, easings and motions along a curve.
#include "gallery/gallery.hpp"

#include <freiform/animate/easing.hpp>
#include <freiform/animate/keys.hpp>
#include <freiform/animate/motion.hpp>

namespace freiform::cli::gallery {

namespace {

Plot easings() {
    Plot plot("easings", "easing: the share of the way by the share of the time");
    static constexpr std::string_view kNames[] = {"linear", "ease", "ease-in", "ease-out", "ease-in-out"};
    std::size_t i = 0;
    for (const std::string_view name : kNames) {
        const auto ease = sure(CubicBezierEasing::named(name));
        plot.graph([ease](double x) { return ease(x).value; }, {0, 1}, {kPalette[i++], 2, name, {}});
    }
    plot.axes(Axes::grid, "time", "way").stretched();
    return plot;
}

// The same keys, and what happens between them.
Plot key_frames() {
    Plot plot("keys", "the same five keys, held, in lines, smooth, tight");
    const double times[] = {0, 1, 2.5, 3, 4}, values[] = {0.2, 1.1, 0.4, 0.9, 0.1};
    std::vector<Key<1>> keys(5);
    Points dots;
    for (std::size_t i = 0; i < 5; ++i) {
        keys[i].time = times[i], keys[i].value = {{values[i]}};
        dots.push_back({{times[i], values[i]}});
    }
    const auto show = [&](const std::vector<Key<1>>& k, const Look& look) {
        const auto track = sure(Track<1>::make(k));
        plot.graph([track](double t) { return track(t)[0]; }, {0, 4}, look, 400);
    };
    for (Key<1>& k : keys) k.next = Between::step;
    show(keys, dashed(kGrey, "step"));
    for (Key<1>& k : keys) k.next = Between::linear;
    show(keys, thin(kSky, "linear"));
    const std::array<TensionContinuityBias, 1> tight = {{{0.7, 0, 0}}};
    set_tangents<1>(keys);
    show(keys, {kBlue, 2.4, "Catmull-Rom", {}});
    set_tangents<1>(keys, tight);
    show(keys, {kOrange, 1.8, "tension 0.7", {}});
    plot.dots(dots, kInk);
    plot.axes(Axes::ticks, "time", "").stretched();
    return plot;
}

// Where the body is at equal times.
Plot along(const Curve<Vec<2>>& way, const Motion& motion, std::string_view name, std::string_view caption,
           const Colour& colour) {
    Plot plot(name, caption);
    plot.curve(way, thin(kGrey));
    const auto t = sure(Trajectory::make(way, motion, {1e-9, Facing::upright}));
    const int n = 24;
    for (int i = 0; i <= n; ++i) {
        const auto s = sure(t.at(t.duration() * i / n));
        const auto corner = [&](double x, double y) {
            const Vec<3> p = s.point + rotated(s.facing, {{x, y, 0}});
            return Vec<2>{{p[0], p[1]}};
        };
        plot.area({corner(0.16, 0), corner(-0.08, 0.08), corner(-0.08, -0.08)}, colour, 0.75);
    }
    return plot;
}

}  // namespace

Figure motions(const Document& d) {
    const Curve<Vec<2>>& way = curve_in(d, "way");
    const double all = length(way, 1e-9).value;
    Plot speeds("speeds", "speed and acceleration within limits of speed, acceleration and jerk");
    const Motion limited = sure(Motion::limited(all, {3, 2, 4}));
    speeds.graph([&](double t) { return limited.at(t).speed; }, {0, limited.duration()},
                 {kBlue, 2.4, "speed", {}}, 400);
    speeds.graph([&](double t) { return limited.at(t).acceleration; }, {0, limited.duration()},
                 {kOrange, 1.8, "acceleration", {}}, 400);
    speeds.axes(Axes::ticks, "time", "").stretched();
    return page(
        "Key frames and motions",
        {easings().panel, key_frames().panel,
         along(way, sure(Motion::uniform(all, 6)), "uniform", "at equal times, at constant speed", kBlue)
             .panel,
         along(way, limited, "limited", "at equal times, from rest to rest within limits", kOrange).panel,
         speeds.panel},
        3, 1400, 860);
}

}  // namespace freiform::cli::gallery

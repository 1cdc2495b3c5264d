// A body that moves along a curve.
//
// Idea: the motion says how far it is, the arc length (query/length.hpp) where that is on the curve, and both
// errors add up along the way. A frame that does not turn about the curve is that of make/frame_sweep.hpp:
// the surface swept by the segment from (0, 0) to (size, 0) is c(v) + u size r(v), and its bound over size is
// that of r. The size is that of the curve, so that rounding takes as little as it can.
// Sweeps want a direction that does not jump: the curve is cut at knots that would let it, and r goes on
// there as the smallest turn from one tangent to the other takes it. A part keeps what it begins with, so
// bounds of parts add up.
#include <freiform/animate/motion.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/make/frame_sweep.hpp>

#include <algorithm>
#include <cmath>
#include <variant>

namespace freiform {

struct Trajectory::Way {
    // A curve, its arc length, and the surfaces from its parts to the tips of the frame's first vector.
    template <class P>
    struct Of {
        Curve<P> curve;
        ArcLength<P> length;
        std::vector<Surface<P>> frame;
    };
    std::variant<Of<Vec<3>>, Of<Hom<3>>> of;
    TrajectoryOptions options;
    double size = 1, frame_bound = 0;
};

namespace {

// Of the curve between knots where its direction may jump.
template <class P>
Result<std::vector<Curve<P>>> smooth_parts(const Curve<P>& curve) {
    const BSplineBasis& basis = curve.basis();
    std::vector<double> cuts;
    for (const double t : basis.breaks())
        if (t == basis.domain().lo || t == basis.domain().hi || basis.multiplicity(t) >= basis.degree())
            cuts.push_back(t);
    std::vector<Curve<P>> parts;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        auto part = restrict_to(curve, 0, {cuts[i], cuts[i + 1]});
        if (!part) return std::unexpected(part.error());
        parts.push_back(*std::move(part));
    }
    return parts;
}

// The vector that the smallest turn from one unit vector to another makes of r, by two reflections.
Vec<3> turned_along(const Vec<3>& r, const Vec<3>& from, const Vec<3>& to) {
    const auto reflected = [](const Vec<3>& x, const Vec<3>& n) {
        return dot(n, n) > 0 ? x - (2 * dot(n, x) / dot(n, n)) * n : x;
    };
    return reflected(reflected(r, from), from + to);
}

}  // namespace

template <class P>
Result<Trajectory> Trajectory::make(const Curve<P>& curve, const Motion& motion,
                                    const TrajectoryOptions& options) {
    if (!(options.accuracy > 0 && std::isfinite(options.accuracy)))
        return refuse(RefusalKind::invalid, "accuracy", "a positive number is expected");
    if (!is_finite(options.up) || (options.facing == Facing::upright && options.up == Vec<3>{}))
        return refuse(RefusalKind::invalid, "up", "a direction is expected");
    if (options.facing == Facing::least_turning &&
        !(options.facing_accuracy > 0 && std::isfinite(options.facing_accuracy)))
        return refuse(RefusalKind::invalid, "facing_accuracy", "a positive number is expected");
    using Q = InSpace<P>;
    Way::Of<Q> of{in_space(curve), ArcLength<Q>(in_space(curve), options.accuracy / 2), {}};
    const Measure length = of.length.total();
    if (!(std::abs(length.value - motion.length()) <= 1e-3 * length.value))
        return refuse(RefusalKind::invalid, "motion",
                      text("it is ", motion.length(), " long, the curve ", length.value));
    const double size = length.value;
    double bound = 0;
    if (options.facing == Facing::least_turning) {
        const auto segment =
            Curve<Vec<2>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<2>>({2}, {{{0, 0}}, {{size, 0}}}));
        Vec<3> start = options.up, along{};
        const auto parts = smooth_parts(of.curve);
        if (!parts) return refuse_within("curve", parts.error());
        for (const Curve<Q>& part : *parts) {
            const Interval on = part.domain()[0];
            const Vec<3> begins = unit(part.template jet<1>(Param<1>{on.lo}).d[1]);
            if (!of.frame.empty()) start = turned_along(start, along, begins);
            auto swept = sweep(*segment, part, {options.facing_accuracy * size, start});
            if (!swept) return refuse_within("curve", swept.error());
            bound += swept->bound / size * (1 + 0x1p-50) + 0x1p-48;
            start = unit(swept->surface(1.0, on.hi) - swept->surface(0.0, on.hi));
            along = unit(part.template jet<1>(Param<1>{on.hi}).d[1]);
            of.frame.push_back(std::move(swept->surface));
        }
    }
    return Trajectory(motion, std::make_shared<const Way>(Way{std::move(of), options, size, bound}));
}

Measure Trajectory::length() const {
    return visit_one([](const auto& of) { return of.length.total(); }, way_->of);
}

Result<Trajectory::State> Trajectory::at(double time) const {
    if (std::isnan(time)) return refuse(RefusalKind::nonfinite, "time", "a number is expected");
    const Motion::State m = motion_.at(time);
    return visit_one(
        [&](const auto& of) -> Result<State> {
            const auto place = of.length.parameter(std::min(m.distance, of.length.total().value));
            if (!place) return std::unexpected(place.error());
            State out;
            out.parameter = place->parameter;
            const auto jet = of.curve.template jet<1>(Param<1>{place->parameter});
            out.point = jet.d[0];
            out.bound =
                (place->bound + m.bound + of.curve.value_error_bound() * std::sqrt(3.0)) * (1 + 0x1p-48);
            out.distance = m.distance, out.speed = m.speed, out.acceleration = m.acceleration;
            out.tangent = unit(jet.d[1]);
            const TrajectoryOptions& o = way_->options;
            if (o.facing == Facing::fixed) return out;
            Vec<3> side, z;
            if (o.facing == Facing::upright) {
                side = cross(unit(o.up), out.tangent);
                if (!(norm(side) > 1e-9))
                    return refuse(RefusalKind::ill_conditioned, text("at ", time),
                                  "the curve has no direction there, or goes along `up`");
                side = unit(side);
                z = cross(out.tangent, side);
            } else {
                const auto after =
                    std::ranges::upper_bound(of.frame.begin() + 1, of.frame.end(), place->parameter, {},
                                             [](const auto& f) { return f.domain()[1].lo; });
                const auto& frame = *(after - 1);
                const Vec<3> tip = frame(1.0, place->parameter) - frame(0.0, place->parameter);
                z = unit(tip - dot(tip, out.tangent) * out.tangent);
                side = cross(z, out.tangent);
                out.facing_bound = way_->frame_bound;
            }
            out.facing = from_axes(out.tangent, side, z);
            return out;
        },
        way_->of);
}

#define FF_TRAJECTORY(P) \
    template Result<Trajectory> Trajectory::make(const Curve<P>&, const Motion&, const TrajectoryOptions&);
FF_TRAJECTORY(Vec<2>)
FF_TRAJECTORY(Hom<2>)
FF_TRAJECTORY(Vec<3>)
FF_TRAJECTORY(Hom<3>)
#undef FF_TRAJECTORY

}  // namespace freiform

// A body that moves along a curve.
//
// Idea: the motion says how far it is, the arc length (query/length.hpp) where that is on the curve, and both
// errors add up along the way. A frame that does not turn about the curve is that of make/frame_sweep.hpp:
// the surface swept by the segment from (0, 0) to (size, 0) is c(v) + u size r(v), and its bound over size is
// that of r. The size is that of the curve, so that rounding takes as little as it can.
#include <freiform/animate/motion.hpp>
#include <freiform/make/frame_sweep.hpp>

#include <cmath>
#include <variant>

namespace freiform {

struct Trajectory::Way {
    // A curve, its arc length, and the surface from the curve to the tips of the frame's first vector.
    template <class P>
    struct Of {
        Curve<P> curve;
        ArcLength<P> length;
        std::optional<Surface<P>> frame;
    };
    std::variant<Of<Vec<3>>, Of<Hom<3>>> of;
    TrajectoryOptions options;
    double size = 1, frame_bound = 0;
};

template <class P>
Result<Trajectory> Trajectory::make(const Curve<P>& curve, const Motion& motion,
                                    const TrajectoryOptions& options) {
    if (!(options.accuracy > 0 && std::isfinite(options.accuracy)))
        return refuse(RefusalKind::invalid, "accuracy", "a positive number is expected");
    if (!is_finite(options.up) || (options.facing == Facing::upright && options.up == Vec<3>{}))
        return refuse(RefusalKind::invalid, "up", "a direction is expected");
    using Q = InSpace<P>;
    Way::Of<Q> of{in_space(curve), ArcLength<Q>(in_space(curve), options.accuracy / 2), std::nullopt};
    const Measure length = of.length.total();
    if (!(std::abs(length.value - motion.length()) <= 1e-3 * length.value))
        return refuse(RefusalKind::invalid, "motion",
                      text("it is ", motion.length(), " long, the curve ", length.value));
    double size = length.value, bound = 0;
    if (options.facing == Facing::least_turning) {
        const auto segment =
            Curve<Vec<2>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<2>>({2}, {{{0, 0}}, {{size, 0}}}));
        auto swept = sweep(*segment, of.curve, {1e-9 * size, options.up});
        if (!swept) return refuse_within("curve", swept.error());
        bound = swept->bound / size * (1 + 0x1p-50);
        of.frame = std::move(swept->surface);
    }
    return Trajectory(motion, std::make_shared<const Way>(Way{std::move(of), options, size, bound}));
}

Measure Trajectory::length() const {
    return std::visit([](const auto& of) { return of.length.total(); }, way_->of);
}

Result<Trajectory::State> Trajectory::at(double time) const {
    if (std::isnan(time)) return refuse(RefusalKind::nonfinite, "time", "a number is expected");
    const Motion::State m = motion_.at(time);
    return std::visit(
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
                const Vec<3> tip = (*of.frame)(1.0, place->parameter) - (*of.frame)(0.0, place->parameter);
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

// How far along a way something is at a time, and the way itself with its frames.
#pragma once
#include <freiform/animate/rotation.hpp>
#include <freiform/core/bounded.hpp>
#include <freiform/query/length.hpp>

#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace freiform {

// Of the motion along the way, each > 0; infinite ones do not count. Without the last one the acceleration
// may jump, without the last two the speed.
struct MotionLimits {
    double speed = 1, acceleration = std::numeric_limits<double>::infinity(),
           jerk = std::numeric_limits<double>::infinity();
};

// Of the motion along a curve that bends: v^2 times the curvature is the acceleration across it. Each > 0;
// infinite ones do not count.
struct BendLimits {
    double speed = std::numeric_limits<double>::infinity(),
           acceleration = std::numeric_limits<double>::infinity(),  // along the way
        across = std::numeric_limits<double>::infinity(),
           jerk = std::numeric_limits<double>::infinity();  // of the acceleration along the way
};

// The distance s(t) that was covered at time t, 0 <= t <= duration. Const and safe to share.
class Motion {
public:
    struct State {
        double distance = 0, speed = 0, acceleration = 0;
        double bound = 0;  // of the distance; speed and acceleration carry their rounding
    };

    // At constant speed. Refuses lengths and durations that are not positive.
    static Result<Motion> uniform(double length, double duration);
    // The fastest motion from rest to rest within the limits: at most seven phases of constant jerk (three of
    // constant acceleration, where the jerk is not limited). Refuses lengths below 0 and limits that are not
    // positive.
    static Result<Motion> limited(double length, const MotionLimits& limits);
    // With the speed v(s) where s has been covered: t = integral of ds / v. The domain of v is [0, length]; v
    // may jump at its knots. `accuracy` > 0: what the distance may be off. Refuses (invalid) speeds that are
    // not proven positive, (limit) more than 2^16 pieces.
    static Result<Motion> with_speed(const Curve<Vec<1>>& v, double accuracy);

    // From rest to rest along the curve, slow where it bends. The curve is cut into parts on each of which
    // the curvature has a proven bound, the speed is held below what that allows (but for `accuracy` beyond
    // the ends of parts, a distance > 0), and among such motions this is the fastest, if the jerk has no
    // limit; with one it is one that keeps it, and need not be the fastest. Bounds are within some 2 % of the
    // curvature, or parts are 1/256 of a polynomial piece long. At corners the body stops. Without a limit of
    // the acceleration or the jerk the speed jumps. P as for Trajectory. Refuses (invalid) limits and
    // accuracies that are not positive, and limits none of which holds everywhere; (ill_conditioned) curves
    // that stand still; (limit) more than 2^16 parts.
    template <class P>
    static Result<Motion> along(const Curve<P>& curve, const BendLimits& limits, double accuracy);

    double duration() const { return times_.back(); }
    double length() const { return length_; }
    // At rest before 0 and after the duration.
    State at(double time) const;

private:
    // On [times_[i], times_[i + 1]]: s = sum of c[k] (t - times_[i])^k, or the inverse of t(s).
    struct Phase {
        double from = 0;
        std::array<double, 4> c{};
    };
    struct SpeedTable;
    Motion() = default;
    void add(double duration, double speed, double acceleration, double jerk);
    State by_speed(double time) const;
    std::size_t phase(double time) const;
    double time_bound(double left) const;

    struct BendPart;
    void pass(const BendPart& part, double w0, double w1, double acceleration);
    void pass_all(std::span<const BendPart> parts, const std::vector<bool>& stops, double acceleration);
    bool pass_below(std::span<const BendPart> parts, const std::vector<bool>& stops,
                    const BendLimits& limits);

    double length_ = 0, fastest_ = 0;  // the latter where many times are added up
    std::vector<double> times_{0};
    std::vector<Phase> phases_;
    std::shared_ptr<const SpeedTable> speeds_;
};

// How a body is turned that moves along a curve.
enum class Facing {
    fixed,          // not at all
    least_turning,  // x along the way, without turning about it (rotation-minimising frame)
    upright,        // x along the way, z as near to `up` as can be
};
struct TrajectoryOptions {
    double accuracy = 0;  // > 0: what points may be off along the way, in model units
    Facing facing = Facing::fixed;
    Vec<3> up{{0, 0, 1}};           // of `upright`; of `least_turning` where z points to at the start
    double facing_accuracy = 1e-6;  // > 0; of `least_turning`: what its unit vectors may be off
};

// A body that moves along a curve in space. Const and safe to share.
//   const auto m = Motion::limited(arc_length.total().value, {.speed = 2, .acceleration = 1, .jerk = 4});
//   const auto t = Trajectory::make(curve, *m, {.accuracy = 1e-6, .facing = Facing::upright});
//   const auto state = t->at(0.5);
class Trajectory {
public:
    struct State {
        double parameter = 0;
        Vec<3> point{};
        double bound = 0;  // distance along the curve between this point and the exact place
        double distance = 0, speed = 0, acceleration = 0;  // along the way
        Vec<3> tangent{};                                  // of length 1; zero where the curve has none
        Quaternion facing{};
        double facing_bound = 0;  // of least_turning: the frame's distance from the exact one; else 0
    };

    // P: Vec<2>, Hom<2> (at z = 0), Vec<3>, Hom<3>. The distances of the motion are measured on the curve, at
    // whose end it stays should its length be less. Refuses (invalid) motions whose length differs from that
    // of the curve by more than a thousandth, and accuracies that are not positive; with least_turning what
    // make/frame_sweep.hpp refuses of rails, but for corners: there the body turns at once, as little as it
    // can.
    template <class P>
    static Result<Trajectory> make(const Curve<P>& curve, const Motion& motion,
                                   const TrajectoryOptions& options);

    double duration() const { return motion_.duration(); }
    Measure length() const;
    // Refuses (ill_conditioned) upright where the curve has no direction or goes along `up` up to 1e-9
    // radians; (nonfinite) NaN.
    Result<State> at(double time) const;

private:
    struct Way;
    Trajectory(Motion motion, std::shared_ptr<const Way> way)
        : motion_(std::move(motion)), way_(std::move(way)) {}
    Motion motion_;
    std::shared_ptr<const Way> way_;
};

}  // namespace freiform

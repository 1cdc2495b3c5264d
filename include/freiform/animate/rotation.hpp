// Rotations in space as unit quaternions, and curves of them.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/core/vec.hpp>
#include <freiform/spline/patch.hpp>

#include <span>
#include <vector>

namespace freiform {

// x i + y j + z k + w. Unit quaternions q and -q are the same rotation.
struct Quaternion {
    double x = 0, y = 0, z = 0, w = 1;
    friend constexpr bool operator==(const Quaternion&, const Quaternion&) = default;
};

constexpr Quaternion operator*(const Quaternion& a, const Quaternion& b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
constexpr Quaternion operator-(const Quaternion& q) { return {-q.x, -q.y, -q.z, -q.w}; }
constexpr Quaternion conjugate(const Quaternion& q) { return {-q.x, -q.y, -q.z, q.w}; }
constexpr double dot(const Quaternion& a, const Quaternion& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}
// Of length 1 with the same direction; 1 for zero.
Quaternion unit(const Quaternion& q);
// By an angle (radians) about an axis of any length, counter-clockwise seen against it; 1 for a zero axis.
Quaternion turn_about(const Vec<3>& axis, double angle);
// The rotation that takes the coordinate axes to these: orthonormal, right-handed.
Quaternion from_axes(const Vec<3>& x, const Vec<3>& y, const Vec<3>& z);
// The image of a vector, q v q*. REQUIRES a unit quaternion, as all below do.
Vec<3> rotated(const Quaternion& q, const Vec<3>& v);
// Half the rotation vector (axis times half the angle), |log q| <= pi; and back.
Vec<3> log(const Quaternion& q);
Quaternion exp(const Vec<3>& half);
// The smallest angle (radians, 0 .. pi) that takes one rotation to the other.
double angle_between(const Quaternion& a, const Quaternion& b);

// From a to b at constant angular speed, the shorter way round; if both are equally long, one of them.
Quaternion slerp(const Quaternion& a, const Quaternion& b, double t);
// [Shoemake 1987]: slerp(slerp(a, b), slerp(after_a, before_b), 2 t (1 - t)), the ways as given, not the
// shorter ones.
Quaternion squad(const Quaternion& a, const Quaternion& after_a, const Quaternion& before_b,
                 const Quaternion& b, double t);

// A curve of rotations over time. Const and safe to share. Values are unit up to rounding; no bound is
// stated.
class RotationTrack {
public:
    enum class Kind {
        step,
        slerp,   // constant angular speed between keys
        squad,   // through the keys, angular velocity continuous, also where they are not equally far apart
        spline,  // near the keys: the cumulative cubic B-spline of [Kim et al. 1995], acceleration
                 // continuous; first and last key are met. Times of keys are equally far apart
    };
    // Between neighbours the shorter way is taken. Refuses, by "keys[i]" or "times[i]", counts that disagree,
    // times that do not increase (for `spline`: that are not equally far apart within 2^-40), numbers that
    // are not finite, and quaternions shorter than 1e-100.
    static Result<RotationTrack> make(std::vector<double> times, std::vector<Quaternion> keys, Kind kind);

    Interval times() const { return {times_.front(), times_.back()}; }
    // Held before the first key and after the last one; NaN as the first.
    Quaternion operator()(double time) const;
    void evaluate(std::span<const double> times, std::span<Quaternion> out) const;

private:
    RotationTrack() = default;
    std::vector<double> times_;
    std::vector<Quaternion> keys_, after_, before_;  // of squad: controls after a key and before it
    Kind kind_ = Kind::slerp;
};

}  // namespace freiform

// Curves of unit quaternions.
//
// squad over unequal times. On a segment of length h from p to q with the controls a and b, by a share x of
// it:
//     p^-1 dp/dx = L + 2 log(p^-1 a)   at its begin,    q^-1 dq/dx = L - 2 log(q^-1 b)   at its end,
// with L = log(p^-1 q). So that the (half) angular velocity in a key is
//     w = (log(q[i-1]^-1 q[i]) + log(q[i]^-1 q[i+1])) / (t[i+1] - t[i-1])
// from both sides, log(q[i]^-1 a) = (h w - L) / 2 and log(q[i]^-1 b) = (L - h w) / 2, each with its own h and
// L. With equal times both are the -(log(q[i]^-1 q[i+1]) + log(q[i]^-1 q[i-1])) / 4 of [Shoemake 1987].
//
// Cumulative B-splines [Kim et al. 1995]: q(t) = q[i-1] prod_j exp(B~_j(t) log(q[j-1]^-1 q[j])) with the sums
// B~ of the cubic B-splines. The first and last key are repeated by reflection, q[-1] = q[0] (q[0]^-1
// q[1])^-1, which meets them: B-splines reproduce turns at constant speed.
//
// Why not interpolate components and normalise? The speed varies along the way. glTF asks for it where its
// samplers are cubic: io/gltf_animation.cpp.
#include <freiform/animate/rotation.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform {

namespace {
Quaternion from(const Vec<4>& v) { return {v[0], v[1], v[2], v[3]}; }
Vec<4> as_vec(const Quaternion& q) { return {{q.x, q.y, q.z, q.w}}; }
Quaternion difference(const Quaternion& a, const Quaternion& b) { return conjugate(a) * b; }
Quaternion power(const Quaternion& q, double t) { return exp(t * log(q)); }
}  // namespace

Quaternion unit(const Quaternion& q) {
    const Vec<4> v = unit(as_vec(q));
    return v == Vec<4>{} ? Quaternion{} : from(v);
}

Quaternion turn_about(const Vec<3>& axis, double angle) {
    const Vec<3> a = std::sin(angle / 2) * unit(axis);
    return axis == Vec<3>{} ? Quaternion{} : Quaternion{a[0], a[1], a[2], std::cos(angle / 2)};
}

// Of the four components the largest comes first, by a root of at least 1; the others from differences.
Quaternion from_axes(const Vec<3>& x, const Vec<3>& y, const Vec<3>& z) {
    const double m[3][3] = {{x[0], y[0], z[0]}, {x[1], y[1], z[1]}, {x[2], y[2], z[2]}};
    const double trace = m[0][0] + m[1][1] + m[2][2];
    Vec<4> q;
    if (trace > 0) {
        q = {{m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], 1 + trace}};
    } else {
        const int i = m[0][0] >= m[1][1] && m[0][0] >= m[2][2] ? 0
                      : m[1][1] >= m[2][2]                     ? 1
                                                               : 2,
                  j = (i + 1) % 3, k = (i + 2) % 3;
        q[i] = 1 + m[i][i] - m[j][j] - m[k][k];
        q[j] = m[j][i] + m[i][j];
        q[k] = m[k][i] + m[i][k];
        q[3] = m[k][j] - m[j][k];
    }
    return from(unit(q));
}

Vec<3> rotated(const Quaternion& q, const Vec<3>& v) {
    const Vec<3> axis{{q.x, q.y, q.z}}, t = 2.0 * cross(axis, v);
    return v + q.w * t + cross(axis, t);
}

Vec<3> log(const Quaternion& q) {
    const Vec<3> v{{q.x, q.y, q.z}};
    const double sine = norm(v), angle = std::atan2(sine, q.w);
    if (sine == 0) return q.w < 0 ? Vec<3>{{std::numbers::pi, 0, 0}} : Vec<3>{};
    return (angle / sine) * v;
}

Quaternion exp(const Vec<3>& half) {
    const double angle = norm(half), s = angle == 0 ? 1 : std::sin(angle) / angle;
    return {s * half[0], s * half[1], s * half[2], std::cos(angle)};
}

double angle_between(const Quaternion& a, const Quaternion& b) {
    const Quaternion d = difference(a, b);
    return 2 * std::atan2(norm(Vec<3>{{d.x, d.y, d.z}}), std::abs(d.w));
}

Quaternion slerp(const Quaternion& a, const Quaternion& b, double t) {
    if (t == 0) return a;
    const Quaternion near = dot(a, b) < 0 ? -b : b;
    return t == 1 ? near : unit(a * power(difference(a, near), t));
}

Quaternion squad(const Quaternion& a, const Quaternion& after_a, const Quaternion& before_b,
                 const Quaternion& b, double t) {
    if (t == 0 || t == 1) return t == 0 ? a : b;
    const Quaternion on = a * power(difference(a, b), t),
                     off = after_a * power(difference(after_a, before_b), t);
    return unit(on * power(difference(on, off), 2 * t * (1 - t)));
}

Result<RotationTrack> RotationTrack::make(std::vector<double> times, std::vector<Quaternion> keys,
                                          Kind kind) {
    if (times.empty() || times.size() != keys.size())
        return refuse(RefusalKind::invalid, "times",
                      text(times.size(), " times and ", keys.size(),
                           " rotations; at least one of each, and as "
                           "many of both, are expected"));
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (!std::isfinite(times[i]))
            return refuse(RefusalKind::nonfinite, text("times[", i, "]"), "a number is expected");
        if (i > 0 && !(times[i] > times[i - 1]))
            return refuse(RefusalKind::invalid, text("times[", i, "]"),
                          text("it is ", times[i], ", not after ", times[i - 1]));
        const Vec<4> v = as_vec(keys[i]);
        if (!is_finite(v))
            return refuse(RefusalKind::nonfinite, text("keys[", i, "]"), "numbers are expected");
        if (!(max_abs(v) > 1e-100))
            return refuse(RefusalKind::invalid, text("keys[", i, "]"), "a zero quaternion turns nothing");
        keys[i] = unit(keys[i]);
        if (i > 0 && dot(keys[i - 1], keys[i]) < 0) keys[i] = -keys[i];
    }
    const std::size_t n = keys.size();
    if (kind == Kind::spline && n > 1) {
        const double step = (times.back() - times.front()) / double(n - 1);
        for (std::size_t i = 1; i < n; ++i)
            if (!(std::abs(times[i] - (times.front() + step * double(i))) <= 0x1p-40 * step))
                return refuse(
                    RefusalKind::invalid, text("times[", i, "]"),
                    text("keys are ", step, " apart on the mean; of a B-spline all are equally far"));
    }
    RotationTrack out;
    if (kind == Kind::squad) {
        out.after_ = out.before_ = keys;
        for (std::size_t i = 0; i < n && n > 1; ++i) {
            const Vec<3> before = i > 0 ? log(difference(keys[i - 1], keys[i])) : Vec<3>{},
                         after = i + 1 < n ? log(difference(keys[i], keys[i + 1])) : Vec<3>{};
            const double h = i > 0 ? times[i] - times[i - 1] : 0, k = i + 1 < n ? times[i + 1] - times[i] : 0;
            const Vec<3> speed = (1 / (h + k)) * (before + after);
            out.after_[i] = keys[i] * exp(0.5 * (k * speed - after));
            out.before_[i] = keys[i] * exp(0.5 * (before - h * speed));
        }
    }
    out.times_ = std::move(times), out.keys_ = std::move(keys), out.kind_ = kind;
    return out;
}

Quaternion RotationTrack::operator()(double time) const {
    if (!(time > times_.front())) return keys_.front();
    if (time >= times_.back()) return keys_.back();
    const auto i = std::size_t(std::ranges::upper_bound(times_, time) - times_.begin()) - 1;
    const double t = (time - times_[i]) / (times_[i + 1] - times_[i]);
    if (kind_ == Kind::step) return keys_[i];
    if (kind_ == Kind::slerp) return slerp(keys_[i], keys_[i + 1], t);
    if (kind_ == Kind::squad) return squad(keys_[i], after_[i], before_[i + 1], keys_[i + 1], t);
    // Key i - 1 .. i + 2, those beyond the ends by reflection.
    const auto key = [&](std::ptrdiff_t k) {
        if (k < 0) return keys_[0] * difference(keys_[1], keys_[0]);
        const auto n = std::ptrdiff_t(keys_.size());
        if (k >= n)
            return keys_[std::size_t(n - 1)] *
                   difference(keys_[std::size_t(n - 2)], keys_[std::size_t(n - 1)]);
        return keys_[std::size_t(k)];
    };
    const auto at = std::ptrdiff_t(i);
    const double r = 1 - t;
    const double sums[3] = {1 - r * r * r / 6, (1 + 3 * t + 3 * t * t - 2 * t * t * t) / 6, t * t * t / 6};
    Quaternion q = key(at - 1);
    for (int j = 0; j < 3; ++j) q = q * power(difference(key(at - 1 + j), key(at + j)), sums[j]);
    return unit(q);
}

void RotationTrack::evaluate(std::span<const double> times, std::span<Quaternion> out) const {
    FF_REQUIRE(times.size() == out.size());
    for (std::size_t i = 0; i < times.size(); ++i) out[i] = (*this)(times[i]);
}

}  // namespace freiform

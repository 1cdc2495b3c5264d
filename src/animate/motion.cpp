// How far along a way something is.
//
// Within limits. From rest to the speed v takes max(v / a + a / j, 2 sqrt(v / j)) and covers half of that
// times v; braking takes as much. If both together are longer than the way, its middle is reached at the
// speed at which they are as long:
//     v^2 / a + v a / j = length   where the acceleration a is reached (v >= a^2 / j), else v = (length^2 j /
//     4)^(1/3).
// Accuracy: durations and coefficients carry less than 100 roundings relative to the whole of their phases,
// and v * duration <= 2 length + cruising, so distances are off by less than 2^-44 of the length.
//
// By speed. t(s) is the integral of 1 / v. On a piece with a share x of it, v is a polynomial with positive
// coefficients in Bernstein form, and p is the cubic with the values and derivatives of 1 / v at both ends.
// As
//     1 / v - p = (1 - p v) / v,
// the integral of p is off by at most max |1 - p v| / min v, both bounded by coefficients (rounding included,
// by core/bounded.hpp). Where cutting has rounded coefficients of v by at most e, 1 / v is off by e / (min v
// (min v - e)) more. Pieces are halved until all that together, times the largest speed, is within the
// accuracy. The inverse is found by Newton's method within a bracket, and what is left of t is counted too.
//
// Why not integrate s' = v(s) as a differential equation? Its errors grow on the way; those of the integral
// add.
#include <freiform/animate/motion.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

// Pieces of t(s): on [distances[i], distances[i + 1]] t = times[i] + width * (integral of p from 0 to x).
struct Motion::SpeedTable {
    struct Piece {
        double from = 0, width = 0;
        std::array<double, 4> slowness{};  // p, in Bernstein form
        std::vector<double> speed;         // v, likewise
        double rounding = 0;               // of its coefficients, by cutting
    };
    std::vector<Piece> pieces;
    double bound = 0;  // of every time, rounding apart
    double fastest = 0;
};

namespace {

double bernstein_value(std::vector<double> b, double x) {
    keep_left(Fibre<double>{b.data(), int(b.size()), 1}, x);
    return b.back();
}

// The integral of a cubic in Bernstein form from 0 to x.
double integral_of_cubic(const std::array<double, 4>& p, double x) {
    std::array<double, 5> sum{};
    for (std::size_t i = 0; i < 4; ++i) sum[i + 1] = sum[i] + p[i] / 4;
    for (std::size_t r = 1; r < 5; ++r)
        for (std::size_t i = 4; i >= r; --i) sum[i] = (1 - x) * sum[i - 1] + x * sum[i];
    return sum[4];
}

double binomial(int n, int k) {
    double b = 1;
    for (int i = 1; i <= k; ++i) b = b * (n - k + i) / i;
    return b;
}

// A bound of |1 - p v| on the piece.
double defect_of_slowness(const std::array<double, 4>& p, const std::vector<double>& v) {
    const int d = int(v.size()) - 1;
    double most = 0;
    for (int k = 0; k <= d + 3; ++k) {
        Bounded sum;
        for (int i = std::max(0, k - d); i <= std::min(3, k); ++i)
            sum += Bounded(binomial(3, i) * binomial(d, k - i)) * Bounded(p[std::size_t(i)]) *
                   Bounded(v[std::size_t(k - i)]);
        const Bounded rest = Bounded(1) - sum / Bounded(binomial(d + 3, k));
        most = std::max(most, std::abs(rest.value) + rest.bound);
    }
    return most;
}

bool is_positive(double x) { return x > 0 && std::isfinite(x); }

}  // namespace

void Motion::add(double duration, double speed, double acceleration, double jerk) {
    if (!(duration > 0)) return;
    double from = 0;
    if (!phases_.empty()) {
        const auto& [s, c] = phases_.back();
        const double t = times_.back() - times_[times_.size() - 2];
        from = s + t * (c[1] + t * (c[2] + t * c[3]));
    }
    phases_.push_back({from, {0, speed, acceleration / 2, jerk / 6}});
    times_.push_back(times_.back() + duration);
}

Result<Motion> Motion::uniform(double length, double duration) {
    if (!is_positive(length) || !is_positive(duration))
        return refuse(RefusalKind::invalid, is_positive(length) ? "duration" : "length",
                      "a positive number is expected");
    Motion m;
    m.length_ = length;
    m.add(duration, length / duration, 0, 0);
    return m;
}

Result<Motion> Motion::limited(double length, const MotionLimits& limits) {
    if (!(length >= 0 && std::isfinite(length)))
        return refuse(RefusalKind::invalid, "length", text("it is ", length, ", not a number from 0 on"));
    const auto& [top, a, j] = limits;
    const std::pair<const char*, double> all[] = {{"speed", top}, {"acceleration", a}, {"jerk", j}};
    for (const auto& [name, value] : all)
        if (!(value > 0)) return refuse(RefusalKind::invalid, name, "a positive number is expected");
    const double per_jerk = std::isinf(j) ? 0 : 1 / j, per_a = std::isinf(a) ? 0 : 1 / a;
    if (std::isinf(top) && per_jerk == 0 && per_a == 0)
        return refuse(RefusalKind::invalid, "speed", "without any limit there is no fastest motion");
    Motion m;
    m.length_ = length;
    if (length == 0) {
        m.times_.push_back(0), m.phases_.push_back({});
        return m;
    }
    // Of the way from rest to a speed: how long the jerk lasts at either end of it, and all of it.
    const double full = a * per_jerk;  // jerk until the acceleration is reached; NaN where neither is limited
    const auto jerk_time = [&](double v) {
        const double t = std::sqrt(v * per_jerk);
        return std::isinf(a) || t < full ? t : full;
    };
    const auto ramp = [&](double v) {
        const double t = jerk_time(v);
        return std::isinf(a) || t < full ? 2 * t : v * per_a + t;
    };
    double v = top;
    if (std::isinf(v) || v * ramp(v) > length) {
        v = std::isinf(a) ? 0 : 2 * length / (full + std::sqrt(full * full + 4 * length * per_a));
        if (std::isinf(a) || v < a * full) v = std::cbrt(length) * std::cbrt(length / (4 * per_jerk));
    }
    const double tj = jerk_time(v), steady = std::max(0.0, ramp(v) - 2 * tj),
                 most = per_jerk == 0 ? a : tj / per_jerk, jerk = per_jerk == 0 ? 0 : j,
                 cruise = std::max(0.0, (length - v * ramp(v)) / v);
    const double early = most * tj / 2;
    m.add(tj, 0, 0, jerk);
    m.add(steady, early, most, 0);
    m.add(tj, v - early, most, -jerk);
    m.add(cruise, v, 0, 0);
    m.add(tj, v, 0, -jerk);
    m.add(steady, v - early, -most, 0);
    m.add(tj, early, -most, jerk);
    if (!is_positive(m.duration()) || !is_positive(v))
        return refuse(RefusalKind::limit, "length",
                      text("with ", length, " and these limits times leave the range of double"));
    return m;
}

Result<Motion> Motion::with_speed(const Curve<Vec<1>>& v, double accuracy) {
    if (!is_positive(accuracy))
        return refuse(RefusalKind::invalid, "accuracy", "a positive number is expected");
    constexpr std::size_t kMostPieces = 1 << 16;
    const Interval on = v.domain()[0];
    if (on.lo != 0)
        return refuse(RefusalKind::invalid, "speed",
                      text("its domain begins at ", on.lo, ", not at distance 0"));
    const BezierPieces<1, Vec<1>> pieces(v);
    auto table = std::make_shared<SpeedTable>();
    std::vector<SpeedTable::Piece> todo;
    for (int i = pieces.extent()[0] - 1; i >= 0; --i) {
        SpeedTable::Piece p{pieces.box({i})[0].lo, pieces.box({i})[0].length(), {}, {}, 0};
        const auto net = pieces.net({i});
        for (int k = 0; k <= pieces.degree(0); ++k) p.speed.push_back(net({k})[0]);
        for (const double c : p.speed) table->fastest = std::max(table->fastest, c);
        todo.push_back(std::move(p));
    }
    double largest = 0;
    for (const Vec<1>& c : v.net().flat()) largest = std::max(largest, std::abs(c[0]));
    const int degree = v.basis().degree();
    for (auto& p : todo) p.rounding = 1.01 * refinement_error(degree) * largest;
    table->fastest += 1.01 * refinement_error(degree) * largest;
    Motion m;
    m.length_ = on.hi;
    while (!todo.empty()) {
        SpeedTable::Piece p = std::move(todo.back());
        todo.pop_back();
        const double least = *std::ranges::min_element(p.speed);
        const double d = double(p.speed.size() - 1), v0 = p.speed.front(), v1 = p.speed.back();
        double off = kInfinity;
        if (least > 2 * p.rounding) {
            const double third0 = d > 0 ? -d * (p.speed[1] - v0) / (v0 * v0) / 3 : 0,
                         third1 = d > 0 ? -d * (v1 - p.speed[p.speed.size() - 2]) / (v1 * v1) / 3 : 0;
            p.slowness = {1 / v0, 1 / v0 + third0, 1 / v1 - third1, 1 / v1};
            const double defect = defect_of_slowness(p.slowness, p.speed);
            if (defect <= 0.25)  // so that p is about 1 / v, and time never runs backwards
                off = p.width * (defect + p.rounding / (least - p.rounding)) / least * (1 + 0x1p-48);
        }
        if (off * table->fastest <= accuracy / 2 * (p.width / on.hi)) {
            table->bound += off;
            m.times_.push_back(m.times_.back() + p.width * integral_of_cubic(p.slowness, 1));
            table->pieces.push_back(std::move(p));
            continue;
        }
        if (!(std::min(v0, v1) > 0))
            return refuse(RefusalKind::invalid, "speed",
                          text("it is not positive at the distance ", v0 > 0 ? p.from + p.width : p.from));
        if (!(p.width > 0x1p-48 * on.hi))
            return refuse(
                RefusalKind::limit, "speed",
                text("it comes too near to 0 at the distance ", p.from, " for the accuracy ", accuracy));
        if (table->pieces.size() + todo.size() >= kMostPieces)
            return refuse(RefusalKind::limit, "accuracy",
                          text("within ", accuracy, " it takes more than ", kMostPieces, " pieces"));
        p.rounding += split_error(degree) *
                      std::abs(*std::ranges::max_element(p.speed, {}, [](double c) { return std::abs(c); }));
        SpeedTable::Piece right = p;
        const int n = int(p.speed.size());
        keep_left(Fibre<double>{p.speed.data(), n, 1}, 0.5);
        keep_right(Fibre<double>{right.speed.data(), n, 1}, 0.5);
        p.width = right.width = p.width / 2;
        right.from = p.from + p.width;
        todo.push_back(std::move(right)), todo.push_back(std::move(p));
    }
    table->bound *= 1 + 0x1p-30;
    m.speeds_ = std::move(table);
    return m;
}

std::size_t Motion::phase(double time) const {
    const auto after = std::size_t(std::ranges::upper_bound(times_, time) - times_.begin());
    return std::min(after, times_.size() - 1) - 1;
}

Motion::State Motion::by_speed(double time) const {
    const std::size_t i = phase(time);
    const SpeedTable::Piece& p = speeds_->pieces[i];
    const double wanted = (time - times_[i]) / p.width;
    double lo = 0, hi = 1, x = std::clamp(wanted * bernstein_value(p.speed, 0.5), 0.0, 1.0);
    double left = integral_of_cubic(p.slowness, x) - wanted;
    for (int k = 0; k < 60 && left != 0; ++k) {
        (left > 0 ? hi : lo) = x;
        double next = x - left * bernstein_value(p.speed, x);
        if (!(next > lo && next < hi)) next = lo / 2 + hi / 2;
        if (std::abs(next - x) <= 0x1p-53 * x) break;
        x = next;
        left = integral_of_cubic(p.slowness, x) - wanted;
    }
    State out;
    out.distance = p.from + x * p.width;
    out.speed = bernstein_value(p.speed, x);
    const std::size_t n = p.speed.size();
    if (n > 1) {
        std::vector<double> d;
        for (std::size_t k = 0; k + 1 < n; ++k) d.push_back(double(n - 1) * (p.speed[k + 1] - p.speed[k]));
        out.acceleration = bernstein_value(std::move(d), x) / p.width * out.speed;
    }
    out.bound = time_bound(std::abs(left) * p.width) * speeds_->fastest;
    return out;
}

// Of a time that was met up to `left`. Sums of times carry one rounding a piece, integrals a dozen.
double Motion::time_bound(double left) const {
    const double rounding = kUnitRoundoff * (double(times_.size()) + 64) * duration();
    return ((speeds_ ? speeds_->bound : 0) + left + rounding) * (1 + 0x1p-40);
}

Motion::State Motion::at(double time) const {
    if (std::isnan(time)) return {time, time, time, kInfinity};
    const double bound = 0x1p-44 * length_ + (fastest_ > 0 ? time_bound(0) * fastest_ : 0);
    if (time < 0) return {0, 0, 0, 0};
    if (time > duration()) return {length_, 0, 0, speeds_ ? time_bound(0) * speeds_->fastest : bound};
    if (speeds_) return by_speed(time);
    const std::size_t i = phase(time);
    const auto& [from, c] = phases_[i];
    const double t = time - times_[i];
    return {std::clamp(from + t * (c[1] + t * (c[2] + t * c[3])), 0.0, length_),
            c[1] + t * (2 * c[2] + t * 3 * c[3]), 2 * c[2] + 6 * t * c[3], bound};
}

}  // namespace freiform

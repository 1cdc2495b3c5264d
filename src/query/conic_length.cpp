// Arc length of lines and conics.
//
// Idea. What length.cpp does for splines, with the speed known as a formula: q = |c'|^2 is entire, and where
// it differs on an ellipse in the complex plane from its value in the middle by less than that value, the
// speed is analytic there and Gauss quadrature has a proven error. The circle is the case without variation.
//
// Notation. The part is m + h z, z in [-1, 1]; E the ellipse with foci +-1 and half-axes (rho +- 1/rho) / 2,
// so that on it |Re t - m| <= R h, |Im t| <= Y h, and |t - m| <= R h, with R the longer one.
//     ellipse    q = A + B cos 2t - C sin 2t,   A, B = (|y|^2 +- |x|^2) / 2,  C = x . y
//                |q''| <= 4 hypot(B, C) cosh(2 Y h)
//     hyperbola  q = B + A cosh 2t + C sinh 2t, |q''| <= 4 (A + |C|) cosh(2 (|m| + R h))
//     parabola   q = 4 t^2 |x|^2 + 4 t C + |y|^2, q'' = 8 |x|^2
// (|sin| and |cos| of 2t are at most cosh(2 Im t), |sinh| and |cosh| at most cosh(2 Re t).)
//
// Method. |q - q(m)| <= s = R h (|q'(m)| + R h max|q''|). If s < q(m) the root of q differs from that of q(m)
// by at most v = s / sqrt(q(m)) on E, and N nodes leave at most h (64/15) v rho^(-2 N) / (1 - rho^-2)
// (length.cpp). Parts for which 24 nodes do not suffice are halved; where an ellipse is so flat that it turns
// back, q vanishes: parts that are 2^-30 of the whole are bounded by their largest speed alone, which is as
// small there: that in the middle and h K.
//
// Cost. A quarter of an ellipse: 1 or 2 parts of 12 to 24 nodes. A backstop of 4096 parts ends the search in
// ranges of thousands of periods; what is left is bounded by the largest speed.
//
// Accuracy. With M = max|c'| and K = max|c''| over the part, a sample is off by at most (16 M + 4 |t| K) u:
// 16 roundings, the second term for its parameter. q(m) is lessened by 64 u M^2; A, B, C enter with what they
// may be off by, so that a circle is not taken for a perfect one.
//
// References. [Trefethen 2013, theorem 19.3].
//
// Why not the arithmetic-geometric mean: it gives complete and incomplete elliptic integrals faster, with a
// proof of its own for each, for ellipses only, and loses digits in differences of short ranges.
#include "query/gauss_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/query/length.hpp>

#include <cmath>

namespace freiform {

namespace {

constexpr int kMostConicParts = 4096;
constexpr double kTinyPart = 0x1p-30;  // of the range

class ConicSpeed {
public:
    explicit ConicSpeed(const Conic<3>& c)
        : kind_(c.kind),
          x_(c.x),
          y_(c.y),
          xx_(dot(c.x, c.x)),
          yy_(dot(c.y, c.y)),
          xy_(dot(c.x, c.y)),
          off_(8 * kUnitRoundoff * (xx_ + yy_)) {}

    double speed(double t) const {
        switch (kind_) {
            case ConicKind::ellipse:
                return norm(std::cos(t) * y_ - std::sin(t) * x_);
            case ConicKind::hyperbola:
                return norm(std::cosh(t) * y_ + std::sinh(t) * x_);
            case ConicKind::parabola:
                break;
        }
        return norm(2 * t * x_ + y_);
    }
    // Bounds of |c'| and |c''| for parameters up to `far` from 0.
    double fastest(double far) const {
        return kind_ == ConicKind::parabola ? 2 * far * norm(x_) + norm(y_) : reach(far);
    }
    double bend(double far) const { return kind_ == ConicKind::parabola ? 2 * norm(x_) : reach(far); }
    // Bounds of |q'(m)|, and of |q''| for complex parameters whose real and imaginary parts are up to `far`
    // and `up`.
    double slope(double m) const {
        const double grow = kind_ == ConicKind::hyperbola ? std::cosh(2 * m) : 1;
        const double rounding = (8 + 8 * std::abs(m)) * off_ * grow;
        switch (kind_) {
            case ConicKind::ellipse:
                return std::abs((yy_ - xx_) * std::sin(2 * m) + 2 * xy_ * std::cos(2 * m)) + rounding;
            case ConicKind::hyperbola:
                return std::abs((yy_ + xx_) * std::sinh(2 * m) + 2 * xy_ * std::cosh(2 * m)) + rounding;
            case ConicKind::parabola:
                break;
        }
        return std::abs(8 * m * xx_ + 4 * xy_) + rounding;
    }
    double turn(double far, double up) const {
        switch (kind_) {
            case ConicKind::ellipse:
                return 4 * (std::hypot((yy_ - xx_) / 2, xy_) + 2 * off_) * std::cosh(2 * up);
            case ConicKind::hyperbola:
                return 2 * (yy_ + xx_ + 2 * std::abs(xy_) + 4 * off_) * std::cosh(2 * far);
            case ConicKind::parabola:
                break;
        }
        return 8 * xx_ + off_;
    }

private:
    double reach(double far) const {
        return (norm(x_) + norm(y_)) * (kind_ == ConicKind::hyperbola ? std::cosh(far) : 1);
    }
    ConicKind kind_;
    Vec<3> x_, y_;
    double xx_, yy_, xy_, off_;  // off_: bound of what each of the three is off by
};

// An infinite bound where no rule is proven to come as near as is wanted.
Measure conic_part(const ConicSpeed& f, Interval on, double wanted) {
    const double m = on.middle(), h = on.length() / 2, far = std::abs(m) + h;
    const double most = f.fastest(far);
    const double middle = f.speed(m), q = middle * middle - 64 * kUnitRoundoff * most * most;
    const double slope = f.slope(m), sample = (16 * most + 4 * far * f.bend(far)) * kUnitRoundoff;
    for (const detail::GaussRule& rule : detail::kGaussRules)
        for (const double rho : {16.0, 8.0, 5.0, 3.5, 2.6, 2.0}) {
            const double reach = (rho + 1 / rho) / 2 * h, up = (rho - 1 / rho) / 2 * h;
            const double s =
                reach * (slope + reach * f.turn(std::abs(m) + reach, up)) * (1 + 64 * kUnitRoundoff);
            if (!(s < 0.99 * q)) continue;
            const double left =
                64.0 / 15 * h * (s / std::sqrt(q)) * std::pow(rho, -2 * rule.points) / (1 - 1 / (rho * rho));
            if (!(left <= std::max(wanted, h * sample))) continue;
            double sum = 0;
            for (const detail::GaussNode& node : rule.half)
                sum += node.weight * (f.speed(m + h * node.at) + f.speed(m - h * node.at));
            return {h * sum, (left + 2 * h * sample + (rule.points + 4) * kUnitRoundoff * h * sum) *
                                 (1 + 64 * kUnitRoundoff)};
        }
    return {0, kInfinity};
}

Measure conic_length(const Conic<3>& conic, Interval on, double accuracy) {
    const ConicSpeed f(conic);
    const double share = accuracy / on.length();
    Measure sum;
    std::vector<Interval> open{on};
    for (int parts = 0; !open.empty(); ++parts) {
        const Interval part = open.back();
        open.pop_back();
        Measure m = conic_part(f, part, share * part.length());
        const double middle = part.middle();
        if (!std::isfinite(m.bound)) {
            if (part.length() > kTinyPart * on.length() && part.lo < middle && middle < part.hi &&
                parts < kMostConicParts) {
                open.push_back({middle, part.hi});
                open.push_back({part.lo, middle});
                continue;
            }
            const double h = part.length() / 2, far = std::max(std::abs(part.lo), std::abs(part.hi));
            const double most = f.fastest(far), near = f.speed(middle) + h * f.bend(far) +
                                                       (16 * most + 4 * far * f.bend(far)) * kUnitRoundoff;
            m = {h * std::min(most, near), h * std::min(most, near) * (1 + 16 * kUnitRoundoff)};
        }
        sum.value += m.value;
        sum.bound += m.bound + kUnitRoundoff * sum.value;
    }
    return sum;
}

}  // namespace

Result<Measure> length(const CurveGeometry<3>& curve, Interval on, double accuracy) {
    FF_REQUIRE(accuracy >= 0);
    if (!std::isfinite(on.lo) || !std::isfinite(on.hi) || on.lo > on.hi)
        return refuse(RefusalKind::invalid, "on",
                      text("[", on.lo, ", ", on.hi, "] is not a finite interval"));
    if (on.lo == on.hi) return Measure{};
    return visit_one(
        [&](const auto& c) -> Result<Measure> {
            using C = std::remove_cvref_t<decltype(c)>;
            if constexpr (requires { c.net(); }) {
                return length(c, on, accuracy);
            } else if constexpr (std::same_as<C, Line<3>>) {
                const double value = norm(c.direction) * on.length();
                return Measure{value, 8 * kUnitRoundoff * value};
            } else {
                const Measure m = conic_length(c, on, accuracy);
                if (!std::isfinite(m.value) || !std::isfinite(m.bound))
                    return refuse(
                        RefusalKind::limit, "on",
                        text("the curve over [", on.lo, ", ", on.hi, "] is longer than doubles are"));
                return m;
            }
        },
        curve);
}

}  // namespace freiform

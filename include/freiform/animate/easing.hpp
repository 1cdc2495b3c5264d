// Easing: how far something has come, as a function of the share of time that has passed.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/core/result.hpp>

#include <array>
#include <string_view>

namespace freiform {

// The function y(x) that the cubic Bezier curve with the points (0, 0), (x1, y1), (x2, y2), (1, 1) is the
// graph of: `cubic-bezier(x1, y1, x2, y2)` of CSS. BeyondKeys [0, 1] it goes on along its tangents at the
// ends.
//   const auto ease = *CubicBezierEasing::make(0.25, 0.1, 0.25, 1);
//   const Bounded y = ease(0.5);
class CubicBezierEasing {
public:
    // Refuses numbers that are not finite, and x1 and x2 outside [0, 1], where y would not be a function.
    static Result<CubicBezierEasing> make(double x1, double y1, double x2, double y2);
    // linear, ease, ease-in, ease-out, ease-in-out. Refuses others.
    static Result<CubicBezierEasing> named(std::string_view name);

    // With a bound of the error, that of finding the curve's parameter included: large only where the graph
    // is vertical. NaN gives NaN.
    Bounded operator()(double x) const;
    const std::array<double, 4>& handles() const { return handles_; }  // x1, y1, x2, y2

private:
    explicit CubicBezierEasing(std::array<double, 4> handles) : handles_(handles) {}
    std::array<double, 4> handles_;
};

// `steps(count, jump)` of CSS: equal steps, with a jump at the start of the time, at its end, at neither or
// at both. REQUIRES count >= 1, and 2 of `neither`. Exact.
enum class StepJump { start, end, neither, both };
double step_easing(double x, int count, StepJump jump = StepJump::end);

// A cubic in Bernstein form over [0, 1] that does not decrease, and other cubics of the same parameter: time
// and values between two keys.
namespace detail {

// A parameter at which the monotone cubic x is `wanted`, x[0] <= wanted <= x[3], and how far it may be from
// every exact one within [0, 1].
struct CubicPlace {
    double at = 0, off = 0;
};
CubicPlace place_on_monotone_cubic(const std::array<double, 4>& x, double wanted);
// The value there.
Bounded cubic_at(const std::array<double, 4>& y, const CubicPlace& s);
Bounded cubic_at(const std::array<Bounded, 4>& y, const Bounded& s);

}  // namespace detail
}  // namespace freiform

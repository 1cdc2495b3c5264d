// Lines (110) and arcs of circles and ellipses (100, 104 in 124).
#pragma once
#include "iges_file.hpp"

#include <freiform/core/constants.hpp>

namespace freiform::detail {

// Whether an ellipse is a circle, as far as rounding tells, and the parameter of an axis if it is none.
struct EllipseAxes {
    explicit EllipseAxes(const Conic<3>& c) {
        const double skew = dot(c.x, c.y), xx = dot(c.x, c.x), yy = dot(c.y, c.y);
        circle = std::max(std::abs(skew), std::abs(xx - yy)) <= 16 * kUnitRoundoff * (xx + yy);
        if (!circle) turn = std::atan2(2 * skew, xx - yy) / 2;
    }
    bool circle = false;
    double turn = 0;
};

inline bool is_whole(Interval on) { return on.length() >= kTwoPi * (1 - 16 * kUnitRoundoff); }

// Whether the curve is written with the parameters that it has, but for where these begin, so that loops'
// curves in the parameters go with it. All of an ellipse begins at its axis for some who read.
inline bool keeps_parameters(const CurveGeometry<3>& curve, Interval on) {
    const auto* c = std::get_if<Conic<3>>(&curve);
    if (c == nullptr || c->kind != ConicKind::ellipse) return c == nullptr;
    const EllipseAxes of(*c);
    return of.circle || !is_whole(on) ||
           std::abs(std::remainder(on.lo - of.turn, kTwoPi)) <= 16 * kUnitRoundoff;
}

// Its parameter runs from 0 to 1.
inline int add_line(IgesFile& file, const Line<3>& line, Interval on) {
    std::vector<std::string> ends;
    for (const double t : {on.lo, on.hi})
        for (const double x : (line.origin + t * line.direction).c) ends.push_back(real(x));
    return file.entity("110", IgesUse::part, ends);
}

// Of an ellipse, at most once round, by its axes; its parameter is ours plus `shift`. All of one begins
// at the axis.
struct IgesArc {
    int entry = 0;
    double shift = 0;
};
inline IgesArc add_arc(IgesFile& file, const Conic<3>& c, Interval on) {
    const auto [circle, axis] = EllipseAxes(c);
    const double turn = circle ? on.lo : axis;
    const Vec<3> a = std::cos(turn) * c.x + std::sin(turn) * c.y,
                 b = std::cos(turn) * c.y - std::sin(turn) * c.x, n = cross(a, b);
    const Vec<3> x = (1 / norm(a)) * a, z = (1 / norm(n)) * n, y = cross(z, x);
    std::vector<std::string> matrix;
    for (int i = 0; i < 3; ++i)
        for (const double v : {x[i], y[i], z[i], c.centre[i]}) matrix.push_back(real(v));
    const int placed = file.entity("124", IgesUse::part, matrix);
    const double width = norm(a), height = circle ? width : norm(b);
    const double begin = circle ? 0 : on.lo - turn - kTwoPi * std::floor((on.lo - turn) / kTwoPi);
    const auto at = [&](double t) {
        return std::array{real(width * std::cos(t)), real(height * std::sin(t))};
    };
    const auto first = at(is_whole(on) ? 0 : begin), last = is_whole(on) ? first : at(begin + on.length());
    const int entry = circle
                          ? file.entity("100", IgesUse::part,
                                        {"0.", "0.", "0.", first[0], first[1], last[0], last[1]}, 0, placed)
                          : file.entity("104", IgesUse::part,
                                        {real(1 / (width * width)), "0.", real(1 / (height * height)), "0.",
                                         "0.", "-1.", "0.", first[0], first[1], last[0], last[1]},
                                        1, placed);
    return {entry, begin - on.lo};
}

}  // namespace freiform::detail

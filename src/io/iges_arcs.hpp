// Lines (110) and arcs of circles and ellipses (100, 104 in 124).
#pragma once
#include "iges_file.hpp"

#include <freiform/core/constants.hpp>

namespace freiform::detail {

// As far as rounding tells. By its axes.
inline bool is_round(const Conic<3>& c) { return norm(c.x) - norm(c.y) <= 16 * kUnitRoundoff * norm(c.x); }

inline bool is_whole(Interval on) { return on.length() >= kTwoPi * (1 - 16 * kUnitRoundoff); }

// Whether the curve is written with the parameters that it has, but for where these begin, so that loops'
// curves in the parameters go with it. All of an ellipse begins at its axis for some who read.
inline bool keeps_parameters(const CurveGeometry<3>& curve, Interval on) {
    const auto* c = std::get_if<Conic<3>>(&curve);
    if (c == nullptr || c->kind != ConicKind::ellipse) return c == nullptr;
    const auto [conic, shift] = by_axes(*c);
    return is_round(conic) || !is_whole(on) ||
           std::abs(std::remainder(on.lo - shift, kTwoPi)) <= 16 * kUnitRoundoff;
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
    const auto [conic, shift] = by_axes(c);
    const bool circle = is_round(conic);
    const double turn = circle ? on.lo - shift : 0;
    const Vec<3> a = std::cos(turn) * conic.x + std::sin(turn) * conic.y,
                 b = std::cos(turn) * conic.y - std::sin(turn) * conic.x, n = cross(a, b);
    const Vec<3> x = (1 / norm(a)) * a, z = (1 / norm(n)) * n, y = cross(z, x);
    std::vector<std::string> matrix;
    for (int i = 0; i < 3; ++i)
        for (const double v : {x[i], y[i], z[i], c.centre[i]}) matrix.push_back(real(v));
    const int placed = file.entity("124", IgesUse::part, matrix);
    const double width = norm(a), height = circle ? width : norm(b);
    const double begin = circle ? 0 : on.lo - shift - kTwoPi * std::floor((on.lo - shift) / kTwoPi);
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

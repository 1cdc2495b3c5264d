// Idea: the derivative of a spline through points follows the quotients of chords and parameter steps, so
// steps like the chords keep the speed even [Farin 2002, 9.6]. Square roots of chords [Lee 1989] keep loops
// and cusps away at sharp turns. A net has one sequence for all its lines: their mean.
//
// Notation: c_i the chord from point i to the next, q_i = c_i or sqrt(c_i / max c).
//
// Method: On a net, q_i is the sum over the lines of the chords of layer i (chordal) or of their square
// roots after division by the longest chord of the net. Summing lengths before dividing weighs every line by
// its length, which is what the mean of normalised lines of [PT97, 9.2.5] does not: there a short line, near
// a pole, counts as much as a long one. The range is that of the mean line.
//
// Accuracy: sums of positive numbers; parameters follow the points bit for bit under powers of two (uniform
// and centripetal ones do not change at all).
#include <freiform/fit/parameters.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

std::string_view name_of(Spacing spacing) {
    constexpr std::string_view names[] = {"uniform", "chordal", "centripetal"};
    return names[int(spacing)];
}

template <std::size_t N, int D>
Result<std::vector<double>> parameters(const Net<N, Vec<D>>& points, int axis, Spacing spacing, bool closed) {
    const auto view = points.view();
    const int n = view.extent[std::size_t(axis)];
    const auto refuse_at = [](RefusalKind kind, std::size_t i, std::string message) {
        return refuse(kind, text("points[", i, "]"), std::move(message));
    };
    if (n < 2)
        return refuse(RefusalKind::invalid, "points",
                      text(n, n == 1 ? " point" : " points", " along axis ", axis, ", 2 are needed"));
    for (std::size_t i = 0; i < points.flat().size(); ++i)
        if (!is_finite(points.flat()[i]))
            return refuse_at(RefusalKind::nonfinite, i, "has a coordinate that is not finite");
    const int steps = closed ? n : n - 1;
    std::vector<double> chord(std::size_t(steps), 0.0), at(std::size_t(steps) + 1, 0.0);
    if (spacing == Spacing::uniform) {
        for (int i = 0; i <= steps; ++i) at[std::size_t(i)] = i;
        return at;
    }
    double longest = 0, lines = 0;
    const auto each_chord = [&](auto&& f) {
        each_fibre(axis, view.extent, [&](const Index<N>& start) {
            const auto line = view.fibre(axis, start);
            for (int i = 0; i < steps; ++i) f(std::size_t(i), norm(line[(i + 1) % n] - line[i]));
        });
    };
    each_fibre(axis, view.extent, [&](const Index<N>&) { ++lines; });
    if (spacing == Spacing::centripetal)
        each_chord([&](std::size_t, double c) { longest = std::max(longest, c); });
    each_chord([&](std::size_t i, double c) {
        chord[i] += spacing == Spacing::centripetal && longest > 0 ? std::sqrt(c / longest) : c;
    });
    for (int i = 0; i < steps; ++i) {
        const auto next = std::size_t(i) + 1;
        at[next] = at[next - 1] + chord[next - 1] / lines;
        if (std::isfinite(at[next]) && at[next] > at[next - 1]) continue;
        if (!std::isfinite(at[next])) return refuse_at(RefusalKind::limit, next - 1, "the chords overflow");
        if (N > 1)
            return refuse(RefusalKind::invalid, "points",
                          text("layers ", i, " and ", (i + 1) % n, " along axis ", axis, " are equal"));
        return refuse_at(RefusalKind::invalid, next % std::size_t(n),
                         text("is the same as points[", i, "]; ", name_of(spacing),
                              " parameters need distinct neighbours"));
    }
    return at;
}

template <int D>
Result<std::vector<double>> parameters(std::span<const Vec<D>> points, Spacing spacing, bool closed) {
    if (points.size() > 0x20000000) return refuse(RefusalKind::limit, "points", "more than 2^29 points");
    return parameters(Net<1, Vec<D>>({int(points.size())}, {points.begin(), points.end()}), 0, spacing,
                      closed);
}

#define FF_PARAMETERS(D)                                                                        \
    template Result<std::vector<double>> parameters(std::span<const Vec<D>>, Spacing, bool);    \
    template Result<std::vector<double>> parameters(const Net<1, Vec<D>>&, int, Spacing, bool); \
    template Result<std::vector<double>> parameters(const Net<2, Vec<D>>&, int, Spacing, bool); \
    template Result<std::vector<double>> parameters(const Net<3, Vec<D>>&, int, Spacing, bool);
FF_PARAMETERS(1)
FF_PARAMETERS(2)
FF_PARAMETERS(3)
FF_PARAMETERS(4)
#undef FF_PARAMETERS

}  // namespace freiform

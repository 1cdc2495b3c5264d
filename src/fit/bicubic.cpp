// Bicubic patches from points, tangents and twists.
//
// Idea: a bicubic patch is Hermite's cubic along both axes. At a corner with steps h, k along u and v the
// four Bezier points next to it are Q, Q + h/3 S_u, Q + k/3 S_v and Q + h/3 S_u + k/3 S_v + h k/9 S_uv, with
// h < 0 and k < 0 for the patches before it. Two patches share the three numbers that their common edge
// depends on, and the twist at its ends, so derivatives across agree along all of it: C^1.
//
// Notation: f_i values at t_i, h_i = t_{i+1} - t_i, d_i = (f_{i+1} - f_i) / h_i; v_i the slope at t_i.
//
// Method: slopes of parabolas, v_i = (h_i d_{i-1} + h_{i-1} d_i) / (h_{i-1} + h_i); at open ends v_0 = (3 d_0
// - v_1) / 2 where f'' = 0 (the scheme of catmull_rom), v_0 = 2 d_0 - v_1 for the parabola through the first
// three points (Bessel). Applied to S_v along u: the twist of the tensor product, or Bessel's. Adini's is
// that of the bilinearly blended Coons patch over the steps on both sides of the point [Farin 2002, 16.3],
//     (S_v[i+1] - S_v[i-1]) / a + (S_u[j+1] - S_u[j-1]) / b - (Q[i+1,j+1] - Q[i-1,j+1] - Q[i+1,j-1] +
//     Q[i-1,j-1]) / (a b),          a = t_{i+1} - t_{i-1}, b likewise; at open ends over the one step there
//     is.
//
// Accuracy: points are copied; other coefficients carry a few roundings of the largest number that they
// depend on. Cost: linear in the number of points.
//
// Why not always zero twists: the surface gets flat at the points, which shows in reflections [Farin
// 2002, 16.3].
//
// References: [Farin 2002, ch. 16], [Barnhill, Brown & Klucewicz 1978].
#include <freiform/fit/bicubic.hpp>

#include <cmath>

namespace freiform {

namespace {

using Spans = std::array<std::span<const double>, 2>;
using Closed = std::array<bool, 2>;

enum class EndSlope { straight, parabola };

// The parameters along one axis, with the neighbours of every point.
struct Steps {
    std::span<const double> at;
    int count = 0;
    bool closed = false;

    int before(int i) const { return closed ? (i + count - 1) % count : std::max(i - 1, 0); }
    int after(int i) const { return closed ? (i + 1) % count : std::min(i + 1, count - 1); }
    double step(int i) const {  // from point i on
        i = (i + count) % count;
        return at[std::size_t(i) + 1] - at[std::size_t(i)];
    }
    bool has_before(int i) const { return closed || i > 0; }
    bool has_after(int i) const { return closed || i + 1 < count; }
    // From the neighbour before to the one after.
    double across(int i) const { return (has_before(i) ? step(i - 1) : 0) + (has_after(i) ? step(i) : 0); }
};

template <int D>
void slopes(const Steps& s, Fibre<const Vec<D>> f, Fibre<Vec<D>> out, EndSlope ends) {
    const auto d = [&](int i) {
        i = (i + s.count) % s.count;
        return (1 / s.step(i)) * (f[s.after(i)] - f[i]);
    };
    for (int i = 0; i < s.count; ++i) {
        if (!s.has_before(i) || !s.has_after(i)) continue;
        const double a = s.step(i - 1), b = s.step(i);
        out[i] = (b / (a + b)) * d(i - 1) + (a / (a + b)) * d(i);
    }
    if (s.closed) return;
    const int last = s.count - 1;
    const auto end = [&](const Vec<D>& near, const Vec<D>& next) {
        return ends == EndSlope::straight ? 0.5 * (3.0 * near - next) : 2.0 * near - next;
    };
    out[0] = last == 1 ? d(0) : end(d(0), out[1]);
    out[last] = last == 1 ? d(0) : end(d(last - 1), out[last - 1]);
}

template <int D>
Net<2, Vec<D>> slopes(const Steps& s, const Net<2, Vec<D>>& f, int axis, EndSlope ends) {
    Net<2, Vec<D>> out(f.extent());
    each_fibre(axis, f.extent(), [&](const Index<2>& at) {
        slopes<D>(s, f.view().fibre(axis, at), out.view().fibre(axis, at), ends);
    });
    return out;
}

template <int D>
Result<void> check_net(const Net<2, Vec<D>>& net, const Index<2>& extent, std::string_view name) {
    if (net.extent() != extent)
        return refuse(RefusalKind::invalid, std::string(name),
                      text(net.extent()[0], " x ", net.extent()[1], " vectors for ", extent[0], " x ",
                           extent[1], " points"));
    for (std::size_t i = 0; i < net.flat().size(); ++i)
        if (!is_finite(net.flat()[i]))
            return refuse(RefusalKind::nonfinite, text(name, "[", i, "]"),
                          "has a coordinate that is not finite");
    return {};
}

// The bases are those of catmull_rom, which also judges the parameters.
struct Axes {
    std::array<Steps, 2> steps;
    std::vector<BSplineBasis> bases;
};
Result<Axes> axes_of(const Index<2>& extent, const Spans& at, const Closed& closed) {
    Axes a;
    for (std::size_t d = 0; d < 2; ++d) {
        if (at[d].size() != std::size_t(extent[d]) + closed[d])
            return refuse(RefusalKind::invalid, text("axes[", d, "].at"),
                          text(at[d].size(), " parameters, expected ", extent[d] + closed[d]));
        auto change = catmull_rom(at[d], closed[d]);
        if (!change) return refuse_within(text("axes[", d, "]"), change.error());
        a.bases.push_back(std::move(change->basis));
        a.steps[d] = {at[d], extent[d], closed[d]};
    }
    return a;
}

template <int D>
Net<2, Vec<D>> adini(const Net<2, Vec<D>>& points, const GridDerivatives<D>& of,
                     const std::array<Steps, 2>& steps) {
    Net<2, Vec<D>> out(points.extent());
    const auto q = points.view(), su = of.du.view(), sv = of.dv.view();
    each_index(points.extent(), [&](const Index<2>& at) {
        const auto [i, j] = at;
        const int i0 = steps[0].before(i), i1 = steps[0].after(i), j0 = steps[1].before(j),
                  j1 = steps[1].after(j);
        const double a = 1 / steps[0].across(i), b = 1 / steps[1].across(j);
        out.view()(at) = a * (sv({i1, j}) - sv({i0, j})) + b * (su({i, j1}) - su({i, j0})) -
                         a * (b * ((q({i1, j1}) - q({i0, j1})) - (q({i1, j0}) - q({i0, j0}))));
    });
    return out;
}

}  // namespace

std::string_view name_of(Twists twists) {
    constexpr std::string_view kNames[] = {"tensor", "zero", "adini", "bessel"};
    return kNames[int(twists)];
}

template <int D>
Result<GridDerivatives<D>> grid_derivatives(const Net<2, Vec<D>>& points, const Spans& at,
                                            const Closed& closed) {
    if (auto ok = check_net(points, points.extent(), "points"); !ok) return std::unexpected(ok.error());
    const auto axes = axes_of(points.extent(), at, closed);
    if (!axes) return std::unexpected(axes.error());
    return GridDerivatives<D>{slopes(axes->steps[0], points, 0, EndSlope::straight),
                              slopes(axes->steps[1], points, 1, EndSlope::straight)};
}

template <int D>
Result<Net<2, Vec<D>>> twists(const Net<2, Vec<D>>& points, const GridDerivatives<D>& derivatives,
                              const Spans& at, const Closed& closed, Twists kind) {
    for (const auto& [net, name] :
         {std::pair(&points, "points"), {&derivatives.du, "du"}, {&derivatives.dv, "dv"}})
        if (auto ok = check_net(*net, points.extent(), name); !ok) return std::unexpected(ok.error());
    const auto axes = axes_of(points.extent(), at, closed);
    if (!axes) return std::unexpected(axes.error());
    const auto& steps = axes->steps;
    switch (kind) {
        case Twists::tensor:
            return slopes(steps[1], slopes(steps[0], points, 0, EndSlope::straight), 1, EndSlope::straight);
        case Twists::bessel:
            return slopes(steps[1], slopes(steps[0], points, 0, EndSlope::parabola), 1, EndSlope::parabola);
        case Twists::adini:
            return adini(points, derivatives, steps);
        case Twists::zero:
            break;
    }
    return Net<2, Vec<D>>(points.extent());
}

template <int D>
Result<Surface<Vec<D>>> bicubic_through(const Net<2, Vec<D>>& points, const GridDerivatives<D>& derivatives,
                                        const Net<2, Vec<D>>& twists, const Spans& at, const Closed& closed) {
    for (const auto& [net, name] : {std::pair(&points, "points"),
                                    {&derivatives.du, "du"},
                                    {&derivatives.dv, "dv"},
                                    {&twists, "twists"}})
        if (auto ok = check_net(*net, points.extent(), name); !ok) return std::unexpected(ok.error());
    const auto axes = axes_of(points.extent(), at, closed);
    if (!axes) return std::unexpected(axes.error());
    const Index<2> extent{axes->bases[0].size(), axes->bases[1].size()};
    if (count_of(extent) < 0) return refuse(RefusalKind::limit, "points", "more than 2^31 - 1 coefficients");
    Net<2, Vec<D>> net(extent);
    // Coefficient c along an axis belongs to point i, a third of a step before it, at it or after it.
    const auto place = [&](std::size_t axis, int c) {
        const Steps& s = axes->steps[axis];
        const int i = (c + 1) / 3, side = c - 3 * i;
        return std::pair(i % s.count, side == 0 ? 0.0 : side > 0 ? s.step(i) / 3 : -s.step(i - 1) / 3);
    };
    each_index(extent, [&](const Index<2>& c) {
        const auto [i, h] = place(0, c[0]);
        const auto [j, k] = place(1, c[1]);
        const Index<2> p{i, j};
        Vec<D> b = points.view()(p);
        if (h != 0) b += h * derivatives.du.view()(p);
        if (k != 0) b += k * derivatives.dv.view()(p);
        if (h != 0 && k != 0) b += (h * k) * twists.view()(p);
        net.view()(c) = b;
    });
    return Surface<Vec<D>>::make({axes->bases[0], axes->bases[1]}, std::move(net));
}

template <int D>
Result<Surface<Vec<D>>> bicubic_through(const Net<2, Vec<D>>& points, const Spans& at, const Closed& closed,
                                        Twists kind) {
    const auto derivatives = grid_derivatives(points, at, closed);
    if (!derivatives) return std::unexpected(derivatives.error());
    const auto mixed = twists(points, *derivatives, at, closed, kind);
    if (!mixed) return std::unexpected(mixed.error());
    return bicubic_through(points, *derivatives, *mixed, at, closed);
}

#define FF_BICUBIC(D)                                                                                      \
    template Result<GridDerivatives<D>> grid_derivatives(const Net<2, Vec<D>>&, const Spans&,              \
                                                         const Closed&);                                   \
    template Result<Net<2, Vec<D>>> twists(const Net<2, Vec<D>>&, const GridDerivatives<D>&, const Spans&, \
                                           const Closed&, Twists);                                         \
    template Result<Surface<Vec<D>>> bicubic_through(const Net<2, Vec<D>>&, const GridDerivatives<D>&,     \
                                                     const Net<2, Vec<D>>&, const Spans&, const Closed&);  \
    template Result<Surface<Vec<D>>> bicubic_through(const Net<2, Vec<D>>&, const Spans&, const Closed&,   \
                                                     Twists);
FF_BICUBIC(1)
FF_BICUBIC(2)
FF_BICUBIC(3)
FF_BICUBIC(4)
#undef FF_BICUBIC

}  // namespace freiform

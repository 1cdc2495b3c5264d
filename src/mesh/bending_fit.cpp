// What is known of a spline beside a quadratic function: essay in bending.cpp.
#include "bending_detail.hpp"

#include <freiform/core/visit.hpp>

namespace freiform {

namespace {

constexpr int kThinCuts = 4;             // of its box: there hulls have to be sharp
constexpr std::ptrdiff_t kMostEnds = 2;  // of pieces of a spline, inside a box
constexpr double kLeastPart = 0x1p-16;   // of a piece: what is less is all rounding
constexpr double kShortPart = 0x1p-8;    // of a piece: bounds of less are of that (derivative_bounds.cpp)

// M with the derivatives that are seen in the middle, and a plane more so that it meets S at the corners of
// the triangle; where that is hardly more than a side, at the ends and in the middle of that, so that little
// is said of what is beside it. `off`: by at corners; `cuts`: into which bounds are sharp.
struct Meeting {
    double off = 0;
    std::array<int, 2> cuts{1, 1};
};
Meeting meet(const DerivativeQuery<2, 3>& surface, const TriangleOn& triangle, const Box<2>& box,
             const Jet<2, 2, Vec<3>>& j, BoxQuadratic& m) {
    const Vec<2> size = box.hi - box.lo;
    std::array<Vec<2>, 3> at;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec<2> d = triangle.uv[k] - box.lo;
        at[k] = {{d[0] / size[0], d[1] / size[1]}};
    }
    std::size_t a = 0, b = 1, c = 2;
    const auto length = [&](std::size_t p, std::size_t q) { return norm(at[q] - at[p]); };
    if (length(1, 2) > length(a, b)) a = 1, b = 2, c = 0;
    if (length(2, 0) > length(a, b)) a = 2, b = 0, c = 1;
    const Vec<2> along = at[b] - at[a], aside = at[c] - at[a];
    const double area = cross(along, aside), longest = dot(along, along);
    const bool thin = is_thin(at);
    Vec<3> twist = size[0] * size[1] * j(1, 1);
    Meeting out;
    if (thin) {
        out.cuts[std::abs(along[0]) > std::abs(along[1]) ? 0 : 1] = kThinCuts;
        const Vec<2> middle = 0.5 * (triangle.uv[a] + triangle.uv[b]);
        const Vec<3> at_middle = jet<0>(surface.geometry(), middle.c).value();
        const Vec<3> bent = 4.0 * ((triangle.at[a] - at_middle) + (triangle.at[b] - at_middle)) +
                            2 * along[0] * along[0] * m.bulge[0] - 2 * along[0] * along[1] * twist +
                            2 * along[1] * along[1] * m.bulge[1];
        const Vec<3> more = 1 / (longest * longest) * bent;
        m.bulge[0] = m.bulge[0] - along[0] * along[0] / 2 * more;
        m.bulge[1] = m.bulge[1] - along[1] * along[1] / 2 * more;
        twist = twist + along[0] * along[1] * more;
    }
    std::array<Vec<3>, 2> slope{size[0] * j(1, 0) - 0.5 * twist, size[1] * j(0, 1) - 0.5 * twist};
    m.corner = {Vec<3>{}, slope[0], slope[1], slope[0] + slope[1] + twist};
    std::array<Vec<3>, 3> rest;
    for (std::size_t k = 0; k < 3; ++k) rest[k] = triangle.at[k] - m(at[k][0], at[k][1]);
    const Vec<3> d = rest[b] - rest[a], e = rest[c] - rest[a];
    Vec<3> origin = rest[a];
    for (const int k : {0, 1}) {
        const Vec<3> more = thin     ? along[k] / longest * d
                            : k == 0 ? 1 / area * (aside[1] * d - along[1] * e)
                                     : 1 / area * (along[0] * e - aside[0] * d);
        slope[std::size_t(k)] = slope[std::size_t(k)] + more, origin = origin - at[a][k] * more;
    }
    m.corner = {origin, origin + slope[0], origin + slope[1], origin + slope[0] + slope[1] + twist};
    for (std::size_t k = 0; k < 3; ++k)
        if (const double x = norm(m(at[k][0], at[k][1]) - triangle.at[k]); !(x <= out.off)) out.off = x;
    return out;
}

// Of a spline: the length of the polynomial or rational piece there. Not that between bends, which smooth
// splines have none of.
double piece_length(const SurfaceGeometry& surface, int axis, double at) {
    return visit_one(
        [&](const auto& s) {
            if constexpr (requires { s.net(); }) {
                const auto& basis = s.basis(axis);
                const int span = basis.span(at);
                return basis.knot(span + 1) - basis.knot(span);
            } else {
                return 0.0;
            }
        },
        surface);
}

}  // namespace

Box<2> room_for_fit(const DerivativeQuery<2, 3>& surface, const Box<2>& box) {
    Box<2> out = box;
    for (int d = 0; d < 2; ++d) {
        const auto& ends = surface.bends(d);
        if (ends.size() < 2) continue;
        const double least = kShortPart * piece_length(surface.geometry(), d, box.side(d).middle());
        if (!(box.hi[d] - box.lo[d] < least)) continue;
        out.lo[d] = std::min(box.lo[d], std::max(ends.front(), box.side(d).middle() - least / 2));
        out.hi[d] = std::max(box.hi[d], std::min(ends.back(), out.lo[d] + least));
    }
    return out;
}

bool is_fitted(const DerivativeQuery<2, 3>& surface, const Box<2>& box) {
    if (surface.piece_numbers() == 0) return false;
    for (int d = 0; d < 2; ++d) {
        const auto& ends = surface.bends(d);
        const Interval on = box.side(d);
        const auto first = std::upper_bound(ends.begin(), ends.end(), on.lo);
        if (!(on.length() > kLeastPart * surface.thinnest_piece(d)) ||
            std::lower_bound(first, ends.end(), on.hi) - first > kMostEnds)
            return false;
    }
    return true;
}

BoxBending bending_by_fit(const DerivativeQuery<2, 3>& surface, const Box<2>& box, bool knows_normals,
                          const Jet<2, 2, Vec<3>>& j, const TriangleOn* triangle) {
    const std::array<Interval, 2> on{box.side(0), box.side(1)};
    const double du = on[0].length(), dv = on[1].length();
    BoxBending out;
    const auto n = knows_normals ? normal_in(surface, on, j(1, 0), j(0, 1)) : std::nullopt;
    BoxQuadratic of{on, {}, {-(du * du / 2) * j(2, 0), -(dv * dv / 2) * j(0, 2)}};
    Meeting met;
    if (triangle) met = meet(surface, *triangle, box, j, of);
    if (!(met.off < kInfinity)) triangle = nullptr;
    const double off = triangle ? met.off + surface.value_error(on) : 0;
    const QuadraticFit fit = surface.fit(of, triangle == nullptr, n.value_or(Vec<3>{}), met.cuts);
    const auto& [m_box, corner, bulge] = fit.m;
    const std::array second{-2 / (du * du) * bulge[0],
                            1 / (du * dv) * ((corner[0] - corner[1]) + (corner[3] - corner[2])),
                            -2 / (dv * dv) * bulge[1]};
    // What second derivatives of M are off by in rounding.
    double size = max_abs(bulge[0]) + max_abs(bulge[1]);
    for (const Vec<3>& c : corner) size = std::max(size, max_abs(c));
    const double slip = 32 * kUnitRoundoff * size;
    const auto rest_of = [&](const std::array<double, jet_size(2, 2)>& r) {
        return Curvature{(r[3] + slip / (du * du)) * kSumSlack, (r[4] + slip / (du * dv)) * kSumSlack,
                         (r[5] + slip / (dv * dv)) * kSumSlack};
    };
    const Curvature rest = rest_of(fit.all);
    const std::array lengths{norm(second[0]), norm(second[1]), norm(second[2])};
    out.full = Curvature{lengths[0], lengths[1], lengths[2]}.plus(kSumSlack, rest);
    if (!out.full.is_finite()) return out;
    const Vec<2> half = half_sides(on);
    for (int d = 0; d < 2; ++d)
        out.first[d] = (norm(j.d[std::size_t(d) + 1]) + (d == 0 ? out.full.uu : out.full.uv) * half[0] +
                        (d == 0 ? out.full.uv : out.full.vv) * half[1]) *
                       (1 + kBendingRounding);
    if (n) out.n = *n;
    const Curvature rest_along = n ? rest_of(fit.along) : rest;
    const Quadratic seen{dot(out.n, second[0]), dot(out.n, second[1]), dot(out.n, second[2])};
    const auto three = [](const Curvature& c) { return std::array{c.uu, c.uv, c.vv}; };
    out.middle = {
        {{on[0].middle(), on[1].middle()}}, seen, three(rest_along), {}, second, three(rest), {}, lengths};
    out.fit = {box, fit.all[0] + off, fit.along[0] + off, triangle != nullptr};
    if (!n) return out;
    Curvature along =
        Curvature{std::abs(seen.uu), std::abs(seen.uv), std::abs(seen.vv)}.plus(kSumSlack, rest_along);
    along.sure_uu = Curvature::less(seen.uu, rest_along.uu + 8 * kUnitRoundoff * lengths[0]);
    along.sure_vv = Curvature::less(seen.vv, rest_along.vv + 8 * kUnitRoundoff * lengths[2]);
    const auto beside = [&](std::size_t k, double by) {
        const Vec<3>& x = second[k];
        return (norm(x - dot(*n, x) * *n) + 16 * kUnitRoundoff * lengths[k] + by) * kSumSlack;
    };
    add_normals(out, on, j(1, 0), j(0, 1), *n, along,
                {beside(0, rest.uu), beside(1, rest.uv), beside(2, rest.vv)});
    return out;
}

}  // namespace freiform

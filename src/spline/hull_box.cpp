// Idea: a piece of a spline with positive weights is in the convex hull of its control points, so in their
// box; what is swept from a set along a line, about an axis or by a distance is in what is swept from the box
// of the set. Cost: that of the control points of the pieces. Rounding: projecting a control point takes one
// division (half a unit), sweeping a corner at most sixteen sums and products of what is no larger than the
// result's scale: kSlack of it covers both.
#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/spline/hull_box.hpp>

#include <cmath>

namespace freiform {

namespace {

constexpr double kSlack = 32 * kUnitRoundoff;

template <int D>
Box<D> widened(Box<D> box, double by) {
    for (int i = 0; i < D; ++i) box.lo[i] -= by, box.hi[i] += by;
    return box;
}

template <std::size_t N, class P>
Box<Space<P>::kDim> of_points(const Patch<N, P>& s, const std::array<Interval, N>& on) {
    Index<N> from{}, count{};
    for (std::size_t d = 0; d < N; ++d) {
        const BSplineBasis& basis = s.basis(int(d));
        const Interval domain = basis.domain();
        if (basis.is_closed() && !(domain.contains(on[d].lo) && domain.contains(on[d].hi))) {
            count[d] = basis.size();
            continue;
        }
        const int first = basis.span(on[d].lo), last = basis.span(on[d].hi);
        from[d] = first - basis.degree();
        count[d] = last - first + basis.degree() + 1;
    }
    const auto view = s.net().view();
    Box<Space<P>::kDim> box;
    each_index(count, [&](Index<N> i) {
        for (std::size_t d = 0; d < N; ++d) i[d] = (i[d] + from[d]) % s.net().extent()[d];
        box.add(project(view(i)));
    });
    return widened(box, kSlack * box.scale());
}

// For each corner of the box.
template <class F>
void each_corner(const Box<3>& box, F&& f) {
    for (int k = 0; k < 8; ++k)
        f(Vec<3>{
            {k & 1 ? box.hi[0] : box.lo[0], k & 2 ? box.hi[1] : box.lo[1], k & 4 ? box.hi[2] : box.lo[2]}});
}

std::optional<Box<3>> swept(const Extrusion& e, const std::array<Interval, 2>& on) {
    const auto profile = hull_box(e.profile, {on[0]});
    if (!profile) return {};
    Box<3> box;
    for (const double v : {on[1].lo, on[1].hi}) {
        box.add(profile->lo + v * e.direction);
        box.add(profile->hi + v * e.direction);
    }
    return widened(box, kSlack * (box.scale() + profile->scale()));
}

// Heights along the axis and distances from it are greatest at corners of the box.
std::optional<Box<3>> swept(const Revolution& r, const std::array<Interval, 2>& on) {
    const auto profile = hull_box(r.profile, {on[1]});
    if (!profile) return {};
    Box<1> height;
    double radius = 0;
    each_corner(*profile, [&](const Vec<3>& x) {
        const double h = dot(x - r.origin, r.axis);
        height.add(Vec<1>{{h}});
        radius = std::max(radius, norm(x - r.origin - h * r.axis));
    });
    Box<3> box;
    for (const double h : {height.lo[0], height.hi[0]}) box.add(r.origin + h * r.axis);
    for (int i = 0; i < 3; ++i) {
        // A circle about the axis reaches radius * sin of the angle between the axis and x_i.
        const double reach = radius * std::hypot(r.axis[(i + 1) % 3], r.axis[(i + 2) % 3]);
        box.lo[i] -= reach, box.hi[i] += reach;
    }
    return widened(box, kSlack * (box.scale() + profile->scale() + max_abs(r.origin) + radius));
}

}  // namespace

template <int D>
std::optional<Box<D>> hull_box(const CurveGeometry<D>& curve, const std::array<Interval, 1>& on) {
    return visit_one(
        [&](const auto& c) -> std::optional<Box<D>> {
            if constexpr (requires { c.net(); }) {
                return of_points(c, on);
            } else if constexpr (std::same_as<std::remove_cvref_t<decltype(c)>, Line<D>>) {
                Box<D> box;
                box.add(c.origin + on[0].lo * c.direction);
                box.add(c.origin + on[0].hi * c.direction);
                return widened(box, kSlack * (box.scale() + max_abs(c.origin)));
            } else {
                return std::nullopt;
            }
        },
        curve);
}

std::optional<Box<3>> hull_box(const SurfaceGeometry& surface, const std::array<Interval, 2>& on) {
    return visit_one(
        [&](const auto& s) -> std::optional<Box<3>> {
            if constexpr (requires { s.net(); }) {
                return of_points(s, on);
            } else if constexpr (requires { s.base; }) {
                auto box = hull_box(*s.base, on);
                if (box) box = widened(*box, std::abs(s.distance) * (1 + kSlack) + kSlack * box->scale());
                return box;
            } else {
                return swept(s, on);
            }
        },
        surface);
}

template std::optional<Box<1>> hull_box(const CurveGeometry<1>&, const std::array<Interval, 1>&);
template std::optional<Box<2>> hull_box(const CurveGeometry<2>&, const std::array<Interval, 1>&);
template std::optional<Box<3>> hull_box(const CurveGeometry<3>&, const std::array<Interval, 1>&);

}  // namespace freiform

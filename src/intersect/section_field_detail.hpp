// A surface and the function whose zeros are its section by a plane.
//
// f = (n . X + d w) 2^-e at the control points (X, w), computed exactly and rounded once; |f| <= 1. So a
// coefficient that is 0 is 0 exactly, and knot insertion keeps sides of zeros.
#pragma once
#include "level_set_detail.hpp"

#include <freiform/intersect/section.hpp>
#include <freiform/poly/exact.hpp>
#include <freiform/spline/derivative_bounds.hpp>

namespace freiform::detail {

template <class P>
struct SectionField {
    SectionField(const Surface<P>& s, const Plane& plane)
        : surface(s), geometry(s), query(geometry), bezier(s), rounding(s.value_error_bound()) {
        const int e = std::ilogb(max_abs(plane.normal));
        Vec<3> n;
        for (int k = 0; k < 3; ++k) n[k] = std::scalbn(plane.normal[k], -e);
        const double length = norm(n);
        unit_normal = (1 / length) * n;
        unit_offset = std::scalbn(plane.offset, -e) / length;
        make_function(plane, length, e);
        for (std::size_t k = 0; k < 2; ++k) {
            const BSplineBasis& basis = s.basis(int(k));
            options.cyclic[k] = basis.is_closed() || is_joined(int(k));
            const auto& breaks = bezier.breaks(int(k));
            for (int i = 0; i + 1 < int(breaks.size()); ++i) {
                if (i == 0 && !options.cyclic[k]) continue;
                const bool seam = i == 0 && !basis.is_closed();
                const int m = seam ? basis.degree() : basis.multiplicity(breaks[std::size_t(i)]);
                if (m > basis.degree()) options.tears[k].push_back(i);
                // Splines follow a branch badly over a line where second derivatives jump; the parameters
                // themselves jump at a seam.
                if (i == 0 || m >= basis.degree() - 1) stops[k].push_back(i);
            }
        }
        each_index(bezier.extent(), [&](const Index<2>& at) {
            double most = 0;
            const auto net = bezier.net(at);
            each_index(net.extent, [&](const Index<2>& i) {
                most = std::max(most, Space<P>::weight(net(i)));
                least_weight = std::min(least_weight, Space<P>::weight(net(i)));
            });
            weight.push_back(most);
            pieces.push_back(bezier.piece(at));
        });
    }

    int count(int axis) const { return function.count[std::size_t(axis)]; }
    std::size_t piece_at(const Index<2>& i) const { return std::size_t(i[0] * count(1) + i[1]); }
    // The parameter of a place in [0, count].
    double parameter(int axis, double place) const {
        const auto& b = bezier.breaks(axis);
        const int i = std::clamp(int(place), 0, count(axis) - 1);
        const double t = place - i;
        const double lo = b[std::size_t(i)], hi = b[std::size_t(i) + 1];
        return t <= 0 ? lo : t >= 1 ? hi : lo + t * (hi - lo);
    }
    double place(int axis, double u) const {
        const auto& b = bezier.breaks(axis);
        const int i =
            std::clamp(int(std::upper_bound(b.begin(), b.end(), u) - b.begin()) - 1, 0, count(axis) - 1);
        return i + (u - b[std::size_t(i)]) / (b[std::size_t(i) + 1] - b[std::size_t(i)]);
    }
    double span(int axis, int piece) const {
        const auto& b = bezier.breaks(axis);
        return b[std::size_t(piece) + 1] - b[std::size_t(piece)];
    }
    // Signed distance from the plane, and what it may be off by.
    double height(const Vec<3>& p) const { return dot(unit_normal, p) + unit_offset; }
    double height_error(const Vec<3>& p) const {
        return 12 * kUnitRoundoff * (2 * max_abs(p) + std::abs(unit_offset));
    }

    const Surface<P>& surface;
    SurfaceGeometry geometry;
    DerivativeQuery<2, 3> query;
    BezierPieces<2, P> bezier;
    std::vector<Patch<2, P, Bernstein>> pieces;
    std::vector<double> weight;  // of each piece, the largest
    double least_weight = kInfinity;
    ArcPieces<2, Vec<1>> function;
    LevelOptions options;
    std::array<std::vector<int>, 2> stops;  // lines that no cubic piece goes over
    Vec<3> unit_normal{};
    double unit_offset = 0;
    double to_function = 0;  // f / w <= to_function times the distance <= 1.03 f / w
    double rounding = 0;     // of a point of the surface, each coordinate

private:
    void make_function(const Plane& plane, double length, int exponent) {
        std::vector<Exact> sums;
        int top = -100000;
        for (const P& p : surface.net().flat()) {
            Exact sum = Exact(plane.offset) * Exact(Space<P>::weight(p));
            for (int k = 0; k < 3; ++k) sum = sum + Exact(plane.normal[k]) * Exact(p[k]);
            if (sum.sign() != 0) top = std::max(top, sum.exponent());
            sums.push_back(std::move(sum));
        }
        if (top == -100000) top = 0;
        std::vector<Vec<1>> c;
        for (const Exact& x : sums) c.push_back({{x.scaled(-top).rounded()}});
        function = arc_pieces(
            Surface<Vec<1>>::trusted(surface.bases(), Net<2, Vec<1>>(surface.net().extent(), std::move(c))));
        to_function = 1.01 * std::scalbn(length, exponent - top);
    }
    // The first and the last control points along an axis, both of which are ends, are the same.
    bool is_joined(int axis) const {
        const std::size_t k = std::size_t(axis);
        const BSplineBasis& b = surface.basis(axis);
        const Interval on = b.domain();
        const int p = b.degree(), n = b.size();
        if (b.is_closed() || p == 0 || b.knot(1) != on.lo || b.knot(n + p - 1) != on.hi) return false;
        const auto net = surface.net().view();
        bool same = true, point = true;
        each_fibre(axis, net.extent, [&](const Index<2>& at) {
            Index<2> last = at;
            last[k] = n - 1;
            same = same && net(at) == net(last);
            for (int i = 0; i < n && point; ++i) {
                Index<2> inner = at;
                inner[k] = i;
                point = net(inner) == net(at);
            }
        });
        return same && !point;
    }
};

}  // namespace freiform::detail

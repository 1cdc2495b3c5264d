// What the parts of the drawing share: the projection to the plane, and flattening.
#pragma once
#include <freiform/io/drawing.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <cmath>

namespace freiform::drawing {

inline constexpr std::size_t kMostSegments = 4'000'000;

// The plane of the picture. Coordinates are first divided by 2^exponent, so that nothing overflows.
struct Plane {
    Vec<3> right{{1, 0, 0}}, up{{0, 1, 0}};
    int exponent = 0;

    Vec<3> scaled(Vec<3> p) const {
        for (int i = 0; i < 3; ++i) p[i] = std::scalbn(p[i], -exponent);
        return p;
    }
    Vec<2> operator()(const Vec<3>& p) const {
        const Vec<3> q = scaled(p);
        return {{dot(right, q), dot(up, q)}};
    }
    // A linear map commutes with weights.
    Hom<2> operator()(const Hom<3>& p) const {
        const Vec<2> q = (*this)(Vec<3>{{p[0], p[1], p[2]}});
        return Hom<2>{{q[0], q[1], p.weight()}};
    }
};

Plane plane_of(const std::optional<View>& view, bool all_plane, double size);

// Bisects `on` until chord_error(a, b) <= tolerance on each part and appends value(b) of each; value(on.lo)
// is there already. False if that needs more than `most` parts or intervals that doubles cannot tell apart.
template <class Value, class ChordError>
bool flatten(const Interval& on, double tolerance, std::size_t most, const Value& value,
             const ChordError& chord_error, DrawnPath& path) {
    std::vector<double> ends{on.hi};
    for (double a = on.lo; !ends.empty();) {
        const double b = ends.back(), middle = a + (b - a) / 2;
        if (!(chord_error(a, b) <= tolerance)) {
            if (!(a < middle && middle < b) || ends.size() > 200) return false;
            ends.push_back(middle);
            continue;
        }
        const Vec<2> p = value(b);
        if (!is_finite(p) || path.segments.size() >= most) return false;
        path.segments.push_back({1, {p}});
        a = b;
        ends.pop_back();
    }
    return true;
}

// The end of what is there of a path.
inline const Vec<2>& end_of(const DrawnPath& path) {
    return path.segments.empty() ? path.start
                                 : path.segments.back().points[std::size_t(path.segments.back().degree - 1)];
}

// Appends a Bezier piece with these plane coefficients, exactly or flattened.
bool add_piece(DrawnPath& path, std::span<const Vec<2>> b, double tolerance, std::size_t most);
bool add_piece(DrawnPath& path, std::span<const Hom<2>> b, double tolerance, std::size_t most);

// A curve of a model; an edge without a curve runs on a surface. Nothing if it cannot be drawn.
std::optional<DrawnPath> path_of(const CurveGeometry<3>& curve, const Interval& on, const Plane& plane,
                                 double tolerance, std::size_t most);
std::optional<DrawnPath> path_of(const CurveGeometry<2>& curve, const Interval& on,
                                 const SurfaceGeometry& surface, const Plane& plane, double tolerance,
                                 std::size_t most);

// The parts of a spline between places where it jumps.
template <class P>
std::optional<std::vector<DrawnPath>> paths_of(const Curve<P>& curve, const Plane& plane, double tolerance,
                                               std::size_t most) {
    const BezierPieces<1, P> pieces(curve);
    std::vector<DrawnPath> paths;
    for (int i = 0; i < pieces.extent()[0]; ++i) {
        const auto net = pieces.net({i});
        std::vector<decltype(plane(P{}))> b;
        for (int k = 0; k <= pieces.degree(0); ++k) b.push_back(plane(net({k})));
        const bool jump =
            i > 0 && curve.basis().multiplicity(pieces.breaks(0)[std::size_t(i)]) > curve.basis().degree();
        if (i == 0 || jump) paths.push_back({project(b[0]), {}, false});
        if (!add_piece(paths.back(), b, tolerance, most)) return std::nullopt;
    }
    if (paths.size() == 1 && curve.basis().is_closed() &&
        curve.basis().multiplicity(curve.domain()[0].lo) <= curve.basis().degree())
        paths[0].closed = true;
    return paths;
}

}  // namespace freiform::drawing

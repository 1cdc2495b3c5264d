// What the parts of the drawing share: the projection to the plane, flattening, and the sketch that all draw
// on.
#pragma once
#include <freiform/io/drawing.hpp>
#include <freiform/mesh/visibility.hpp>
#include <freiform/query/continuity.hpp>
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
    // With the third coordinate towards the eye.
    Vec<3> deep(const Vec<3>& p) const {
        const Vec<3> q = scaled(p);
        return {{dot(right, q), dot(up, q), dot(cross(right, up), q)}};
    }
    // A linear map commutes with weights.
    Hom<2> operator()(const Hom<3>& p) const {
        const Vec<2> q = (*this)(Vec<3>{{p[0], p[1], p[2]}});
        return Hom<2>{{q[0], q[1], p.weight()}};
    }
};

Plane plane_of(const std::optional<View>& view, bool all_plane, double size);

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

// What surfaces are in front of, of lines that are not theirs.
struct Behind {
    std::vector<DrawnPath> paths, net;  // of curves and edges; of control polygons
    std::vector<DrawnDisc> points;      // control points
};

// What is drawn so far, and of which object.
class Sketch {
public:
    Sketch(const Plane& plane_in, double tolerance_in, double size_in, const DrawingOptions& options_in)
        : plane(plane_in), tolerance(tolerance_in), size(size_in), options(options_in) {}

    DrawnGroup& group(std::string role, const Colour& c, double width) {
        groups.push_back({name, std::move(role), c, width, {}, {}, {}});
        return groups.back();
    }
    void take(DrawnGroup& to, DrawnPath path) {
        used += path.segments.size();
        to.paths.push_back(std::move(path));
    }
    void leave_out(std::string why) { left_out.push_back({RefusalKind::unsupported, label, std::move(why)}); }
    void keep(DrawnGroup& to, std::optional<DrawnPath> path, std::string_view what) {
        if (!path) return leave_out(text(what, " cannot be followed in double precision"));
        take(to, std::move(*path));
    }
    Colour colour_of(std::size_t object) const {
        const auto& own = options.palette;
        return own.empty() ? kPalette[object % kPalette.size()] : own[object % own.size()];
    }
    std::size_t rest() const { return kMostSegments - std::min(used, kMostSegments); }
    // What is behind a surface goes to `behind`.
    template <class P>
    void add_paths(DrawnGroup& to, const Curve<P>& curve) {
        if constexpr (Space<P>::kDim == 3)
            if (occluders && add_seen(to, curve)) return;
        auto paths = paths_of(curve, plane, tolerance, rest());
        if (!paths) return leave_out("a curve of it cannot be followed in double precision");
        for (DrawnPath& path : *paths) take(to, std::move(path));
    }

    // The polygon through these points, to `net` where it is behind a surface.
    void add_polygon(DrawnGroup& to, std::span<const Vec<3>> points, bool closed);
    bool is_behind(const Vec<3>& p) const {
        const Vec<3> q = plane.deep(p);
        return occluders && !occluders->hidden(q, q).empty();
    }

    const Plane plane;
    const double tolerance, size;  // of curves in the plane; of all that is drawn (0: not yet known)
    const DrawingOptions& options;
    std::string label, name;  // of the object: for messages, for groups
    Colour colour;
    std::size_t curves = 0;  // met so far
    std::vector<DrawnGroup> groups;
    std::vector<Note> notes;
    std::vector<Panel> more;  // further panels
    std::vector<Refusal> left_out;
    std::optional<Refusal> failure;
    std::size_t used = 0;                // segments
    std::vector<CurveEnds> ends;         // of the curves
    std::size_t joints = 0;              // marked so far
    bool answered = false;               // a curve was there for what is asked at a parameter
    std::optional<Occluders> occluders;  // the surfaces, once they are there
    Behind behind;                       // of the object

private:
    // False where none of the curve is hidden, or it cannot be told.
    template <class P>
    bool add_seen(DrawnGroup& to, const Curve<P>& curve);
};

// Everything that the options ask for of a curve in space. `basis`: of the curve as it was given, which
// differs from that of its graph. P is Vec<3> or Hom<3>.
template <class P>
void add_curve(Sketch& sketch, const Curve<P>& curve, const BSplineBasis& basis);
// Control points and the lines between them along each axis.
template <class P>
void add_points(Sketch& sketch, DrawnGroup& group, std::span<const P> coefficients);

// Panels of their own: c' as a curve, the graphs of the B-splines.
template <class P>
void add_hodograph(Sketch& sketch, const Curve<P>& curve);
void add_basis(Sketch& sketch, const BSplineBasis& basis);

// The knots of a curve; then, after all curves, where ends of two of them meet.
template <class P>
void add_joints(Sketch& sketch, const Curve<P>& curve);
void join_curves(Sketch& sketch);
// The A-frames at its inner knots.
template <class P>
void add_a_frames(Sketch& sketch, const Curve<P>& curve);

// Surfaces, trimmed surfaces, models, triangles in space.
bool has_faces(const Shape& shape);
// All of these objects together, since each may hide the others; what cannot be drawn goes to left_out, what
// spoils the whole to failure.
void add_faces(Sketch& sketch, const Document& document, std::span<const std::size_t> objects);
// A box around points of the faces, in the plane.
Box<2> box_of_faces(Sketch& sketch, const Document& document, std::span<const std::size_t> objects);

// Adds an object; what of it cannot be drawn goes to left_out.
void add_object(Sketch& sketch, const Document& document, std::size_t index);

}  // namespace freiform::drawing

// Curves, surfaces and polysurfaces of 3DM files, as they are there: a curve is a row of pieces, each of its
// own kind, with a parameter that is linear in that of the piece.
#pragma once
#include "rhino_bytes.hpp"

#include <freiform/spline/geometry.hpp>

#include <array>
#include <variant>
#include <vector>

namespace freiform::rhino {

struct Piece {
    CurveGeometry<3> shape;
    Interval on;  // the part of `shape`
    Interval of;  // the parameters of the whole curve
    Vec<3> end(bool last) const { return jet<0>(shape, last ? on.hi : on.lo).value(); }
};

struct CurveInSpace {
    std::vector<Piece> pieces;  // not empty, one after the other
    Interval domain() const { return {pieces.front().of.lo, pieces.back().of.hi}; }
    Vec<3> end(bool last) const { return last ? pieces.back().end(true) : pieces.front().end(false); }
};

// origin + x x + y y, with (x, y) in `extent`.
struct PlaneInSpace {
    Vec<3> origin{}, x{}, y{};
    std::array<Interval, 2> extent{};
};
// The profile, turned about the axis by the angles `angle`; v runs along it.
struct Revolved {
    CurveInSpace profile;
    Vec<3> origin{}, axis{};  // of length 1
    Interval angle;
    bool transposed = false;  // u runs along the profile
};
// profile(u) + v along, v in [0, 1].
struct Swept {
    CurveInSpace profile;
    Vec<3> along{};
    bool transposed = false;  // v runs along the profile
};
using SurfaceInSpace = std::variant<Surface<Vec<3>>, Surface<Hom<3>>, PlaneInSpace, Revolved, Swept>;

// A curve, and how something runs along it.
struct Along {
    int curve = -1;
    std::optional<Interval> part;  // of the parameters of the curve; none: all
    bool backward = false;         // against it
};
struct TrimOf {
    int edge = -1;
    bool reversed = false;
    // In the parameters of the surface, in the direction of the loop; none if it is not said.
    Along image = {};
};
struct EdgeOf {
    Along along;
    std::array<int, 2> vertex{-1, -1};
};
struct LoopOf {
    std::vector<TrimOf> trims;
};
struct FaceOf {
    int surface = -1;
    bool reversed = false;
    std::vector<LoopOf> loops;
};
struct BrepOf {
    std::vector<CurveInSpace> curves;
    std::vector<std::optional<CurveInSpace>> images;  // curves in parameters; none: could not be read
    std::vector<Result<SurfaceInSpace>> surfaces;     // or why there is none
    std::vector<Vec<3>> vertices;
    std::vector<EdgeOf> edges;
    std::vector<FaceOf> faces;
    bool is_solid() const;  // every edge is used twice
};

Result<CurveInSpace> read_curve(StoredObject o, int depth = 0);
// The same, of the data of the class.
Result<CurveInSpace> read_nurbs_curve(Bytes& b);
Result<CurveInSpace> read_poly_curve(Bytes& b, int depth);
Result<SurfaceInSpace> read_surface(StoredObject o);
Result<SurfaceInSpace> read_nurbs_surface(Bytes& b);
Result<BrepOf> read_brep(StoredObject o);
Result<BrepOf> read_extrusion(StoredObject o);
// A face of all of the surface, with the edges around it.
BrepOf whole_face(SurfaceInSpace surface);

// Numbers as they are in files: knots without the first and the last, homogeneous points.
struct SplineNumbers {
    int dim = 3;
    bool rational = false;
    std::array<int, 2> order{}, size{1, 1};
    std::array<std::vector<double>, 2> knots;
    std::vector<double> points;
};
Result<CurveInSpace> spline_curve(const SplineNumbers& n);
Result<SurfaceInSpace> spline_surface(const SplineNumbers& n);

// Of edges whose file has no vertices: ends that a loop goes through one after the other are one.
void find_vertices(BrepOf& b);

// What is meant of the curve, in its own direction.
Result<CurveInSpace> part_of(const CurveInSpace& c, const Along& along);
// The part of a curve over a part of its parameters, each piece cut; what is off an end by rounding is there.
Result<CurveInSpace> part_of(const CurveInSpace& c, Interval part);
// x -> origin + x0 axes[0] + x1 axes[1] + x2 axes[2].
struct AffineMap {
    Vec<3> origin{};
    std::array<Vec<3>, 3> axes{Vec<3>{{1, 0, 0}}, Vec<3>{{0, 1, 0}}, Vec<3>{{0, 0, 1}}};
    Vec<3> vector(const Vec<3>& d) const { return d[0] * axes[0] + d[1] * axes[1] + d[2] * axes[2]; }
    Vec<3> point(const Vec<3>& p) const { return origin + vector(p); }
};
AffineMap operator*(const AffineMap& a, const AffineMap& b);  // first b, then a
// The image but for rounding.
CurveInSpace mapped(const CurveInSpace& c, const AffineMap& map);
inline CurveInSpace moved(const CurveInSpace& c, const Vec<3>& by) { return mapped(c, {by}); }
// Without surfaces of revolution, whose image is none in general (unsupported).
BrepOf mapped(const BrepOf& b, const AffineMap& map);
// One piece after the other, from the last end to the first; parameters count from 0.
CurveInSpace backwards(const CurveInSpace& c);
bool is_straight(const CurveInSpace& c);
// Nearer ends, of the size of what they bound, are one.
inline constexpr double kClose = 0x1p-36;
double extent_of(const CurveInSpace& c);
bool closes(const CurveInSpace& c);
CurveInSpace segment(const Vec<3>& a, const Vec<3>& b);

}  // namespace freiform::rhino

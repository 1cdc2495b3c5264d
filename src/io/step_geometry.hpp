// Curves and surfaces of STEP files as ours: the same map. Elementary ones stay what they are.
#pragma once
#include "step_fields.hpp"

#include <freiform/spline/geometry.hpp>

#include <unordered_map>
#include <vector>

namespace freiform::step {

// A right-handed frame of unit vectors.
struct Placement {
    Vec<3> o{}, x{{1, 0, 0}}, y{{0, 1, 0}}, z{{0, 0, 1}};
};

// A curve with what its bounded forms say: the part of it that is meant, if they do, and its sense.
struct BoundedCurve {
    CurveGeometry<3> curve;
    bool reversed = false;          // the entity runs against `curve`
    std::optional<Interval> range;  // of the parameters of `curve`; none: all of it
    // `curve` is a spline within `bound` of the instance `approximated`, if there is one; its parameter may
    // be an angle.
    std::uint32_t approximated = kMissing;
    double bound = 0;
    bool has_angles = false;
    bool has_own_parameters = false;  // not the standard's, between the ends of segments
};

// A segment of a composite curve: itself, and the curve that it is a part of.
struct CompositeSegment {
    std::uint32_t instance, curve;
    bool forward;
};
Result<std::vector<CompositeSegment>> segments_in(const File& file, std::uint32_t composite);

// The composite curve that the instance is, or wraps as a curve on a surface; kMissing if there is none.
std::uint32_t composite_in(const File& file, std::uint32_t i);

constexpr double kNearEnds = 1e-6;  // of the size of a curve: nearer ends are one, as in loops

// Geometry by instance, converted once. Lengths are in the unit of the file, angles times `angle` are
// radians.
class GeometryReader {
public:
    explicit GeometryReader(const File& file) : f_(file), composite_points_left_(4 * file.tokens.size()) {}
    double angle = 1;
    double tolerance = 0;  // of the file: what is a spline near something may be off by a part of it

    // What curves and surfaces that were asked for rest on: instances that splines stand for, and the bounds
    // of their distances.
    struct Approximated {
        std::uint32_t instance;
        double bound;
        friend auto operator<=>(const Approximated&, const Approximated&) = default;
    };
    std::vector<Approximated> approximated;

    Result<Vec<3>> point(std::uint32_t i) const;
    Result<Vec<3>> direction(std::uint32_t i) const;  // of length 1
    Result<Placement> placement(std::uint32_t i) const;
    // What CARTESIAN_TRANSFORMATION_OPERATOR_3D does: scale times a frame, which may be left-handed.
    struct Operator {
        Placement to;
        double scale = 1;
    };
    Result<Operator> transformation(std::uint32_t i) const;

    Result<BoundedCurve> curve(std::uint32_t i);
    // Of curves that splines stand for, by their size: how near those are to be, and have to be.
    double lift_accuracy(double size) const;
    double lift_limit(double size) const;
    Result<SurfaceGeometry> surface(std::uint32_t i);
    // What the file says of a curve in the parameters of a surface (PCURVE); their third coordinate is 0.
    // What cannot be read of it is left out.
    std::vector<CurveGeometry<3>> images(std::uint32_t curve, std::uint32_t surface);
    std::vector<std::uint32_t> pcurves(std::uint32_t curve) const;
    Result<std::vector<std::uint32_t>> items_of_pcurve(std::uint32_t pcurve) const;

private:
    Result<Vec<3>> triple(const Fields& f, int i, std::string_view what) const;
    Result<Vec<3>> vector(std::uint32_t i) const;
    Result<BoundedCurve> basic_curve(std::uint32_t i);
    Result<BoundedCurve> composite(std::uint32_t i);
    Result<void> join(std::uint32_t spline, double moved);
    Result<CurveGeometry<3>> spline_curve(std::uint32_t i);
    Result<CurveGeometry<3>> conic(std::uint32_t i, Type type) const;
    Result<BoundedCurve> unwrapped_curve(std::uint32_t i);
    Result<BoundedCurve> wrapped_curve(std::uint32_t wrapping, BoundedCurve basis) const;
    Result<BoundedCurve> trimmed(std::uint32_t i, BoundedCurve basis) const;
    Result<BoundedCurve> offset_of(std::uint32_t i, Type type, BoundedCurve basis) const;
    Result<SurfaceGeometry> basic_surface(std::uint32_t i);
    Result<SurfaceGeometry> elementary(std::uint32_t i, Type type, double offset) const;
    Result<SurfaceGeometry> spline_surface(std::uint32_t i);
    Result<CurveGeometry<3>> profile(std::uint32_t i);

    const File& f_;
    std::unordered_map<std::uint32_t, Result<BoundedCurve>> curves_;
    std::size_t composite_points_left_;  // of composite curves as one, with what is in them
    int depth_ = 0;                      // of curves in composite curves
    bool has_own_parameters_ = false;    // a profile of the surface that is made now
};

// The parameter of the point of the curve that is nearest to `p`, among some tries; `distance` to it.
double parameter_of(const CurveGeometry<3>& curve, const Vec<3>& p, double& distance);

// The curve that runs backwards, and where the parameter t of the curve is on it.
CurveGeometry<3> reversed(const CurveGeometry<3>& curve);

// x -> scale (linear x) + offset, with `linear` orthonormal; a mirror if `mirrored`.
struct Motion {
    Placement to;  // images of the axes and of the origin
    double scale = 1;
    bool mirrored = false;
    bool is_identity() const;
    Vec<3> turned(const Vec<3>& d) const { return d[0] * to.x + d[1] * to.y + d[2] * to.z; }
    Vec<3> direction(const Vec<3>& d) const { return scale * turned(d); }
    Vec<3> point(const Vec<3>& p) const { return to.o + direction(p); }
};
Motion operator*(const Motion& a, const Motion& b);  // first b, then a
// From coordinates in the frame to space, and back.
Motion motion_to(const Placement& frame);
Motion motion_from(const Placement& frame);

CurveGeometry<3> moved(const CurveGeometry<3>& curve, const Motion& by);
SurfaceGeometry moved(const SurfaceGeometry& surface, const Motion& by);

// A surface along a spline that goes on with its first turn again gets that turn alone; whether it is one.
// `close`: ends nearer than this are one.
bool rewind(SurfaceGeometry& surface, double close);

}  // namespace freiform::step

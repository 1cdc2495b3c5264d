// Plane paths, as illustration programs and fonts have them: chains of lines, quadratic and cubic Bezier
// curves and arcs of ellipses.
#pragma once
#include <freiform/spline/patch.hpp>
#include <freiform/spline/transform.hpp>

#include <array>
#include <string_view>
#include <variant>
#include <vector>

namespace freiform {

// A Bezier curve of degree 1 to 3. Of degree 2 it may be rational, with weights 1, weight, 1: an arc of an
// ellipse if weight is below 1, of a parabola if it is 1, of a hyperbola above.
struct PathSegment {
    int degree = 1;
    std::array<Vec<2>, 4> points{};  // degree + 1 of them
    double weight = 1;

    const Vec<2>& front() const { return points[0]; }
    const Vec<2>& back() const { return points[std::size_t(degree)]; }
};

// Each segment begins where the one before ends, the first at `start`, the last of a closed one ends there.
// No segments: a dot.
struct Subpath {
    Vec<2> start{};
    std::vector<PathSegment> segments;
    bool closed = false;
};

struct Path {
    std::vector<Subpath> subpaths;
};

// The image; weights stay as they are.
Path transformed(Path path, const Affinity<2>& map);

// The arc from `from` to `to` of the ellipse with the radii rx, ry whose first axis is turned by `angle`
// (radians) from x: of the four such arcs the one that is `large` (more than half of the ellipse) or not and
// turns by `sweep` from x to y or back; as at most four rational quadratics of equal angles. Radii that are
// too small are enlarged until there is one arc; with a radius of 0, or so large that its middle is at
// infinity, it is a line; with equal ends it is nothing. The ends are exactly the given ones; the rest is off
// by the rounding of some 30 operations. Source: the rules for elliptical arcs of the SVG specification.
std::vector<PathSegment> elliptic_arc(const Vec<2>& from, const Vec<2>& to, double rx, double ry,
                                      double angle, bool large, bool sweep);

// A whole ellipse from center + (rx, 0) on, from x to y, in four quarters.
Subpath ellipse(const Vec<2>& center, double rx, double ry);

// The subpath as one curve: of the highest degree of its segments, each on an interval of length 1, with
// knots of full multiplicity between them; rational if a segment is. What is raised to a higher degree is off
// by the rounding of its new control points. REQUIRES a segment.
std::variant<Curve<Vec<2>>, Curve<Hom<2>>> curve_of(const Subpath& subpath);

// A curve as a subpath, closed if it ends exactly where it begins. Pieces that are polynomial of degree <= 3,
// rational of degree 2 without being hyperbolas, or were raised from such, up to rounding; all others as
// cubics within `tolerance`. Refuses (invalid) tolerances that are not positive, (unsupported) curves that
// jump, (limit) curves that would need more than 100,000 segments, (ill_conditioned) tolerances below the
// rounding of the coordinates.
struct SubpathOfCurve {
    Subpath subpath;
    double bound =
        0;  // distance between points of equal parameters where something was approximated; 0: nothing was
};
template <class P>
Result<SubpathOfCurve> subpath_of(const Curve<P>& curve, double tolerance);

// Path data as SVG writes it: M L H V C S Q T A Z, absolute and relative, with everything that may be left
// out. What is wrong ends the path there, as the specification wants it: `stopped` says at which character
// and why; before it `path` holds what was read.
struct PathData {
    Path path;
    std::optional<Refusal> stopped;
};
PathData parse_path_data(std::string_view text);

// The same in absolute commands, with the shortest numbers that are read back as the same doubles. Arcs of
// ellipses as A, which gives them back up to rounding. REQUIRES weights <= 1.
std::string path_data(const Path& path);

}  // namespace freiform

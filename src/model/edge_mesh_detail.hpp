// Discretisation of edges: once for each edge, fine enough for its own curve and for every face that uses it.
#pragma once
#include "chord_curve_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/model/model.hpp>
#include <freiform/spline/apex.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <deque>
#include <memory>
#include <vector>

namespace freiform {

// u(t) or v(t).
CurveGeometry<1> component_of(const CurveGeometry<2>& curve, int i);

// One use of an edge by a face, with what is needed to bound errors along it.
struct CoedgeQuery {
    int face = -1, loop = -1, index = -1;
    const Coedge* coedge = nullptr;
    std::unique_ptr<DerivativeQuery<1, 2>> curve;
    std::array<PiecewiseBound, 2> second;  // of both coordinates of a spline that is not lifted
    std::optional<LiftedCurve> lift;
    std::unique_ptr<ChordCurve> chords;  // of the lift; for twins made when a tolerance is too small for them
    double twin = kInfinity;  // of the distance between lift and edge, if they are the same but for rounding
    bool is_twin(double tolerance) const {
        constexpr double kTwins = 0x1p-10;  // of the tolerance
        return 2 * twin <= kTwins * tolerance;
    }
};

struct EdgeMesh {
    std::vector<double> parameters;        // increasing, the ends of the edge's range included
    std::vector<int> points;               // shared mesh points, one for each parameter
    bool collapsed = false;                // all its points are one
    Interval kept{-kInfinity, kInfinity};  // of the parameters: those outside are the vertices at the ends
    double moved = 0;                      // how far what became a point is from it, at most
    void lengthen() { kept = {-kInfinity, kInfinity}, moved = 0; }
    double bound = 0;  // of the distance between polyline and curve, on the edge and on its faces
    double size = 0;   // about the diagonal of a box around the edge, known where angles are asked for
    std::vector<std::unique_ptr<CoedgeQuery>> uses;
    std::unique_ptr<ChordCurve> curve;
};

// What the parameter interval [a, b] of an edge contributes.
struct SegmentError {
    double polyline = 0;  // bound of the distance between the chord and the curve, in space and on every face
    double triangle = 0;  // bound of the interpolation error of a triangle whose longest side is the chord
    // Normals of each face over the chord's box are within this angle of one; 0 at poles, and where shorter
    // chords are of no help.
    double turn = 0;
    double sliver = 0;  // what the region between chord and parameter curve adds
};

struct EdgeDemands {
    double tolerance = 0;
    double longest = kInfinity;  // the longest segment
    // What normals of faces turn by along a segment that is longer than angle_floor, at most.
    double angle = kInfinity;
};

class EdgeMesher {
public:
    // `faces`: one query per face of the model, in order; `apexes`: of those that are taken as cones. All
    // must outlive the mesher.
    EdgeMesher(const Model& model, std::span<const std::unique_ptr<DerivativeQuery<2, 3>>> faces,
               std::span<const std::optional<Apex>> apexes);

    // Parameters for which every segment keeps the demands. Refuses (limit) beyond `max_segments`.
    Result<void> discretise(int edge, const EdgeDemands& demands, std::size_t max_segments);
    void forget();  // all parameters
    // Cuts segment `index` of the edge into two: after this part of its parameters.
    void split(int edge, int index, double part = 0.5);

    EdgeMesh& mesh(int edge) { return edges_[std::size_t(edge)]; }
    const EdgeMesh& mesh(int edge) const { return edges_[std::size_t(edge)]; }
    Vec<3> position(int edge, double t) const;
    // `tolerance`: below this errors need not be known better; `cone`: likewise, what normals turn by.
    SegmentError error(int edge, double a, double b, double tolerance, double cone) const;

    struct Part {
        double a, b;
        double needs;  // chords, to keep the demands
        double bound;
    };
    Part part(int edge, double a, double b, const EdgeDemands& demands) const;
    std::vector<double> smooth_pieces(int edge, double tolerance) const;

private:
    double size(int edge) const;
    double estimate(int edge, Interval on, double tolerance) const;
    // What parts ask for, and whether the bounds of all are known.
    struct Shares {
        double sum = 0, most = 0, least = kInfinity;
        bool known = true;
    };
    static Shares shares_of(std::span<const Part> parts);
    static std::vector<double> shared_out(std::span<const Part> parts, int count);
    std::vector<Part> advanced(int edge, std::span<const Part> known, bool guessed, int least,
                               const EdgeDemands& demands, std::size_t most) const;
    std::vector<Part> pilots(int edge, std::span<const double> ends, const EdgeDemands& demands) const;
    std::vector<Part> all_equal(int edge, std::span<const Part> known, double count,
                                const EdgeDemands& demands, std::size_t most) const;
    std::vector<Part> equal_parts(int edge, Interval on, int least, const EdgeDemands& demands,
                                  std::size_t max_segments) const;
    std::vector<Part> joined(int edge, std::vector<Part> parts, double longest,
                             const EdgeDemands& demands) const;
    std::optional<double> torn_place(int edge, Interval on, const EdgeDemands& demands) const;
    std::optional<Refusal> find_parts(int edge, Interval on, int least, const EdgeDemands& demands,
                                      std::size_t max_segments, std::vector<Part>& out) const;

    const Model& model_;
    std::span<const std::unique_ptr<DerivativeQuery<2, 3>>> faces_;
    std::span<const std::optional<Apex>> apexes_;
    std::vector<EdgeMesh> edges_;
};

}  // namespace freiform

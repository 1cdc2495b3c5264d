// Discretisation of edges: once for each edge, fine enough for its own curve and for every face that uses it.
#pragma once
#include <freiform/model/model.hpp>
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
};

struct EdgeMesh {
    std::vector<double> parameters;  // increasing, the ends of the edge's range included
    std::vector<int> points;         // shared mesh points, one for each parameter
    double bound = 0;  // of the distance between polyline and curve, on the edge and on its faces
    std::vector<std::unique_ptr<CoedgeQuery>> uses;
    std::unique_ptr<DerivativeQuery<1, 3>> curve;
};

// What the parameter interval [a, b] of an edge contributes.
struct SegmentError {
    double polyline = 0;  // bound of the distance between the chord and the curve, in space and on every face
    double triangle = 0;  // bound of the interpolation error of a triangle whose longest side is the chord
    double turn = 0;  // normals of each face over the chord's box are within this angle of one; not of poles
    double sliver = 0;  // what the region between chord and parameter curve adds
};

class EdgeMesher {
public:
    // `faces`: one query per face of the model, in order. All must outlive the mesher.
    EdgeMesher(const Model& model, std::span<const std::unique_ptr<DerivativeQuery<2, 3>>> faces);

    // Parameters for which every segment keeps the tolerance, is at most `longest` long, and normals turn by
    // at most `angle` along it where it is longer than kAngleFloor tolerances. Refuses (limit) beyond
    // `max_segments`.
    Result<void> discretise(int edge, double tolerance, double longest, double angle,
                            std::size_t max_segments);
    void forget();  // all parameters
    // Cuts segment `index` of the edge into two.
    void split(int edge, int index);

    EdgeMesh& mesh(int edge) { return edges_[std::size_t(edge)]; }
    const EdgeMesh& mesh(int edge) const { return edges_[std::size_t(edge)]; }
    Vec<3> position(int edge, double t) const;
    SegmentError error(int edge, double a, double b, bool turns) const;

private:
    double estimate(int edge, double tolerance) const;

    const Model& model_;
    std::span<const std::unique_ptr<DerivativeQuery<2, 3>>> faces_;
    std::vector<EdgeMesh> edges_;
};

}  // namespace freiform

// Joins faces that a file leaves apart (IGES): edges that are the same curve within a tolerance become one.
// Explicit, and it says what it did: no reader and no other function sews.
#pragma once
#include <freiform/model/model.hpp>

#include <array>

namespace freiform {

struct SewOptions {
    double tolerance = 0;  // distance in model units, > 0: what is farther apart stays apart
};

// An edge of the sewn model that more faces use than before. Indices are those of the sewn model.
struct SewnEdge {
    int edge = -1;
    std::vector<int> faces;  // all that use it; more than two: non-manifold, and left so
    // No point of an edge that was joined to it is farther than this from its curve, nor the other way round:
    // a bound, rounding included, at most the tolerance.
    double bound = 0;
    // |surface(coedge.curve(t)) - edge.curve(t)| is at most this for the coedges that were joined: a bound.
    double face_bound = 0;
};

// An edge that still has one face, and why. Indices are those of the sewn model.
struct RemainingGap {
    int edge = -1, face = -1;
    std::string face_name;
    // The largest distance of its places from the other edges with one face, infinite without any: measured
    // at samples, an estimate.
    double gap = 0;
    Vec<3> at{};       // where that is
    Box<3> box;        // of its places, likewise
    int opening = -1;  // of Sewing::openings, -1 where the edge is on none
    Refusal reason;
};

// Remaining edges that follow each other round a hole, each vertex joining two: there is no face.
struct Opening {
    std::vector<int> edges;  // in order
    Box<3> box;              // of samples
};

struct Sewing {
    Model model;
    double tolerance = 0;
    int open_before = 0;  // edges with one face
    std::vector<SewnEdge> joined;
    int split = 0;            // cuts of edges that met several shorter ones
    int vertices_joined = 0;  // vertices that became one with another
    double vertex_moved = 0;  // the largest distance between two such, exact but for rounding
    // Faces that were turned over, so that neighbours agree on the outside, and closed parts face outward (by
    // an estimate; those that agree already stay as they are where they may be a hollow in another).
    std::vector<int> flipped;
    std::vector<int> twisted;  // edges whose two faces can not agree (a Moebius strip)
    std::vector<RemainingGap> remaining;
    std::vector<Opening> openings;
};

// Two edges are joined if a map from one onto the other is found with which their whole curves are proven to
// lie within the tolerance of each other (edge_gap), if that is small against the edges themselves, and if no
// other edge would lose its length by it; nearest pairs first. An edge along which ends of others lie is cut
// there; vertices become one that are all within the tolerance of the first, or of the middle of their box,
// and lie there. An edge that one face has alone, no larger than twice the tolerance and between vertices
// that became one, becomes a point if its loop is far larger (which `approximations` name). The face of an
// edge that is given up gets a parameter curve that follows the one that stays. Curves and surfaces are not
// moved. Edges without a curve in space get the image of their parameter curve first (make/image_curve.hpp;
// where its degree is too high a spline that follows within a proven 1/32 of the tolerance, which
// `approximations` name; what has neither is left alone), those that are one point become degenerate, and
// these are left alone. Numbers of edges and vertices change, those of faces do not; texts of
// `approximations` name old numbers and say so. Results do not depend on the number of threads. Refuses a
// tolerance that is not a positive number.
//   auto sewn = sew(model, {.tolerance = 1e-3});
Result<Sewing> sew(const Model& model, const SewOptions& options);

// The largest tolerance that the model gives for a vertex, an edge or a face; 0 if it gives none.
double largest_tolerance(const Model& model);

}  // namespace freiform

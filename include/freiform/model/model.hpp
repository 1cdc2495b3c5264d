// Boundary representation: faces on surfaces, bounded by loops of edges that they share.
//
//     Body -> Shell -> Face -> Loop -> Coedge -> Edge -> Vertex
//
// An edge has one curve in space; every face that uses it has a coedge with a curve in the parameter domain
// of its surface, over the same parameter interval: surface(coedge.curve(t)) lies within `tolerance` of
// edge.curve(t) for every t of edge.range. Indices refer to the vectors of Model; -1 means none.
#pragma once
#include <freiform/core/colour.hpp>
#include <freiform/core/result.hpp>
#include <freiform/spline/geometry.hpp>

#include <optional>
#include <string>
#include <vector>

namespace freiform {

struct Vertex {
    Vec<3> point{};
    double tolerance = 0;  // as the file says; 0 if it says nothing
};

struct Edge {
    // None: degenerate, or the surface along the parameter curve of its first coedge.
    std::optional<CurveGeometry<3>> curve;
    bool degenerate = false;   // all of it is the vertex `start`: a pole or apex
    Interval range{0, 1};      // the part of the curve that the edge is; lo at `start`, hi at `end`
    int start = -1, end = -1;  // equal for a closed edge
    double tolerance = 0;
    std::string name;
    std::optional<Colour> colour = {};
    std::vector<int> layers = {};  // those that it is on
};

struct Coedge {
    int edge = -1;
    bool reversed = false;   // the loop runs through it from `end` to `start`
    CurveGeometry<2> curve;  // parameter curve over edge.range (not reversed when `reversed` is set)
};

// Closed: the end of each coedge is the start of the next. A seam is one edge with two coedges in one face.
struct Loop {
    std::vector<Coedge> coedges;
};

struct Face {
    SurfaceGeometry surface;
    bool reversed = false;    // the outward normal is -(S_u x S_v)
    std::vector<Loop> loops;  // the face is where the odd-even rule says inside; none: the whole domain
    double tolerance = 0;
    std::string name;
    std::optional<Colour> colour;
    std::vector<int> layers = {};  // those that it is on
};

struct FaceUse {
    int face = -1;
    bool reversed = false;  // against the orientation of the face itself
};

struct Shell {
    std::vector<FaceUse> faces;
    bool closed = false;  // the file says so; `open_edges` of `summary` tells what is true
};

struct Body {
    std::vector<int> shells;  // of a solid: the outer one first, then voids
    bool solid = false;
    std::string name;
    std::optional<Colour> colour;
    std::vector<int> layers = {};  // likewise; its faces need not say them again
};

// What programs show and hide together; edges, faces and bodies say which ones they are on.
struct Layer {
    std::string name;
    std::string description = {};
};

// Something that a reader had to approximate: never silent, always with a number.
struct Approximation {
    std::string where, what;
    std::optional<double> bound;  // no point moved by more than this: proven, rounding included
    double estimate = 0;          // without a bound: what is believed instead; nothing proves it
};

// Something of a file that is wrong, and that a reader made right because it was asked to.
struct Repair {
    std::string where, what;  // the entity of the file; what was done to it
    double distance = 0;      // by which something is elsewhere now, or was apart
};

struct Model {
    std::string unit;  // "mm", "m", "inch", ...: the unit of all coordinates and tolerances
    std::vector<Vertex> vertices;
    std::vector<Edge> edges;
    std::vector<Face> faces;
    std::vector<Shell> shells;
    std::vector<Body> bodies;
    std::vector<Refusal> refused;  // entities of the file that are not in the model, each with its reason
    std::vector<Approximation> approximations;
    std::vector<Layer> layers;  // in the order of the file; no name twice
    std::vector<Repair> repairs;
};

struct ModelSummary {
    int vertices = 0, edges = 0, faces = 0, shells = 0, bodies = 0, solids = 0;
    int open_edges = 0;  // edges (not degenerate ones) with fewer than two coedges in all faces
    int seams = 0, degenerate_edges = 0;
    Box<3> box;  // contains the model; may be larger than needed
};
ModelSummary summary(const Model& model);

// Checks every index, range, finite number and loop. A model from `make_model` never makes an algorithm leave
// its arrays.
Result<Model> make_model(Model model);

}  // namespace freiform

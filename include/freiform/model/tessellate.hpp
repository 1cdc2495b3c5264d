// A model to a watertight triangle mesh within a tolerance, with a proof.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/mesh/triangle_mesh.hpp>
#include <freiform/model/model.hpp>

#include <functional>
#include <span>

namespace freiform {

struct TessellateOptions {
    double tolerance = 0;         // distance in model units, > 0
    double max_edge = kInfinity;  // the longest side of a triangle, likewise, > 0
    // The largest angle (radians) between a triangle and normals of its part of the surface, > 0. Triangles
    // are refined for it where that may help (FaceDemands::max_angle); Tessellation says what was reached.
    double max_angle = kInfinity;
    // An aim, > 1: inside faces points are placed in boxes that are at most so much longer than wide, in
    // space. Points on edges stay where they are.
    double max_aspect = kInfinity;
    // Inside faces cells of parameter lines become quads where their halves keep to all this. In faces that
    // are a rectangle of parameters with four edges the lines reach from edge to edge and end at its points.
    bool quads = false;
    // Splines that lie in a plane are meshed as that plane, unless one of the four above is asked for: fewer
    // triangles, but parameters of their corners do not tell what is between them.
    bool as_planes = false;
    long long max_triangles = 20'000'000;  // more is a refusal (limit), before memory is taken for it
    // Called with a fraction in [0, 1], from any thread; false stops with a refusal (limit).
    std::function<bool(double)> progress = {};
};

struct RefusedFace {
    int face = -1;
    std::string name;
    Refusal reason;
};

struct FaceReport {
    int face = -1;
    int triangles = 0;  // halves of quads included
    int quads = 0;
    double error_bound = 0;
    double boundary_gap = 0;
    double angle_bound = 0;  // as Tessellation's
    int angle_exceeded = 0;  // triangles with a bound above max_angle
};

struct Tessellation {
    TriangleMesh mesh;  // one part per face that was not refused, in order
    int quads = 0;      // MeshPart::quads of all; the bounds below are those of their halves
    MeshTopology topology;
    // Every point of a face that is not refused lies within error_bound + boundary_gap of the mesh, and every
    // point of the mesh within the same distance of the surface of its face, continued where the mesh leaves
    // the boundary of the face. Away from the boundaries of faces error_bound alone is enough. Proven from
    // control points (curvature_tree.cpp, bending.cpp, edge_mesh.cpp), rounding included.
    double error_bound = 0;
    // How far the model contradicts itself: the largest distance between a mesh point on an edge and the
    // place where a face's own parameter curve puts it. Not an error of the mesh.
    double boundary_gap = 0;
    // Where max_angle is given: the largest angle between a triangle and any normal of the surface over it, a
    // bound (pi where some triangle has none, as at poles); and how many triangles have one above max_angle.
    double angle_bound = 0;
    int angle_exceeded = 0;
    std::vector<FaceReport> faces;
    std::vector<RefusedFace> refused;
    // Of solids whose faces look the wrong way, all of a shell: its triangles and their normals are turned.
    std::vector<int> turned_shells;
    struct {
        double edges = 0, faces = 0, total = 0;
    } seconds;
};

// Every edge is discretised once and shared by its faces, so that a closed shell gives a closed mesh. A face
// that cannot be meshed is listed in `refused`; the others are delivered. Refuses the whole for a tolerance
// that is not a positive number, a longest side or angle that is not positive, an aspect up to 1, and for
// limits: before any work if an estimate says that they are far away. Sides between boundary points can
// exceed max_edge by twice the gap. Results do not depend on the number of threads. Parts that are copies of
// another part, moved and turned, get its mesh, moved and turned; where max_angle is given, each its own.
Result<Tessellation> tessellate(const Model& model, const TessellateOptions& options);

// One after the other for all options, with the work shared that does not depend on them: what the single
// calls give, bit for bit.
std::vector<Result<Tessellation>> tessellate(const Model& model, std::span<const TessellateOptions> options);

// About how many triangles that would give, from curvatures at samples; without making any. An estimate, not
// a bound. REQUIRES options that `tessellate` does not refuse.
double predicted_triangles(const Model& model, const TessellateOptions& options);

}  // namespace freiform

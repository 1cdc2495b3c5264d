// Parts of a model that are elsewhere and turned what another part is, as in assemblies.
#pragma once
#include <freiform/model/tessellate.hpp>

#include <algorithm>

namespace freiform {

// x -> turn x + offset; the rows of `turn` are orthonormal but for `skew`: |turn x| <= (1 + skew) |x|.
struct RigidMotion {
    std::array<Vec<3>, 3> turn{};
    Vec<3> offset{};
    double skew = 0;

    Vec<3> turned(const Vec<3>& d) const { return {{dot(turn[0], d), dot(turn[1], d), dot(turn[2], d)}}; }
    Vec<3> operator()(const Vec<3>& p) const { return turned(p) + offset; }
};

struct FaceCopy {
    int of = -1;  // the face that it is a copy of; -1: none
    int motion = -1;
    // Bounds the distance between the surface and the moved one at equal parameters, and between the edges'
    // curves; of the face's parameters, rounding included.
    double apart = 0;
};

struct Copies {
    std::vector<FaceCopy> faces;  // one for each of the model
    std::vector<RigidMotion> motions;
    bool any() const { return !motions.empty(); }
    // Of all faces.
    double apart() const {
        double most = 0;
        for (const FaceCopy& f : faces) most = std::max(most, f.apart);
        return most;
    }
};

// Faces that hang together by edges or vertices are copied together or not at all: same topology and
// parameters, bit for bit, and geometry that after a motion is apart by no more than its coordinates are
// rounded.
Copies copies_in(const Model& model);

// The model with those faces alone that are no copies; edges and vertices keep their places.
Model originals_of(const Model& model, const Copies& copies);

// The tessellation of the model from that of its originals. Refuses (limit) more triangles than may be.
Result<Tessellation> with_copies(const Model& model, const Copies& copies, Tessellation originals,
                                 const TessellateOptions& options);

}  // namespace freiform

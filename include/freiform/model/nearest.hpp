// The point of a solid model that is nearest to a given one, with a lower bound that proves it.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/model/model.hpp>

#include <memory>
#include <span>

namespace freiform {

struct ModelNearest {
    int face = -1;
    Vec<2> uv{};  // its parameters there
    // On the boundary of the face: the edge, its parameter, and the vertex where that is an end of it.
    int edge = -1, vertex = -1;
    double t = 0;
    Vec<3> point{};
    double distance = 0;     // to `point`
    double point_error = 0;  // bound: how far `point` may be from the face
    // bound: no point of any face is nearer. The true distance lies in [lower_bound, distance + point_error].
    double lower_bound = 0;
};

struct ModelNearestOptions {
    // A distance: how far lower_bound may stay below `distance`. 0: 2^-30 of the size of the model. No less
    // than 2^-44 of the largest coordinate is of use: rounding.
    double accuracy = 0;
    // A backstop: parts of faces and of their boundaries that are looked at for one answer. Reached,
    // `lower_bound` is what was proven until then. From the centre of a sphere all of it is as near, and the
    // bound comes near to the distance with the square root of this.
    int max_parts = 20000;
};

struct ModelFarthest {
    int face = -1, edge = -1;  // edge: where the place is on the boundary
    Vec<2> uv{};
    Vec<3> point{};
    double distance = 0;     // to `point`
    double point_error = 0;  // bound: how far `point` may be from the face
    // bound: no point of any face is farther. The largest distance lies in [distance - point_error,
    // upper_bound].
    double upper_bound = 0;
};

struct NearestFaces {
    // The nearest point of each; `lower_bound` is for all faces but those before it.
    std::vector<ModelNearest> faces;
    double others = 0;  // bound: all other faces are at least so far; infinite: there are none
};

namespace detail {
struct ModelParts;
}

// Prepared faces; const, to be asked from many threads.
//
// The model is its faces, as their parameter curves trim them. Where the curve of an edge in space is beside
// the parameter curve (edge_gap says by how much), the latter is meant; `t` is the parameter of both.
class ModelNearestQuery {
public:
    // Refuses models without faces (invalid), and faces without bounds of their derivatives or of their
    // boundary, with the place: a lower bound would leave them out.
    static Result<ModelNearestQuery> make(Model model);

    // Many points, in parallel. REQUIRES out.size() == points.size(). Refuses, before any output, points that
    // are not finite (with the index), a negative accuracy and max_parts < 1.
    //   auto q = ModelNearestQuery::make(model);
    //   auto done = q->nearest(points, out);
    Result<void> nearest(std::span<const Vec<3>> points, std::span<ModelNearest> out,
                         const ModelNearestOptions& options = {}) const;
    Result<ModelNearest> nearest(const Vec<3>& point, const ModelNearestOptions& options = {}) const;

    // The `count` nearest faces, of those that are within `radius`; one that may be within it is among them.
    // Nearest first, as far as bounds tell. Refuses besides a count below 1 and a radius that is negative.
    Result<NearestFaces> nearest_faces(const Vec<3>& point, int count, double radius = kInfinity,
                                       const ModelNearestOptions& options = {}) const;
    // `accuracy`: how far upper_bound may stay above `distance`. The same refusals.
    Result<ModelFarthest> farthest(const Vec<3>& point, const ModelNearestOptions& options = {}) const;

    const Model& model() const;
    const detail::ModelParts& parts() const { return *prepared_; }

private:
    std::shared_ptr<const detail::ModelParts> prepared_;
};

}  // namespace freiform

// What stands for faces while they are meshed: planes for splines that lie in one (flat_faces.cpp), splines
// for offsets (offset_faces.cpp).
#pragma once
#include <freiform/model/tessellate.hpp>

#include <optional>
#include <vector>

namespace freiform {

struct StandIn {
    const Face* given = nullptr;  // as the model has it
    bool is_plane = false;        // its parameters are others then
    // The bound of the given face is larger by `apart` than that of what stands for it, and its boundary gap
    // by `gap`, which may be negative.
    double apart = 0, gap = 0;
};

struct StandIns {
    std::vector<std::optional<StandIn>> faces;  // one for each of the model
    // The model with these in their place, the same in all else; nothing where there are none. Edges and
    // coedges keep their places.
    std::optional<Model> standing;
};

// The model must outlive the answer. Splines take some time, and change what is needed by little.
StandIns stand_ins_for(const Model& model, const TessellateOptions& how, bool with_splines);

// Of one face; `standing` becomes what stands for it.
std::optional<StandIn> plane_for(const Model& model, const Face& face, double tolerance, Face& standing);
std::optional<StandIn> spline_for(const Model& model, const Face& face, double tolerance, Face& standing);

// Of the parameter curves, moved into the domain.
Box<2> box_of_curves(const Model& model, const Face& face);

}  // namespace freiform

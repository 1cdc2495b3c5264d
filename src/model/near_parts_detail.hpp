// What the search for the nearest point of a model prepares.
#pragma once
#include "face_parts_detail.hpp"
#include "face_rim_detail.hpp"

#include <freiform/model/nearest.hpp>

#include <deque>

namespace freiform {

struct NearLeaf {
    int face = -1;
    int part = -1, rim = -1;  // one of them
    Box<3> box;
};
struct NearNode {
    Box<3> box;
    int begin = 0, end = 0;  // leaves
    int left = -1;           // the children are `left` and `left` + 1
};

// Parts of all faces and of their boundaries, and a tree of boxes over them.
struct detail::ModelParts {
    explicit ModelParts(Model m) : model(std::move(m)) {}

    Model model;
    double size = 0;
    std::vector<FaceParts> faces;
    std::deque<DerivativeQuery<1, 2>> curves;
    std::vector<FacePart> parts;
    std::vector<FaceRim> rims;
    std::vector<NearLeaf> leaves;
    std::vector<NearNode> nodes;

    Result<void> prepare();
    void add_parts(int face);
    void add_rims(int face);
    FaceRim rim_over(int face, const Coedge* coedge, const DerivativeQuery<1, 2>* curve, Interval on) const {
        FaceRim rim = FaceRim::over(model.faces[std::size_t(face)], faces[std::size_t(face)].surface(),
                                    coedge, curve, on);
        rim.owner = face;
        return rim;
    }
    void build();
};

}  // namespace freiform

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

    // Boundaries of faces are known within `sag`, or better (a length).
    Result<void> prepare(double sag = kInfinity);
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

// Parts of faces and boundaries for a search that halves some of them: first those that are prepared.
class OpenedParts {
public:
    explicit OpenedParts(const detail::ModelParts& all) : all_(all), parts_(all.parts), rims_(all.rims) {}

    const FacePart& part(int i) const { return parts_[std::size_t(i)]; }
    const FaceRim& rim(int i) const { return rims_[std::size_t(i)]; }
    // f(i) for the halves that are not outside of the face. False: there are none, since parameters can not
    // be halved any more, or the rim is a jump.
    template <class F>
    bool halve_part(int face, int index, F&& f) {
        const Box<2> box = part(index).box;
        bool can = false;
        for (int k = 0; k < 2; ++k) {
            const double m = box.side(k).middle();
            can = can || (box.lo[k] < m && m < box.hi[k]);
        }
        if (!can) return false;
        const FacePart whole = part(index);
        for (FacePart& half : all_.faces[std::size_t(face)].halves(whole, whole.may_be_long())) {
            parts_.push_back(std::move(half));
            f(int(parts_.size()) - 1);
        }
        return true;
    }
    template <class F>
    bool halve_rim(int index, F&& f) {
        const FaceRim whole = rim(index);
        const double middle = whole.on.middle();
        if (!whole.coedge || !(whole.on.lo < middle && middle < whole.on.hi)) return false;
        for (const Interval half : {Interval{whole.on.lo, middle}, Interval{middle, whole.on.hi}}) {
            rims_.push_back(all_.rim_over(whole.owner, whole.coedge, whole.curve, half));
            f(int(rims_.size()) - 1);
        }
        return true;
    }

private:
    const detail::ModelParts& all_;
    std::vector<FacePart> parts_;
    std::vector<FaceRim> rims_;
};

}  // namespace freiform

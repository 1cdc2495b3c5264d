// Polysurfaces, curves and blocks of 3DM files as the entities of STEP that say the same, so that one reader
// makes faces of both: seams, poles, parameter curves, gaps and all that is told of them (docs/step.md).
//
// Numbers come through unchanged, as the shortest text that is the same double. What that reader says of its
// entities is said of the objects of the file again.
#pragma once
#include "rhino_geometry.hpp"
#include "step_product.hpp"

#include <map>
#include <string>
#include <vector>

namespace freiform::rhino {

class StepText {
public:
    // `tolerance`: of the file, in its unit.
    explicit StepText(double tolerance) : product_(entities_, "mm", tolerance), geometry_(entities_) {
        mark("", "");
    }

    // What follows belongs to the object with this label.
    void begin(std::string label) { mark(std::move(label), ""); }

    // They return the number of an item of a representation; nothing where all faces are refused.
    Result<std::vector<int>> brep(const BrepOf& b, std::string_view name);
    Result<int> curve(const CurveInSpace& c, std::string_view name);
    // A representation that others can have somewhere: the image of each.
    int block(std::string_view name, const std::vector<int>& items);
    // Nothing if the map is no similarity.
    std::optional<int> instance(int block, std::string_view name, const AffineMap& map);

    void put_on_layer(const std::string& layer, int item) { layers_[layer].push_back(item); }
    void colour(const Colour& c, int item);

    std::vector<Refusal> refused;  // faces, by the object and their number there

    std::size_t bytes() const { return entities_.out.size(); }
    // The file, once.
    std::string take(const std::vector<int>& items);
    // Entities in what is said of the file by the names of what they stand for.
    Refusal told(Refusal r) const;
    std::string told(const std::string& s, bool with_object) const;

private:
    struct Mark {
        int after;  // entities with a greater number
        std::string object, part;
    };
    void mark(std::string object, std::string part) {
        marks_.push_back({entities_.last(), std::move(object), std::move(part)});
    }
    void mark_part(std::string part) {
        std::string object = marks_.back().object;
        mark(std::move(object), std::move(part));
    }
    void refuse_face(const std::string& label, Refusal r);
    Result<int> bounded(const Piece& p);
    Result<int> row(const CurveInSpace& c);
    Result<int> curve_of(const CurveInSpace& c);
    int edge_on(int curve, int from, int to, std::string_view name);
    struct Work;
    static void find_images(Work& w);
    int pcurve(const CurveGeometry<2>& c, int surface);
    Result<int> edge_of(Work& w, std::size_t edge);
    Result<int> loop_of(Work& w, const LoopOf& l, const std::string& face);
    Result<int> face_of(Work& w, const FaceOf& face, const std::string& label);
    Result<int> surface(const SurfaceInSpace& s, bool& turned);

    detail::Entities entities_;
    detail::Product product_;
    detail::StepGeometry geometry_;
    std::vector<Mark> marks_;
    std::map<std::string, std::vector<int>> layers_;
    std::map<std::array<double, 3>, int> colours_;
    std::vector<int> styled_;
    int frame_ = 0, parameters_ = 0;  // entities that are there once
};

}  // namespace freiform::rhino

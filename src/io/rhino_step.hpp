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
    static constexpr std::size_t kMostWork = 500'000'000;

    // `tolerance`: of the file, in its unit. `longest`: bytes. `work`: control points of curves that edges
    // are parts of.
    explicit StepText(double tolerance, std::size_t longest = std::size_t(1) << 28,
                      std::size_t work = kMostWork)
        : product_(entities_, "mm", tolerance), geometry_(entities_), longest_(longest), work_left_(work) {
        begin("");
    }

    // What follows belongs to the object with this label.
    void begin(std::string label) {
        objects_.push_back(std::move(label));
        mark_part("");
    }

    // They return the number of an item of a representation; nothing where all faces are refused.
    Result<std::vector<int>> brep(const BrepOf& b, std::string_view name);
    Result<int> curve(const CurveInSpace& c, std::string_view name);
    // A representation that others can have somewhere: the image of each.
    int block(std::string_view name, const std::vector<int>& items);
    // Nothing if the map is no similarity.
    std::optional<int> instance(int block, std::string_view name, const AffineMap& map);

    void put_on_layer(int layer, int item) { layers_[layer].push_back(item); }
    void colour(const Colour& c, int item);

    std::vector<Refusal> refused;  // faces, by the object and their number there

    bool is_too_long() const { return entities_.out.size() > longest_; }
    // The file, once.
    std::string take(const std::vector<int>& items, const std::vector<std::string>& layers);
    // Entities in what is said of the file by the names of what they stand for.
    Refusal told(Refusal r) const;
    std::string told(const std::string& s, bool with_object) const;

private:
    struct Mark {
        int after;  // entities with a greater number
        std::size_t object;
        std::string part;
    };
    void mark_part(std::string part) {
        marks_.push_back({entities_.last(), objects_.size() - 1, std::move(part)});
    }
    // Of a curve that many edges share.
    Result<CurveInSpace> shared_part(const CurveInSpace& c, const Along& along);
    void refuse_face(const std::string& label, Refusal r);
    Result<int> bounded(const Piece& p);
    Result<int> row(const CurveInSpace& c);
    Result<int> curve_of(const CurveInSpace& c);
    int edge_on(int curve, int from, int to, std::string_view name);
    struct Work;
    void find_images(Work& w);
    int pcurve(const CurveGeometry<2>& c, int surface);
    Result<int> edge_of(Work& w, std::size_t edge);
    Result<int> loop_of(Work& w, const LoopOf& l, const std::string& face);
    Result<int> face_of(Work& w, const FaceOf& face, const std::string& label);
    Result<int> surface(const SurfaceInSpace& s, bool& turned);

    detail::Entities entities_;
    detail::Product product_;
    detail::StepGeometry geometry_;
    std::vector<Mark> marks_;
    std::vector<std::string> objects_;  // their labels
    std::map<int, std::vector<int>> layers_;
    std::map<std::array<double, 3>, int> colours_;
    std::vector<int> styled_;
    std::size_t longest_, work_left_;
    int frame_ = 0, parameters_ = 0;  // entities that are there once
};

}  // namespace freiform::rhino

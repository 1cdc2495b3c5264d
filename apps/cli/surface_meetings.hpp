// What intersect says of two surfaces: branches and nodes.
#pragma once
#include "input.hpp"

#include <freiform/model/intersect.hpp>

namespace freiform::cli {

class SurfaceMeetings {
public:
    void add(const SurfaceIntersection& found, const std::array<std::size_t, 2>& objects,
             const std::string& where);
    void add(const ModelIntersection& found, const std::array<std::size_t, 2>& objects,
             const std::string& where);
    // The members "curves" and "nodes" of the answer, and what is shown instead.
    void write(json::Writer& w) const;
    const std::string& plain() const { return plain_; }
    const Document& curves() const { return curves_; }

private:
    using Row = std::function<void(json::Writer&)>;
    void add_branch(const SurfaceBranch& b, int before, const std::array<std::size_t, 2>& objects,
                    const std::string& where, const FaceBranch* of_faces);
    void add_node(const SurfaceNode& n, const std::array<std::size_t, 2>& objects, const std::string& where,
                  const FaceNode* of_faces);
    std::vector<Row> branches_, nodes_, chains_;
    Document curves_;
    std::string plain_;
};

}  // namespace freiform::cli

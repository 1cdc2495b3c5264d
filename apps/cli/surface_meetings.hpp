// What intersect says of two surfaces: branches and nodes.
#pragma once
#include "input.hpp"

#include <freiform/intersect/surface_surface.hpp>

namespace freiform::cli {

class SurfaceMeetings {
public:
    void add(const SurfaceIntersection& found, const std::array<std::size_t, 2>& objects,
             const std::string& where);
    // The members "curves" and "nodes" of the answer, and what is shown instead.
    void write(json::Writer& w) const;
    const std::string& plain() const { return plain_; }
    const Document& curves() const { return curves_; }

private:
    using Row = std::function<void(json::Writer&)>;
    std::vector<Row> branches_, nodes_;
    Document curves_;
    std::string plain_;
};

}  // namespace freiform::cli

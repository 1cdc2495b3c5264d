// What `convert` does to one object on the way.
#pragma once
#include <freiform/shape.hpp>

#include <optional>
#include <string>
#include <vector>

namespace freiform::cli {

struct ConvertArguments {
    std::string file, object, axis;
    bool to_bezier = false, reverse = false, to_triangles = false, to_surfaces = false, orient_loops = false;
    std::optional<int> elevate;
    std::optional<double> split, reduce, tolerance;
    std::vector<double> knots;

    bool changes() const {
        return to_bezier || reverse || elevate || split || reduce || !knots.empty() || to_triangles ||
               to_surfaces;
    }
};

// One patch becomes one or more; `suffix` tells them apart.
struct ConvertedPiece {
    std::string suffix;
    Shape shape;
};
using Pieces = std::vector<ConvertedPiece>;

// What became of an object.
struct Changed {
    Pieces pieces;
    double bound = 0;  // of the distance to what it was
    int removed = 0;   // knots
};

// A refusal names the option, not the object.
Result<Changed> converted(const Shape&, const ConvertArguments&);

}  // namespace freiform::cli

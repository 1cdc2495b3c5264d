// The curves, surfaces, volumes and triangles of a document as nearest points and distances take them, and
// how places on them and on models are written.
#pragma once
#include "input.hpp"

#include <freiform/model/nearest.hpp>
#include <freiform/query/nearest.hpp>

namespace freiform::cli {

// Of one number of coordinates.
struct ObjectSet {
    std::vector<std::size_t> index;  // in the document
    std::vector<NearestObject> objects;
    std::vector<std::size_t> params;
    int coordinates = 0;  // 0: none yet
};

// Object i; what has other coordinates than the set is refused, as "has .. coordinates, REASON", models and
// trimmed surfaces are left out.
Result<void> add_object(const Input& input, std::size_t i, std::string_view reason, ObjectSet& out);

// "x, y, z"
std::string listed_numbers(std::span<const double> x);

// "face", "parameters", "edge", "point", and the same for people.
void write_place(json::Writer& w, const ModelNearest& n);
std::string place_text(const ModelNearest& n);

}  // namespace freiform::cli

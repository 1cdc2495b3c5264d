// What intersect says of curves, lines and rays that meet models: contacts on their faces.
#pragma once
#include "input.hpp"

#include <freiform/model/curve_model.hpp>

namespace freiform::cli {

class ModelContactRows {
public:
    // `ray`: the line of the table, if it is one. `swapped`: the model is A, so that its parameters are `a`.
    // What is near within `tolerance` counts as a point.
    void add(const ModelContacts& found, const std::array<std::size_t, 2>& objects,
             std::optional<std::size_t> ray, bool swapped, double tolerance, const std::string& where);

    const std::vector<std::function<void(json::Writer&)>>& points() const { return points_; }
    const std::vector<std::function<void(json::Writer&)>>& overlaps() const { return overlaps_; }
    const std::vector<std::function<void(json::Writer&)>>& possible() const { return possible_; }
    const std::string& plain() const { return plain_; }
    const std::vector<std::string>& undecided() const { return undecided_; }

private:
    std::vector<std::function<void(json::Writer&)>> points_, possible_, overlaps_;
    std::string plain_;
    std::vector<std::string> undecided_;
};

// Rows px, py, pz, dx, dy, dz of a table; rays begin at t = 0. Refusals name the line.
Result<std::vector<StraightLine>> read_lines(const Context& context, const std::string& file, bool rays);

// "ray 3 with part (object 0)": every line with every object of A that has faces.
Result<void> meet_lines(const Input& input, std::span<const StraightLine> lines, double tolerance,
                        ModelContactRows& rows);

}  // namespace freiform::cli

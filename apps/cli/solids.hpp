// Solid models that commands make: as documents, or as triangles.
#pragma once
#include "command.hpp"

namespace freiform::cli {

// How `tessellate` would write it, for a command whose answer is a model.
struct SolidOutput {
    std::string format;               // "json", "step", "iges", "igs", "glb", "stl", "obj" or "ply"
    std::optional<double> tolerance;  // of triangles; a thousandth of the model's box without

    bool is_mesh() const { return format != "json" && format != "step" && !is_iges(); }
    bool is_iges() const { return format == "iges" || format == "igs"; }
};
// From -o and --to; other formats are wrong usage. The default is json.
SolidOutput solid_output(const Context& context, const std::string& command, std::optional<double> tolerance);

// Writes the models of the document; `w` is a JSON object and `said` a line for people about them, to which
// what is known of triangles is added, and which is then printed if the answer went to a file.
Result<void> emit_solids(const Context& context, const SolidOutput& output, const Document& document,
                         json::Writer& w, std::string said);

// The ending of the output's name, or --to, in small letters; `otherwise` if there is none.
std::string output_ending(const Context& context, std::string_view otherwise);

}  // namespace freiform::cli

// What a command was asked about: a file, and the objects of it that --object chose.
#pragma once
#include "command.hpp"

#include <freiform/core/visit.hpp>

namespace freiform::cli {

struct Input {
    std::string file;  // as it was given
    std::shared_ptr<const Document> document;
    std::vector<std::size_t> chosen;  // indices of objects

    const Object& object(std::size_t i) const { return document->objects[i]; }
    // For people: of one object among several its index and name, else the file.
    std::string label(std::size_t i) const;
    // A refusal about object i, said with its label: "objects[0] "c1": at[3]".
    std::unexpected<Refusal> about(std::size_t i, Refusal r) const;
};
Result<Input> read_input(const Context& context, const std::string& file, const std::string& object);

// Whether a file is a triangle mesh: .stl, .ply, .glb, .obj without curves and surfaces, and STEP files whose
// shapes are all tessellated.
bool is_mesh_file(const Context& context, const std::string& file);

// Curves that bound no face, and triangles beside exact shapes, are left out of a whole file.
inline bool is_face(const Refusal& refused) {
    return refused.kind != RefusalKind::unsupported || refused.where != "file";
}
void write_refusals(json::Writer& w, std::string_view name, const std::vector<Refusal>& list);

// Says on standard error what reading had to change in these objects, and by how much.
void remark_changes(const Document& document, std::span<const std::size_t> objects);

// "Is a model, not a curve, and left out".
void remark_left_out(const Input& input, std::size_t i);

// Calls f(curve) if the shape is a curve; whether it is. Most questions are about curves only, and the other
// two dozen shapes need no code of their own.
template <class F>
bool with_curve(const Shape& shape, F&& f) {
    return visit_one(
        [&](const auto& s) {
            if constexpr (TensorPatch<std::remove_cvref_t<decltype(s)>>)
                if constexpr (std::remove_cvref_t<decltype(s)>::kParams == 1) return f(s), true;
            return false;
        },
        shape);
}

// A trimmed surface as a model of one face, whose edges have no curves of their own. A loop is a chain of
// splines, or one ellipse.
Result<Model> model_of_trimmed(const TrimmedSurface& t);

// Calls of_curve(index, curve) for the curves among the chosen objects, and if there is an of_model, that for
// the models and trimmed surfaces; what else there is, is remarked on. Refuses if there is none "to PURPOSE".
using OfModel = std::function<Result<void>(std::size_t index, const Model& model)>;
template <class F>
Result<void> each_curve(const Input& input, std::string_view purpose, F&& of_curve,
                        const OfModel& of_model = {}) {
    std::size_t curves = 0;
    for (const std::size_t i : input.chosen) {
        const Shape& shape = input.object(i).shape;
        Result<void> done;
        if (with_curve(shape, [&](const auto& curve) { done = of_curve(i, curve); }))
            ++curves;
        else if (const Model* model = std::get_if<Model>(&shape); model && of_model)
            ++curves, done = of_model(i, *model);
        else if (const auto* trimmed = std::get_if<TrimmedSurface>(&shape); trimmed && of_model) {
            const auto one = model_of_trimmed(*trimmed);
            ++curves, done = one ? of_model(i, *one) : std::unexpected(one.error());
        } else
            remark_left_out(input, i);
        if (!done) return input.about(i, done.error());
    }
    if (curves == 0)
        return refuse(RefusalKind::no_answer, shown(input.file),
                      text("there is no ", of_model ? "curve or model" : "curve", " to ", purpose));
    return {};
}

// Of a curve, surface, volume or the surface that is trimmed; else none.
std::span<const BSplineBasis> bases_of(const Shape& shape);

// The box of the control points of these and of triangles; `lo` is empty if there are none.
struct ControlBox {
    std::vector<double> lo, hi;
    double diagonal = 0;
};
ControlBox control_box(const Shape& shape);

}  // namespace freiform::cli

#include "surface_commands.hpp"

#include "point_commands.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/spline/in_space.hpp>

namespace freiform::cli {

Result<SpaceCurves> read_space_curves(const Context& context, const std::string& file,
                                      const std::string& object, std::string_view purpose) {
    const auto document = read_any(file, context.read_options());
    if (!document) return std::unexpected(document.error());
    const auto objects = selected(*document, object);
    if (!objects) return std::unexpected(objects.error());
    SpaceCurves all;
    all.unit = document->unit;
    for (const std::size_t i : *objects) {
        const Object& o = document->objects[i];
        const bool is_curve = visit_one(
            [&](const auto& s) {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (TensorPatch<S>)
                    if constexpr (S::kParams == 1 && (S::Point::kCoords == 2 || S::Point::kCoords == 3)) {
                        const auto c = in_space(s);
                        if constexpr (Space<typename S::Coefficients>::kRational) {
                            all.rational.push_back(c);
                        } else {
                            all.polynomial.push_back(c);
                            all.rational.push_back(to_rational(c));
                        }
                        return true;
                    }
                return false;
            },
            o.shape);
        if (!is_curve)
            return refuse(
                RefusalKind::no_answer, text(shown(file), ": ", object_label(*document, i)),
                text("is a ", type_name(o.shape), "; curves of two or three coordinates are ", purpose));
        all.names.push_back(o.name);
        all.labels.push_back(text(shown(file), ": ", object_label(*document, i)));
    }
    return all;
}

Result<SpaceCurves> read_space_curves(const Context& context, const std::string& file, std::size_t count,
                                      std::string_view purpose) {
    auto all = read_space_curves(context, file, "", purpose);
    if (all && all->size() != count)
        return refuse(
            RefusalKind::no_answer, shown(file),
            text("has ", all->size(), all->size() == 1 ? " curve, " : " curves, ", count, " are ", purpose));
    return all;
}

Result<void> emit_surfaces(const Context& context, const std::string& format, MadeSurfaces made) {
    const std::size_t n = made.document.objects.size();
    json::Writer w;
    w.begin_object().field("surfaces", n).field("bound", made.bound);
    std::string plain = text(n, n == 1 ? " surface" : " surfaces", " within ", made.bound, " of ", made.of);
    for (const auto& [name, value] : made.said) {
        w.field(name, value);
        plain += text(", ", name, " ", value);
    }
    w.end_object();
    for (char& c : plain) c = c == '_' ? ' ' : c;
    return emit_spline(context, format, std::move(made.document), plain + "\n", w.take() + "\n");
}

std::vector<double> parse_numbers(const std::string& option, const std::vector<double>& given,
                                  std::size_t count) {
    if (given.size() != count) wrong_usage(text(option, " needs ", count, " numbers, found ", given.size()));
    return given;
}
Vec<3> parse_vector(const std::string& option, const std::vector<double>& given) {
    const auto x = parse_numbers(option, given, 3);
    return {{x[0], x[1], x[2]}};
}
Vec<3> parse_direction(const std::string& option, const std::vector<double>& given) {
    const Vec<3> v = parse_vector(option, given);
    require_direction(option, v.c);
    return v;
}

}  // namespace freiform::cli

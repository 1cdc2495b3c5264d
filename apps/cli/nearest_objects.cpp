#include "nearest_objects.hpp"

#include <freiform/core/visit.hpp>

namespace freiform::cli {

Result<void> add_object(const Input& input, std::size_t i, std::string_view reason, ObjectSet& out) {
    return visit_one(
        [&](const auto& s) -> Result<void> {
            using S = std::remove_cvref_t<decltype(s)>;
            if constexpr (TensorPatch<S> || TriangularPatch<S>) {
                const int own = Space<typename S::Coefficients>::kDim;
                if (out.coordinates != 0 && own != out.coordinates)
                    return refuse(RefusalKind::no_answer, input.label(i),
                                  text("has ", own, " coordinates, ", reason));
                out.coordinates = own;
                out.index.push_back(i);
                out.objects.push_back(NearestObject::of(s));
                if constexpr (TensorPatch<S>)
                    out.params.push_back(S::kParams);
                else
                    out.params.push_back(2);
            }
            return {};
        },
        input.object(i).shape);
}

std::string listed_numbers(std::span<const double> x) {
    std::string s;
    for (const double v : x) s += text(s.empty() ? "" : ", ", v);
    return s;
}

void write_place(json::Writer& w, const ModelNearest& n) {
    w.field("face", n.face).key("parameters").array(n.uv.c);
    if (n.edge >= 0) w.field("edge", n.edge);
    if (n.vertex >= 0) w.field("vertex", n.vertex);
    w.key("point").array(n.point.c);
}

std::string place_text(const ModelNearest& n) {
    return text("face ", n.face, " at ", listed_numbers(n.uv.c),
                n.edge >= 0 ? text(", on edge ", n.edge) : "",
                n.vertex >= 0 ? text(", vertex ", n.vertex) : "", ", point ", listed_numbers(n.point.c));
}

}  // namespace freiform::cli

#include "regions.hpp"

#include "input.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>

namespace freiform::cli {

namespace {

// At the inner knots where no derivative need be continuous: walls end there.
template <class P>
std::vector<CurveGeometry<2>> cut_at_corners(const Curve<P>& c) {
    std::vector<CurveGeometry<2>> parts;
    double from = c.basis().domain().lo;
    const auto knots = c.basis().knots();
    const int p = c.basis().degree();
    const auto add = [&](double to) {
        if (auto part = restrict_to(c, 0, {from, to})) parts.push_back(*std::move(part));
        from = to;
    };
    for (std::size_t i = 0; i + std::size_t(p) <= knots.size(); ++i) {
        const double t = knots[i];
        if (t > from && t < c.basis().domain().hi && knots[i + std::size_t(p) - 1] == t) add(t);
    }
    add(c.basis().domain().hi);
    return parts;
}

// Ends with one control point are one, whatever dividing by their weights makes of it.
template <class P>
bool is_closed(const Curve<P>& c) {
    const Interval on = c.basis().domain();
    const Vec<2> a = c(on.lo), b = c(on.hi);
    return c.basis().is_closed() || norm(b - a) <= 8 * kUnitRoundoff * norm(a);
}

}  // namespace

Result<PlaneRegion> read_region(const Context& context, const std::string& file, const std::string& object) {
    const auto input = read_input(context, file, object);
    if (!input) return std::unexpected(input.error());
    PlaneRegion region;
    region.unit = input->document->unit;
    for (const std::size_t i : input->chosen) {
        const bool taken = visit_one(
            [&](const auto& s) {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (std::same_as<S, Curve<Vec<2>>> || std::same_as<S, Curve<Hom<2>>>) {
                    if (!is_closed(s)) return false;
                    region.loops.push_back(cut_at_corners(s));
                    return true;
                }
                return false;
            },
            input->object(i).shape);
        if (!taken)
            return input->about(
                i, {RefusalKind::no_answer, "",
                    "is no closed plane curve; such curves bound the region of a solid (--object)"});
    }
    return region;
}

Result<void> emit_swept(const Context& context, const SolidOutput& output, const std::string& file,
                        const std::string& unit, Result<Model> model,
                        std::span<const std::pair<std::string, double>> said) {
    if (!model) return refuse_within(shown(file), model.error());
    model->unit = unit;
    Document document;
    document.unit = unit;
    const std::size_t faces = model->faces.size(), solids = model->bodies.size();
    document.objects.push_back({"", *std::move(model)});
    json::Writer w;
    w.begin_object().field("solids", solids).field("faces", faces);
    std::string words = text(solids, solids == 1 ? " solid, " : " solids, ", faces, " faces");
    for (const auto& [name, number] : said) {
        w.field(name, number);
        words += text(", ", name, " ", number);
    }
    return emit_solids(context, output, document, w, std::move(words));
}

}  // namespace freiform::cli

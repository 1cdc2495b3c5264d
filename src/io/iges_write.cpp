// Idea. An entity is a list of numbers: those of 126 and 128 are degrees, flags, knots, weights, points and
// the domain. A trimmed surface (144) names its surface, its outer loop and its holes; a loop (142) is a
// composite curve (102) in the parameters and one in space, whose curves are the images of those
// (make/image_curve.hpp). Models: iges_model.cpp. The file is cards of 80 columns, each with the letter of
// its section and a number; the directory says where the parameters of each entity begin, and these which
// directory entry they are of.
//
// References: the Initial Graphics Exchange Specification, version 5.3, 4.4, 4.23, 4.24, 4.34 and 4.36.
#include "iges_file.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/iges.hpp>
#include <freiform/make/image_curve.hpp>

namespace freiform {

namespace {

using detail::IgesFile;
using detail::IgesLook;
using detail::IgesUse;

Result<int> iges_loop(IgesFile& file, const std::vector<CurveGeometry<2>>& curves, const TrimmedSurface& t,
                      int surface) {
    const SurfaceGeometry geometry = visit_one(
        [](const auto& s) -> SurfaceGeometry {
            const auto open = IgesFile::cut(s);  // which refused nothing when the surface was written
            return open ? *open : s;
        },
        t.surface);
    std::array<std::vector<int>, 2> chains;  // in the parameters, in space
    for (const auto& c : curves) {
        const auto flat = parameter_spline(c, domain(c)[0]);
        if (!flat) return std::unexpected(flat.error());
        const auto image = image_curve(geometry, *flat);
        if (!image) return std::unexpected(image.error());
        const auto add_spline = [&](const auto& x, IgesUse use) -> Result<int> {
            if constexpr (requires { x.net(); })
                return file.add(x, use);
            else
                return refuse(RefusalKind::unsupported, "", "a curve that is no spline");
        };
        const auto one = visit_one([&](const auto& x) { return add_spline(x, IgesUse::parameters); }, *flat);
        if (!one) return one;
        const auto other = visit_one([&](const auto& x) { return add_spline(x, IgesUse::part); }, *image);
        if (!other) return other;
        chains[0].push_back(*one), chains[1].push_back(*other);
    }
    std::array<int, 2> whole{};
    for (std::size_t k = 0; k < 2; ++k) {
        std::vector<std::string> values = {text(chains[k].size())};
        for (const int id : chains[k]) values.push_back(text(id));
        whole[k] = chains[k].size() == 1
                       ? chains[k][0]
                       : file.entity("102", k == 0 ? IgesUse::parameters : IgesUse::part, values);
    }
    return file.entity("142", IgesUse::part,
                       {"0", text(surface), text(whole[0]), text(whole[1]), "3"});  // both are as good
}

// One for each outer loop; holes go to the only one.
Result<int> iges_trimmed(IgesFile& file, const TrimmedSurface& t, const std::string& name) {
    const auto turned = detail::oriented_loops(t);
    if (!turned) return std::unexpected(turned.error());
    const auto look = [&] { return file.look(std::nullopt, name); };  // of each entity its own
    const bool is_whole = turned->loops.empty();
    const auto surface = visit_one(
        [&](const auto& s) {
            return is_whole ? file.add(s, IgesUse::alone, look()) : file.add(s, IgesUse::part);
        },
        t.surface);
    if (!surface || is_whole) return surface;
    std::vector<int> outer, holes;
    for (std::size_t l = 0; l < turned->loops.size(); ++l) {
        const auto id = iges_loop(file, turned->loops[l], t, *surface);
        if (!id) return refuse_within(text("loops[", l, "]"), id.error());
        (turned->depth[l] % 2 == 0 ? outer : holes).push_back(*id);
    }
    if (outer.size() > 1 && !holes.empty())
        return refuse(RefusalKind::unsupported, "loops",
                      text(outer.size(), " outer loops and ", holes.size(),
                           " holes; IGES has holes in one outer loop each: split the surface first"));
    int last = 0;
    for (const int o : outer) {
        std::vector<std::string> values = {text(*surface), "1", text(holes.size()), text(o)};
        for (const int h : holes) values.push_back(text(h));
        const IgesLook own = look();
        last = file.entity("144", IgesUse::alone, values, 0, 0, own);
    }
    return last;
}

}  // namespace

Result<std::string> write_iges(const Document& document) {
    IgesFile file;
    for (std::size_t i = 0; i < document.objects.size(); ++i) {
        const Object& o = document.objects[i];
        const auto done = visit_one(
            [&](const auto& s) -> Result<int> {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (std::same_as<S, TrimmedSurface>) return iges_trimmed(file, s, o.name);
                if constexpr (std::same_as<S, Model>) {
                    const auto model = detail::add_model(file, s);
                    return model ? Result<int>(0) : std::unexpected(model.error());
                }
                if constexpr (TensorPatch<S>)
                    if constexpr (S::kParams <= 2 && (S::Point::kCoords == 2 || S::Point::kCoords == 3))
                        return file.add(s, IgesUse::alone, file.look(std::nullopt, o.name));
                return refuse(RefusalKind::unsupported, "",
                              text("is a ", type_name(o.shape),
                                   "; IGES files are written of models, and of curves and surfaces of two or "
                                   "three coordinates, trimmed or not"));
            },
            o.shape);
        if (!done) return refuse_within(object_label(document, i), done.error());
    }
    if (file.is_empty()) return refuse(RefusalKind::no_answer, "objects", "there is nothing to write");
    return file.take(document.unit);
}

}  // namespace freiform

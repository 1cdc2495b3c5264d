#include "document_detail.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/document.hpp>
#include <freiform/make/named_curve.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace freiform {

using namespace document_detail;

namespace {

constexpr std::string_view kTypes[] = {"curve",   "surface", "volume", "triangle",
                                       "hermite", "trimmed", "model"};

Result<Object> object_of(Result<ReadShape> shape) {
    if (!shape) return std::unexpected(shape.error());
    return Object{"", std::move(shape->shape), std::move(shape->given_points)};
}

template <int D>
Result<Shape> read_hermite(const Fields& f, const std::vector<double>& t, std::size_t n) {
    const auto vectors = [](json::Value v) { return read_list(v, read_vec<D>); };
    const auto p = f.get("points", vectors), r = f.get("tangents", vectors);
    if (!p) return std::unexpected(p.error());
    if (!r) return std::unexpected(r.error());
    if (r->size() != n)
        return refuse(RefusalKind::invalid, "tangents", text(r->size(), " tangents for ", n, " points"));
    auto curve = hermite_spline<Vec<D>>(*p, *r, t);
    if (!curve) return std::unexpected(curve.error());
    return std::move(*curve);
}

Result<Object> read_hermite_object(json::Value v) {
    static constexpr std::string_view kFields[] = {"type", "name", "points", "tangents", "parameters"};
    const auto f = Fields::read(v, "a hermite curve", kFields);
    if (!f) return std::unexpected(f.error());
    const auto points = f->get("points");
    if (!points) return std::unexpected(points.error());
    if (!points->is(json::Kind::array) || points->size() < 2)
        return expected("at least 2 points", *points, "points");
    const std::size_t n = points->size();
    const json::Value first = *points->elements().begin();
    if (!first.is(json::Kind::array) || first.size() < 1 || first.size() > 4)
        return expected("a point of 1 to 4 numbers", first, "points[0]");

    std::vector<double> t;
    for (std::size_t i = 0; i < n; ++i) t.push_back(double(i));
    const auto given = f->get_or("parameters", read_numbers, t);
    if (!given) return std::unexpected(given.error());
    if (given->size() != n)
        return refuse(RefusalKind::invalid, "parameters",
                      text(given->size(), " parameters for ", n, " points"));
    for (std::size_t i = 1; i < n; ++i)
        if (!((*given)[i - 1] < (*given)[i]))
            return refuse(RefusalKind::invalid, text("parameters[", i, "]"),
                          text("does not increase: ", (*given)[i - 1], " -> ", (*given)[i]));
    if (!std::isfinite(given->back() - given->front()))
        return refuse(RefusalKind::nonfinite, "parameters", "their range leaves the range of double");

    const auto shape = first.size() == 1   ? read_hermite<1>(*f, *given, n)
                       : first.size() == 2 ? read_hermite<2>(*f, *given, n)
                       : first.size() == 3 ? read_hermite<3>(*f, *given, n)
                                           : read_hermite<4>(*f, *given, n);
    if (!shape) return std::unexpected(shape.error());
    return Object{"", *shape, {}};
}

Result<Object> object_of(Result<Shape> shape) {
    if (!shape) return std::unexpected(shape.error());
    return Object{"", std::move(*shape), {}};
}

// How many colours a shape has room for: one per control point.
std::size_t room_for_colours(const Shape& shape) {
    return visit_one(
        [](const auto& s) -> std::size_t {
            using S = std::remove_cvref_t<decltype(s)>;
            if constexpr (TensorPatch<S>)
                return s.net().flat().size();
            else if constexpr (TriangularPatch<S>)
                return s.coefficients().size();
            else
                return 0;
        },
        shape);
}

Result<void> read_attribute(const json::Member& m, Object& object) {
    if (m.key == "name" || m.key == "material") {
        auto word = read_string(m.value);
        if (!word) return refuse_within(m.key, word.error());
        (m.key == "name" ? object.name : object.material) = std::move(*word);
    } else if (m.key == "colours") {
        auto colours = read_list(m.value, [](json::Value c) -> Result<Colour> {
            const auto colour = read_colour(c);
            if (!colour) return std::unexpected(colour.error());
            return **colour;
        });
        if (!colours) return refuse_within("colours", colours.error());
        if (const auto room = room_for_colours(object.shape); colours->size() != room)
            return refuse(RefusalKind::invalid, "colours",
                          text(colours->size(), " colours for ", room, " points"));
        object.colours = std::move(*colours);
    }
    return {};
}

Result<Object> read_object(json::Value v) {
    const auto type = read_type(v, "", kTypes);
    if (!type) return std::unexpected(type.error());
    auto object = *type == "curve"      ? object_of(read_patch<1>(v))
                  : *type == "surface"  ? object_of(read_patch<2>(v))
                  : *type == "volume"   ? object_of(read_patch<3>(v))
                  : *type == "triangle" ? object_of(read_triangle(v))
                  : *type == "hermite"  ? read_hermite_object(v)
                  : *type == "trimmed"  ? object_of(read_trimmed(v))
                                        : object_of(read_model(v));
    if (!object) return object;
    auto changes = changes_in(v);
    if (Model* model = std::get_if<Model>(&object->shape))
        std::ranges::move(changes, std::back_inserter(model->approximations));
    else
        object->approximations = std::move(changes);
    for (const json::Member& m : v.members())
        if (auto ok = read_attribute(m, *object); !ok) return std::unexpected(ok.error());
    return object;
}

bool has_member(json::Value v, std::string_view key) {
    for (const json::Member& m : v.members())
        if (m.key == key) return true;
    return false;
}

}  // namespace

Result<Document> read_document(std::string_view json) {
    const auto tree = json::parse(json);
    if (!tree) return std::unexpected(tree.error());
    const json::Value root = tree->root();
    if (!root.is(json::Kind::object))
        return expected("a document: an object with \"objects\", or with \"type\"", root);
    Document document;
    if (has_member(root, "type")) {
        auto object = read_object(root);
        if (!object) return std::unexpected(object.error());
        document.objects.push_back(std::move(*object));
        return document;
    }
    static constexpr std::string_view kFields[] = {"freiform", "unit", "objects"};
    const auto f = Fields::read(root, "a document", kFields);
    if (!f) return std::unexpected(f.error());
    const auto version = f->get_or("freiform", read_int, kVersion);
    if (!version) return std::unexpected(version.error());
    if (*version != kVersion)
        return refuse(
            RefusalKind::unsupported, "freiform",
            text("the document is of version ", *version, ", this program reads version ", kVersion));
    auto unit = f->get_or("unit", read_string, std::string());
    if (!unit) return std::unexpected(unit.error());
    document.unit = std::move(*unit);
    auto objects = f->get("objects", [](json::Value list) { return read_list(list, read_object); });
    if (!objects) return std::unexpected(objects.error());
    document.objects = std::move(*objects);
    return document;
}

std::string write_document(const Document& document) {
    json::Writer w;
    w.begin_object().field("freiform", kVersion);
    if (!document.unit.empty()) w.field("unit", document.unit);
    w.key("objects").begin_array();
    for (const Object& o : document.objects) {
        w.new_line(2).begin_object();
        if (!o.name.empty()) w.field("name", o.name);
        w.field("type", type_name(o.shape));
        visit_one(
            [&](const auto& s) {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (TensorPatch<S>) {
                    write_patch(w, s, o.given_points);
                } else if constexpr (TriangularPatch<S>) {
                    write_triangle(w, s, o.given_points);
                } else if constexpr (std::same_as<S, Model>) {
                    write_model(w, s);
                } else {
                    w.key("surface").begin_object();
                    visit_one([&](const auto& surface) { write_patch(w, surface, {}); }, s.surface);
                    w.end_object().key("loops").begin_array();
                    for (const auto& loop : s.loops) {
                        w.begin_array();
                        for (const auto& curve : loop) write_curve(w, curve);
                        w.end_array();
                    }
                    w.end_array();
                }
            },
            o.shape);
        if (!o.material.empty()) w.field("material", o.material);
        if (!o.colours.empty() && o.colours.size() == room_for_colours(o.shape)) {
            w.key("colours").begin_array();
            for (const Colour& c : o.colours) w.array(std::array{c.r, c.g, c.b, c.a});
            w.end_array();
        }
        w.end_object();
    }
    w.end_array().end_object();
    return w.take() + "\n";
}

}  // namespace freiform

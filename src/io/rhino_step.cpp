#include "rhino_step.hpp"

#include "step_trace.hpp"

#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::rhino {

namespace {

using detail::Entities;
using detail::quoted;
using detail::real;

std::string triple(const Vec<3>& p) { return detail::listed_as(p.c, real); }

constexpr double kSimilar = 0x1p-36;  // of the scale of a map: what it is a similarity up to

Refusal within(const std::string& part, Refusal r) {
    r.where = r.where.empty() ? part : part.empty() ? r.where : text(part, ", ", r.where);
    return r;
}

}  // namespace

namespace {

// None of arcs.
std::optional<CurveGeometry<3>> bounded_spline(const Piece& p) {
    if (std::holds_alternative<Conic<3>>(p.shape)) return std::nullopt;
    if (!std::holds_alternative<Line<3>>(p.shape)) return p.shape;
    Net<1, Vec<3>> net({2}, {p.end(false), p.end(true)});
    return CurveGeometry<3>(Curve<Vec<3>>::trusted({*BSplineBasis::bezier(1)}, std::move(net)));
}

}  // namespace

// A curve that ends where the piece does.
Result<int> StepText::bounded(const Piece& p) {
    return visit_one(
        [&](const auto& g) -> Result<int> {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (std::same_as<G, Line<3>>) {
                return geometry_.curve(*bounded_spline(p));
            } else if constexpr (std::same_as<G, Conic<3>>) {
                const auto whole = geometry_.curve(p.shape);
                if (!whole || p.on.length() >= 2 * std::numbers::pi * (1 - 0x1p-30)) return whole;
                const int a = geometry_.point(p.end(false)), b = geometry_.point(p.end(true));
                return entities_.add(
                    text("TRIMMED_CURVE('',#", *whole, ",(#", a, "),(#", b, "),.T.,.CARTESIAN.)"));
            } else {
                return geometry_.one(g);
            }
        },
        p.shape);
}

Result<int> StepText::row(const CurveInSpace& c) {
    std::vector<int> segments;
    for (const Piece& p : c.pieces) {
        const auto id = bounded(p);
        if (!id) return id;
        segments.push_back(entities_.add(text("COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#", *id, ")")));
    }
    return entities_.add(text("COMPOSITE_CURVE('',", Entities::refs(segments), ",.U.)"));
}

Result<int> StepText::curve_of(const CurveInSpace& c) {
    return c.pieces.size() == 1 ? geometry_.curve(c.pieces[0].shape) : row(c);
}

int StepText::edge_on(int curve, int from, int to, std::string_view name) {
    return entities_.add(text("EDGE_CURVE(", quoted(name), ",#", from, ",#", to, ",#", curve, ",.T.)"));
}

Result<int> StepText::surface(const SurfaceInSpace& s, bool& turned) {
    turned = false;
    return visit_one(
        [&](const auto& x) -> Result<int> {
            using S = std::remove_cvref_t<decltype(x)>;
            if constexpr (std::same_as<S, PlaneInSpace>) {
                return geometry_.surface(Extrusion{Line<3>{x.origin, x.x}, x.y, SurfaceKind::plane});
            } else if constexpr (std::same_as<S, Revolved>) {
                turned = x.transposed;
                const auto id = curve_of(x.profile);
                if (!id) return id;
                const int at = geometry_.point(x.origin);
                const int axis = entities_.add(text("DIRECTION('',", triple(x.axis), ")"));
                const int placed = entities_.add(text("AXIS1_PLACEMENT('',#", at, ",#", axis, ")"));
                return entities_.add(text("SURFACE_OF_REVOLUTION('',#", *id, ",#", placed, ")"));
            } else if constexpr (std::same_as<S, Swept>) {
                turned = x.transposed;
                if (is_straight(x.profile))
                    return geometry_.surface(
                        Extrusion{x.profile.pieces[0].shape, x.along, SurfaceKind::plane});
                const auto id = curve_of(x.profile);
                if (!id) return id;
                const int direction = entities_.add(text("DIRECTION('',", triple(x.along), ")"));
                const int v = entities_.add(text("VECTOR('',#", direction, ",", real(norm(x.along)), ")"));
                return entities_.add(text("SURFACE_OF_LINEAR_EXTRUSION('',#", *id, ",#", v, ")"));
            } else {
                return geometry_.surface(x);
            }
        },
        s);
}

void StepText::refuse_face(const std::string& label, Refusal r) {
    refused.push_back(within(objects_.back(), within(label, std::move(r))));
}

struct StepText::Work {
    const BrepOf& b;
    std::vector<int> vertices, edges, surfaces;  // entities; 0: not yet
    std::vector<char> turned;                    // surfaces whose entity has the other normal
    // Of each edge: a spline and the edge's curve in its parameters, in the edge's direction.
    std::vector<std::vector<std::pair<int, CurveInSpace>>> images;
};

// However often a file names a curve of many points: all together no more than so many.
Result<CurveInSpace> StepText::shared_part(const CurveInSpace& c, const Along& along) {
    std::size_t work = c.pieces.size();
    for (std::size_t i = 0; i < c.pieces.size() && work <= work_left_; ++i)
        visit_one(
            [&](const auto& g) {
                if constexpr (requires { g.net(); }) work += g.net().flat().size();
            },
            c.pieces[i].shape);
    if (work > work_left_ || is_too_long()) {
        work_left_ = 0;
        return refuse(RefusalKind::limit, "", "its curve has too many points for the edges that share it");
    }
    work_left_ -= work;
    return part_of(c, along);
}

void StepText::find_images(Work& w) {
    for (const FaceOf& f : w.b.faces) {
        const auto& surface = w.b.surfaces[std::size_t(f.surface)];
        if (!surface || (!std::holds_alternative<Surface<Vec<3>>>(*surface) &&
                         !std::holds_alternative<Surface<Hom<3>>>(*surface)))
            continue;
        for (const LoopOf& l : f.loops)
            for (const TrimOf& t : l.trims) {
                const auto n = std::size_t(t.image.curve);
                if (t.image.curve < 0 || n >= w.b.images.size() || !w.b.images[n]) continue;
                auto c = shared_part(*w.b.images[n], t.image);
                if (!c || c->pieces.size() != 1) continue;
                if (t.image.backward != t.reversed) c = backwards(*c);
                w.images[std::size_t(t.edge)].emplace_back(f.surface, std::move(*c));
            }
    }
}

// 0 if it has no entity.
int StepText::pcurve(const CurveGeometry<2>& c, int surface) {
    const auto flat = visit_one(
        [&](const auto& g) -> Result<int> {
            if constexpr (requires { g.net(); })
                return geometry_.one(g);
            else
                return 0;
        },
        c);
    if (!flat || *flat == 0) return 0;
    if (parameters_ == 0)
        parameters_ = entities_.add(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(2)PARAMETRIC_REPRESENTATION_CONTEXT()"
            "REPRESENTATION_CONTEXT('2D SPACE',''))");
    const int held = entities_.add(text("DEFINITIONAL_REPRESENTATION('',(#", *flat, "),#", parameters_, ")"));
    return entities_.add(text("PCURVE('',#", surface, ",#", held, ")"));
}

// The curve in space with those in parameters, all in one direction.
Result<int> StepText::edge_of(Work& w, std::size_t edge) {
    const EdgeOf& e = w.b.edges[edge];
    auto c = shared_part(w.b.curves[std::size_t(e.along.curve)], e.along);
    if (!c) return std::unexpected(c.error());
    if (e.along.backward) c = backwards(*c);
    const auto space = curve_of(*c);
    if (!space) return space;
    std::vector<int> pcurves;
    for (const auto& [surface, image] : w.images[edge]) {
        const auto spline = bounded_spline(image.pieces[0]);
        const auto flat = spline ? step::without_last_coordinate(*spline) : std::nullopt;
        if (flat) pcurves.push_back(pcurve(*flat, w.surfaces[std::size_t(surface)]));
    }
    std::erase(pcurves, 0);
    const int shape =
        pcurves.empty()
            ? *space
            : entities_.add(text("SURFACE_CURVE('',#", *space, ",", Entities::refs(pcurves), ",.CURVE_3D.)"));
    return edge_on(shape, w.vertices[std::size_t(e.vertex[0])], w.vertices[std::size_t(e.vertex[1])], "");
}

// 0 of a loop that bounds nothing.
Result<int> StepText::loop_of(Work& w, const LoopOf& l, const std::string& face) {
    std::vector<int> around;
    for (const TrimOf& t : l.trims) {
        int& e = w.edges[std::size_t(t.edge)];
        if (e == 0) {
            const std::string label = text("edge ", t.edge);
            mark_part(label);
            const auto id = edge_of(w, std::size_t(t.edge));
            mark_part(face);
            if (!id) return std::unexpected(within(label, id.error()));
            e = *id;
        }
        around.push_back(entities_.add(text("ORIENTED_EDGE('',*,*,#", e, t.reversed ? ",.F.)" : ",.T.)")));
    }
    return around.empty() ? 0 : entities_.add(text("EDGE_LOOP('',", Entities::refs(around), ")"));
}

Result<int> StepText::face_of(Work& w, const FaceOf& face, const std::string& label) {
    const auto n = std::size_t(face.surface);
    if (face.loops.empty()) return w.surfaces[n];
    const bool reversed = face.reversed != (w.turned[n] != 0);
    std::vector<int> bounds;
    for (const LoopOf& l : face.loops) {
        const auto loop = loop_of(w, l, label);
        if (!loop) return loop;
        // Loops run about the surface's own normal here, about the face's there.
        if (*loop > 0)
            bounds.push_back(entities_.add(text("FACE_BOUND('',#", *loop, reversed ? ",.F.)" : ",.T.)")));
    }
    if (bounds.empty()) return refuse(RefusalKind::invalid, "", "none of its loops has an edge");
    return entities_.add(
        text("ADVANCED_FACE('',", Entities::refs(bounds), ",#", w.surfaces[n], reversed ? ",.F.)" : ",.T.)"));
}

Result<std::vector<int>> StepText::brep(const BrepOf& b, std::string_view name) {
    Work w{b,
           {},
           std::vector<int>(b.edges.size(), 0),
           std::vector<int>(b.surfaces.size(), 0),
           std::vector<char>(b.surfaces.size(), 0),
           {}};
    w.images.resize(b.edges.size());
    for (const Vec<3>& p : b.vertices) {
        if (!is_finite(p))
            return refuse(RefusalKind::invalid, "", "a vertex has coordinates that are no numbers");
        const int at = geometry_.point(p);
        w.vertices.push_back(entities_.add(text("VERTEX_POINT('',#", at, ")")));
    }
    find_images(w);
    const auto label = [](std::size_t face) { return text("face ", face); };
    std::vector<std::optional<Refusal>> why(b.surfaces.size());
    for (std::size_t f = 0; f < b.faces.size(); ++f) {
        const auto n = std::size_t(b.faces[f].surface);
        if (w.surfaces[n] != 0 || why[n]) continue;
        mark_part(label(f));
        bool turned = false;
        const auto id = b.surfaces[n] ? surface(*b.surfaces[n], turned)
                                      : Result<int>(std::unexpected(b.surfaces[n].error()));
        if (!id) why[n] = id.error();
        w.surfaces[n] = id ? *id : 0, w.turned[n] = turned;
    }
    std::vector<int> faces;
    for (std::size_t f = 0; f < b.faces.size(); ++f) {
        const auto& no_surface = why[std::size_t(b.faces[f].surface)];
        mark_part(label(f));
        const auto id =
            no_surface ? Result<int>(std::unexpected(*no_surface)) : face_of(w, b.faces[f], label(f));
        if (id)
            faces.push_back(*id);
        else
            refuse_face(label(f), id.error());
    }
    if (faces.empty()) return std::vector<int>{};
    mark_part("");
    const bool solid = b.is_solid() && faces.size() == b.faces.size();
    const int shell =
        entities_.add(text(solid ? "CLOSED_SHELL(''," : "OPEN_SHELL('',", Entities::refs(faces), ")"));
    return std::vector{
        entities_.add(solid ? text("MANIFOLD_SOLID_BREP(", quoted(name), ",#", shell, ")")
                            : text("SHELL_BASED_SURFACE_MODEL(", quoted(name), ",(#", shell, "))"))};
}

Result<int> StepText::curve(const CurveInSpace& c, std::string_view name) {
    const auto vertex = [&](bool last) {
        return entities_.add(text("VERTEX_POINT('',#", geometry_.point(c.end(last)), ")"));
    };
    const int from = vertex(false);
    const auto shape = curve_of(c);
    if (!shape) return shape;
    const int id = edge_on(*shape, from, closes(c) ? from : vertex(true), name);
    const int set = entities_.add(text("CONNECTED_EDGE_SET('',(#", id, "))"));
    return entities_.add(text("EDGE_BASED_WIREFRAME_MODEL(", quoted(name), ",(#", set, "))"));
}

int StepText::block(std::string_view name, const std::vector<int>& items) {
    if (frame_ == 0) {
        const int at = geometry_.point({});
        frame_ = entities_.add(text("AXIS2_PLACEMENT_3D('',#", at, ",$,$)"));
    }
    const int shapes = entities_.add(text("SHAPE_REPRESENTATION(", quoted(name), ",", Entities::refs(items),
                                          ",#", product_.context(), ")"));
    return entities_.add(text("REPRESENTATION_MAP(#", frame_, ",#", shapes, ")"));
}

std::optional<int> StepText::instance(int block, std::string_view name, const AffineMap& map) {
    const auto& axis = map.axes;
    const double scale = norm(axis[0]);
    if (!(scale > 0) || !std::isfinite(scale) || !is_finite(map.origin)) return std::nullopt;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(std::abs(norm(axis[i]) - scale) <= kSimilar * scale)) return std::nullopt;
        if (!(std::abs(dot(axis[i], axis[(i + 1) % 3])) <= kSimilar * scale * scale)) return std::nullopt;
    }
    std::array<int, 3> ids{};
    for (std::size_t i = 0; i < 3; ++i)
        ids[i] = entities_.add(text("DIRECTION('',", triple((1 / scale) * axis[i]), ")"));
    const int at = geometry_.point(map.origin);
    const int by = entities_.add(text("CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',#", ids[0], ",#", ids[1],
                                      ",#", at, ",", real(scale), ",#", ids[2], ")"));
    return entities_.add(text("MAPPED_ITEM(", quoted(name), ",#", block, ",#", by, ")"));
}

void StepText::colour(const Colour& c, int item) {
    int& style = colours_[{c.r, c.g, c.b}];
    if (style == 0) {
        int id = entities_.add(text("COLOUR_RGB('',", real(c.r), ",", real(c.g), ",", real(c.b), ")"));
        id = entities_.add(text("FILL_AREA_STYLE_COLOUR('',#", id, ")"));
        id = entities_.add(text("FILL_AREA_STYLE('',(#", id, "))"));
        id = entities_.add(text("SURFACE_STYLE_FILL_AREA(#", id, ")"));
        id = entities_.add(text("SURFACE_SIDE_STYLE('',(#", id, "))"));
        id = entities_.add(text("SURFACE_STYLE_USAGE(.BOTH.,#", id, ")"));
        style = entities_.add(text("PRESENTATION_STYLE_ASSIGNMENT((#", id, "))"));
    }
    styled_.push_back(entities_.add(text("STYLED_ITEM('',(#", style, "),#", item, ")")));
}

std::string StepText::take(const std::vector<int>& items, const std::vector<std::string>& layers) {
    begin("");
    for (const auto& [layer, on] : layers_)
        entities_.add(text("PRESENTATION_LAYER_ASSIGNMENT(", quoted(layers[std::size_t(layer)]), ",'',",
                           Entities::refs(on), ")"));
    product_.add("SHAPE_REPRESENTATION", "", items);
    product_.style(styled_);
    std::string out = text(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
        "FILE_SCHEMA(('AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF'));\nENDSEC;\nDATA;\n");
    out += entities_.out;
    entities_.out = {};
    return out + "ENDSEC;\nEND-ISO-10303-21;\n";
}

// "#17 EDGE_LOOP" is what of the file the entity 17 was made for.
std::string StepText::told(const std::string& s, bool with_object) const {
    std::string out;
    for (std::size_t i = 0; i < s.size();) {
        std::size_t j = i + 1;
        int id = 0;
        while (s[i] == '#' && j < s.size() && s[j] >= '0' && s[j] <= '9' && j < i + 9)
            id = 10 * id + (s[j++] - '0');
        if (s[i] != '#' || j == i + 1) {
            out += s[i++];
            continue;
        }
        std::size_t name = j;
        if (name < s.size() && s[name] == ' ') {
            ++name;
            while (name < s.size() &&
                   ((s[name] >= 'A' && s[name] <= 'Z') || (s[name] >= '0' && s[name] <= '9') ||
                    s[name] == '_' || s[name] == '&'))
                ++name;
            if (name > j + 1) j = name;
        }
        const auto after =
            std::partition_point(marks_.begin(), marks_.end(), [&](const Mark& m) { return m.after < id; });
        const Mark* m = after == marks_.begin() ? nullptr : &*(after - 1);
        const bool object = m != nullptr && with_object && !objects_[m->object].empty();
        if (object) out += objects_[m->object];
        if (m != nullptr && !m->part.empty())
            out += (object ? ", " : "") + m->part;
        else if (!object)
            out += "a part of it";
        i = j;
    }
    return out;
}

Refusal StepText::told(Refusal r) const {
    r.where = told(r.where, true);
    r.message = told(r.message, false);
    return r;
}

}  // namespace freiform::rhino

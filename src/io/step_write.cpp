// Idea. A STEP file is a list of numbered entities that name each other. Everything that is shared is written
// once: vertices and edges of a model by their index, so that what was watertight stays so.
//
//     PRODUCT -> .. -> SHAPE_REPRESENTATION -> MANIFOLD_SOLID_BREP -> CLOSED_SHELL -> ADVANCED_FACE ->
//     FACE_BOUND
//     -> EDGE_LOOP -> ORIENTED_EDGE -> EDGE_CURVE -> VERTEX_POINT, LINE, B_SPLINE_CURVE_WITH_KNOTS, ..
//
// Orientation. Our loops run counter-clockwise in the parameters of the surface; those of the standard about
// the normal of the face. So the bounds of a reversed face are reversed, too. Degenerate edges (poles) have
// no entity.
//
// Parametrisation. Extrusions and revolutions have the parameters that the standard gives them, up to scale;
// edges are trimmed by their vertices. So conics may be turned to their principal axes. Of splines that go on
// beyond an edge only its part is written, of surfaces with several turns only one (step_written.cpp).
//
// Trimmed surfaces. Loops are turned as above first. Their edges have parameter curves alone: what these are
// in space is found exactly but for rounding (make/image_curve.hpp), and both are written.
//
// References: ISO 10303-21 (the text), -42 (geometry and topology), -242:2014 (products).
// Why not the writer of Open CASCADE: it rounds numbers to 15 digits, which moves control points, and takes a
// process of its own.
#include "step_detail.hpp"
#include "step_product.hpp"
#include "step_written.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/io/step.hpp>
#include <freiform/make/image_curve.hpp>
#include <freiform/spline/in_space.hpp>

#include <map>

namespace freiform {

namespace {

using detail::Entities;
using detail::Product;
using detail::quoted;
using detail::real;
using detail::StepGeometry;

class StepModel {
public:
    StepModel(Entities& entities, const Model& model)
        : e_(entities),
          geometry_(entities),
          m_(model),
          vertices_(model.vertices.size()),
          edges_(model.edges.size()),
          on_layers_(model.layers.size()) {}

    // The solids, and all other shells.
    Result<void> write() {
        std::vector<int> faces;
        for (std::size_t f = 0; f < m_.faces.size(); ++f) {
            const auto id = face(m_.faces[f]);
            if (!id) return refuse_within(text("faces[", f, "]"), id.error());
            faces.push_back(*id);
            put_on_layers(m_.faces[f].layers, *id);
            if (m_.faces[f].colour) styled.push_back(coloured(*m_.faces[f].colour, *id));
        }
        for (const Body& b : m_.bodies) {
            std::vector<int> shells;
            for (const int s : b.shells)
                shells.push_back(add_shell(m_.shells[std::size_t(s)], b.solid, faces, !shells.empty()));
            const int id = add_body(b, shells);
            if (id > 0) put_on_layers(b.layers, id);
            if (id > 0 && b.colour) styled.push_back(coloured(*b.colour, id));
        }
        return {};
    }

    // Once all else is written.
    void write_layers() {
        for (std::size_t l = 0; l < m_.layers.size(); ++l)
            if (!on_layers_[l].empty())
                e_.add(text("PRESENTATION_LAYER_ASSIGNMENT(", quoted(m_.layers[l].name), ",",
                            quoted(m_.layers[l].description), ",", Entities::refs(on_layers_[l]), ")"));
    }

    // Edges that no face has, once faces are written; nothing if there are none.
    Result<void> write_wires(std::string_view name) {
        std::vector<int> wires;
        for (std::size_t i = 0; i < m_.edges.size(); ++i) {
            const Edge& e = m_.edges[i];
            if (edges_[i] != 0 || e.degenerate) continue;
            if (!e.curve)
                return refuse(RefusalKind::unsupported, text("edges[", i, "]"),
                              "has neither a curve nor a face");
            const auto curve = geometry_.curve(detail::part_of(e));
            if (!curve) return refuse_within(text("edges[", i, "]"), curve.error());
            wires.push_back(edge_curve(e, *curve));
        }
        if (wires.empty()) return {};
        const int set = e_.add(text("CONNECTED_EDGE_SET('',", Entities::refs(wires), ")"));
        wireframes.push_back(e_.add(text("EDGE_BASED_WIREFRAME_MODEL(", quoted(name), ",(#", set, "))")));
        return {};
    }

    std::vector<int> solids, sheets, wireframes, styled;

private:
    // Red, green and blue; one style for all surfaces of a colour, and one for all curves.
    int coloured(const Colour& c, int item, bool is_curve = false) {
        int& style = styles_[is_curve][{c.r, c.g, c.b}];
        if (style == 0) {
            int id = e_.add(text("COLOUR_RGB('',", real(c.r), ",", real(c.g), ",", real(c.b), ")"));
            if (is_curve) {
                const int font = e_.add("DRAUGHTING_PRE_DEFINED_CURVE_FONT('continuous')");
                id = e_.add(text("CURVE_STYLE('',#", font, ",POSITIVE_LENGTH_MEASURE(0.1),#", id, ")"));
            } else {
                id = e_.add(text("FILL_AREA_STYLE_COLOUR('',#", id, ")"));
                id = e_.add(text("FILL_AREA_STYLE('',(#", id, "))"));
                id = e_.add(text("SURFACE_STYLE_FILL_AREA(#", id, ")"));
                id = e_.add(text("SURFACE_SIDE_STYLE('',(#", id, "))"));
                id = e_.add(text("SURFACE_STYLE_USAGE(.BOTH.,#", id, ")"));
            }
            style = e_.add(text("PRESENTATION_STYLE_ASSIGNMENT((#", id, "))"));
        }
        return e_.add(text("STYLED_ITEM('',(#", style, "),#", item, ")"));
    }

    void put_on_layers(const std::vector<int>& layers, int id) {
        for (const int l : layers) on_layers_[std::size_t(l)].push_back(id);
    }

    // A void, and what is used from behind as a whole, is a shell that another one turns; where only some
    // faces are, each of them is turned.
    int add_shell(const Shell& shell, bool solid, const std::vector<int>& faces, bool is_void) {
        const auto turned = std::ranges::count_if(shell.faces, &FaceUse::reversed);
        const bool all = turned > 0 && turned == std::ssize(shell.faces);
        std::vector<int> used;
        for (const FaceUse& u : shell.faces) {
            const int face = faces[std::size_t(u.face)];
            used.push_back(u.reversed && !all ? e_.add(text("ORIENTED_FACE('',*,#", face, ",.F.)")) : face);
        }
        const std::string_view kind = solid ? "CLOSED_SHELL(''," : "OPEN_SHELL('',";
        const int id = e_.add(text(kind, Entities::refs(used), ")"));
        if (!all && !(is_void && solid)) return id;
        return e_.add(text("ORIENTED_", kind, "*,#", id, all ? ",.F.)" : ",.T.)"));
    }

    // Its entity; 0 if it has no shells.
    int add_body(const Body& b, const std::vector<int>& shells) {
        if (shells.empty()) return 0;
        if (!b.solid) {
            sheets.push_back(
                e_.add(text("SHELL_BASED_SURFACE_MODEL(", quoted(b.name), ",", Entities::refs(shells), ")")));
            return sheets.back();
        }
        if (shells.size() == 1) {
            solids.push_back(e_.add(text("MANIFOLD_SOLID_BREP(", quoted(b.name), ",#", shells[0], ")")));
        } else {
            solids.push_back(e_.add(text("BREP_WITH_VOIDS(", quoted(b.name), ",#", shells[0], ",",
                                         Entities::refs({shells.begin() + 1, shells.end()}), ")")));
        }
        return solids.back();
    }

    int vertex(int v) {
        int& id = vertices_[std::size_t(v)];
        if (id == 0) {
            const int p = geometry_.point(m_.vertices[std::size_t(v)].point);
            id = e_.add(text("VERTEX_POINT('',#", p, ")"));
        }
        return id;
    }

    // Where a surface folds, a curve in space does not say which part of it is meant. Splines that a reader
    // made to follow an edge have many more control points than it: another will make its own.
    static bool is_worth_writing(const CurveGeometry<2>& image, const CurveGeometry<3>& edge,
                                 const SurfaceGeometry& surface) {
        const auto points = [](const auto& g) -> std::size_t {
            if constexpr (requires { g.net(); })
                return g.net().flat().size();
            else
                return 0;
        };
        const std::size_t n = visit_one(points, image);
        return n > 0 && n <= visit_one(points, edge) && visit_one(points, surface) > 0;
    }

    // The curve in space, or the image of the parameter curve; that is beside it, but without `of_surface`.
    Result<int> curve_of(const Edge& e, const Coedge& c, const SurfaceGeometry& surface, int of_surface) {
        const auto parameters = parameter_spline(c.curve, e.range);
        if (e.curve && parameters && of_surface > 0 && is_worth_writing(c.curve, *e.curve, surface))
            return geometry_.surface_curve(detail::part_of(e), *parameters, of_surface);
        if (e.curve) return geometry_.curve(detail::part_of(e));
        if (!parameters) return std::unexpected(parameters.error());
        if (const auto shape = detail::lifted(*parameters, surface)) return geometry_.curve(*shape);
        const auto image = image_curve(surface, *parameters);
        if (!image)
            return refuse(RefusalKind::unsupported, "",
                          "has no curve in space, and " + image.error().message);
        return of_surface > 0 ? geometry_.surface_curve(*image, *parameters, of_surface)
                              : geometry_.curve(*image);
    }

    Result<int> edge(const Coedge& c, const SurfaceGeometry& surface, int of_surface) {
        int& id = edges_[std::size_t(c.edge)];
        if (id != 0) return id;
        const Edge& e = m_.edges[std::size_t(c.edge)];
        const auto curve = curve_of(e, c, surface, of_surface);
        if (!curve) return refuse_within(text("edges[", c.edge, "]"), curve.error());
        return id = edge_curve(e, *curve);
    }

    int edge_curve(const Edge& e, int curve) {
        const int from = vertex(e.start), to = vertex(e.end);
        const int id =
            e_.add(text("EDGE_CURVE(", quoted(e.name), ",#", from, ",#", to, ",#", curve, ",.T.)"));
        put_on_layers(e.layers, id);
        if (e.colour) styled.push_back(coloured(*e.colour, id, true));
        return id;
    }

    Result<int> face(const Face& f) {
        if (f.loops.empty()) return refuse(RefusalKind::unsupported, "loops", "a face without boundary");
        const auto once = detail::one_turn(m_, f);
        const auto surface = geometry_.surface(once.value_or(f.surface));
        if (!surface) return surface;
        std::vector<int> bounds, seams;
        const std::vector<Loop> loops = detail::without_seams(m_, f, seams);
        for (const int i : seams) edges_[std::size_t(i)] = -1;
        if (loops.empty())
            return refuse(RefusalKind::unsupported, "loops",
                          "are seams alone, which have no curves in space");
        for (const Loop& l : loops) {
            std::vector<int> around;
            int pole = -1;
            for (const Coedge& c : l.coedges) {
                const Edge& e = m_.edges[std::size_t(c.edge)];
                if (e.degenerate) {
                    pole = e.start;
                    continue;
                }
                const auto id = edge(c, f.surface, once ? 0 : *surface);
                if (!id) return id;
                around.push_back(e_.add(text("ORIENTED_EDGE('',*,*,#", *id, c.reversed ? ",.F.)" : ",.T.)")));
            }
            const int loop = around.empty() ? e_.add(text("VERTEX_LOOP('',#", vertex(pole), ")"))
                                            : e_.add(text("EDGE_LOOP('',", Entities::refs(around), ")"));
            bounds.push_back(e_.add(text(loops.size() == 1 ? "FACE_OUTER_BOUND('',#" : "FACE_BOUND('',#",
                                         loop, f.reversed ? ",.F.)" : ",.T.)")));
        }
        return e_.add(text("ADVANCED_FACE(", quoted(f.name), ",", Entities::refs(bounds), ",#", *surface,
                           f.reversed ? ",.F.)" : ",.T.)"));
    }

    Entities& e_;
    StepGeometry geometry_;
    const Model& m_;
    std::vector<int> vertices_, edges_;                           // their entities, 0 until they are written
    std::vector<std::vector<int>> on_layers_;                     // the entities of each
    std::array<std::map<std::array<double, 3>, int>, 2> styles_;  // of surfaces, of curves
};

// What a file says of all its lengths is what is true of every edge and face; the gaps of single ones are
// found again by those who read it.
constexpr double kAccurate = 1e-7;
double least_tolerance(const Model& m) {
    double least = kInfinity;
    for (const Edge& e : m.edges)
        if (e.curve) least = std::min(least, e.tolerance);
    for (const Face& f : m.faces) least = std::min(least, f.tolerance);
    return least;
}

}  // namespace

Result<std::string> write_step(const Document& given) {
    Document document = given;
    for (std::size_t i = 0; i < document.objects.size(); ++i)
        if (auto* t = std::get_if<TrimmedSurface>(&document.objects[i].shape)) {
            auto turned = detail::oriented_loops(*t);
            if (!turned) return refuse_within(object_label(document, i), turned.error());
            t->loops = std::move(turned->loops);
        }
    Entities entities;
    StepGeometry geometry(entities);
    std::vector<std::size_t> with_faces, wires;
    std::vector<int> curves;
    for (std::size_t i = 0; i < document.objects.size(); ++i) {
        const Object& o = document.objects[i];
        const auto done = visit_one(
            [&](const auto& s) -> Result<void> {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (std::same_as<S, Model>) {
                    (s.faces.empty() && !s.edges.empty() ? wires : with_faces).push_back(i);
                    return {};
                } else if constexpr (std::same_as<S, TrimmedSurface>) {
                    with_faces.push_back(i);
                    return {};
                } else if constexpr (S::Point::kCoords == 2 || S::Point::kCoords == 3) {
                    if constexpr (TensorPatch<S>) {
                        if constexpr (S::kParams == 1) {
                            const auto id = geometry.one(in_space(s));
                            if (!id) return std::unexpected(id.error());
                            curves.push_back(*id);
                            return {};
                        } else if constexpr (S::kParams == 2) {
                            with_faces.push_back(i);
                            return {};
                        }
                    }
                }
                return refuse(
                    RefusalKind::unsupported, "",
                    text("is a ", type_name(o.shape),
                         "; STEP files hold curves and surfaces of two or three coordinates, and models"));
            },
            o.shape);
        if (!done) return refuse_within(object_label(document, i), done.error());
    }
    if (with_faces.empty() && wires.empty() && curves.empty())
        return refuse(RefusalKind::no_answer, "objects", "there is nothing to write");
    std::string unit = document.unit;
    std::vector<int> solids, sheets, wireframes, styled;
    double uncertainty = kInfinity;
    if (!with_faces.empty()) {
        const auto model = scene_of(document, with_faces);
        if (!model) return std::unexpected(model.error());
        if (unit.empty()) unit = model->unit;
        uncertainty = std::min(uncertainty, least_tolerance(*model));
        StepModel writer(entities, *model);
        if (auto ok = writer.write(); !ok) return std::unexpected(ok.error());
        if (auto ok = writer.write_wires(""); !ok) return std::unexpected(ok.error());
        writer.write_layers();
        solids = writer.solids, sheets = writer.sheets, styled = writer.styled;
        wireframes = writer.wireframes;
    }
    for (const std::size_t i : wires) {
        const Model& model = std::get<Model>(document.objects[i].shape);
        if (unit.empty()) unit = model.unit;
        if (!model.unit.empty() && model.unit != unit)
            return refuse(
                RefusalKind::unsupported, object_label(document, i),
                text("a model in ", model.unit, " cannot be written to one file with others in ", unit));
        uncertainty = std::min(uncertainty, least_tolerance(model));
        StepModel writer(entities, model);
        if (auto ok = writer.write_wires(document.objects[i].name); !ok)
            return refuse_within(object_label(document, i), ok.error());
        writer.write_layers();
        wireframes.insert(wireframes.end(), writer.wireframes.begin(), writer.wireframes.end());
        styled.insert(styled.end(), writer.styled.begin(), writer.styled.end());
    }
    const std::string_view name = document.objects[0].name;
    if (!std::isfinite(uncertainty)) uncertainty = kAccurate;
    Product product(entities, unit, std::max(uncertainty, kAccurate));
    product.add("ADVANCED_BREP_SHAPE_REPRESENTATION", name, solids);
    product.add("MANIFOLD_SURFACE_SHAPE_REPRESENTATION", name, sheets);
    product.add("EDGE_BASED_WIREFRAME_SHAPE_REPRESENTATION", name, wireframes);
    product.style(styled);
    if (!curves.empty()) {
        const int set = entities.add(text("GEOMETRIC_CURVE_SET('',", Entities::refs(curves), ")"));
        product.add("GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION", name, {set});
    }
    return text("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME(", quoted(name),
                ",'',(''),(''),'freiform','freiform','');\nFILE_SCHEMA(('AP242_MANAGED_MODEL_BASED_3D_"
                "ENGINEERING_MIM_LF "
                "{ 1 0 10303 442 1 1 4 }'));\nENDSEC;\nDATA;\n",
                entities.out, "ENDSEC;\nEND-ISO-10303-21;\n");
}

}  // namespace freiform

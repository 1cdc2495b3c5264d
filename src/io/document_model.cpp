// Solid models of a document, and the curves and surfaces that only models and trimmed surfaces have.
#include "document_detail.hpp"

#include <freiform/core/visit.hpp>

namespace freiform::document_detail {

namespace {

// The index of a name in a list of names.
template <std::size_t K>
auto one_of(const std::string_view (&names)[K]) {
    return [&names](json::Value v) -> Result<int> {
        const auto s = read_string(v);
        if (!s) return std::unexpected(s.error());
        for (std::size_t i = 0; i < K; ++i)
            if (names[i] == *s) return int(i);
        return expected(text(listed(names), did_you_mean(*s, names)), v);
    };
}

template <int D>
Result<CurveGeometry<D>> read_analytic(json::Value v, std::string_view type) {
    if (type == "line") {
        static constexpr std::string_view kFields[] = {"type", "origin", "direction"};
        const auto f = Fields::read(v, "a line", kFields);
        if (!f) return std::unexpected(f.error());
        const auto origin = f->get("origin", read_vec<D>), direction = f->get("direction", read_vec<D>);
        if (!origin) return std::unexpected(origin.error());
        if (!direction) return std::unexpected(direction.error());
        return Line<D>{*origin, *direction};
    }
    static constexpr std::string_view kFields[] = {"type", "centre", "x", "y"};
    const auto f = Fields::read(v, text("the curve \"", type, "\""), kFields);
    if (!f) return std::unexpected(f.error());
    const auto centre = f->get("centre", read_vec<D>), x = f->get("x", read_vec<D>),
               y = f->get("y", read_vec<D>);
    for (const auto* part : {&centre, &x, &y})
        if (!*part) return std::unexpected(part->error());
    const auto kind = type == kConicNames[0]   ? ConicKind::ellipse
                      : type == kConicNames[1] ? ConicKind::hyperbola
                                               : ConicKind::parabola;
    return Conic<D>{kind, *centre, *x, *y};
}

template <int D>
Result<CurveGeometry<D>> read_curve_geometry(json::Value v) {
    static constexpr std::string_view kKnown[] = {"curve", "line", "ellipse", "hyperbola", "parabola"};
    const auto type = read_type(v, "curve", kKnown);
    if (!type) return std::unexpected(type.error());
    if (*type != "curve") {
        auto curve = read_analytic<D>(v, *type);
        if (!curve) return curve;
        if (auto ok = check(*curve); !ok) {  // names the kind first, which the path has already
            Refusal r = ok.error();
            const std::size_t dot = r.where.find('.');
            r.where = dot == std::string::npos ? "" : r.where.substr(dot + 1);
            return std::unexpected(std::move(r));
        }
        return curve;
    }
    auto patch = read_patch<1>(v);
    if (!patch) return std::unexpected(patch.error());
    if (auto* c = std::get_if<Curve<Vec<D>>>(&patch->shape)) return std::move(*c);
    if (auto* c = std::get_if<Curve<Hom<D>>>(&patch->shape)) return std::move(*c);
    return refuse(RefusalKind::invalid, "points", text("the points need ", D, " coordinates here"));
}

Result<std::variant<Surface<Vec<3>>, Surface<Hom<3>>>> read_space_patch(json::Value v) {
    auto patch = read_patch<2>(v);
    if (!patch) return std::unexpected(patch.error());
    if (auto* s = std::get_if<Surface<Vec<3>>>(&patch->shape)) return std::move(*s);
    if (auto* s = std::get_if<Surface<Hom<3>>>(&patch->shape)) return std::move(*s);
    return refuse(RefusalKind::invalid, "points", "the points need 3 coordinates here");
}

Result<SurfaceGeometry> read_swept(json::Value v, bool revolution) {
    static constexpr std::string_view kExtrusion[] = {"type", "profile", "direction", "kind"};
    static constexpr std::string_view kRevolution[] = {"type", "profile", "origin", "axis", "kind"};
    const auto f = revolution ? Fields::read(v, "a surface of revolution", kRevolution)
                              : Fields::read(v, "an extrusion", kExtrusion);
    if (!f) return std::unexpected(f.error());
    auto profile = f->get("profile", read_space_curve);
    if (!profile) return std::unexpected(profile.error());
    const auto kind = f->get_or("kind", one_of(kSurfaceKinds), 0);
    if (!kind) return std::unexpected(kind.error());
    const auto direction = f->get(revolution ? "axis" : "direction", read_vec<3>);
    if (!direction) return std::unexpected(direction.error());
    if (!revolution) return Extrusion{std::move(*profile), *direction, SurfaceKind(*kind)};
    const auto origin = f->get("origin", read_vec<3>);
    if (!origin) return std::unexpected(origin.error());
    return Revolution{std::move(*profile), *origin, *direction, SurfaceKind(*kind)};
}

Result<SurfaceGeometry> read_offset(json::Value v);

// An offset's base is read by the same function without the offset among the types: no recursion on data.
Result<SurfaceGeometry> read_surface(json::Value v, bool may_be_offset) {
    static constexpr std::string_view kKnown[] = {"surface", "extrusion", "revolution", "offset"};
    const auto type = read_type(v, "surface", std::span(kKnown).first(may_be_offset ? 4 : 3));
    if (!type) return std::unexpected(type.error());
    if (*type == "offset") return read_offset(v);
    if (*type != "surface") {
        auto swept = read_swept(v, *type == "revolution");
        if (!swept) return swept;
        if (auto ok = check(*swept); !ok) {
            Refusal r = ok.error();
            const std::size_t dot = r.where.find('.');
            r.where = dot == std::string::npos ? "" : r.where.substr(dot + 1);
            return std::unexpected(std::move(r));
        }
        return swept;
    }
    auto patch = read_space_patch(v);
    if (!patch) return std::unexpected(patch.error());
    return visit_one([](auto&& s) { return SurfaceGeometry(std::move(s)); }, std::move(*patch));
}

Result<SurfaceGeometry> read_offset(json::Value v) {
    static constexpr std::string_view kFields[] = {"type", "base", "distance"};
    const auto f = Fields::read(v, "an offset surface", kFields);
    if (!f) return std::unexpected(f.error());
    auto base = f->get("base", [](json::Value b) { return read_surface(b, false); });
    if (!base) return std::unexpected(base.error());
    const auto distance = f->get("distance", read_number);
    if (!distance) return std::unexpected(distance.error());
    return OffsetSurface{std::make_shared<const SurfaceGeometry>(std::move(*base)), *distance};
}

// Puts what was read into its place; false, with the refusal, if there is none. For the many fields of a
// model.
class Into {
public:
    template <class T, class Read>
    Into& field(const Fields& f, std::string_view key, T& place, Read&& read) {
        if (refusal_ || !f.has(key)) return *this;
        return needed(f, key, place, std::forward<Read>(read));
    }
    template <class T, class Read>
    Into& needed(const Fields& f, std::string_view key, T& place, Read&& read) {
        if (refusal_) return *this;
        auto x = f.get(key, std::forward<Read>(read));
        if (x)
            place = std::move(*x);
        else
            refusal_ = std::move(x.error());
        return *this;
    }
    template <class T>
    Result<T> give(T value) {
        if (refusal_) return std::unexpected(std::move(*refusal_));
        return value;
    }

private:
    std::optional<Refusal> refusal_;
};

template <class T, std::size_t K, class Fill>
Result<T> read_entity(json::Value v, std::string_view what, const std::string_view (&allowed)[K],
                      Fill&& fill) {
    const auto f = Fields::read(v, what, allowed);
    if (!f) return std::unexpected(f.error());
    T entity;
    Into into;
    fill(into, *f, entity);
    return into.give(std::move(entity));
}

constexpr std::string_view kVertexFields[] = {"point", "tolerance"};
constexpr std::string_view kEdgeFields[] = {"curve",     "degenerate", "range",  "start", "end",
                                            "tolerance", "name",       "colour", "layers"};
constexpr std::string_view kCoedgeFields[] = {"edge", "reversed", "curve"};
constexpr std::string_view kFaceFields[] = {"surface", "reversed", "loops", "tolerance",
                                            "name",    "colour",   "layers"};
constexpr std::string_view kFaceUseFields[] = {"face", "reversed"};
constexpr std::string_view kShellFields[] = {"faces", "closed"};
constexpr std::string_view kBodyFields[] = {"shells", "solid", "name", "colour", "layers"};
constexpr std::string_view kRefusedFields[] = {"kind", "where", "message"};
constexpr std::string_view kApproximationFields[] = {"where", "what", "bound", "estimate"};
constexpr std::string_view kLayerFields[] = {"name", "description"};
constexpr std::string_view kRepairFields[] = {"where", "what", "distance"};
constexpr std::string_view kModelFields[] = {"type",    "name",           "unit",   "vertices",
                                             "edges",   "faces",          "shells", "bodies",
                                             "refused", "approximations", "layers", "repairs"};
constexpr std::string_view kRefusalKinds[] = {
    "invalid", "nonfinite",     "out_of_domain",   "unreadable", "unsupported", "unavailable",
    "limit",   "not_converged", "ill_conditioned", "no_answer",  "io"};

Result<Vertex> read_vertex(json::Value v) {
    return read_entity<Vertex>(v, "a vertex", kVertexFields, [](Into& in, const Fields& f, Vertex& x) {
        in.needed(f, "point", x.point, read_vec<3>).field(f, "tolerance", x.tolerance, read_number);
    });
}

Result<std::vector<int>> read_indices(json::Value v) { return read_list(v, read_int); }

Result<Edge> read_edge(json::Value v) {
    return read_entity<Edge>(v, "an edge", kEdgeFields, [](Into& in, const Fields& f, Edge& x) {
        Vec<2> range{{0, 1}};
        in.field(f, "curve", x.curve, read_space_curve)
            .field(f, "degenerate", x.degenerate, read_bool)
            .field(f, "range", range, read_vec<2>)
            .needed(f, "start", x.start, read_int)
            .needed(f, "end", x.end, read_int)
            .field(f, "tolerance", x.tolerance, read_number)
            .field(f, "name", x.name, read_string)
            .field(f, "colour", x.colour, read_colour)
            .field(f, "layers", x.layers, read_indices);
        x.range = {range[0], range[1]};
    });
}

// A coedge has no curve of its own to begin with, so it is built from its fields.
Result<Coedge> read_coedge(json::Value v) {
    const auto f = Fields::read(v, "a coedge", kCoedgeFields);
    if (!f) return std::unexpected(f.error());
    const auto edge = f->get("edge", read_int);
    if (!edge) return std::unexpected(edge.error());
    const auto reversed = f->get_or("reversed", read_bool, false);
    if (!reversed) return std::unexpected(reversed.error());
    auto curve = f->get("curve", read_plane_curve);
    if (!curve) return std::unexpected(curve.error());
    return Coedge{*edge, *reversed, std::move(*curve)};
}

Result<Loop> read_loop(json::Value v) {
    auto coedges = read_list(v, read_coedge);
    if (!coedges) return std::unexpected(coedges.error());
    return Loop{std::move(*coedges)};
}

Result<Face> read_face(json::Value v) {
    return read_entity<Face>(v, "a face", kFaceFields, [](Into& in, const Fields& f, Face& x) {
        in.needed(f, "surface", x.surface, read_surface_geometry)
            .field(f, "reversed", x.reversed, read_bool)
            .field(f, "loops", x.loops, [](json::Value l) { return read_list(l, read_loop); })
            .field(f, "tolerance", x.tolerance, read_number)
            .field(f, "name", x.name, read_string)
            .field(f, "colour", x.colour, read_colour)
            .field(f, "layers", x.layers, read_indices);
    });
}

Result<FaceUse> read_face_use(json::Value v) {
    return read_entity<FaceUse>(
        v, "a use of a face", kFaceUseFields, [](Into& in, const Fields& f, FaceUse& x) {
            in.needed(f, "face", x.face, read_int).field(f, "reversed", x.reversed, read_bool);
        });
}

Result<Shell> read_shell(json::Value v) {
    return read_entity<Shell>(v, "a shell", kShellFields, [](Into& in, const Fields& f, Shell& x) {
        in.needed(f, "faces", x.faces, [](json::Value l) {
              return read_list(l, read_face_use);
          }).field(f, "closed", x.closed, read_bool);
    });
}

Result<Body> read_body(json::Value v) {
    return read_entity<Body>(v, "a body", kBodyFields, [](Into& in, const Fields& f, Body& x) {
        in.needed(f, "shells", x.shells, read_indices)
            .field(f, "solid", x.solid, read_bool)
            .field(f, "name", x.name, read_string)
            .field(f, "colour", x.colour, read_colour)
            .field(f, "layers", x.layers, read_indices);
    });
}

Result<Refusal> read_refusal(json::Value v) {
    return read_entity<Refusal>(v, "a refusal", kRefusedFields, [](Into& in, const Fields& f, Refusal& x) {
        int kind = 0;
        in.needed(f, "kind", kind, one_of(kRefusalKinds))
            .field(f, "where", x.where, read_string)
            .needed(f, "message", x.message, read_string);
        x.kind = RefusalKind(kind);
    });
}

Result<Approximation> read_approximation(json::Value v) {
    return read_entity<Approximation>(v, "an approximation", kApproximationFields,
                                      [](Into& in, const Fields& f, Approximation& x) {
                                          in.field(f, "where", x.where, read_string)
                                              .needed(f, "what", x.what, read_string)
                                              .field(f, "estimate", x.estimate, read_number);
                                          if (f.has("bound") || !f.has("estimate"))
                                              in.needed(f, "bound", x.bound, read_number);
                                      });
}

Result<Layer> read_layer(json::Value v) {
    return read_entity<Layer>(v, "a layer", kLayerFields, [](Into& in, const Fields& f, Layer& x) {
        in.needed(f, "name", x.name, read_string).field(f, "description", x.description, read_string);
    });
}

Result<Repair> read_repair(json::Value v) {
    return read_entity<Repair>(v, "a repair", kRepairFields, [](Into& in, const Fields& f, Repair& x) {
        in.field(f, "where", x.where, read_string)
            .needed(f, "what", x.what, read_string)
            .field(f, "distance", x.distance, read_number);
    });
}

}  // namespace

Result<CurveGeometry<2>> read_plane_curve(json::Value v) { return read_curve_geometry<2>(v); }
Result<CurveGeometry<3>> read_space_curve(json::Value v) { return read_curve_geometry<3>(v); }
Result<SurfaceGeometry> read_surface_geometry(json::Value v) { return read_surface(v, true); }

Result<Shape> read_trimmed(json::Value v) {
    static constexpr std::string_view kFields[] = {"type", "name", "surface", "loops"};
    const auto f = Fields::read(v, "a trimmed surface", kFields);
    if (!f) return std::unexpected(f.error());
    auto surface =
        f->get("surface", [](json::Value s) -> Result<std::variant<Surface<Vec<3>>, Surface<Hom<3>>>> {
            static constexpr std::string_view kKnown[] = {"surface"};
            if (const auto type = read_type(s, "surface", kKnown); !type)
                return std::unexpected(type.error());
            return read_space_patch(s);
        });
    if (!surface) return std::unexpected(surface.error());
    auto loops = f->get("loops", [](json::Value l) {
        return read_list(l, [](json::Value loop) { return read_list(loop, read_plane_curve); });
    });
    if (!loops) return std::unexpected(loops.error());
    auto trimmed = TrimmedSurface::make(std::move(*surface), std::move(*loops));
    if (!trimmed) {  // in a document this is invalid, not a question about a parameter
        Refusal r = trimmed.error();
        if (r.kind == RefusalKind::out_of_domain) r.kind = RefusalKind::invalid;
        return std::unexpected(std::move(r));
    }
    return std::move(*trimmed);
}

Result<Shape> read_model(json::Value v) {
    auto m = read_entity<Model>(v, "a model", kModelFields, [](Into& in, const Fields& f, Model& x) {
        const auto list = [](auto&& read) { return [&read](json::Value l) { return read_list(l, read); }; };
        in.field(f, "unit", x.unit, read_string)
            .field(f, "vertices", x.vertices, list(read_vertex))
            .field(f, "edges", x.edges, list(read_edge))
            .needed(f, "faces", x.faces, list(read_face))
            .field(f, "shells", x.shells, list(read_shell))
            .field(f, "bodies", x.bodies, list(read_body))
            .field(f, "refused", x.refused, list(read_refusal))
            .field(f, "approximations", x.approximations, list(read_approximation))
            .field(f, "layers", x.layers, list(read_layer))
            .field(f, "repairs", x.repairs, list(read_repair));
    });
    if (!m) return std::unexpected(m.error());
    auto checked = make_model(std::move(*m));
    if (!checked) {
        Refusal r = checked.error();
        if (r.kind == RefusalKind::out_of_domain) r.kind = RefusalKind::invalid;
        return std::unexpected(std::move(r));
    }
    return std::move(*checked);
}

}  // namespace freiform::document_detail

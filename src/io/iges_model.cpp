// Idea. Vertices and edges of a model are lists (502, 504) that its loops (508) refer to by index, so what
// was watertight stays so:
//
//     186 solid -> 514 shell -> 510 face -> 508 loop -> 504 edges -> 502 vertices
//
// Edges are lines (110), arcs of circles and ellipses (100, 104) and splines, parts of other conics as
// rational ones. Flat surfaces are 190, revolutions and circular cylinders 120, offsets 140, all others
// splines (128), of extrusions exact ones over what the face uses of them. Loops have curves in the
// parameters, too, where the parameters of the entity are ours or linear in them, of edges as well: those who
// read have to guess at seams otherwise, and lose what lies across. Flat faces need none. Parabolas and
// hyperbolas, ellipses all of which is an edge that begins elsewhere than at an axis, and extrusions of all
// conics but circles have parameters of their own.
//
// Orientation. Loops run counter-clockwise about the normal of the surface; a shell says which of its faces
// are turned. Revolutions are parametrised by the profile first, ours by the angle: about the opposite axis
// the normals are the same.
//
// References: the Initial Graphics Exchange Specification, version 5.3, 4.3, 4.5, 4.13, 4.18, 4.21,
// 4.32, 4.49, 4.111 and 4.144 to 4.151.
// Why not 144 for each face: nothing then says that faces share edges, and every reader guesses.
#include "iges_arcs.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/make/image_curve.hpp>
#include <freiform/spline/transform.hpp>

namespace freiform::detail {

namespace {

// What a parameter curve covers, or somewhat more.
void add_extent(Box<2>& box, const CurveGeometry<2>& curve, Interval on) {
    visit_one(
        [&](const auto& c) {
            using C = std::remove_cvref_t<decltype(c)>;
            if constexpr (std::same_as<C, Line<2>>) {
                for (const double t : {on.lo, on.hi}) box.add(c.origin + t * c.direction);
            } else if constexpr (std::same_as<C, Conic<2>>) {
                if (const auto arc = parameter_spline(curve, on)) add_extent(box, *arc, {0, 1});
            } else {
                for (const auto& p : c.net().flat()) box.add(project(p));
            }
        },
        curve);
}

// A surface in the file, and where our parameters are in its own, if linear maps tell.
struct WrittenSurface {
    int entry = 0;
    std::optional<Affinity<2>> parameters;
};
constexpr Affinity<2> kSameParameters{{{{1, 0}, {0, 1}}}, {}};

class IgesModel {
public:
    IgesModel(IgesFile& file, const Model& model)
        : file_(file),
          m_(model),
          rational_(model.edges.size()),
          curves_(model.edges.size()),
          index_(model.edges.size()) {}

    Result<void> write() {
        for (const Face& f : m_.faces) find_conics(f);
        for (std::size_t f = 0; f < m_.faces.size(); ++f)
            if (auto ok = find_edges(m_.faces[f]); !ok)
                return refuse_within(text("faces[", f, "]"), ok.error());
        vertices_ = lists();
        std::vector<int> faces;
        for (std::size_t f = 0; f < m_.faces.size(); ++f) {
            const auto id = face(m_.faces[f]);
            if (!id) return refuse_within(text("faces[", f, "]"), id.error());
            faces.push_back(*id);
        }
        for (const Body& b : m_.bodies) add(b, faces);
        return {};
    }

private:
    static bool is_turned(const Face& f) {
        const auto* offset = std::get_if<OffsetSurface>(&f.surface);
        const SurfaceGeometry& s = offset != nullptr ? *offset->base : f.surface;
        return std::holds_alternative<Extrusion>(s) || std::holds_alternative<Revolution>(s);
    }

    // Conics in the parameters of splines become rational; so do their edges then.
    void find_conics(const Face& f) {
        if (is_turned(f)) return;
        for (const Loop& l : f.loops)
            for (const Coedge& c : l.coedges)
                if (std::holds_alternative<Conic<2>>(c.curve)) rational_[std::size_t(c.edge)] = true;
    }

    // The curves of all edges, each once.
    Result<void> find_edges(const Face& f) {
        if (f.loops.empty()) return refuse(RefusalKind::unsupported, "loops", "a face without boundary");
        for (const Loop& l : f.loops)
            for (const Coedge& c : l.coedges) {
                const Edge& e = m_.edges[std::size_t(c.edge)];
                int& id = curves_[std::size_t(c.edge)];
                if (e.degenerate || id != 0) continue;
                const auto made = edge(e, c, f.surface);
                if (!made) return refuse_within(text("edges[", c.edge, "]"), made.error());
                id = *made;
            }
        return {};
    }

    Result<int> edge(const Edge& e, const Coedge& c, const SurfaceGeometry& surface) {
        if (e.curve)
            return rational_[std::size_t(c.edge)] ? as_spline(*e.curve, e.range) : part(*e.curve, e.range);
        const auto flat = parameter_spline(c.curve, e.range);
        if (!flat) return std::unexpected(flat.error());
        const auto image = image_curve(surface, *flat);
        if (!image) return std::unexpected(image.error());
        return spline<3>(*image);
    }

    Result<int> part(const CurveGeometry<3>& curve, Interval on) {
        if (const auto* l = std::get_if<Line<3>>(&curve)) return add_line(file_, *l, on);
        if (keeps_parameters(curve, on)) {
            if (const auto* c = std::get_if<Conic<3>>(&curve)) return add_arc(file_, *c, on).entry;
        }
        return as_spline(curve, on);
    }

    Result<int> as_spline(const CurveGeometry<3>& curve, Interval on) {
        const auto made = space_spline(curve, on);
        if (!made) return std::unexpected(made.error());
        return spline<3>(*made);
    }

    template <int D>
    Result<int> spline(const CurveGeometry<D>& curve, IgesUse use = IgesUse::part) {
        return visit_one(
            [&](const auto& x) -> Result<int> {
                if constexpr (requires { x.net(); })
                    return file_.add(x, use);
                else
                    return refuse(RefusalKind::unsupported, "", "a curve that is no spline");
            },
            curve);
    }

    // In the parameters of the file, as the loop runs, which is not always as the edge does.
    static Result<CurveGeometry<2>> along_loop(const CurveGeometry<2>& curve, const Affinity<2>& parameters,
                                               bool reversed) {
        return visit_one(
            [&](const auto& c) -> Result<CurveGeometry<2>> {
                if constexpr (requires { c.net(); }) {
                    const auto mapped = transform(c, parameters);
                    if (!mapped) return std::unexpected(mapped.error());
                    return reversed ? reverse(mapped->patch, 0) : mapped->patch;
                } else {
                    return c;
                }
            },
            curve);
    }

    // The lists of vertices and of edges; returns the first.
    int lists() {
        std::vector<std::string> points = {text(m_.vertices.size())};
        for (const Vertex& v : m_.vertices)
            for (const double x : v.point.c) points.push_back(real(x));
        const int vertices = file_.entity("502", IgesUse::part, points, 1);
        std::vector<std::string> edges = {""};
        int count = 0;
        for (std::size_t e = 0; e < m_.edges.size(); ++e) {
            if (curves_[e] == 0) continue;
            index_[e] = ++count;
            edges.push_back(text(curves_[e]));
            for (const int end : {m_.edges[e].start, m_.edges[e].end})
                edges.push_back(text(vertices)), edges.push_back(text(end + 1));
        }
        edges[0] = text(count);
        edges_ = file_.entity("504", IgesUse::part, edges, 1);
        return vertices;
    }

    Result<int> loop(const Loop& l, const std::optional<Affinity<2>>& parameters) {
        std::vector<std::string> values = {text(l.coedges.size())};
        for (const Coedge& c : l.coedges) {
            const Edge& e = m_.edges[std::size_t(c.edge)];
            const std::array<int, 4> entry =
                e.degenerate ? std::array{1, vertices_, e.start + 1, 1}
                             : std::array{0, edges_, index_[std::size_t(c.edge)], c.reversed ? 0 : 1};
            for (const int x : entry) values.push_back(text(x));
            if (!parameters) {
                values.emplace_back("0");
                continue;
            }
            const auto flat = parameter_spline(c.curve, e.range);
            if (!flat) return std::unexpected(flat.error());
            const auto along = along_loop(*flat, *parameters, c.reversed);
            if (!along) return std::unexpected(along.error());
            const auto id = spline<2>(*along, IgesUse::parameters);
            if (!id) return id;
            for (const int x : {1, 0, *id}) values.push_back(text(x));
        }
        return file_.entity("508", IgesUse::part, values, 1);
    }

    Result<int> face(const Face& f) {
        Box<2> used;
        for (const Loop& l : f.loops)
            for (const Coedge& c : l.coedges) add_extent(used, c.curve, m_.edges[std::size_t(c.edge)].range);
        const auto surface = visit_one([&](const auto& s) { return one(s, used); }, f.surface);
        if (!surface) return std::unexpected(surface.error());
        std::vector<std::string> values = {text(surface->entry), text(f.loops.size()),
                                           f.loops.size() == 1 ? "1" : "0"};
        // Those who read find curves to edges with parameters of their own better.
        const auto is_own = [&](const Coedge& c) {
            const Edge& e = m_.edges[std::size_t(c.edge)];
            return std::holds_alternative<Conic<2>>(c.curve) ||
                   (e.curve && (rational_[std::size_t(c.edge)] || !keeps_parameters(*e.curve, e.range)));
        };
        const bool own = is_turned(f) && std::ranges::any_of(f.loops, [&](const Loop& l) {
                             return std::ranges::any_of(l.coedges, is_own);
                         });
        for (const Loop& l : f.loops) {
            const auto id = loop(l, own ? std::nullopt : surface->parameters);
            if (!id) return id;
            values.push_back(text(*id));
        }
        const IgesLook look = file_.look(f.colour, f.name);
        return file_.entity("510", IgesUse::part, values, 1, 0, look);
    }

    void add(const Body& b, const std::vector<int>& faces) {
        std::vector<int> shells;
        for (const int s : b.shells) {
            const Shell& shell = m_.shells[std::size_t(s)];
            std::vector<std::string> values = {text(shell.faces.size())};
            for (const FaceUse& u : shell.faces) {
                const std::size_t f = std::size_t(u.face);
                values.push_back(text(faces[f]));
                values.emplace_back(m_.faces[f].reversed != u.reversed ? "0" : "1");
            }
            const IgesLook look = b.solid ? IgesLook{} : file_.look(b.colour, b.name);
            shells.push_back(file_.entity("514", b.solid ? IgesUse::part : IgesUse::alone, values,
                                          b.solid ? 1 : 2, 0, look));
        }
        if (!b.solid || shells.empty()) return;
        std::vector<std::string> values = {text(shells[0]), "1", text(shells.size() - 1)};
        for (std::size_t i = 1; i < shells.size(); ++i)
            values.push_back(text(shells[i])), values.emplace_back("1");
        const IgesLook look = file_.look(b.colour, b.name);
        file_.entity("186", IgesUse::alone, values, 0, 0, look);
    }

    static Result<WrittenSurface> written(const Result<int>& entry,
                                          const std::optional<Affinity<2>>& parameters) {
        if (!entry) return std::unexpected(entry.error());
        return WrittenSurface{*entry, parameters};
    }

    template <class P>
    Result<WrittenSurface> one(const Surface<P>& s, const Box<2>&) {
        return written(file_.add(s, IgesUse::part), kSameParameters);
    }

    Result<WrittenSurface> one(const Extrusion& s, const Box<2>& used) {
        if (const auto* line = std::get_if<Line<3>>(&s.profile)) {
            const Vec<3> n = cross(line->direction, s.direction);
            const auto triple = [](const Vec<3>& v) {
                return std::vector{real(v[0]), real(v[1]), real(v[2])};
            };
            std::vector<std::string> at = triple(line->origin);
            at.emplace_back("0");
            const int point = file_.entity("116", IgesUse::part, at);
            const int normal = file_.entity("123", IgesUse::part, triple((1 / norm(n)) * n));
            return written(file_.entity("190", IgesUse::part, {text(point), text(normal)}), {});
        }
        const Vec<3> lo = used.side(1).lo * s.direction, hi = used.side(1).hi * s.direction;
        if (const auto* c = std::get_if<Conic<3>>(&s.profile);
            c && c->kind == ConicKind::ellipse && is_round(by_axes(*c).conic)) {
            const Vec<3> n = cross(c->x, c->y);
            if (norm(cross(n, s.direction)) <= 16 * kUnitRoundoff * norm(n) * norm(s.direction))
                return turned(Line<3>{c->centre + c->x, s.direction}, c->centre, n, used);
        }
        const bool conic = std::holds_alternative<Conic<3>>(s.profile);  // of it the angles that are used
        const Interval angles{used.side(0).lo, std::min(used.side(0).hi, used.side(0).lo + kTwoPi)};
        const auto profile = space_spline(s.profile, conic ? angles : domain(s.profile)[0]);
        if (!profile) return std::unexpected(profile.error());
        return visit_one(
            [&](const auto& c) -> Result<WrittenSurface> {
                if constexpr (requires { c.net(); }) {
                    using P = typename std::remove_cvref_t<decltype(c)>::Coefficients;
                    std::vector<P> rows;
                    for (const P& p : c.net().flat())
                        for (const Vec<3>& by : {lo, hi})
                            if constexpr (Space<P>::kRational)
                                rows.push_back(weighted(project(p) + by, p.weight()));
                            else
                                rows.push_back(p + by);
                    const auto across = BSplineBasis::bezier(1, used.side(1));
                    if (!across) return std::unexpected(across.error());
                    const auto made =
                        Surface<P>::make({c.basis(), *across}, Net<2, P>({int(rows.size()) / 2, 2}, rows));
                    if (!made) return std::unexpected(made.error());
                    return written(file_.add(*made, IgesUse::part),
                                   conic ? std::nullopt : std::optional(kSameParameters));
                } else {
                    return refuse(RefusalKind::unsupported, "", "an extrusion of a line");
                }
            },
            *profile);
    }

    Result<WrittenSurface> one(const Revolution& s, const Box<2>& used) {
        return turned(s.profile, s.origin, s.axis, used);
    }

    // By the normal of the base where its parameters begin; distances against it are negative.
    Result<WrittenSurface> one(const OffsetSurface& s, const Box<2>& used) {
        const auto base = visit_one([&](const auto& x) { return one(x, used); }, *s.base);
        if (!base) return base;
        auto on = domain(*s.base);
        for (int d = 0; d < 2; ++d)
            if (!std::isfinite(on[std::size_t(d)].length())) on[std::size_t(d)] = used.side(d);
        Vec<3> n = normal(*s.base, Param<2>{{on[0].lo, on[1].lo}});
        if (!(norm(n) > 0)) n = normal(*s.base, Param<2>{{on[0].hi, on[1].hi}});
        if (!(norm(n) > 0))
            return refuse(RefusalKind::unsupported, "",
                          "an offset of a surface without normals where it begins and ends; STEP files have "
                          "them");
        std::vector<std::string> values;
        for (const double x : n.c) values.push_back(real(x));
        values.push_back(real(s.distance)), values.push_back(text(base->entry));
        return written(file_.entity("140", IgesUse::part, values), base->parameters);
    }

    // The profile turned once about the axis: its angle, from the opposite axis, is the second parameter.
    Result<WrittenSurface> turned(const CurveGeometry<3>& profile, const Vec<3>& origin, const Vec<3>& axis,
                                  const Box<2>& used) {
        const int about = add_line(file_, {origin, (-1 / norm(axis)) * axis}, {0, 1});
        const Interval on = used.side(1);
        const double middle = (used.side(0).lo + used.side(0).hi) / 2;
        Affinity<2> parameters{{{{0, 1}, {-1, 0}}}, {{0, kTwoPi * (1 + std::floor(middle / kTwoPi))}}};
        const auto generatrix = visit_one(
            [&](const auto& g) -> Result<int> {
                using G = std::remove_cvref_t<decltype(g)>;
                if constexpr (std::same_as<G, Line<3>>) {
                    parameters.linear[0][1] = 1 / on.length();
                    parameters.offset[0] = -on.lo / on.length();
                } else if constexpr (std::same_as<G, Conic<3>>) {
                    if (g.kind != ConicKind::ellipse) return part(profile, on);
                    const IgesArc made = add_arc(file_, g, on);
                    parameters.offset[0] = made.shift;
                    return made.entry;
                }
                return part(profile, std::same_as<G, Line<3>> ? on : domain(profile)[0]);
            },
            profile);
        if (!generatrix) return std::unexpected(generatrix.error());
        const auto* conic = std::get_if<Conic<3>>(&profile);
        return written(
            file_.entity("120", IgesUse::part, {text(about), text(*generatrix), "0.", real(kTwoPi)}),
            conic != nullptr && conic->kind != ConicKind::ellipse ? std::nullopt : std::optional(parameters));
    }

    IgesFile& file_;
    const Model& m_;
    std::vector<bool> rational_;  // edges that are splines whatever they are
    std::vector<int> curves_;     // the entities of edges, 0 for degenerate ones
    std::vector<int> index_;      // their places in the list of edges, from 1
    int vertices_ = 0, edges_ = 0;
};

}  // namespace

Result<void> add_model(IgesFile& file, const Model& model) { return IgesModel(file, model).write(); }

}  // namespace freiform::detail

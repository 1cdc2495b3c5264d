// Idea. Vertices and edges of a model are lists (502, 504) that its loops (508) refer to by index, so what
// was watertight stays so:
//
//     186 solid -> 514 shell -> 510 face -> 508 loop -> 504 edges -> 502 vertices
//
// Edges are splines in space, parts of conics as rational ones. Loops on splines have curves in the
// parameters, too; others have none, so that surfaces need not keep their parameters: flat ones are 190,
// revolutions and circular cylinders 120, all others splines (128), of extrusions exact ones over what the
// face uses of them.
//
// Orientation. Loops run counter-clockwise about the normal of the surface; a shell says which of its faces
// are turned. Revolutions are parametrised by the profile first, ours by the angle: about the opposite axis
// the normals are the same.
//
// References: the Initial Graphics Exchange Specification, version 5.3, 4.18, 4.49, 4.111 and 4.144 to 4.151.
// Why not 144 for each face: nothing then says that faces share edges, and every reader guesses.
#include "iges_file.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/make/image_curve.hpp>

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

bool is_circle(const Conic<3>& c) {
    const double xx = dot(c.x, c.x), yy = dot(c.y, c.y);
    return c.kind == ConicKind::ellipse && std::abs(xx - yy) <= 16 * kUnitRoundoff * xx &&
           std::abs(dot(c.x, c.y)) <= 16 * kUnitRoundoff * xx;
}

class IgesModel {
public:
    IgesModel(IgesFile& file, const Model& model)
        : file_(file), m_(model), curves_(model.edges.size()), index_(model.edges.size()) {}

    Result<void> write() {
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
    // The curves of all edges, each once.
    Result<void> find_edges(const Face& f) {
        if (f.loops.empty()) return refuse(RefusalKind::unsupported, "loops", "a face without boundary");
        for (const Loop& l : f.loops)
            for (const Coedge& c : l.coedges) {
                const Edge& e = m_.edges[std::size_t(c.edge)];
                int& id = curves_[std::size_t(c.edge)];
                if (e.degenerate || id != 0) continue;
                const auto curve = curve_of(e, c, f.surface);
                if (!curve) return refuse_within(text("edges[", c.edge, "]"), curve.error());
                const auto made = spline<3>(*curve);
                if (!made) return refuse_within(text("edges[", c.edge, "]"), made.error());
                id = *made;
            }
        return {};
    }

    static Result<CurveGeometry<3>> curve_of(const Edge& e, const Coedge& c, const SurfaceGeometry& surface) {
        if (e.curve) return space_spline(*e.curve, e.range);
        const auto flat = parameter_spline(c.curve, e.range);
        if (!flat) return std::unexpected(flat.error());
        return image_curve(surface, *flat);
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

    // As the loop runs, which is not always as the edge does.
    static CurveGeometry<2> along_loop(const CurveGeometry<2>& curve, bool reversed) {
        if (!reversed) return curve;
        return visit_one(
            [&](const auto& c) -> CurveGeometry<2> {
                if constexpr (requires { c.net(); })
                    return reverse(c, 0);
                else
                    return c;
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

    // Of splines with the curves in the parameters, which readers would otherwise have to find again.
    Result<int> loop(const Loop& l, bool on_spline) {
        std::vector<std::string> values = {text(l.coedges.size())};
        for (const Coedge& c : l.coedges) {
            const Edge& e = m_.edges[std::size_t(c.edge)];
            const std::array<int, 4> entry =
                e.degenerate ? std::array{1, vertices_, e.start + 1, 1}
                             : std::array{0, edges_, index_[std::size_t(c.edge)], c.reversed ? 0 : 1};
            for (const int x : entry) values.push_back(text(x));
            if (!on_spline) {
                values.emplace_back("0");
                continue;
            }
            const auto flat = parameter_spline(c.curve, e.range);
            if (!flat) return std::unexpected(flat.error());
            const auto id = spline<2>(along_loop(*flat, c.reversed), IgesUse::parameters);
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
        if (!surface) return surface;
        std::vector<std::string> values = {text(*surface), text(f.loops.size()),
                                           f.loops.size() == 1 ? "1" : "0"};
        const bool on_spline = std::holds_alternative<Surface<Vec<3>>>(f.surface) ||
                               std::holds_alternative<Surface<Hom<3>>>(f.surface);
        for (const Loop& l : f.loops) {
            const auto id = loop(l, on_spline);
            if (!id) return id;
            values.push_back(text(*id));
        }
        return file_.entity("510", IgesUse::part, values, 1);
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
            shells.push_back(
                file_.entity("514", b.solid ? IgesUse::part : IgesUse::alone, values, b.solid ? 1 : 2));
        }
        if (!b.solid || shells.empty()) return;
        std::vector<std::string> values = {text(shells[0]), "1", text(shells.size() - 1)};
        for (std::size_t i = 1; i < shells.size(); ++i)
            values.push_back(text(shells[i])), values.emplace_back("1");
        file_.entity("186", IgesUse::alone, values);
    }

    template <class P>
    Result<int> one(const Surface<P>& s, const Box<2>&) {
        return file_.add(s, IgesUse::part);
    }

    Result<int> one(const Extrusion& s, const Box<2>& used) {
        if (const auto* line = std::get_if<Line<3>>(&s.profile)) {
            const Vec<3> n = cross(line->direction, s.direction);
            const auto triple = [](const Vec<3>& v) {
                return std::vector{real(v[0]), real(v[1]), real(v[2])};
            };
            std::vector<std::string> at = triple(line->origin);
            at.emplace_back("0");
            const int point = file_.entity("116", IgesUse::part, at);
            const int normal = file_.entity("123", IgesUse::part, triple((1 / norm(n)) * n));
            return file_.entity("190", IgesUse::part, {text(point), text(normal)});
        }
        const Vec<3> lo = used.side(1).lo * s.direction, hi = used.side(1).hi * s.direction;
        if (const auto* c = std::get_if<Conic<3>>(&s.profile); c && is_circle(*c)) {
            const Vec<3> n = cross(c->x, c->y);
            if (norm(cross(n, s.direction)) <= 16 * kUnitRoundoff * norm(n) * norm(s.direction))
                return turned(Line<3>{c->centre + c->x + lo, hi - lo}, {0, 1}, c->centre, n);
        }
        const bool whole = std::holds_alternative<Conic<3>>(s.profile);  // the angles that are used
        const auto profile = space_spline(s.profile, whole ? used.side(0) : domain(s.profile)[0]);
        if (!profile) return std::unexpected(profile.error());
        return visit_one(
            [&](const auto& c) -> Result<int> {
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
                    return file_.add(*made, IgesUse::part);
                } else {
                    return refuse(RefusalKind::unsupported, "", "an extrusion of a line");
                }
            },
            *profile);
    }

    Result<int> one(const Revolution& s, const Box<2>& used) {
        const bool whole = std::holds_alternative<Curve<Vec<3>>>(s.profile) ||
                           std::holds_alternative<Curve<Hom<3>>>(s.profile);
        return turned(s.profile, whole ? domain(s.profile)[0] : used.side(1), s.origin, s.axis);
    }

    Result<int> one(const OffsetSurface&, const Box<2>&) {
        return refuse(RefusalKind::unsupported, "", "an offset surface; STEP files have them");
    }

    // The profile turned once about the axis: its angle is the first parameter.
    Result<int> turned(const CurveGeometry<3>& profile, Interval on, const Vec<3>& origin,
                       const Vec<3>& axis) {
        const auto curve = space_spline(profile, on);
        if (!curve) return std::unexpected(curve.error());
        const Line<3> along{origin, (-1 / norm(axis)) * axis};
        std::vector<std::string> ends;
        for (const double t : {0.0, 1.0})
            for (const double x : (along.origin + t * along.direction).c) ends.push_back(real(x));
        const int about = file_.entity("110", IgesUse::part, ends);
        const auto generatrix = spline<3>(*curve);
        if (!generatrix) return generatrix;
        return file_.entity("120", IgesUse::part, {text(about), text(*generatrix), "0.", real(kTwoPi)});
    }

    IgesFile& file_;
    const Model& m_;
    std::vector<int> curves_;  // the entities of edges, 0 for degenerate ones
    std::vector<int> index_;   // their places in the list of edges, from 1
    int vertices_ = 0, edges_ = 0;
};

}  // namespace

Result<void> add_model(IgesFile& file, const Model& model) { return IgesModel(file, model).write(); }

}  // namespace freiform::detail

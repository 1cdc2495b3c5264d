// Items of a representation: solids, shells, faces, sets of curves and surfaces.
#include "step_shape.hpp"

#include "step_tangles.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/core/visit.hpp>

#include <algorithm>
#include <set>

namespace freiform::step {

namespace {

// Of the tolerance: a vertex nearer to an edge than this is on it.
constexpr double kTouches = 1e-3;

// What an item is that would be a shape if it were read; empty: no shape.
std::string_view unread_shape(const File& f, std::uint32_t item) {
    struct Kind {
        std::string_view part, words;
    };
    constexpr std::string_view kSwept = "a swept solid", kCsg = "a CSG solid or a part of one",
                               kVolume = "a volume";
    static constexpr Kind kKinds[] = {{"AREA_SOLID", kSwept},
                                      {"FACE_SOLID", kSwept},
                                      {"SWEPT_", kSwept},
                                      {"SECTIONED_", kSwept},
                                      {"CSG", kCsg},
                                      {"BOOLEAN", kCsg},
                                      {"BLOCK", kCsg},
                                      {"SPHERE", kCsg},
                                      {"TORUS", kCsg},
                                      {"RIGHT_", kCsg},
                                      {"ELLIPSOID", kCsg},
                                      {"FACETED_PRIMITIVE", kCsg},
                                      {"ECCENTRIC_CONE", kCsg},
                                      {"CYCLIDE_SEGMENT", kCsg},
                                      {"TETRAHEDRON", kCsg},
                                      {"HEXAHEDRON", kCsg},
                                      {"PYRAMID", kCsg},
                                      {"HALF_SPACE", kCsg},
                                      {"_VOLUME", kVolume},
                                      {"SOLID", "a solid of another type"},
                                      {"BREP", "a solid of another type"},
                                      {"SHELL", "a shell of another type"},
                                      {"SURFACE", "a surface that no face bounds"},
                                      {"FACE", "a face of another type"}};
    const std::string names = f.label(item);
    for (const Kind& k : kKinds)
        if (names.find(k.part) != names.npos) return k.words;
    return {};
}

}  // namespace

std::string name_in(const Fields& f) {
    std::string name = f.string(0);
    return name == "NONE" ? std::string() : name;
}

void ShapeReader::refuse_item(std::uint32_t item, Refusal why) {
    const std::string label = f_.label(item);
    const bool same = why.where == label;
    out_.model.refused.push_back(
        {why.kind, label, same || why.where.empty() ? why.message : text(why.where, ": ", why.message)});
}

void ShapeReader::report(int edge, std::string what, std::optional<double> bound, double estimate) {
    out_.model.approximations.push_back({"", std::move(what), bound, bound ? 0 : estimate});
    out_.approximated.push_back(edge);
}

std::optional<Colour> ShapeReader::colour_of(std::uint32_t i) const {
    const auto at = styles_.colours.find(i);
    return at == styles_.colours.end() ? std::nullopt : std::optional<Colour>(at->second);
}

// The faces of a shell, through ORIENTED_ shells and faces.
Result<void> ShapeReader::shell_faces(std::uint32_t i, bool forward, Shell& out, int depth) {
    if (depth > 20) return refuse(RefusalKind::invalid, f_.label(i), "is a shell of itself, or too deep");
    for (const Type t : {Type::ORIENTED_CLOSED_SHELL, Type::ORIENTED_OPEN_SHELL})
        if (f_.is(i, t)) {
            const auto f = Fields::of(f_, i, t, 4);
            if (!f) return std::unexpected(f.error());
            const auto at = f->reference(2, "shell");
            if (!at) return std::unexpected(at.error());
            return shell_faces(*at, f->flag(3) == forward, out, depth + 1);
        }
    Type type = Type::unknown;
    for (const Type t : {Type::CLOSED_SHELL, Type::OPEN_SHELL, Type::CONNECTED_FACE_SET})
        if (f_.is(i, t)) type = t;
    const auto f = Fields::of(f_, i, type, 1);
    if (!f) return std::unexpected(f.error());
    const auto ids = f->references(f->size() - 1, "faces");
    if (!ids) return std::unexpected(ids.error());
    for (const std::uint32_t id : *ids) note_missed_plane(id);
    for (std::uint32_t id : *ids) {
        bool same = forward;
        if (f_.is(id, Type::ORIENTED_FACE)) {
            const auto o = Fields::of(f_, id, Type::ORIENTED_FACE, 4);
            if (!o) return std::unexpected(o.error());
            const auto at = o->reference(2, "face");
            if (!at) return std::unexpected(at.error());
            if (!o->flag(3)) same = !same;
            id = *at;
        }
        if (const int made = face(id); made >= 0) out.faces.push_back({made, !same});
    }
    return {};
}

Result<int> ShapeReader::shell(std::uint32_t i, bool closed) {
    Shell made;
    made.closed = closed;
    if (auto ok = shell_faces(i, true, made, 0); !ok) return std::unexpected(ok.error());
    if (made.faces.empty()) return -1;
    settle_turned(made);
    out_.model.shells.push_back(std::move(made));
    return int(out_.model.shells.size()) - 1;
}

void ShapeReader::body_of(std::uint32_t item, std::vector<int> shells, bool solid,
                          const std::vector<std::uint32_t>& made_of) {
    if (shells.empty()) return;
    Body b;
    b.shells = std::move(shells);
    b.solid = solid;
    b.name = name_in(Fields(f_, item, f_.instances[item].first + 1));
    b.colour = colour_of(item);
    styles_.add_layers(b.layers, item);
    for (const std::uint32_t i : made_of) styles_.add_layers(b.layers, i);
    out_.model.bodies.push_back(std::move(b));
}

void ShapeReader::solid(std::uint32_t item) {
    const Fields f(f_, item, f_.instances[item].first + 1);
    std::vector<std::uint32_t> list;
    const auto outer = f.reference(1, "outer shell");
    if (!outer) return refuse_item(item, outer.error());
    list.push_back(*outer);
    if (f_.is(item, Type::BREP_WITH_VOIDS)) {
        const auto voids = f.references(2, "voids");
        if (!voids) return refuse_item(item, voids.error());
        list.insert(list.end(), voids->begin(), voids->end());
    }
    std::vector<int> shells;
    for (const std::uint32_t i : list) {
        const auto made = shell(i, true);
        if (!made)
            refuse_item(item, made.error());
        else if (*made >= 0)
            shells.push_back(*made);
    }
    body_of(item, std::move(shells), true, list);
}

void ShapeReader::sheet(std::uint32_t item, std::uint32_t of, bool closed) {
    const auto made = shell(of, closed);
    if (!made) return refuse_item(item, made.error());
    if (*made >= 0) body_of(item, {*made}, false, {of});
}

void ShapeReader::free_curve(std::uint32_t item) {
    if (f_.is(item, Type::EDGE_CURVE) || f_.is(item, Type::SUBEDGE)) {
        if (const auto made = edge(item); !made) refuse_item(item, made.error());
        return;
    }
    if (composite_in(f_, item) != kMissing) {
        if (const auto made = free_composite(item); !made) refuse_item(item, made.error());
        return;
    }
    const auto c = curve_in_space(item, nullptr);
    if (!c) return refuse_item(item, c.error());
    const Interval on = c->range.value_or(domain(c->curve)[0]);
    if (!std::isfinite(on.length()) || !(on.lo < on.hi))
        return refuse_item(
            item, {RefusalKind::unsupported, f_.label(item), "is a curve without end, or without length"});
    Edge e;
    e.name = name_in(Fields(f_, item, f_.instances[item].first + 1));
    e.curve = c->curve;
    e.range = on;
    e.tolerance = tolerance_;
    const Vec<3> a = jet<0>(*e.curve, on.lo).value(), b = jet<0>(*e.curve, on.hi).value();
    e.start = int(out_.model.vertices.size());
    out_.model.vertices.push_back({a, 0});
    e.end = e.start;
    if (norm(a - b) > tolerance_) {
        e.end = int(out_.model.vertices.size());
        out_.model.vertices.push_back({b, 0});
    }
    out_.model.edges.push_back(std::move(e));
}

// The curves and surfaces of sets, wires and edge models, with a stack of our own: kMissing stands above what
// the last of `around` contains. Sets that many sets name are visited as often, but all together no more than
// items_left_ allows.
void ShapeReader::set_items(std::uint32_t item) {
    std::vector<std::uint32_t> todo{item}, around;
    std::set<std::uint32_t> inside, circular;
    const auto refuse_more = [&] {
        items_left_ = 0;
        refuse_item(item, {RefusalKind::limit, "", "names its items more often than it may"});
    };
    while (!todo.empty()) {
        const std::uint32_t i = todo.back();
        todo.pop_back();
        if (i == kMissing) {
            inside.erase(around.back());
            around.pop_back();
            continue;
        }
        if (inside.contains(i)) {
            if (circular.insert(i).second) refuse_item(i, {RefusalKind::invalid, "", "contains itself"});
            continue;
        }
        if (items_left_ == 0) return refuse_more();
        --items_left_;
        inside.insert(i);
        around.push_back(i);
        todo.push_back(kMissing);
        // What is put on the stack is paid for there: lists that name themselves take no more memory.
        const auto put = [&](const std::vector<std::uint32_t>& ids) {
            if (ids.size() > items_left_) return false;
            items_left_ -= ids.size();
            todo.insert(todo.end(), ids.rbegin(), ids.rend());
            return true;
        };
        const auto is_any = [&](std::initializer_list<Type> types) {
            return std::any_of(types.begin(), types.end(), [&](Type t) { return f_.is(i, t); });
        };
        if (is_any({Type::GEOMETRIC_SET, Type::GEOMETRIC_CURVE_SET, Type::EDGE_BASED_WIREFRAME_MODEL,
                    Type::SHELL_BASED_WIREFRAME_MODEL, Type::CONNECTED_EDGE_SET, Type::WIRE_SHELL,
                    Type::EDGE_LOOP})) {
            const auto ids = Fields(f_, i, f_.instances[i].first + 1).references(1, "items");
            if (!ids)
                refuse_item(i, ids.error());
            else if (!put(*ids))
                return refuse_more();
        } else if (f_.is(i, Type::RECTANGULAR_COMPOSITE_SURFACE)) {
            // Its patches are surfaces one beside the other.
            const Fields f(f_, i, f_.part(i, Type::RECTANGULAR_COMPOSITE_SURFACE));
            const auto rows = f.rows(f.size() - 1, "segments");
            if (!rows) refuse_item(i, rows.error());
            for (std::size_t r = rows ? rows->size() : 0; r-- > 0;) {
                const auto patches = f.references_at((*rows)[r], "segments");
                if (!patches)
                    refuse_item(i, patches.error());
                else if (!put(*patches))
                    return refuse_more();
            }
        } else if (const bool patch = f_.is(i, Type::SURFACE_PATCH); patch || f_.is(i, Type::ORIENTED_EDGE)) {
            const Fields f(f_, i, f_.instances[i].first + 1);
            const auto at = patch ? f.reference(0, "surface") : f.reference(3, "edge");
            if (at)
                todo.push_back(*at);
            else
                refuse_item(i, at.error());
        } else if (is_any({Type::CARTESIAN_POINT, Type::VERTEX_SHELL, Type::VERTEX_POINT, Type::VERTEX_LOOP,
                           Type::AXIS2_PLACEMENT_3D, Type::AXIS1_PLACEMENT})) {
            continue;
        } else if (is_any({Type::PLANE, Type::CYLINDRICAL_SURFACE, Type::CONICAL_SURFACE,
                           Type::SPHERICAL_SURFACE, Type::TOROIDAL_SURFACE, Type::DEGENERATE_TOROIDAL_SURFACE,
                           Type::B_SPLINE_SURFACE, Type::B_SPLINE_SURFACE_WITH_KNOTS, Type::BEZIER_SURFACE,
                           Type::UNIFORM_SURFACE, Type::QUASI_UNIFORM_SURFACE,
                           Type::SURFACE_OF_LINEAR_EXTRUSION, Type::SURFACE_OF_REVOLUTION,
                           Type::OFFSET_SURFACE, Type::RECTANGULAR_TRIMMED_SURFACE,
                           Type::CURVE_BOUNDED_SURFACE, Type::SURFACE_REPLICA})) {
            if (const int made = face(i); made >= 0) {
                styles_.add_layers(out_.model.faces[std::size_t(made)].layers, item);
                out_.loose.push_back(made);
            }
        } else {
            const std::size_t before = out_.model.edges.size();
            free_curve(i);
            for (std::size_t e = before; e < out_.model.edges.size(); ++e)
                for (const std::uint32_t styled : {i, item}) style_edge(out_.model.edges[e], styled);
        }
    }
}

void ShapeReader::add(std::uint32_t item) {
    const Fields f(f_, item, f_.instances[item].first + 1);
    const auto is = [&](Type t) { return f_.is(item, t); };
    if (is(Type::MANIFOLD_SOLID_BREP) || is(Type::BREP_WITH_VOIDS) || is(Type::FACETED_BREP)) {
        solid(item);
    } else if (is(Type::SHELL_BASED_SURFACE_MODEL) || is(Type::FACE_BASED_SURFACE_MODEL)) {
        const auto ids = f.references(1, "shells");
        if (!ids) return refuse_item(item, ids.error());
        for (const std::uint32_t i : *ids)
            sheet(item, i, is(Type::SHELL_BASED_SURFACE_MODEL) && f_.is(i, Type::CLOSED_SHELL));
    } else if (is(Type::OPEN_SHELL) || is(Type::CLOSED_SHELL) || is(Type::CONNECTED_FACE_SET)) {
        sheet(item, item, is(Type::CLOSED_SHELL));
    } else if (is(Type::ADVANCED_FACE) || is(Type::FACE_SURFACE) || is(Type::SUBFACE)) {
        if (const int made = face(item); made >= 0) out_.loose.push_back(made);
    } else if (is(Type::GEOMETRIC_SET) || is(Type::GEOMETRIC_CURVE_SET) ||
               is(Type::EDGE_BASED_WIREFRAME_MODEL) || is(Type::SHELL_BASED_WIREFRAME_MODEL)) {
        set_items(item);
    } else if (is_tessellated(f_, item)) {
        ++out_.tessellated;
    } else if (!add_swept(item)) {
        const std::string_view kind = unread_shape(f_, item);
        if (!kind.empty())
            refuse_item(item, {RefusalKind::unsupported, "", text("is ", kind, ", which is not read")});
    }
}

// Vertices that loops go through as if they were one.
void ShapeReader::merge_vertices() {
    std::vector<int> to(out_.model.vertices.size());
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = int(i);
    const auto root = [&](int v) {
        while (to[std::size_t(v)] != v) v = to[std::size_t(v)] = to[std::size_t(to[std::size_t(v)])];
        return v;
    };
    for (const auto& [a, b] : same_) {
        const int x = std::min(root(a), root(b)), y = std::max(root(a), root(b));
        to[std::size_t(y)] = x;
        auto& v = out_.model.vertices;
        v[std::size_t(x)].tolerance = std::max({v[std::size_t(x)].tolerance, v[std::size_t(y)].tolerance,
                                                norm(v[std::size_t(x)].point - v[std::size_t(y)].point)});
    }
    const auto label = [&](int v) {
        const auto of = vertex_of_.find(v);
        return of == vertex_of_.end() ? std::string("an end") : f_.label(of->second);
    };
    for (int i = 0; i < int(to.size()); ++i) {
        const int r = root(i);
        const auto& v = out_.model.vertices;
        const double apart = norm(v[std::size_t(i)].point - v[std::size_t(r)].point);
        if (r != i && apart > 0)
            report(-1,
                   text(label(i), " is taken for ", label(r), ", ", apart,
                        " from it: loops say that they are one"),
                   apart * (1 + 8 * kUnitRoundoff), 0);
    }
    for (Edge& e : out_.model.edges) e.start = root(e.start), e.end = root(e.end);
}

// Curves of the file that splines stand for, each once.
void ShapeReader::tell_approximated() {
    auto& all = geometry_.approximated;
    sort(all);
    const auto rest = std::ranges::unique(all);
    all.erase(rest.begin(), rest.end());
    for (const auto& [instance, bound] : all)
        report(-1, text(f_.label(instance), ": a spline near it stands for it"), bound, 0);
}

// Loose faces make a body; edges and vertices that only refused faces had are left out.
Part ShapeReader::finish() {
    Model& m = out_.model;
    tell_approximated();
    if (!twins_.empty()) merge_twins();
    if (!same_.empty()) merge_vertices();
    cut_touched_edges(m, kTouches * tolerance_, [&](int edge, int parts, int first) {
        const std::size_t known = out_.approximated.size();
        for (std::size_t i = 0; i < known; ++i)  // what is told of the edge is true of its parts
            for (int k = 1; k < parts && out_.approximated[i] == edge; ++k) {
                m.approximations.push_back(m.approximations[i]);
                out_.approximated.push_back(first + k - 1);
            }
        report(edge, text("is one of ", parts, " parts of an edge that another loop of its face touches"),
               0.0, 0);
    });
    if (!out_.loose.empty()) {
        Shell s;
        for (const int i : out_.loose) s.faces.push_back({i, false});
        m.shells.push_back(std::move(s));
        Body b;
        b.shells = {int(m.shells.size()) - 1};
        m.bodies.push_back(std::move(b));
    }
    for (Shell& s : m.shells)
        for (FaceUse& u : s.faces) u.reversed = u.reversed != false;
    out_.bytes = 0;
    const auto numbers = [](const auto& g) {
        if constexpr (requires { g.net(); })
            return g.net().flat().size() * sizeof(g.net().flat()[0]) + 200;
        else
            return std::size_t(0);
    };
    for (const Edge& e : m.edges) out_.bytes += sizeof(Edge) + (e.curve ? visit_one(numbers, *e.curve) : 0);
    for (const Face& f : m.faces) {
        out_.bytes += sizeof(Face) + visit_one(numbers, f.surface);
        for (const Loop& l : f.loops)
            for (const Coedge& c : l.coedges) out_.bytes += sizeof(Coedge) + visit_one(numbers, c.curve);
    }
    out_.bytes += m.vertices.size() * sizeof(Vertex);
    return std::move(out_);
}

}  // namespace freiform::step

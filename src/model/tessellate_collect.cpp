// What comes out of a tessellation: mesh, normals, bounds. Essay in tessellate.cpp.
#include "tessellator_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/mesh/normal_cone.hpp>
#include <freiform/spline/repeated_jets.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace freiform {

namespace {

constexpr std::size_t kVerticesAtOnce = 1024;
constexpr int kSteps = 16;             // of Newton's method
constexpr double kSameNormals = 1e-3;  // radians, about: normals of both sides of a kink that are one

bool has_kinks(const DerivativeQuery<2, 3>& surface) {
    return !surface.kinks(0).empty() || !surface.kinks(1).empty();
}

template <class T>
void append(std::vector<T>& to, std::vector<T>&& more) {
    if (to.capacity() == 0)
        to = std::move(more);
    else
        to.insert(to.end(), more.begin(), more.end());
}

// Of length 1, where both tangents are there and not parallel.
std::optional<Vec<3>> regular_normal(const Jet<2, 1, Vec<3>>& j) {
    const Vec<3> m = cross(j.d[1], j.d[2]);
    if (!(norm(m) > 1e-9 * norm(j.d[1]) * norm(j.d[2])) || !(max_abs(j.d[1]) > 0) || !(max_abs(j.d[2]) > 0))
        return std::nullopt;
    return unit(m);
}

}  // namespace

// Unit normal at uv where it is not plain to see; where the surface has none (a pole), that of a point a
// little inside the triangle. First derivatives above `usual` are not small.
Vec<3> Tessellator::normal_at(std::size_t f, const Vec<2>& uv, const Vec<2>& inwards,
                              const Vec<2>& usual) const {
    const SurfaceGeometry& surface = shape(f);
    for (double step : {0.0, 1e-6, 1e-4, 1e-2, 0.5}) {
        const auto j = jet<1>(surface, step == 0 ? uv.c : ((1 - step) * uv + step * inwards).c);
        if (const auto n = regular_normal(j)) {
            // A vanishing derivative leaves the direction of the other to chance.
            if (norm(j.d[1]) > usual[0] && norm(j.d[2]) > usual[1]) return *n;
            const auto inner = jet<1>(surface, inwards.c);
            if (norm(j.d[1]) > 1e-9 * norm(inner.d[1]) && norm(j.d[2]) > 1e-9 * norm(inner.d[2])) return *n;
        }
    }
    return {};
}

double Tessellator::rounding_of(std::size_t f) const {
    Box<2> box;
    for (const Vec<2>& p : boundaries_[f].polygon.uv) box.add(p);
    if (box.is_empty()) return 0;
    const std::array<Interval, 2> on{box.side(0), box.side(1)};
    return 2 * std::max(value_error_bound(model_.faces[f].surface, on), value_error_bound(shape(f), on));
}

// With the points of the mesh itself, which on edges are not those of the face.
void Tessellator::measure_angles(Tessellation& out) const {
    parallel_for(out.faces.size(), 1, [&](std::size_t i) {
        FaceReport& report = out.faces[i];
        const MeshPart& part = out.mesh.parts[i];
        for (int k = part.first; k < part.first + part.count; ++k) {
            auto t = out.mesh.triangles[std::size_t(k)];
            const auto uv = [&](std::size_t c) { return out.mesh.vertices[std::size_t(t[c])].uv; };
            if (cross(uv(1) - uv(0), uv(2) - uv(0)) < 0) std::swap(t[1], t[2]);
            const auto point = [&](std::size_t c) {
                return out.mesh.points[std::size_t(out.mesh.vertices[std::size_t(t[c])].point)];
            };
            const double angle = normal_angle_bound(*queries_[std::size_t(report.face)],
                                                    {uv(0), uv(1), uv(2)}, {point(0), point(1), point(2)});
            report.angle_bound = std::max(report.angle_bound, angle);
            report.angle_exceeded += !(angle <= options_.max_angle);
        }
    });
    for (const FaceReport& f : out.faces) {
        out.angle_bound = std::max(out.angle_bound, f.angle_bound);
        out.angle_exceeded += f.angle_exceeded;
    }
}

// Corners of triangles on a kink of the surface are a vertex for each side of it, if its normals differ.
Tessellator::Sides Tessellator::sides_of(std::size_t f) const {
    const FaceMesh& m = meshes_[f];
    const DerivativeQuery<2, 3>& surface = *queries_[f];
    Sides out{m.triangles, m.uv, {}};
    // Axes along which the vertex is on a kink, and the triangle below it.
    const auto below = [&](int v, const std::array<int, 3>& t) {
        int axes = 0;
        for (int d = 0; d < 2; ++d) {
            const double at = m.uv[std::size_t(v)][d];
            if (std::ranges::binary_search(surface.kinks(d), at, {}, &Kink::at) &&
                m.uv[std::size_t(t[0])][d] + m.uv[std::size_t(t[1])][d] + m.uv[std::size_t(t[2])][d] < 3 * at)
                axes |= 1 << d;
        }
        return axes;
    };
    const auto just_below = [&](int v, int axes) {
        Vec<2> at = m.uv[std::size_t(v)];
        for (int d = 0; d < 2; ++d)
            if (axes & 1 << d) at[d] = std::nextafter(at[d], -kInfinity);
        return at;
    };
    const auto normal = [&](const Vec<2>& at) {
        const auto j = jet<1>(surface.geometry(), at.c);
        const Vec<3> n = cross(j.d[1], j.d[2]);
        return norm(n) > 0 ? unit(n) : n;
    };
    std::vector<char> is_used(m.uv.size());  // as it is: from above
    for (const auto& t : m.triangles)
        for (const int v : t)
            if (below(v, t) == 0) is_used[std::size_t(v)] = 1;
    std::vector<std::array<int, 4>> known(m.uv.size(), {-1, -1, -1, -1});  // by axes
    for (auto& t : out.triangles) {
        const std::array<int, 3> own = t;
        for (int& v : t) {
            const int axes = below(v, own);
            if (axes == 0) continue;
            int& at = known[std::size_t(v)][std::size_t(axes)];
            if (at < 0) {
                const Vec<2> place = just_below(v, axes);
                at = v;
                if (!std::exchange(is_used[std::size_t(v)], true)) {
                    out.place[std::size_t(v)] = place;
                } else if (norm(normal(place) - normal(out.place[std::size_t(v)])) > kSameNormals) {
                    at = int(out.place.size());
                    out.place.push_back(place);
                    out.copy_of.push_back(v);
                }
            }
            v = at;
        }
    }
    return out;
}

// The vertices of a face; those with the point -1 - i are at inner[i].
Tessellator::FaceLook Tessellator::look_of(std::size_t f, bool flip) const {
    const SurfaceGeometry& surface = shape(f);
    const FaceMesh& m = meshes_[f];
    FaceLook out;
    Sides sides;
    if (has_kinks(*queries_[f])) sides = sides_of(f), out.triangles = std::move(sides.triangles);
    const std::vector<Vec<2>>& place = out.triangles.empty() ? m.uv : sides.place;
    out.vertices.resize(place.size());
    std::size_t inner = 0;
    for (std::size_t i = 0; i < m.uv.size(); ++i)
        out.vertices[i].point = m.point[i] >= 0 ? m.point[i] : -int(++inner);
    out.inner.resize(inner);
    for (std::size_t i = m.uv.size(); i < place.size(); ++i)
        out.vertices[i].point = out.vertices[std::size_t(sides.copy_of[i - m.uv.size()])].point;
    // Faces are looked at in parallel, and the vertices of large ones.
    struct Tangents {  // their lengths
        double u = 0, v = 0;
        bool are_regular = false;
    };
    std::vector<Tangents> tangents(place.size());
    const auto look_at = [&](std::size_t i, RepeatedJets& jets) {
        MeshVertex& v = out.vertices[i];
        const bool is_own = i < m.uv.size();
        v.uv = is_own ? m.uv[i] : m.uv[std::size_t(sides.copy_of[i - m.uv.size()])];
        const auto j = jets.at<1>(place[i].c);
        const auto normal = regular_normal(j);
        tangents[i] = {norm(j.d[1]), norm(j.d[2]), normal.has_value()};
        if (normal) v.normal = flip ? -*normal : *normal;
        if (is_own && v.point < 0)
            out.inner[std::size_t(-1 - v.point)] =
                place[i] == v.uv ? j.value() : jet<0>(surface, v.uv.c).value();
    };
    parallel_for((place.size() + kVerticesAtOnce - 1) / kVerticesAtOnce, 1, [&](std::size_t part) {
        const std::size_t first = part * kVerticesAtOnce,
                          end = std::min(place.size(), first + kVerticesAtOnce);
        RepeatedJets jets(surface, end - first);
        for (std::size_t i = first; i < end; ++i) look_at(i, jets);
    });
    Vec<2> usual{};
    for (const Tangents& t : tangents)
        usual = {{std::max(usual[0], 1e-6 * t.u), std::max(usual[1], 1e-6 * t.v)}};
    const auto is_plain = [&](std::size_t i) {
        return tangents[i].are_regular && tangents[i].u > usual[0] && tangents[i].v > usual[1];
    };
    std::map<std::size_t, Vec<2>> inwards;  // of the others: the middle of a triangle
    for (std::size_t i = 0; i < place.size(); ++i)
        if (!is_plain(i)) inwards.insert({i, {}});
    if (inwards.empty()) return out;
    for (const auto& t : out.triangles.empty() ? m.triangles : out.triangles)
        for (const int v : t)
            if (const auto found = inwards.find(std::size_t(v)); found != inwards.end())
                found->second = (1.0 / 3) * (place[std::size_t(t[0])] + place[std::size_t(t[1])] +
                                             place[std::size_t(t[2])]);
    for (const auto& [i, middle] : inwards) {
        const Vec<3> normal = normal_at(f, place[i], middle, usual);
        out.vertices[i].normal = flip ? -normal : normal;
    }
    return out;
}

// Parameters of the spline that a plane stands for, at the corners of its mesh: of the boundary on its
// parameter curves; others are looked for.
std::vector<Vec<2>> Tessellator::given_places(std::size_t f) const {
    const Face& face = *stand_in(f)->given;
    std::map<int, const Coedge*> uses;
    for (const Loop& l : face.loops)
        for (const Coedge& c : l.coedges) uses[c.edge] = &c;
    const FaceMesh& m = meshes_[f];
    const auto domain = limits(face.surface);
    std::vector<Vec<2>> out;
    for (std::size_t i = 0; i < m.uv.size(); ++i) {
        const auto source =
            i < boundaries_[f].sources.size() ? boundaries_[f].sources[i] : BoundaryOfFace::Source{};
        if (source.edge >= 0) {
            const Coedge& c = *uses.at(source.edge);
            const auto& t = edges_->mesh(source.edge).parameters;
            out.push_back(clamped(
                jet<0>(c.curve, t[std::size_t(source.segment + (c.reversed ? 1 : 0))]).value(), domain));
            continue;
        }
        const Vec<3> p = jet<0>(model_.faces[f].surface, m.uv[i].c).value();
        Vec<2> uv = out.empty() ? Vec<2>{} : out.back();
        for (int step = 0; step < kSteps; ++step) {
            const auto j = jet<1>(face.surface, uv.c);
            const Vec<3> d = p - j.value();
            const double uu = dot(j.d[1], j.d[1]), uw = dot(j.d[1], j.d[2]), ww = dot(j.d[2], j.d[2]),
                         det = uu * ww - uw * uw, u = dot(j.d[1], d), w = dot(j.d[2], d);
            if (!(det > 0)) break;
            uv = clamped(uv + (1 / det) * Vec<2>{{ww * u - uw * w, uu * w - uw * u}}, domain);
        }
        out.push_back(uv);
    }
    return out;
}

std::vector<const Colour*> body_colours(const Model& model) {
    std::vector<const Colour*> out(model.faces.size(), nullptr);
    for (const Body& b : model.bodies)
        if (b.colour)
            for (int s : b.shells)
                for (const FaceUse& u : model.shells[std::size_t(s)].faces)
                    out[std::size_t(u.face)] = &*b.colour;
    return out;
}

Tessellation Tessellator::collect() {
    Tessellation out;
    out.mesh.unit = model_.unit;
    out.mesh.points = points_;
    std::vector<char> flipped(faces(), 0);
    for (const Shell& s : model_.shells)
        for (const FaceUse& u : s.faces) flipped[std::size_t(u.face)] = u.reversed;
    const auto body_colour = body_colours(model_);
    std::vector<FaceLook> looks(faces());
    parallel_for(faces(), 1, [&](std::size_t f) {
        if (!is_refused(f)) looks[f] = look_of(f, model_.faces[f].reversed != bool(flipped[f]));
    });
    std::vector<std::size_t> first_vertex(faces(), 0);
    std::size_t points = points_.size(), vertices = 0, triangles = 0;
    for (std::size_t f = 0; f < faces(); ++f)
        points += looks[f].inner.size(), vertices += looks[f].vertices.size(),
            triangles += meshes_[f].triangles.size();
    out.mesh.points.reserve(points);
    if (faces() > 1) {  // of one they are taken as they are
        out.mesh.vertices.reserve(vertices);
        out.mesh.triangles.reserve(triangles);
    }
    for (std::size_t f = 0; f < faces(); ++f) {
        const Face& face = model_.faces[f];
        if (is_refused(f)) {
            out.refused.push_back({int(f), face.name, *refusals_[f]});
            continue;
        }
        FaceMesh& m = meshes_[f];
        const bool flip = face.reversed != bool(flipped[f]);
        const int base = int(out.mesh.vertices.size());
        first_vertex[f] = std::size_t(base);
        const int inner = int(out.mesh.points.size());
        append(out.mesh.points, std::move(looks[f].inner));
        for (MeshVertex& v : looks[f].vertices)
            if (v.point < 0) v.point = inner - 1 - v.point;
        append(out.mesh.vertices, std::move(looks[f].vertices));
        MeshPart part{face.name, face.colour, int(out.mesh.triangles.size()), 0, int(f)};
        if (!part.colour && body_colour[f]) part.colour = *body_colour[f];
        auto triangles_here = std::move(looks[f].triangles.empty() ? m.triangles : looks[f].triangles);
        // Turned over, the second half of a quad is the first.
        for (std::size_t k = 0; flip && k < 2 * std::size_t(m.quads); k += 2)
            std::swap(triangles_here[k], triangles_here[k + 1]);
        for (auto& t : triangles_here) {
            if (flip) std::swap(t[1], t[2]);
            for (int& i : t) i += base;
        }
        append(out.mesh.triangles, std::move(triangles_here));
        part.quads = m.quads;
        out.quads += m.quads;
        part.count = int(out.mesh.triangles.size()) - part.first;
        out.mesh.parts.push_back(part);

        FaceReport report{int(f), part.count, m.quads, m.bound, boundaries_[f].gap};
        for (const Loop& l : face.loops)
            for (const Coedge& c : l.coedges)
                report.error_bound =
                    std::max(report.error_bound, kBesideBoundary * edges_->mesh(c.edge).bound);
        report.error_bound += rounding_of(f);
        if (const StandIn* of = stand_in(f)) {
            report.error_bound += of->apart;
            report.boundary_gap = std::max(0.0, report.boundary_gap + of->gap);
        }
        out.error_bound = std::max(out.error_bound, report.error_bound);
        out.boundary_gap = std::max(out.boundary_gap, report.boundary_gap);
        out.faces.push_back(report);
    }
    if (std::isfinite(options_.max_angle)) measure_angles(out);
    for (const MeshPart& part : out.mesh.parts) {
        const StandIn* of = stand_in(std::size_t(part.face));
        if (of == nullptr || !of->is_plane || part.count == 0) continue;
        const auto places = given_places(std::size_t(part.face));
        for (std::size_t i = 0; i < places.size(); ++i)
            out.mesh.vertices[first_vertex[std::size_t(part.face)] + i].uv = places[i];
    }
    out.topology = topology(out.mesh);
    return out;
}

}  // namespace freiform

// Idea. The mesh carries the parameters of its vertices, and is within a proven distance of the linear
// interpolation of the surface over each triangle. A line of constant u of the interpolation therefore lies
// within that distance of the isoline, is cut off where the face is, and lies on the triangles themselves: no
// triangle that it runs on can hide it. Outlines are moved from the chord to the surface, because they decide
// how smooth a drawing looks. At the apex of a cone every triangle has a vertex of its own, so a line ends on
// the side of one where n . eye has another sign at the apex of the next: there it is led to the apex. At
// poles with one normal the signs are the same, and lines pass by.
#include <freiform/core/visit.hpp>
#include <freiform/mesh/level_lines.hpp>
#include <freiform/model/surface_lines.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace freiform {

namespace {

constexpr std::size_t kFewestLines = 5, kMostLines = 25;
constexpr double kEdgeOn = 1e-9;  // |n . eye| below is rounding: the face is seen edge on
constexpr int kBisections = 40;

Box<2> parameters_of(const TriangleMesh& mesh, const MeshPart& part) {
    Box<2> box;
    for (int i = part.first; i < part.first + part.count; ++i)
        for (const int v : mesh.triangles[std::size_t(i)]) box.add(mesh.vertices[std::size_t(v)].uv);
    return box;
}

template <class At>
void keep(std::vector<SurfaceLine>& out, int face, const LevelLine& line, const At& at) {
    SurfaceLine s{face, {}};
    for (const EdgePlace& place : line.places) {
        const Vec<3> p = at(place);
        if (s.points.empty() || !(s.points.back() == p)) s.points.push_back(p);
    }
    if (s.points.size() > 1) out.push_back(std::move(s));
}

// The zero of n . eye on the line in the parameter plane between two vertices on both sides of it.
Vec<3> turning_point(const SurfaceGeometry& surface, const MeshVertex& a, const MeshVertex& b,
                     const Vec<3>& eye, double guess) {
    const auto ends = limits(surface);
    const auto place = [&](double t) { return clamped((1 - t) * a.uv + t * b.uv, ends); };
    const auto f = [&](double t) { return dot(normal(surface, place(t).c), eye); };
    double lo = 0, hi = 1;
    const double f0 = f(0);
    if (f0 * f(1) < 0) {
        for (int i = 0; i < kBisections; ++i) {
            const double middle = lo + (hi - lo) / 2;
            ((f(middle) < 0) == (f0 < 0) ? lo : hi) = middle;
        }
        guess = lo;
    }
    return jet<0>(surface, place(guess).c).value();
}

}  // namespace

std::vector<double> isoline_levels(const SurfaceGeometry& surface, int axis, const Interval& on,
                                   std::optional<int> count) {
    std::vector<double> out;
    const auto even = [&](double lo, double hi, std::size_t parts) {
        for (std::size_t k = 1; k < parts; ++k) out.push_back(lo + (hi - lo) * double(k) / double(parts));
    };
    if (count) {
        even(on.lo, on.hi, std::size_t(*count) + 1);
        return out;
    }
    const BSplineBasis* basis = nullptr;
    int degrees = 0;
    visit_one(
        [&](const auto& s) {
            if constexpr (requires { s.net(); }) {
                basis = &s.basis(axis);
                degrees = std::max(s.basis(0).degree(), s.basis(1).degree());
            }
        },
        surface);
    if (!basis || degrees < 2) return out;
    std::vector<double> breaks{on.lo};
    for (const double b : basis->breaks())
        if (on.lo < b && b < on.hi) breaks.push_back(b);
    breaks.push_back(on.hi);
    const std::size_t spans = breaks.size() - 1;
    if (spans > kMostLines) {
        for (std::size_t i = 1; i < kMostLines; ++i) out.push_back(breaks[i * spans / kMostLines]);
        return out;
    }
    for (std::size_t i = 0; i < spans; ++i) {
        if (i > 0) out.push_back(breaks[i]);
        even(breaks[i], breaks[i + 1], (kFewestLines + spans - 1) / spans);
    }
    return out;
}

std::vector<SurfaceLine> isolines(const Model& model, const TriangleMesh& mesh, std::optional<int> count) {
    std::vector<SurfaceLine> out;
    std::vector<double> values(mesh.vertices.size());
    const auto on_mesh = [&](const EdgePlace& p) {
        const Vec<3>&a = mesh.points[std::size_t(mesh.vertices[std::size_t(p.a)].point)],
              &b = mesh.points[std::size_t(mesh.vertices[std::size_t(p.b)].point)];
        return (1 - p.t) * a + p.t * b;
    };
    for (int axis = 0; axis < 2; ++axis) {
        for (std::size_t v = 0; v < values.size(); ++v) values[v] = mesh.vertices[v].uv[axis];
        for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
            const MeshPart& part = mesh.parts[i];
            if (part.face < 0 || part.count == 0) continue;
            const SurfaceGeometry& surface = model.faces[std::size_t(part.face)].surface;
            for (const double at : isoline_levels(surface, axis, parameters_of(mesh, part).side(axis), count))
                for (const LevelLine& line : level_lines(mesh, int(i), values, at))
                    keep(out, part.face, line, on_mesh);
        }
    }
    return out;
}

std::vector<SurfaceLine> silhouettes(const Model& model, const TriangleMesh& mesh, const Vec<3>& eye) {
    std::vector<SurfaceLine> out;
    std::vector<double> values(mesh.vertices.size());
    for (std::size_t v = 0; v < values.size(); ++v) {
        values[v] = dot(mesh.vertices[v].normal, eye);
        if (std::abs(values[v]) < kEdgeOn) values[v] = 0;
    }
    // The last part that has a value < 0, and one >= 0, at a point.
    std::vector<std::array<int, 2>> seen(mesh.points.size(), {-1, -1});
    for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
        const MeshPart& part = mesh.parts[i];
        const int face = part.face, now = int(i);
        if (face < 0) continue;
        for (int k = part.first; k < part.first + part.count; ++k)
            for (const int v : mesh.triangles[std::size_t(k)])
                seen[std::size_t(mesh.vertices[std::size_t(v)].point)][values[std::size_t(v)] >= 0] = now;
        const auto turns = [&](int v) {
            return seen[std::size_t(mesh.vertices[std::size_t(v)].point)] == std::array{now, now};
        };
        const SurfaceGeometry& surface = model.faces[std::size_t(face)].surface;
        for (LevelLine& line : level_lines(mesh, now, values, 0)) {
            for (EdgePlace* end : {&line.places.front(), &line.places.back()})
                if (const bool a = turns(end->a); !line.closed && a != turns(end->b))
                    (a ? end->b : end->a) = a ? end->a : end->b, end->t = 0;
            keep(out, face, line, [&](const EdgePlace& p) {
                return turning_point(surface, mesh.vertices[std::size_t(p.a)],
                                     mesh.vertices[std::size_t(p.b)], eye, p.t);
            });
        }
    }
    return out;
}

std::vector<SurfaceNormal> surface_normals(const TriangleMesh& mesh, int count) {
    std::vector<SurfaceNormal> out;
    for (const MeshPart& part : mesh.parts) {
        const Box<2> box = parameters_of(mesh, part);
        std::set<std::pair<double, double>> taken;
        const Vec<2> step = (1.0 / count) * (box.hi - box.lo);
        if (!(step[0] > 0 && step[1] > 0)) continue;
        for (int i = part.first; i < part.first + part.count; ++i) {
            std::array<const MeshVertex*, 3> v{};
            Box<2> steps;  // of the triangle, in steps of the grid, whose places are in the middle of cells
            std::array<Vec<2>, 3> q;
            for (std::size_t k = 0; k < 3; ++k) {
                v[k] = &mesh.vertices[std::size_t(mesh.triangles[std::size_t(i)][k])];
                for (int d = 0; d < 2; ++d) q[k][d] = (v[k]->uv[d] - box.lo[d]) / step[d] - 0.5;
                steps.add(q[k]);
            }
            const auto area = [](const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) {
                return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            };
            const double whole = area(q[0], q[1], q[2]);
            if (whole == 0) continue;
            for (double x = std::ceil(steps.lo[0]); x <= steps.hi[0]; ++x)
                for (double y = std::ceil(steps.lo[1]); y <= steps.hi[1]; ++y) {
                    const Vec<2> at{{x, y}};
                    const std::array<double, 3> w{area(at, q[1], q[2]) / whole, area(q[0], at, q[2]) / whole,
                                                  area(q[0], q[1], at) / whole};
                    // On a side between two triangles both may say yes.
                    if (!(w[0] >= 0 && w[1] >= 0 && w[2] >= 0) || !taken.insert({x, y}).second) continue;
                    SurfaceNormal n{part.face, {}, {}};
                    for (std::size_t k = 0; k < 3; ++k) {
                        n.foot += w[k] * mesh.points[std::size_t(v[k]->point)];
                        n.normal += w[k] * v[k]->normal;
                    }
                    n.normal = unit(n.normal);
                    if (max_abs(n.normal) > 0) out.push_back(n);
                }
        }
    }
    return out;
}

}  // namespace freiform

// Why a twentieth of the area and not the extremes: curvatures grow without limit towards a degenerate
// corner, and one such corner would leave a single colour for all the rest.
#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/model/surface_field.hpp>
#include <freiform/query/surface_curvature.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freiform {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kSingular = 1e-7;  // |S_u x S_v| of that inside the triangle: a pole up to rounding
constexpr double kLeftOut = 0.05;   // of the area, at each end
constexpr int kFootSteps = 4;

double pick(const SurfaceCurvature& c, SurfaceField field, bool flipped) {
    switch (field) {
        case SurfaceField::gauss:
            return c.gauss.value;
        case SurfaceField::mean:
            return flipped ? -c.mean.value : c.mean.value;
        case SurfaceField::greatest:
            return flipped ? -c.least.value : c.greatest.value;
        default:
            return flipped ? -c.greatest.value : c.least.value;
    }
}

// Nothing where the surface is singular.
double curvature(const SurfaceGeometry& surface, const Vec<2>& uv, const Vec<2>& inside,
                 const Vec<3>& outward, SurfaceField field) {
    const auto j = jet<2>(surface, uv.c);
    const auto inner = jet<1>(surface, inside.c);
    const Vec<3> n = cross(j.d[1], j.d[2]);
    if (!(norm(n) > kSingular * norm(cross(inner.d[1], inner.d[2])))) return kNan;
    std::array<BoundedVec<3>, 6> d;
    for (std::size_t i = 0; i < 6; ++i)
        for (int c = 0; c < 3; ++c) d[i][std::size_t(c)] = j.d[i][c];
    const auto c = surface_curvature(d);
    if (!c) return kNan;
    const double value = pick(*c, field, dot(n, outward) < 0);
    return std::isfinite(value) ? value : kNan;
}

// The distance of the point from the surface, from what is near the parameters: no less than the true one.
double distance_near(const SurfaceGeometry& surface, const Vec<3>& p, Vec<2> uv,
                     const std::array<Interval, 2>& ends) {
    double best = norm(jet<0>(surface, uv.c).value() - p);
    for (int step = 0; step < kFootSteps; ++step) {  // Gauss-Newton
        const auto j = jet<1>(surface, uv.c);
        const Vec<3> off = p - j.d[0];
        const double a = dot(j.d[1], j.d[1]), b = dot(j.d[1], j.d[2]), c = dot(j.d[2], j.d[2]),
                     det = a * c - b * b, u = dot(j.d[1], off), v = dot(j.d[2], off);
        if (!(det > 0)) break;
        const Vec<2> next = clamped(uv + Vec<2>{{(c * u - b * v) / det, (a * v - b * u) / det}}, ends);
        const double distance = norm(jet<0>(surface, next.c).value() - p);
        if (!(distance < best)) break;
        best = distance, uv = next;
    }
    return best;
}

}  // namespace

FieldValues surface_field(const Model& model, const TriangleMesh& mesh, SurfaceField field) {
    FieldValues out;
    out.values.assign(mesh.vertices.size(), kNan);
    std::vector<int> face(mesh.vertices.size(), -1);
    std::vector<Vec<2>> inside(mesh.vertices.size());
    for (const MeshPart& part : mesh.parts)
        for (int i = part.first; i < part.first + part.count; ++i) {
            const auto& t = mesh.triangles[std::size_t(i)];
            Vec<2> middle{};
            for (const int v : t) middle += (1.0 / 3) * mesh.vertices[std::size_t(v)].uv;
            for (const int v : t) face[std::size_t(v)] = part.face, inside[std::size_t(v)] = middle;
        }
    std::vector<char> beside(mesh.vertices.size(), 0);
    parallel_for(mesh.vertices.size(), 256, [&](std::size_t i) {
        if (face[i] < 0) return;
        const SurfaceGeometry& surface = model.faces[std::size_t(face[i])].surface;
        const auto ends = limits(surface);
        const MeshVertex& v = mesh.vertices[i];
        const Vec<2> uv = clamped(v.uv, ends), inner = clamped(inside[i], ends);
        if (field == SurfaceField::error) {
            out.values[i] = distance_near(surface, mesh.points[std::size_t(v.point)], uv, ends);
            return;
        }
        for (const double step : {0.0, 1e-3, 1e-2}) {
            out.values[i] = curvature(surface, (1 - step) * uv + step * inner, inner, v.normal, field);
            if (!std::isnan(out.values[i])) return;
            beside[i] = 1;
        }
    });
    for (std::size_t i = 0; i < beside.size(); ++i)
        (std::isnan(out.values[i]) ? out.missing : out.beside) += beside[i];
    return out;
}

Interval usual_range(const TriangleMesh& mesh, std::span<const double> values) {
    std::vector<std::pair<double, double>> parts;  // value, area
    double area = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        const auto p = mesh.points_of(i);
        double mean = 0;
        for (const int v : t) mean += values[std::size_t(v)] / 3;
        const Vec<3>& a = mesh.points[std::size_t(p[0])];
        const double size =
            norm(cross(mesh.points[std::size_t(p[1])] - a, mesh.points[std::size_t(p[2])] - a));
        if (!std::isfinite(mean) || !(size > 0)) continue;
        parts.emplace_back(mean, size);
        area += size;
    }
    if (parts.empty()) return {1, 0};
    sort(parts);
    const auto bound = [&](auto begin, auto end) {
        double left = kLeftOut * area;
        for (; begin + 1 != end && (left -= begin->second) > 0;) ++begin;
        return begin->first;
    };
    return {bound(parts.begin(), parts.end()), bound(parts.rbegin(), parts.rend())};
}

}  // namespace freiform

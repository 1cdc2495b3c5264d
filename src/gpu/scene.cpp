// Camera. Rotated coordinates are x to the right, y up, z towards the eye, in units of half the largest side
// of the model's box. With k = 1 / distance (0 for parallel rays) a point is drawn at (x, y) / (1 - k z). The
// box of all drawn points is fitted into the picture, and the range of z into the depth buffer.
#include "gpu/scene.hpp"

#include "gpu/outward_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/interval.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {
namespace {

constexpr double kInverseDistance = 0.2;  // the eye is 5 half sides away: mild, and always outside the model
constexpr double kNearest = 0.1;          // lines that come nearer to the eye, or behind it, are cut off
constexpr double kFlat = 1 - 1e-9;        // cosine of the angle between triangles of one plane
constexpr double kDepthUsed = 0.98;       // the rest is for lines, which are drawn a little nearer

struct Axes {
    Vec<3> right, up, eye;
};

Axes axes_of(const View& view) {
    const double ca = std::cos(view.azimuth), sa = std::sin(view.azimuth);
    const double ce = std::cos(view.elevation), se = std::sin(view.elevation);
    const Vec<3> right{{-sa, ca, 0}}, eye{{ce * ca, ce * sa, se}};
    return {right, cross(eye, right), eye};
}

// Maps to the coordinates of the scene.
struct Centring {
    Vec<3> middle{};
    double size = 0;
    Vec<3> operator()(const Vec<3>& p) const {
        Vec<3> q{};
        for (int d = 0; d < 3; ++d) q[d] = size > 0 ? (p[d] - middle[d]) / size : 0;
        return q;
    }
};

Centring centring_of(const TriangleMesh& mesh) {
    Box<3> box;
    for (const auto& t : mesh.triangles)
        for (int v : t) box.add(mesh.points[std::size_t(mesh.vertices[std::size_t(v)].point)]);
    Centring c;
    if (box.is_empty()) return c;
    Vec<3> half;
    for (int d = 0; d < 3; ++d) {
        c.middle[d] = box.lo[d] / 2 + box.hi[d] / 2;
        half[d] = box.hi[d] / 2 - box.lo[d] / 2;
    }
    c.size = max_abs(half);
    return c;
}

// Where a value lies on the map, not yet held to [0, 1]: that would bend what is interpolated.
std::array<float, 2> on_map(double value, const RenderOptions& o) {
    if (!std::isfinite(value)) return {0, 0};
    const double most = std::max(std::abs(o.range.lo), std::abs(o.range.hi));
    const double t = o.painting == Painting::diverging ? (most > 0 ? 0.5 + value / most / 2 : 0.5)
                     : o.range.length() > 0            ? (value - o.range.lo) / o.range.length()
                                                       : 0;
    return {float(std::clamp(t, -1e4, 1e4)), 1};
}

std::array<float, 3> to_floats(const Vec<3>& p) { return {float(p[0]), float(p[1]), float(p[2])}; }

std::array<std::uint8_t, 4> to_bytes(const Colour& c, int outward) {
    const auto byte = [](double x) { return std::uint8_t(std::lround(255 * x)); };
    return {byte(c.r), byte(c.g), byte(c.b), outward_byte(outward)};
}

// Vertices are copied per part, so that each copy can have the colour of its part.
void add_triangles(GpuScene& scene, const TriangleMesh& mesh, const std::vector<Vec<3>>& points,
                   const RenderOptions& options, std::span<const int> outward) {
    const Colour& uncoloured = options.colour;
    std::vector<std::pair<int, std::uint32_t>> copy(mesh.vertices.size(), {-1, 0});
    scene.vertices.reserve(mesh.vertices.size());
    scene.indices.reserve(3 * mesh.triangles.size());
    const auto add = [&](int part, std::size_t first, std::size_t count, const Colour& colour) {
        for (std::size_t t = first; t < first + count; ++t)
            for (int v : mesh.triangles[t]) {
                auto& [owner, index] = copy[std::size_t(v)];
                if (owner != part) {
                    const MeshVertex& from = mesh.vertices[std::size_t(v)];
                    index = std::uint32_t(scene.vertices.size());
                    scene.vertices.push_back({to_floats(points[std::size_t(from.point)]),
                                              to_floats(unit(from.normal)),
                                              to_bytes(colour, outward[t]),
                                              {}});
                    if (!options.field.empty())
                        scene.vertices.back().field = on_map(options.field[std::size_t(v)], options);
                    owner = part;
                }
                scene.indices.push_back(index);
            }
    };
    if (mesh.parts.empty()) add(0, 0, mesh.triangles.size(), uncoloured);
    for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
        const MeshPart& part = mesh.parts[i];
        add(int(i), std::size_t(part.first), std::size_t(part.count), part.colour.value_or(uncoloured));
    }
}

void add_lines(GpuScene& scene, const TriangleMesh& mesh, const std::vector<Vec<3>>& points,
               const RenderOptions& options, std::span<const MeshEdge> all) {
    if (!options.edges && !options.outlines) return;
    std::vector<int> part_of(mesh.triangles.size(), 0);
    for (std::size_t i = 0; i < mesh.parts.size(); ++i)
        std::fill_n(part_of.begin() + mesh.parts[i].first, mesh.parts[i].count, int(i));
    // A flat area of a level is many faces of one triangle with one name: their sides are no borders.
    const auto one_area = [&](int first, int second) {
        const MeshPart &p = mesh.parts[std::size_t(part_of[std::size_t(first)])],
                       &q = mesh.parts[std::size_t(part_of[std::size_t(second)])];
        return p.count == 1 && q.count == 1 && !p.name.empty() && p.name == q.name &&
               dot(triangle_normal(mesh, std::size_t(first)), triangle_normal(mesh, std::size_t(second))) >
                   kFlat;
    };
    for (const MeshEdge& edge : all) {
        const auto [first, second] = edge.triangles;
        const bool outline = second < 0 || (part_of[std::size_t(first)] != part_of[std::size_t(second)] &&
                                            !one_area(first, second));
        const SceneLine line{to_floats(points[std::size_t(edge.a)]), to_floats(points[std::size_t(edge.b)])};
        if (outline && options.outlines) {
            scene.outlines.push_back(line);
        } else if (options.edges) {
            scene.edges.push_back(line);
        }
    }
}

void set_camera(GpuScene& scene, std::span<const std::array<float, 3>> shown, const RenderOptions& options) {
    const Axes axes = axes_of(options.view);
    const std::array<Vec<3>, 3> rows{axes.right, axes.up, axes.eye};
    const double k = options.perspective ? kInverseDistance : 0;
    Box<3> box;
    const auto add = [&](const std::array<float, 3>& at) {
        const Vec<3> p{{at[0], at[1], at[2]}};
        const double z = dot(axes.eye, p), w = 1 - k * z;
        if (w > kNearest) box.add(Vec<3>{{dot(axes.right, p) / w, dot(axes.up, p) / w, z}});
    };
    for (const auto& p : shown) add(p);
    if (box.is_empty()) box.add(Vec<3>{{0, 0, 0}});
    const double share = options.room / options.width;  // taken away at the right
    const double usable =
        1 - share - 2 * options.margin * std::min(options.width, options.height) / options.width;
    const double usable_y = 1 - 2 * options.margin * std::min(options.width, options.height) / options.height;
    const double wide = box.hi[0] - box.lo[0], high = box.hi[1] - box.lo[1], deep = box.hi[2] - box.lo[2];
    const double tiny = 1e-6;  // of a model of size 2: one seen edge on still gets a finite scale
    const double scale = std::min(usable * options.width / std::max(wide, tiny),
                                  usable_y * options.height / std::max(high, tiny));
    const double shift = -share;  // of the middle, in half widths
    const double sx = 2 * scale / options.width, sy = 2 * scale / options.height;
    const double cx = (box.lo[0] + box.hi[0]) / 2, cy = (box.lo[1] + box.hi[1]) / 2;
    // Depth a z + b over 1 - k z is -kDepthUsed at the nearest point and kDepthUsed at the farthest.
    double a = 0, b = 0;
    if (deep > tiny) {
        const double near = -kDepthUsed * (1 - k * box.hi[2]), far = kDepthUsed * (1 - k * box.lo[2]);
        a = (near - far) / deep;
        b = near - a * box.hi[2];
    }
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) scene.rotation[3 * j + i] = float(rows[i].c[j]);
    const std::array<double, 16> m{
        sx, 0, 0, 0, 0, sy, 0, 0, k * (cx * sx - shift), k * cy * sy, a, -k, shift - cx * sx, -cy * sy, b, 1};
    std::transform(m.begin(), m.end(), scene.projection.begin(), [](double x) { return float(x); });
    scene.inverse_distance = float(k);
    scene.pixels = float(scale);
}

// All that is drawn, or the frame that is asked for.
std::vector<std::array<float, 3>> shown_points(const GpuScene& scene, const Centring& centred,
                                               const RenderOptions& options) {
    std::vector<std::array<float, 3>> out;
    for (const Vec<3>& p : options.frame) out.push_back(to_floats(centred(p)));
    if (!out.empty()) return out;
    for (const SceneVertex& v : scene.vertices) out.push_back(v.position);
    for (const auto& lines : scene.lines)
        for (const SceneLine& line : lines) out.push_back(line.from), out.push_back(line.to);
    return out;
}

void add_user_lines(GpuScene& scene, const Centring& centred, const RenderOptions& options) {
    for (const RenderLines& lines : options.lines) {
        scene.lines.emplace_back();
        for (const auto& [from, to] : lines.segments)
            scene.lines.back().push_back({to_floats(centred(from)), to_floats(centred(to))});
    }
}

}  // namespace

GpuScene make_scene(const TriangleMesh& mesh, const RenderOptions& options) {
    GpuScene scene;
    const Centring centred = centring_of(mesh);
    std::vector<Vec<3>> points;
    for (const Vec<3>& p : mesh.points) points.push_back(centred(p));
    add_user_lines(scene, centred, options);
    const std::vector<MeshEdge> all = edges(mesh);
    add_triangles(scene, mesh, points, options, outward_sides(mesh, points, all));
    add_lines(scene, mesh, points, options, all);
    set_camera(scene, shown_points(scene, centred, options), options);
    return scene;
}

double pixel_size(const TriangleMesh& mesh, const RenderOptions& options) {
    GpuScene scene;
    const Centring centred = centring_of(mesh);
    if (!(centred.size > 0)) return 0;
    const Vec<3> eye = axes_of(options.view).eye;
    double nearest = -kInfinity;
    for (const Vec<3>& p : mesh.points) {
        scene.vertices.push_back({.position = to_floats(centred(p))});
        nearest = std::max(nearest, dot(eye, centred(p)));
    }
    add_user_lines(scene, centred, options);
    set_camera(scene, shown_points(scene, centred, options), options);
    return centred.size * (1 - scene.inverse_distance * nearest) / scene.pixels;
}

GpuScene make_scene(const SurfaceBuffers& surfaces, const RenderOptions& options) {
    GpuScene scene;
    const Centring centred{surfaces.middle, surfaces.size};
    add_user_lines(scene, centred, options);
    auto shown = shown_points(scene, centred, options);
    if (options.frame.empty())
        for (const Vec<3>& p : surfaces.extent) shown.push_back(to_floats(centred(p)));
    set_camera(scene, shown, options);
    return scene;
}

}  // namespace freiform

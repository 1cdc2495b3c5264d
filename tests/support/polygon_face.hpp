// Faces on any surface, bounded by polygons in its parameters.
#pragma once
#include <freiform/model/model.hpp>

#include <support/random.hpp>
#include <vector>

namespace freiform::test {

inline Model polygon_face(const SurfaceGeometry& surface, const std::vector<Vec<2>>& corners) {
    Model m;
    Face f;
    f.surface = surface;
    f.loops.emplace_back();
    const int n = int(corners.size());
    for (int i = 0; i < n; ++i) {
        const Vec<2> from = corners[std::size_t(i)], to = corners[std::size_t((i + 1) % n)];
        m.vertices.push_back({jet<0>(surface, from.c).value(), 1e-9});
        m.edges.push_back({{}, false, {0, 1}, i, (i + 1) % n, 1e-9, ""});
        f.loops[0].coedges.push_back({i, false, Line<2>{from, to - from}});
    }
    m.faces = {f};
    m.shells = {{{{0, false}}, false}};
    m.bodies = {{{0}, false, "", {}}};
    return must(make_model(std::move(m)));
}
inline Model polygon_face(const SurfaceGeometry& surface, const Box<2>& on) {
    return polygon_face(surface, {on.lo, {{on.hi[0], on.lo[1]}}, on.hi, {{on.lo[0], on.hi[1]}}});
}

// Points of the face: of a grid of the parameters with so many steps each way, and on its sides.
inline std::vector<Vec<3>> places_on(const SurfaceGeometry& surface, const std::vector<Vec<2>>& corners,
                                     int steps) {
    Box<2> box;
    for (const Vec<2>& c : corners) box.add(c);
    const auto is_inside = [&](const Vec<2>& q) {
        bool inside = false;
        for (std::size_t i = 0, k = corners.size() - 1; i < corners.size(); k = i++) {
            const Vec<2>&a = corners[i], &b = corners[k];
            if ((a[1] > q[1]) != (b[1] > q[1]) && q[0] < (b[0] - a[0]) * (q[1] - a[1]) / (b[1] - a[1]) + a[0])
                inside = !inside;
        }
        return inside;
    };
    std::vector<Vec<3>> out;
    const Vec<2> size = box.hi - box.lo;
    for (int i = 0; i <= steps; ++i)
        for (int k = 0; k <= steps; ++k)
            if (const Vec<2> q{{box.lo[0] + size[0] * i / steps, box.lo[1] + size[1] * k / steps}};
                is_inside(q))
                out.push_back(jet<0>(surface, q.c).value());
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (int k = 0; k < steps; ++k) {
            const Vec<2>&a = corners[i], &b = corners[(i + 1) % corners.size()];
            out.push_back(jet<0>(surface, (a + (double(k) / steps) * (b - a)).c).value());
        }
    return out;
}

}  // namespace freiform::test

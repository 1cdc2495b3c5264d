// Triangles that are fine in the parameter plane and not in space, where corners of the boundary are the same
// point: they get further points. See face_mesh.cpp for the whole.
#include "filler_detail.hpp"

#include <freiform/core/sort.hpp>

#include <algorithm>
#include <tuple>

namespace freiform {

namespace {

constexpr double kFlat = 1e-9;  // of the squared longest side: no area

}  // namespace

// A point in the middle of the side, if it is one and not of the boundary.
bool Filler::halve(int v, int w) {
    const auto e = t_.find_edge(v, w);
    if (e.triangle < 0 || t_.is_constrained(e.triangle, e.edge)) return false;
    return t_.insert(scaled(0.5 * (uv(v) + uv(w))), e.triangle).status == Triangulation::Insert::done;
}

// The longest sides of triangles without area that have a corner at one of several places of its point.
std::vector<std::array<int, 2>> Filler::flat_sides(std::span<const int> place,
                                                   std::span<const int> corners_at) const {
    std::vector<std::array<int, 2>> out;
    const auto id = [&](int v) { return v < int(place.size()) ? place[std::size_t(v)] : v; };
    const auto is_shared = [&](int v) {
        return v < int(place.size()) && corners_at[std::size_t(place[std::size_t(v)])] > 1;
    };
    for (int i = 0; i < t_.size(); ++i) {
        if (!t_.is_inside(i)) continue;
        const auto& v = t_.vertices(i);
        if (!is_shared(v[0]) && !is_shared(v[1]) && !is_shared(v[2])) continue;
        if (id(v[0]) == id(v[1]) || id(v[1]) == id(v[2]) || id(v[2]) == id(v[0])) continue;
        std::array<Vec<3>, 3> p;
        for (std::size_t k = 0; k < 3; ++k) p[k] = jet<0>(surface_.geometry(), uv(v[k]).c).value();
        std::size_t longest = 0;
        const auto side = [&](std::size_t k) { return norm(p[(k + 1) % 3] - p[k]); };
        for (std::size_t k = 1; k < 3; ++k)
            if (side(k) > side(longest)) longest = k;
        if (norm(cross(p[1] - p[0], p[2] - p[0])) > kFlat * side(longest) * side(longest)) continue;
        out.push_back({v[longest], v[(longest + 1) % 3]});
    }
    return out;
}

// Around a pole two triangles that are neighbours across a single inner point fall on each other, and so do
// edges across a seam when a strip is one edge wide. And a triangle of a pole and two points of another line
// to it than that of its corner there has no area where these lines are straight.
int Filler::separate(std::span<const int> place) {
    std::vector<int> corners_at(place.size(), 0);
    const auto id = [&](int v) { return v < int(place.size()) ? place[std::size_t(v)] : v; };
    for (int p : place) ++corners_at[std::size_t(p)];
    struct Side {
        int a, b, u, v;
        bool operator<(const Side& o) const { return std::tie(a, b, u, v) < std::tie(o.a, o.b, o.u, o.v); }
    };
    std::vector<Side> sides;
    for (int i = 0; i < t_.size(); ++i) {
        if (!t_.is_inside(i)) continue;
        const auto& v = t_.vertices(i);
        if (id(v[0]) == id(v[1]) || id(v[1]) == id(v[2]) || id(v[2]) == id(v[0])) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const int u = std::min(v[k], v[(k + 1) % 3]), w = std::max(v[k], v[(k + 1) % 3]);
            if (u >= int(place.size()) || (corners_at[std::size_t(id(u))] < 2 &&
                                           (w >= int(place.size()) || corners_at[std::size_t(id(w))] < 2)))
                continue;
            const int a = id(u), b = id(w);
            sides.push_back({std::min(a, b), std::max(a, b), u, w});
        }
    }
    sort(sides.begin(), sides.end());
    int inserted = 0;
    for (const auto& [u, w] : flat_sides(place, corners_at)) inserted += halve(u, w);
    for (std::size_t i = 0, j; i < sides.size(); i = j) {
        for (j = i; j < sides.size() && sides[j].a == sides[i].a && sides[j].b == sides[i].b;) ++j;
        if (j - i <= 2) continue;
        for (std::size_t k = i; k < j; ++k) {
            if (k > i && sides[k].u == sides[k - 1].u && sides[k].v == sides[k - 1].v) continue;
            inserted += halve(sides[k].u, sides[k].v);
        }
    }
    return inserted;
}

}  // namespace freiform

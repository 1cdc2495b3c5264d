// Method. Whether a side is halved depends on its two points alone, so the triangles on both sides agree. A
// triangle with 1, 2 or 3 halved sides becomes 2, 3 or 4. A side and the new ones inside a triangle are at
// most half as long as the longest before, or as long as a side that stays: about log2(longest side /
// longest) rounds.
#include <freiform/mesh/refine.hpp>

#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace freiform {

namespace {

using Halves = std::unordered_map<std::uint64_t, int>;

std::uint64_t key(int a, int b) {
    const auto [lo, hi] = std::minmax(a, b);
    return std::uint64_t(std::uint32_t(lo)) << 32 | std::uint32_t(hi);
}

class Round {
public:
    Round(TriangleMesh& mesh, double longest) : mesh_(mesh), longest_(longest) {}

    // False if nothing was to be done.
    bool run() {
        std::vector<std::array<int, 3>> out;
        out.reserve(2 * mesh_.triangles.size());
        if (mesh_.parts.empty()) {
            for (const auto& t : mesh_.triangles) split(t, out);
        } else {
            for (MeshPart& part : mesh_.parts) {
                const int first = int(out.size());
                for (int i = part.first; i < part.first + part.count; ++i)
                    split(mesh_.triangles[std::size_t(i)], out);
                part.first = first, part.count = int(out.size()) - first;
            }
        }
        mesh_.triangles = std::move(out);
        return !vertices_.empty();
    }

private:
    // The vertex in the middle of a side; -1 if the side stays.
    int half(int v, int w) {
        const MeshVertex a = mesh_.vertices[std::size_t(v)], b = mesh_.vertices[std::size_t(w)];
        const Vec<3> p = mesh_.points[std::size_t(a.point)], q = mesh_.points[std::size_t(b.point)];
        if (a.point == b.point || !(norm(q - p) > longest_)) return -1;
        const auto [vertex, is_new] = vertices_.try_emplace(key(v, w), int(mesh_.vertices.size()));
        if (is_new) {
            const auto [point, new_point] =
                points_.try_emplace(key(a.point, b.point), int(mesh_.points.size()));
            if (new_point) mesh_.points.push_back(0.5 * p + 0.5 * q);
            mesh_.vertices.push_back({point->second, unit(a.normal + b.normal), 0.5 * (a.uv + b.uv)});
        }
        return vertex->second;
    }

    void split(std::array<int, 3> t, std::vector<std::array<int, 3>>& out) {
        std::array<int, 3> h{half(t[0], t[1]), half(t[1], t[2]), half(t[2], t[0])};
        const int halves = (h[0] >= 0) + (h[1] >= 0) + (h[2] >= 0);
        if (halves == 0) return out.push_back(t);
        if (halves == 3) {
            for (const auto& n : {std::array{t[0], h[0], h[2]}, std::array{h[0], t[1], h[1]},
                                  std::array{h[2], h[1], t[2]}, std::array{h[0], h[1], h[2]}})
                out.push_back(n);
            return;
        }
        // Turned so that the first side is halved, and of two the last is not.
        while (!(h[0] >= 0 && h[2] < 0)) t = {t[1], t[2], t[0]}, h = {h[1], h[2], h[0]};
        out.push_back({t[0], h[0], t[2]});
        if (halves == 1) return out.push_back({h[0], t[1], t[2]});
        out.push_back({h[0], t[1], h[1]});
        out.push_back({h[0], h[1], t[2]});
    }

    TriangleMesh& mesh_;
    double longest_;
    Halves points_, vertices_;
};

}  // namespace

TriangleMesh refined(const TriangleMesh& mesh, double longest, std::size_t max_triangles, int rounds) {
    FF_REQUIRE(longest > 0);
    TriangleMesh out = mesh;
    for (int i = 0; 4 * out.triangles.size() <= max_triangles; ++i)
        if (!Round(out, i < rounds ? 0 : longest).run()) break;
    return out;
}

}  // namespace freiform

// Method. A triangle with corners on both sides of the level has exactly two sides that the line crosses. A
// piece runs from the side where the boundary of the triangle goes down to the one where it goes up, so that
// what is above lies on the left; a side between two triangles of the same orientation is the end of one
// piece and the beginning of the next, and following these gives whole lines.
//
// Cost. One pass over the triangles and a sort of the pieces by the side they begin at.
#include <freiform/core/sort.hpp>
#include <freiform/mesh/level_lines.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace freiform {

namespace {

using Side = std::array<int, 2>;  // vertices, the smaller first

struct Piece {
    Side from, to;
    bool used = false;
};

EdgePlace place_on(const Side& s, std::span<const double> values, double level) {
    const double fa = values[std::size_t(s[0])] - level, fb = values[std::size_t(s[1])] - level;
    return {s[0], s[1], std::clamp(fa / (fa - fb), 0.0, 1.0)};  // the signs differ: fa != fb
}

// Triangles [first, first + count).
void add_lines(const TriangleMesh& mesh, int part, std::size_t first, std::size_t count,
               std::span<const double> values, double level, std::vector<LevelLine>& out) {
    std::vector<Piece> pieces;
    for (std::size_t i = first; i < first + count; ++i) {
        const auto& t = mesh.triangles[i];
        std::array<bool, 3> above{};
        for (std::size_t k = 0; k < 3; ++k) above[k] = values[std::size_t(t[k])] >= level;
        if (above[0] == above[1] && above[1] == above[2]) continue;
        Piece piece{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            const auto [a, b] = std::minmax(t[k], t[next]);
            if (above[k] && !above[next]) piece.from = {a, b};
            if (!above[k] && above[next]) piece.to = {a, b};
        }
        pieces.push_back(piece);
    }
    sort(pieces, {}, &Piece::from);
    const auto beginning_at = [&](const Side& s) {
        auto at = std::ranges::lower_bound(pieces, s, {}, &Piece::from);
        while (at != pieces.end() && at->from == s && at->used) ++at;
        return at != pieces.end() && at->from == s ? &*at : nullptr;
    };
    std::vector<Side> ends;
    for (const Piece& p : pieces) ends.push_back(p.to);
    sort(ends);
    const auto follow = [&](Piece* piece) {
        LevelLine line{part, {place_on(piece->from, values, level)}, false};
        const Side start = piece->from;
        for (; piece; piece = beginning_at(piece->to)) {
            piece->used = true;
            line.places.push_back(place_on(piece->to, values, level));
            line.closed = piece->to == start;
            if (line.closed) break;
        }
        out.push_back(std::move(line));
    };
    for (Piece& p : pieces)
        if (!p.used && !std::ranges::binary_search(ends, p.from)) follow(&p);
    for (Piece& p : pieces)
        if (!p.used) follow(&p);
}

// The vertex of the triangle at a point.
const MeshVertex& vertex_at(const TriangleMesh& mesh, int triangle, int point, int& index) {
    for (const int v : mesh.triangles[std::size_t(triangle)])
        if (mesh.vertices[std::size_t(v)].point == point) index = v;
    return mesh.vertices[std::size_t(index)];
}

}  // namespace

std::vector<LevelLine> level_lines(const TriangleMesh& mesh, int part, std::span<const double> values,
                                   double level) {
    FF_REQUIRE(values.size() == mesh.vertices.size());
    std::vector<LevelLine> out;
    if (mesh.parts.empty()) {
        add_lines(mesh, 0, 0, mesh.triangles.size(), values, level, out);
    } else {
        const MeshPart& p = mesh.parts[std::size_t(part)];
        add_lines(mesh, part, std::size_t(p.first), std::size_t(p.count), values, level, out);
    }
    return out;
}

std::vector<LevelLine> level_lines(const TriangleMesh& mesh, std::span<const double> values, double level) {
    if (mesh.parts.empty()) return level_lines(mesh, 0, values, level);
    std::vector<LevelLine> out;
    for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
        auto lines = level_lines(mesh, int(i), values, level);
        std::ranges::move(lines, std::back_inserter(out));
    }
    return out;
}

std::vector<OutlineEdge> outline_edges(const TriangleMesh& mesh, double angle) {
    std::vector<int> part_of(mesh.triangles.size(), 0);
    for (std::size_t i = 0; i < mesh.parts.size(); ++i)
        std::fill_n(part_of.begin() + mesh.parts[i].first, mesh.parts[i].count, int(i));
    const double cosine = std::cos(angle);
    std::vector<OutlineEdge> out;
    for (const MeshEdge& e : edges(mesh)) {
        const auto [s, t] = e.triangles;
        const bool lonely = t < 0 || e.forward + e.backward > 2;
        bool crease = lonely;
        if (!lonely) {
            // Two sides that both run from a to b have opposite orientations.
            const double sign = e.forward == e.backward ? 1 : -1;
            const bool between = part_of[std::size_t(s)] != part_of[std::size_t(t)];
            int bent = 0;
            for (const int point : {e.a, e.b}) {
                int i = 0, j = 0;
                const MeshVertex &v = vertex_at(mesh, s, point, i), &w = vertex_at(mesh, t, point, j);
                if (i == j || sign * dot(v.normal, w.normal) >= cosine) continue;
                crease = crease || ++bent == 2 || between || v.uv == w.uv;
            }
        }
        OutlineEdge edge{e.a, e.b, !crease, {-1, -1}};
        if (s >= 0) edge.parts[0] = part_of[std::size_t(s)];
        if (!lonely) edge.parts[1] = part_of[std::size_t(t)];
        if (edge.parts[1] >= 0 && edge.parts[0] > edge.parts[1]) std::swap(edge.parts[0], edge.parts[1]);
        if (crease || edge.parts[0] != edge.parts[1]) out.push_back(edge);
    }
    return out;
}

std::vector<Outline> outlines(const TriangleMesh& mesh, double angle) {
    std::vector<OutlineEdge> all = outline_edges(mesh, angle);
    const auto kind = [](const OutlineEdge& e) { return std::tuple(e.parts, e.smooth); };
    sort(all, {}, [](const OutlineEdge& e) { return std::tuple(e.parts, e.smooth, e.a, e.b); });
    std::vector<Outline> out;
    for (std::size_t i = 0; i < all.size();) {
        std::size_t j = i;
        std::map<int, std::vector<std::size_t>> at;  // the edges of each point
        for (; j < all.size() && kind(all[j]) == kind(all[i]); ++j)
            for (const int p : {all[j].a, all[j].b}) at[p].push_back(j);
        std::vector<char> used(j - i, 0);
        const auto follow = [&](std::size_t edge, int from) {
            Outline line{all[i].smooth, all[i].parts, {from}};
            for (;;) {
                used[edge - i] = 1;
                const int to = all[edge].a == line.points.back() ? all[edge].b : all[edge].a;
                line.points.push_back(to);
                const auto& next = at[to];
                if (next.size() != 2) break;
                edge = next[0] == edge ? next[1] : next[0];
                if (used[edge - i]) break;
            }
            out.push_back(std::move(line));
        };
        for (const auto& [point, list] : at)
            if (list.size() != 2)
                for (const std::size_t e : list)
                    if (!used[e - i]) follow(e, point);
        for (std::size_t e = i; e < j; ++e)
            if (!used[e - i]) follow(e, all[e].a);
        i = j;
    }
    return out;
}

}  // namespace freiform

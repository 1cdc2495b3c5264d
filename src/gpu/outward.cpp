// What shading has to know of closed surfaces.
//
// Idea. Where a closed surface curves away like a saddle, triangles at its outline are seen from behind, by
// less than a pixel. A normal that is turned to the eye there takes its light from the wrong side: dark dots
// along bright outlines. From outside only the outside is seen, so normals of a closed surface need not be
// turned, once it is known which way is out. Surfaces that enclose nothing are seen from both sides, and
// their normals are turned as before.
//
// Method. Faces, or triangles, that edges join are closed where each edge has two of them. Of triangles the
// volume tells the side. Of faces, about which no volume is known, the point that is farthest in a direction
// does: the outward normal does not point back there. Fourteen directions are asked; those whose answer is
// near a right angle abstain, and one that contradicts the others leaves the side open.
#include "gpu/outward_detail.hpp"

#include <freiform/core/constants.hpp>

#include <array>
#include <cmath>
#include <numeric>

namespace freiform {

namespace {

constexpr double kClear = 0.5;         // cosine beyond which a direction has an opinion
constexpr int kLeastVotes = 3;         // of fourteen
constexpr double kLeastVolume = 1e-6;  // of the cube of the box: less is flat, or crosses itself

// Sets of numbers, joined one pair at a time.
class JoinedSets {
public:
    explicit JoinedSets(std::size_t n) : above_(n) { std::iota(above_.begin(), above_.end(), 0); }
    int root(int i) {
        while (above_[std::size_t(i)] != i) {
            above_[std::size_t(i)] = above_[std::size_t(above_[std::size_t(i)])];
            i = above_[std::size_t(i)];
        }
        return i;
    }
    void join(int i, int j) { above_[std::size_t(root(i))] = root(j); }

private:
    std::vector<int> above_;
};

std::vector<Vec<3>> fourteen_directions() {
    std::vector<Vec<3>> out;
    for (int d = 0; d < 3; ++d)
        for (const double s : {-1.0, 1.0}) {
            Vec<3> v{};
            v[d] = s;
            out.push_back(v);
        }
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0}) out.push_back(unit(Vec<3>{{x, y, z}}));
    return out;
}

Vec<3> normal_of(const Model& model, const FacePoint& p) {
    if (p.normal) return *p.normal;
    const Face& face = model.faces[std::size_t(p.face)];
    const Vec<3> n = normal(face.surface, p.uv.c);
    return face.reversed ? -n : n;
}

struct Votes {
    int out = 0, in = 0;
    int side() const { return in == 0 && out >= kLeastVotes ? 1 : out == 0 && in >= kLeastVotes ? -1 : 0; }
};

}  // namespace

std::vector<int> outward_sides(const Model& model, std::span<const FacePoint> points) {
    std::vector<std::vector<int>> at(model.edges.size());  // faces, once for each coedge
    for (std::size_t f = 0; f < model.faces.size(); ++f)
        for (const Loop& loop : model.faces[f].loops)
            for (const Coedge& c : loop.coedges) at[std::size_t(c.edge)].push_back(int(f));
    JoinedSets sets(model.faces.size());
    std::vector<char> open(model.faces.size());
    for (std::size_t e = 0; e < at.size(); ++e) {
        for (const int f : at[e]) {
            sets.join(f, at[e][0]);
            open[std::size_t(f)] = open[std::size_t(f)] || (!model.edges[e].degenerate && at[e].size() != 2);
        }
    }
    std::vector<char> encloses(model.faces.size(), 1);
    for (std::size_t f = 0; f < open.size(); ++f)
        if (open[f]) encloses[std::size_t(sets.root(int(f)))] = 0;
    std::vector<Votes> votes(model.faces.size());
    for (const Vec<3>& d : fourteen_directions()) {
        std::vector<const FacePoint*> farthest(model.faces.size());
        for (const FacePoint& p : points) {
            const FacePoint*& best = farthest[std::size_t(sets.root(p.face))];
            if (!best || dot(p.at, d) > dot(best->at, d)) best = &p;
        }
        for (std::size_t i = 0; i < farthest.size(); ++i) {
            if (!farthest[i] || !encloses[i]) continue;
            const double along = dot(normal_of(model, *farthest[i]), d);
            votes[i].out += along > kClear, votes[i].in += along < -kClear;
        }
    }
    std::vector<int> sides(model.faces.size());
    for (std::size_t f = 0; f < sides.size(); ++f) sides[f] = votes[std::size_t(sets.root(int(f)))].side();
    return sides;
}

std::vector<int> outward_sides(const TriangleMesh& mesh, std::span<const Vec<3>> points,
                               std::span<const MeshEdge> edges) {
    const std::size_t n = mesh.triangles.size();
    JoinedSets sets(n);
    std::vector<char> encloses(n, 1);
    for (const MeshEdge& e : edges)
        if (e.triangles[1] >= 0) sets.join(e.triangles[0], e.triangles[1]);
    for (const MeshEdge& e : edges)
        if (e.forward != 1 || e.backward != 1)
            for (const int t : e.triangles)
                if (t >= 0) encloses[std::size_t(sets.root(t))] = 0;
    struct Sum {
        double volume = 0, with = 0, area = 0;  // of the vertices' normals with the triangles'
        Box<3> box;
    };
    std::vector<Sum> sums(n);
    for (std::size_t t = 0; t < n; ++t) {
        Sum& s = sums[std::size_t(sets.root(int(t)))];
        std::array<Vec<3>, 3> p, normal;
        for (std::size_t k = 0; k < 3; ++k) {
            const MeshVertex& v = mesh.vertices[std::size_t(mesh.triangles[t][k])];
            p[k] = points[std::size_t(v.point)], normal[k] = unit(v.normal);
            s.box.add(p[k]);
        }
        const Vec<3> across = cross(p[1] - p[0], p[2] - p[0]);
        s.volume += dot(p[0], across) / 6;
        s.area += norm(across);
        for (const Vec<3>& m : normal) s.with += dot(m, across) / 3;
    }
    std::vector<int> sides(n);
    for (std::size_t t = 0; t < n; ++t) {
        const std::size_t i = std::size_t(sets.root(int(t)));
        const Sum& s = sums[i];
        const double size = max_abs(s.box.hi - s.box.lo);
        if (!encloses[i] || !(std::abs(s.volume) > kLeastVolume * size * size * size)) continue;
        if (!(std::abs(s.with) > kClear * s.area)) continue;
        sides[t] = (s.volume > 0) == (s.with > 0) ? 1 : -1;
    }
    return sides;
}

}  // namespace freiform

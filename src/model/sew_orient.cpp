// Which side of a coedge its face is on, and faces that agree about it.
//
// The boundary of a mesh runs with the face on its left (in the parameter plane; turned over with the face).
// Loops may be given in either direction, so the left is looked for: from the middle of a coedge a ray to its
// left leaves the face through an odd number of sides if it begins inside (odd-even rule). Two faces agree
// along an edge when their meshes run along it in opposite directions. Samples decide: a wrong answer turns a
// face over and spoils nothing else.
#include "sew_detail.hpp"

#include <freiform/core/sort.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace freiform {

namespace {

constexpr int kSidesPerCoedge = 24;

}  // namespace

std::vector<Side2> sides_along(const CurveGeometry<2>& curve, Interval on) {
    std::vector<Side2> sides;
    Vec<2> last = jet<0>(curve, on.lo).value();
    for (int k = 1; k <= kSidesPerCoedge; ++k) {
        const double t = k == kSidesPerCoedge ? on.hi : on.lo + on.length() * k / kSidesPerCoedge;
        const Vec<2> next = jet<0>(curve, t).value();
        sides.push_back({last, next});
        last = next;
    }
    return sides;
}

namespace {

// Is the face on the left of the coedge's curve, seen in the direction of growing parameters?
bool is_left(std::span<const Side2> all, std::size_t own) {
    const auto& [a, b] = all[own];
    const Vec<2> middle = 0.5 * (a + b), d = b - a, left{{-d[1], d[0]}};
    int crossings = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (k == own) continue;
        const Vec<2> p = all[k][0] - middle, q = all[k][1] - middle;
        const double x = dot(p, d), y = dot(q, d);
        if ((x < 0) == (y < 0)) continue;
        const double where = (dot(p, left) * y - dot(q, left) * x) / (y - x);  // along `left`
        crossings += where > 0;
    }
    return crossings % 2 == 1;
}

struct Use {
    int face = -1;
    bool forward = false;  // the mesh runs along the edge in the direction of its parameter
};

// By face: its normal as its shell has it is that of its surface turned over.
std::vector<char> turned_over_in(const Model& model) {
    std::vector<char> over(model.faces.size(), 0);
    for (const Shell& s : model.shells)
        for (const FaceUse& u : s.faces) over[std::size_t(u.face)] = u.reversed;
    for (std::size_t f = 0; f < over.size(); ++f) over[f] = bool(over[f]) != model.faces[f].reversed;
    return over;
}

std::vector<std::vector<Use>> uses_of(const Model& model, std::span<const char> turned_over) {
    std::vector<std::vector<Use>> uses(model.edges.size());
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        std::vector<Side2> all;
        std::vector<std::pair<int, std::size_t>> middles;
        for (const Loop& l : model.faces[f].loops)
            for (const Coedge& c : l.coedges) {
                const auto own = sides_along(c.curve, model.edges[std::size_t(c.edge)].range);
                middles.push_back({c.edge, all.size() + own.size() / 2});
                all.insert(all.end(), own.begin(), own.end());
            }
        for (const auto& [edge, own] : middles)
            uses[std::size_t(edge)].push_back({int(f), is_left(all, own) != bool(turned_over[f])});
    }
    return uses;
}

}  // namespace

void orient(Model& model, std::span<const SewnEdge> joined, std::vector<int>& flipped,
            std::vector<int>& twisted) {
    const std::vector<char> turned_over = turned_over_in(model);
    const auto uses = uses_of(model, turned_over);
    struct Neighbour {
        int face, edge;
        bool turned;  // one of the two has to be turned over
    };
    std::vector<std::vector<Neighbour>> neighbours(model.faces.size());
    std::vector<char> is_open(model.faces.size(), 0);
    for (std::size_t e = 0; e < uses.size(); ++e) {
        for (const Use& u : uses[e])
            if (uses[e].size() != 2 && !model.edges[e].degenerate) is_open[std::size_t(u.face)] = 1;
        if (uses[e].size() != 2 || uses[e][0].face == uses[e][1].face || model.edges[e].degenerate) continue;
        const bool turned = uses[e][0].forward == uses[e][1].forward;
        for (std::size_t k = 0; k < 2; ++k)
            neighbours[std::size_t(uses[e][k].face)].push_back({uses[e][1 - k].face, int(e), turned});
    }
    std::vector<int> side(model.faces.size(), -1);
    struct Connected {
        std::vector<int> faces;
        PartFacing facing;  // of a closed one, as its first face has it
    };
    std::vector<Connected> parts;
    for (const SewnEdge& s : joined)
        for (const int seed : s.faces) {
            if (side[std::size_t(seed)] >= 0) continue;
            std::vector<int> part{seed};
            side[std::size_t(seed)] = 0;
            for (std::size_t next = 0; next < part.size(); ++next)
                for (const Neighbour& n : neighbours[std::size_t(part[next])]) {
                    const int wanted = side[std::size_t(part[next])] != int(n.turned);
                    int& its = side[std::size_t(n.face)];
                    if (its < 0) {
                        its = wanted;
                        part.push_back(n.face);
                    } else if (its != wanted) {
                        twisted.push_back(n.edge);
                        is_open[std::size_t(n.face)] = 1;
                    }
                }
            parts.push_back({std::move(part), {}});
        }
    for (Connected& p : parts) {
        bool closed = true;
        std::vector<char> inward;
        for (const int f : p.faces) {
            closed = closed && !is_open[std::size_t(f)];
            inward.push_back(char(turned_over[std::size_t(f)] ^ side[std::size_t(f)]));
        }
        if (closed) p.facing = facing(model, p.faces, inward);
    }
    for (const Connected& p : parts) {
        std::size_t over = 0;
        for (const int f : p.faces) over += std::size_t(side[std::size_t(f)]);
        const bool mixed = over != 0 && over != p.faces.size();
        int turn = 2 * over > p.faces.size() ? 0 : 1;
        const Box<3>& box = p.facing.box;
        bool inside = false;
        for (const Connected& o : parts)
            inside = inside || (&o != &p && o.facing.box.contains(box.lo) && o.facing.box.contains(box.hi));
        if (p.facing.sum != 0 && (mixed || !inside)) turn = p.facing.sum > 0 ? 1 : 0;
        for (const int f : p.faces)
            if (side[std::size_t(f)] == turn) flipped.push_back(f);
    }
    for (auto* list : {&flipped, &twisted}) {
        sort(list->begin(), list->end());
        list->erase(std::unique(list->begin(), list->end()), list->end());
    }
    for (const int f : flipped) model.faces[std::size_t(f)].reversed = !model.faces[std::size_t(f)].reversed;
}

void unite_shells(Model& model, std::span<const SewnEdge> joined) {
    const std::size_t n = model.shells.size();
    std::vector<int> root(n);
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](int s) {
        while (root[std::size_t(s)] != s) s = root[std::size_t(s)] = root[std::size_t(root[std::size_t(s)])];
        return s;
    };
    std::vector<int> shell_of(model.faces.size(), -1), count(model.edges.size());
    for (std::size_t i = 0; i < n; ++i)
        for (const FaceUse& u : model.shells[i].faces) shell_of[std::size_t(u.face)] = int(i);
    for (const Face& f : model.faces)
        for (const Loop& l : f.loops)
            for (const Coedge& c : l.coedges) ++count[std::size_t(c.edge)];
    std::vector<char> changed(n, 0);
    for (const SewnEdge& e : joined)
        for (const int f : e.faces) {
            const int one = shell_of[std::size_t(e.faces.front())], other = shell_of[std::size_t(f)];
            if (one < 0 || other < 0) continue;
            changed[std::size_t(one)] = changed[std::size_t(other)] = 1;
            const int a = find(one), b = find(other);
            root[std::size_t(std::max(a, b))] = std::min(a, b);
        }
    // Bodies keep the colour of faces that leave them.
    for (const Body& body : model.bodies)
        for (const int s : body.shells)
            if (find(s) != s && body.colour)
                for (const FaceUse& u : model.shells[std::size_t(s)].faces)
                    if (Face& f = model.faces[std::size_t(u.face)]; !f.colour) f.colour = body.colour;
    std::vector<int> at(n, -1);
    std::vector<Shell> kept;
    for (std::size_t s = 0; s < n; ++s) {
        const std::size_t to = std::size_t(find(int(s)));
        if (to == s) {
            at[s] = int(kept.size());
            kept.push_back(model.shells[s]);
        } else {
            auto& faces = kept[std::size_t(at[to])].faces;
            changed[to] = 1;
            faces.insert(faces.end(), model.shells[s].faces.begin(), model.shells[s].faces.end());
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (at[i] < 0 || !changed[i]) continue;
        Shell& shell = kept[std::size_t(at[i])];
        shell.closed = true;
        for (const FaceUse& u : shell.faces)
            for (const Loop& l : model.faces[std::size_t(u.face)].loops)
                for (const Coedge& c : l.coedges)
                    shell.closed = shell.closed && (model.edges[std::size_t(c.edge)].degenerate ||
                                                    count[std::size_t(c.edge)] >= 2);
    }
    for (Body& b : model.bodies) {
        std::vector<int> shells;
        bool anew = false;
        for (const int s : b.shells) {
            anew = anew || changed[std::size_t(s)];
            if (at[std::size_t(s)] >= 0) shells.push_back(at[std::size_t(s)]);
        }
        b.shells = std::move(shells);
        if (anew)
            b.solid = !b.shells.empty() && std::all_of(b.shells.begin(), b.shells.end(),
                                                       [&](int s) { return kept[std::size_t(s)].closed; });
    }
    std::erase_if(model.bodies, [](const Body& b) { return b.shells.empty(); });
    model.shells = std::move(kept);
}

}  // namespace freiform

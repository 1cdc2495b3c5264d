// Convex hulls in space.
//
// Idea. Quickhull [Barber 1996] with exact signs. Every facet keeps the points that are strictly above it;
// the highest of one is added: the facets it sees are taken away, and those between it and the rim of the
// hole come instead. Above means orient3d, so the hull is that of the given doubles, whatever order rounding
// would see.
//
// Method. A point outside of a convex polyhedron is strictly above a facet, so a point above none is inside
// or on it and is dropped. Points of facets that go are above one of the new ones or inside: the plane of a
// new facet through an edge of the rim is between those of the old facets at this edge. New facets have an
// area: a point on the line through an edge of the rim would not be strictly above the facet that goes.
//
// Cost. n log n as a rule; n^2 / 4 signs at worst, when all points are corners.
#include <freiform/poly/predicates.hpp>
#include <freiform/query/hull.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace freiform {

namespace {

class SpaceHull {
public:
    explicit SpaceHull(std::span<const Vec<3>> points) : points_(points) {}

    // False: all points are in one plane.
    bool build() {
        if (!begin()) return false;
        for (std::size_t f = 0; f < facets_.size(); ++f)
            while (facets_[f].alive && !facets_[f].above.empty()) add(int(f));
        return true;
    }
    std::vector<std::array<int, 3>> triangles() const {
        std::vector<std::array<int, 3>> out;
        for (const Facet& f : facets_)
            if (f.alive) out.push_back(f.corner);
        return out;
    }

private:
    struct Facet {
        std::array<int, 3> corner, beside;  // beside[k]: across the edge from corner k to k + 1
        std::vector<int> above;
        bool alive = true;
    };

    const Vec<3>& at(int i) const { return points_[std::size_t(i)]; }
    bool sees(int p, const Facet& f) const {
        return orient3d(at(f.corner[0]), at(f.corner[1]), at(f.corner[2]), at(p)) < 0;
    }
    double height(int p, const Facet& f) const {
        const Vec<3>& a = at(f.corner[0]);
        return dot(cross(at(f.corner[1]) - a, at(f.corner[2]) - a), at(p) - a);
    }
    bool on_one_line(int a, int b, int c) const {
        for (int k = 0; k < 3; ++k) {
            const auto flat = [&](int i) { return Vec<2>{{at(i)[k], at(i)[(k + 1) % 3]}}; };
            if (orient2d(flat(a), flat(b), flat(c)) != 0) return false;
        }
        return true;
    }
    // The point that is best by `size`, of those that `fits`; the first that fits where sizes are all 0.
    template <class Size, class Fits>
    int best(Size&& size, Fits&& fits) const {
        int found = 0;
        for (int i = 1; i < int(points_.size()); ++i)
            if (size(i) > size(found)) found = i;
        for (int i = 0; !fits(found); ++i) {
            if (i == int(points_.size())) return -1;
            found = i;
        }
        return found;
    }

    bool begin() {
        if (points_.size() < 4) return false;
        const int a = 0;
        const int b = best([&](int i) { return norm(at(i) - at(a)); }, [&](int i) { return at(i) != at(a); });
        if (b < 0) return false;
        const int c = best([&](int i) { return norm(cross(at(i) - at(a), at(b) - at(a))); },
                           [&](int i) { return !on_one_line(a, b, i); });
        if (c < 0) return false;
        const int d =
            best([&](int i) { return std::abs(dot(cross(at(b) - at(a), at(c) - at(a)), at(i) - at(a))); },
                 [&](int i) { return orient3d(at(a), at(b), at(c), at(i)) != 0; });
        if (d < 0) return false;
        const bool below = orient3d(at(a), at(b), at(c), at(d)) > 0;
        const std::array<int, 4> v = below ? std::array{a, b, c, d} : std::array{a, c, b, d};
        facets_ = {{{v[0], v[1], v[2]}, {1, 2, 3}, {}, true},
                   {{v[1], v[0], v[3]}, {0, 3, 2}, {}, true},
                   {{v[2], v[1], v[3]}, {0, 1, 3}, {}, true},
                   {{v[0], v[2], v[3]}, {0, 2, 1}, {}, true}};
        std::vector<int> all(points_.size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = int(i);
        share_out(all, {0, 1, 2, 3});
        return true;
    }

    void share_out(const std::vector<int>& points, const std::vector<int>& facets) {
        for (const int p : points)
            for (const int f : facets)
                if (Facet& facet = facets_[std::size_t(f)]; sees(p, facet)) {
                    facet.above.push_back(p);
                    break;
                }
    }

    // The highest point above facet f.
    void add(int f) {
        const std::vector<int>& above = facets_[std::size_t(f)].above;
        const int p =
            *std::ranges::max_element(above, {}, [&](int i) { return height(i, facets_[std::size_t(f)]); });
        std::vector<int> seen{f}, points;
        facets_[std::size_t(f)].alive = false;
        struct Rim {
            int from, to, outer;
        };
        std::vector<Rim> rim;
        for (std::size_t k = 0; k < seen.size(); ++k) {
            Facet& facet = facets_[std::size_t(seen[k])];
            points.insert(points.end(), facet.above.begin(), facet.above.end());
            facet.above = {};
            for (std::size_t e = 0; e < 3; ++e) {
                Facet& other = facets_[std::size_t(facet.beside[e])];
                if (!other.alive) continue;
                if (sees(p, other)) other.alive = false, seen.push_back(facet.beside[e]);
            }
        }
        for (const int s : seen)
            for (std::size_t e = 0; e < 3; ++e) {
                const Facet& facet = facets_[std::size_t(s)];
                if (facets_[std::size_t(facet.beside[e])].alive)
                    rim.push_back({facet.corner[e], facet.corner[(e + 1) % 3], facet.beside[e]});
            }
        std::map<int, int> from;  // the new facet whose edge of the rim begins there
        std::vector<int> made;
        for (const Rim& r : rim) {
            const int n = int(facets_.size());
            facets_.push_back({{r.from, r.to, p}, {r.outer, -1, -1}, {}, true});
            Facet& outer = facets_[std::size_t(r.outer)];
            for (std::size_t e = 0; e < 3; ++e)
                if (outer.corner[e] == r.to && outer.corner[(e + 1) % 3] == r.from) outer.beside[e] = n;
            from[r.from] = n;
            made.push_back(n);
        }
        for (const int n : made) {
            const int next = from.at(facets_[std::size_t(n)].corner[1]);
            facets_[std::size_t(n)].beside[1] = next;
            facets_[std::size_t(next)].beside[2] = n;
        }
        share_out(points, made);
    }

    std::span<const Vec<3>> points_;
    std::vector<Facet> facets_;
};

}  // namespace

Result<std::vector<std::array<int, 3>>> hull_triangles(std::span<const Vec<3>> points) {
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"),
                          "has a coordinate that is not finite");
    SpaceHull hull(points);
    if (!hull.build())
        return refuse(RefusalKind::no_answer, "points", text("all ", points.size(), " are in one plane"));
    return hull.triangles();
}

}  // namespace freiform

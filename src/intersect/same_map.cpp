// Maps between parameters of surfaces that are the same; same_map_detail.hpp is the essay.
//
// Accuracy. With common degrees and breaks, pieces of both are sums of the same Bernstein polynomials. Where
// weights are the same up to a common factor and 1 +- e, means of the same points with these weights are
// within 4 e of their size; breaks that differ by d move a point by its derivative times d, which the
// control points within the neighbouring knots bound. Restriction, elevation and insertion are convex
// combinations of a few dozen roundings each.
#include "same_map_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::detail {

namespace {

constexpr int kSamplesOfSame = 5;      // along each axis
constexpr double kNoSlope = 0x1p-30;   // of a matrix of derivatives, that counts as zero
constexpr double kOneBreak = 0x1p-40;  // of the domain

std::array<double, 2> own_sample(const SurfacePart& p, int i, int j) {
    const auto at = [](const Interval& on, int k) {
        return on.lo + on.length() * ((k + 0.5) / kSamplesOfSame);
    };
    return {at(p.on[0], i), at(p.on[1], j)};
}

// Gauss-Newton from y to the foot of a point; the distance.
double foot_of(const SurfacePart& b, const Vec<3>& p, std::array<double, 2>& y) {
    double off = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 30; ++i) {
        const auto j = jet<1>(b.surface, y);
        const Vec<3> r = j.value() - p, u = j.d[1], v = j.d[2];
        off = norm(r);
        const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), det = uu * vv - uv * uv;
        if (!(det > 0)) break;
        const double du = (vv * dot(u, r) - uv * dot(v, r)) / det,
                     dv = (uu * dot(v, r) - uv * dot(u, r)) / det;
        y[0] = clamped(y[0] - du, b.on[0]), y[1] = clamped(y[1] - dv, b.on[1]);
        if (std::abs(du) <= 0x1p-50 * b.on[0].length() && std::abs(dv) <= 0x1p-50 * b.on[1].length()) break;
    }
    return off;
}

struct FootPair {
    std::array<double, 2> x{}, y{};
};
// A point of A that is on B inside of its part.
std::optional<FootPair> foot_pair(const SurfacePart& a, const SurfacePart& b, double tolerance) {
    std::vector<std::pair<std::array<double, 2>, Vec<3>>> on_b;
    for (int i = 0; i < kSamplesOfSame; ++i)
        for (int j = 0; j < kSamplesOfSame; ++j) {
            const auto y = own_sample(b, i, j);
            on_b.push_back({y, jet<0>(b.surface, y).value()});
        }
    for (int i = 0; i < kSamplesOfSame; ++i)
        for (int j = 0; j < kSamplesOfSame; ++j) {
            FootPair out{own_sample(a, i, j), {}};
            const Vec<3> p = jet<0>(a.surface, out.x).value();
            const auto nearest =
                std::ranges::min_element(on_b, {}, [&](const auto& s) { return norm(s.second - p); });
            out.y = nearest->first;
            if (!(foot_of(b, p, out.y) <= tolerance)) continue;
            bool inner = true;
            for (std::size_t k = 0; k < 2; ++k)
                inner = inner && b.on[k].lo < out.y[k] && out.y[k] < b.on[k].hi;
            if (inner) return out;
        }
    return std::nullopt;
}

// M from first derivatives at a pair; nothing: parameters of B depend on both of A.
std::optional<SameMap> map_at(const SurfacePart& a, const SurfacePart& b, const FootPair& at,
                              double tolerance) {
    const auto ja = jet<1>(a.surface, at.x), jb = jet<1>(b.surface, at.y);
    const Vec<3> u = jb.d[1], v = jb.d[2];
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), det = uu * vv - uv * uv;
    if (!(det > 0)) return std::nullopt;
    std::array<std::array<double, 2>, 2> m{};  // m[k][i]: dy[k] / dx[i], in lengths of the parts
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec<3>& d = ja.d[i + 1];
        const double along_u = dot(u, d), along_v = dot(v, d);
        m[0][i] = (vv * along_u - uv * along_v) / det * a.on[i].length() / b.on[0].length();
        m[1][i] = (uu * along_v - uv * along_u) / det * a.on[i].length() / b.on[1].length();
    }
    SameMap out;
    out.swapped = std::abs(m[0][1]) + std::abs(m[1][0]) > std::abs(m[0][0]) + std::abs(m[1][1]);
    for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t i = out.source(k);
        const double size = max_abs(ja.d[i + 1]) * a.on[i].length();
        if (!(std::abs(m[k][1 - i]) <= (kNoSlope + 64 * tolerance / size) * std::abs(m[k][i])))
            return std::nullopt;
        out.scale[k] = m[k][i] * b.on[k].length() / a.on[i].length();
        if (std::abs(std::abs(out.scale[k]) - 1) < 0x1p-40) out.scale[k] = out.scale[k] > 0 ? 1 : -1;
        out.shift[k] = at.y[k] - out.scale[k] * at.x[i];
        // Feet of surfaces that are a little apart are a little aside: borders at one place are meant to be.
        const Vec<3>& d = jb.d[k + 1];
        const double beside = 4 * tolerance / norm(d), lo = out.scale[k] * a.on[i].lo + out.shift[k],
                     hi = out.scale[k] * a.on[i].hi + out.shift[k];
        const auto near = [&](double x) {
            for (const double end : {b.on[k].lo, b.on[k].hi})
                if (std::abs(x - end) <= beside) return end;
            return x;
        };
        if (near(lo) != lo && near(hi) != hi && near(lo) != near(hi))
            out.scale[k] = (near(hi) - near(lo)) / a.on[i].length();
        if (near(lo) != lo)
            out.shift[k] = near(lo) - out.scale[k] * a.on[i].lo;
        else if (near(hi) != hi)
            out.shift[k] = near(hi) - out.scale[k] * a.on[i].hi;
    }
    return out;
}

// R and M(R); false: it has no area.
bool set_region(SameMap& m, const SurfacePart& a, const SurfacePart& b) {
    for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t i = m.source(k);
        const double p = (b.on[k].lo - m.shift[k]) / m.scale[k], q = (b.on[k].hi - m.shift[k]) / m.scale[k];
        const double noise =
            0x1p-44 * std::max({std::abs(a.on[i].lo), std::abs(a.on[i].hi), a.on[i].length()});
        Interval r{std::max(a.on[i].lo, std::min(p, q)), std::min(a.on[i].hi, std::max(p, q))};
        if (std::abs(r.lo - a.on[i].lo) <= noise) r.lo = a.on[i].lo;
        if (std::abs(r.hi - a.on[i].hi) <= noise) r.hi = a.on[i].hi;
        if (!(r.length() > 0x1p-20 * a.on[i].length())) return false;
        m.region[i] = r;
        const double s = m.scale[k] * r.lo + m.shift[k], t = m.scale[k] * r.hi + m.shift[k];
        m.image[k] = {clamped(std::min(s, t), b.on[k]), clamped(std::max(s, t), b.on[k])};
        const double noise_b =
            0x1p-44 * std::max({std::abs(b.on[k].lo), std::abs(b.on[k].hi), b.on[k].length()});
        if (m.image[k].lo - b.on[k].lo <= noise_b) m.image[k].lo = b.on[k].lo;
        if (b.on[k].hi - m.image[k].hi <= noise_b) m.image[k].hi = b.on[k].hi;
    }
    return true;
}

// Breaks of one that the other has not are inserted there; 0 and 1 are the ends of both domains.
Result<Surface<Hom<3>>> with_breaks_of(const Surface<Hom<3>>& s, const Surface<Hom<3>>& other, int axis) {
    const Interval on = s.basis(axis).domain(), from = other.basis(axis).domain();
    std::vector<double> missing;
    const auto own = s.basis(axis).breaks();
    for (const double t : other.basis(axis).breaks()) {
        const double x = on.lo + (t - from.lo) / from.length() * on.length();
        if (std::ranges::none_of(own, [&](double o) { return std::abs(o - x) <= kOneBreak * on.length(); }))
            missing.push_back(x);
    }
    if (missing.empty()) return s;
    return insert_knots(s, axis, missing);
}

// A bound of how far A over R is from B over M(R), both as splines.
std::optional<double> gap_of(const SameMap& m, const SurfacePart& a, const SurfacePart& b) {
    const auto part_a = part_spline(a.surface, m.region), part_b = part_spline(b.surface, m.image);
    if (!part_a || !part_b) return std::nullopt;
    // Maps to the own parameters have to agree, too.
    for (std::size_t k = 0; k < 2; ++k)
        if (part_b->map[k].arcs() != part_a->map[m.source(k)].arcs()) return std::nullopt;
    Surface<Hom<3>> p = part_a->surface, q = part_b->surface;
    if (m.swapped) {
        const Index<2> n = q.net().extent();
        std::vector<Hom<3>> net;
        for (int j = 0; j < n[1]; ++j)
            for (int i = 0; i < n[0]; ++i) net.push_back(q.net().view()({i, j}));
        q = Surface<Hom<3>>::trusted({q.basis(1), q.basis(0)}, Net<2, Hom<3>>({n[1], n[0]}, std::move(net)));
    }
    for (std::size_t k = 0; k < 2; ++k)
        if (m.scale[k] < 0) q = reverse(q, int(m.source(k)));
    for (int axis = 0; axis < 2; ++axis) {
        const int more = p.basis(axis).degree() - q.basis(axis).degree();
        auto raised = elevate(more > 0 ? q : p, axis, std::abs(more));
        if (!raised) return std::nullopt;
        (more > 0 ? q : p) = std::move(*raised);
        auto own = with_breaks_of(p, q, axis), others = with_breaks_of(q, p, axis);
        if (!own || !others) return std::nullopt;
        p = std::move(*own), q = std::move(*others);
    }
    const BezierPieces<2, Hom<3>> x(p), y(q);
    if (x.extent() != y.extent()) return std::nullopt;
    double most = 0, uneven = 0, size = 0, moved = 0, least = kInfinity, heaviest = 0;
    const double factor = x.net({0, 0})({0, 0}).weight() / y.net({0, 0})({0, 0}).weight();
    each_index(x.extent(), [&](const Index<2>& at) {
        const auto own = x.net(at), other = y.net(at);
        Box<3> box;
        each_index(own.extent, [&](const Index<2>& i) {
            const Hom<3>&h = own(i), &g = other(i);
            const Vec<3> u = project(h), v = project(g);
            most = std::max(most, norm(u - v)), size = std::max({size, max_abs(u), max_abs(v)});
            uneven = std::max(uneven, std::abs(h.weight() - factor * g.weight()) / h.weight());
            least = std::min(least, h.weight()), heaviest = std::max(heaviest, h.weight());
            box.add(u), box.add(v);
        });
        for (std::size_t k = 0; k < 2; ++k) {
            const Interval s = x.box(at)[k], t = y.box(at)[k], on = p.domain()[k], from = q.domain()[k];
            const double off =
                std::max(std::abs((s.lo - on.lo) / on.length() - (t.lo - from.lo) / from.length()),
                         std::abs((s.hi - on.lo) / on.length() - (t.hi - from.lo) / from.length()));
            // |S_u| <= degree * w_max / w_min * diagonal / length, twice for both pieces beside the break.
            moved = std::max(moved,
                             off * on.length() / s.length() * 4 * p.basis(int(k)).degree() * box.diagonal());
        }
    });
    const double spread = heaviest / least;
    const double rounding =
        1024 * (p.basis(0).degree() + p.basis(1).degree() + 1) * kUnitRoundoff * size * spread;
    return 1.01 * (most + 12 * uneven * size * spread + 2 * moved * spread * spread + rounding +
                   part_a->bound + part_b->bound);
}

}  // namespace

std::array<Interval, 2> SameMap::forth(const std::array<Interval, 2>& s) const {
    std::array<Interval, 2> out;
    for (std::size_t k = 0; k < 2; ++k) {
        const Interval x = own[0][source(k)].over(s[source(k)]);
        const double p = scale[k] * x.lo + shift[k], q = scale[k] * x.hi + shift[k];
        const double slack = 16 * kUnitRoundoff * (std::abs(p) + std::abs(q) + std::abs(shift[k]));
        out[k] = own[1][k].inverse_over({std::min(p, q) - slack, std::max(p, q) + slack});
    }
    return out;
}

std::array<Interval, 2> SameMap::back(const std::array<Interval, 2>& t) const {
    std::array<Interval, 2> out;
    for (std::size_t k = 0; k < 2; ++k) {
        const Interval y = own[1][k].over(t[k]);
        const double p = (y.lo - shift[k]) / scale[k], q = (y.hi - shift[k]) / scale[k];
        const double slack =
            16 * kUnitRoundoff * (std::abs(y.lo) + std::abs(y.hi) + std::abs(shift[k])) / std::abs(scale[k]);
        out[source(k)] = own[0][source(k)].inverse_over({std::min(p, q) - slack, std::max(p, q) + slack});
    }
    return out;
}

std::array<Interval, 2> SameMap::region_of_spline(std::size_t side) const {
    const auto& r = side == 0 ? region : image;
    return {own[side][0].inverse_over(r[0]), own[side][1].inverse_over(r[1])};
}

std::vector<SameMap> same_maps(const SurfacePart& a, const SurfacePart& b,
                               const std::array<const PartSpline*, 2>& splines, double tolerance) {
    std::vector<SameMap> out;
    const auto at = foot_pair(a, b, tolerance);
    if (!at) return out;
    auto found = map_at(a, b, *at, tolerance);
    if (!found) return out;
    found->own = {splines[0]->map, splines[1]->map};
    // Angles of B a turn away are the same.
    std::vector<double> turns{0};
    std::size_t turning = 2;
    for (std::size_t k = 0; k < 2; ++k)
        if (found->own[1][k].arcs() > 0 && found->own[0][found->source(k)].arcs() > 0) turning = k;
    if (turning < 2) turns = {-kTwoPi, 0, kTwoPi};
    for (const double turn : turns) {
        SameMap m = *found;
        if (turning < 2) m.shift[turning] += turn;
        if (!set_region(m, a, b)) continue;
        const auto gap = gap_of(m, a, b);
        if (!gap || !(*gap <= tolerance)) continue;
        m.gap = 1.01 * (*gap + splines[0]->bound + splines[1]->bound);
        out.push_back(m);
    }
    return out;
}

}  // namespace freiform::detail

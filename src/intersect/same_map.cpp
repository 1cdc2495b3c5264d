// Maps between parameters of surfaces that are the same; same_map_detail.hpp is the essay.
//
// Accuracy. With common degrees and breaks, pieces of both are sums of the same Bernstein polynomials; along
// angles those of tau' (axis_angles_detail.hpp), for which the weights of row i are divided by r^i. Where
// weights are the same up to a factor for each piece and 1 +- e, means of the same points with these weights
// are within 4 e of their size. So the distance is proven for the map that takes pieces to pieces; M x is
// next to it: breaks that count as one are no farther apart than kOneBreak, and what r differs by moves tau
// by a quarter of that. `forth` and `back` have room for both. Restriction, elevation and insertion are
// convex combinations of a few dozen roundings each.
#include "same_map_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::detail {

namespace {

using AngleSurface = SameMap::Side;

constexpr int kSamplesOfSame = 5;        // along each axis
constexpr double kNoSlope = 0x1p-30;     // of a matrix of derivatives, that counts as zero
constexpr double kOneBreak = 0x1p-40;    // of the domain
constexpr double kSameAngles = 0x1p-40;  // relative, of weights

std::array<double, 2> sample_of(const Surface<Hom<3>>& s, int i, int j) {
    const auto at = [](const Interval& on, int k) {
        return on.lo + on.length() * ((k + 0.5) / kSamplesOfSame);
    };
    return {at(s.domain()[0], i), at(s.domain()[1], j)};
}

// Gauss-Newton from y to the foot of a point; the distance.
double foot_of(const Surface<Hom<3>>& b, const Vec<3>& p, std::array<double, 2>& y) {
    const auto on = b.domain();
    double off = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 30; ++i) {
        const auto j = b.jet<1>(y);
        const Vec<3> r = j.value() - p, u = j.d[1], v = j.d[2];
        off = norm(r);
        const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), det = uu * vv - uv * uv;
        if (!(det > 0)) break;
        const double du = (vv * dot(u, r) - uv * dot(v, r)) / det,
                     dv = (uu * dot(v, r) - uv * dot(u, r)) / det;
        y[0] = clamped(y[0] - du, on[0]), y[1] = clamped(y[1] - dv, on[1]);
        if (std::abs(du) <= 0x1p-50 * on[0].length() && std::abs(dv) <= 0x1p-50 * on[1].length()) break;
    }
    return off;
}

struct FootPair {
    std::array<double, 2> x{}, y{};  // of the splines
};
// A point of A that is on B inside of its domain.
std::optional<FootPair> foot_pair(const Surface<Hom<3>>& a, const Surface<Hom<3>>& b, double tolerance) {
    std::vector<std::pair<std::array<double, 2>, Vec<3>>> on_b;
    for (int i = 0; i < kSamplesOfSame; ++i)
        for (int j = 0; j < kSamplesOfSame; ++j) {
            const auto y = sample_of(b, i, j);
            on_b.push_back({y, b(y)});
        }
    for (int i = 0; i < kSamplesOfSame; ++i)
        for (int j = 0; j < kSamplesOfSame; ++j) {
            FootPair out{sample_of(a, i, j), {}};
            const Vec<3> p = a(out.x);
            const auto nearest =
                std::ranges::min_element(on_b, {}, [&](const auto& s) { return norm(s.second - p); });
            out.y = nearest->first;
            if (!(foot_of(b, p, out.y) <= tolerance)) continue;
            bool inner = true;
            for (std::size_t k = 0; k < 2; ++k) {
                const Interval on = b.domain()[k];
                inner = inner && on.lo < out.y[k] && out.y[k] < on.hi;
            }
            if (inner) return out;
        }
    return std::nullopt;
}

// M from first derivatives at a pair; nothing: parameters of B depend on both of A.
std::optional<SameMap> map_at(const AngleSurface& a, const AngleSurface& b, const FootPair& at,
                              double tolerance) {
    const auto ja = a.surface->jet<1>(at.x), jb = b.surface->jet<1>(at.y);
    const auto by_own = [](const AngleSurface& s, const std::array<double, 2>& place, std::size_t k,
                           const Vec<3>& d) { return (1 / s.own[k].slope(place[k])) * d; };
    const std::array<Vec<3>, 2> da{by_own(a, at.x, 0, ja.d[1]), by_own(a, at.x, 1, ja.d[2])},
        db{by_own(b, at.y, 0, jb.d[1]), by_own(b, at.y, 1, jb.d[2])};
    const std::array<Interval, 2> on_a = a.range(), on_b = b.range();
    const Vec<3> u = db[0], v = db[1];
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), det = uu * vv - uv * uv;
    if (!(det > 0)) return std::nullopt;
    std::array<std::array<double, 2>, 2> m{};  // m[k][i]: dy[k] / dx[i], in lengths of the domains
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec<3>& d = da[i];
        const double along_u = dot(u, d), along_v = dot(v, d);
        m[0][i] = (vv * along_u - uv * along_v) / det * on_a[i].length() / on_b[0].length();
        m[1][i] = (uu * along_v - uv * along_u) / det * on_a[i].length() / on_b[1].length();
    }
    SameMap out;
    out.side = {a, b};
    out.swapped = std::abs(m[0][1]) + std::abs(m[1][0]) > std::abs(m[0][0]) + std::abs(m[1][1]);
    for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t i = out.source(k);
        const double size = max_abs(da[i]) * on_a[i].length();
        if (!(std::abs(m[k][1 - i]) <= (kNoSlope + 64 * tolerance / size) * std::abs(m[k][i])))
            return std::nullopt;
        if (a.own[i].is_identity() != b.own[k].is_identity()) return std::nullopt;
        out.scale[k] = m[k][i] * on_b[k].length() / on_a[i].length();
        if (std::abs(std::abs(out.scale[k]) - 1) < 0x1p-40 || !a.own[i].is_identity())
            out.scale[k] = out.scale[k] > 0 ? 1 : -1;
        out.shift[k] = b.own[k].at(at.y[k]) - out.scale[k] * a.own[i].at(at.x[i]);
        // Feet of surfaces that are a little apart are a little aside: borders at one place are meant to be.
        const double beside = 4 * tolerance / norm(db[k]), lo = out.scale[k] * on_a[i].lo + out.shift[k],
                     hi = out.scale[k] * on_a[i].hi + out.shift[k];
        const auto near = [&](double x) {
            for (const double end : {on_b[k].lo, on_b[k].hi})
                if (std::abs(x - end) <= beside) return end;
            return x;
        };
        if (a.own[i].is_identity() && near(lo) != lo && near(hi) != hi && near(lo) != near(hi))
            out.scale[k] = (near(hi) - near(lo)) / on_a[i].length();
        if (near(lo) != lo)
            out.shift[k] = near(lo) - out.scale[k] * on_a[i].lo;
        else if (near(hi) != hi)
            out.shift[k] = near(hi) - out.scale[k] * on_a[i].hi;
    }
    return out;
}

// R and M(R); false: it has no area.
bool set_region(SameMap& m) {
    const std::array<Interval, 2> a = m.side[0].range(), b = m.side[1].range();
    for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t i = m.source(k);
        const double p = (b[k].lo - m.shift[k]) / m.scale[k], q = (b[k].hi - m.shift[k]) / m.scale[k];
        const double noise = 0x1p-44 * std::max({std::abs(a[i].lo), std::abs(a[i].hi), a[i].length()});
        Interval r{std::max(a[i].lo, std::min(p, q)), std::min(a[i].hi, std::max(p, q))};
        if (std::abs(r.lo - a[i].lo) <= noise) r.lo = a[i].lo;
        if (std::abs(r.hi - a[i].hi) <= noise) r.hi = a[i].hi;
        if (!(r.length() > 0x1p-20 * a[i].length())) return false;
        m.region[i] = r;
        const double s = m.scale[k] * r.lo + m.shift[k], t = m.scale[k] * r.hi + m.shift[k];
        m.image[k] = {clamped(std::min(s, t), b[k]), clamped(std::max(s, t), b[k])};
        const double noise_b = 0x1p-44 * std::max({std::abs(b[k].lo), std::abs(b[k].hi), b[k].length()});
        if (m.image[k].lo - b[k].lo <= noise_b) m.image[k].lo = b[k].lo;
        if (b[k].hi - m.image[k].hi <= noise_b) m.image[k].hi = b[k].hi;
    }
    for (std::size_t side = 0; side < 2; ++side)
        for (std::size_t k = 0; k < 2; ++k) {
            const Interval r = (side == 0 ? m.region : m.image)[k];
            m.on[side][k] = {m.side[side].own[k].inverse(r.lo), m.side[side].own[k].inverse(r.hi)};
            if (!(m.on[side][k].lo < m.on[side][k].hi)) return false;
        }
    return true;
}

// Places inside of a region where a spline has breaks, in its own parameters.
std::vector<double> inner_breaks(const AxisAngles& own, const Interval& region) {
    std::vector<double> out;
    const double beside = kOneBreak * own.range().length();
    for (const double s : own.breaks())
        if (const double x = own.at(s); region.lo + beside < x && x < region.hi - beside) out.push_back(x);
    return out;
}
// Those of the other one, carried over, that it has not.
std::vector<double> missing_breaks(const AxisAngles& own, const std::vector<double>& has,
                                   const std::vector<double>& wanted) {
    std::vector<double> out;
    const double beside = 2 * kOneBreak * own.range().length();
    for (const double x : wanted)
        if (std::ranges::none_of(has, [&](double o) { return std::abs(o - x) <= beside; }))
            out.push_back(own.inverse(x));
    sort(out);
    return out;
}

// Both over R and M(R), along the axes of A, in the same direction, with the same degrees and breaks.
std::optional<std::array<Surface<Hom<3>>, 2>> made_comparable(const SameMap& m) {
    std::array<Surface<Hom<3>>, 2> out{*m.side[0].surface, *m.side[1].surface};
    for (std::size_t side = 0; side < 2; ++side)
        for (std::size_t k = 0; k < 2; ++k) {
            if (out[side].domain()[k] == m.on[side][k]) continue;
            auto part = restrict_to(out[side], int(k), m.on[side][k]);
            if (!part) return std::nullopt;
            out[side] = std::move(*part);
        }
    for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t i = m.source(k);
        const AxisAngles &own_a = m.side[0].own[i], &own_b = m.side[1].own[k];
        auto at_a = inner_breaks(own_a, m.region[i]), at_b = inner_breaks(own_b, m.image[k]);
        auto to_a = at_b, to_b = at_a;
        for (double& y : to_a) y = (y - m.shift[k]) / m.scale[k];
        for (double& x : to_b) x = m.scale[k] * x + m.shift[k];
        auto a = insert_knots(out[0], int(i), missing_breaks(own_a, at_a, to_a));
        auto b = insert_knots(out[1], int(k), missing_breaks(own_b, at_b, to_b));
        if (!a || !b) return std::nullopt;
        out = {std::move(*a), std::move(*b)};
    }
    Surface<Hom<3>>& q = out[1];
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
        const int more = out[0].basis(axis).degree() - q.basis(axis).degree();
        auto raised = elevate(more > 0 ? q : out[0], axis, std::abs(more));
        if (!raised) return std::nullopt;
        (more > 0 ? q : out[0]) = std::move(*raised);
    }
    return out;
}

// The weights of a piece, in parameters with which those at the ends are the same.
class PieceWeights {
public:
    PieceWeights(NetView<2, const Hom<3>> net, const std::array<bool, 2>& angles) : net_(net) {
        const double first = net({0, 0}).weight();
        if (angles[0]) ratio_[0] = std::sqrt(net({2, 0}).weight() / first);
        if (angles[1]) ratio_[1] = std::sqrt(net({0, 2}).weight() / first);
    }
    double operator()(const Index<2>& i) const {
        return net_(i).weight() / std::pow(ratio_[0], i[0]) / std::pow(ratio_[1], i[1]);
    }

private:
    NetView<2, const Hom<3>> net_;
    std::array<double, 2> ratio_{1, 1};
};

// A bound of how far A over R is from B over M(R), both as splines.
std::optional<double> gap_of(const SameMap& m) {
    const auto both = made_comparable(m);
    if (!both) return std::nullopt;
    const BezierPieces<2, Hom<3>> x((*both)[0]), y((*both)[1]);
    if (x.extent() != y.extent()) return std::nullopt;
    const std::array<bool, 2> angles{!m.side[0].own[0].is_identity(), !m.side[0].own[1].is_identity()};
    double most = 0, uneven = 0, size = 0, spread = 1;
    each_index(x.extent(), [&](const Index<2>& at) {
        const auto own = x.net(at), other = y.net(at);
        const PieceWeights w(own, angles), z(other, angles);
        const double factor = w({0, 0}) / z({0, 0});
        double least = kInfinity, heaviest = 0;
        each_index(own.extent, [&](const Index<2>& i) {
            const Vec<3> u = project(own(i)), v = project(other(i));
            const double heavy = w(i);
            most = std::max(most, norm(u - v)), size = std::max({size, max_abs(u), max_abs(v)});
            uneven = std::max(uneven, std::abs(heavy - factor * z(i)) / heavy);
            least = std::min(least, heavy), heaviest = std::max(heaviest, heavy);
        });
        spread = std::max(spread, heaviest / least);
    });
    if ((angles[0] || angles[1]) && !(uneven <= kSameAngles)) return std::nullopt;
    const double rounding = 1024 * ((*both)[0].basis(0).degree() + (*both)[0].basis(1).degree() + 1) *
                            kUnitRoundoff * size * spread;
    return 1.01 * (most + 12 * uneven * size * spread + rounding);
}

std::vector<SameMap> maps_from(const FootPair& at, const std::array<const PartSpline*, 2>& splines,
                               double tolerance) {
    std::vector<SameMap> out;
    for (const bool by_angles : {true, false}) {
        const auto side = [&](std::size_t i) {
            const Surface<Hom<3>>& s = splines[i]->surface;
            const auto of = by_angles ? AxisAngles::of : AxisAngles::identity;
            return SameMap::Side{&s, {of(s, 0), of(s, 1)}};
        };
        const auto found = map_at(side(0), side(1), at, tolerance);
        if (!found) continue;
        // Angles of B a turn away are the same.
        std::array<std::vector<double>, 2> turns{{{0}, {0}}};
        for (std::size_t k = 0; k < 2; ++k)
            if (!found->side[1].own[k].is_identity()) turns[k] = {-kTwoPi, 0, kTwoPi};
        for (const double u : turns[0])
            for (const double v : turns[1]) {
                SameMap m = *found;
                m.shift[0] += u, m.shift[1] += v;
                if (!set_region(m)) continue;
                const auto gap = gap_of(m);
                if (!gap || !(*gap <= tolerance)) continue;
                m.gap = 1.01 * (*gap + splines[0]->bound + splines[1]->bound);
                out.push_back(std::move(m));
            }
        if (!out.empty()) break;
    }
    return out;
}

}  // namespace

std::array<Interval, 2> SameMap::forth(const std::array<Interval, 2>& s) const {
    std::array<Interval, 2> out;
    for (std::size_t k = 0; k < 2; ++k) {
        const Interval x = side[0].own[source(k)].over(s[source(k)]);
        const double p = scale[k] * x.lo + shift[k], q = scale[k] * x.hi + shift[k];
        const double slack = 16 * kUnitRoundoff * (std::abs(p) + std::abs(q) + std::abs(shift[k]));
        out[k] = side[1].own[k].inverse_over({std::min(p, q) - slack, std::max(p, q) + slack});
    }
    return out;
}

std::array<Interval, 2> SameMap::back(const std::array<Interval, 2>& t) const {
    std::array<Interval, 2> out;
    for (std::size_t k = 0; k < 2; ++k) {
        const Interval y = side[1].own[k].over(t[k]);
        const double p = (y.lo - shift[k]) / scale[k], q = (y.hi - shift[k]) / scale[k];
        const double slack =
            16 * kUnitRoundoff * (std::abs(y.lo) + std::abs(y.hi) + std::abs(shift[k])) / std::abs(scale[k]);
        out[source(k)] =
            side[0].own[source(k)].inverse_over({std::min(p, q) - slack, std::max(p, q) + slack});
    }
    return out;
}

Sameness sameness(const std::array<const PartSpline*, 2>& splines, double tolerance) {
    Sameness out;
    const auto at = foot_pair(splines[0]->surface, splines[1]->surface, tolerance);
    if (!at) return out;
    out.maps = maps_from(*at, splines, tolerance);
    out.one_sphere = out.maps.empty() && are_one_sphere(splines[0]->surface, splines[1]->surface, tolerance);
    return out;
}

}  // namespace freiform::detail

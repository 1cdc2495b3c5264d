// Orders of continuity along a line where two surfaces meet.
//
// Idea: every jump is |numerator| / denominator with polynomials of the parameter along the line: products of
// the derivatives of both sides. The numerator is formed exactly as a polynomial, so what cancels cancels in
// its coefficients, once, and not on every small interval anew. Its largest value is found by branch and
// bound (largest_detail.hpp).
//
// Notation: A = (numerator) / w one surface on its side of the line, u across, t along. U, T: w^2 times A_u
// and A_t, which are polynomials; N = U x T, w^4 times the normal; B, v, U', T', N' the other surface. e the
// direction orthogonal to the line in the tangent plane.
//
// Method: Both lines are cut at the breaks of both; on each piece everything is in Bernstein form, scaled so
// that products are convolutions (piecewise_detail.hpp).
// C^k: w^(k+1) d^k A is a polynomial a_k by the quotient rule; the jump is |a_k v^(k+1) - b_k w^(k+1)| /
// (w v)^(k+1).
// G^1: the angle atan2(|N x N'|, N . N'). Both normals take the way across from the first surface to the
// second, so a surface that turns back has the angle pi, and how u and v run does not matter. G^2: with E =
// (T.T) U - (U.T) T, which is e times |T| |N|, the curvature of the normal section along e is
//     k = K / (|T|^2 |N|^3),   K = w ((T.T)^2 P_uu - 2 (T.T)(U.T) P_ut + (U.T)^2 P_tt) . N,
// P_.. = w^3 times the second derivatives. |N| and |N'| are roots, but their product is N . N' / cos(angle),
// so
//     (k - k') |N'| = K (N.N') / (|T|^2 |N|^4) - K' / (|T'|^2 |N'|^2) + k |N'| (1 - cos(angle)),
// a quotient of polynomials and a term that vanishes with the square of the angle. Why k - k' is all: if the
// tangent planes agree along the line, so does the derivative of the normal along it, hence II(T, .).
//
// Accuracy: `Bounded` arithmetic from the control points on; enclosures are rounded outwards by 2^-45, many
// times what their few operations on numbers >= 0 can lose. Cost: degrees of K (N.N') |T'|^2 |N'|^2: 40 for
// bicubics, 97 for rational ones.
//
// Why not sampling: no bound. Why not intervals for k and k' each: their width does not vanish with the jump,
// and a smooth joint would need intervals as short as the bound is to be small. Why not solve for the
// connection functions of G^1: they are quotients, and small denominators decide nothing about the shape.
//
// References: [Pegna & Wolter 1992], [Farin 2002, ch. 20], [Ye, Liang & Nowacki 1996].
#include "continuity_detail.hpp"
#include "largest_detail.hpp"
#include "piecewise_detail.hpp"
#include "surface_strip_detail.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/query/surface_continuity.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform {

namespace {

using detail::Form;
using detail::JointStrips;
using detail::LinePart;
using detail::Strip;
using Poly = Form<Bounded>;
using Poly3 = std::array<Poly, 3>;
constexpr double kIn = 1 - 0x1p-45, kOut = 1 + 0x1p-45;

// Orders of C
// ------------------------------------------------------------------------------------------------------

Poly power(const Poly& a, int n) {
    Poly p{{Bounded(1)}};
    for (int i = 0; i < n; ++i) p = p * a;
    return p;
}

// w^(k+1) times the derivative of order k: w^k A_k - sum_{j>0} C(k, j) w_j w^(j-1) a_(k-j).
std::vector<std::vector<Poly>> numerators(const Strip& s, int orders) {
    std::vector<std::vector<Poly>> a;
    for (int k = 0; k <= orders; ++k) {
        std::vector<Poly> now;
        for (std::size_t c = 0; c + 1 < s[0].size(); ++c) {
            Poly x = power(s.w(), k) * s[std::size_t(k)][c];
            for (int j = 1; j <= k; ++j)
                x = x - int(binomial(k, j)) *
                            (s.w(std::size_t(j)) * power(s.w(), j - 1) * a[std::size_t(k - j)][c]);
            now.push_back(x);
        }
        a.push_back(std::move(now));
    }
    return a;
}

// |(f_0, .., f_{n-2})| / |f_{n-1}|, f_{n-1} > 0.
std::optional<Interval> quotient_of_length(std::span<const Interval> f) {
    const Interval below = f.back();
    if (!(below.lo > 0)) return std::nullopt;
    double low = 0, high = 0;
    for (const Interval& x : f.first(f.size() - 1)) {
        const double near = x.contains(0) ? 0 : std::min(std::abs(x.lo), std::abs(x.hi));
        low = std::hypot(low, near), high = std::hypot(high, std::max(std::abs(x.lo), std::abs(x.hi)));
    }
    return Interval{low / below.hi * kIn, high / below.lo * kOut};
}

LinePart part_of(const Interval& on, std::initializer_list<const Poly*> polys) {
    LinePart p{on, {}, 0};
    for (const Poly* f : polys) p.polynomial.push_back(detail::bernstein(*f));
    return p;
}

// Orders of G
// ------------------------------------------------------------------------------------------------------

Poly inner(const Poly3& a, const Poly3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Poly3 cross(const Poly3& a, const Poly3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class F>
Poly3 each(F&& f) {
    return {f(0), f(1), f(2)};
}

// U, T and N of the essay.
struct Frame {
    Poly3 u, t, n;
};
Frame frame_of(const Strip& s) {
    Frame f;
    f.u = each([&](std::size_t c) { return s[1][c] * s.w() - s[0][c] * s.w(1); });
    f.t = each([&](std::size_t c) { return derivative(s[0][c]) * s.w() - s[0][c] * derivative(s.w()); });
    f.n = cross(f.u, f.t);
    return f;
}

// K of the essay.
Poly bending(const Strip& s, const Frame& f) {
    const Poly &w = s.w(), wt = derivative(w);
    const auto second = [&](auto&& of) { return inner(each(of), f.n); };
    const Poly uu =
        second([&](std::size_t c) { return w * (s[2][c] * w - s[0][c] * s.w(2)) - 2 * (s.w(1) * f.u[c]); });
    const Poly ut = second([&](std::size_t c) { return derivative(f.u[c]) * w - 2 * (wt * f.u[c]); });
    const Poly tt = second([&](std::size_t c) { return derivative(f.t[c]) * w - 2 * (wt * f.t[c]); });
    const Poly t2 = inner(f.t, f.t), ut1 = inner(f.u, f.t);
    return w * (t2 * t2 * uu - 2 * (t2 * ut1 * ut) + ut1 * ut1 * tt);
}

// Of N x N' (three coordinates) and N . N'.
std::optional<Interval> angle(std::span<const Interval> f) {
    double low = 0, high = 0;
    for (const Interval& x : f.first(3)) {
        const double near = x.contains(0) ? 0 : std::min(std::abs(x.lo), std::abs(x.hi));
        low = std::hypot(low, near), high = std::hypot(high, std::max(std::abs(x.lo), std::abs(x.hi)));
    }
    low *= kIn, high *= kOut;
    const Interval d = f[3];
    if (low == 0 && d.contains(0)) return std::nullopt;
    // atan2(s, c) falls with c; with s it rises where c > 0 and falls where c < 0.
    const double most = std::atan2(d.lo > 0 ? high : low, d.lo),
                 least = std::atan2(d.hi > 0 ? low : high, d.hi);
    return Interval{least * kIn, std::min(most * kOut, std::numbers::pi * kOut)};
}

// Of the numerator, |T|^2, |T'|^2, |N|^2, |N'|^2, N . N', K, N x N'.
std::optional<Interval> bend(std::span<const Interval> f) {
    const Interval &t = f[1], &s = f[2], &n = f[3], &m = f[4], &d = f[5];
    if (!(t.lo > 0) || !(s.lo > 0) || !(n.lo > 0) || !(m.lo > 0) || !(d.lo > 0)) return std::nullopt;
    const auto below = [](double a, double b, double c, double e) {
        return std::sqrt(e) * a * b * c * c * e;
    };
    const double near = f[0].contains(0) ? 0 : std::min(std::abs(f[0].lo), std::abs(f[0].hi)),
                 far = std::max(std::abs(f[0].lo), std::abs(f[0].hi));
    double sine = 0;
    for (const Interval& x : f.subspan(7, 3))
        sine = std::hypot(sine, std::max(std::abs(x.lo), std::abs(x.hi)));
    // 1 - cos <= sin^2 for angles up to a right one, k = K / (|T|^2 |N|^3).
    const double k = std::max(std::abs(f[6].lo), std::abs(f[6].hi)) / (t.lo * n.lo * std::sqrt(n.lo)),
                 rest = k * std::min(1.0, sine / n.lo * (sine / m.lo)) * kOut;
    return Interval{std::max(0.0, near / below(t.hi, s.hi, n.hi, m.hi) * kIn - rest),
                    far / below(t.lo, s.lo, n.lo, m.lo) * kOut + rest};
}

LinePart angle_part(const Interval& on, const Frame& a, const Frame& b) {
    const Poly3 x = cross(a.n, b.n);
    const Poly d = inner(a.n, b.n);
    return part_of(on, {&x[0], &x[1], &x[2], &d});
}
LinePart bend_part(const Interval& on, const Strip& sa, const Strip& sb, const Frame& a, const Frame& b) {
    const Poly t = inner(a.t, a.t), s = inner(b.t, b.t), n = inner(a.n, a.n), m = inner(b.n, b.n),
               d = inner(a.n, b.n), k = bending(sa, a);
    const Poly numerator = k * d * s * m - bending(sb, b) * t * n * n;
    const Poly3 x = cross(a.n, b.n);
    return part_of(on, {&numerator, &t, &s, &n, &m, &d, &k, &x[0], &x[1], &x[2]});
}

// The answer
// ------------------------------------------------------------------------------------------------------

LargestJump scaled(const detail::Largest& x, int e) {
    return {std::scalbn(x.value, e), std::scalbn(x.bound, e), x.at};
}
Result<void> check(const SurfaceSide& a, const SurfaceSide& b, const ContinuityOptions& o) {
    if (a.dimension != b.dimension)
        return refuse(RefusalKind::invalid, "second",
                      text("has ", b.dimension, " coordinates, the first surface has ", a.dimension));
    if (o.orders < 0 || o.orders > std::min(a.orders, b.orders))
        return refuse(RefusalKind::unsupported, "orders",
                      text(o.orders, " is outside 0..", std::min(a.orders, b.orders),
                           ", the orders that the sides were made for"));
    return detail::check_allowances(o);
}
void add_aside(std::vector<Interval>& all, const std::vector<Interval>& more) {
    for (Interval x : more) {
        if (x.lo > x.hi) std::swap(x.lo, x.hi);
        all.push_back(x);
    }
    sort(all, {}, &Interval::lo);
    std::vector<Interval> merged;
    for (const Interval& x : all)
        if (!merged.empty() && x.lo <= merged.back().hi)
            merged.back().hi = std::max(merged.back().hi, x.hi);
        else
            merged.push_back(x);
    all = std::move(merged);
}

void find_c(const JointStrips& j, SurfaceContinuity& out) {
    const int orders = j.options.orders;
    std::vector<std::vector<LinePart>> lines(std::size_t(orders) + 1);
    for (std::size_t i = 0; i < j.parts.size(); ++i) {
        const Strip &s = j.first[i], &t = j.second[i];
        auto a = numerators(s, orders), b = numerators(t, orders);
        for (std::size_t c = 0; c < a[0].size(); ++c) {
            // Both are measured from points of their own.
            const Bounded apart = Bounded(j.a.origin[c]) - Bounded(j.b.origin[c]);
            if (!apart.is_zero())
                a[0][c] = a[0][c] + Poly{{Bounded(std::scalbn(1.0, -j.length)) * apart}} * s.w();
        }
        for (int k = 0; k <= orders; ++k) {
            const Poly left = power(t.w(), k + 1), right = power(s.w(), k + 1), below = left * right;
            LinePart part{j.parts[i].on, {}, 0};
            for (std::size_t c = 0; c < a[0].size(); ++c)
                part.polynomial.push_back(
                    detail::bernstein(a[std::size_t(k)][c] * left - b[std::size_t(k)][c] * right));
            part.polynomial.push_back(detail::bernstein(below));
            lines[std::size_t(k)].push_back(std::move(part));
        }
    }
    for (int k = 0; k <= orders; ++k)
        out.c.push_back(scaled(detail::largest(std::move(lines[std::size_t(k)]), quotient_of_length),
                               j.length - k * j.across));
}

detail::Largest largest_bend(const JointStrips& j) {
    std::vector<LinePart> bends;
    for (std::size_t i = 0; i < j.parts.size(); ++i)
        bends.push_back(
            bend_part(j.parts[i].on, j.first[i], j.second[i], frame_of(j.first[i]), frame_of(j.second[i])));
    return detail::largest(std::move(bends), bend);
}

// A plane side as one in space.
SurfaceSide in_space(SurfaceSide side) {
    for (SurfaceSide::Piece& p : side.pieces)
        for (std::size_t row = 2; row <= p.derivative.size(); row += 4)
            p.derivative.insert(p.derivative.begin() + std::ptrdiff_t(row), std::vector<Bounded>{});
    side.origin.push_back(0);
    side.dimension = 3;
    return side;
}

void find_g(const JointStrips& j, SurfaceContinuity& out) {
    const double reach = std::min(j.a.reach, j.b.reach);
    const double own[] = {0, j.options.angle, j.options.curvature};
    const auto order = [&] {
        return detail::order_of(
            out.g, [&](int k) { return std::max(detail::worth(j.options.tolerance, reach, k), own[k]); });
    };
    out.g.push_back(out.c[0]);
    out.g_order = order();
    if (j.a.dimension != 3 || j.options.orders < 1) return;
    std::vector<LinePart> angles;
    for (std::size_t i = 0; i < j.parts.size(); ++i)
        angles.push_back(angle_part(j.parts[i].on, frame_of(j.first[i]), frame_of(j.second[i])));
    const detail::Largest g1 = detail::largest(std::move(angles), angle);
    add_aside(out.singular, g1.aside);
    if (!g1.any) return;
    out.g.push_back(scaled(g1, 0));
    out.opposed = g1.value + g1.bound + j.options.angle >= std::numbers::pi;
    out.g_order = order();
    if (out.g_order < 1 || j.options.orders < 2 || !(g1.value + g1.bound < 1.5)) return;
    detail::Largest g2 = largest_bend(j);
    // Bernstein coefficients of high degree mix what is far apart: shorter parts have less of that.
    std::optional<JointStrips> finer;
    for (int round = 0; round < 3 && g2.bound > std::max(1e-10, 2 * detail::kRelative * g2.value); ++round) {
        finer.emplace(finer ? finer->halved() : j.halved());
        detail::Largest again = largest_bend(*finer);
        const bool better = again.any && again.bound < g2.bound / 4;
        if (again.any && again.bound < g2.bound) g2 = std::move(again);
        if (!better) break;
    }
    add_aside(out.singular, g2.aside);
    if (!g2.any) return;
    out.g.push_back(scaled(g2, -j.length));
    out.g_order = order();
}

}  // namespace

std::optional<LargestJump> SurfaceContinuity::first_c_jump() const {
    return c_order + 1 < int(c.size()) ? std::optional(c[std::size_t(c_order + 1)]) : std::nullopt;
}
std::optional<LargestJump> SurfaceContinuity::first_g_jump() const {
    return g_order + 1 < int(g.size()) ? std::optional(g[std::size_t(g_order + 1)]) : std::nullopt;
}

Result<SurfaceContinuity> continuity(const SurfaceSide& before, const SurfaceSide& after,
                                     const ContinuityOptions& options) {
    if (auto ok = check(before, after, options); !ok) return std::unexpected(ok.error());
    if (before.dimension == 2) return continuity(in_space(before), in_space(after), options);
    const JointStrips j = JointStrips::make(before, after, options);
    SurfaceContinuity out;
    find_c(j, out);
    if (auto ok = detail::check_finite(out.c, "c"); !ok) return std::unexpected(ok.error());
    const double h = std::min(before.span, after.span);
    out.c_order = detail::order_of(out.c, [&](int k) { return detail::worth(options.tolerance, h, k); });
    find_g(j, out);
    if (auto ok = detail::check_finite(out.g, "g"); !ok) return std::unexpected(ok.error());
    return out;
}

}  // namespace freiform

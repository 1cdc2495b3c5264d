// Conics by equation.
//
// Notation: a .. f the coefficients; Q the symmetric matrix (2a b d; b 2c e; d e 2f), D = det Q,
// delta = 4 a c - b^2.
//
// Method, kind: D = 0 means that the conic is degenerate; the sign of delta tells ellipse (point), parabola
// (parallel lines) and hyperbola (crossing lines) apart; that of (a + c) D whether an ellipse has real
// points, that of d^2 + e^2 - 4 (a + c) f whether parallel lines have. All in exact arithmetic.
//
// Method, form: the centre is (b e - 2 c d, b d - 2 a e) / delta, where F is D / (2 delta). The eigenvalues
// of the quadratic part are (a + c +- r) / 2 with r = |(a - c, b)|; the smaller one is delta / 4 over the
// larger, without cancellation; eigenvectors by the half angle of (a - c, b). delta, D and the numerators of
// the centre are exact before they are rounded once, so ellipses that are nearly parabolas keep all digits of
// their shape. What they lose is the absolute accuracy of points: centre and axis are far away, and the
// bounds say so.
//
// A parabola is l p^2 + m p + k q + f = 0 along its eigenvectors n (of l = a + c) and n turned by 90 degrees.
//
// Five points: the coefficients are the minors of order 5 of the matrix with the rows (x^2, x y, y^2, x, y,
// 1), in exact arithmetic; rounding comes last.
//
// Arcs in a box: the parameters where the conic meets the sides are solutions of
// p cos t + q sin t = s (cosh, sinh; t^2, t); between two of them it is inside or outside as a whole.
//
// Accuracy: bounded.hpp after the exact part. Coefficients are first multiplied by powers of two that bring
// lengths near 1.
//
// References: [Salmon 1879, ch. 10-13].
//
// Why not an eigenvalue routine? Its rounding decides about kinds, and near parabolas it is always wrong.
#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/make/conic_equation.hpp>
#include <freiform/poly/determinant.hpp>
#include <freiform/poly/exact.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using Exacts = std::array<Exact, 6>;

struct Invariants {
    Exact big, delta, trace, k;  // D, delta, a + c, d^2 + e^2 - 4 (a + c) f
};
Invariants invariants(const Exacts& q) {
    const auto& [a, b, c, d, e, f] = q;
    const Exact two(2), four(4);
    Invariants i;
    i.delta = four * a * c - b * b;
    i.trace = a + c;
    // det Q / 2 = f delta - a e^2 - c d^2 + b d e
    i.big = two * (f * i.delta - a * e * e - c * d * d + b * d * e);
    i.k = d * d + e * e - four * i.trace * f;
    return i;
}

ConicType kind_of(const Exacts& q) {
    const auto& [a, b, c, d, e, f] = q;
    if (a.sign() == 0 && b.sign() == 0 && c.sign() == 0) {
        if (d.sign() != 0 || e.sign() != 0) return ConicType::line;
        return f.sign() == 0 ? ConicType::plane : ConicType::empty;
    }
    const Invariants i = invariants(q);
    if (i.big.sign() == 0) {
        if (i.delta.sign() != 0) return i.delta.sign() > 0 ? ConicType::point : ConicType::crossing_lines;
        return i.k.sign() > 0    ? ConicType::parallel_lines
               : i.k.sign() == 0 ? ConicType::double_line
                                 : ConicType::empty;
    }
    if (i.delta.sign() == 0) return ConicType::parabola;
    if (i.delta.sign() < 0) return ConicType::hyperbola;
    if (i.trace.sign() * i.big.sign() > 0) return ConicType::empty;
    return b.sign() == 0 && (a - c).sign() == 0 ? ConicType::circle : ConicType::ellipse;
}

Exacts exact(const std::array<double, 6>& c) {
    Exacts q;
    for (std::size_t i = 0; i < 6; ++i) q[i] = Exact(c[i]);
    return q;
}

// The double next to an exact number, off by at most one unit in the last place.
Bounded rounded(const Exact& x) {
    const double v = x.rounded();
    return {v, x == Exact(std::isfinite(v) ? v : 0) ? 0 : std::abs(v) * 0x1p-52 + 0x1p-1074};
}

Result<void> check_equation(const ConicEquation& q) {
    for (std::size_t i = 0; i < 6; ++i)
        if (!std::isfinite(q.c[i]))
            return refuse(RefusalKind::nonfinite, text("c[", i, "]"),
                          text(q.c[i], " is not a finite number"));
    if (!is_finite(q.origin)) return refuse(RefusalKind::nonfinite, "origin", "is not finite");
    return {};
}

// Lengths are multiplied by 2^-exponent, the equation by a power of two, so that coefficients are at most
// about 1.
struct Scaled {
    std::array<double, 6> c;
    int exponent = 0;
};
Scaled scaled(const std::array<double, 6>& c) {
    const auto log = [&](std::size_t from, std::size_t to) {
        double m = 0;
        for (std::size_t i = from; i < to; ++i) m = std::max(m, std::abs(c[i]));
        return m == 0 ? -4000 : std::ilogb(m);
    };
    const int second = log(0, 3), first = log(3, 5), zeroth = log(5, 6);
    Scaled s{c, 0};
    const int base = second > -4000 ? second : first;
    if (second > -4000)
        s.exponent = std::max({first - second, zeroth == -4000 ? -4000 : (zeroth - second) / 2, -2000});
    else
        s.exponent = std::max(zeroth - first, -2000);
    if (s.exponent == -2000) s.exponent = 0;
    const int order = second > -4000 ? 2 : 1;
    for (std::size_t i = 0; i < 6; ++i) {
        const int degree = i < 3 ? 2 : i < 5 ? 1 : 0;
        s.c[i] = std::scalbn(c[i], (degree - order) * s.exponent - base);
    }
    return s;
}

using Pair = std::array<Bounded, 2>;

// The unit eigenvector of (a b/2; b/2 c) for the eigenvalue (a + c + r) / 2.
Pair eigenvector(const Bounded& difference, const Bounded& b, const Bounded& r) {
    if (r.value == 0) return {Bounded(1), Bounded(0)};
    if (b.is_zero())
        return difference.value >= 0 ? Pair{Bounded(1), Bounded(0)} : Pair{Bounded(0), Bounded(1)};
    const Bounded cosine = difference / r, half(0.5);
    if (difference.value >= 0) {
        const Bounded x = sqrt(half * (Bounded(1) + cosine));
        return {x, half * (b / r) / x};
    }
    const Bounded y = sqrt(half * (Bounded(1) - cosine));
    return {half * (b / r) / y, y};
}

Vec<2> values(const Pair& p, int exponent, double& bound) {
    bound = std::max({bound, std::scalbn(p[0].bound, exponent), std::scalbn(p[1].bound, exponent)});
    return {{std::scalbn(p[0].value, exponent), std::scalbn(p[1].value, exponent)}};
}
Pair times(const Bounded& s, const Pair& p) { return {s * p[0], s * p[1]}; }
Pair sum(const Pair& p, const Pair& q) { return {p[0] + q[0], p[1] + q[1]}; }

// The parts of a form in scaled coordinates, put back into those of the equation.
struct Back {
    Vec<2> origin;
    int exponent;
    Vec<2> place(const Pair& p, double& bound) const {
        const double s = std::scalbn(1.0, exponent);
        const Pair moved{Bounded(origin[0]) + p[0] * Bounded(s), Bounded(origin[1]) + p[1] * Bounded(s)};
        return values(moved, 0, bound);
    }
    Vec<2> direction(const Pair& p, double& bound) const { return values(p, exponent, bound); }
};

struct Quadratic {
    std::array<Bounded, 6> q;
    Exacts e;
    Invariants i;
    Bounded difference, r;
    Pair n, m;  // eigenvectors of (a + c + r) / 2 and (a + c - r) / 2

    explicit Quadratic(const std::array<double, 6>& c) : e(exact(c)), i(invariants(e)) {
        for (std::size_t k = 0; k < 6; ++k) q[k] = c[k];
        difference = rounded(e[0] - e[2]);
        r = sqrt(rounded((e[0] - e[2]) * (e[0] - e[2]) + e[1] * e[1]));
        n = eigenvector(difference, q[1], r);
        m = {-n[1], n[0]};
    }
    Pair centre() const {
        const Exact two(2);
        const Bounded delta = rounded(i.delta);
        return {rounded(e[1] * e[4] - two * e[2] * e[3]) / delta,
                rounded(e[1] * e[3] - two * e[0] * e[4]) / delta};
    }
};

void solve_central(const Quadratic& s, const Back& back, ConicForm& form) {
    const Bounded trace = rounded(s.i.trace), delta = rounded(s.i.delta), half(0.5);
    const bool positive = trace.value >= 0;
    const Bounded larger = half * (positive ? trace + s.r : trace - s.r);
    const Bounded smaller = Bounded(0.25) * delta / larger;
    const Bounded l1 = positive ? larger : smaller, l2 = positive ? smaller : larger;
    if (form.type == ConicType::point || form.type == ConicType::crossing_lines) {
        const Vec<2> p = back.place(s.centre(), form.bound);
        if (form.type == ConicType::point) {
            form.point = p;
            return;
        }
        // l1 u^2 + l2 v^2 = 0 along the eigenvectors.
        const Bounded slope = sqrt(-(l1 / l2));
        for (const double sign : {1.0, -1.0}) {
            const Pair d = sum(s.n, times(Bounded(sign) * slope, s.m));
            form.lines.push_back({p, values(d, 0, form.bound)});
        }
        return;
    }
    // F at the centre is D / (2 delta); half the squared axes are -F / l.
    const Bounded f = rounded(s.i.big) / (Bounded(2) * delta), s1 = -(f / l1), s2 = -(f / l2);
    FoundConic<2> found;
    found.conic.kind = form.type == ConicType::hyperbola ? ConicKind::hyperbola : ConicKind::ellipse;
    const bool swapped = form.type == ConicType::hyperbola ? s1.value < 0 : s1.value < s2.value;
    const Pair& along = swapped ? s.m : s.n;
    const Pair across = swapped ? times(Bounded(-1), s.n) : s.m;
    const Bounded length = swapped ? s2 : s1, width = swapped ? s1 : s2;
    found.conic.centre = back.place(s.centre(), found.centre_bound);
    found.conic.x = back.direction(times(sqrt(length), along), found.x_bound);
    found.conic.y = back.direction(times(sqrt(form.type == ConicType::hyperbola ? -width : width), across),
                                   found.y_bound);
    form.conic = found;
}

void solve_parabolic(const Quadratic& s, const Back& back, ConicForm& form) {
    const Bounded l = rounded(s.i.trace), half(0.5);
    // The eigenvector of l: that of the larger eigenvalue if l > 0.
    const Pair n = l.value > 0 ? s.n : s.m, m{-n[1], n[0]};
    const Bounded d = n[0] * s.q[3] + n[1] * s.q[4], p0 = -(d / (Bounded(2) * l));
    if (form.type == ConicType::parabola) {
        const Bounded k = m[0] * s.q[3] + m[1] * s.q[4], q0 = -((s.q[5] + half * d * p0) / k), size = k / l;
        FoundConic<2> found;
        found.conic.kind = ConicKind::parabola;
        found.conic.centre = back.place(sum(times(p0, n), times(q0, m)), found.centre_bound);
        found.conic.x = back.direction(times(-size, m), found.x_bound);
        found.conic.y = back.direction(times(size, n), found.y_bound);
        form.conic = found;
        return;
    }
    const Bounded apart =
        form.type == ConicType::double_line ? Bounded() : sqrt(rounded(s.i.k)) / (Bounded(2) * l);
    for (const double sign : {1.0, -1.0}) {
        if (sign < 0 && form.type == ConicType::double_line) break;
        form.lines.push_back(
            {back.place(times(p0 + Bounded(sign) * apart, n), form.bound), values(m, 0, form.bound)});
    }
}

// The parameters in [-limit, limit] where centre + .. has coordinate s: p cos t + q sin t = s, and the like.
std::vector<double> crossings(ConicKind kind, double p, double q, double s) {
    std::vector<double> t;
    if (kind == ConicKind::ellipse) {
        const double size = std::hypot(p, q), at = std::atan2(q, p);
        if (!(std::abs(s) <= size) || size == 0) return t;
        const double half = std::acos(s / size);
        t = {at - half, at + half};
        for (double& x : t) x -= kTwoPi * std::floor(x / (kTwoPi));
        return t;
    }
    // Hyperbola: with z = e^t, (p + q) z^2 - 2 s z + (p - q) = 0. Parabola: p t^2 + q t - s = 0.
    const bool hyperbola = kind == ConicKind::hyperbola;
    const double a = hyperbola ? p + q : p, b = hyperbola ? -s : q / 2, c = hyperbola ? p - q : -s;
    const double root = b * b - a * c;
    if (!(root >= 0)) return t;
    const double z = -(b + std::copysign(std::sqrt(root), b));
    for (const double x : {a == 0 ? HUGE_VAL : z / a, z == 0 ? HUGE_VAL : c / z}) {
        const double y = hyperbola ? (x > 0 ? std::log(x) : HUGE_VAL) : x;
        if (std::isfinite(y)) t.push_back(y);
    }
    return t;
}

}  // namespace

std::string_view name_of(ConicType type) {
    static constexpr std::string_view kNames[] = {
        "circle",      "ellipse", "parabola", "hyperbola", "crossing lines", "parallel lines",
        "double line", "line",    "point",    "empty",     "plane"};
    return kNames[int(type)];
}

Result<ConicType> classify(const ConicEquation& equation) {
    if (auto ok = check_equation(equation); !ok) return std::unexpected(ok.error());
    return kind_of(exact(equation.c));
}

Result<ConicForm> solve(const ConicEquation& equation) {
    const auto type = classify(equation);
    if (!type) return std::unexpected(type.error());
    ConicForm form{*type, {}, {}, {}, 0};
    if (form.type == ConicType::empty || form.type == ConicType::plane) return form;
    const Scaled small = scaled(equation.c);
    for (std::size_t i = 0; i < 6; ++i)
        if (small.c[i] != 0 && std::abs(small.c[i]) < 0x1p-1000)
            return refuse(RefusalKind::ill_conditioned, text("c[", i, "]"), "is too small beside the others");
    const Quadratic s(small.c);
    const Back back{equation.origin, small.exponent};
    if (form.type == ConicType::line) {
        // The point of the line that is nearest to the origin.
        const Bounded k = -(s.q[5] / (s.q[3] * s.q[3] + s.q[4] * s.q[4]));
        form.lines.push_back({back.place({k * s.q[3], k * s.q[4]}, form.bound), {{-small.c[4], small.c[3]}}});
    } else if (form.type == ConicType::parabola || form.type == ConicType::parallel_lines ||
               form.type == ConicType::double_line) {
        solve_parabolic(s, back, form);
    } else {
        solve_central(s, back, form);
    }
    double worst = form.bound;
    if (form.conic)
        worst = std::max({worst, form.conic->centre_bound, form.conic->x_bound, form.conic->y_bound,
                          max_abs(form.conic->conic.centre), max_abs(form.conic->conic.x),
                          max_abs(form.conic->conic.y)});
    for (const Line<2>& l : form.lines) worst = std::max(worst, max_abs(l.origin));
    if (!std::isfinite(worst))
        return refuse(RefusalKind::ill_conditioned, "c", "centre or axes leave the range of double");
    return form;
}

Result<std::vector<ConicArc<2>>> arcs_inside(const ConicForm& form, const Box<2>& box) {
    if (!form.conic)
        return refuse(RefusalKind::no_answer, "conic", text("the equation describes: ", name_of(form.type)));
    if (!is_finite(box.lo) || !is_finite(box.hi) || !(box.lo[0] < box.hi[0]) || !(box.lo[1] < box.hi[1]))
        return refuse(RefusalKind::invalid, "box", "is empty or not finite");
    std::vector<ConicArc<2>> arcs;
    const ConicKind kind = form.conic->conic.kind;
    for (int branch = 0; branch < (kind == ConicKind::hyperbola ? 2 : 1); ++branch) {
        FoundConic<2> found = *form.conic;
        if (branch == 1) found.conic.x = -found.conic.x;
        std::vector<double> t;
        for (int i = 0; i < 2; ++i)
            for (const double side : {box.lo[i], box.hi[i]})
                for (const double x :
                     crossings(kind, found.conic.x[i], found.conic.y[i], side - found.conic.centre[i]))
                    t.push_back(x);
        sort(t.begin(), t.end());
        const CurveGeometry<2> curve(found.conic);
        if (kind == ConicKind::ellipse) {
            if (t.empty())
                t = {0, kTwoPi};
            else
                t.push_back(t.front() + kTwoPi);
        }
        const auto is_inside = [&](std::size_t i) {
            return t[i] < t[i + 1] && box.contains(jet<0>(curve, Interval{t[i], t[i + 1]}.middle()).d[0]);
        };
        for (std::size_t i = 0; i + 1 < t.size(); ++i) {
            if (!is_inside(i)) continue;
            const double from = t[i];  // parts that follow each other inside are one arc: it touches a side
            while (i + 2 < t.size() && (is_inside(i + 1) || t[i + 1] == t[i + 2])) ++i;
            auto arc = conic_arc(found, {from, std::min(t[i + 1], from + kTwoPi)});
            if (!arc) return std::unexpected(arc.error());
            arcs.push_back(std::move(*arc));
        }
    }
    return arcs;
}

Result<FoundEquation> equation_of(const Conic<2>& conic) {
    if (auto ok = check(CurveGeometry<2>(conic)); !ok) return std::unexpected(ok.error());
    const int e = std::ilogb(std::max(max_abs(conic.x), max_abs(conic.y)));
    const auto axis = [&](const Vec<2>& v) { return Pair{std::scalbn(v[0], -e), std::scalbn(v[1], -e)}; };
    const Pair x = axis(conic.x), y = axis(conic.y);
    const Bounded area = x[0] * y[1] - x[1] * y[0], two(2);
    if (!area.excludes_zero())
        return refuse(RefusalKind::invalid, "conic", "x and y are parallel: it is flat");
    // u = q x y and v = x x q are linear in q = p - centre: u = cos t, v = sin t, times the area.
    const Bounded sign(conic.kind == ConicKind::hyperbola ? -1 : 1);
    std::array<Bounded, 6> c;
    if (conic.kind == ConicKind::parabola) {
        c = {x[1] * x[1], -(two * x[0] * x[1]), x[0] * x[0], -(area * y[1]), area * y[0], 0};
    } else {
        c = {y[1] * y[1] + sign * x[1] * x[1],
             -(two * (y[0] * y[1] + sign * x[0] * x[1])),
             y[0] * y[0] + sign * x[0] * x[0],
             0,
             0,
             -(area * area)};
    }
    FoundEquation found{{{}, conic.centre}, {}, ConicType::ellipse};
    for (std::size_t i = 0; i < 6; ++i) {
        const int power = i < 3 ? 0 : i < 5 ? e : 2 * e;
        found.equation.c[i] = std::scalbn(c[i].value, power);
        found.bound[i] = std::scalbn(c[i].bound, power);
        if (!std::isfinite(found.equation.c[i]) || !std::isfinite(found.bound[i]))
            return refuse(RefusalKind::ill_conditioned, "conic", "the equation leaves the range of double");
    }
    if (conic.kind == ConicKind::hyperbola) found.type = ConicType::hyperbola;
    if (conic.kind == ConicKind::parabola) found.type = ConicType::parabola;
    if (conic.kind == ConicKind::ellipse && kind_of(exact(found.equation.c)) == ConicType::circle)
        found.type = ConicType::circle;
    return found;
}

Result<FoundEquation> equation_through(const std::array<Vec<2>, 5>& points) {
    for (std::size_t i = 0; i < 5; ++i)
        if (!is_finite(points[i]))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"),
                          "has a coordinate that is not finite");
    // points[0] is the origin, so its row is (0, 0, 0, 0, 0, 1): f = 0, and four rows of five columns remain.
    std::array<std::array<Exact, 5>, 4> rows;
    for (std::size_t i = 1; i < 5; ++i) {
        const Exact x = Exact(points[i][0]) - Exact(points[0][0]),
                    y = Exact(points[i][1]) - Exact(points[0][1]);
        rows[i - 1] = {x * x, x * y, y * y, x, y};
    }
    Exacts q;
    int sign = 0, top = -5000;
    for (std::size_t column = 0; column < 5; ++column) {
        std::vector<Exact> m;
        for (const auto& row : rows)
            for (std::size_t k = 0; k < 5; ++k)
                if (k != column) m.push_back(row[k]);
        const Exact minor = determinant<Exact>(m, 4, 4);
        q[column] = column % 2 == 0 ? minor : Exact() - minor;
    }
    for (const Exact& x : q)
        if (x.sign() != 0) {
            if (sign == 0) sign = x.sign();
            top = std::max(top, x.exponent());
        }
    if (sign == 0)
        return refuse(RefusalKind::no_answer, "points",
                      "more than one conic passes these five points: four are on a line, or two are equal");
    const ConicType type = kind_of(q);
    if (type > ConicType::hyperbola)
        return refuse(RefusalKind::no_answer, "points",
                      text("the conic through them is degenerate: ", name_of(type)));
    FoundEquation found{{{}, points[0]}, {}, type};
    for (std::size_t i = 0; i < 6; ++i) {
        const Bounded c = rounded(q[i].scaled(-top));
        found.equation.c[i] = sign * c.value;
        found.bound[i] = c.bound;
        if (q[i].sign() != 0 && std::abs(c.value) < 0x1p-1000)
            return refuse(RefusalKind::ill_conditioned, "points",
                          "the coefficients are too far apart for doubles");
    }
    return found;
}

}  // namespace freiform

// Exact decisions about points of a curve, in integers.
//
// Notation: a = at - lo, b = hi - at; a point is sum C(n, i) b^(n-i) a^i q_i with homogeneous q_i, of
// polynomials with the weight 1, whose sum is (a + b)^n. Doubles are integers times a power of two, so all
// this is exact, and two points are the same if the products of coordinates of one with the weight of the
// other are.
//
// The plane of points in space: the 3 x 3 minors of three of the homogeneous points.
#include "self_contact_detail.hpp"

#include <freiform/poly/integer_roots.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace freiform::detail {

namespace {

// A parameter of a curve with the Bernstein coefficients, homogeneous ones of rational curves, that give its
// point without a rounding: those of a piece, or a single one at a knot where the curve passes its
// coefficient.
struct ExactPlace {
    double at = 0;
    Interval on;
    int degree = 0, coordinates = 0;  // with the weight, if there is one
    bool rational = false;
    std::vector<double> numbers;
};
// Nothing where coefficients of the piece would have to be computed first.
template <class P>
std::optional<ExactPlace> exact_place(const Curve<P>& curve, double at) {
    const BSplineBasis& basis = curve.basis();
    const int p = basis.degree(), s = basis.span(at);
    const Interval piece{basis.knot(s), basis.knot(s + 1)};
    int first = s - p, count = p + 1;
    if (p == 0 || basis.knot(s - p + 1) == at)  // knots of multiplicity p and more
        count = 1;
    else if (basis.knot(s + p) == at)
        first = s, count = 1;
    else if (basis.knot(s - p + 1) != piece.lo || basis.knot(s + p) != piece.hi)
        return std::nullopt;
    ExactPlace place{at, piece, count - 1, P::kCoords, Space<P>::kRational, {}};
    for (int i = first; i < first + count; ++i) {
        const P& b = curve.net().flat()[std::size_t(i % basis.size())];
        place.numbers.insert(place.numbers.end(), b.c.begin(), b.c.end());
    }
    return place;
}

using Integers = std::vector<Integer>;

Integers powers(const Integer& x, int n) {
    Integers p{integer(1)};
    for (int i = 0; i < n; ++i) p.push_back(p.back() * x);
    return p;
}

// Homogeneous coordinates, the weight last. `numbers` and `one` are scaled alike.
Integers point_of(const ExactPlace& place, std::span<const Integer> numbers, const Integer& one) {
    const double ends[] = {place.on.lo, place.at, place.on.hi};
    const Integers x = integer_coefficients(ends, 1);
    const int n = place.degree;
    const Integers a = powers(x[1] - x[0], n), b = powers(x[2] - x[1], n);
    Integers sum(std::size_t(place.coordinates));
    for (int i = 0; i <= n; ++i) {
        const Integer factor =
            integer(std::int64_t(binomial(n, i))) * a[std::size_t(i)] * b[std::size_t(n - i)];
        for (std::size_t c = 0; c < sum.size(); ++c)
            sum[c] = sum[c] + factor * numbers[std::size_t(i) * sum.size() + c];
    }
    if (!place.rational) sum.push_back(one * powers(x[2] - x[0], n).back());
    return sum;
}

// Are the points the same, exactly? REQUIRES places of one curve.
bool is_same_point(const ExactPlace& a, const ExactPlace& b) {
    std::vector<double> all = a.numbers;
    all.insert(all.end(), b.numbers.begin(), b.numbers.end());
    all.push_back(1);
    const Integers scaled = integer_coefficients(all, 1);
    const std::span<const Integer> numbers(scaled);
    const Integers p = point_of(a, numbers.first(a.numbers.size()), scaled.back()),
                   q = point_of(b, numbers.subspan(a.numbers.size()), scaled.back());
    for (std::size_t c = 0; c + 1 < p.size(); ++c)
        if (p[c] * q.back() != q[c] * p.back()) return false;
    return true;
}

// One answer of a search.
template <class P>
class Contact {
public:
    using Meeting = SelfIntersection<Space<P>::kDim>;
    explicit Contact(const Curve<P>& curve) : curve_(curve) {}

    // What a pair of intervals that was given up is.
    void describe(Meeting& m) const {
        m.at = m.first.overlaps(m.second) ? std::array{m.first.lo, m.second.hi} : nearest(m.first, m.second);
        if (meets_exactly(m)) {
            m.kind = SelfContact::meeting;
            return;
        }
        if (m.kind == SelfContact::near && m.first.overlaps(m.second)) m.kind = SelfContact::cusp;
        if (m.kind == SelfContact::near)
            m.distance = (gap(m.at[0], m.at[1]) + 4 * curve_.value_error_bound()) * (1 + 0x1p-50);
        else
            m.at = {m.first.middle(), m.second.middle()};
    }

private:
    double gap(double s, double t) const { return norm(curve_(s) - curve_(t)); }

    // Parameters with a small distance: from the best of a grid by the method of Gauss and Newton, damped.
    std::array<double, 2> nearest(const Interval& first, const Interval& second) const {
        constexpr int kGrid = 4, kSteps = 30;
        std::array<double, 2> best{first.middle(), second.middle()};
        double least = gap(best[0], best[1]);
        for (int i = 0; i <= kGrid; ++i)
            for (int j = 0; j <= kGrid; ++j) {
                const double s = first.lo + first.length() * i / kGrid,
                             t = second.lo + second.length() * j / kGrid;
                if (const double d = gap(s, t); d < least) least = d, best = {s, t};
            }
        double damping = 1e-3;
        for (int k = 0; k < kSteps && least > 0; ++k) {
            const auto a = curve_.template jet<1>(best[0]), b = curve_.template jet<1>(best[1]);
            const auto f = a.value() - b.value(), u = a.d[1], v = b.d[1];
            const double uu = dot(u, u) * (1 + damping), vv = dot(v, v) * (1 + damping), uv = dot(u, v),
                         det = uu * vv - uv * uv;
            if (!(det > 0)) break;
            const double fu = dot(f, u), fv = dot(f, v);
            const std::array<double, 2> next{clamped(best[0] - (fu * vv - fv * uv) / det, first),
                                             clamped(best[1] + (fv * uu - fu * uv) / det, second)};
            const double d = gap(next[0], next[1]);
            damping = d < least ? damping / 4 : damping * 8;
            if (d < least) least = d, best = next;
        }
        return best;
    }

    // Simple parameters in an interval near x: x itself, multiples of 2^-20 and 2^-10 of a piece, knots.
    std::vector<double> simple_near(double x, const Interval& on) const {
        const BSplineBasis& basis = curve_.basis();
        const int span = basis.span(x);
        const double lo = basis.knot(span), hi = basis.knot(span + 1);
        std::vector<double> all{x, lo, hi};
        for (const double n : {0x1p20, 0x1p10})
            all.push_back(lo + (hi - lo) * (std::round((x - lo) / (hi - lo) * n) / n));
        std::erase_if(all, [&](double y) { return !on.contains(y); });
        return all;
    }

    bool meets_exactly(Meeting& m) const {
        const double noise = 8 * curve_.value_error_bound();
        for (const double s : simple_near(m.at[0], m.first))
            for (const double t : simple_near(m.at[1], m.second)) {
                if (!(s < t) || !(gap(s, t) <= noise)) continue;
                if (curve_.basis().is_closed() && s == curve_.basis().domain().lo &&
                    t == curve_.basis().domain().hi)
                    continue;
                const auto a = detail::exact_place(curve_, s), b = detail::exact_place(curve_, t);
                if (!a || !b || !detail::is_same_point(*a, *b)) continue;
                m.at = {s, t};
                return true;
            }
        return false;
    }

    const Curve<P>& curve_;
};

using Plane = std::array<Integer, 4>;

// All x with det(a, b, c, x) = 0.
Plane plane_through(const Integer* a, const Integer* b, const Integer* c) {
    const auto minor = [&](std::size_t i, std::size_t j, std::size_t k) {
        return a[i] * (b[j] * c[k] - b[k] * c[j]) - a[j] * (b[i] * c[k] - b[k] * c[i]) +
               a[k] * (b[i] * c[j] - b[j] * c[i]);
    };
    return {minor(1, 2, 3), negated(minor(0, 2, 3)), minor(0, 1, 3), negated(minor(0, 1, 2))};
}

bool are_parallel(const Integer* a, const Integer* b) {
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j)
            if (a[i] * b[j] != a[j] * b[i]) return false;
    return true;
}

}  // namespace

std::optional<int> spare_coordinate(const Tuples& points) {
    std::vector<double> all;
    for (std::size_t i = 0; i < points.count(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) all.push_back(points[i][c]);
        all.push_back(points.weight(i));
    }
    const Integers h = integer_coefficients(all, 1);
    const auto point = [&](std::size_t i) { return h.data() + 4 * i; };
    std::size_t second = 1;
    while (second < points.count() && are_parallel(point(0), point(second))) ++second;
    for (std::size_t third = second + 1; third < points.count(); ++third) {
        const Plane plane = plane_through(point(0), point(second), point(third));
        std::optional<int> best;
        double most = 0;
        int exponent = 0;
        for (int c = 0; c < 3; ++c) {
            const Leading size = leading(plane[std::size_t(c)]);
            const double fraction = std::abs(size.fraction);
            if (fraction == 0 ||
                (best && (size.exponent < exponent || (size.exponent == exponent && fraction <= most))))
                continue;
            best = c, most = fraction, exponent = size.exponent;
        }
        if (!best) continue;  // on one line with the others so far
        for (std::size_t i = third + 1; i < points.count(); ++i) {
            Integer sum;
            for (std::size_t c = 0; c < 4; ++c) sum = sum + plane[c] * point(i)[c];
            if (sum.sign() != 0) return std::nullopt;
        }
        return best;
    }
    return std::nullopt;
}

template <class P>
void describe(const Curve<P>& curve, SelfIntersection<Space<P>::kDim>& m) {
    Contact<P>(curve).describe(m);
}
template void describe(const Curve<Vec<2>>&, SelfIntersection<2>&);
template void describe(const Curve<Hom<2>>&, SelfIntersection<2>&);
template void describe(const Curve<Vec<3>>&, SelfIntersection<3>&);
template void describe(const Curve<Hom<3>>&, SelfIntersection<3>&);

}  // namespace freiform::detail

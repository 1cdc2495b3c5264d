// Zeros of functions of curves: see piecewise_detail.hpp.
//
// Method. A function of the coordinates (a Wronskian, a derivative) is a polynomial on each Bezier piece. It
// is computed with Bounded, whose bounds become the error of its coefficients; if that leaves no root
// uncertain, this is the answer. Otherwise, and if the coefficients of the piece are exact, it is computed
// again in integers. Zeros on both sides of a knot become one: their signs outside say what it is.
#include "query/piecewise_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/poly/integer_roots.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freiform::detail {

namespace {

double choose(int n, int k) {  // exact for n <= 50; each step is rounded twice beyond
    double c = 1;
    for (int i = 1; i <= k; ++i) c = c * (n - k + i) / i;
    return c;
}
Bounded bounded_choose(int n, int k) {
    const double c = choose(n, std::min(k, n - k));
    return {c, c < 0x1p53 ? 0 : c * (2.02 * n * kUnitRoundoff)};
}

std::vector<Integer> binomials(int n) {
    std::vector<Integer> row(std::size_t(n) + 1, integer(1));
    for (int i = 1; i <= n; ++i)
        row[std::size_t(i)] = divided(row[std::size_t(i) - 1] * integer(n - i + 1), integer(i)).quotient;
    return row;
}

bool is_settled(const RealRoots& r) {
    return r.kind == RootsKind::isolated && std::all_of(r.roots.begin(), r.roots.end(), [](const Root& x) {
               return x.is_one && x.is_certain();
           });
}

}  // namespace

template <class P>
CurvePieces pieces_of(const Curve<P>& curve) {
    const BezierPieces<1, P> pieces(curve);
    const BSplineBasis& basis = curve.basis();
    const int p = basis.degree();
    CurvePieces out{Space<P>::kDim, Space<P>::kRational, basis.is_closed(), {}};
    for (int i = 0; i < pieces.extent()[0]; ++i) {
        const auto net = pieces.net({i});
        CurvePiece piece{pieces.box({i})[0], {}, {}};
        const int s = basis.span(piece.on.lo);
        const bool exact =
            p == 0 || (basis.knot(s - p + 1) == piece.on.lo && basis.knot(s + p) == piece.on.hi);
        for (int k = 0; k < P::kCoords; ++k) {
            std::vector<double> row;
            double most = 0;
            for (int j = 0; j <= p; ++j)
                row.push_back(net({j})[k]), most = std::max(most, std::abs(row.back()));
            piece.row.push_back(std::move(row));
            piece.error.push_back(exact ? 0 : (12 * p + 8) * kUnitRoundoff * most + 0x1p-1060);
        }
        out.pieces.push_back(std::move(piece));
    }
    return out;
}
template CurvePieces pieces_of(const Curve<Vec<1>>&);
template CurvePieces pieces_of(const Curve<Vec<2>>&);
template CurvePieces pieces_of(const Curve<Vec<3>>&);
template CurvePieces pieces_of(const Curve<Vec<4>>&);
template CurvePieces pieces_of(const Curve<Hom<1>>&);
template CurvePieces pieces_of(const Curve<Hom<2>>&);
template CurvePieces pieces_of(const Curve<Hom<3>>&);
template CurvePieces pieces_of(const Curve<Hom<4>>&);

Coordinates<Bounded> bounded_coordinates(const CurvePiece& piece, int dimension) {
    // One power of two for all, so that products neither overflow nor underflow needlessly.
    double most = 0;
    for (const auto& row : piece.row)
        for (const double x : row) most = std::max(most, std::abs(x));
    const int e = most > 0 ? -std::ilogb(most) : 0;
    const auto form = [&](std::size_t k) {
        const std::vector<double>& row = piece.row[k];
        const double error = piece.error[k];
        Form<Bounded> f;
        const int n = int(row.size()) - 1;
        for (int i = 0; i <= n; ++i) {
            // Scaling loses at most 2^-1074, and only where the error is not 0 anyway or x is tiny.
            const double x = std::scalbn(row[std::size_t(i)], e);
            const bool lost = std::scalbn(x, -e) != row[std::size_t(i)];
            const Bounded c{x, std::scalbn(error, e) + (lost || error > 0 ? 0x1p-1074 : 0)};
            f.s.push_back(bounded_choose(n, i) * c);
        }
        return f;
    };
    Coordinates<Bounded> c;
    for (int k = 0; k < dimension; ++k) c.x.push_back(form(std::size_t(k)));
    c.w = int(piece.row.size()) > dimension ? form(piece.row.size() - 1) : Form<Bounded>{{Bounded(1)}};
    return c;
}

Coordinates<Integer> integer_coordinates(const CurvePiece& piece, int dimension) {
    std::vector<double> all;
    for (const auto& row : piece.row) all.insert(all.end(), row.begin(), row.end());
    const std::vector<Integer> whole = integer_coefficients(all, 1);
    const std::size_t count = piece.row[0].size();
    const auto row = binomials(int(count) - 1);
    Coordinates<Integer> c;
    for (std::size_t k = 0; k < piece.row.size(); ++k) {
        Form<Integer> f;
        for (std::size_t i = 0; i < count; ++i) f.s.push_back(row[i] * whole[k * count + i]);
        if (int(k) < dimension)
            c.x.push_back(std::move(f));
        else
            c.w = std::move(f);
    }
    if (c.w.is_zero()) c.w = {{integer(1)}};
    return c;
}

std::vector<Bounded> bernstein(const Form<Bounded>& f) {
    std::vector<Bounded> c;
    for (int i = 0; i <= f.degree(); ++i) c.push_back(f.s[std::size_t(i)] / bounded_choose(f.degree(), i));
    return c;
}

std::vector<Integer> bernstein(const Form<Integer>& f) {
    if (f.is_zero()) return {Integer{}};
    const auto row = binomials(f.degree());
    Integer common = integer(1);
    for (const Integer& b : row) common = common * divided(b, gcd(common, b)).quotient;
    std::vector<Integer> c;
    for (std::size_t i = 0; i < f.s.size(); ++i) c.push_back(f.s[i] * divided(common, row[i]).quotient);
    return c;
}

PieceZeros with_ends(RealRoots found, std::span<const Bounded> c) {
    PieceZeros z{std::move(found), 0, 0};
    const auto sign = [](const Bounded& x) { return x.excludes_zero() ? (x.value > 0 ? 1 : -1) : 0; };
    if (z.found.kind != RootsKind::isolated || c.empty()) return z;
    z.first = sign(c.front());
    z.last = sign(c.back());
    // Exact answers know more than the rounded coefficients.
    const auto& r = z.found.roots;
    if (z.first == 0 && !r.empty() && r.front().at.lo > 0) z.first = r.front().before;
    if (z.last == 0 && !r.empty() && r.back().at.hi < 1) z.last = r.back().after;
    return z;
}

Result<PieceZeros> zeros_of(const Expression& f, const CurvePiece& piece, int dimension, double width) {
    const std::vector<Bounded> c = bernstein(f.bounded(bounded_coordinates(piece, dimension)));
    if (c.empty()) return PieceZeros{{RootsKind::zero, {}, Arithmetic::plain}, 0, 0};
    std::vector<double> values;
    double error = 0;
    bool finite = true;
    for (const Bounded& x : c) {
        values.push_back(x.value);
        error = std::max(error, x.bound);
        finite = finite && x.bound - x.bound == 0 && x.value - x.value == 0;
    }
    if (int(c.size()) > kMaxRootDegree + 1)
        return refuse(
            RefusalKind::unsupported, "degree",
            text("the question leads to a polynomial of degree ", c.size() - 1, ", above ", kMaxRootDegree));
    if (finite) {
        auto found = real_roots(values, width, error);
        if (!found) return std::unexpected(found.error());
        if (is_settled(*found) || !piece.is_exact()) return with_ends(std::move(*found), c);
    } else if (!piece.is_exact()) {
        return PieceZeros{{RootsKind::possibly_zero, {}, Arithmetic::plain}, 0, 0};
    }
    const std::vector<Integer> whole = bernstein(f.whole(integer_coordinates(piece, dimension)));
    const auto sign = [](const Integer& x) { return x.sign(); };
    if (std::all_of(whole.begin(), whole.end(), [](const Integer& x) { return x.sign() == 0; }))
        return PieceZeros{{RootsKind::zero, {}, Arithmetic::exact}, 0, 0};
    return PieceZeros{{RootsKind::isolated, integer_roots(whole, width), Arithmetic::exact},
                      sign(whole.front()),
                      sign(whole.back())};
}

Interval image(const Interval& on, const Interval& part) {
    const auto map = [&](double s, double outwards) {
        if (s == 0) return on.lo;
        if (s == 1) return on.hi;
        if (on.lo == 0 && on.hi == 1) return s;
        // Two roundings; a neighbour in either direction is as far as they can lead.
        const double t = on.lo + on.length() * s;
        const double slack = 2 * kUnitRoundoff * (std::abs(on.lo) + on.length()) + 0x1p-1074;
        return std::clamp(t + outwards * slack, on.lo, on.hi);
    };
    return {map(part.lo, -1), map(part.hi, 1)};
}

namespace {

// Zeros on both sides of a knot, a left and b right of it, as one over `at`.
Zero merged(const Zero& a, const Zero& b, const Interval& at) {
    if (a.everywhere != b.everywhere) {  // the end of an overlap is a zero of its neighbour already
        Zero m = a.everywhere ? a : b;
        m.before = a.before;
        m.after = b.after;
        return m;
    }
    Zero m{at, std::max(a.least, b.least), kUncounted, false, a.everywhere, false, a.before, b.after};
    if (a.everywhere) return m;
    const bool at_knot = a.at.lo == a.at.hi && b.at.lo == b.at.hi;
    if (a.most != kUncounted && b.most != kUncounted)
        m.most = at_knot ? std::max(a.most, b.most) : a.most + b.most;
    m.is_one = at_knot && a.is_one && b.is_one;
    const int signs = m.before * m.after;
    if (m.is_one || signs == 0 || m.most == kUncounted) return m;
    // The signs outside say whether the number is odd.
    if (m.most % 2 != int(signs < 0)) --m.most;
    if (signs < 0) m.least = std::max(m.least, 1);
    m.least = std::min(m.least, m.most);
    m.is_one = m.least == 1 && m.most == 1;
    return m;
}

bool is_point_or_same(const Zero& a, const Zero& b) {
    if (a.everywhere == b.everywhere) return true;
    const Zero& other = a.everywhere ? b : a;
    return other.at.lo == other.at.hi;
}

// The last zero and the first one of a closed curve, where they meet at the seam.
void join_seam(const CurvePieces& curve, std::span<const PieceZeros> zeros, std::vector<Zero>& all) {
    const double lo = curve.pieces.front().on.lo, hi = curve.pieces.back().on.hi;
    if (all.size() > 1 && all.front().at.lo == lo && all.back().at.hi == hi &&
        is_point_or_same(all.back(), all.front())) {
        const Zero first = all.front(), last = all.back();
        const bool at_knot = first.at.hi == lo && last.at.lo == hi;
        // Beyond the end parameters go on, as they do on closed curves; rounded outwards.
        const double end = hi + (first.at.hi - lo);
        const Interval over{last.at.lo, end > hi ? std::nextafter(end, 2 * std::abs(end) + 1) : end};
        const Zero m = merged(last, first, at_knot ? Interval{lo, lo} : over);
        all.pop_back();
        all.erase(all.begin());
        if (m.most > 0) all.insert(at_knot ? all.begin() : all.end(), m);
    } else if (zeros.back().last * zeros.front().first < 0) {
        all.insert(all.begin(), {{lo, lo}, 1, 1, true, false, true, zeros.back().last, zeros.front().first});
    }
}

}  // namespace

std::vector<Zero> joined(const CurvePieces& curve, std::span<const PieceZeros> zeros) {
    std::vector<Zero> all;
    for (std::size_t i = 0; i < zeros.size(); ++i) {
        const PieceZeros& z = zeros[i];
        const Interval on = curve.pieces[i].on;
        std::vector<Zero> own;
        if (z.found.kind != RootsKind::isolated) {
            const bool certain = z.found.kind == RootsKind::zero;
            own.push_back({on, certain ? 1 : 0, kUncounted, false, certain, false, 0, 0});
        }
        for (const Root& r : z.found.roots)
            own.push_back({image(on, r.at), r.least, r.most, r.is_one, false, false, r.before, r.after});
        const bool meet = !all.empty() && all.back().at.hi == on.lo && !own.empty() &&
                          own.front().at.lo == on.lo && is_point_or_same(all.back(), own.front());
        if (meet) {
            own.front() = merged(all.back(), own.front(), {all.back().at.lo, own.front().at.hi});
            all.pop_back();
            if (own.front().most == 0) own.erase(own.begin());
        } else if (i > 0 && zeros[i - 1].last * z.first < 0) {
            all.push_back({{on.lo, on.lo}, 1, 1, true, false, true, zeros[i - 1].last, z.first});
        }
        all.insert(all.end(), own.begin(), own.end());
    }
    if (curve.is_closed && !zeros.empty()) join_seam(curve, zeros, all);
    return all;
}

namespace {

double speed_bound(const CurvePiece& piece, int dimension) {
    // Polynomial: n max |difference|. Rational: C' = n sum of positive multiples of P_j - P_i over w^2; |C'|
    // <= n (w_max / w_min)^2 max |P_{i+1} - P_i| [Floater 1992]. In each case a bound of what the search is
    // wide.
    const int n = piece.degree();
    const bool rational = int(piece.row.size()) > dimension;
    double most = 0, least_w = 1, most_w = 1, scale = 0, off_w = 0, off = 0;
    for (int k = 0; k < dimension; ++k) off = std::max(off, piece.error[std::size_t(k)]);
    if (rational) {
        off_w = piece.error.back();
        least_w = *std::min_element(piece.row.back().begin(), piece.row.back().end()) - off_w;
        most_w = *std::max_element(piece.row.back().begin(), piece.row.back().end()) + off_w;
        if (!(least_w > 0)) return std::numeric_limits<double>::infinity();
    }
    const auto at = [&](int k, int i) {
        const double x = piece.row[std::size_t(k)][std::size_t(i)];
        return rational ? x / piece.row.back()[std::size_t(i)] : x;
    };
    for (int i = 0; i < n; ++i) {
        double sum = 0;
        for (int k = 0; k < dimension; ++k) {
            const double d = at(k, i + 1) - at(k, i);
            sum = std::max(sum, std::abs(d));
            scale = std::max({scale, std::abs(at(k, i)), std::abs(at(k, i + 1))});
        }
        most = std::max(most, sum * std::sqrt(double(dimension)));
    }
    const double ratio = most_w / least_w;
    const double lost = ((off + scale * off_w) / least_w + 4 * kUnitRoundoff * scale) * 4;
    return 1.01 * n * ratio * ratio * (most + lost * dimension);
}

}  // namespace

std::vector<double> speed_bounds(const CurvePieces& curve) {
    std::vector<double> all;
    for (const CurvePiece& p : curve.pieces) all.push_back(speed_bound(p, curve.dimension));
    return all;
}

double width_for(double accuracy, double speed) {
    if (!(speed > 0)) return 1;
    return std::min(1.0, 0.9 * accuracy / speed);
}

double reach_of(const CurvePieces& curve, std::span<const double> speed, const Interval& at) {
    // Intervals over the seam of a closed curve end beyond the last piece.
    const double beyond = std::max(0.0, at.hi - curve.pieces.back().on.hi), seam = curve.pieces.front().on.lo;
    double reach = 0;
    for (std::size_t i = 0; i < speed.size(); ++i) {
        const Interval on = curve.pieces[i].on;
        for (const Interval& part : {at, Interval{seam, seam + beyond}}) {
            const double length = std::min(on.hi, part.hi) - std::max(on.lo, part.lo);
            if (length > 0) reach += speed[i] * std::min(1.0, length / on.length());
        }
    }
    return 1.01 * reach;
}

}  // namespace freiform::detail

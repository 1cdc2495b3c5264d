// Crossings of a curve with a line or plane.
//
// Idea. Along a Bezier piece the signed distance, times the weight, is a polynomial whose Bernstein
// coefficients are g_i = sum_k n_k X_ik + c w_i; its real roots are the crossings.
//
// Method. Products of two doubles are sums of two doubles (fma), so where the coefficients of the piece are
// exact, g_i is handed over as a sum of 2 (D + 1) doubles, and the roots are exact. If a product is so small
// that this could underflow (below 2^-900 of the largest number squared), or the piece is known up to an
// error, g_i is one double with a bound. Roots on both sides of a knot are joined (piecewise.cpp); signs
// before and after tell crossing from tangent.
//
// Accuracy. A root in an interval of width d (of [0, 1]) is within d max |dC/dt| / 2 of the point in the
// middle; `width` is chosen from that. `bound` is computed from the interval reached, plus the rounding of
// the point.
//
// Cost. A cubic and a line: about 2 us.
//
// References. [Lane Riesenfeld 1981]: variation diminishing, so no more crossings than the control polygon.
//
// Why not clipping of the control polygon against the line and Newton's method from there? It finds one root
// for each crossing of the polygon, but the polygon may cross where the curve does not.
#include "query/piecewise_detail.hpp"

#include <freiform/query/crossings.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freiform {

namespace {

using namespace detail;

// The distance function on a piece.
struct Distance {
    std::vector<double> parts;  // exact; empty if it is not
    std::vector<Bounded> c;
    int terms = 0;
};

// `plane` holds the normal and the offset, scaled like `piece` to at most 1.
Distance distance_of(const CurvePiece& piece, std::span<const Bounded> plane, int dimension) {
    Distance d;
    d.terms = 2 * (dimension + 1);
    bool exact = piece.is_exact();
    const std::size_t rows = piece.row.size(), count = piece.row[0].size();
    for (std::size_t i = 0; i < count; ++i) {
        Bounded sum;
        for (std::size_t k = 0; k <= std::size_t(dimension); ++k) {
            const bool weight = k == std::size_t(dimension);
            const double x = k < rows ? piece.row[k][i] : 1;
            const double error = weight && rows == k ? 0 : piece.error[k];
            const double high = plane[k].value * x, low = std::fma(plane[k].value, x, -high);
            d.parts.push_back(high);
            d.parts.push_back(low);
            exact =
                exact && plane[k].bound == 0 && (plane[k].value == 0 || x == 0 || std::abs(high) > 0x1p-900);
            sum = sum + plane[k] * Bounded(x, error);
        }
        d.c.push_back(sum);
    }
    if (!exact) d.parts.clear();
    return d;
}

Result<PieceZeros> zeros_of(const Distance& d, double width) {
    if (!d.parts.empty()) {
        auto found = real_roots_of_sums(d.parts, d.terms, width);
        if (!found) return std::unexpected(found.error());
        return with_ends(std::move(*found), d.c);
    }
    std::vector<double> values;
    double error = 0;
    for (const Bounded& x : d.c) values.push_back(x.value), error = std::max(error, x.bound);
    auto found = real_roots(values, width, error);
    if (!found) return std::unexpected(found.error());
    return with_ends(std::move(*found), d.c);
}

// Coordinates, and with them the plane, multiplied by powers of two: numbers of the curve and of the plane
// are then at most 1, whatever the unit of length is.
std::vector<Bounded> scale(CurvePieces& curve, std::span<const double> plane) {
    const std::size_t dimension = std::size_t(curve.dimension);
    double x = 0, w = curve.is_rational ? 0 : 1, n = 0;
    for (const CurvePiece& p : curve.pieces)
        for (std::size_t k = 0; k < p.row.size(); ++k)
            for (const double y : p.row[k])
                (k < dimension ? x : w) = std::max(k < dimension ? x : w, std::abs(y));
    const int ex = x > 0 ? std::ilogb(x) + 1 : 0, ew = curve.is_rational ? std::ilogb(w) + 1 : 0;
    for (CurvePiece& p : curve.pieces) {
        for (std::size_t k = 0; k < p.row.size(); ++k) {
            const int e = k < dimension ? ex : ew;
            p.error[k] = std::scalbn(p.error[k], -e);
            for (double& y : p.row[k]) {
                const double z = std::scalbn(y, -e);
                if (std::scalbn(z, e) != y) p.error[k] = std::max(p.error[k], 0x1p-1070);
                y = z;
            }
        }
    }
    // n . x + c w = 2^ex n . (x 2^-ex) + 2^ew c (w 2^-ew)
    for (std::size_t k = 0; k < dimension; ++k) n = std::max(n, std::abs(plane[k]));
    const int en = std::ilogb(n) + 1, ec = plane[dimension] == 0 ? 0 : std::ilogb(plane[dimension]) + 1;
    const int top = plane[dimension] == 0 ? en + ex : std::max(en + ex, ec + ew);
    std::vector<Bounded> scaled;
    for (std::size_t k = 0; k <= dimension; ++k) {
        const int e = (k < dimension ? ex : ew) - top;
        const double y = std::scalbn(plane[k], e);
        scaled.emplace_back(y, std::scalbn(y, -e) == plane[k] ? 0 : 0x1p-1074);
    }
    return scaled;
}

CrossingKind kind_of(const Zero& z, const Interval& domain, bool is_closed) {
    if (z.everywhere) return CrossingKind::overlap;
    if (z.jump) return CrossingKind::jump;
    if (z.least == 0) return CrossingKind::possible;
    if (!is_closed && (z.at.lo == domain.lo || z.at.hi == domain.hi)) return CrossingKind::end;
    if (z.before * z.after < 0) return CrossingKind::crossing;
    if (z.before * z.after > 0) return z.is_one ? CrossingKind::tangent : CrossingKind::possible;
    return z.is_one ? (z.most % 2 != 0 ? CrossingKind::crossing : CrossingKind::tangent)
                    : CrossingKind::possible;
}

}  // namespace

std::string_view name_of(CrossingKind kind) {
    switch (kind) {
        case CrossingKind::crossing:
            return "crossing";
        case CrossingKind::tangent:
            return "tangent";
        case CrossingKind::end:
            return "end";
        case CrossingKind::overlap:
            return "overlap";
        case CrossingKind::jump:
            return "jump";
        case CrossingKind::possible:
            return "possible";
    }
    return "";
}

template <class P>
Result<std::vector<Crossing<Space<P>::kDim>>> crossings(const Curve<P>& curve, const PointOf<P>& normal,
                                                        double offset, double accuracy) {
    constexpr int D = Space<P>::kDim;
    if (!is_finite(normal) || !std::isfinite(offset))
        return refuse(RefusalKind::nonfinite, "plane", "has a number that is not finite");
    if (max_abs(normal) == 0) return refuse(RefusalKind::invalid, "normal", "is zero");
    if (!(accuracy >= 0))
        return refuse(RefusalKind::invalid, "accuracy", text(accuracy, " is not a length >= 0"));

    CurvePieces pieces = pieces_of(curve);
    std::vector<double> plane(normal.c.begin(), normal.c.end());
    plane.push_back(offset);
    const std::vector<double> speed = speed_bounds(pieces);
    const std::vector<Bounded> scaled = scale(pieces, plane);
    std::vector<PieceZeros> zeros;
    for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
        auto z = zeros_of(distance_of(pieces.pieces[i], scaled, D), width_for(accuracy, speed[i]));
        if (!z) return refuse_within(text("pieces[", i, "]"), z.error());
        zeros.push_back(std::move(*z));
    }
    std::vector<Crossing<D>> out;
    for (const Zero& z : joined(pieces, zeros)) {
        Crossing<D> c{kind_of(z, curve.basis().domain(), pieces.is_closed), z.at, z.least, z.most, {}, 0};
        if (z.everywhere) c.least = c.most = 0;
        c.point = curve(z.at.middle());
        c.bound = curve.value_error_bound() * std::sqrt(double(D)) + reach_of(pieces, speed, z.at);
        out.push_back(c);
    }
    return out;
}

template Result<std::vector<Crossing<1>>> crossings(const Curve<Vec<1>>&, const Vec<1>&, double, double);
template Result<std::vector<Crossing<2>>> crossings(const Curve<Vec<2>>&, const Vec<2>&, double, double);
template Result<std::vector<Crossing<3>>> crossings(const Curve<Vec<3>>&, const Vec<3>&, double, double);
template Result<std::vector<Crossing<4>>> crossings(const Curve<Vec<4>>&, const Vec<4>&, double, double);
template Result<std::vector<Crossing<1>>> crossings(const Curve<Hom<1>>&, const Vec<1>&, double, double);
template Result<std::vector<Crossing<2>>> crossings(const Curve<Hom<2>>&, const Vec<2>&, double, double);
template Result<std::vector<Crossing<3>>> crossings(const Curve<Hom<3>>&, const Vec<3>&, double, double);
template Result<std::vector<Crossing<4>>> crossings(const Curve<Hom<4>>&, const Vec<4>&, double, double);

}  // namespace freiform

// Rational curves over one denominator.
//
// Idea: with the different denominators d_1 .. d_m, W their product, curve k over d_s is the numerator times
// W / d_s over W. Method: all curves on the breaks of all, piece by piece in Bernstein form, where products
// are exact but for rounding, which is counted (bounded.hpp).
//
// Accuracy: coefficients of pieces are off by what the common basis (compatible.hpp) and the extraction of
// pieces moved. A denominator w that differs from f times another, d, by e at most, is replaced by d: the
// numerator over f is then off by a factor of f d / w = 1 +- e / (w - e), which is added to its bound.
//
// Why not splines with the continuity that the products have? Their knots are known, but the coefficients
// cost a system of equations or a blossom of p q terms, and the surface is the same.
#include "bernstein_detail.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/make/boolean_sum.hpp>
#include <freiform/spline/bezier.hpp>
#include <freiform/spline/compatible.hpp>

#include <algorithm>

namespace freiform {

namespace {

using detail::BernsteinScalar;
using detail::BernsteinVector;

// Something with these breaks and degree 1, to make others compatible with.
template <class P>
Result<Curve<P>> marker(const std::vector<double>& breaks) {
    std::vector<double> t = breaks;
    t.insert(t.begin(), breaks.front());
    t.push_back(breaks.back());
    auto basis = BSplineBasis::make(1, std::move(t));
    if (!basis) return std::unexpected(basis.error());
    Net<1, P> net({basis->size()});
    if constexpr (Space<P>::kRational)
        for (P& p : net.flat()) p[P::kCoords - 1] = 1;
    return Curve<P>::trusted({*std::move(basis)}, std::move(net));
}

// The pieces of one curve: numerators and weights (of functions: values, as the first coordinate).
struct Pieces {
    std::vector<BernsteinVector> numerator;
    std::vector<BernsteinScalar> weight;
    double relative = 0;
};

template <class P>
Pieces pieces_of(const Curve<P>& c, double relative) {
    const BezierPieces<1, P> pieces(c);
    Pieces out;
    out.relative = relative + 1.01 * refinement_error(c.basis().degree());
    double largest = 0, heaviest = 0;
    for (const P& p : c.net().flat()) {
        for (int d = 0; d < Space<P>::kDim; ++d) largest = std::max(largest, std::abs(p[d]));
        heaviest = std::max(heaviest, Space<P>::weight(p));
    }
    const double e = out.relative * largest, f = Space<P>::kRational ? out.relative * heaviest : 0;
    for (int i = 0; i < pieces.extent()[0]; ++i) {
        auto& x = out.numerator.emplace_back();
        auto& w = out.weight.emplace_back();
        for (int k = 0; k <= pieces.degree(0); ++k) {
            const P& p = pieces.net({i})({k});
            BoundedVec<3> v{};
            for (int d = 0; d < Space<P>::kDim; ++d) v[std::size_t(d)] = {p[d], e};
            x.push_back(v);
            w.emplace_back(Space<P>::weight(p), f);
        }
    }
    return out;
}

// The curve over another denominator of which its own is a multiple, or over 1: numerators are divided by the
// factor and widened by what the quotient may be off. False, and unchanged, where it is no multiple.
bool share(Pieces& p, const Pieces* other) {
    const auto of_other = [&](std::size_t i, std::size_t j) {
        return other ? other->weight[i][j] : Bounded(1);
    };
    const Bounded factor = p.weight[0][0].value / of_other(0, 0).value;
    double least = std::numeric_limits<double>::infinity(), off = 0;
    for (std::size_t i = 0; i < p.weight.size(); ++i)
        for (std::size_t j = 0; j < p.weight[i].size(); ++j) {
            const Bounded difference = p.weight[i][j] - factor.value * of_other(i, j);
            least = std::min(least, p.weight[i][j].value - p.weight[i][j].bound);
            off = std::max(off, std::abs(difference.value) + difference.bound);
        }
    constexpr double kSame = 0x1p-40;  // rounding of common bases; more are different weights
    if (!(off <= kSame * least)) return false;
    double largest = 0;
    for (BernsteinVector& piece : p.numerator)
        for (auto& v : piece)
            for (Bounded& x : v) {
                x = x / Bounded(factor.value);
                largest = std::max(largest, std::abs(x.value) + x.bound);
            }
    if (off == 0) return true;
    for (BernsteinVector& piece : p.numerator)
        for (auto& v : piece)
            for (Bounded& x : v) x.bound += off / (least - off) * largest * (1 + 0x1p-40);
    return true;
}

// Pieces of one degree, one after the other; the joint belongs to the first of two.
template <class T>
std::vector<T> joined(const std::vector<std::vector<T>>& pieces, std::size_t degree) {
    std::vector<T> all;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const auto up = detail::elevated(pieces[i], degree);
        all.insert(all.end(), up.begin() + (i > 0), up.end());
    }
    return all;
}

std::vector<double> inner_breaks(std::span<const Curve<Vec<1>>> functions, const Interval& on) {
    std::vector<double> all = {on.lo, on.hi};
    for (const auto& f : functions) {
        const auto own = f.basis().breaks();
        all.insert(all.end(), own.begin(), own.end());
    }
    sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

}  // namespace

Result<OverOne> over_one_denominator(std::span<const Curve<Hom<3>>> curves,
                                     std::span<const Curve<Vec<1>>> functions) {
    FF_REQUIRE(!curves.empty());
    std::vector<Curve<Hom<3>>> all;
    for (std::size_t k = 0; k < curves.size(); ++k) {
        const BSplineBasis& b = curves[k].basis();
        for (const double t : b.breaks())
            if (b.multiplicity(t) > b.degree() && t != b.domain().lo && t != b.domain().hi)
                return refuse(RefusalKind::unsupported, text("[", k, "]"), text("jumps at ", t));
        auto open = restrict_to(curves[k], 0, b.domain());
        if (!open) return refuse_within(text("[", k, "]"), open.error());
        all.push_back(b.is_closed() ? *std::move(open) : curves[k]);
    }
    auto mark = marker<Hom<3>>(inner_breaks(functions, all[0].domain()[0]));
    if (!mark) return std::unexpected(mark.error());
    all.push_back(*std::move(mark));
    const auto same = compatible(std::span<const Curve<Hom<3>>>(all));
    if (!same) return std::unexpected(same.error());
    const std::vector<double> breaks = same->curves[0].basis().breaks();
    std::vector<Curve<Vec<3>>> marked;
    for (const auto& f : functions) marked.push_back(in_space(f));
    auto other = marker<Vec<3>>(breaks);
    if (!other) return std::unexpected(other.error());
    marked.push_back(*std::move(other));
    const auto same_functions = compatible(std::span<const Curve<Vec<3>>>(marked));
    if (!same_functions) return std::unexpected(same_functions.error());

    // Which denominators there are.
    std::vector<Pieces> pieces;
    std::vector<int> denominator;  // of curve k; -1: none
    std::vector<std::size_t> first;
    for (std::size_t k = 0; k < curves.size(); ++k) {
        const double opened =
            curves[k].basis().is_closed() ? refinement_error(curves[k].basis().degree()) : 0;
        pieces.push_back(pieces_of(same->curves[k], same->relative[k] + opened));
        Pieces& p = pieces.back();
        int found = share(p, nullptr) ? -1 : int(first.size());
        for (std::size_t s = 0; s < first.size() && found == int(first.size()); ++s)
            if (share(p, &pieces[first[s]])) found = int(s);
        if (found == int(first.size())) first.push_back(k);
        denominator.push_back(found);
    }
    const std::size_t p = std::size_t(same->curves[0].basis().degree()),
                      q = std::size_t(same_functions->curves[0].basis().degree()), m = first.size();
    const bool constant = std::find(denominator.begin(), denominator.end(), -1) != denominator.end();
    const std::size_t degree = m * p + std::max(q, constant ? p : 0);
    if (degree > std::size_t(kMaxDegree))
        return refuse(RefusalKind::unsupported, "",
                      text("have ", m, " different denominators of degree ", p,
                           ": the surface would have degree ", degree, ", more than ", kMaxDegree,
                           "; give curves that share their weights, or polynomial ones near them"));
    const auto times_all_but = [&](std::size_t piece, int s, auto polynomial) {
        for (std::size_t r = 0; r < m; ++r)
            if (int(r) != s) polynomial = detail::scaled_by(pieces[first[r]].weight[piece], polynomial);
        return polynomial;
    };
    std::vector<double> t(degree + 1, breaks.front());
    for (std::size_t i = 1; i < breaks.size(); ++i) t.insert(t.end(), degree, breaks[i]);
    t.push_back(breaks.back());
    auto basis = BSplineBasis::make(int(degree), std::move(t));
    if (!basis) return std::unexpected(basis.error());
    OverOne out{*std::move(basis), {}, {}, {}};
    const std::size_t count = breaks.size() - 1;
    for (std::size_t k = 0; k < curves.size(); ++k) {
        std::vector<BernsteinVector> numerators;
        for (std::size_t i = 0; i < count; ++i)
            numerators.push_back(times_all_but(i, denominator[k], pieces[k].numerator[i]));
        out.curves.push_back(joined(numerators, degree));
    }
    for (std::size_t k = 0; k < functions.size(); ++k) {
        const Pieces f = pieces_of(same_functions->curves[k], same_functions->relative[k]);
        std::vector<BernsteinScalar> products;
        for (std::size_t i = 0; i < count; ++i) {
            BernsteinScalar values;
            for (const auto& v : f.numerator[i]) values.push_back(v[0]);
            products.push_back(times_all_but(i, -1, values));
        }
        out.functions.push_back(joined(products, degree));
    }
    std::vector<BernsteinScalar> weights;
    for (std::size_t i = 0; i < count; ++i)
        weights.push_back(times_all_but(i, -1, BernsteinScalar{Bounded(1)}));
    out.denominator = joined(weights, degree);
    return out;
}

}  // namespace freiform

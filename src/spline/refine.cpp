// Knot removal and degree reduction.
//
// Idea: a spline with fewer knots (or of lower degree) is a spline on the old knots, with the coefficients A
// c, where A is the matrix of knot insertion (elevation). So the distance is a difference of coefficients,
// and the best c is a least-squares solution of A c = P.
//
// Notation: P the old coefficients, c the new ones, d_i = P_i - (A c)_i, u = 2^-53, p the higher degree.
//
// Method: Which knots matter least: with m knots at x the pieces left and right agree in all derivatives up
// to order p - m. One of the knots can go if order p - m + 1 agrees, too. The jump there is a linear
// functional l of the coefficients, and |l(P)| / |l|_1 is the smallest change of coefficients, in the maximum
// norm, that makes it vanish. Knots are tried in this order, first all of them at once, then the cheaper half
// and so on; what succeeded is the start of the next round, but is always measured against the given patch.
//
// Least squares: normal equations in skyline form (the corners of a closed basis fill only the last p rows),
// with two steps of iterative refinement, which make up for the squared condition where A c = P has a
// solution.
//
// Accuracy: by partition of unity |f - g| <= max |d_i|. Entries of A carry at most 7 p + 3 roundings and no
// cancellation, sums p + 1, the difference one: each coordinate of d_i is off by at most r = (8 p + 16) u max
// |P, c|. Rational: with numerators and weights (a, w) of d and the old points within R of q,
//     f - g = (a - f w) / W',    |f - g| <= max (|a_i - q w_i| + R |w_i|) / min W'_i,
// where a, w are off by r_a, r_w. The solution c itself may be inexact; the bound is measured, not predicted.
//
// References: [LycheMorken2018], [PT97, ch. 5.4].
//
// Why not the local formula A5.8 of [PT97]: it takes knots one by one, each with an error that is estimated
// at one coefficient, and the errors add up.
//
// Nothing of this depends on the number of parameters or of coordinates: along one axis a net is a number of
// blocks of rows of numbers (Slab), and every step is linear in them, but for the distances of points.
#include "normal_equations_detail.hpp"
#include "refine_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/spline/refine.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace freiform {

namespace detail {

double distance_bound(int degree, const Tuples& old, const Tuples& fresh, const Tuples& image) {
    const int dim = old.dim();
    const double roundings = (8 * degree + 16) * kUnitRoundoff, root = std::sqrt(double(dim)) * 1.01;
    double a_max = 0, w_max = 0, w_min = std::numeric_limits<double>::infinity(), worst = 0;
    Box<4> box;
    for (const Tuples* net : {&old, &fresh})
        for (std::size_t i = 0; i < net->count(); ++i) {
            a_max = std::max(a_max, max_abs(net->numerator(i)));
            w_max = std::max(w_max, net->weight(i));
            if (net == &fresh) w_min = std::min(w_min, net->weight(i));
            if (net == &old) box.add(net->point(i));
        }
    const double r_a = root * roundings * a_max;
    if (!old.rational) {
        for (std::size_t i = 0; i < old.count(); ++i)
            worst = std::max(worst, norm(old.numerator(i) - image.numerator(i)));
        return (worst + r_a) * (1 + 16 * kUnitRoundoff);
    }
    if (!(w_min >= std::numeric_limits<double>::min())) return std::numeric_limits<double>::infinity();
    Vec<4> q;
    for (int i = 0; i < dim; ++i) q[i] = box.side(i).middle();
    // The box is that of computed quotients: each coordinate is off by one rounding.
    const double reach = box.diagonal() / 2 * 1.01 + 4 * kUnitRoundoff * root * box.scale(),
                 r_w = roundings * w_max;
    for (std::size_t i = 0; i < old.count(); ++i) {
        const double w = old.weight(i) - image.weight(i);
        const Vec<4> a = old.numerator(i) - image.numerator(i);
        worst = std::max(worst, norm(a - w * q) + reach * std::abs(w));
    }
    return (worst + r_a + (root * max_abs(q) + reach) * r_w) / w_min * (1 + 32 * kUnitRoundoff);
}

}  // namespace detail

namespace {

// A net along one axis: `blocks` times basis.size() runs of `run` numbers, which make tuples.
struct Slab {
    BSplineBasis basis;
    std::vector<double> all;
    std::size_t run = 1, blocks = 1;
    int size = 1;
    bool rational = false;

    Tuples tuples() const { return {all, size, rational}; }
    std::size_t row(std::size_t block, std::size_t i) const {
        return (block * std::size_t(basis.size()) + i) * run;
    }
    // The same tuples along another basis.
    Slab along(const BSplineBasis& other, std::vector<double> numbers) const {
        return {other, std::move(numbers), run, blocks, size, rational};
    }
    Slab along(const Change<BSplineBasis>& change) const {
        std::vector<double> out(blocks * std::size_t(change.map.rows()) * run);
        change.map.apply(all.data(), out.data(), run, blocks);
        return along(change.basis, std::move(out));
    }
};

struct Thinner {
    Slab slab;
    double bound = 0;
    int removed = 0;
};

// c with A c = target in the least-squares sense, over the basis `coarse`; nothing if the equations are
// singular. `keep_ends`: on open bases that are clamped the first and the last coefficient are kept.
std::optional<Slab> least_squares(const BSplineBasis& coarse, const BandMap& a, bool keep_ends,
                                  const Slab& target) {
    const std::size_t n = std::size_t(a.cols), rows = std::size_t(a.rows()), run = target.run;
    std::vector<char> fixed(n, 0);
    if (keep_ends) fixed.front() = fixed.back() = 1;
    const detail::NormalEquations equations(a, std::move(fixed));
    if (!equations.ok()) return std::nullopt;
    Slab out = target.along(coarse, std::vector<double>(target.blocks * n * run));
    std::vector<double> rest(rows * run), step(n * run);
    for (std::size_t block = 0; block < target.blocks; ++block) {
        const double* goal = &target.all[target.row(block, 0)];
        double* c = &out.all[out.row(block, 0)];
        if (keep_ends) {
            std::copy_n(goal, run, c);
            std::copy_n(goal + (rows - 1) * run, run, c + (n - 1) * run);
        }
        for (int round = 0; round < 3; ++round) {
            a.apply(c, rest.data(), run, 1);
            for (std::size_t k = 0; k < rows * run; ++k) rest[k] = goal[k] - rest[k];
            std::fill(step.begin(), step.end(), 0.0);
            for (std::size_t i = 0; i < rows; ++i)
                for (std::size_t k = 0; k < std::size_t(a.width); ++k) {
                    const std::size_t column = (std::size_t(a.first[i]) + k) % n;
                    const double w = a.entry[i * std::size_t(a.width) + k];
                    for (std::size_t x = 0; x < run; ++x) step[column * run + x] += w * rest[i * run + x];
                }
            for (std::size_t i = 0; i < n; ++i)
                if (equations.fixed(i)) std::fill_n(&step[i * run], run, 0.0);
            equations.solve(step.data(), run);
            for (std::size_t k = 0; k < n * run; ++k) c[k] += step[k];
        }
    }
    return out;
}

// |l(P)| / |l|_1 for the jump l of the derivative of order p - m + 1 at the break x, the largest over all
// fibres.
double removal_cost(const Slab& s, double x, int multiplicity, double reach) {
    const BSplineBasis& b = s.basis;
    const int p = b.degree(), order = p - multiplicity + 1, n = b.size();
    const Interval on = b.domain();
    const int right = b.span(x);
    int left = x == on.lo ? b.span(on.hi) : right;
    while (b.knot(left + 1) > (x == on.lo ? on.hi : x)) --left;
    while (b.knot(left) == b.knot(left + 1)) --left;
    // Knots relative to x, in units of the nearer span: derivatives of high order must not overflow.
    struct Local {
        const BSplineBasis& basis;
        double origin;
        int exponent;
        int degree() const { return basis.degree(); }
        double knot(int i) const { return std::scalbn(basis.knot(i) - origin, -exponent); }
    };
    const int exponent =
        std::ilogb(std::min(b.knot(right + 1) - b.knot(right), b.knot(left + 1) - b.knot(left)));
    std::vector<std::pair<int, double>> l;
    double w[kMaxDegree + 1];
    const auto add = [&](int span, double origin, double sign) {
        weights_in_span(Local{b, origin, exponent}, span, 0.0, order, w);
        for (int k = 0; k <= p; ++k) {
            const int column = (span - p + k) % n;
            const auto found =
                std::find_if(l.begin(), l.end(), [&](const auto& e) { return e.first == column; });
            if (found == l.end())
                l.emplace_back(column, sign * w[k]);
            else
                found->second += sign * w[k];
        }
    };
    add(right, x, 1);
    add(left, x == on.lo ? on.hi : x, -1);
    double size = 0, worst = 0;
    for (const auto& [column, weight] : l) size += std::abs(weight);
    std::vector<double> jump(s.run);
    for (std::size_t block = 0; block < s.blocks; ++block) {
        std::fill(jump.begin(), jump.end(), 0.0);
        for (const auto& [column, weight] : l) {
            const double* from = &s.all[s.row(block, std::size_t(column))];
            for (std::size_t c = 0; c < s.run; ++c) jump[c] += weight / size * from[c];
        }
        const Tuples sums{jump, s.size, s.rational};
        for (std::size_t i = 0; i < sums.count(); ++i) {
            // A change of a weight counts as far as it moves the farthest point.
            const double moved = s.rational ? reach * std::abs(sums.weight(i)) : 0;
            worst = std::max(worst, max_abs(sums.numerator(i)) + moved);
        }
    }
    return std::isfinite(worst) ? worst : std::numeric_limits<double>::infinity();
}

Result<void> check_tolerance(double tolerance) {
    if (!std::isfinite(tolerance))
        return refuse(RefusalKind::nonfinite, "tolerance", text(tolerance, " is not a finite number"));
    if (tolerance < 0) return refuse(RefusalKind::invalid, "tolerance", text(tolerance, " is negative"));
    return {};
}

bool is_clamped(const BSplineBasis& b) {
    return !b.is_closed() && b.knot(0) == b.domain().lo && b.knots().back() == b.domain().hi;
}

// The same closed basis with all knots of the seam at the lower end of the domain: an index shift.
Change<BSplineBasis> seam_in_front(const BSplineBasis& b) {
    std::vector<double> t(b.defining().begin(), b.defining().end());
    const int n = b.size(), moved = int(std::count(t.begin(), t.end(), t.back())) - 1;
    std::fill_n(t.end() - 1 - moved, moved, t.front());
    std::rotate(t.begin(), t.end() - 1 - moved, t.end() - 1);
    BandMap m{n, 1, std::vector<int>(std::size_t(n)), std::vector<double>(std::size_t(n), 1.0)};
    for (int i = 0; i < n; ++i) m.first[std::size_t((i + moved) % n)] = i;
    auto fresh = b.same_kind(b.degree(), std::move(t));
    FF_REQUIRE(fresh.has_value());
    return {std::move(*fresh), std::move(m)};
}

// `basis` without one knot at each of `gone` (ascending).
Result<BSplineBasis> without(const BSplineBasis& basis, const std::vector<double>& gone) {
    std::vector<double> t;
    auto next = gone.begin();
    for (double x : basis.defining())
        if (next != gone.end() && *next == x)
            ++next;
        else
            t.push_back(x);
    return basis.same_kind(basis.degree(), std::move(t));
}

// The knots that `fine` has more than `coarse`.
std::vector<double> knots_between(const BSplineBasis& coarse, const BSplineBasis& fine) {
    std::vector<double> more;
    const auto a = fine.defining(), b = coarse.defining();
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(more));
    return more;
}

std::optional<Thinner> attempt(const Slab& given, const Slab& now, const std::vector<double>& gone) {
    const BSplineBasis& fine = given.basis;
    const auto coarse = without(now.basis, gone);
    if (!coarse) return std::nullopt;
    const auto up = insert_knots(*coarse, knots_between(*coarse, fine));
    if (!up || up->basis != fine) return std::nullopt;
    auto c = least_squares(*coarse, up->map, is_clamped(fine), given);
    if (!c || !detail::check_coefficients(c->tuples())) return std::nullopt;
    const double bound =
        detail::distance_bound(fine.degree(), given.tuples(), c->tuples(), c->along(*up).tuples());
    return Thinner{std::move(*c), bound, fine.size() - coarse->size()};
}

// The knots that can go at all, those that cost least first; each as it is stored.
std::vector<double> ranked_knots(const Slab& s, double reach) {
    const BSplineBasis& b = s.basis;
    const auto breaks = b.breaks();
    std::vector<std::pair<double, double>> ranked;  // cost, knot
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        const bool seam = i == 0 && b.is_closed();
        const int m = b.multiplicity(breaks[i]);
        if (i == 0 && !(seam && m > 1)) continue;
        // A knot of the seam is stored at its lower or at its upper end.
        const double stored = seam && std::count(b.defining().begin(), b.defining().end(), breaks[0]) < 2
                                  ? b.domain().hi
                                  : breaks[i];
        const double cost = removal_cost(s, breaks[i], m, reach);
        if (std::isfinite(cost)) ranked.emplace_back(cost, stored);
    }
    sort(ranked.begin(), ranked.end());
    std::vector<double> knots;
    for (const auto& [cost, knot] : ranked) knots.push_back(knot);
    return knots;
}

Result<Thinner> fewer_knots(Slab given, double tolerance) {
    if (auto ok = check_tolerance(tolerance); !ok) return std::unexpected(ok.error());
    const double reach = detail::reach_of(given.tuples()).coordinate;
    Thinner best{given, 0, 0};
    for (;;) {  // every round but the last removes a knot
        const std::vector<double> ranked = ranked_knots(best.slab, reach);
        bool success = false;
        for (std::size_t count = ranked.size(); count > 0 && !success; count /= 2) {
            std::vector<double> gone(ranked.begin(), ranked.begin() + std::ptrdiff_t(count));
            sort(gone.begin(), gone.end());
            if (auto next = attempt(given, best.slab, gone); next && next->bound <= tolerance) {
                best = std::move(*next);
                success = true;
            }
        }
        if (!success) return best;
    }
}

Result<Thinner> lower_degree(Slab given, double tolerance) {
    if (auto ok = check_tolerance(tolerance); !ok) return std::unexpected(ok.error());
    if (given.basis.is_closed()) given = given.along(seam_in_front(given.basis));
    const BSplineBasis& old = given.basis;
    const int p = old.degree();
    if (p < 1) return refuse(RefusalKind::invalid, "degree", "degree 0 cannot be reduced");
    if (!old.is_closed() && !is_clamped(old))
        return refuse(RefusalKind::unsupported, "knots", "the open basis is not clamped");
    std::vector<double> t;
    const auto from = old.defining();
    for (std::size_t i = 0; i < from.size(); ++i) {
        // The last of several equal knots goes; at the ends of the domain always one, elsewhere one stays.
        const bool last = i + 1 == from.size() || from[i + 1] != from[i];
        const bool single = i == 0 || from[i - 1] != from[i];
        if (!last || single) t.push_back(from[i]);
    }
    const auto coarse = old.same_kind(p - 1, std::move(t));
    if (!coarse) return std::unexpected(coarse.error());
    const auto up = elevate(*coarse);
    if (!up) return std::unexpected(up.error());
    const auto common = insert_knots(old, knots_between(old, up->basis));
    if (!common) return std::unexpected(common.error());
    if (common->basis != up->basis)
        return refuse(RefusalKind::unsupported, "knots", "the knots do not allow a common refinement");
    const Slab goal = given.along(*common);
    auto c = least_squares(*coarse, up->map, !old.is_closed(), goal);
    if (!c) return refuse(RefusalKind::ill_conditioned, "knots", "the least-squares equations are singular");
    // Twice the roundings: the old coefficients were carried to the common basis, too.
    const double bound = detail::distance_bound(2 * p, goal.tuples(), c->tuples(), c->along(*up).tuples());
    if (!detail::check_coefficients(c->tuples()) || !(bound <= tolerance))
        return refuse(RefusalKind::no_answer, "tolerance",
                      text("degree ", p - 1, " comes within ", bound, ", not within ", tolerance));
    return Thinner{std::move(*c), bound, 1};
}

template <std::size_t N, class P>
Slab slab_of(const Patch<N, P>& patch, int axis) {
    const auto all = numbers(patch.net().flat());
    Slab s{patch.basis(axis), {all.begin(), all.end()}, std::size_t(P::kCoords), 1,
           P::kCoords,        Space<P>::kRational};
    for (std::size_t d = 0; d < N; ++d)
        if (d != std::size_t(axis))
            (d < std::size_t(axis) ? s.blocks : s.run) *= std::size_t(patch.net().extent()[d]);
    return s;
}

template <std::size_t N, class P>
Result<Reduced<N, P>> reduced(const Patch<N, P>& patch, int axis, Result<Thinner> found) {
    if (!found) return std::unexpected(std::move(found.error()));
    auto bases = patch.bases();
    bases[std::size_t(axis)] = std::move(found->slab.basis);
    Index<N> extent = patch.net().extent();
    extent[std::size_t(axis)] = bases[std::size_t(axis)].size();
    Net<N, P> net(extent);
    std::ranges::copy(found->slab.all, numbers(net.flat()).begin());
    return Reduced<N, P>{Patch<N, P>::trusted(std::move(bases), std::move(net)), found->bound,
                         found->removed};
}

}  // namespace

template <std::size_t N, class P>
Result<Reduced<N, P>> remove_knots(const Patch<N, P>& patch, int axis, double tolerance) {
    return reduced(patch, axis, fewer_knots(slab_of(patch, axis), tolerance));
}

template <std::size_t N, class P>
Result<Reduced<N, P>> reduce_degree(const Patch<N, P>& patch, int axis, double tolerance) {
    return reduced(patch, axis, lower_degree(slab_of(patch, axis), tolerance));
}

#define FF_REFINE(N, P)                                                           \
    template Result<Reduced<N, P>> remove_knots(const Patch<N, P>&, int, double); \
    template Result<Reduced<N, P>> reduce_degree(const Patch<N, P>&, int, double);
#define FF_REFINE_ALL(D) \
    FF_REFINE(1, Vec<D>) \
    FF_REFINE(1, Hom<D>) \
    FF_REFINE(2, Vec<D>) \
    FF_REFINE(2, Hom<D>) \
    FF_REFINE(3, Vec<D>) \
    FF_REFINE(3, Hom<D>)
FF_REFINE_ALL(1)
FF_REFINE_ALL(2)
FF_REFINE_ALL(3)
FF_REFINE_ALL(4)
#undef FF_REFINE
#undef FF_REFINE_ALL

}  // namespace freiform

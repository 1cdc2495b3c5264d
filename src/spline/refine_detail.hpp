// Knot removal and degree reduction; instantiated in refine.cpp.
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
// Why not the local formula A5.8 of [PT97]: it takes knots
// one by one, each with an error that is estimated at one coefficient, and the errors add up.
#pragma once
#include <freiform/spline/refine.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace freiform::detail {

// Cholesky factor of A^T A, row by row from the first non-zero on. Fixed unknowns keep their value.
class NormalEquations {
public:
    NormalEquations(const BandMap& a, std::vector<char> fixed) : fixed_(std::move(fixed)) {
        const int n = a.cols;
        first_.resize(std::size_t(n));
        std::iota(first_.begin(), first_.end(), 0);
        each_pair(a, [&](std::size_t i, std::size_t j, double) { first_[i] = std::min(first_[i], int(j)); });
        start_.resize(std::size_t(n) + 1);
        for (std::size_t i = 0; i < std::size_t(n); ++i)
            start_[i + 1] = start_[i] + i + 1 - std::size_t(first_[i]);
        l_.assign(start_.back(), 0.0);
        each_pair(a, [&](std::size_t i, std::size_t j, double x) { at(i, j) += x; });
        for (std::size_t i = 0; i < std::size_t(n); ++i)
            if (fixed_[i]) at(i, i) = 1;
        factor();
    }
    bool ok() const { return ok_; }

    // b := (A^T A)^-1 b
    template <class P>
    void solve(std::vector<P>& b) const {
        const std::size_t n = b.size();
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = std::size_t(first_[i]); j < i; ++j) b[i] -= at(i, j) * b[j];
            b[i] *= 1 / at(i, i);
        }
        for (std::size_t i = n; i-- > 0;) {
            b[i] *= 1 / at(i, i);
            for (std::size_t j = std::size_t(first_[i]); j < i; ++j) b[j] -= at(i, j) * b[i];
        }
    }
    bool fixed(std::size_t i) const { return fixed_[i] != 0; }

private:
    double& at(std::size_t i, std::size_t j) { return l_[start_[i] + j - std::size_t(first_[i])]; }
    double at(std::size_t i, std::size_t j) const { return l_[start_[i] + j - std::size_t(first_[i])]; }
    // f(i, j, A_ki A_kj) for j <= i and every row k; a column that a narrow closed basis meets twice counts
    // twice.
    template <class F>
    void each_pair(const BandMap& a, F&& f) const {
        for (int k = 0; k < a.rows(); ++k) {
            const auto row = a.row(k);
            for (int x = 0; x < a.width; ++x)
                for (int y = 0; y < a.width; ++y) {
                    const auto i = std::size_t((a.first[std::size_t(k)] + x) % a.cols);
                    const auto j = std::size_t((a.first[std::size_t(k)] + y) % a.cols);
                    const double product = row[std::size_t(x)] * row[std::size_t(y)];
                    if (j <= i && product != 0 && !fixed_[i] && !fixed_[j]) f(i, j, product);
                }
        }
    }
    void factor() {
        for (std::size_t i = 0; i + 1 < start_.size(); ++i) {
            for (std::size_t j = std::size_t(first_[i]); j <= i; ++j) {
                double sum = at(i, j);
                for (auto k = std::size_t(std::max(first_[i], first_[j])); k < j; ++k)
                    sum -= at(i, k) * at(j, k);
                if (j < i)
                    at(i, j) = sum / at(j, j);
                else if (!(sum > 0))
                    return;
                else
                    at(i, i) = std::sqrt(sum);
            }
        }
        ok_ = true;
    }

    std::vector<char> fixed_;
    std::vector<int> first_;
    std::vector<std::size_t> start_;
    std::vector<double> l_;
    bool ok_ = false;
};

// c with A c = target in the least-squares sense, along `axis`; false if the equations are singular. On open
// bases that are clamped the first and the last coefficient are kept.
template <std::size_t N, class P>
bool least_squares(int axis, const BandMap& a, bool keep_ends, const Net<N, P>& target, Net<N, P>& out) {
    const std::size_t n = std::size_t(a.cols);
    std::vector<char> fixed(n, 0);
    if (keep_ends) fixed.front() = fixed.back() = 1;
    const NormalEquations equations(a, std::move(fixed));
    if (!equations.ok()) return false;
    Index<N> extent = target.extent();
    extent[std::size_t(axis)] = a.cols;
    out = Net<N, P>(extent);
    const auto from = target.view();
    const auto to = out.view();
    std::vector<P> image(std::size_t(a.rows())), step(n);
    each_fibre(axis, extent, [&](const Index<N>& at) {
        const Fibre<const P> goal = from.fibre(axis, at);
        const Fibre<P> c = to.fibre(axis, at);
        if (keep_ends) {
            c[0] = goal[0];
            c[a.cols - 1] = goal[goal.size - 1];
        }
        for (int round = 0; round < 3; ++round) {
            a.apply<P>({c.first, c.size, c.stride}, {image.data(), a.rows(), 1});
            std::fill(step.begin(), step.end(), P{});
            for (int i = 0; i < a.rows(); ++i) {
                const P rest = goal[i] - image[std::size_t(i)];
                for (int k = 0; k < a.width; ++k)
                    step[std::size_t((a.first[std::size_t(i)] + k) % a.cols)] +=
                        a.row(i)[std::size_t(k)] * rest;
            }
            for (std::size_t i = 0; i < n; ++i)
                if (equations.fixed(i)) step[i] = P{};
            equations.solve(step);
            for (int i = 0; i < a.cols; ++i) c[i] += step[std::size_t(i)];
        }
    });
    return true;
}

// A bound of the distance of the spline with coefficients `old` from the one with coefficients A `fresh`,
// `image` being the computed A `fresh`; infinite where the weights allow none. `degree`: the higher one.
template <std::size_t N, class P>
double distance_bound(int degree, const Net<N, P>& old, const Net<N, P>& fresh, const Net<N, P>& image) {
    constexpr int D = Space<P>::kDim;
    constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
    const double roundings = (8 * degree + 16) * kUnit, root = std::sqrt(double(D)) * 1.01;
    double a_max = 0, w_max = 0, w_min = std::numeric_limits<double>::infinity(), worst = 0;
    Box<D> box;
    for (const Net<N, P>* net : {&old, &fresh})
        for (const P& p : net->flat()) {
            for (int i = 0; i < D; ++i) a_max = std::max(a_max, std::abs(p[i]));
            w_max = std::max(w_max, Space<P>::weight(p));
            if (net == &fresh) w_min = std::min(w_min, Space<P>::weight(p));
            if (net == &old) box.add(project(p));
        }
    const double r_a = root * roundings * a_max;
    if constexpr (!Space<P>::kRational) {
        for (std::size_t i = 0; i < old.flat().size(); ++i)
            worst = std::max(worst, norm(old.flat()[i] - image.flat()[i]));
        return (worst + r_a) * (1 + 16 * kUnit);
    } else {
        if (!(w_min >= std::numeric_limits<double>::min())) return std::numeric_limits<double>::infinity();
        Vec<D> q;
        for (int i = 0; i < D; ++i) q[i] = box.side(i).middle();
        // The box is that of computed quotients: each coordinate is off by one rounding.
        const double reach = box.diagonal() / 2 * 1.01 + 4 * kUnit * root * box.scale(),
                     r_w = roundings * w_max;
        for (std::size_t i = 0; i < old.flat().size(); ++i) {
            const P d = old.flat()[i] - image.flat()[i];
            Vec<D> a;
            for (int k = 0; k < D; ++k) a[k] = d[k] - q[k] * d.weight();
            worst = std::max(worst, norm(a) + reach * std::abs(d.weight()));
        }
        return (worst + r_a + (root * max_abs(q) + reach) * r_w) / w_min * (1 + 32 * kUnit);
    }
}

// |l(P)| / |l|_1 for the jump l of the derivative of order p - m + 1 at the break x, the largest over all
// fibres.
template <std::size_t N, class P>
double removal_cost(const Patch<N, P>& s, int axis, double x, int multiplicity, double reach) {
    const BSplineBasis& b = s.basis(axis);
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
    Index<N> extent = s.net().extent();
    const auto view = s.net().view();
    each_fibre(axis, extent, [&](const Index<N>& at) {
        P sum{};
        for (const auto& [column, weight] : l) sum += weight / size * view.fibre(axis, at)[column];
        double cost = 0;  // a change of a weight counts as far as it moves the farthest point
        for (int c = 0; c < Space<P>::kDim; ++c) cost = std::max(cost, std::abs(sum[c]));
        if (Space<P>::kRational) cost += reach * std::abs(Space<P>::weight(sum));
        worst = std::max(worst, cost);
    });
    return std::isfinite(worst) ? worst : std::numeric_limits<double>::infinity();
}

inline Result<void> check_tolerance(double tolerance) {
    if (!std::isfinite(tolerance))
        return refuse(RefusalKind::nonfinite, "tolerance", text(tolerance, " is not a finite number"));
    if (tolerance < 0) return refuse(RefusalKind::invalid, "tolerance", text(tolerance, " is negative"));
    return {};
}

inline bool is_clamped(const BSplineBasis& b) {
    return !b.is_closed() && b.knot(0) == b.domain().lo && b.knots().back() == b.domain().hi;
}

// The same closed basis with all knots of the seam at the lower end of the domain: an index shift.
inline Change<BSplineBasis> seam_in_front(const BSplineBasis& b) {
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
inline Result<BSplineBasis> without(const BSplineBasis& basis, const std::vector<double>& gone) {
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
inline std::vector<double> knots_between(const BSplineBasis& coarse, const BSplineBasis& fine) {
    std::vector<double> more;
    const auto a = fine.defining(), b = coarse.defining();
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(more));
    return more;
}

template <std::size_t N, class P>
std::optional<Reduced<N, P>> attempt(const Patch<N, P>& given, const Patch<N, P>& now, int axis,
                                     const std::vector<double>& gone) {
    const BSplineBasis& fine = given.basis(axis);
    const auto coarse = without(now.basis(axis), gone);
    if (!coarse) return std::nullopt;
    const auto up = insert_knots(*coarse, knots_between(*coarse, fine));
    if (!up || up->basis != fine) return std::nullopt;
    Net<N, P> c;
    if (!least_squares(axis, up->map, is_clamped(fine), given.net(), c)) return std::nullopt;
    auto bases = given.bases();
    bases[std::size_t(axis)] = *coarse;
    const double bound = distance_bound(fine.degree(), given.net(), c, along(axis, up->map, c));
    auto patch = Patch<N, P>::make(std::move(bases), std::move(c));
    if (!patch) return std::nullopt;
    return Reduced<N, P>{std::move(*patch), bound, fine.size() - coarse->size()};
}

}  // namespace freiform::detail

namespace freiform {

template <std::size_t N, class P>
Result<Reduced<N, P>> remove_knots(const Patch<N, P>& given, int axis, double tolerance) {
    if (auto ok = detail::check_tolerance(tolerance); !ok) return std::unexpected(ok.error());
    Reduced<N, P> best{given, 0, 0};
    double reach = 0;
    for (const P& p : given.net().flat()) reach = std::max(reach, max_abs(project(p)));
    for (;;) {  // every round but the last removes a knot
        const BSplineBasis& b = best.patch.basis(axis);
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
            const double cost = detail::removal_cost(best.patch, axis, breaks[i], m, reach);
            if (std::isfinite(cost)) ranked.emplace_back(cost, stored);
        }
        std::sort(ranked.begin(), ranked.end());
        bool success = false;
        for (std::size_t count = ranked.size(); count > 0 && !success; count /= 2) {
            std::vector<double> gone;
            for (std::size_t i = 0; i < count; ++i) gone.push_back(ranked[i].second);
            std::sort(gone.begin(), gone.end());
            if (auto next = detail::attempt(given, best.patch, axis, gone);
                next && next->bound <= tolerance) {
                best = std::move(*next);
                success = true;
            }
        }
        if (!success) return best;
    }
}

template <std::size_t N, class P>
Result<Reduced<N, P>> reduce_degree(const Patch<N, P>& patch, int axis, double tolerance) {
    if (auto ok = detail::check_tolerance(tolerance); !ok) return std::unexpected(ok.error());
    const Patch<N, P> given =
        patch.basis(axis).is_closed() ? rebase(patch, axis, detail::seam_in_front(patch.basis(axis))) : patch;
    const BSplineBasis& old = given.basis(axis);
    const int p = old.degree();
    if (p < 1) return refuse(RefusalKind::invalid, "degree", "degree 0 cannot be reduced");
    if (!old.is_closed() && !detail::is_clamped(old))
        return refuse(RefusalKind::unsupported, "knots", "the open basis is not clamped");
    std::vector<double> t;
    const auto from = old.defining();
    for (std::size_t i = 0; i < from.size(); ++i) {
        // The last of several equal knots goes; at the ends of the domain always one, elsewhere one stays.
        const bool last = i + 1 == from.size() || from[i + 1] != from[i];
        const bool single = i == 0 || from[i - 1] != from[i];
        if (!last || single) t.push_back(from[i]);
    }
    auto coarse = old.same_kind(p - 1, std::move(t));
    if (!coarse) return std::unexpected(coarse.error());
    auto up = elevate(*coarse);
    if (!up) return std::unexpected(up.error());
    auto common = insert_knots(old, detail::knots_between(old, up->basis));
    if (!common) return std::unexpected(common.error());
    if (common->basis != up->basis)
        return refuse(RefusalKind::unsupported, "knots", "the knots do not allow a common refinement");
    const Net<N, P> goal = along(axis, common->map, given.net());
    Net<N, P> c;
    if (!detail::least_squares(axis, up->map, !old.is_closed(), goal, c))
        return refuse(RefusalKind::ill_conditioned, "knots", "the least-squares equations are singular");
    // Twice the roundings: the old coefficients were carried to the common basis, too.
    const double bound = detail::distance_bound(2 * p, goal, c, along(axis, up->map, c));
    auto bases = given.bases();
    bases[std::size_t(axis)] = std::move(*coarse);
    auto out = Patch<N, P>::make(std::move(bases), std::move(c));
    if (!out || !(bound <= tolerance))
        return refuse(RefusalKind::no_answer, "tolerance",
                      text("degree ", p - 1, " comes within ", bound, ", not within ", tolerance));
    return Reduced<N, P>{std::move(*out), bound, 1};
}

}  // namespace freiform

// Positive weights by knot insertion.
//
// Idea: coefficients of a spline converge to the function when knots are inserted, with the square of the
// distance of knots. So the denominator of a rational spline is positive on the whole domain if and only if
// its coefficients are positive after finitely many insertions, and these coefficients are the proof.
//
// Notation: w_i the weights, W the denominator, A the matrix of insertion, u = 2^-53.
//
// Method: the sign of W in a corner decides whether all is negated. Then in rounds: carry the *given* net to
// the knots found so far (rounding does not build up); where a coefficient is not certainly positive, put a
// knot in the middle of the longest spans of its support, along the axis where the weights bend most; ask
// for the value of W where the worst coefficient acts most (its Greville point). A value that is not
// certainly positive is the refusal. With one parameter the pole is then enclosed by bisection.
//
// Cost: rounds are bounded by the binary logarithm of the shortest span that is tried (2^-30 of the domain).
//
// Accuracy: the rows of A have non-negative entries, off by at most 5 p roundings; products and the p + 1
// terms of a sum add p + 2. So a coefficient is off by at most k u (A |P|)_i with k = sum (6 p_d + 2) over
// the axes with new knots, and what underflows; A |P| is computed with the same A (the factor 1.01 covers its
// rounding). A weight counts as positive if it is more than twice that. The distance: with the errors e_a,
// e_w of numerator and weight of a coefficient and g the exact, f the computed function,
//     f - g = (e_A - g e_W) / W^,    |f - g| <= max_i (|e_a| + |g| |e_w|)_i / w_i
// by the convex hull property, and |g| <= max |project(P_i)| + |f - g|.
//
// References: [Farin 2002, ch. 13] for points at infinity, [LycheMorken2018] for the convergence.
//
// Why not degree elevation? It converges with 1/n only. Why not cutting into pieces? It makes p knots of one.
#include <freiform/basis/greville.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/core/tuples.hpp>
#include <freiform/spline/weights.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace freiform {

namespace {

constexpr double kTiny = 0x1p-1074;
constexpr double kShortest = 0x1p-30;  // of the domain: spans that are halved no further
constexpr long long kMostCoefficients = 1'000'000;

// Every net is one of three axes, of extent 1 where there are fewer, and of four coordinates, 0 where there
// are fewer: the search looks at weights alone.
using Tuple = Hom<4>;
using Place = std::array<double, 3>;
constexpr int kWeight = 4;

Tuple absolute(Tuple p) {
    for (int i = 0; i < Tuple::kCoords; ++i) p[i] = std::abs(p[i]);
    return p;
}

// A net together with the net of absolute values, and the number of roundings that their entries carry.
struct Carried {
    std::vector<BSplineBasis> bases;  // one per axis that there is
    Net<3, Tuple> net, size;
    double roundings = 0, terms = 0;

    double error(const Tuple& sizes, int coordinate) const {
        return 1.01 * roundings * kUnitRoundoff * sizes[coordinate] + terms * kTiny;
    }
    void apply(int axis, const BandMap& map, int degree) {
        net = along(axis, map, net);
        size = along(axis, map, size);
        roundings += 6 * degree + 2;
        terms += degree + 2;
    }
};

// What was found, before it is a patch.
struct Found {
    std::vector<BSplineBasis> bases;
    Net<3, Tuple> net;
    double bound = 0;
    int inserted = 0;
    bool negated = false;
};

class Search {
public:
    Search(std::vector<BSplineBasis> bases, const Net<3, Tuple>& net, int dim)
        : given_{std::move(bases), net, net}, now_{given_}, dim_(dim) {
        for (Tuple& p : given_.size.flat()) p = absolute(p);
    }

    Result<Found> run() {
        // Coefficients at an end that is not clamped say what the pieces do outside the domain.
        for (std::size_t d = 0; d < axes(); ++d) {
            const BSplineBasis& b = given_.bases[d];
            if (b.is_closed() || (b.knot(0) == b.domain().lo && b.knots().back() == b.domain().hi)) continue;
            auto change = restrict_to(b, b.domain());
            if (!change) return std::unexpected(change.error());
            given_.apply(int(d), change->map, b.degree());
            given_.bases[d] = std::move(change->basis);
        }
        if (auto ok = orient(); !ok) return std::unexpected(ok.error());
        for (;;) {
            now_ = carried();
            bool done = true;
            if (auto ok = round(done); !ok) return std::unexpected(ok.error());
            if (done) break;
            Index<3> extent = given_.net.extent();
            for (std::size_t d = 0; d < axes(); ++d) extent[d] += int(more_[d].size());
            if (const long long n = count_of(extent); n < 0 || n > kMostCoefficients)
                return refuse(RefusalKind::limit, "weights",
                              text("more than ", kMostCoefficients,
                                   " coefficients would be needed to make all weights positive"));
        }
        return result();
    }

private:
    struct Value {
        double w, error;
    };

    std::size_t axes() const { return given_.bases.size(); }

    // The denominator at u, with a bound of its error.
    Value denominator(const Place& u) const {
        Carried at = given_;
        for (std::size_t d = 0; d < axes(); ++d) {
            const double x = at.bases[d].wrap(u[d]);
            at.apply(int(d), collocation(at.bases[d], std::span(&x, 1)), at.bases[d].degree());
        }
        return {at.net.flat()[0].weight(), at.error(at.size.flat()[0], kWeight)};
    }

    Result<void> orient() {
        Place corner{};
        for (std::size_t d = 0; d < axes(); ++d) corner[d] = given_.bases[d].domain().lo;
        const Value v = denominator(corner);
        if (v.w < -v.error) {
            negated_ = true;
            for (Tuple& p : given_.net.flat()) p = -p;
        } else if (!(v.w > v.error)) {
            return zero_at(v, corner);
        }
        return {};
    }

    std::unexpected<Refusal> zero_at(const Value& v, const Place& where) const {
        if (v.w == 0)
            return refuse(RefusalKind::invalid, "weights",
                          text("the denominator is 0 at ", shown(where), ": a pole"));
        return refuse(RefusalKind::ill_conditioned, "weights",
                      text("the denominator cannot be told from 0 near ", shown(where)));
    }

    Carried carried() const {
        Carried to = given_;
        for (std::size_t d = 0; d < axes(); ++d) {
            if (more_[d].empty()) continue;
            const std::vector<double> knots(more_[d].begin(), more_[d].end());
            auto change = insert_knots(to.bases[d], knots);
            FF_REQUIRE(change.has_value());
            to.apply(int(d), change->map, to.bases[d].degree());
            to.bases[d] = std::move(change->basis);
        }
        return to;
    }

    // Looks at all weights; adds knots where one is not certainly positive.
    Result<void> round(bool& done) {
        const auto net = now_.net.view();
        const auto size = now_.size.view();
        double worst = std::numeric_limits<double>::infinity();
        Index<3> worst_at{};
        bool stuck = false;
        each_index(now_.net.extent(), [&](const Index<3>& at) {
            const double w = net(at).weight();
            if (w > 2 * now_.error(size(at), kWeight) && w >= std::numeric_limits<double>::min()) return;
            done = false;
            const double scale = size(at).weight();
            if (const double x = scale == 0 ? 0 : w / scale; x < worst) worst = x, worst_at = at;
            stuck = !refine(at) || stuck;
        });
        if (done) return {};
        Place where{};
        for (std::size_t d = 0; d < axes(); ++d) where[d] = place_of(now_.bases[d], worst_at[d]);
        const Value v = denominator(where);
        if (v.w > v.error && !stuck) return {};
        if (v.w < -v.error) return pole(where);
        return zero_at(v, where);
    }

    static double place_of(const BSplineBasis& b, int i) {
        const double at = b.wrap(b.degree() == 0 ? b.knot(i) : greville(b, i));
        return std::clamp(at, b.domain().lo, b.domain().hi);
    }

    // Puts knots into the support of the coefficient; false if its spans are too short already.
    bool refine(const Index<3>& at) {
        int best = -1;
        double most = -1;
        for (std::size_t d = 0; d < axes(); ++d) {
            const BSplineBasis& b = now_.bases[d];
            const double length = longest(b, at[d]) / b.domain().length();
            if (b.degree() == 0 || !(length > kShortest)) continue;
            const double score = bend(at, d) + 0x1p-40 * length;
            if (score > most) most = score, best = int(d);
        }
        if (best < 0) return false;
        const BSplineBasis& b = now_.bases[std::size_t(best)];
        const int i = at[std::size_t(best)];
        const double enough = longest(b, i) / 2;
        for (int k = i; k <= i + b.degree(); ++k) {
            const Interval span{b.knot(k), b.knot(k + 1)};
            if (span.length() < enough || !visible(b, span)) continue;
            const double middle = b.wrap(span.middle());
            if (b.domain().contains(middle)) more_[std::size_t(best)].insert(middle);
        }
        return true;
    }
    static bool visible(const BSplineBasis& b, const Interval& span) {
        return span.lo < span.hi && (b.is_closed() || (b.domain().lo <= span.lo && span.hi <= b.domain().hi));
    }
    static double longest(const BSplineBasis& b, int i) {
        double length = 0;
        for (int k = i; k <= i + b.degree(); ++k) {
            const Interval span{b.knot(k), b.knot(k + 1)};
            if (visible(b, span)) length = std::max(length, span.length());
        }
        return length;
    }
    // How far the weight is from the mean of its neighbours along the axis (or the one that there is),
    // relative to the weights there.
    double bend(Index<3> at, std::size_t d) const {
        const auto net = now_.net.view();
        const int n = now_.net.extent()[d], i = at[d];
        const double w = net(at).weight();
        double sum = 0, size = std::abs(w);
        int count = 0;
        for (int step : {-1, 1}) {
            int j = i + step;
            if (now_.bases[d].is_closed()) j = (j + n) % n;
            if (j < 0 || j >= n) continue;
            at[d] = j;
            sum += net(at).weight() - w;
            size = std::max(size, std::abs(net(at).weight()));
            ++count;
        }
        return count == 0 || size == 0 ? 0 : std::abs(sum) / count / size;
    }

    // W is positive in the corner and negative at `where`.
    std::unexpected<Refusal> pole(const Place& where) const {
        if (axes() > 1)
            return refuse(RefusalKind::invalid, "weights",
                          text("the denominator is negative at ", shown(where),
                               " and positive elsewhere: there is a pole"));
        // Between the last certainly positive and the first certainly negative value of two bisections.
        const auto bisected = [&](bool undecided_is_positive) {
            Interval x{given_.bases[0].domain().lo, where[0]};
            for (int k = 0; k < 100 && x.lo < x.middle() && x.middle() < x.hi; ++k) {
                const Value v = denominator({x.middle()});
                const bool positive = v.w > v.error || (undecided_is_positive && v.w >= -v.error);
                (positive ? x.lo : x.hi) = x.middle();
            }
            return x;
        };
        const double plus = bisected(false).lo, minus = bisected(true).hi;
        return refuse(RefusalKind::invalid, "weights",
                      text("the denominator changes its sign between the parameters ", plus, " and ", minus,
                           ": a pole"));
    }
    std::string shown(const Place& u) const {
        std::string s = axes() == 1 ? "the parameter " : "the parameters (";
        for (std::size_t d = 0; d < axes(); ++d) s += text(d == 0 ? "" : ", ", u[d]);
        return axes() == 1 ? s : s + ")";
    }

    Found result() {
        int inserted = 0;
        for (const auto& knots : more_) inserted += int(knots.size());
        double reach = 0, moved = 0, rho = 0;
        for (std::size_t i = 0; i < now_.net.flat().size() && now_.roundings > 0; ++i) {
            const Tuple &p = now_.net.flat()[i], &s = now_.size.flat()[i];
            Vec<4> e;
            for (int c = 0; c < dim_; ++c) e[c] = now_.error(s, c) / p.weight();
            moved = std::max(moved, norm(e));
            rho = std::max(rho, now_.error(s, kWeight) / p.weight());
            reach = std::max(reach, norm(project(p)));
        }
        return {std::move(now_.bases), std::move(now_.net),
                (moved + reach * rho) / (1 - rho) * (1 + 32 * kUnitRoundoff), inserted, negated_};
    }

    Carried given_, now_;
    std::array<std::set<double>, 3> more_;
    int dim_;
    bool negated_ = false;
};

// Refuses numbers that are not finite or too large. Are all weights positive?
Result<bool> check_numbers(const Tuples& all) {
    bool positive = true;
    for (std::size_t i = 0; i < all.count(); ++i) {
        double most = 0;
        for (int c = 0; c < all.size; ++c) {
            if (!std::isfinite(all[i][c]))
                return refuse(RefusalKind::nonfinite, text("points[", i, "]"),
                              "has a coordinate or a weight that is not finite");
            most = std::max(most, std::abs(all[i][c]));
        }
        if (most > 0x1p1022)
            return refuse(RefusalKind::limit, text("points[", i, "]"),
                          "a coordinate, or its product with the weight, is above 2^1022");
        positive = positive && all.weight(i) > 0;
    }
    return positive;
}

Result<Found> search(std::span<const BSplineBasis> bases, const Index<3>& extent, const Tuples& all) {
    std::vector<Tuple> net;
    for (std::size_t i = 0; i < all.count(); ++i) {
        Tuple& t = net.emplace_back();
        for (int c = 0; c < all.dim(); ++c) t[c] = all[i][c];
        t[kWeight] = all.weight(i);
    }
    return Search({bases.begin(), bases.end()}, Net<3, Tuple>(extent, std::move(net)), all.dim()).run();
}

}  // namespace

template <std::size_t N, int D>
Result<PositiveForm<N, D>> positive_weights(const std::array<BSplineBasis, N>& bases,
                                            const Net<N, Hom<D>>& net) {
    const auto positive = check_numbers(tuples(net.flat()));
    if (!positive) return std::unexpected(positive.error());
    bool fits = true;
    for (std::size_t d = 0; d < N; ++d) fits = fits && net.extent()[d] == bases[d].size();
    if (*positive || !fits) {  // `make` says what does not fit
        auto patch = Patch<N, Hom<D>>::make(bases, net);
        if (!patch) return std::unexpected(patch.error());
        return PositiveForm<N, D>{std::move(*patch)};
    }
    Index<3> extent{1, 1, 1};
    std::ranges::copy(net.extent(), extent.begin());
    auto found = search(bases, extent, tuples(net.flat()));
    if (!found) return std::unexpected(found.error());
    const auto made = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<BSplineBasis, N>{std::move(found->bases[I])...};
    }
    (std::make_index_sequence<N>{});
    Index<N> size{};
    for (std::size_t d = 0; d < N; ++d) size[d] = made[d].size();
    std::vector<Hom<D>> coefficients;
    for (const Tuple& t : found->net.flat()) {
        Hom<D>& p = coefficients.emplace_back();
        for (int c = 0; c < D; ++c) p[c] = t[c];
        p[D] = t.weight();
    }
    auto patch = Patch<N, Hom<D>>::make(made, Net<N, Hom<D>>(size, std::move(coefficients)));
    if (!patch) return std::unexpected(patch.error());
    return PositiveForm<N, D>{std::move(*patch), found->bound, found->inserted, found->negated};
}

#define FF_POSITIVE(N, D)                                                                    \
    template Result<PositiveForm<N, D>> positive_weights(const std::array<BSplineBasis, N>&, \
                                                         const Net<N, Hom<D>>&);
#define FF_POSITIVE_ALL(N) FF_POSITIVE(N, 1) FF_POSITIVE(N, 2) FF_POSITIVE(N, 3) FF_POSITIVE(N, 4)
FF_POSITIVE_ALL(1)
FF_POSITIVE_ALL(2)
FF_POSITIVE_ALL(3)
#undef FF_POSITIVE
#undef FF_POSITIVE_ALL

}  // namespace freiform

// Arc length with a bound that is proven.
//
// Idea: on a part of a curve where the square of the speed does not vanish, not even at complex parameters
// near by, the speed is analytic there, and Gauss quadrature converges geometrically with a constant that can
// be computed from the coefficients. Where the speed comes near zero (cusps) the curve is halved: the parts
// that resist become short so quickly that a crude bound does for them.
//
// Notation. On a Bezier piece |c'| = |H| / W^2 with a hodograph H: of a polynomial piece of degree p the
// p (b_{i+1} - b_i), degree m = p - 1, and W = 1; of a rational one m = 2 p - 2 and
//     H_k = sum_{i < j, i + j = k + 1} (j - i) C(p, i) C(p, j) / C(m, k) w_i w_j (b_j - b_i),
// since B_i B_j' - B_i' B_j = (j - i) B_i B_j / (x (1 - x)): no cancellation but that of vectors. z in [-1,
// 1] is the parameter of a part, E the ellipse with foci +-1 and half-axes (rho +- 1/rho) / 2, R the longer
// one. q = H . H (without conjugation, so that it is analytic).
//
// Method. Let q_k and W_k be the Chebyshev coefficients of q and W, found from values at Chebyshev nodes. On
// E |T_k| <= (rho^k + rho^-k) / 2, so there
//     |q - q_0| <= s = sum_{k > 0} |q_k| (rho^k + rho^-k) / 2,    and likewise |W - W_0| <= t.
// If s < q_0 and t < W_0 then neither vanishes, the root g of q has a positive real part, hence
// |g + sqrt(q_0)| >= sqrt(q_0), and f = g / W^2 differs from the constant f_0 = sqrt(q_0) / W_0^2 by at most
//     v = s / (sqrt(q_0) (W_0 - t)^2) + sqrt(q_0) t (2 W_0 + t) / (W_0 (W_0 - t))^2.
// The Chebyshev coefficients of f - f_0 are at most 2 v rho^-k. The rule with N points is exact to degree
// 2 N - 1 and, like the integral, zero for odd functions; for even k >= 2 N it is off by at most
// 2 + 2 / (k^2 - 1) <= 32/15. So the error of the integral over [-1, 1] is at most
//     sum_{even k >= 2 N} 2 v rho^-k 32/15 = (64/15) v rho^(-2 N) / (1 - rho^-2),
// which is [Trefethen 2013, theorem 19.3]. Of a few rho the one is taken that needs the fewest points. If
// even 24 do not suffice the part is halved.
//
// The crude bound: the length is at most the mean of the |H_i| (the length of the control polygon of a
// polynomial piece) and at least the length of their mean (the chord), over the smallest and largest W^2.
// It is used where what it leaves open is small: half of the accuracy is kept for such parts, and each may
// take a sixteenth of what is left of it. At a cusp of a regular kind parts of 2^-k of a piece have lengths
// of about 4^-k of it, so some 20 halvings do for 10 digits.
//
// The inverse. A table holds the sum of lengths up to every part. Inside a part s(t) is the integral over its
// beginning, by the same function, and s(t) = S is solved by Newton's method, s' = |c'|, inside an interval
// that always contains the solution and is halved where Newton leaves it. What is reported is not how the
// iteration ended, but the length up to the parameter that is given back, against the wanted one.
//
// Accuracy. Chain::error for the coefficients; H has p + 10 roundings; halving m each, evaluation 3 m + 4,
// all of convex terms. What a value at a node is off, a Chebyshev coefficient is off by twice that at most,
// and s contains it times rho^k. A node of the quadrature is off by at most 3 u, the value by that times
// |f'|, which is at most v / (R - 1) (Cauchy, on the disc around it). All this is in the bound.
//
// Cost. A smooth cubic to 10 digits: 2 to 4 parts of 12 to 16 points.
//
// Why not Taylor coefficients: simpler, but of degree m they carry 3^m roundings: nothing was provable beyond
// degree 20. Why not the polygon and the chord alone: they converge as h^2, 10^5 parts for 10 digits; their
// combination that converges as h^4 [Gravesen 1997] is an estimate. Why not adaptive quadrature that compares
// two rules: an estimate, too, and wrong at cusps.
#include "query/speed_detail.hpp"

#include <freiform/core/constants.hpp>

#include <numeric>

namespace freiform {

using detail::SpeedBlock;

template <class P>
struct ArcLength<P>::Table {
    static constexpr int D = Space<P>::kDim;
    struct Part {
        SpeedBlock<D> speed;
        int piece = 0;
        double x0 = 0;
        Measure own, before;  // the length of the part; of all before it
    };

    explicit Table(const Curve<P>& curve) : chain(curve) {}
    double units(double x) const { return std::scalbn(x, chain.exponent()); }

    detail::Chain<P> chain;
    std::vector<Part> parts;
    Measure total;
    double accuracy = 0, scale = 0;  // divided units; scale: an upper bound of the length
};

namespace {

// How the accuracy is shared out.
struct Budget {
    double share = 0;  // error per length that may be made anywhere
    double pool = 0;   // for parts that only a crude bound exists of
    double floor = 0;  // below this an error does not matter
};

constexpr int kMostHalvings = 200;

// Calls part(block, x0, measure) for parts of the block from left to right.
template <int D, class F>
void measure(const SpeedBlock<D>& whole, double x0, Budget& budget, F&& part) {
    std::vector<SpeedBlock<D>> open{whole};
    for (double x = x0; !open.empty();) {
        SpeedBlock<D>& b = open.back();
        const Measure crude = crude_length(b);
        const double wanted = std::max(budget.share * (crude.value + crude.bound), budget.floor);
        // Halving does not help against rounding.
        const double light = b.weights().lo, noise = 4 * b.h_slip * b.width / (light * light);
        bool accept = crude.bound <= std::max(wanted, noise) || int(open.size()) > kMostHalvings;
        if (!accept && crude.bound <= budget.pool / 16) {
            budget.pool -= crude.bound;
            accept = true;
        }
        Measure m = crude;
        if (!accept) {
            m = gauss_length(b, wanted);
            accept = std::isfinite(m.bound);
            if (accept && crude.bound < m.bound) m = crude;
        }
        if (accept) {
            part(b, x, m);
            x += b.width;
            open.pop_back();
            continue;
        }
        SpeedBlock<D> right = b.split(), left = b;
        b = std::move(right);
        open.push_back(std::move(left));
    }
}

Budget budget_of(double accuracy, double scale) {
    return {std::max(accuracy / 2 / scale, 0.25 * kUnitRoundoff), accuracy / 2, 0x1p-60 * scale};
}

template <int D>
Measure measured(const SpeedBlock<D>& block, Budget budget) {
    Measure sum;
    int count = 0;
    measure(block, 0, budget, [&](const SpeedBlock<D>&, double, const Measure& m) {
        sum.value += m.value;
        sum.bound += m.bound;
        ++count;
    });
    sum.bound += (count - 1) * kUnitRoundoff * sum.value;
    return sum;
}

}  // namespace

template <class P>
ArcLength<P>::ArcLength(const Curve<P>& curve, double accuracy) {
    FF_REQUIRE(accuracy >= 0);
    auto t = std::make_shared<Table>(curve);
    std::vector<SpeedBlock<Table::D>> blocks;
    for (int i = 0; i < t->chain.pieces(); ++i) {
        blocks.push_back(speed_of(t->chain, i));
        const Measure crude = crude_length(blocks.back());
        t->scale += crude.value + crude.bound;
    }
    t->accuracy = std::scalbn(accuracy, -t->chain.exponent());
    Budget budget = budget_of(t->accuracy, t->scale);
    for (int i = 0; i < t->chain.pieces() && t->scale > 0; ++i)
        measure(blocks[std::size_t(i)], 0, budget, [&](const auto& b, double x0, const Measure& m) {
            t->parts.push_back({b, i, x0, m, t->total});
            t->total.value += m.value;
            t->total.bound += m.bound + kUnitRoundoff * t->total.value;
        });
    table_ = std::move(t);
}

template <class P>
Measure ArcLength<P>::total() const {
    return {table_->units(table_->total.value),
            table_->units(table_->total.bound) + std::numeric_limits<double>::denorm_min()};
}

template <class P>
Interval ArcLength<P>::domain() const {
    return {table_->chain.at(0), table_->chain.at(table_->chain.pieces())};
}

namespace {

// The length up to the fraction y of part k, in divided units.
template <class Table>
Measure up_to(const Table& table, std::size_t k, double y) {
    const auto& part = table.parts[k];
    Measure m = part.before;
    if (y >= 1) {
        m.value += part.own.value, m.bound += part.own.bound;
    } else if (y > 0) {
        const Measure inside = measured(part.speed.left(y), budget_of(table.accuracy, table.scale));
        m.value += inside.value, m.bound += inside.bound;
    }
    m.bound += kUnitRoundoff * m.value;
    return m;
}

// The length up to parameter t. The local parameter of t has 3 roundings, its place in a part 2 more.
template <class Table>
Measure length_to(const Table& table, double t) {
    const int i = table.chain.starting(t);
    const double x = table.chain.local(i, t);
    const auto& parts = table.parts;
    if (parts.empty()) return {};
    std::size_t lo = 0, hi = parts.size();  // the last part that begins at or before (i, x)
    while (hi - lo > 1) {
        const std::size_t middle = (lo + hi) / 2;
        (parts[middle].piece < i || (parts[middle].piece == i && parts[middle].x0 <= x) ? lo : hi) = middle;
    }
    const auto& part = parts[lo];
    const double y = std::clamp((x - part.x0) / part.speed.width, 0.0, 1.0);
    Measure m = up_to(table, lo, y);
    const Interval w = part.speed.weights();
    m.bound += 6 * kUnitRoundoff * x * (part.speed.largest() + part.speed.h_slip) / (w.lo * w.lo);
    return m;
}

}  // namespace

template <class P>
Result<Measure> ArcLength<P>::at(double t) const {
    const Interval on = domain();
    if (!std::isfinite(t)) return refuse(RefusalKind::nonfinite, "at", text(t, " is not a finite number"));
    if (!on.contains(t))
        return refuse(RefusalKind::out_of_domain, "at",
                      text(t, " is outside the domain [", on.lo, ", ", on.hi, "]"));
    if (t == on.hi) return total();
    const Measure m = length_to(*table_, t);
    return Measure{table_->units(m.value),
                   table_->units(m.bound) + std::numeric_limits<double>::denorm_min()};
}

template <class P>
Result<PlaceAtLength> ArcLength<P>::parameter(double length) const {
    const Table& table = *table_;
    if (!std::isfinite(length))
        return refuse(RefusalKind::nonfinite, "length", text(length, " is not a finite number"));
    const Measure all = total();
    if (length < 0 || length > all.value + all.bound)
        return refuse(RefusalKind::out_of_domain, "length",
                      text(length, " is outside [0, ", all.value, "], the length of the curve"));
    const double wanted = std::scalbn(length, -table.chain.exponent());
    const auto answer = [&](double t, const Measure& m) {
        return PlaceAtLength{t, table.units(std::abs(m.value - wanted) + m.bound + kUnitRoundoff * wanted) +
                                    std::numeric_limits<double>::denorm_min()};
    };
    if (length == 0 || table.parts.empty()) return answer(domain().lo, {});
    if (wanted >= table.total.value) return answer(domain().hi, table.total);
    const auto after =
        std::ranges::upper_bound(table.parts, wanted, {}, [](const auto& part) { return part.before.value; });
    const std::size_t k = std::size_t(after - table.parts.begin()) - 1;
    const auto& part = table.parts[k];
    // s(y) - wanted changes its sign between lo and hi.
    double lo = 0, hi = 1, y = part.own.value > 0 ? (wanted - part.before.value) / part.own.value : 0;
    for (int step = 0; step < 100; ++step) {
        y = std::clamp(y, lo, hi);
        const Measure m = up_to(table, k, y);
        const double off = m.value - wanted;
        if (std::abs(off) <= std::max(0.125 * m.bound, 2 * kUnitRoundoff * wanted)) break;
        (off < 0 ? lo : hi) = y;
        const double slope = part.speed.speed(y) * part.speed.width;
        double next = slope > 0 ? y - off / slope : -1;
        if (!(next > lo && next < hi)) next = lo + (hi - lo) / 2;
        if (next == y || !(lo < hi)) break;
        y = next;
    }
    const double x = part.x0 + y * part.speed.width;
    const double t = std::clamp(table.chain.global(part.piece, x), domain().lo, domain().hi);
    return answer(t, length_to(table, t));
}

template <class P>
Result<Measure> ArcLength<P>::total(Interval on) const {
    if (on.lo > on.hi)
        return refuse(RefusalKind::invalid, "on",
                      text("the interval begins at ", on.lo, ", after its end ", on.hi));
    if (on == domain()) return total();
    const auto a = at(on.lo), b = at(on.hi);
    for (const auto* end : {&a, &b})
        if (!*end) return refuse(end->error().kind, "on", end->error().message);
    const double value = std::max(0.0, b->value - a->value);
    return Measure{value, a->bound + b->bound + kUnitRoundoff * value};
}

// The parameter is found by its length from the beginning of the curve, where the part begins at a->value:
// that is off by a->bound, and the sum is rounded. Clamping to the part brings the length nearer to the
// wanted one, since lengths grow with the parameter.
template <class P>
Result<PlaceAtLength> ArcLength<P>::parameter(double length, Interval on) const {
    if (on == domain()) return parameter(length);
    const auto all = total(on);
    if (!all) return std::unexpected(all.error());
    if (!std::isfinite(length))
        return refuse(RefusalKind::nonfinite, "length", text(length, " is not a finite number"));
    if (length < 0 || length > all->value + all->bound)
        return refuse(RefusalKind::out_of_domain, "length",
                      text(length, " is outside [0, ", all->value, "], the length of the part"));
    if (length == 0) return PlaceAtLength{on.lo, 0};
    if (length >= all->value)
        return PlaceAtLength{on.hi, (length - all->value) * (1 + 2 * kUnitRoundoff) + all->bound};
    const Measure before = *at(on.lo);
    const double wanted = std::min(before.value + length, total().value);
    auto place = parameter(wanted);
    if (!place) return place;
    place->parameter = clamped(place->parameter, on);
    place->bound = (place->bound + before.bound + kUnitRoundoff * wanted) * (1 + 4 * kUnitRoundoff);
    return place;
}

namespace {

constexpr int kMostPlaces = 100'000'000;

// The places at all lengths(0), .., lengths(last).
template <class P, class Lengths>
Result<std::vector<PlaceAtLength>> places(const ArcLength<P>& s, Interval on, int last, Lengths&& lengths) {
    std::vector<PlaceAtLength> out;
    for (int i = 0; i <= last; ++i) {
        const auto place = s.parameter(lengths(i), on);
        if (!place) return std::unexpected(place.error());
        out.push_back(*place);
    }
    return out;
}

}  // namespace

template <class P>
Result<std::vector<PlaceAtLength>> ArcLength<P>::equal_parts(int n, Interval on) const {
    if (n < 1) return refuse(RefusalKind::invalid, "parts", text("must be positive, found ", n));
    if (n > kMostPlaces) return refuse(RefusalKind::limit, "parts", text(n, " are more than ", kMostPlaces));
    const auto all = total(on);
    if (!all) return std::unexpected(all.error());
    auto out =
        places(*this, on, n, [&](int i) { return i == n ? all->value : all->value * (double(i) / n); });
    // Parts are of the whole length as it is, not as it was found.
    for (int i = 1; out && i < n; ++i) {
        double& bound = (*out)[std::size_t(i)].bound;
        bound = (bound + all->bound * (double(i) / n)) * (1 + 8 * kUnitRoundoff);
    }
    return out;
}
template <class P>
Result<std::vector<PlaceAtLength>> ArcLength<P>::equal_parts(int n) const {
    return equal_parts(n, domain());
}

template <class P>
Result<std::vector<PlaceAtLength>> ArcLength<P>::spaced(double d, Interval on) const {
    if (!(d > 0 && std::isfinite(d)))
        return refuse(RefusalKind::invalid, "distance", text("must be positive and finite, found ", d));
    const auto all = total(on);
    if (!all) return std::unexpected(all.error());
    const double n = std::floor(all->value / d);
    if (n >= kMostPlaces)
        return refuse(RefusalKind::limit, "distance",
                      text(n, " places are needed, ", kMostPlaces, " may be asked for"));
    return places(*this, on, int(n), [&](int i) { return std::min(i * d, all->value); });
}
template <class P>
Result<std::vector<PlaceAtLength>> ArcLength<P>::spaced(double d) const {
    return spaced(d, domain());
}

template <class P>
Measure length(const Curve<P>& curve, double accuracy) {
    return ArcLength<P>(curve, accuracy).total();
}

template <class P>
Result<Measure> length(const Curve<P>& curve, Interval on, double accuracy) {
    return ArcLength<P>(curve, accuracy / 2).total(on);
}

#define FF_INSTANTIATE(P)                             \
    template class ArcLength<P>;                      \
    template Measure length(const Curve<P>&, double); \
    template Result<Measure> length(const Curve<P>&, Interval, double);
FF_INSTANTIATE(Vec<1>)
FF_INSTANTIATE(Vec<2>)
FF_INSTANTIATE(Vec<3>)
FF_INSTANTIATE(Vec<4>)
FF_INSTANTIATE(Hom<1>)
FF_INSTANTIATE(Hom<2>)
FF_INSTANTIATE(Hom<3>)
FF_INSTANTIATE(Hom<4>)
#undef FF_INSTANTIATE

}  // namespace freiform

// A curve at unit speed.
//
// Idea: on a part of a piece the inverse t(s) of the arc length is approximated by a quintic tau(s), and
// c(tau(s)) by a quintic r(s). c(tau(s)) is a point of the curve itself, so it is as far from c(t(s)) as the
// arc between them is long at most: one scalar function, the length sigma(tau(s)) - s, bounds that error, and
// its derivative is the deviation of the speed from 1. Both approximations are compared by polynomial
// arithmetic.
//
// Notation: a part of a piece on [x0, x1], with lengths s0 and s1 = s0 + d at its ends; v = (s - s0) / d in
// [0, 1]; T unit tangents, K curvature vectors (c'' across T, over |c'|^2) at the ends; H and W as in
// length.cpp, of the part, h = x1 - x0.
//
// Method. tau interpolates x0 and x1 with the first two derivatives of t, 1 / |c'| and -c' . c'' / |c'|^4.
// If its Bernstein coefficients over [x0, x1] are inside all compositions are convex combinations. The square
// of the speed of c(tau(s)), less 1, is E / (d^2 W^4) with
//     E = |H(tau)|^2 (h tau')^2 - d^2 W(tau)^4,
// a polynomial of v, bounded by its Bernstein coefficients: e = max |E| / (d^2 min W^4). So the speed is
// within e of 1 (e <= 1), and the length is off by at most what it is off at the nearer end plus e d / 2. r
// interpolates point, T and K at both ends. r - c(tau) = (W(tau) r - N(tau)) / W(tau) is bounded in the same
// way. A part that is not within the tolerance is halved in its parameter.
//
// At a cusp T has no meaning and the speed no lower bound. Parts shorter than the tolerance are replaced by
// their chords: both chord and curve are within min(s - s0, s1 - s) of an end.
//
// Accuracy. Products of Bernstein forms are convex sums. A product of degrees m and n has at most 3 (m + n) +
// 8 roundings (large binomial coefficients are rounded), composition with degree p at most 7.5 p^2 + 23 p. E
// has at most 60 (deg + 10) + 16 m^2 + 32 p^2 (the last of W) relative to the larger of its two terms, r -
// c(tau) at most 8 p^2 + 60 p + 120 relative to the size of the part. Lengths at the ends are off by the
// bounds of ArcLength and by 6 roundings of a parameter; coefficients by Chain::error.
//
// Cost. The errors are of sixth order in h: 10^6 times the accuracy costs ten times the pieces. Why not a
// cubic tau: of fourth order (230 pieces instead of 44 for a cubic within 1e-9). Why not the composition
// itself, which is exact in space: of degree 5 p.
// References: [Farin 2002, ch. 23] for the problem; the bound is ours.
#include "query/speed_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/query/reparametrise.hpp>
#include <freiform/spline/wide.hpp>

#include <optional>

namespace freiform {

namespace {

// C(n, k) for all k.
std::vector<double> binomial_row(int n) {
    std::vector<double> row{1};
    for (int k = 0; k < n; ++k) row.push_back(row.back() * (n - k) / (k + 1));
    return row;
}

template <class B>
std::vector<B> product(const std::vector<double>& f, const std::vector<B>& g) {
    const int m = int(f.size()) - 1, n = int(g.size()) - 1;
    const auto of_f = binomial_row(m), of_g = binomial_row(n), all = binomial_row(m + n);
    std::vector<B> out(std::size_t(m + n) + 1);
    for (int k = 0; k <= m + n; ++k)
        for (int i = std::max(0, k - n); i <= std::min(k, m); ++i) {
            const std::size_t at = std::size_t(i), other = std::size_t(k - i);
            out[std::size_t(k)] += (of_f[at] / all[std::size_t(k)] * of_g[other]) * (f[at] * g[other]);
        }
    return out;
}
// Of all dimensions: their code is there once, whatever curves there are.
using Wide = Vec<4>;
template <int D>
Wide wide(const Vec<D>& x) {
    Wide out{};
    for (int c = 0; c < D; ++c) out[c] = x[c];
    return out;
}

std::vector<double> square(const std::vector<Wide>& f) {
    std::vector<double> sum;
    for (int c = 0; c < 4; ++c) {
        std::vector<double> one;
        for (const Wide& v : f) one.push_back(v[c]);
        const auto q = product(one, one);
        if (c == 0) sum.assign(q.size(), 0);
        for (std::size_t i = 0; i < q.size(); ++i) sum[i] += q[i];
    }
    return sum;
}

// b(tau(v)) by de Casteljau's scheme with polynomials in place of numbers.
template <class V>
std::vector<V> composed_with(std::vector<V> b, const std::vector<double>& tau) {
    std::vector<double> rest;
    for (const double x : tau) rest.push_back(1 - x);
    std::vector<std::vector<V>> level;
    for (const V& x : b) level.push_back({x});
    for (; level.size() > 1; level.pop_back())
        for (std::size_t i = 0; i + 1 < level.size(); ++i) {
            auto low = product(rest, level[i]);
            const auto high = product(tau, level[i + 1]);
            for (std::size_t k = 0; k < low.size(); ++k) low[k] += high[k];
            level[i] = std::move(low);
        }
    return level[0];
}

std::vector<double> ones(int degree) { return std::vector<double>(std::size_t(degree) + 1, 1.0); }

double square_of(double x) { return x * x; }

// A part of a piece of length d, and what a quintic is compared with: Bernstein coefficients. Both weights
// are empty where the piece is a polynomial.
struct ComparedPart {
    double d = 0, width = 0;                     // width: in the parameter
    double from = 0, to = 0;                     // |dc / dv| at the ends if tau were linear
    std::array<double, 2> bend{};                // c' . c'' / |c'|^2 there
    std::vector<Wide> hodograph = {};            // of H
    std::vector<double> speed_weight = {};       // of W
    double largest = 0, h_slip = 0, w_slip = 0;  // of H
    Interval w{};                                // of W
    std::vector<Wide> numerator = {}, r = {};    // both about the start
    std::vector<double> weight = {};             // of the numerator
    double off = 0, slip = 0;                    // of the lengths at the ends, and of points
};
struct Compared {
    double bound = 0, speed = 0;
};

// Nothing where tau is not monotone, or the speed too far from 1.
std::optional<Compared> compared(const ComparedPart& in) {
    const double d = in.d;
    const int p = int(in.numerator.size()) - 1, m = int(in.hodograph.size()) - 1,
              q = int(in.speed_weight.size()) - 1;
    // tau' = d / |c'| and tau'' = -d^2 c' . c'' / |c'|^4.
    const double a = d / in.from / 5, e = d / in.to / 5;
    const double bend_a = -in.bend[0] * square_of(d / in.from) / 20,
                 bend_e = -in.bend[1] * square_of(d / in.to) / 20;
    const std::vector<double> tau{0, a, 2 * a + bend_a, 1 - (2 * e - bend_e), 1 - e, 1};
    std::vector<double> slope;
    for (std::size_t k = 0; k < 5; ++k) {
        if (!(0 <= tau[k] && tau[k] <= 1)) return std::nullopt;
        slope.push_back(5 * (tau[k + 1] - tau[k]));
    }

    // The speed of c(tau).
    std::vector<Wide> hodograph = in.hodograph;
    for (Wide& x : hodograph) x *= in.width / d;
    auto fast = square(product(slope, composed_with(std::move(hodograph), tau)));
    std::vector<double> unit_speed{1};
    if (q > 0) {
        auto weight = composed_with(in.speed_weight, tau);
        weight = product(weight, weight);
        unit_speed = product(weight, weight);
    }
    const int degree = int(std::max(fast.size(), unit_speed.size())) - 1;
    fast = product(fast, ones(degree + 1 - int(fast.size())));
    unit_speed = product(unit_speed, ones(degree + 1 - int(unit_speed.size())));
    double most = 0, size = 0;
    for (std::size_t k = 0; k < fast.size(); ++k) {
        most = std::max(most, std::abs(fast[k] - unit_speed[k]));
        size = std::max({size, std::abs(fast[k]), unit_speed[k]});
    }
    double steepest = 0;
    for (const double x : slope) steepest = std::max(steepest, std::abs(x) * in.width / d);
    const double scale = std::max(size, square_of(steepest * in.largest));
    const double roundings = 60.0 * (degree + 10) + 16.0 * m * m + 32.0 * std::max(0, q) * q;
    most += roundings * kUnitRoundoff * scale +
            2 * steepest * in.h_slip * steepest * (in.largest + in.h_slip) +
            8 * in.w_slip * square_of(square_of(in.w.hi));
    const double deviation = most / square_of(square_of(in.w.lo)) * (1 + 64 * kUnitRoundoff);
    if (!(deviation <= 0.5)) return std::nullopt;

    // r and its distance from c(tau).
    double far = d;
    for (const Wide& x : in.numerator) far = std::max(far, norm(x));
    for (const Wide& x : in.r) far = std::max(far, norm(x));
    double lightest = kInfinity, heaviest = 0;
    std::vector<Wide> numerator;
    for (std::size_t k = 0; k < in.numerator.size(); ++k) {
        const double w = in.weight.empty() ? 1 : in.weight[k];
        numerator.push_back(w * in.numerator[k]);
        lightest = std::min(lightest, w), heaviest = std::max(heaviest, w);
    }
    numerator = product(ones(5), composed_with(std::move(numerator), tau));
    const auto along = composed_with(in.weight.empty() ? ones(p) : in.weight, tau);
    const auto other = product(along, in.r);
    double gap = 0, gap_slope = 0;
    const int n = int(numerator.size()) - 1;
    for (int k = 0; k <= n; ++k) {
        numerator[std::size_t(k)] -= other[std::size_t(k)];
        gap = std::max(gap, norm(numerator[std::size_t(k)]));
    }
    const double noise = (8.0 * p * p + 60 * p + 120) * kUnitRoundoff * far * heaviest;
    for (int k = 0; k < n; ++k)
        gap_slope = std::max(gap_slope, norm(numerator[std::size_t(k) + 1] - numerator[std::size_t(k)]));
    double weight_slope = 0;
    for (std::size_t k = 0; k + 1 < along.size(); ++k)
        weight_slope = std::max(weight_slope, std::abs(along[k + 1] - along[k]));
    gap = (gap + noise) / lightest;
    gap_slope = (n * (gap_slope + 2 * noise) +
                 5 * p * (weight_slope + (16.0 * p * p + 60) * kUnitRoundoff * heaviest) * gap) /
                lightest / d;
    return Compared{(in.off + deviation * d / 2 + gap + in.slip) * (1 + 64 * kUnitRoundoff),
                    deviation + gap_slope + 2 * p * in.slip / d};
}

template <class P>
class Reparametrisation {
public:
    static constexpr int D = Space<P>::kDim;
    using Point = Vec<D>;
    struct Piece {
        std::array<Point, 6> r{};
        double bound = 0, speed = 0;
        bool good = false;
    };

    // At an end of a block, in the direction of growing parameters.
    struct Frame {
        Point tangent{}, curvature{};  // unit; c'' across the tangent over |c'|^2
        double bend = 0;               // c' . c'' / |c'|^2
    };

    Reparametrisation(const detail::Chain<P>& chain, double tolerance)
        : chain_(chain), tolerance_(tolerance) {}

    void begin(int piece) {
        piece_ = piece;
        speed_ = speed_of(chain_, piece);
        const Interval w = speed_.weights();
        slip_ = 8 * kUnitRoundoff * (speed_.largest() + speed_.h_slip) / (w.lo * w.lo);
    }
    // The part on [x0, x1] from `start`, of length d; the lengths at its ends are off by at most `off`.
    Piece piece(double x0, double x1, const Point& start, double d, double off) const {
        P b[kMaxDegree + 1];
        chain_.copy_left(piece_, x1, b);
        const Point end = project(b[chain_.degree()]);
        chain_.cut_left(x0, x1, b);
        off += slip_;
        const double slip = chain_.error(6 * chain_.degree());
        Piece out = chord(start, end, d, off, slip);
        if (out.bound <= tolerance_) return out;
        if (auto curved = quintic(std::span<const P>(b, std::size_t(chain_.degree()) + 1),
                                  speed_.part(x0, x1), start, end, d, off, slip))
            return *curved;
        return out;
    }

private:
    Piece chord(const Point& start, const Point& end, double d, double off, double slip) const {
        Piece out;
        for (int i = 0; i <= 5; ++i) out.r[std::size_t(i)] = (1 - i / 5.0) * start + (i / 5.0) * end;
        out.r[5] = end;
        out.bound = (d + 4 * (off + slip)) * (1 + 8 * kUnitRoundoff);
        out.speed =
            std::max(1.0, (norm(end - start) + 10 * slip) / d);  // 5 between points, which are rounded
        out.good = out.bound <= tolerance_;
        return out;
    }

    std::optional<Piece> quintic(std::span<const P> b, const detail::SpeedBlock<D>& h, const Point& start,
                                 const Point& end, double d, double off, double slip) const {
        const Frame first = frame(b, false), last = frame(b, true);
        Piece out;
        out.r = {start,
                 start + (d / 5) * first.tangent,
                 start + (2 * d / 5) * first.tangent + (d * d / 20) * first.curvature,
                 end - (2 * d / 5) * last.tangent + (d * d / 20) * last.curvature,
                 end - (d / 5) * last.tangent,
                 end};
        ComparedPart part{.d = d,
                          .width = h.width,
                          .from = h.speed(0) * h.width,
                          .to = h.speed(1) * h.width,
                          .bend = {first.bend, last.bend},
                          .largest = h.largest(),
                          .h_slip = h.h_slip,
                          .w_slip = h.w_slip,
                          .w = h.weights(),
                          .off = off,
                          .slip = slip};
        for (int i = 0; i <= h.m; ++i) part.hodograph.push_back(wide(h.h[std::size_t(i)]));
        for (int i = 0; i <= h.p && h.p > 0; ++i) part.speed_weight.push_back(h.w[std::size_t(i)][0]);
        for (const P& x : b) {
            part.numerator.push_back(wide(project(x) - start));
            if (!chain_.polynomial()) part.weight.push_back(Space<P>::weight(x));
        }
        for (const Point& x : out.r) part.r.push_back(wide(x - start));
        const auto found = compared(part);
        if (!found) return std::nullopt;
        out.bound = found->bound;
        out.speed = found->speed;
        out.good = out.bound <= tolerance_;
        return out;
    }

    static Frame frame(std::span<const P> b, bool at_end) {
        const int p = int(b.size()) - 1;
        std::array<P, 3> h{};  // value and derivatives of numerator and weight there
        const auto c = [&](int i) { return b[std::size_t(at_end ? p - i : i)]; };
        const double sign = at_end ? -1 : 1;
        h[0] = c(0);
        if (p >= 1) h[1] = sign * p * (c(1) - c(0));
        if (p >= 2) h[2] = double(p) * (p - 1) * ((c(2) - c(1)) - (c(1) - c(0)));
        std::array<Point, 3> d{};
        project_jet<1, P>(2, std::span<const P>(h), d);
        const double speed = norm(d[1]);
        const Point t = unit(d[1]);
        if (!(speed > 0)) return {};
        return {t, (1 / speed / speed) * (d[2] - dot(d[2], t) * t), dot(d[2], t) / speed};
    }

    const detail::Chain<P>& chain_;
    double tolerance_, slip_ = 0;
    int piece_ = 0;
    detail::SpeedBlock<D> speed_;
};

constexpr int kDeepestStep = 60;

}  // namespace

template <class P>
static Result<ArcLengthCurve<Space<P>::kDim>> at_unit_speed(const Curve<P>& curve, double tolerance,
                                                            int max_pieces) {
    constexpr int D = Space<P>::kDim;
    if (!(tolerance > 0 && std::isfinite(tolerance)))
        return refuse(RefusalKind::invalid, "tolerance",
                      text("must be a positive finite distance, found ", tolerance));
    const detail::Chain<P> chain(curve);
    for (int i = 1; i < chain.pieces(); ++i)
        if (chain.jumps_at(i))
            return refuse(RefusalKind::no_answer, "curve", text("jumps at parameter ", chain.at(i)));
    const ArcLength<P> length(curve, tolerance / 16);
    const Measure total = length.total();
    if (!(total.value > total.bound)) return refuse(RefusalKind::no_answer, "curve", "has no length");
    const int e = chain.exponent();
    Reparametrisation<P> pieces(chain, std::scalbn(tolerance, -e));
    const auto at = [&](int i, double x) {
        Measure m = *length.at(chain.global(i, x));
        return Measure{std::scalbn(m.value, -e), std::scalbn(m.bound, -e)};
    };
    std::vector<Vec<D>> points{project(chain.piece(0)[0])};
    std::vector<double> breaks{0};
    double bound = 0, speed = 0;
    for (int i = 0; i < chain.pieces(); ++i) {
        pieces.begin(i);
        struct End {
            double x;
            Measure s;
            int depth;
        };
        std::vector<End> ends{{1, at(i, 1), 0}};
        Measure before = at(i, 0);
        for (double x = 0; !ends.empty();) {
            const End end = ends.back();
            const double s0 = std::scalbn(breaks.back(), -e), d = end.s.value - s0;
            const double off =
                std::max(before.bound + std::abs(before.value - s0), end.s.bound) + kUnitRoundoff * s0;
            if (!(d >
                  8 * kUnitRoundoff * end.s.value)) {  // too short for lengths that doubles can tell apart
                const double passed = d + 2 * off + norm(chain.value(i, end.x) - points.back());
                bound = std::max(bound, std::max(0.0, passed));
            } else {
                auto found = pieces.piece(x, end.x, points.back(), d, off);
                if (!found.good && end.depth < kDeepestStep) {
                    const double middle = x + (end.x - x) / 2;
                    ends.push_back({middle, at(i, middle), end.depth + 1});
                    ends[ends.size() - 2].depth = end.depth + 1;
                    continue;
                }
                if (!found.good)
                    return refuse(
                        RefusalKind::ill_conditioned, "tolerance",
                        text(tolerance, " is below what rounding allows at parameter ", chain.global(i, x)));
                if (breaks.size() > std::size_t(max_pieces))
                    return refuse(RefusalKind::limit, "max_pieces",
                                  text("more than ", max_pieces, " pieces are needed; at ",
                                       100 * s0 / std::scalbn(total.value, -e), " percent of the length"));
                for (std::size_t k = 1; k <= 5; ++k) points.push_back(found.r[k]);
                breaks.push_back(std::scalbn(end.s.value, e));
                bound = std::max(bound, found.bound);
                speed = std::max(speed, found.speed);
            }
            before = end.s;
            x = end.x;
            ends.pop_back();
        }
    }
    std::vector<double> knots(6, 0.0);
    for (std::size_t k = 1; k < breaks.size(); ++k)
        knots.insert(knots.end(), k + 1 < breaks.size() ? 5 : 6, breaks[k]);
    auto basis = BSplineBasis::make(5, std::move(knots));
    if (!basis) return std::unexpected(basis.error());
    for (Vec<D>& x : points) x = detail::scaled(x, e);
    const int count = int(points.size());
    auto made = Curve<Vec<D>>::make({std::move(*basis)}, Net<1, Vec<D>>({count}, std::move(points)));
    if (!made) return std::unexpected(made.error());
    return ArcLengthCurve<D>{std::move(*made), std::scalbn(bound, e), speed, total};
}

template <class P>
Result<ArcLengthCurve<Space<P>::kDim>> by_arc_length(const Curve<P>& curve, double tolerance,
                                                     int max_pieces) {
    constexpr int D = Space<P>::kDim;
    if constexpr (detail::kIsWidened<P>) {
        const auto made = at_unit_speed(detail::widened(curve), tolerance, max_pieces);
        if (!made) return std::unexpected(made.error());
        return ArcLengthCurve<D>{detail::narrowed<D>(made->curve), made->bound, made->speed_bound,
                                 made->length};
    } else {
        return at_unit_speed(curve, tolerance, max_pieces);
    }
}

#define FF_INSTANTIATE(P) \
    template Result<ArcLengthCurve<Space<P>::kDim>> by_arc_length(const Curve<P>&, double, int);
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

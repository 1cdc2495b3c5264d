// Bound of the distance between an edge and its parameter curve on a face.
//
// Idea. The gap g(t) = S(p(t)) - c(t) is tiny beside S, p and c, so bounds of its size that add up those of
// its terms are worthless, and the same is true for its first and second derivative. But samples see the
// cancellation: on a piece of length h the parabola q through g at both ends and in the middle is known, and
// g - q is at most
//     0.00802 h^3 max|g'''|                                                       (|x (x - 1/2) (x - 1)| / 6
//     <= 0.00802)
// where the terms may be added up, because h^3 is small enough. So a few times (size / gap)^(1/3) samples
// prove what dense sampling only suggests.
//
// Notation. p = (u, v). S_ij, u_k, v_k, c_k: bounds of derivatives over the piece and over a box that
// contains p there (ends of the chord, widened by h^2/8 max|p''|; not where the chord is longer than h^2
// max|p''|, for p' is the chord's slope somewhere and nowhere 0 then). By the chain rule |g'''| <= c_3 + S_30
// u_1^3
//     + 3 S_21 u_1^2 v_1 + 3 S_12 u_1 v_1^2 + S_03 v_1^3 + 3 (S_20 u_1 u_2 + S_11 (u_1 v_2 + v_1 u_2) + S_02
//     v_1 v_2)
//     + S_10 u_3 + S_01 v_3, and so on for g'' and g'.
//
// Method. Pieces begin at the breaks of p and c. The piece with the largest bound is cut into as many parts
// as its bound of g''' asks for, or halved if these are many, until all keep the goal. |q| is at most the
// larger end plus the bump |g(middle) - (g(a) + g(b)) / 2|. Errors of order 1 (h/2 max|g'|) and 2 (h^2/8
// max|g''|) on top of the larger end are used where g is less smooth or their derivative bounds are the only
// finite ones.
//
// Seams: lines of the surface's parameter plane where it is not C^2, and the ends of its domain, beyond which
// parameters are moved back. If the box reaches over such a line by s, p is taken moved by s to one side of
// it: that curve has the derivatives of p, and the surface is smooth along it; each point moves by at most
// S_10 s. Edges often run along a seam, and s is rounding then, as it is where they cross one, for pieces end
// there. If the box reaches over two lines that are closer than it is wide, order 1 remains.
//
// Accuracy. A sample is off by at most r: value_error_bound of S and of c, and S_10, S_01 times that of u, v.
// The middle is off by rounding, at most 2^-20 h (shorter pieces use order 1), which changes q by no more
// than 2^-20 of the ends. With both: |g| <= (1 + 2^-18) |q| + 0.00803 h^3 max|g'''| + 3 r + 4 S_10 s.
//
// Cost. One sample costs two curve points and a surface point; a piece, four derivative queries.
//
// Why not the Bezier form of S o p? It exists (degree 3 (3 + 3) for a cubic on a bicubic patch), but not for
// angles, and for rational surfaces its denominator has to be multiplied out with c's.
#include "edge_mesh_detail.hpp"
#include "surface_seams_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/model/edge_gap.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace freiform {

namespace {

constexpr double kError[4] = {0, 0.5, 0.125, 0.00803};  // of order k, times h^k max|g^(k)|
constexpr int kMostParts = 64;                          // of a piece at a time
constexpr int kPieceCost = 12;                          // in samples
constexpr double kShort = 0x1p-30;  // of |t|: the middle of such a piece is not its middle

// How far the interval has to be moved so that it lies between two neighbouring seams with fewer than `order`
// - 1 continuous derivatives. Infinite if it does not fit.
double shift_between(const std::vector<SurfaceSeam>& seams, Interval limits, Interval on, int order) {
    const double middle = clamped(on.middle(), limits);
    Interval strip{-kInfinity, kInfinity};
    for (const SurfaceSeam& s : seams) {
        if (s.smooth >= order - 1) continue;
        if (s.at > middle || s.at == limits.hi) {
            strip.hi = s.at;
            break;
        }
        strip.lo = s.at;
    }
    if (on.length() > strip.length()) return kInfinity;
    return std::max({0.0, strip.lo - on.lo, on.hi - strip.hi});
}

// What the bound over a piece is made of.
struct Terms {
    double derivative[4] = {0, kInfinity, kInfinity, kInfinity};  // of g, by order
    double moved[4] = {0, 0, kInfinity, kInfinity};  // S_10 s: infinite where the order cannot be used
    double rounding = 0;                             // of a sample
};

struct Piece {
    Interval on;
    Vec<3> first{}, middle{}, last{};  // the gap there
    double bound = kInfinity;
    Terms terms;
    bool operator<(const Piece& o) const { return bound < o.bound; }
};

class Prover {
public:
    Prover(const DerivativeQuery<2, 3>& surface, const CurveGeometry<2>& on_surface,
           const CurveGeometry<3>& in_space, Interval range, const EdgeGapOptions& options)
        : surface_(surface),
          curve_(on_surface),
          space_(in_space),
          range_(range),
          options_(options),
          component_{component_of(on_surface, 0), component_of(on_surface, 1)},
          along_{DerivativeQuery<1, 1>(component_[0]), DerivativeQuery<1, 1>(component_[1])},
          in_space_(in_space),
          seams_(seams_of(surface.geometry())),
          limits_(limits(surface.geometry())) {}
    EdgeGap run();

private:
    using CurveBounds = std::array<DerivativeBounds<1>, 2>;

    bool is_covered() const;
    std::vector<double> cuts() const;
    void add_crossings(std::vector<double>& t) const;
    Vec<3> gap(double t);
    CurveBounds along(Interval on) const { return {along_[0]({on}, 3), along_[1]({on}, 3)}; }
    Box<2> box_of(Interval on, const CurveBounds& p) const;
    void measure_rounding(const std::vector<double>& cuts);
    Terms terms(Interval on) const;
    Piece piece(Interval on, const Vec<3>& first, const Vec<3>& last, double known);
    bool in_parts(Piece& p);
    double goal(const Terms& x) const {
        return std::max({options_.target, options_.factor * found_, options_.roundings * x.rounding});
    }

    const DerivativeQuery<2, 3>& surface_;
    const CurveGeometry<2>& curve_;
    const CurveGeometry<3>& space_;
    Interval range_;
    EdgeGapOptions options_;
    std::array<CurveGeometry<1>, 2> component_;
    std::array<DerivativeQuery<1, 1>, 2> along_;
    DerivativeQuery<1, 3> in_space_;
    std::array<std::vector<SurfaceSeam>, 2> seams_;
    std::array<Interval, 2> limits_;
    double value_error_ = 0, parameter_error_[2] = {0, 0};
    double found_ = 0;
    long long samples_ = 0;
};

// The ranges of splines contain `range`, and neither curve is torn inside.
bool Prover::is_covered() const {
    const auto contains = [&](const auto& curve) {
        return visit_one(
            [&](const auto& c) {
                if constexpr (requires { c.net(); })
                    return c.domain()[0].lo <= range_.lo && range_.hi <= c.domain()[0].hi;
                else
                    return true;
            },
            curve);
    };
    const auto whole = [&](std::span<const Kink> kinks) {
        return std::all_of(kinks.begin(), kinks.end(),
                           [&](const Kink& k) { return std::isfinite(k.jump) || !range_.contains(k.at); });
    };
    return contains(curve_) && contains(space_) && whole(along_[0].kinks(0)) && whole(along_[1].kinks(0)) &&
           whole(in_space_.kinks(0));
}

std::vector<double> Prover::cuts() const {
    std::vector<double> t{range_.lo, range_.hi};
    const auto add = [&](const auto& curve) {
        visit_one(
            [&](const auto& c) {
                if constexpr (requires { c.net(); })
                    for (double x : c.basis().breaks())
                        if (range_.lo < x && x < range_.hi) t.push_back(x);
            },
            curve);
    };
    add(curve_);
    add(space_);
    if (t.size() == 2)
        for (int i = 1; i < 4; ++i) t.push_back(range_.lo + range_.length() * i / 4);
    for (int pass = 0; pass < 2; ++pass) {
        sort(t.begin(), t.end());
        t.erase(std::unique(t.begin(), t.end()), t.end());
        if (pass == 0) add_crossings(t);
    }
    return t;
}

// Where the parameter curve crosses a seam between two of these places, but for those that it runs along.
void Prover::add_crossings(std::vector<double>& t) const {
    constexpr double kAlong = 0x1p-24;  // of the surface's parameters
    const std::size_t count = t.size();
    const auto at = [&](double x) { return jet<0>(curve_, x).value(); };
    Vec<2> last = at(t.front());
    for (std::size_t i = 1; i < count; ++i) {
        const Vec<2> next = at(t[i]);
        for (int k = 0; k < 2; ++k)
            for (auto s = std::ranges::upper_bound(seams_[std::size_t(k)], std::min(last[k], next[k]), {},
                                                   &SurfaceSeam::at);
                 s != seams_[std::size_t(k)].end() && s->at < std::max(last[k], next[k]); ++s) {
                const double before = last[k] - s->at, after = next[k] - s->at;
                const double along = kAlong * std::max(std::abs(last[k]), std::abs(next[k]));
                if (std::min(std::abs(before), std::abs(after)) <= along) continue;
                Interval on{t[i - 1], t[i]};
                for (double m = on.middle(); on.lo < m && m < on.hi; m = on.middle())
                    ((at(m)[k] - s->at) * before > 0 ? on.lo : on.hi) = m;
                t.push_back(on.lo);
            }
        last = next;
    }
}

Vec<3> Prover::gap(double t) {
    const Vec<2> uv = clamped(jet<0>(curve_, t).value(), limits_);
    const Vec<3> g = jet<0>(surface_.geometry(), uv.c).value() - jet<0>(space_, t).value();
    found_ = std::max(found_, norm(g));
    ++samples_;
    return g;
}

Box<2> Prover::box_of(Interval on, const CurveBounds& p) const {
    const double h = on.length(), grow = 1 + 0x1p-18;
    Box<2> box;
    const Vec<2> way = jet<0>(curve_, on.hi).value() - jet<0>(curve_, on.lo).value();
    Vec<2> sag;
    for (int i = 0; i < 2; ++i) {
        const double bend = grow * h * h * p[std::size_t(i)](2), rounding = grow * parameter_error_[i];
        const bool is_monotone = std::abs(way[i]) > bend + 2 * rounding;
        sag[i] = (is_monotone ? 0 : bend / 8) + rounding;
    }
    for (double t : {on.lo, on.hi}) {
        const Vec<2> at = jet<0>(curve_, t).value();
        box.add(at - sag);
        box.add(at + sag);
    }
    return box;
}

void Prover::measure_rounding(const std::vector<double>& cuts) {
    for (int i = 0; i < 2; ++i) parameter_error_[i] = value_error_bound(component_[std::size_t(i)], {range_});
    Box<2> box;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const Interval on{cuts[i], cuts[i + 1]};
        box.add(box_of(on, along(on)));
    }
    value_error_ = 1.8 * (value_error_bound(surface_.geometry(), {box.side(0), box.side(1)}) +
                          value_error_bound(space_, {range_}));  // of a distance: sqrt 3 times
}

Terms Prover::terms(Interval on) const {
    CurveBounds p = along(on);
    const auto c = in_space_({on}, 3);
    const Box<2> box = box_of(on, p);
    std::array<Interval, 2> around;
    double shift[2][4]{};
    bool torn = false;
    for (std::size_t i = 0; i < 2; ++i) {
        around[i] = box.side(int(i));
        if (around[i].hi <= limits_[i].lo ||
            around[i].lo >= limits_[i].hi) {  // held at the end of the domain
            p[i] = {};
            continue;
        }
        double most = 0;
        for (int order = 2; order <= 3; ++order) {
            shift[i][order] = shift_between(seams_[i], limits_[i], box.side(int(i)), order);
            if (std::isfinite(shift[i][order])) most = std::max(most, shift[i][order]);
        }
        around[i].lo -= most;
        around[i].hi += most;
        for (const SurfaceSeam& s : seams_[i]) torn = torn || (s.smooth < 0 && around[i].contains(s.at));
    }
    Terms x;
    if (torn) return x;
    for (std::size_t i = 0; i < 2; ++i)
        around[i] = {clamped(around[i].lo, limits_[i]), clamped(around[i].hi, limits_[i])};
    const auto s = surface_(around, 3);
    const auto &u = p[0], &v = p[1];
    const double u1 = u(1), u2 = u(2), u3 = u(3), v1 = v(1), v2 = v(2), v3 = v(3);
    x.derivative[1] = c(1) + s(1, 0) * u1 + s(0, 1) * v1;
    x.derivative[2] =
        c(2) + s(2, 0) * u1 * u1 + 2 * s(1, 1) * u1 * v1 + s(0, 2) * v1 * v1 + s(1, 0) * u2 + s(0, 1) * v2;
    x.derivative[3] = c(3) + s(3, 0) * u1 * u1 * u1 + 3 * s(2, 1) * u1 * u1 * v1 +
                      3 * s(1, 2) * u1 * v1 * v1 + s(0, 3) * v1 * v1 * v1 +
                      3 * (s(2, 0) * u1 * u2 + s(1, 1) * (u1 * v2 + v1 * u2) + s(0, 2) * v1 * v2) +
                      s(1, 0) * u3 + s(0, 1) * v3;
    for (int order = 2; order <= 3; ++order)
        x.moved[order] = s(1, 0) * shift[0][order] + s(0, 1) * shift[1][order];
    x.rounding = value_error_ + s(1, 0) * parameter_error_[0] + s(0, 1) * parameter_error_[1];
    for (double* number : {&x.derivative[1], &x.derivative[2], &x.derivative[3], &x.moved[2], &x.moved[3]})
        if (std::isnan(*number)) *number = kInfinity;  // 0 times infinite: nothing is known
    return x;
}

// The bound that samples at both ends and in the middle of a piece of length h give, by one of the orders.
double bound_of(const Terms& x, int order, double h, const Vec<3>& a, const Vec<3>& m, const Vec<3>& b) {
    double q = std::max(norm(a), norm(b));
    if (order == 3) q += norm(m - 0.5 * (a + b));
    const double power = order == 1 ? h : order == 2 ? h * h : h * h * h;
    const double bound =
        (1 + 0x1p-18) * q + kError[order] * power * x.derivative[order] + 3 * x.rounding + 4 * x.moved[order];
    return std::isnan(bound) ? kInfinity : bound;
}

bool is_short(Interval on, double part) { return part < kShort * std::max(std::abs(on.lo), std::abs(on.hi)); }

Piece Prover::piece(Interval on, const Vec<3>& first, const Vec<3>& last, double known) {
    Piece p{on, first, gap(on.middle()), last, known, terms(on)};
    samples_ += kPieceCost;
    const int top = is_short(on, on.length()) ? 1 : 3;
    for (int order = 1; order <= top; ++order)
        p.bound = std::min(p.bound, bound_of(p.terms, order, on.length(), p.first, p.middle, p.last));
    return p;
}

// Cuts the piece into as many equal parts as its derivatives ask for. False where that is too many or not
// enough.
bool Prover::in_parts(Piece& p) {
    const Terms& x = p.terms;
    const double h = p.on.length(), top = std::max({norm(p.first), norm(p.middle), norm(p.last)});
    int parts = kMostParts + 1, order = 0;
    for (int k = 1; k <= 3; ++k) {
        const double room = goal(x) - (1 + 0x1p-18) * top - 3 * x.rounding - 4 * x.moved[k];
        const double needed = 1 + std::pow(1.5 * kError[k] * x.derivative[k] / room, 1.0 / k) * h;
        if (room > 0 && needed < parts) parts = std::max(2, int(needed)), order = k;
    }
    if (order == 0 || is_short(p.on, h / parts)) return false;
    const auto at = [&](int i) { return p.on.lo + h * i / (2 * parts); };
    Vec<3> a = p.first;
    double bound = 0;
    for (int i = 0; i < parts; ++i) {
        const Vec<3> m = gap(at(2 * i + 1)), b = i + 1 == parts ? p.last : gap(at(2 * i + 2));
        bound = std::max(bound, bound_of(x, order, h / parts, a, m, b));
        a = b;
    }
    p.bound = std::min(p.bound, bound);
    return p.bound <= goal(x);
}

EdgeGap Prover::run() {
    if (!is_covered()) {
        gap(range_.lo), gap(range_.hi);
        return {found_, kInfinity};
    }
    const auto t = cuts();
    measure_rounding(t);
    std::vector<Piece> pieces;
    Vec<3> first = gap(t.front());
    for (std::size_t i = 0; i + 1 < t.size(); ++i) {
        const Vec<3> last = gap(t[i + 1]);
        pieces.push_back(piece({t[i], t[i + 1]}, first, last, kInfinity));
        first = last;
    }
    std::priority_queue<Piece> todo({}, std::move(pieces));
    double bound = 0;
    while (!todo.empty()) {
        Piece p = todo.top();
        todo.pop();
        const double middle = p.on.middle();
        const bool more = samples_ < options_.max_samples && p.on.lo < middle && middle < p.on.hi;
        if (p.bound <= goal(p.terms) || !more || in_parts(p)) {
            bound = std::max(bound, p.bound);
            continue;
        }
        todo.push(piece({p.on.lo, middle}, p.first, p.middle, p.bound));
        todo.push(piece({middle, p.on.hi}, p.middle, p.last, p.bound));
    }
    return {found_, bound};
}

}  // namespace

EdgeGap edge_gap(const DerivativeQuery<2, 3>& surface, const CurveGeometry<2>& on_surface,
                 const CurveGeometry<3>& in_space, Interval range, const EdgeGapOptions& options) {
    FF_REQUIRE(range.lo <= range.hi && std::isfinite(range.length()));
    return Prover(surface, on_surface, in_space, range, options).run();
}

}  // namespace freiform

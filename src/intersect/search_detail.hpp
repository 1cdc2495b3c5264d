// All pairs of parameters at which a part of one object and a part of another may be in the same place: the
// search that all intersections share. intersection.cpp is the essay.
#pragma once
#include "parts_detail.hpp"

#include <algorithm>
#include <optional>

namespace freiform::detail {

// Linear functions that see one parameter each: r_k . (column j) = det if j == k, else 0. What is left are
// directions in which the objects may be apart although all columns are parallel.
template <std::size_t N, int D>
struct Rows {
    std::array<Vec<D>, N> r{};
    std::array<Vec<D>, 2> more{};
    int extra = 0;
    double det = 0;
};
inline Vec<2> normal(const Vec<2>& a) { return {{a[1], -a[0]}}; }
inline Rows<2, 2> rows_of(const std::array<Vec<2>, 2>& c) {
    Rows<2, 2> out;
    out.r = {normal(c[1]), -normal(c[0])};
    out.det = c[0][0] * c[1][1] - c[0][1] * c[1][0];
    if (out.det * out.det <= 0.0625 * dot(c[0], c[0]) * dot(c[1], c[1])) {
        out.more[0] = dot(c[0], c[0]) > dot(c[1], c[1]) ? c[0] : c[1];
        out.extra = 1;
    }
    return out;
}
inline Rows<2, 3> rows_of(const std::array<Vec<3>, 2>& c) {
    Rows<2, 3> out;
    const Vec<3> n = cross(c[0], c[1]);
    out.r = {cross(c[1], n), cross(n, c[0])};
    out.det = dot(n, n);
    out.more = {n, dot(c[0], c[0]) > dot(c[1], c[1]) ? c[0] : c[1]};
    out.extra = 2;
    return out;
}
inline Rows<3, 3> rows_of(const std::array<Vec<3>, 3>& c) {
    Rows<3, 3> out;
    out.r = {cross(c[1], c[2]), cross(c[2], c[0]), cross(c[0], c[1])};
    out.det = dot(c[0], out.r[0]);
    return out;
}

// A root that is unique in the parts around it, in parameters of the pieces.
template <std::size_t N>
struct Simple {
    int a = 0, b = 0;  // pieces
    std::array<double, N> at{};
    std::array<Interval, N> box{};
    double gap = 0;
    int sign = 0;         // of the determinant
    bool exists = false;  // proven; never in space, where curves need not meet
};
// Parts that nothing was proven of: too near to each other to be told apart, or the budget was over.
template <std::size_t N>
struct Open {
    int a = 0, b = 0;            // pieces
    int part_a = 0, part_b = 0;  // while the search lives
    std::array<Interval, N> box{};
    bool over_budget = false;
};

// `Prune` decides what else may be set aside: settled(ia, ib) of two parts, and stuck(piece a, piece b),
// which is called when a pair of pieces takes long.
template <class A, class B>
class Search {
public:
    static constexpr std::size_t N = A::kParams + B::kParams;
    static constexpr int D = A::D;
    static constexpr double kMargin =
        0x1p-20;  // roots are unique in a part that is longer by this on each side

    Search(A& a, B& b) : a_(a), b_(b) {}

    template <class Prune>
    void look_at(int piece_a, int piece_b, int max_parts, Prune& prune) {
        found_.clear();
        open_.clear();
        pairs_.assign(1, {piece_a, piece_b});
        for (int looked_at = 0; !pairs_.empty(); ++looked_at) {
            const auto [ia, ib] = pairs_.back();
            pairs_.pop_back();
            if (looked_at == kStuck) prune.stuck(piece_a, piece_b);
            if (looked_at >= kStuck && prune.settled(ia, ib)) continue;
            look(ia, ib, looked_at >= max_parts);
        }
    }

    // Of the last pair of pieces.
    const std::vector<Simple<N>>& found() const { return found_; }
    const std::vector<Open<N>>& open() const { return open_; }

    // Where in the box open parts of the last pair of pieces are near each other, if flat ones are halved as
    // long as they are longer than rounding. Those that run along each other have no end of that, but where
    // the tips of two cusps meet, what is near is far shorter than what is flat. Nothing: it takes too long.
    std::optional<std::vector<std::array<Interval, N>>> narrowed(const std::array<Interval, N>& box) {
        constexpr int kMostLooks = 2000;
        pairs_.clear();
        for (const Open<N>& o : open_)
            if (overlap(o.box, box)) pairs_.push_back({o.part_a, o.part_b});
        std::vector<std::array<Interval, N>> out;
        for (int looked_at = 0; !pairs_.empty(); ++looked_at) {
            if (looked_at == kMostLooks) return std::nullopt;
            const auto [ia, ib] = pairs_.back();
            pairs_.pop_back();
            const std::optional<Near> n = near(ia, ib);
            if (n && (n->tiny || !halve(ia, ib, n->first_is_larger))) out.push_back(on(ia, ib));
        }
        return out;
    }

private:
    static constexpr int kStuck = 300;
    static constexpr double kFlat = 16;  // times the rounding

    struct Pair {
        int a, b;
    };
    using Columns = std::array<Vec<D>, N>;

    // Of two parts that are not proven to be apart: `flat`, neither is wide beside rounding.
    struct Near {
        Rows<N, D> rows;
        bool flat = false, tiny = false, first_is_larger = false;
    };
    std::optional<Near> near(int ia, int ib) const {
        const auto& p = a_[ia];
        const auto& q = b_[ib];
        const double e = p.error + q.error;
        for (int k = 0; k < D; ++k)
            if (p.lo[k] - q.hi[k] > e || q.lo[k] - p.hi[k] > e) return std::nullopt;
        Columns c;
        for (std::size_t k = 0; k < A::kParams; ++k) c[k] = a_.chord(ia, int(k));
        for (std::size_t k = 0; k < B::kParams; ++k) c[A::kParams + k] = -b_.chord(ib, int(k));
        Near out;
        out.rows = rows_of(c);
        // Closed parts have no chord, so nothing to be flat along.
        out.flat = std::any_of(c.begin(), c.end(), [](const Vec<D>& v) { return max_abs(v) > 0; });
        if (apart(ia, ib, out.rows.r, e, out.flat)) return std::nullopt;
        bool ignored = true;
        for (int k = 0; k < out.rows.extra; ++k)
            if (apart(ia, ib, std::array{out.rows.more[std::size_t(k)]}, e, ignored)) return std::nullopt;
        const double size_a = p.extent(), size_b = q.extent();
        out.tiny = std::max(size_a, size_b) <= kFlat * e;
        out.first_is_larger = size_a >= size_b;
        return out;
    }

    void look(int ia, int ib, bool over_budget) {
        const std::optional<Near> n = near(ia, ib);
        if (!n) return;
        if (n->rows.det != 0) {
            const double q_norm = contraction(ia, ib, n->rows);
            if (q_norm < 0.9 && settle(ia, ib, n->rows, q_norm)) return;
        }
        if (over_budget || n->tiny || n->flat || !halve(ia, ib, n->first_is_larger))
            give_up(ia, ib, over_budget);
    }

    bool halve(int ia, int ib, bool first) {
        if (first ? !a_.halve(ia) : !b_.halve(ib)) return false;
        const int half = first ? a_[ia].left : b_[ib].left;
        for (const int h : {half, half + 1}) pairs_.push_back(first ? Pair{h, ib} : Pair{ia, h});
        return true;
    }

    // Ranges of r_k . x over the control points.
    template <std::size_t M, class Parts>
    static std::array<Interval, M> ranges(const Parts& parts, int i, const std::array<Vec<D>, M>& r) {
        const auto* h = parts.hull(i);
        std::array<Interval, M> x;
        for (std::size_t m = 0; m < M; ++m) x[m].lo = x[m].hi = dot(r[m], h[0]);
        for (int k = 1; k < parts.block(); ++k)
            for (std::size_t m = 0; m < M; ++m) {
                const double v = dot(r[m], h[k]);
                x[m] = {std::min(x[m].lo, v), std::max(x[m].hi, v)};
            }
        return x;
    }
    static double size_of(const Vec<D>& r) {
        double size = 0;
        for (int k = 0; k < D; ++k) size += std::abs(r[k]);
        return size;
    }
    // Along one of the r, by more than rounding? `flat` stays true if neither is longer than rounding there.
    template <std::size_t M>
    bool apart(int ia, int ib, const std::array<Vec<D>, M>& r, double e, bool& flat) const {
        const auto x = ranges(a_, ia, r), y = ranges(b_, ib, r);
        for (std::size_t k = 0; k < M; ++k) {
            const double slack = size_of(r[k]) * (1.01 * e + 2 * (D + 1) * 1.01 * kUnitRoundoff);
            if (x[k].lo - y[k].hi > slack || y[k].lo - x[k].hi > slack) return true;
            if (std::max(x[k].length(), y[k].length()) > kFlat * slack) flat = false;
        }
        return false;
    }

    // A bound of |1 - Y J| over both parts, in their own parameters; J are the derivatives, Y = r / det.
    double contraction(int ia, int ib, const Rows<N, D>& rows) const {
        std::array<double, N> sum{};
        add_variation(a_, ia, 0, 1, rows, sum);
        const double half = *std::max_element(sum.begin(), sum.end());
        if (half >= std::abs(rows.det)) return half / std::abs(rows.det);
        add_variation(b_, ib, A::kParams, -1, rows, sum);
        return *std::max_element(sum.begin(), sum.end()) / std::abs(rows.det) * (1 + 0x1p-16 * 32);
    }
    template <class Parts>
    static void add_variation(const Parts& parts, int i, std::size_t first, double sign,
                              const Rows<N, D>& rows, std::array<double, N>& sum) {
        for (std::size_t axis = 0; axis < Parts::kParams; ++axis) {
            std::array<double, N> most{}, own{};
            own[first + axis] = rows.det;
            const double radius = parts.slopes(i, int(axis), [&](const Vec<D>& d) {
                for (std::size_t k = 0; k < N; ++k)
                    most[k] = std::max(most[k], std::abs(sign * dot(rows.r[k], d) - own[k]));
            });
            for (std::size_t k = 0; k < N; ++k) sum[k] += most[k] + size_of(rows.r[k]) * radius;
        }
    }

    struct Value {
        Vec<D> f;
        Columns j;
        double error = 0;
    };
    Value value(int piece_a, int piece_b, const std::array<double, N>& x) const {
        Value v;
        Vec<D> p, q;
        v.error = a_.at(piece_a, x.data(), p, v.j.data()) +
                  b_.at(piece_b, x.data() + A::kParams, q, v.j.data() + A::kParams);
        for (std::size_t k = A::kParams; k < N; ++k) v.j[k] = -v.j[k];
        v.f = p - q;
        v.error += 2 * kUnitRoundoff * max_abs(v.f);
        return v;
    }
    std::array<Interval, N> on(int ia, int ib) const {
        std::array<Interval, N> x;
        const auto& p = a_[ia];
        const auto& q = b_[ib];
        for (std::size_t k = 0; k < A::kParams; ++k) x[k] = {p.from[k], p.from[k] + p.width[k]};
        for (std::size_t k = 0; k < B::kParams; ++k) x[A::kParams + k] = {q.from[k], q.from[k] + q.width[k]};
        return x;
    }

    // Newton's method from where the chords meet; never far outside of the parts.
    std::array<double, N> newton(int ia, int ib, const std::array<Interval, N>& x,
                                 const Rows<N, D>& rows) const {
        const Vec<D> gap = a_.hull(ia)[0] - b_.hull(ib)[0];
        std::array<double, N> t;
        for (std::size_t k = 0; k < N; ++k)
            t[k] = x[k].lo + std::clamp(-dot(rows.r[k], gap) / rows.det, 0.0, 1.0) * x[k].length();
        double last = kInfinity;
        for (int i = 0; i < 8; ++i) {
            const Value v = value(a_[ia].piece, b_[ib].piece, t);
            const Rows<N, D> r = rows_of(v.j);
            if (r.det == 0) break;
            double step = 0;
            for (std::size_t k = 0; k < N; ++k) {
                const double d = dot(r.r[k], v.f) / r.det, w = x[k].length();
                const double next = std::clamp(t[k] - d, x[k].lo - w, x[k].hi + w);
                step = std::max(step, std::abs(next - t[k]) / w);
                t[k] = next;
            }
            // Convergence is quadratic: what is left is far below this step.
            if (step <= 0x1p-27 || (step >= 0.5 * last && step < 0x1p-20)) break;
            last = step;
        }
        return t;
    }

    // At most one root. True: it has been found, or there is none.
    bool settle(int ia, int ib, const Rows<N, D>& rows, double q) {
        const std::array<Interval, N> x = on(ia, ib);
        Simple<N> s;
        s.a = a_[ia].piece, s.b = b_[ib].piece;
        s.at = newton(ia, ib, x, rows);
        for (std::size_t k = 0; k < N; ++k) {
            const double m = 0.5 * kMargin * x[k].length();
            s.at[k] = std::clamp(s.at[k], x[k].lo - m, x[k].hi + m);
        }
        const Value v = value(s.a, s.b, s.at);
        std::array<double, N> d, e;
        double radius = 0;
        for (std::size_t k = 0; k < N; ++k) {
            const double size = size_of(rows.r[k]);
            d[k] = dot(rows.r[k], v.f) / rows.det;
            e[k] = 1.01 * size / std::abs(rows.det) * (v.error + 8 * kUnitRoundoff * max_abs(v.f));
            radius = std::max(radius, std::abs(d[k]) + e[k]);
        }
        radius = 1.01 * radius / (1 - q);
        bool inside = true;
        for (std::size_t k = 0; k < N; ++k) {
            const double w = x[k].length(), mid = (s.at[k] - x[k].lo) / w;
            const double reach = std::min(radius, e[k] + q * radius + std::abs(d[k])) + 0x1p-50 / w;
            const Interval root{mid - d[k] - e[k] - q * radius - 0x1p-50 / w,
                                mid - d[k] + e[k] + q * radius + 0x1p-50 / w};
            if (root.lo > 1 || root.hi < 0) return true;
            inside = inside && mid - radius >= -kMargin && mid + radius <= 1 + kMargin;
            s.box[k] = {s.at[k] - reach * w, s.at[k] + reach * w};
        }
        if (!inside) return false;
        s.exists = N == std::size_t(D);
        s.sign = rows.det > 0 ? 1 : -1;
        s.gap = std::sqrt(double(D)) * 1.01 * (max_abs(v.f) + v.error);
        // In space the rest of the difference does not vanish, unless by chance.
        if (!s.exists && misses(ia, ib, v, radius)) return true;
        for (const Simple<N>& other : found_)
            if (overlap(other.box, s.box)) return is_within(other.box, x);
        found_.push_back(s);
        return true;
    }
    static bool overlap(const std::array<Interval, N>& a, const std::array<Interval, N>& b) {
        for (std::size_t k = 0; k < N; ++k)
            if (!a[k].overlaps(b[k])) return false;
        return true;
    }
    // A root that is in the parts or so near that it is the one that is unique there.
    static bool is_within(const std::array<Interval, N>& box, const std::array<Interval, N>& x) {
        for (std::size_t k = 0; k < N; ++k) {
            const double m = kMargin * x[k].length();
            if (box[k].lo < x[k].lo - m || box[k].hi > x[k].hi + m) return false;
        }
        return true;
    }
    // Is the difference not 0 wherever the root may be, which is `radius` of the parts from here?
    bool misses(int ia, int ib, const Value& v, double radius) const {
        Vec<D> change{};
        const auto add = [&](const auto& parts, int i, std::size_t axes) {
            for (std::size_t axis = 0; axis < axes; ++axis) {
                Vec<D> most{};
                const double more = parts.slopes(i, int(axis), [&](const Vec<D>& d) {
                    for (int c = 0; c < D; ++c) most[c] = std::max(most[c], std::abs(d[c]));
                });
                for (int c = 0; c < D; ++c) change[c] += most[c] + more;
            }
        };
        add(a_, ia, A::kParams);
        add(b_, ib, B::kParams);
        for (int c = 0; c < D; ++c)
            if (std::abs(v.f[c]) > 1.01 * (change[c] * radius + v.error)) return true;
        return false;
    }

    void give_up(int ia, int ib, bool over_budget) {
        open_.push_back({a_[ia].piece, b_[ib].piece, ia, ib, on(ia, ib), over_budget});
    }

    A& a_;
    B& b_;
    std::vector<Pair> pairs_;
    std::vector<Simple<N>> found_;
    std::vector<Open<N>> open_;
};

}  // namespace freiform::detail

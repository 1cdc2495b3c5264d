// One cubic piece of a branch of a section: in space and in the parameters of the surface, with a bound.
//
// Notation. C(t) in space, q(t) in the parameters, 0 <= t <= 1; E = C - S o q. h: signed distance from the
// plane.
//
// Accuracy. Over a part of length 1, |E| <= max |E(ends)| + max |E''| / 8, and
//     |E''| <= |C''| + |S_uu| u'^2 + 2 |S_uv u' v'| + |S_vv| v'^2 + |S_u u''| + |S_v v''|
// or, where E'' is continuous, since |4 D - E''(middle)| <= |E'''| / 6 for D = E(0) - 2 E(middle) + E(1),
//     |E| <= max |E(ends)| + |D| / 2 + max |E'''| / 12
// with derivatives of S bounded over a box that contains q. If S has a kink in the box along an axis, S is
// replaced by S with that parameter fixed, off by the width of the box times |S_u|, twice.
//
// So |h(S(q))| <= |h(C)| + |E| = r; or r is found like |E|, with derivatives of h. If the slope of h along u
// is at least m over the box and its surroundings, a zero of h is at most r / m away from q along u, and is
// the only one there: the branch. Where the axis changes between two parts, h is monotone along both in the
// rectangle of q and the two zeros, which one monotone arc joins. So the zeros are one curve that follows q
// from end to end; its distance from C is at most |E| + |S_u| r / m.
#pragma once
#include "cubic_arc_detail.hpp"
#include "section_field_detail.hpp"

#include <optional>

namespace freiform::detail {

struct SectionPiece {
    CubicArc<Vec<3>> space{};
    CubicArc<Vec<2>> at{};
    double length = 0;  // of its interval of parameters
    std::array<Vec<3>, 2> tangent{};
    std::array<Vec<2>, 2> slope{};
};

struct PieceBound {
    double surface = 0, plane = 0, all = 0;
    void include(const PieceBound& o) {
        surface = std::max(surface, o.surface), plane = std::max(plane, o.plane), all = std::max(all, o.all);
    }
};

template <class P>
class PieceProof {
public:
    // `on_side`: q runs along a side of the surface that lies in the plane.
    PieceProof(const SectionField<P>& field, double tolerance, bool on_side)
        : field_(field), tolerance_(tolerance), on_side_(on_side) {}

    // Nothing: no bound up to the tolerance.
    std::optional<PieceBound> operator()(const SectionPiece& piece) const {
        PieceBound bound;
        bound.plane = plane_bound(piece);
        const Sample a = sample(piece.space[0], piece.at[0]), b = sample(piece.space[3], piece.at[3]);
        if (is_exhausted()) return std::nullopt;
        parts_ = 0;
        if (!prove(piece.space, piece.at, a, b, 0, bound)) return std::nullopt;
        return bound;
    }
    // A backstop for the whole branch: then pieces have the bounds that they have.
    bool is_exhausted() const { return all_parts_ >= kMostPartsOfAll; }
    // Without a proof that follows the branch: everything is in a small box.
    PieceBound by_size(const SectionPiece& piece, std::array<Interval, 2> around) const {
        PieceBound bound;
        bound.plane = plane_bound(piece);
        double reach = 0;
        for (int i = 1; i < 4; ++i)
            reach = std::max(reach, norm(piece.space[std::size_t(i)] - piece.space[0]));
        for (int k = 0; k < 2; ++k) {
            Interval& on = around[std::size_t(k)];
            on = hull(on, {piece.at[0][k], piece.at[0][k]});
        }
        const DerivativeBounds<2> d = field_.query(around, 1);
        bound.surface = 1.01 * (reach + error_at(piece.space[0], piece.at[0]));
        bound.all = 1.01 * (bound.surface + d(1, 0) * around[0].length() + d(0, 1) * around[1].length());
        return bound;
    }
    // What `operator()` will hardly do better than.
    double estimate(const SectionPiece& piece) const {
        double most = 0;
        auto [left, right] = arc_halves(piece.space);
        auto [first, second] = arc_halves(piece.at);
        const std::array<std::pair<Vec<3>, Vec<2>>, 3> places{
            {{left[3], first[3]},
             {arc_halves(left)[0][3], arc_halves(first)[0][3]},
             {arc_halves(right)[0][3], arc_halves(second)[0][3]}}};
        for (const auto& [x, u] : places) {
            if (!is_inside(u)) return kInfinity;
            const auto jet = field_.surface.template jet<1>({u[0], u[1]});
            double off = norm(x - jet.value());
            const double h = std::abs(field_.height(jet.value()));
            double slope = 0;
            for (int k = 0; k < 2; ++k) {
                const Vec<3>& d = jet.d[std::size_t(k) + 1];
                const double size = norm(d);
                if (size > 0) slope = std::max(slope, std::abs(dot(field_.unit_normal, d)) / size);
            }
            if (!on_side_ && h > 0) off += slope > 0 ? h / slope : kInfinity;
            most = std::max(most, off);
        }
        return most;
    }

private:
    static constexpr int kDeepest = 24;
    static constexpr int kMostParts = 2000;  // of one piece; shorter pieces need fewer
    static constexpr int kMostPartsOfAll = 100'000;

    bool is_inside(const Vec<2>& u) const {
        const auto on = field_.surface.domain();
        return on[0].contains(u[0]) && on[1].contains(u[1]);
    }
    double plane_bound(const SectionPiece& piece) const {
        double most = 0;
        for (const Vec<3>& p : piece.space)
            most = std::max(most, std::abs(field_.height(p)) + field_.height_error(p));
        return 1.01 * most;
    }
    // E and the height of the surface at one place; what each is off by.
    struct Sample {
        Vec<3> off{};
        double height = 0, error = 0;
        double size() const { return 1.01 * (norm(off) + error); }
    };
    Sample sample(const Vec<3>& x, const Vec<2>& u) const {
        const Vec<3> s = field_.surface({u[0], u[1]});
        return {x - s, field_.height(s),
                1.8 * (field_.rounding + 64 * kUnitRoundoff * max_abs(x)) + field_.height_error(s)};
    }
    double error_at(const Vec<3>& x, const Vec<2>& u) const { return sample(x, u).size(); }

    bool prove(const CubicArc<Vec<3>>& c, const CubicArc<Vec<2>>& q, const Sample& a, const Sample& b,
               int depth, PieceBound& bound) const {
        ++all_parts_;
        const auto [c0, c1] = arc_halves(c);
        const auto [q0, q1] = arc_halves(q);
        const Sample m = sample(c0[3], q0[3]);
        const std::array<const Sample*, 3> samples{&a, &m, &b};
        if (const auto here = bound_over(c, q, samples, bound.plane)) {
            if (here->all <= tolerance_) {
                bound.include(*here);
                return true;
            }
        }
        if (depth == kDeepest || ++parts_ > kMostParts || is_exhausted() ||
            std::max({a.size(), m.size(), b.size()}) > tolerance_)
            return false;
        return prove(c0, q0, a, m, depth + 1, bound) && prove(c1, q1, m, b, depth + 1, bound);
    }

    // No line over which second derivatives jump is inside.
    bool is_twice_smooth(const std::array<Interval, 2>& box) const {
        for (int k = 0; k < 2; ++k)
            for (const int line : field_.stops[std::size_t(k)]) {
                const double at = field_.bezier.breaks(k)[std::size_t(line)];
                if (box[std::size_t(k)].lo < at && at < box[std::size_t(k)].hi) return false;
            }
        return true;
    }
    std::optional<PieceBound> bound_over(const CubicArc<Vec<3>>& c, const CubicArc<Vec<2>>& q,
                                         const std::array<const Sample*, 3>& at, double plane) const {
        const double ends = std::max(at[0]->size(), at[2]->size());
        const auto path = speeds_of(q, field_.surface.domain());
        if (!path) return std::nullopt;
        const auto& [box, speed, bend, twist, slack] = *path;
        const bool smooth = is_twice_smooth(box);
        const DerivativeBounds<2> d = field_.query(box, smooth ? 3 : 2);
        const std::array<double, 2> first{d(1, 0), d(0, 1)}, second{d(2, 0), d(0, 2)};
        double most = bend_of_arc(c) * 1.01, aside = 0, shift = 0;
        std::array<bool, 2> fixed{};
        for (std::size_t a = 0; a < 2; ++a) {
            for (const Kink& kink : field_.query.kinks(int(a)))
                fixed[a] = fixed[a] || (box[a].lo < kink.at && kink.at < box[a].hi);
            if (fixed[a])
                aside += 2 * first[a] * box[a].length();
            else
                most += second[a] * speed[a] * speed[a] + first[a] * bend[a];
            shift += first[a] * slack[a];
        }
        if (!fixed[0] && !fixed[1]) most += 2 * d(1, 1) * speed[0] * speed[1];
        double between = most / 8 + aside;
        const double errors = at[0]->error + 2 * at[1]->error + at[2]->error;
        if (smooth && !fixed[0] && !fixed[1]) {
            const double second_difference = norm(at[0]->off - 2 * at[1]->off + at[2]->off) + errors;
            between = std::min(
                between, 1.01 * (second_difference / 2 + (twist_of_arc(c) + third_of_arc(d, *path)) / 12));
        }
        PieceBound bound;
        bound.plane = plane;
        bound.surface = 1.01 * (ends + between + 4 * shift);
        if (on_side_) {
            bound.all = bound.surface;
            return bound;
        }
        if (bound.surface > tolerance_) return std::nullopt;
        double height = bound.surface + plane;
        double off = to_branch(box, first, height);
        if (bound.surface + off > tolerance_ && !fixed[0] && !fixed[1]) {
            // Where the plane is nearly tangential, the height of S o q is known better than its place.
            height = std::min(height, height_over(*path, at, smooth));
            off = to_branch(box, first, height);
        }
        bound.all = 1.01 * (bound.surface + off);
        return bound;
    }

    double height_over(const ArcSpeeds& path, const std::array<const Sample*, 3>& at, bool smooth) const {
        const auto& [box, speed, bend, twist, slack] = path;
        const DerivativeBounds<2> n = field_.query.along(field_.unit_normal, box, smooth ? 3 : 2);
        const double ends =
            std::max(std::abs(at[0]->height) + at[0]->error, std::abs(at[2]->height) + at[2]->error);
        const double shift = 4 * (n(1, 0) * slack[0] + n(0, 1) * slack[1]);
        double more = (n(2, 0) * speed[0] * speed[0] + 2 * n(1, 1) * speed[0] * speed[1] +
                       n(0, 2) * speed[1] * speed[1] + n(1, 0) * bend[0] + n(0, 1) * bend[1]) /
                      8;
        if (smooth) {
            const double difference = std::abs(at[0]->height - 2 * at[1]->height + at[2]->height);
            const double errors = at[0]->error + 2 * at[1]->error + at[2]->error;
            more = std::min(more, (difference + errors) / 2 + third_of_arc(n, path) / 12);
        }
        return 1.01 * (ends + shift + more);
    }

    // How far the branch is from points of the surface over the box whose height is at most `height`.
    double to_branch(const std::array<Interval, 2>& box, const std::array<double, 2>& first,
                     double height) const {
        std::array<Interval, 2> in, wide;  // places, of cyclic axes beyond the domain
        const double size = std::max(first[0] * box[0].length(), first[1] * box[1].length());
        Index<2> from{}, to{};
        for (int k = 0; k < 2; ++k) {
            const std::size_t a = std::size_t(k);
            in[a] = {field_.place(k, box[a].lo), field_.place(k, box[a].hi)};
            const int n = field_.count(k), piece = std::clamp(int(in[a].lo), 0, n - 1);
            const double whole = first[a] * field_.span(k, piece);
            const double more = std::max(0x1p-20, whole > size ? 0.5 * size / whole : 0.5);
            wide[a] = {in[a].lo - more, in[a].hi + more};
            if (!field_.options.cyclic[a])
                wide[a] = {std::max(wide[a].lo, 0.0), std::min(wide[a].hi, double(n))};
            from[a] = int(std::floor(wide[a].lo));
            to[a] = std::max(from[a], int(std::ceil(wide[a].hi)) - 1);
        }
        std::array<Slope, 2> slope;
        std::array<double, 2> reach{};  // of the surface, by places
        double weight = 0;
        for (int i = from[0]; i <= to[0]; ++i)
            for (int j = from[1]; j <= to[1]; ++j) {
                const int n = field_.count(0), m = field_.count(1);
                const Index<2> piece{(i % n + n) % n, (j % m + m) % m};
                weight = std::max(weight, field_.weight[field_.piece_at(piece)]);
                std::array<Interval, 2> part, of;
                for (int k = 0; k < 2; ++k) {
                    const std::size_t a = std::size_t(k);
                    const double by = piece[a] - (k == 0 ? i : j);
                    part[a] = {std::max(wide[a].lo + by, double(piece[a])),
                               std::min(wide[a].hi + by, piece[a] + 1.0)};
                    of[a] = {field_.parameter(k, part[a].lo), field_.parameter(k, part[a].hi)};
                }
                const DerivativeBounds<2> d = field_.query(of, 1);
                for (int k = 0; k < 2; ++k) {
                    const std::size_t a = std::size_t(k);
                    slope[a].include(slope_over(piece, part, k));
                    reach[a] = std::max(reach[a], d.d[a + 1] * field_.span(k, piece[a]));
                }
            }
        double best = kInfinity;
        for (std::size_t a = 0; a < 2; ++a) {
            if (slope[a].sign != 1 && slope[a].sign != -1) continue;
            const double off = 1.01 * height * field_.to_function * weight / slope[a].least;
            if (in[a].lo - off >= wide[a].lo && in[a].hi + off <= wide[a].hi)
                best = std::min(best, off * reach[a]);
        }
        return best;
    }

    // Of the function, by places.
    struct Slope {
        double least = kInfinity;
        int sign = 2;  // 2: nothing seen; 0: both
        void include(const Slope& o) {
            least = std::min(least, o.least);
            sign = sign == 2 || sign == o.sign ? o.sign : 0;
        }
    };
    // Of the part, or of a longer one around it: very short ones say nothing but rounding.
    Slope slope_over(const Index<2>& piece, const std::array<Interval, 2>& part, int axis) const {
        const auto& f = field_.function;
        const std::size_t at = field_.piece_at(piece), block = std::size_t(f.block());
        LevelBlock b{{}, f.degree, {}, f.error[at]};
        for (std::size_t k = 0; k < 2; ++k) b.on[k] = {double(piece[k]), piece[k] + 1.0};
        for (std::size_t n = 0; n < block; ++n) b.c.push_back(f.points[at * block + n][0]);
        b.error += 2 * kUnitRoundoff * b.most();
        const Slope own = slope_of(part_of(b, part), axis);
        auto around = part;
        bool longer = false;
        for (Interval& on : around) {
            const double lack = std::max(0.0, 0x1p-10 - on.length());
            longer = longer || lack > 0;
            on = {on.lo - lack, on.hi + lack};
        }
        if (!longer) return own;
        const Slope other = slope_of(part_of(b, around), axis);
        return other.sign != 0 && (own.sign == 0 || other.least > own.least) ? other : own;
    }
    static Slope slope_of(const LevelBlock& b, int axis) {
        const std::size_t k = std::size_t(axis);
        Slope s;
        if (b.degree[k] == 0 || !(b.on[k].length() > 0)) return {0, 0};
        Index<2> extent{b.degree[0] + 1, b.degree[1] + 1};
        --extent[k];
        const double factor = b.degree[k] / b.on[k].length();
        each_index(extent, [&](const Index<2>& at) {
            Index<2> next = at;
            ++next[k];
            const double d = b.coefficient(next[0], next[1]) - b.coefficient(at[0], at[1]);
            const double size = std::abs(d) - 2.02 * b.error - 4 * kUnitRoundoff * b.most();
            const int sign = size > 0 ? d > 0 ? 1 : -1 : 0;
            s.sign = s.sign == 2 || s.sign == sign ? sign : 0;
            s.least = std::min(s.least, 0.99 * factor * std::max(size, 0.0));
        });
        return s;
    }

    const SectionField<P>& field_;
    double tolerance_;
    bool on_side_;
    mutable int parts_ = 0, all_parts_ = 0;
};

}  // namespace freiform::detail

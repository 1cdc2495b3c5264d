// Curves that run along each other: found from their ends, and taken out of the search.
//
// Idea. Where two curves are the same, or nearly, over an interval, the interval ends at an end of one of
// them. So pairs of parameters that meet, of which one is an end, are looked for; an overlap runs from one
// such pair to the next, in the directions in which both curves go on. In integers (exact_pair.cpp) all this
// is exact: curves of one algebraic curve that leave a common point in the same direction stay together.
// Otherwise the control points of both over the intervals are compared.
//
// A curve that turns round upon itself or the other one has overlaps that no end begins, or ends that are
// passed more than once. So an exact overlap must be followed by both curves at a few points, and where some
// pair of ends begins nothing that another ends, or has no direction, nothing is settled: it stays open.
//
// Parts of both that move on in one common direction have no other contacts than those of the overlap:
// a curve that moves on does not meet itself. `settled` looks at the control points over the interval that
// both parts cover. That interval comes from Newton's method, and that the curves are together over it is
// seen at its ends and in the middle only: here, beside overlaps, no other contact is an estimate, not a
// proof.
#pragma once
#include "exact_pair_detail.hpp"
#include "parts_detail.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/intersect/contact.hpp>

namespace freiform::detail {

// The number with the fewest bits in an interval of [0, 1]; of all of it the middle.
inline double simplest(const Interval& on) {
    if (on == Interval{0, 1}) return 0.5;
    for (double n = 1; n <= 0x1p52; n *= 2)
        if (const double x = std::ceil(on.lo * n) / n; x <= on.hi) return x;
    return on.middle();
}

// Control points of a Bezier curve of [0, 1] over part of it; outside of [0, 1] it is continued.
template <class P>
std::vector<P> over(const P* from, int count, const Interval& on) {
    std::vector<P> b(from, from + count);
    const Fibre<P> row{b.data(), count, 1};
    if (std::abs(on.lo) <= std::abs(1 - on.hi)) {
        keep_right(row, on.lo);
        keep_left(row, (on.hi - on.lo) / (1 - on.lo));
    } else {
        keep_left(row, on.hi);
        keep_right(row, on.lo / on.hi);
    }
    return b;
}

template <class P>
class Overlaps {
public:
    static constexpr int D = Space<P>::kDim;
    using Curve = PartTree<1, P>;

    // Lengths in the scale of the parts.
    Overlaps(const Curve& a, const Curve& b, double accuracy) : a_(a), b_(b), accuracy_(accuracy) {}

    // Exact coefficients of a pair of pieces, made when first asked for; null where there are none.
    ExactPair* exact(int pa, int pb) {
        if (pa == pa_ && pb == pb_ && asked_) return exact_ ? &*exact_ : nullptr;
        begin(pa, pb);
        asked_ = true;
        if constexpr (D == 2) {
            if (a_.source().error[std::size_t(pa)] == 0 && b_.source().error[std::size_t(pb)] == 0) {
                exact_.emplace(homogeneous(a_, pa), homogeneous(b_, pb));
                if (!exact_->is_bearable()) exact_.reset();
            }
        }
        return exact_ ? &*exact_ : nullptr;
    }
    // All contacts in a box of parameters in space; nothing where rounding is all that is known.
    std::optional<std::vector<ExactContact>> contacts_in_space(int pa, int pb, const Interval& a,
                                                               const Interval& b) const requires(D == 3) {
        if (a_.source().error[std::size_t(pa)] != 0 || b_.source().error[std::size_t(pb)] != 0)
            return std::nullopt;
        Vec<3> x, u, v;
        place(a_, pa, a.middle(), x, u);
        place(b_, pb, b.middle(), x, v);
        const Vec<3> n = cross(u, v);  // of the plane whose image without its largest coordinate is best
        int third = 0;
        for (const int k : {1, 2})
            if (std::abs(n[k]) > std::abs(n[third])) third = k;
        const auto lifted = [](const Curve& c, int piece) {
            std::vector<Hom<3>> h;
            for (int i = 0; i < c.block(); ++i) {
                const P& p = c.coefficients(piece)[i];
                h.push_back({{p[0], p[1], p[2], Space<P>::weight(p)}});
            }
            return h;
        };
        ExactPair pair(lifted(a_, pa), lifted(b_, pb), third);
        if (!pair.is_bearable()) return std::nullopt;
        return pair.contacts(a, b);
    }
    void begin(int pa, int pb) {
        if (pa == pa_ && pb == pb_) return;
        pa_ = pa, pb_ = pb, asked_ = looked_ = same_ = false;
        complete_ = true;
        exact_.reset();
        overlaps_.clear();
        isolated_.clear();
    }
    // Looks for overlaps of a pair of pieces, once.
    void stuck(int pa, int pb) {
        begin(pa, pb);
        if (looked_) return;
        looked_ = true;
        if (ExactPair* e = exact(pa, pb); e && e->coincide()) {
            same_ = true;
            if (const auto ends = e->ends()) join(*ends, true);
            return;
        }
        join(near_ends(), false);
    }
    // Do the parts have no contacts but those of overlaps, and isolated()?
    bool settled(int ia, int ib) const {
        if (!complete_ || (!same_ && overlaps_.empty())) return false;
        const Vec<D> u = a_.chord(ia, 0), v = b_.chord(ib, 0);
        const double sign = dot(u, v) < 0 ? -1 : 1;
        const Vec<D> c = norm(v) * u + sign * norm(u) * v;
        double size = 0;
        for (int k = 0; k < D; ++k) size += std::abs(c[k]);
        // Legs of a double control point at an end of the piece are 0 exactly: a curve may start with one.
        const auto moves_on = [&](const auto& points, const Curve& curve, int part, const Interval& covers,
                                  double s, double error) {
            const auto* p = curve.hull(curve[part].piece);
            const int n = curve.block();
            const int begin = n > 2 && covers.lo == 0 && p[0] == p[1],
                      end = n - 1 - (n > 2 && covers.hi == 1 && p[n - 2] == p[n - 1]);
            for (int i = begin; i < end; ++i)
                if (!(s * dot(c, points[std::size_t(i) + 1] - points[std::size_t(i)]) >
                      size * (2.02 * error + 8 * kUnitRoundoff)))
                    return false;
            return begin < end;
        };
        // The shorter part on the curve of the longer one, so that neither is continued far beyond its end.
        const bool first = a_[ia].extent() >= b_[ib].extent();
        const Curve &longer = first ? a_ : b_, &shorter = first ? b_ : a_;
        const int il = first ? ia : ib, is = first ? ib : ia;
        const double from = longer[il].from[0], w = longer[il].width[0], t = shorter[is].from[0],
                     width = shorter[is].width[0];
        Interval on{from, from + w};
        for (const double at : {t, t + 0.5 * width, t + width}) {
            double s = 0;
            if (!inverse(longer, il, shorter, is, at, s)) return false;
            on = hull(on, {s, s});
        }
        const double wider = 0.05 * on.length();
        on = {std::max(0.0, on.lo - wider), std::min(1.0, on.hi + wider)};
        if (!(on.length() > 0) || on.length() > 16 * std::max(w, width)) return false;
        const auto all = over(longer.coefficients(longer[il].piece), longer.block(), on);
        std::vector<Vec<D>> points;
        for (const P& p : all) points.push_back(Space<P>::project(p));
        const double grown = 64 * longer.block() * kUnitRoundoff + longer[longer[il].piece].error;
        return moves_on(points, longer, il, on, first ? 1 : sign, grown) &&
               moves_on(shorter.hull(is), shorter, is, {t, t + width}, first ? sign : 1, shorter[is].error);
    }

    // In parameters of the pieces.
    const std::vector<Overlap>& overlaps() const { return overlaps_; }
    // Ends that meet, of curves that are the same beyond: of one runs where the other does not. Exactly so if
    // the curves are, otherwise they are only near each other.
    const std::vector<ExactContact>& isolated() const { return isolated_; }

private:
    static std::vector<Hom<2>> homogeneous(const Curve& c, int piece) {
        std::vector<Hom<2>> h;
        for (int i = 0; i < c.block(); ++i) {
            const P& p = c.coefficients(piece)[i];
            if constexpr (Space<P>::kRational)
                h.push_back({{p[0], p[1], p[2]}});
            else
                h.push_back({{p[0], p[1], 1}});
        }
        return h;
    }
    static void place(const Curve& c, int piece, double t, Vec<D>& x, Vec<D>& d) { c.at(piece, &t, x, &d); }

    // The parameter of a curve, continued beyond its ends, where it passes by the point of the other; from
    // the middle of a part.
    bool inverse(const Curve& on, int part, const Curve& other, int other_part, double t, double& s) const {
        Vec<D> y, ignored, x, d;
        place(other, other[other_part].piece, t, y, ignored);
        const int piece = on[part].piece;
        s = on[part].from[0] + 0.5 * on[part].width[0];
        for (int i = 0; i < 32; ++i) {  // beside a cusp each step leaves a quarter
            place(on, piece, s, x, d);
            const double step = dot(y - x, d) / dot(d, d);
            if (!std::isfinite(step)) break;
            s = std::clamp(s + step, -1.0, 2.0);
            if (std::abs(step) <= 0x1p-50) break;
        }
        place(on, piece, s, x, d);
        return norm(y - x) <= 4 * reach();
    }

    // Does the other curve pass by an end? The feet that are near enough.
    void near_end(const Curve& from, int pf, double end, const Curve& to, int pt, bool first,
                  std::vector<ExactContact>& out) const {
        Vec<D> p, ignored, x, d;
        place(from, pf, end, p, ignored);
        const int samples = 4 * to.block();
        for (int i = 0; i <= samples; ++i) {
            double t = double(i) / samples;
            for (int k = 0; k < 12; ++k) {
                place(to, pt, t, x, d);
                const double step = dot(p - x, d) / dot(d, d);
                if (!std::isfinite(step)) break;
                t = std::clamp(t + step, 0.0, 1.0);
            }
            place(to, pt, t, x, d);
            if (norm(p - x) > reach()) continue;
            if (t < 0x1p-40) t = 0;
            if (t > 1 - 0x1p-40) t = 1;
            const ExactContact c =
                first ? ExactContact{{end, end}, {t, t}, 0} : ExactContact{{t, t}, {end, end}, 0};
            if (std::none_of(out.begin(), out.end(), [&](const ExactContact& o) {
                    return std::abs(o.a.lo - c.a.lo) + std::abs(o.b.lo - c.b.lo) < 0x1p-20;
                }))
                out.push_back(c);
        }
    }
    double reach() const {
        return std::max(accuracy_, 64 * (a_[pa_].error + b_[pb_].error) + 1024 * kUnitRoundoff);
    }
    std::vector<ExactContact> near_ends() const {
        std::vector<ExactContact> out;
        for (const double end : {0.0, 1.0}) {
            near_end(a_, pa_, end, b_, pb_, true, out);
            near_end(b_, pb_, end, a_, pa_, false, out);
        }
        return out;
    }

    // Of the tangent, at a cusp at an end, too; zero at others.
    static Vec<D> heading(const Curve& c, int piece, double t) {
        Vec<D> x, d;
        place(c, piece, t, x, d);
        const Vec<D>* p = c.hull(piece);
        const int last = c.block() - 1;
        for (int k = 1; k <= last && max_abs(d) == 0 && (t == 0 || t == 1); ++k)
            d = t == 0 ? p[k] - p[0] : p[last] - p[last - k];
        return max_abs(d) > 0x1p-20 * c[piece].extent() || t == 0 || t == 1 ? d : Vec<D>{};
    }
    // 1: b runs with a at this pair; -1: against; 0: neither, or not known.
    int direction(const ExactContact& c) {
        const Vec<D> u = heading(a_, pa_, c.a.middle()), v = heading(b_, pb_, c.b.middle());
        const double d = dot(u, v), size = norm(u) * norm(v);
        if (size == 0) complete_ = false;
        return d > 0.9 * size && d > 0 ? 1 : d < -0.9 * size && d < 0 ? -1 : 0;
    }

    void join(std::vector<ExactContact> ends, bool exact) {
        sort(ends.begin(), ends.end(), [](const auto& x, const auto& y) { return x.a.lo < y.a.lo; });
        std::vector<char> used(ends.size());
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const ExactContact& from = ends[i];
            const int way = direction(from);
            const auto goes = [&](const ExactContact& c, int up) {
                return (up > 0 ? c.a.hi < 1 : c.a.lo > 0) && (up * way > 0 ? c.b.hi < 1 : c.b.lo > 0);
            };
            if (way == 0 || (!exact && is_within_one(from))) continue;
            if (!goes(from, 1)) {
                if (!goes(from, -1)) isolated_.push_back(from);
                // The same curve on the left, and not from any begin: one of them turns round.
                if (exact && goes(from, -1) && !used[i]) complete_ = false;
                continue;
            }
            bool ended = false;
            for (std::size_t k = i + 1; k < ends.size(); ++k) {
                const ExactContact& to = ends[k];
                if (direction(to) != way || !goes(to, -1) || way * (to.b.lo - from.b.lo) <= 0) continue;
                const double t0 = simplest(from.b), t1 = simplest(to.b);
                Overlap o{
                    {simplest(from.a), simplest(to.a)}, {std::min(t0, t1), std::max(t0, t1)}, way < 0, 0};
                if (!exact) o.gap = distance(o);
                if (exact ? is_followed(o) : o.gap <= reach()) {
                    overlaps_.push_back(o);
                    used[k] = ended = true;
                }
                if (ended || !exact) break;
            }
            if (exact && !ended) complete_ = false;
        }
    }

    bool is_within_one(const ExactContact& c) const {
        return std::any_of(overlaps_.begin(), overlaps_.end(), [&](const Overlap& o) {
            const double x = (c.a.lo - o.a.lo) / o.a.length(), y = (c.b.lo - o.b.lo) / o.b.length();
            return o.a.overlaps(c.a) && o.b.overlaps(c.b) && std::abs(x - (o.reversed ? 1 - y : y)) < 0.25;
        });
    }
    // Does each curve stay with the other, as far as a few points say? It need not if one turns round.
    bool is_followed(const Overlap& o) const {
        constexpr int kPoints = 8;
        const auto stays = [&](const Curve& from, int pf, const Interval& s, const Curve& to, int pt,
                               const Interval& on) {
            Vec<D> p, x, d;
            for (int i = 1; i < kPoints; ++i) {
                place(from, pf, s.lo + s.length() * i / kPoints, p, d);
                bool found = false;
                for (int k = 0; k <= kPoints && !found; ++k) {
                    double t = on.lo + on.length() * k / kPoints;
                    for (int n = 0; n < 12 && !found; ++n) {
                        place(to, pt, t, x, d);
                        found = norm(p - x) <= reach();
                        const double step = dot(p - x, d) / dot(d, d);
                        if (!std::isfinite(step)) break;
                        t = clamped(t + step, on);
                    }
                }
                if (!found) return false;
            }
            return true;
        };
        return stays(a_, pa_, o.a, b_, pb_, o.b) && stays(b_, pb_, o.b, a_, pa_, o.a);
    }

    // A bound of how far the curves are from each other over these intervals, from their control points.
    double distance(const Overlap& o) const {
        std::vector<P> x = over(a_.coefficients(pa_), a_.block(), o.a),
                       y = over(b_.coefficients(pb_), b_.block(), o.b);
        if (o.reversed) std::reverse(y.begin(), y.end());
        const auto raise = [](std::vector<P>& b) {
            const int n = int(b.size());
            b.push_back(b.back());
            for (int i = n - 1; i > 0; --i)
                b[std::size_t(i)] =
                    (double(i) / n) * b[std::size_t(i) - 1] + (double(n - i) / n) * b[std::size_t(i)];
        };
        while (x.size() < y.size()) raise(x);
        while (y.size() < x.size()) raise(y);
        double most = 0, uneven = 0, size = 0;
        const int n = int(x.size()) - 1;
        if (Space<P>::kRational && n > 0) {
            // Weights up to a common factor and a change of the parameter that keeps the ends.
            const auto w = [](const P& p) { return Space<P>::weight(p); };
            const double k = w(x[0]) / w(y[0]),
                         c = std::pow(w(x[std::size_t(n)]) / w(x[0]) / (w(y[std::size_t(n)]) / w(y[0])),
                                      1.0 / n);
            double factor = k;
            for (P& p : y) p *= factor, factor *= c;
        }
        for (int i = 0; i <= n; ++i) {
            const auto &p = x[std::size_t(i)], &q = y[std::size_t(i)];
            const Vec<D> u = Space<P>::project(p), v = Space<P>::project(q);
            most = std::max(most, norm(u - v));
            size = std::max(size, max_abs(u));
            uneven =
                std::max(uneven, std::abs(Space<P>::weight(p) - Space<P>::weight(q)) / Space<P>::weight(p));
        }
        // A mean of the v with weights that are off by a factor 1 +- uneven is off by 2 uneven of their size.
        const double rounding = 2 * (a_[pa_].error + b_[pb_].error) + 32 * (n + 2) * kUnitRoundoff;
        return 1.01 * (most + 4 * uneven * size * D + D * rounding);
    }

    const Curve &a_, &b_;
    double accuracy_;
    int pa_ = -1, pb_ = -1;
    bool asked_ = false, looked_ = false, same_ = false;
    bool complete_ = true;  // it is known of all ends that meet whether an overlap begins there
    std::optional<ExactPair> exact_;
    std::vector<Overlap> overlaps_;
    std::vector<ExactContact> isolated_;
};

}  // namespace freiform::detail

// Contacts of two curves: subdivision, a proof of uniqueness, Newton's method, and integers for the rest.
//
// Idea. F(s, t) = A(s) - B(t) has at most one zero where its derivative differs little from one matrix: with
// Y the inverse of the matrix of the chords, |1 - Y F'| <= q < 1 over both parts. Then the mean value theorem
// says how far the zero can be from any point, x - x0 = -Y F(x0) + (1 - Y F')(x - x0): whether there is one,
// and in which box, is known from one value of F. That is the operator of Krawczyk. Parts shorter by a half
// have half the q, so a few halvings do where curves cross at an angle.
//
// Notation. Parts are halves of Bezier pieces (parts_detail.hpp); r_k are linear functions that vanish on all
// columns of the chord matrix but one, so Y = r / det.
//
// Method. For pairs of parts, from a stack:
//   - apart: boxes, then the r_k, which are the normals of both chords: quadratically tight. If chords
//     are parallel, also along the chord; in space along the common normal.
//   - at most one zero: Newton's method from where the chords meet gives x0. No zero if the interval of some
//     parameter is outside of its part; one if the ball around x0 is inside of the part, made longer by 2^-20
//     at each end, over which the derivative changes by no more than 2^-16 n of itself. A zero
//     beside a common end of parts is so found by both, and counted once, because it is unique in both.
//   - given up: parts that are flat within rounding, or as small. Neighbours are united to clusters.
//   - otherwise the larger part is halved.
// Clusters, zeros within rounding of an end, and those whose box is wider than kWidest since the curves cross
// at a small angle, are decided in integers where the coefficients are those given (exact_pair.cpp). Curves
// that run along each other would be cut into parts that are flat within rounding, 10^8 of them: if a pair of
// pieces takes long, overlaps are looked for and set aside (overlap_detail.hpp).
// What integers leave open too, as where the tips of cusps meet, is halved on to the size of rounding. Pieces
// on both sides of a knot find the same zero, or both a zero beyond their end: if both cross the same way,
// one follows from continuity.
//
// In space, Y is an inverse from the left. Zeros of Y F are unique as before; F itself does not vanish there
// unless by chance, which is reported with the gap. Curves of one plane of space are intersected in their
// image without one coordinate (query/self_contact.cpp has the same).
//
// Symmetry. The curves are ordered by their coefficients first, and results exchanged back.
//
// Accuracy. Errors of control points as in parts_detail.hpp; values at the ends of a chain of comparisons
// carry 1.01 for their own rounding. Coordinates are scaled to at most 1 by a power of two.
//
// Cost. Two cubics that cross once: about 1 us. A tangent contact: some 200 pairs of parts, then a
// millisecond in integers.
//
// References. [Krawczyk 1969], [Sederberg Nishita 1990], [Neumaier 1990].
//
// Why not Bezier clipping? It needs the same proofs at its end, converges only linearly for a pair of
// parts that holds two zeros, and its clipped parts are no dyadic ones that pairs could share.
#include "contacts_detail.hpp"
#include "overlap_detail.hpp"
#include "piece_pairs_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/intersect/curve_curve.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

std::string_view name_of(ContactKind kind) {
    constexpr std::string_view kNames[] = {"crossing", "tangent", "end", "possible"};
    return kNames[int(kind)];
}

namespace {

using namespace detail;

constexpr double kWidest =
    0x1p-38;  // box of a zero in parameters of pieces; wider ones are a case in thousands

template <class P>
class CurvePair {
public:
    static constexpr int D = Space<P>::kDim;
    using Answer = Intersections<D, 2>;

    Answer run(const ArcPieces<1, P>& a, const ArcPieces<1, P>& b, const IntersectOptions& options) {
        const int e = std::max(a.exponents.point, b.exponents.point);
        exponent_ = e < -1090 ? 0 : e;
        a_.reset(a, exponent_);
        b_.reset(b, exponent_);
        raw_.clear();
        answer_ = {};
        Overlaps<P> overlaps(a_, b_, std::scalbn(options.accuracy, -exponent_));
        const auto look = [&](int i, int j) {
            search_.look_at(i, j, options.max_parts, overlaps);
            if (search_.found().empty() && search_.open().empty() && overlaps.overlaps().empty()) return;
            overlaps.begin(i, j);
            take(i, j, overlaps);
        };
        if (a.pieces() == 1 && b.pieces() == 1) {
            look(0, 0);
        } else {
            tree_a_.reset(a_);
            tree_b_.reset(b_);
            tree_a_.each_pair(tree_b_, look);
        }
        answer_.contacts = joined(std::move(raw_));
        raw_ = {};
        chain_overlaps();
        return std::move(answer_);
    }

private:
    using Boxes = std::array<Interval, 2>;

    // Is this end of a piece an end of a curve?
    static bool is_open_end(const ArcPieces<1, P>& c, int piece, int end) {
        const int n = c.pieces();
        if (end == 0) return piece == 0 ? !c.closed[0] : c.jump[std::size_t(piece)];
        return piece + 1 == n ? !c.closed[0] : c.jump[std::size_t(piece) + 1];
    }

    static bool is_at_end(const Simple<2>& s) {
        return s.box[0].lo <= 0 || s.box[0].hi >= 1 || s.box[1].lo <= 0 || s.box[1].hi >= 1;
    }
    static bool is_unclear(const Simple<2>& s) {
        return is_at_end(s) || std::max(s.box[0].length(), s.box[1].length()) > kWidest;
    }

    static bool is_left_open(int i, int j, const Simple<2>& s, Overlaps<P>& overlaps) {
        return D == 3 || (is_unclear(s) && overlaps.exact(i, j));
    }

    void take(int i, int j, Overlaps<P>& overlaps) {
        exact_.clear();
        std::vector<Boxes> unclear;
        for (const Simple<2>& s : search_.found()) {
            if (is_left_open(i, j, s, overlaps))
                unclear.push_back(s.box);
            else
                add_simple(i, j, s, is_at_end(s));
        }
        std::vector<Boxes> undecided;
        // Parts that coincide are settled only after overlaps were looked for.
        if (search_.open().size() > 0 &&
            (overlaps.exact(i, j) ? overlaps.exact(i, j)->coincide() : search_.open().size() > 8))
            overlaps.stuck(i, j);
        for (const Open<2>& o : search_.open())
            if (!overlaps.settled(o.part_a, o.part_b)) (o.over_budget ? undecided : unclear).push_back(o.box);
        for (const Boxes& box : clusters(unclear)) decide(i, j, box, overlaps);
        for (const Boxes& box : clusters(undecided))
            answer_.undecided.push_back(freiform::detail::global(where(i, j), box));
        if (const auto& isolated = overlaps.isolated(); !isolated.empty()) {
            const bool same = overlaps.exact(i, j) && overlaps.exact(i, j)->coincide();
            for (const ExactContact& c : isolated) add_exact(i, j, c, same);
        }
        for (const Overlap& o : overlaps.overlaps()) {
            Overlap g = o;
            for (double* t : {&g.a.lo, &g.a.hi}) *t = freiform::detail::global(on(a_, i), *t);
            for (double* t : {&g.b.lo, &g.b.hi}) *t = freiform::detail::global(on(b_, j), *t);
            g.gap = std::scalbn(o.gap, exponent_);
            answer_.overlaps.push_back(g);
        }
    }
    static Interval on(const PartTree<1, P>& p, int i) { return p.source().box(i)[0]; }
    Where<2> where(int i, int j) const {
        const auto &a = a_.source(), &b = b_.source();
        return {{on(a_, i), on(b_, j)}, {a.domain[0], b.domain[0]}, {a.closed[0], b.closed[0]}};
    }

    void decide(int i, int j, Boxes box, Overlaps<P>& overlaps) {
        for (Interval& t : box) t = {std::max(0.0, t.lo), std::min(1.0, t.hi)};
        std::optional<std::vector<ExactContact>> found;
        if constexpr (D == 3)
            found = overlaps.contacts_in_space(i, j, box[0], box[1]);
        else if (ExactPair* e = overlaps.exact(i, j))
            found = e->contacts(box[0], box[1]);
        if (found) {
            for (const ExactContact& c : *found)
                if (D == 3 || !is_known(c)) add_exact(i, j, c);
            return;
        }
        // Zeros that are known, but at an end, are open as well.
        std::vector<Boxes> left{box};
        if (auto narrow = search_.narrowed(box)) {
            left = *std::move(narrow);
            for (const Simple<2>& s : search_.found())
                if (is_left_open(i, j, s, overlaps) && touch(s.box, box)) left.push_back(s.box);
        }
        for (const Boxes& b : clusters(left)) add_possible(i, j, b, overlaps);
    }
    void add_possible(int i, int j, const Boxes& box, Overlaps<P>& overlaps) {
        Raw<D, 2> r;
        r.c.box = box;
        r.c.at = nearest(i, j, box);
        r.c.least = 0;
        r.c.most = std::max(1, (a_.block() - 1) * (b_.block() - 1));
        r.c.multiplicity = 0;
        const bool whole = box[0] == Interval{0, 1} || box[1] == Interval{0, 1};
        r.c.kind = !whole && reaches_end(i, j, box) ? ContactKind::end : ContactKind::possible;
        if constexpr (D == 2)
            if (ExactPair* e = overlaps.exact(i, j); e && !e->coincide()) begin_at_end(*e, r.c);
        finish(i, j, r);
    }
    // Ends that lie on the other curve are known exactly, cusps and curves that fold along a line included.
    static void begin_at_end(ExactPair& exact, Contact<D, 2>& c) {
        std::vector<ExactContact> ends = exact.ends().value_or(std::vector<ExactContact>());
        std::erase_if(ends, [&](const ExactContact& e) { return !touch(c.box, Boxes{e.a, e.b}); });
        if (ends.empty()) return;
        const ExactContact& first = *std::min_element(
            ends.begin(), ends.end(), [](const auto& x, const auto& y) { return x.a.lo < y.a.lo; });
        c.at = {simplest(first.a), simplest(first.b)};
        c.box = {hull(c.box[0], first.a), hull(c.box[1], first.b)};
        c.least = 1;
    }
    bool is_known(const ExactContact& c) const {
        return std::any_of(search_.found().begin(), search_.found().end(), [&](const Simple<2>& s) {
            return !is_unclear(s) && s.box[0].overlaps(c.a) && s.box[1].overlaps(c.b);
        });
    }
    bool reaches_end(int i, int j, const Boxes& t) const {
        const auto reaches = [](const ArcPieces<1, P>& c, int piece, const Interval& x) {
            const bool small = x.length() < 0x1p-8 || x == Interval{0, 1};
            return small &&
                   ((x.lo <= 0 && is_open_end(c, piece, 0)) || (x.hi >= 1 && is_open_end(c, piece, 1)));
        };
        return reaches(a_.source(), i, t[0]) || reaches(b_.source(), j, t[1]);
    }

    void add_simple(int i, int j, const Simple<2>& s, bool at_end) {
        Raw<D, 2> r;
        r.c.kind = s.exists ? ContactKind::crossing : ContactKind::possible;
        r.c.least = s.exists;
        r.c.multiplicity = s.exists;
        r.sign = s.sign;
        r.c.box = s.box;
        r.c.at = s.at;
        if (at_end && reaches_end(i, j, s.box)) {
            r.c.kind = ContactKind::end;
            r.c.least = 0;
            r.c.multiplicity = 0;
        } else {
            r.at_joint = at_end;
        }
        finish(i, j, r);
    }
    void add_exact(int i, int j, const ExactContact& c, bool proven = true) {
        // Clusters side by side may both reach to it.
        for (const ExactContact& o : exact_)
            if (o.a == c.a && o.b == c.b) return;
        exact_.push_back(c);
        Raw<D, 2> r;
        r.c.box = {c.a, c.b};
        r.c.at = {simplest(c.a), simplest(c.b)};
        r.c.multiplicity = c.multiplicity;
        r.c.least = proven;
        const bool end =
            (c.a.lo == c.a.hi || c.b.lo == c.b.hi || c.a == Interval{0, 1} || c.b == Interval{0, 1}) &&
            reaches_end(i, j,
                        {c.a.lo == c.a.hi || c.a == Interval{0, 1} ? c.a : Interval{0.5, 0.5},
                         c.b.lo == c.b.hi || c.b == Interval{0, 1} ? c.b : Interval{0.5, 0.5}});
        r.c.kind = end                   ? ContactKind::end
                   : c.multiplicity == 1 ? ContactKind::crossing
                                         : ContactKind::tangent;
        finish(i, j, r, true);
    }

    void finish(int i, int j, Raw<D, 2> r, bool exact = false) {
        for (std::size_t k = 0; k < 2; ++k) r.c.at[k] = std::clamp(r.c.at[k], 0.0, 1.0);
        Vec<D> x, y, u, v;
        const Where<2> on = where(i, j);
        const double e = a_.at(i, &r.c.at[0], x, &u) + b_.at(j, &r.c.at[1], y, &v);
        set_point(r, x, y,
                  e + parameter_rounding(on.piece[0]) * norm(u) + parameter_rounding(on.piece[1]) * norm(v),
                  exponent_);
        if constexpr (D == 2)
            if (exact && r.c.multiplicity == 1) r.sign = cross(u, v) < 0 ? 1 : -1;
        r.from = {i, j, 0};
        move_to_objects(r, on);
        raw_.push_back(r);
    }

    // Parameters of a box with a small distance, by the method of Gauss and Newton, damped.
    std::array<double, 2> nearest(int i, int j, const Boxes& box) const {
        std::array<double, 2> best{box[0].middle(), box[1].middle()};
        double least = kInfinity, damping = 1e-3;
        std::array<double, 2> t = best;
        Vec<D> x, y, u, v, f{}, bu{}, bv{};
        for (int k = 0; k < 40; ++k) {
            a_.at(i, &t[0], x, &u);
            b_.at(j, &t[1], y, &v);
            const double d = norm(x - y);
            damping = d < least ? damping / 4 : damping * 8;
            if (d < least) least = d, best = t, f = x - y, bu = u, bv = v;
            const double uu = dot(bu, bu) * (1 + damping), vv = dot(bv, bv) * (1 + damping), uv = dot(bu, bv),
                         det = uu * vv - uv * uv, fu = dot(f, bu), fv = dot(f, bv);
            if (!(det > 0) || least == 0) break;
            t = {clamped(best[0] - (fu * vv - fv * uv) / det, box[0]),
                 clamped(best[1] + (fv * uu - fu * uv) / det, box[1])};
        }
        return best;
    }

    // Overlaps that go on over a knot are one.
    void chain_overlaps() {
        auto& all = answer_.overlaps;
        sort(all.begin(), all.end(), [](const Overlap& x, const Overlap& y) {
            return x.a.lo != y.a.lo ? x.a.lo < y.a.lo : x.b.lo < y.b.lo;
        });
        const double sa = slack(a_.source()), sb = slack(b_.source());
        std::vector<Overlap> out;
        std::vector<std::array<double, 2>> joints;  // where one goes on as the next
        for (const Overlap& o : all) {
            const auto before = std::find_if(out.begin(), out.end(), [&](const Overlap& p) {
                return p.reversed == o.reversed && std::abs(p.a.hi - o.a.lo) <= sa &&
                       std::abs(o.reversed ? p.b.lo - o.b.hi : p.b.hi - o.b.lo) <= sb;
            });
            if (before == out.end()) {
                out.push_back(o);
                continue;
            }
            joints.push_back({o.a.lo, o.reversed ? o.b.hi : o.b.lo});
            before->a = hull(before->a, o.a);
            before->b = hull(before->b, o.b);
            before->gap = std::max(before->gap, o.gap);
        }
        all = std::move(out);
        // Ends of pieces that meet where overlaps go on are no contacts of their own.
        std::erase_if(answer_.contacts, [&](const Contact<D, 2>& c) {
            return std::ranges::any_of(joints, [&](const std::array<double, 2>& t) {
                return c.box[0].lo >= t[0] - sa && c.box[0].hi <= t[0] + sa && c.box[1].lo >= t[1] - sb &&
                       c.box[1].hi <= t[1] + sb;
            });
        });
        // Small boxes beside an overlap belong to it; a large one may hold more.
        const auto is_small = [](const Interval& t, const ArcPieces<1, P>& c) {
            return t.length() <= 0x1p-6 * c.domain[0].length();
        };
        std::erase_if(answer_.contacts, [&](const Contact<D, 2>& c) {
            return std::any_of(all.begin(), all.end(), [&](const Overlap& o) {
                const Interval a{o.a.lo - sa, o.a.hi + sa}, b{o.b.lo - sb, o.b.hi + sb};
                if (!a.contains(c.at[0]) || !b.contains(c.at[1])) return false;
                if (!is_small(c.box[0], a_.source()) || !is_small(c.box[1], b_.source())) return false;
                const double s = (c.at[0] - o.a.lo) / o.a.length(), t = (c.at[1] - o.b.lo) / o.b.length();
                return std::abs((o.reversed ? 1 - t : t) - s) < 1e-6 && !c.is_proven();
            });
        });
    }
    static double slack(const ArcPieces<1, P>& c) {
        return 0x1p-40 * std::max(std::abs(c.domain[0].lo), std::abs(c.domain[0].hi));
    }

    PartTree<1, P> a_, b_;
    Search<PartTree<1, P>, PartTree<1, P>> search_{a_, b_};
    BoxTree<D> tree_a_, tree_b_;
    int exponent_ = 0;
    std::vector<Raw<D, 2>> raw_;
    std::vector<ExactContact> exact_;  // of the pair of pieces at hand
    Answer answer_;
};

// Which of the curves comes first, whatever order they are given in?
template <class P>
bool is_before(const ArcPieces<1, P>& a, const ArcPieces<1, P>& b) {
    if (a.points.size() != b.points.size()) return a.points.size() < b.points.size();
    for (std::size_t i = 0; i < a.points.size(); ++i)
        if (a.points[i] != b.points[i]) return a.points[i].c < b.points[i].c;
    return a.breaks < b.breaks;
}

template <class P>
Intersections<Space<P>::kDim, 2> pair_of(CurvePair<P>& work, const ArcPieces<1, P>& a,
                                         const ArcPieces<1, P>& b, const IntersectOptions& options) {
    const bool swap = is_before(b, a);
    auto answer = swap ? work.run(b, a, options) : work.run(a, b, options);
    if (swap) exchange(answer);
    return answer;
}

}  // namespace

template <class P>
IntersectCurve<P>::IntersectCurve(const Curve<P>& curve)
    : pieces_(std::make_shared<const ArcPieces<1, P>>(arc_pieces(curve))) {}

template <class P>
requires(Space<P>::kDim == 2 || Space<P>::kDim == 3) Result < Intersections < Space<P>::kDim,
2 >> intersect(const Curve<P>& a, const Curve<P>& b, const IntersectOptions& options) {
    if (auto ok = check_accuracy(options); !ok) return std::unexpected(ok.error());
    CurvePair<P> work;
    return pair_of(work, arc_pieces(a), arc_pieces(b), options);
}

template <class P>
requires(Space<P>::kDim == 2 ||
         Space<P>::kDim == 3) Result<void> intersect(std::span<const IntersectCurve<P>> a,
                                                     std::span<const IntersectCurve<P>> b,
                                                     std::span<Intersections<Space<P>::kDim, 2>> out,
                                                     const IntersectOptions& options) {
    FF_REQUIRE(a.size() == b.size() && a.size() == out.size());
    if (auto ok = check_accuracy(options); !ok) return ok;
    constexpr std::size_t kChunk = 64;
    parallel_for((a.size() + kChunk - 1) / kChunk, 4, [&](std::size_t chunk) {
        CurvePair<P> work;
        for (std::size_t i = chunk * kChunk; i < std::min(a.size(), (chunk + 1) * kChunk); ++i)
            out[i] = pair_of(work, a[i].pieces(), b[i].pieces(), options);
    });
    return {};
}

#define FF_INTERSECT(P)                                                                                     \
    template class IntersectCurve<P>;                                                                       \
    template Result<Intersections<Space<P>::kDim, 2>> intersect(const Curve<P>&, const Curve<P>&,           \
                                                                const IntersectOptions&);                   \
    template Result<void> intersect(std::span<const IntersectCurve<P>>, std::span<const IntersectCurve<P>>, \
                                    std::span<Intersections<Space<P>::kDim, 2>>, const IntersectOptions&);
FF_INTERSECT(Vec<2>)
FF_INTERSECT(Hom<2>)
FF_INTERSECT(Vec<3>)
FF_INTERSECT(Hom<3>)
#undef FF_INTERSECT

}  // namespace freiform

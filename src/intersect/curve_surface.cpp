// Contacts of a curve and a surface: the search of curve_curve.cpp with three parameters.
//
// Idea. F(t, u, v) = C(t) - S(u, v) has three equations for three unknowns; uniqueness, existence and what
// is apart are seen as for two plane curves, with the chords of the patch along u and v as columns. The rows
// of the adjoint matrix are the normal of the patch and two directions across the curve.
//
// Method. As in curve_curve.cpp. Roots on both sides of a knot line are joined, at a corner of four patches
// those of all four. What rounding leaves open stays open: there is no implicit form of a surface here
// that integers could bear.
//
// A line is cut to where it may meet the box of the surface, and is then a curve of degree 1.
//
// Cost. A line and a bicubic patch that it goes through once: about 5 us.
//
// References. [Neumaier 1990].
//
// Why not two equations for a line, the distances from two planes through it? It would be a second search;
// Newton's method takes the third parameter along for nothing.
#include "contacts_detail.hpp"
#include "piece_pairs_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/intersect/curve_surface.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using namespace detail;

// Nothing is set aside.
struct NoPrune {
    void stuck(int, int) {}
    bool settled(int, int) const { return false; }
};

template <class P>
class CurveSurface {
public:
    using Answer = Intersections<3, 3>;

    Answer run(const ArcPieces<1, P>& c, const ArcPieces<2, P>& s, const IntersectOptions& options) {
        const int e = std::max(c.exponents.point, s.exponents.point);
        exponent_ = e < -1090 ? 0 : e;
        curve_.reset(c, exponent_);
        surface_.reset(s, exponent_);
        raw_.clear();
        answer_ = {};
        tree_curve_.reset(curve_);
        tree_surface_.reset(surface_);
        NoPrune none;
        tree_curve_.each_pair(tree_surface_, [&](int i, int j) {
            search_.look_at(i, j, options.max_parts, none);
            take(i, j);
        });
        answer_.contacts = joined(std::move(raw_));
        raw_ = {};
        return std::move(answer_);
    }

private:
    using Boxes = std::array<Interval, 3>;

    Where<3> where(int i, int j) const {
        const auto& c = curve_.source();
        const auto& s = surface_.source();
        const auto patch = s.box(j);
        return {{c.box(i)[0], patch[0], patch[1]},
                {c.domain[0], s.domain[0], s.domain[1]},
                {c.closed[0], s.closed[0], s.closed[1]}};
    }

    void take(int i, int j) {
        for (const Simple<3>& s : search_.found()) {
            Raw<3, 3> r;
            r.c.kind = ContactKind::crossing;
            r.c.box = s.box;
            r.c.at = s.at;
            r.sign = s.sign;
            for (const Interval& t : s.box) r.at_joint = r.at_joint || t.lo <= 0 || t.hi >= 1;
            if (r.at_joint && reaches_boundary(i, j, s.box)) {
                r.at_joint = false;
                r.c.kind = ContactKind::end;
                r.c.least = r.c.multiplicity = 0;
            }
            finish(i, j, r);
        }
        std::vector<Boxes> unclear, undecided;
        for (const Open<3>& o : search_.open()) (o.over_budget ? undecided : unclear).push_back(o.box);
        for (const Boxes& box : clusters(unclear)) {
            Raw<3, 3> r;
            r.c.box = box;
            for (std::size_t k = 0; k < 3; ++k) r.c.at[k] = box[k].middle();
            r.c.least = r.c.multiplicity = 0;
            // As many as Bezout's theorem allows for one piece and one patch.
            const auto& d = surface_.source().degree;
            r.c.most = std::max(1, 2 * d[0] * d[1] * curve_.source().degree[0]);
            finish(i, j, r);
        }
        for (const Boxes& box : clusters(undecided))
            answer_.undecided.push_back(detail::global(where(i, j), box));
    }

    bool reaches_boundary(int i, int j, const Boxes& t) const {
        const Where<3> at = where(i, j);
        for (std::size_t k = 0; k < 3; ++k) {
            if (at.closed[k]) continue;
            if ((t[k].lo <= 0 && at.piece[k].lo == at.domain[k].lo) ||
                (t[k].hi >= 1 && at.piece[k].hi == at.domain[k].hi))
                return true;
            if (k == 0 &&
                ((t[0].lo <= 0 && curve_.source().jump[std::size_t(i)]) ||
                 (t[0].hi >= 1 && i + 1 < curve_.pieces() && curve_.source().jump[std::size_t(i) + 1])))
                return true;
        }
        return false;
    }

    void finish(int i, int j, Raw<3, 3> r) {
        for (double& t : r.c.at) t = std::clamp(t, 0.0, 1.0);
        const Where<3> on = where(i, j);
        Vec<3> x, y, d[3];
        double e = curve_.at(i, &r.c.at[0], x, d) + surface_.at(j, &r.c.at[1], y, d + 1);
        for (std::size_t k = 0; k < 3; ++k) e += parameter_rounding(on.piece[k]) * norm(d[k]);
        set_point(r, x, y, e, exponent_);
        r.from = {i, j, 0};
        move_to_objects(r, on);
        raw_.push_back(r);
    }

    PartTree<1, P> curve_;
    PartTree<2, P> surface_;
    Search<PartTree<1, P>, PartTree<2, P>> search_{curve_, surface_};
    BoxTree<3> tree_curve_, tree_surface_;
    int exponent_ = 0;
    std::vector<Raw<3, 3>> raw_;
    Answer answer_;
};

// The parameters at which a line may be in a box, and an eighth of its size more: a line cut to a flat
// surface would be a point, whose direction is all rounding.
Interval inside(const StraightLine& line, const Box<3>& box) {
    Interval t = line.on;
    for (int k = 0; k < 3; ++k) {
        const double d = line.direction[k], size = std::max(box.scale(), std::abs(line.point[k]));
        const double more = std::max(0.125 * max_abs(box.hi - box.lo), 0x1p-40 * size);
        const double lo = box.lo[k] - line.point[k] - more, hi = box.hi[k] - line.point[k] + more;
        if (d == 0) {
            if (lo > 0 || hi < 0) return {1, 0};
            continue;
        }
        t = {std::max(t.lo, std::min(lo / d, hi / d)), std::min(t.hi, std::max(lo / d, hi / d))};
    }
    return t;
}

}  // namespace

Result<void> check_line(const StraightLine& line, std::size_t i) {
    const std::string where = text("lines[", i, "]");
    if (!is_finite(line.point) || !is_finite(line.direction))
        return refuse(RefusalKind::nonfinite, where, "has a number that is not finite");
    if (max_abs(line.direction) == 0) return refuse(RefusalKind::invalid, where, "has no direction");
    if (!(line.on.lo < line.on.hi))
        return refuse(RefusalKind::invalid, where, text("runs over [", line.on.lo, ", ", line.on.hi, "]"));
    return {};
}

template <class P>
requires(Space<P>::kDim == 3) Result<Intersections<3, 3>> intersect(const Curve<P>& curve,
                                                                    const Surface<P>& surface,
                                                                    const IntersectOptions& options) {
    if (auto ok = check_accuracy(options); !ok) return std::unexpected(ok.error());
    return CurveSurface<P>().run(arc_pieces(curve), arc_pieces(surface), options);
}

template <class P>
IntersectSurface<P>::IntersectSurface(const Surface<P>& surface)
    : pieces_(std::make_shared<const ArcPieces<2, P>>(arc_pieces(surface))) {}

template <class P>
Result<void> IntersectSurface<P>::intersect(std::span<const StraightLine> lines,
                                            std::span<Intersections<3, 3>> out,
                                            const IntersectOptions& options) const {
    FF_REQUIRE(lines.size() == out.size());
    if (auto ok = check_accuracy(options); !ok) return ok;
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (auto ok = check_line(lines[i], i); !ok) return ok;
    Box<3> box;
    for (const P& p : pieces_->points) box.add(Space<P>::project(p));
    constexpr std::size_t kChunk = 16;
    parallel_for((lines.size() + kChunk - 1) / kChunk, 4, [&](std::size_t chunk) {
        CurveSurface<P> work;
        for (std::size_t i = chunk * kChunk; i < std::min(lines.size(), (chunk + 1) * kChunk); ++i) {
            out[i] = {};
            const Interval on = inside(lines[i], box);
            const bool beyond = !std::isfinite(on.lo) || !std::isfinite(on.hi);  // doubles, not the surface
            if (!beyond && !(on.lo < on.hi)) continue;
            const auto basis = BSplineBasis::bezier(1, on);
            const auto end = [&](double t) {
                return Space<P>::lift(lines[i].point + t * lines[i].direction, 1);
            };
            if (beyond || !basis)
                out[i].undecided.push_back({on, pieces_->domain[0], pieces_->domain[1]});
            else
                out[i] = work.run(
                    arc_pieces(Curve<P>::trusted({*basis}, Net<1, P>({2}, {end(on.lo), end(on.hi)}))),
                    *pieces_, options);
        }
    });
    return {};
}

template <class P>
Result<Intersections<3, 3>> IntersectSurface<P>::intersect(const StraightLine& line,
                                                           const IntersectOptions& options) const {
    Intersections<3, 3> out;
    if (auto done = intersect(std::span(&line, 1), std::span(&out, 1), options); !done)
        return std::unexpected(done.error());
    return out;
}

template Result<Intersections<3, 3>> intersect(const Curve<Vec<3>>&, const Surface<Vec<3>>&,
                                               const IntersectOptions&);
template Result<Intersections<3, 3>> intersect(const Curve<Hom<3>>&, const Surface<Hom<3>>&,
                                               const IntersectOptions&);
template class IntersectSurface<Vec<3>>;
template class IntersectSurface<Hom<3>>;

}  // namespace freiform

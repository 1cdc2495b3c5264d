// What a pen covers: loops around runs of arcs, joins and caps, united by their winding numbers.
//
// Idea. The pen along a line or an arc covers a ring sector, whose sides are known exactly. Everything is cut
// into such parts, each a loop that runs counter-clockwise, and what is inside of any of them is the answer:
// the region of the sum of all loops by the rule nonzero, since nothing is wound negatively.
//
// Notation. A frame is the pen at a joint: from left, P + h N, to right, P - h N.
//
//     left  o-------o-----.          runs: parts one after the other, with the same tangent at the joints,
//     and
//           |       |      \               radii above h: one loop along the right side and back on the left
//         P x---->--x--->   o        tight: radius R <= h; the pen passes over the centre c of the arc. Two
//           |       |      /               pies about c, of the radii R + h and h - R
//     right o-------o-----'
//
// Frames. Parts that end at a joint have the pen there as a common side, and have it exactly: with P on it,
// and the centres of tight parts beside it, as corners in between. So they cancel, and nothing is left to
// rounding.
//
// References. SVG 2, section 13.5, for joins, caps and dashes; [Bolton 1975] for the arcs.
//
// Why not the outline of both sides at once, with the rule nonzero? Where the radius is below h the inner
// side runs backwards, and takes away from what other parts cover.
#include "arc_chain_detail.hpp"
#include "arcs_join_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/region/stroke.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using namespace detail;

struct Frame {
    std::vector<Vec<2>> points;  // from left to right
    std::size_t p = 0;           // index of the joint

    const Vec<2>& left() const { return points.front(); }
    const Vec<2>& right() const { return points.back(); }
    std::size_t index(const Vec<2>& q) const {
        return std::size_t(std::ranges::find(points, q) - points.begin());
    }
};

// A closed loop of lines and arcs of circles.
class LoopBuilder {
public:
    explicit LoopBuilder(const Vec<2>& start) { loop_.start = start, loop_.closed = true; }
    void line_to(const Vec<2>& q) {
        if (q != at()) loop_.segments.push_back({1, {at(), q}, 1});
    }
    // By less than half a turn, whose half has this sine; from its tangents, so that large radii do no harm.
    void bend_to(const Vec<2>& q, double sine, bool counter_clockwise) {
        const Vec<2> from = at(), chord = q - from;
        if (sine == 0 || max_abs(chord) == 0) return line_to(q);
        const double cosine = std::sqrt((1 - sine) * (1 + sine)),
                     tangent = (counter_clockwise ? 0.5 : -0.5) * sine / cosine;
        const Vec<2> corner = from + 0.5 * chord + tangent * Vec<2>{{chord[1], -chord[0]}};
        loop_.segments.push_back({2, {from, corner, q}, cosine});
    }
    void arc_to(const Vec<2>& q, double radius, bool counter_clockwise) {
        for (const PathSegment& s : elliptic_arc(at(), q, radius, radius, 0, false, counter_clockwise))
            loop_.segments.push_back(s);
    }
    // By half a turn at most, in the direction with which it leaves; the other, opposite to that in its end.
    void arc_from(const Vec<2>& direction, const Vec<2>& q) {
        const Vec<2> from = at();
        bend_in_parts(from, direction, q, on_arc(from, direction, q, 0.5), q, true);
    }
    void arc_into(const Vec<2>& q, const Vec<2>& direction) {
        const Vec<2> from = at();
        bend_in_parts(q, direction, from, on_arc(q, direction, from, 0.5), q, false);
    }
    // The points of the frame from index i to j, both included.
    void along(const Frame& f, std::size_t i, std::size_t j) {
        for (std::size_t k = i; k != j; i < j ? ++k : --k) line_to(f.points[k]);
        line_to(f.points[j]);
    }
    void close_into(Path& path) && {
        line_to(loop_.start);
        if (loop_.segments.size() > 1) path.subpaths.push_back(std::move(loop_));
    }

private:
    void bend_in_parts(const Vec<2>& start, const Vec<2>& direction, const Vec<2>& end, const Vec<2>& middle,
                       const Vec<2>& to, bool forward) {
        const double half = half_turn(start, direction, end), sine = std::abs(std::sin(half));
        if (std::abs(half) < 0.5) return bend_to(to, sine, (half > 0) == forward);
        bend_to(middle, std::abs(std::sin(half / 2)), (half > 0) == forward);
        bend_to(to, std::abs(std::sin(half / 2)), (half > 0) == forward);
    }
    const Vec<2>& at() const { return loop_.segments.empty() ? loop_.start : loop_.segments.back().back(); }
    Subpath loop_;
};

class Pen {
public:
    explicit Pen(const StrokeStyle& style) : style_(style), h_(style.width / 2) {}

    void dot(const Vec<2>& p) {
        const ArcPiece piece{p, p, {{1, 0}}, {{1, 0}}, 0, {}};
        const Frame f = frame(p, piece.normal_a(), {});
        cap(f, {{-1, 0}}, true), cap(f, {{1, 0}}, false);
    }

    void stroke(const ArcChain& chain) {
        const std::size_t n = chain.pieces.size();
        if (n == 0) return;
        std::vector<Frame> begin(n), end(n);
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t k = (i + 1) % n;
            const ArcPiece &x = chain.pieces[i], &y = chain.pieces[k];
            const bool joined = i + 1 < n || chain.closed;
            if (joined && chain.before[k] == PieceJoint::smooth && x.b == y.a) {
                end[i] = begin[k] = frame(x.b, x.normal_b(), {centre(x), centre(y)});
                continue;
            }
            end[i] = frame(x.b, x.normal_b(), {centre(x)});
            begin[k] = frame(y.a, y.normal_a(), {centre(y)});
            if (joined && chain.before[k] == PieceJoint::round)
                disc(end[i]);
            else if (joined && chain.before[k] == PieceJoint::turn)
                join(end[i], x.tb, begin[k], y.ta, LineJoin::round),
                    join(end[i], x.tb, begin[k], y.ta, LineJoin::round, true);
            else if (joined)
                join(end[i], x.tb, begin[k], y.ta, style_.join, false, chain.bends[k]);
        }
        if (!chain.closed)
            cap(begin[0], -chain.pieces[0].ta, true), cap(end[n - 1], chain.pieces[n - 1].tb, false);
        for (std::size_t i = 0; i < n;) {
            if (is_tight(chain.pieces[i])) {
                tight(chain.pieces[i], begin[i], end[i]);
                ++i;
                continue;
            }
            std::size_t j = i + 1;
            while (j < n && !is_tight(chain.pieces[j]) && chain.before[j] == PieceJoint::smooth) ++j;
            run(std::span(chain.pieces).subspan(i, j - i), std::span(begin).subspan(i, j - i),
                std::span(end).subspan(i, j - i));
            i = j;
        }
    }
    Path take() { return std::move(path_); }

    // Of the joins: the one that rounding leaves most in doubt.
    struct Doubt {
        Vec<2> at;
        double bound = 0;
    };
    const Doubt& worst() const { return worst_; }

private:
    bool is_tight(const ArcPiece& x) const { return x.curvature != 0 && 1 <= h_ * std::abs(x.curvature); }
    std::optional<Vec<2>> centre(const ArcPiece& x) const {
        return is_tight(x) ? std::optional(x.centre) : std::nullopt;
    }

    Frame frame(const Vec<2>& p, const Vec<2>& n,
                std::initializer_list<std::optional<Vec<2>>> centres) const {
        std::vector<std::pair<double, Vec<2>>> at{{h_, p + h_ * n}, {0.0, p}, {-h_, p - h_ * n}};
        for (const auto& c : centres)
            if (c) at.push_back({std::clamp(freiform::dot(*c - p, n), -h_, h_), *c});
        sort(at.begin(), at.end(), [](const auto& x, const auto& y) {
            return std::pair(-x.first, x.second.c) < std::pair(-y.first, y.second.c);
        });
        Frame f;
        for (const auto& [height, q] : at) f.points.push_back(q);
        // What lies as far out as the ends is inside of them.
        const Vec<2> left = p + h_ * n, right = p - h_ * n;
        std::erase(f.points, left), std::erase(f.points, right);
        f.points.insert(f.points.begin(), left), f.points.push_back(right);
        f.p = f.index(p);
        return f;
    }

    void run(std::span<const ArcPiece> pieces, std::span<const Frame> begin, std::span<const Frame> end) {
        LoopBuilder loop(begin.front().right());
        for (std::size_t i = 0; i < pieces.size(); ++i) side(loop, pieces[i], end[i].right(), true);
        loop.along(end.back(), end.back().points.size() - 1, 0);
        for (std::size_t i = pieces.size(); i-- > 0;) side(loop, pieces[i], begin[i].left(), false);
        loop.along(begin.front(), 0, begin.front().points.size() - 1);
        std::move(loop).close_into(path_);
    }
    static void side(LoopBuilder& loop, const ArcPiece& x, const Vec<2>& to, bool forward) {
        loop.bend_to(to, half_sine(x), (x.curvature > 0) == forward);
    }
    static double half_sine(const ArcPiece& x) { return 0.5 * std::abs(x.curvature) * norm(x.b - x.a); }

    void tight(const ArcPiece& x, const Frame& begin, const Frame& end) {
        // Counter-clockwise about the centre the pen goes from `first` to `last`.
        const bool left = x.curvature > 0;
        const Frame &first = left ? begin : end, &last = left ? end : begin;
        const auto pie = [&](bool right_side) {
            const auto edge = [&](const Frame& f) {
                return right_side ? f.points.size() - 1 : std::size_t(0);
            };
            LoopBuilder loop(x.centre);
            loop.along(first, first.index(x.centre), edge(first));
            loop.bend_to(last.points[edge(last)], half_sine(x), true);
            loop.along(last, edge(last), last.index(x.centre));
            std::move(loop).close_into(path_);
        };
        pie(left), pie(!left);  // of the radii R + h and h - R
    }

    void disc(const Frame& f) {
        LoopBuilder loop(f.right());
        loop.arc_to(f.left(), h_, true);
        loop.arc_to(f.right(), h_, true);
        std::move(loop).close_into(path_);
    }

    // Along the end of the chain that `out` points away from.
    void cap(const Frame& f, const Vec<2>& out, bool at_start) {
        if (style_.cap == LineCap::butt) return;
        const std::size_t last = f.points.size() - 1, from = at_start ? 0 : last;
        LoopBuilder loop(f.points[from]);
        if (style_.cap == LineCap::round) {
            loop.arc_to(f.points[last - from], h_, true);
        } else {
            loop.line_to(f.points[from] + h_ * out), loop.line_to(f.points[last - from] + h_ * out);
            loop.line_to(f.points[last - from]);
        }
        loop.along(f, last - from, from);
        std::move(loop).close_into(path_);
    }

    // On the outside of the corner, between the pens before and after it; or on the inside.
    void join(const Frame& f, const Vec<2>& in, const Frame& g, const Vec<2>& out, LineJoin how,
              bool inside = false, const std::array<Bounded, 2>& bends = {}) {
        const bool left = cross(in, out) > 0 || (cross(in, out) == 0 && freiform::dot(in, out) < 0);
        if (cross(in, out) == 0 && freiform::dot(in, out) > 0) return;
        const Frame &first = left ? f : g, &last = left ? g : f;
        const auto edge = [&](const Frame& x) {
            return left != inside ? x.points.size() - 1 : std::size_t(0);
        };
        const Vec<2>&p = f.points[f.p], &a = first.points[edge(first)], &b = last.points[edge(last)];
        LoopBuilder loop(p);
        loop.along(first, first.p, edge(first));
        const Vec<2> middle = unit((a - p) + (b - p));
        const double half = freiform::dot(middle, a - p) / h_;  // the cosine of half the turn
        if (how == LineJoin::arcs) {
            const Bounded scale = left ? h_ : -h_, bend_in = scale * bends[0], bend_out = scale * bends[1];
            const JoinSide incoming{(left ? -1.0 : 1.0) * Vec<2>{{-in[1], in[0]}}, in, bend_in},
                outgoing{(left ? -1.0 : 1.0) * Vec<2>{{-out[1], out[0]}}, -out, bend_out};
            const JoinSide &x = left ? incoming : outgoing, &y = left ? outgoing : incoming;
            const ArcsJoin arcs = arcs_join(x, y, style_.miter_limit);
            if (!(h_ * arcs.bound <= worst_.bound)) worst_ = {p, h_ * arcs.bound};
            how = arcs.kind == ArcsJoinKind::round        ? LineJoin::round
                  : arcs.kind == ArcsJoinKind::miter_clip ? LineJoin::miter_clip
                                                          : LineJoin::arcs;
            if (how == LineJoin::arcs) {
                loop.arc_from(x.direction, p + h_ * arcs.from_first);
                loop.line_to(p + h_ * arcs.from_last);
                loop.arc_into(b, y.direction);
            }
        }
        const bool miter = how == LineJoin::miter || how == LineJoin::miter_clip;
        if (how == LineJoin::round) {
            loop.arc_to(b, h_, true);
        } else if (miter && half * style_.miter_limit >= 1) {
            loop.line_to(p + (h_ / half) * middle);
        } else if (how == LineJoin::miter_clip && style_.miter_limit > half && half > 0) {
            const Vec<2> tip = p + (h_ / half) * middle;
            const double s = (style_.miter_limit - half) / (1 / half - half);
            loop.line_to(a + s * (tip - a)), loop.line_to(b + s * (tip - b));
        }
        loop.line_to(b);
        loop.along(last, edge(last), last.p);
        std::move(loop).close_into(path_);
    }

    const StrokeStyle& style_;
    double h_;
    Path path_;
    Doubt worst_;
};

Result<void> check(const StrokeStyle& style, const RegionOptions& options) {
    if (!(style.width > 0) || !std::isfinite(style.width))
        return refuse(RefusalKind::invalid, "width", text(style.width, " is not a width > 0"));
    if (!(style.miter_limit >= 1))
        return refuse(RefusalKind::invalid, "miter_limit", text(style.miter_limit, " is not at least 1"));
    if (!(options.tolerance > 0))
        return refuse(RefusalKind::invalid, "tolerance", text(options.tolerance, " is not a length > 0"));
    return {};
}

bool has_length(const Subpath& s) {
    return std::ranges::any_of(s.segments, [](const PathSegment& x) {
        const Box<2> box = box_of(x);
        return box.lo != box.hi;
    });
}

}  // namespace

Result<Region> stroked(const Path& path, const StrokeStyle& style, const RegionOptions& options) {
    if (const auto ok = check(style, options); !ok) return std::unexpected(ok.error());
    // The same refusals as for a region: numbers, weights, what hangs together.
    std::vector<RegionArc> checked;
    if (const auto ok = add_arcs(path, 0, checked); !ok) return refuse_within("path", ok.error());
    Path dashes;
    if (!style.dashes.empty()) {
        auto cut = dashed(path, style, options.tolerance / 8);
        if (!cut) return std::unexpected(cut.error());
        dashes = *std::move(cut);
    }
    Pen pen(style);
    double bound = 0;
    const Path& drawn = style.dashes.empty() ? path : dashes;
    for (std::size_t i = 0; i < drawn.subpaths.size(); ++i) {
        const Subpath& s = drawn.subpaths[i];
        if (!has_length(s)) {
            pen.dot(s.start);
            continue;
        }
        const auto chain = arc_chain(s, style.width / 2, options.tolerance / 2);
        if (!chain) return refuse_within(text("path.subpaths[", i, "]"), chain.error());
        bound = std::max(bound, chain->bound);
        pen.stroke(*chain);
        if (const auto& [at, off] = pen.worst(); !(off < options.tolerance / 4))
            return refuse(RefusalKind::ill_conditioned, text("path.subpaths[", i, "]"),
                          text("rounding leaves open how the edges go on in the join at (", at[0], ", ",
                               at[1], "), by ", off, " for a tolerance of ", options.tolerance));
    }
    bound += pen.worst().bound;
    RegionOptions rest = options;
    rest.tolerance = 0.99 * (options.tolerance - bound);
    auto region = region_of({pen.take()}, rest);
    if (!region) return region;
    // Points and tangents of the loops are rounded to some 30 u of the coordinates.
    double scale = style.width;
    for (const RegionArc& a : checked) scale = std::max(scale, a.box.scale() + style.width);
    region->bound += bound + 0x1p-47 * scale;
    return region;
}

Result<Region> grown(const Filled& region, const OffsetStyle& style, const RegionOptions& options) {
    RegionOptions part = options;
    part.tolerance = options.tolerance / 4;
    auto clean = region_of(region, part);
    if (!clean || style.distance == 0) return clean;
    if (!std::isfinite(style.distance))
        return refuse(RefusalKind::invalid, "distance", text(style.distance, " is not a length"));
    StrokeStyle pen;
    pen.width = 2 * std::abs(style.distance), pen.join = style.join, pen.miter_limit = style.miter_limit;
    const auto rim = stroked(clean->path, pen, part);
    if (!rim) return rim;
    part.tolerance = options.tolerance - clean->bound - rim->bound;
    auto out = combine({clean->path}, {rim->path},
                       style.distance > 0 ? RegionOperation::union_of : RegionOperation::difference, part);
    if (out) out->bound += clean->bound + rim->bound;
    return out;
}

}  // namespace freiform

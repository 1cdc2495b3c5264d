// From a branch, as a chain of cells, to splines: as few cubic pieces as a greedy search finds.
//
// Points of the branch come from the cells: a cell has one arc, a graph over one axis, so that a point is one
// zero of a monotone function. Pieces interpolate points and tangents in space and in the parameters, with
// derivatives as if the parameter were the length of the curve; so neighbours join with C^1.
#pragma once
#include "section_fit_detail.hpp"

#include <freiform/core/sort.hpp>

namespace freiform::detail {

// A point of the branch, in places that continue over seams; `step`: the cell behind it.
struct BranchPoint {
    Place x{};
    int step = 0;
    bool stop = false;  // pieces end here: second derivatives, or the parameters, jump
};

template <class P>
class BranchFit {
public:
    BranchFit(const SectionField<P>& field, double tolerance) : field_(field), tolerance_(tolerance) {}

    SectionBranch branch(const LevelBranch& branch, const std::vector<LevelCell>& cells) {
        branch_ = &branch, cells_ = &cells;
        points_.clear();
        for (std::size_t i = 0; i < branch.at.size(); ++i)
            points_.push_back({branch.at[i], int(std::min(i, branch.cells.size() - 1)), false});
        SectionBranch out = fitted(branch.closed);
        out.ends = branch.node;
        return out;
    }
    // A side that lies in the plane.
    SectionBranch side(const LevelSide& side) {
        branch_ = nullptr;
        along_ = 1 - side.axis;
        points_.clear();
        const auto place = [&](double t) {
            return side.axis == 0 ? Place{double(side.line), t} : Place{t, double(side.line)};
        };
        points_.push_back({place(side.along.lo), 0, false});
        points_.push_back({place(side.along.hi), 0, false});
        const std::size_t k = std::size_t(along_);
        return fitted(field_.options.cyclic[k] && side.along.length() == field_.count(along_));
    }

private:
    struct Frame {
        Vec<3> point{}, tangent{};
        Vec<2> at{}, slope{};
    };
    static constexpr int kMostAdded = 4096;       // a backstop: a tolerance below rounding
    static constexpr double kShortest = 0x1p-30;  // places

    int monotone_axis(int step) const { return branch_ ? cell(step).simple_axis() : 1 - along_; }
    const LevelCell& cell(int step) const {
        return (*cells_)[std::size_t(branch_->cells[std::size_t(step)])];
    }
    Place in_cell(const Place& x, int step) const {
        const Place& s = branch_->shift[std::size_t(step)];
        return {x[0] - s[0], x[1] - s[1]};
    }

    // The point of an arc whose place along the free axis is between those of a and b.
    BranchPoint between(const BranchPoint& a, const BranchPoint& b, double fraction) const {
        BranchPoint p{{}, a.step, false};
        const std::size_t m = std::size_t(monotone_axis(a.step)), f = 1 - m;
        p.x[f] = a.x[f] + fraction * (b.x[f] - a.x[f]);
        p.x[m] = a.x[m];
        if (!branch_) return p;
        const LevelCell& c = cell(a.step);
        Place x = in_cell(p.x, a.step);
        const double shift = p.x[m] - x[m];
        double lo = c.on[m].lo, hi = c.on[m].hi;
        const bool rises = c.slope_sign(int(m)) > 0;
        for (int i = 0; i < 80; ++i) {
            x[m] = lo + (hi - lo) / 2;
            if (!(lo < x[m] && x[m] < hi)) break;
            ((level_value(c.block_at(x), x).value > 0) == rises ? hi : lo) = x[m];
        }
        p.x[m] = x[m] + shift;
        return p;
    }

    // Points where the branch goes over lines that pieces may not go over.
    void add_stops() {
        std::vector<BranchPoint> all;
        for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
            all.push_back(points_[i]);
            const std::size_t begin = all.size();
            const BranchPoint a = points_[i], b = points_[i + 1];
            for (int axis = 0; axis < 2; ++axis) {
                const std::size_t k = std::size_t(axis);
                const Interval on{std::min(a.x[k], b.x[k]), std::max(a.x[k], b.x[k])};
                for (double line = std::ceil(on.lo + kShortest); line < on.hi - kShortest; ++line) {
                    const int n = field_.count(axis), own = ((int(line) % n) + n) % n;
                    if (std::ranges::find(field_.stops[k], own) == field_.stops[k].end()) continue;
                    double lo = 0, hi = 1;  // along the free axis
                    const bool rises = b.x[k] > a.x[k];
                    for (int j = 0; j < 60; ++j) {
                        const double mid = (lo + hi) / 2;
                        ((between(a, b, mid).x[k] > line) == rises ? hi : lo) = mid;
                    }
                    BranchPoint p = between(a, b, hi);
                    p.x[k] = line;
                    p.stop = true;
                    all.push_back(p);
                }
            }
            const std::size_t free = std::size_t(1 - monotone_axis(a.step));
            sort(all.begin() + std::ptrdiff_t(begin), all.end(), [&](const auto& p, const auto& q) {
                return (p.x[free] < q.x[free]) == (a.x[free] < b.x[free]) && p.x[free] != q.x[free];
            });
        }
        all.push_back(points_.back());
        // No two on top of each other; stops and ends stay.
        points_.clear();
        const auto near = [](const BranchPoint& p, const BranchPoint& q) {
            return std::max(std::abs(p.x[0] - q.x[0]), std::abs(p.x[1] - q.x[1])) <= kShortest;
        };
        for (std::size_t i = 0; i < all.size(); ++i) {
            const bool last = i + 1 == all.size();
            while (last && points_.size() > 1 && near(points_.back(), all[i])) points_.pop_back();
            if (!last && !points_.empty() && near(points_.back(), all[i])) {
                if (!all[i].stop) {
                    points_.back().step = all[i].step;
                    continue;
                }
                if (points_.size() > 1 && !points_.back().stop) points_.pop_back();
            }
            points_.push_back(all[i]);
        }
    }

    // Seen from the side of `toward`; `step` is the cell on that side.
    Frame frame(const BranchPoint& p, int step, const Place& toward) const {
        Frame out;
        Index<2> piece{};
        Place nudged = p.x;
        for (int axis = 0; axis < 2; ++axis) {
            const std::size_t k = std::size_t(axis);
            const int n = field_.count(axis);
            nudged[k] += 0x1p-26 * std::clamp(toward[k] - p.x[k], -1.0, 1.0);
            const double base = field_.options.cyclic[k] ? n * std::floor(nudged[k] / n) : 0;
            const double own = std::clamp(p.x[k] - base, 0.0, double(n));
            piece[k] = std::clamp(int(std::floor(nudged[k] - base)), 0, n - 1);
            out.at[axis] = field_.parameter(axis, own);
        }
        Place direction{};
        if (branch_) {
            const LevelCell& c = cell(step);
            const std::size_t m = std::size_t(c.simple_axis()), f = 1 - m;
            const LevelValue v = level_value(c.block_at(in_cell(nudged, step)), in_cell(p.x, step));
            const std::size_t i = std::size_t(step);
            const double onward = branch_->at[i + 1][f] > branch_->at[i][f] ? 1 : -1;
            direction[f] = onward * std::abs(v.slope[m]);
            direction[m] = -onward * v.slope[f] * (v.slope[m] < 0 ? -1 : 1);
        } else {
            direction[std::size_t(along_)] = 1;
        }
        const auto jet = field_.pieces[field_.piece_at(piece)].template jet<1>({out.at[0], out.at[1]});
        out.point = jet.value();
        for (int k = 0; k < 2; ++k) {
            out.slope[k] = direction[std::size_t(k)] * field_.span(k, piece[std::size_t(k)]);
            out.tangent += out.slope[k] * jet.d[std::size_t(k) + 1];
        }
        const double speed = norm(out.tangent);
        if (speed > 0 && std::isfinite(speed)) {
            out.tangent = (1 / speed) * out.tangent;
            out.slope = (1 / speed) * out.slope;
        }
        return out;
    }

    // Cubic from point i to point j, as on a circle with these tangents, if they are no noise. It begins with
    // the tangent that the piece before it ends with, so that nothing moves when the join is left out of the
    // spline.
    SectionPiece piece(std::size_t i, std::size_t j, const SectionPiece* before, double t) const {
        Frame a = frame(points_[i], points_[i].step, points_[i + 1].x);
        const Frame b = frame(points_[j], points_[j - 1].step, points_[j - 1].x);
        if (before && norm(before->tangent[1] - a.tangent) <= 1e-9) {
            a.tangent = before->tangent[1];
            const Vec<2> d = before->slope[1] - a.slope;
            if (max_abs(d) <= 1e-9 * max_abs(a.slope) && before->at[3] == a.at) a.slope = before->slope[1];
        }
        SectionPiece out;
        out.length = arc_interval(a.point, b.point, a.tangent, b.tangent, t, tolerance_);
        const double h = out.length / 3;
        out.space = {a.point, a.point + h * a.tangent, b.point - h * b.tangent, b.point};
        out.at = {a.at, a.at + h * a.slope, b.at - h * b.slope, b.at};
        out.tangent = {a.tangent, b.tangent};
        out.slope = {a.slope, b.slope};
        return out;
    }

    // Two points of a closed branch are joined by two ways. A piece follows the one between points i and j if
    // some point of the other one is farther from it than the branch is from the piece.
    bool leaves_out_some(const SectionPiece& p, std::size_t i, std::size_t j, bool closed) const {
        if (!closed || !branch_) return true;
        Box<3> box;
        for (const Vec<3>& x : p.space) box.add(x);
        const double more = 1.01 * tolerance_ + 64 * kUnitRoundoff * box.scale() + 4 * field_.rounding;
        const Vec<3> by{{more, more, more}};
        box.lo -= by, box.hi += by;
        for (std::size_t k = 0; k + 1 < points_.size(); ++k)
            if ((k < i || k > j) && (k != 0 || j + 1 < points_.size()) && !box.contains(point_of(points_[k])))
                return true;
        return false;
    }
    Vec<3> point_of(const BranchPoint& p) const {
        Param<2> u;
        for (int axis = 0; axis < 2; ++axis) {
            const std::size_t k = std::size_t(axis);
            const int n = field_.count(axis);
            const double base = field_.options.cyclic[k] ? n * std::floor(p.x[k] / n) : 0;
            u[k] = field_.parameter(axis, std::clamp(p.x[k] - base, 0.0, double(n)));
        }
        return field_.surface(u);
    }
    // A loop of two cells has other points than the two in which they meet.
    void add_middles() {
        std::vector<BranchPoint> all;
        for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
            all.push_back(points_[i]);
            all.push_back(between(points_[i], points_[i + 1], 0.5));
        }
        all.push_back(points_.back());
        points_ = std::move(all);
    }
    // Is there room for another point behind point i?
    bool is_long(std::size_t i) const {
        const Place &a = points_[i].x, &b = points_[i + 1].x;
        return std::max(std::abs(a[0] - b[0]), std::abs(a[1] - b[1])) > 4 * kShortest;
    }

    // Contains the arc between two points of a cell along the axis along which f is monotone: opposite signs
    // all along both sides of it, as near to the points as that is certain.
    Interval strip(const BranchPoint& a, const BranchPoint& b, int axis) const {
        const std::size_t m = std::size_t(axis), f = 1 - m;
        const LevelCell& c = cell(a.step);
        const double shift = branch_->shift[std::size_t(a.step)][m];
        const Place p = in_cell(a.x, a.step), q = in_cell(b.x, a.step);
        const int sign = c.slope_sign(axis);
        const auto is_beyond = [&](double at, int expected) {
            std::array<Interval, 2> line;
            line[m] = {at, at}, line[f] = {std::min(p[f], q[f]), std::max(p[f], q[f])};
            SignSeen seen;
            for (const LevelBlock& block : c.blocks) {
                if (!block.on[m].contains(at) || !block.on[f].overlaps(line[f])) continue;
                const LevelBlock part = part_of(block, line);
                for (const double x : part.c) seen.add(x, part.error);
            }
            return seen.sign() == expected;
        };
        for (double more = kShortest / 64; more < c.on[m].length(); more *= 4) {
            const Interval on{std::min(p[m], q[m]) - more, std::max(p[m], q[m]) + more};
            const bool below = on.lo <= c.on[m].lo || is_beyond(on.lo, -sign);
            const bool above = on.hi >= c.on[m].hi || is_beyond(on.hi, sign);
            if (below && above)
                return {std::max(on.lo, c.on[m].lo) + shift, std::min(on.hi, c.on[m].hi) + shift};
        }
        return {c.on[m].lo + shift, c.on[m].hi + shift};
    }
    std::array<Interval, 2> around(std::size_t i) const {
        std::array<Interval, 2> box;
        const Place &a = points_[i].x, &b = points_[i + 1].x;
        for (int axis = 0; axis < 2; ++axis) {
            const std::size_t k = std::size_t(axis);
            Interval on{std::min(a[k], b[k]), std::max(a[k], b[k])};
            if (branch_ && axis == monotone_axis(points_[i].step))
                on = strip(points_[i], points_[i + 1], axis);
            const int n = field_.count(axis);
            const double base = field_.options.cyclic[k] ? n * std::floor((a[k] + b[k]) / (2 * n)) : 0;
            on = {std::clamp(on.lo - base, 0.0, double(n)), std::clamp(on.hi - base, 0.0, double(n))};
            box[k] = {field_.parameter(axis, on.lo), field_.parameter(axis, on.hi)};
        }
        return box;
    }

    SectionBranch fitted(bool closed);
    SectionBranch spline(const std::vector<SectionPiece>& pieces, const PieceBound& bound, bool closed) const;

    const SectionField<P>& field_;
    double tolerance_;
    const LevelBranch* branch_ = nullptr;
    const std::vector<LevelCell>* cells_ = nullptr;
    int along_ = 0;
    std::vector<BranchPoint> points_;
};

template <class P>
SectionBranch BranchFit<P>::fitted(bool closed) {
    if (closed && branch_) add_middles();
    add_stops();
    const PieceProof<P> proof(field_, tolerance_, branch_ == nullptr);
    std::vector<SectionPiece> pieces;
    PieceBound bound;
    double t = 0;
    std::size_t step = 1;
    int added = 0;  // points where not even the shortest piece was near enough
    for (std::size_t i = 0; i + 1 < points_.size();) {
        std::size_t most = i + 1;
        while (most + 1 < points_.size() && !points_[most].stop) ++most;
        // The longest piece that is near enough: doubled while it is, then halved.
        std::size_t good = i, bad = most + 1;
        std::optional<PieceBound> best;
        SectionPiece chosen{};
        int refined = 0;
        for (std::size_t j = std::min(i + step, most); j > i;) {
            const SectionPiece p = piece(i, j, pieces.empty() ? nullptr : &pieces.back(), t);
            const bool good_guess = leaves_out_some(p, i, j, closed) && proof.estimate(p) <= 0.7 * tolerance_;
            const auto proven = good_guess ? proof(p) : std::nullopt;
            if (proven)
                good = j, best = proven, chosen = p;
            else
                bad = j;
            if (good >= most) break;
            if (bad <= good + 1 && good > i && refined < 3 && is_long(good)) {
                // Something between two points?
                points_.insert(points_.begin() + std::ptrdiff_t(good) + 1,
                               between(points_[good], points_[bad], 0.5));
                ++refined, ++most, ++bad;
                j = good + 1;
                continue;
            }
            if (bad <= good + 1) break;
            j = bad > most ? std::min(most, good + 2 * (good - i)) : good + (bad - good) / 2;
        }
        if (!best) {  // not even to the next point
            const BranchPoint &a = points_[i], &b = points_[i + 1];
            const SectionPiece p = piece(i, i + 1, pieces.empty() ? nullptr : &pieces.back(), t);
            const PieceBound size = proof.by_size(p, around(i));
            if (size.all > tolerance_ && is_long(i) && !proof.is_exhausted() && ++added < kMostAdded) {
                points_.insert(points_.begin() + std::ptrdiff_t(i) + 1, between(a, b, 0.5));
                step = 1;
                continue;
            }
            good = i + 1, best = size, chosen = p;
        }
        bound.include(*best);
        pieces.push_back(chosen);
        t += chosen.length;
        step = good - i;
        i = good;
    }
    return spline(pieces, bound, closed);
}

template <class P>
SectionBranch BranchFit<P>::spline(const std::vector<SectionPiece>& pieces, const PieceBound& bound,
                                   bool closed) const {
    std::vector<Vec<3>> space{pieces[0].space[0]};
    std::vector<Vec<2>> at{pieces[0].at[0]};
    std::vector<double> knots(4, 0.0), parameter_knots(4, 0.0);
    double t = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const SectionPiece& p = pieces[i];
        t += p.length;
        space.insert(space.end(), {p.space[1], p.space[2]});
        at.insert(at.end(), {p.at[1], p.at[2]});
        if (i + 1 == pieces.size()) break;
        const SectionPiece& q = pieces[i + 1];
        // A join with one tangent has two knots; with two tangents three; a jump four.
        const bool smooth = p.tangent[1] == q.tangent[0], jump = p.at[3] != q.at[0];
        const bool smooth_at = smooth && !jump && p.slope[1] == q.slope[0];
        if (!smooth) space.push_back(p.space[3]);
        if (!smooth_at) at.push_back(p.at[3]);
        if (jump) at.push_back(q.at[0]);
        knots.insert(knots.end(), smooth ? 2 : 3, t);
        parameter_knots.insert(parameter_knots.end(), jump ? 4 : smooth_at ? 2 : 3, t);
    }
    space.push_back(pieces.back().space[3]);
    at.push_back(pieces.back().at[3]);
    knots.insert(knots.end(), 4, t);
    parameter_knots.insert(parameter_knots.end(), 4, t);
    const int n = int(space.size()), m = int(at.size());
    return {Curve<Vec<3>>::trusted({*BSplineBasis::make(3, std::move(knots))},
                                   Net<1, Vec<3>>({n}, std::move(space))),
            Curve<Vec<2>>::trusted({*BSplineBasis::make(3, std::move(parameter_knots))},
                                   Net<1, Vec<2>>({m}, std::move(at))),
            closed,
            {kAtBoundary, kAtBoundary},
            bound.surface,
            bound.plane,
            bound.all};
}

}  // namespace freiform::detail

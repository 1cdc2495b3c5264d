// Fitting branches; branch_fit_detail.hpp is the essay.
#include "branch_fit_detail.hpp"

namespace freiform::detail {

TraceFit::Frame TraceFit::frame(const Place4& x) const {
    Frame out;
    out.point = 0.5 * (charts_.sheet(0).at(x[0], x[1]).point + charts_.sheet(1).at(x[2], x[3]).point);
    const Charts::Direction d = charts_.direction(x);
    out.tangent = d.tangent;
    out.at = {Vec<2>{{x[0], x[1]}}, {{x[2], x[3]}}};
    out.slope = {Vec<2>{{d.x[0], d.x[1]}}, {{d.x[2], d.x[3]}}};
    return out;
}

// Cubic from one frame to another.
TraceFit::Piece TraceFit::piece(const Frame& a, const Frame& b, double t) const {
    Piece out;
    out.length = arc_interval(a.point, b.point, a.tangent, b.tangent, t, tolerance_);
    const double h = out.length / 3;
    out.space = {a.point, a.point + h * a.tangent, b.point - h * b.tangent, b.point};
    out.tangent = {a.tangent, b.tangent};
    for (std::size_t k = 0; k < 2; ++k) {
        out.at[k] = {a.at[k], a.at[k] + h * a.slope[k], b.at[k] - h * b.slope[k], b.at[k]};
        out.slope[k] = {a.slope[k], b.slope[k]};
        // Rounding must not carry it over the border.
        const auto& on = charts_.sheet(k).domain();
        for (Vec<2>& q : out.at[k])
            for (int i = 0; i < 2; ++i) {
                const Interval d = on[std::size_t(i)];
                const double noise = 0x1p-40 * std::max(d.length(), std::max(std::abs(d.lo), std::abs(d.hi)));
                if (q[i] < d.lo && q[i] > d.lo - noise) q[i] = d.lo;
                if (q[i] > d.hi && q[i] < d.hi + noise) q[i] = d.hi;
            }
    }
    return out;
}

// Samples of what is to be proven, and that the piece follows the way from point i to point j.
bool TraceFit::looks_good(const Piece& p, std::size_t i, std::size_t j) const {
    const auto [left, right] = arc_halves(p.space);
    for (std::size_t k = 0; k < 2; ++k) {
        const auto [first, second] = arc_halves(p.at[k]);
        const std::array<std::pair<Vec<3>, Vec<2>>, 3> places{
            {{left[3], first[3]},
             {arc_halves(left)[0][3], arc_halves(first)[0][3]},
             {arc_halves(right)[0][3], arc_halves(second)[0][3]}}};
        for (const auto& [x, u] : places)
            if (!proofs_[k]->contains(u) || proofs_[k]->off(x, u) > 0.7 * tolerance_) return false;
    }
    // Points on the way, in the order of the chord, are near the piece.
    const std::size_t stride = std::max<std::size_t>(1, (j - i) / 6);
    for (std::size_t n = i + stride; n < j; n += stride) {
        const Vec<3>& x = frames_[n].point;
        double lo = 0, hi = 1, t = 0.5;
        Vec<3> off{}, slope{};
        for (int r = 0; r < 12; ++r) {
            t = 0.5 * (lo + hi);
            const double s = 1 - t;
            off = s * s * s * p.space[0] + 3 * s * s * t * p.space[1] + 3 * s * t * t * p.space[2] +
                  t * t * t * p.space[3] - x;
            slope = s * s * (p.space[1] - p.space[0]) + 2 * s * t * (p.space[2] - p.space[1]) +
                    t * t * (p.space[3] - p.space[2]);
            (dot(off, slope) > 0 ? hi : lo) = t;
        }
        const double speed = norm(slope), along = speed > 0 ? std::abs(dot(off, slope)) / speed : 0;
        const double aside = std::sqrt(std::max(0.0, dot(off, off) - along * along));
        if (along > p.length / 512 || aside > 4 * tolerance_ + 0x1p-8 * p.length) return false;
    }
    return true;
}

std::optional<TraceFit::Bound> TraceFit::prove(const Piece& p) const {
    Bound out{};
    for (std::size_t k = 0; k < 2; ++k) {
        const auto bound = (*proofs_[k])(p.space, p.at[k], tolerance_);
        if (!bound) return std::nullopt;
        out[k] = *bound;
    }
    return out;
}

// Without a proof that follows the branch: all of the piece is near where it begins.
TraceFit::Bound TraceFit::by_size(const Piece& p) const {
    double reach = 0;
    for (std::size_t i = 1; i < 4; ++i) reach = std::max(reach, norm(p.space[i] - p.space[0]));
    Bound out{};
    for (std::size_t k = 0; k < 2; ++k) out[k] = 1.01 * (reach + proofs_[k]->off(p.space[0], p.at[k][0]));
    return out;
}

// Another point between i and the next one.
bool TraceFit::refine(std::size_t i) {
    const TracePoint &p = points_[i], &q = points_[i + 1];
    if (p.seam || p.chart < 0) return false;
    const Chart& c = charts_.charts()[std::size_t(p.chart)];
    TracePoint mid = p;
    bool moved = false;
    for (std::size_t k = 0; k < 4; ++k) {
        mid.x[k] = 0.5 * (p.x[k] + q.x[k]);
        moved = moved || (std::abs(q.x[k] - p.x[k]) > 0x1p-30 * c.width(k));
    }
    if (!moved) return false;
    const std::array<double, 4> width{c.width(0), c.width(1), c.width(2), c.width(3)};
    if (!charts_.newton(mid.x, c.free, width)) return false;
    for (std::size_t k = 0; k < 4; ++k)
        if (!charts_.is_cyclic(k)) mid.x[k] = clamped(mid.x[k], charts_.domain(k));
    points_.insert(points_.begin() + std::ptrdiff_t(i) + 1, mid);
    frames_.insert(frames_.begin() + std::ptrdiff_t(i) + 1, frame(mid.x));
    return true;
}

SurfaceBranch TraceFit::operator()(Trace trace) {
    points_ = std::move(trace.points);
    frames_.clear();
    for (const TracePoint& p : points_) frames_.push_back(frame(p.x));
    std::vector<Piece> pieces;
    Bound bound{};
    double t = 0;
    std::size_t step = 1;
    int refined = 0;
    for (std::size_t i = 0; i + 1 < points_.size();) {
        if (points_[i].seam) {
            ++i;
            continue;
        }
        std::size_t most = i + 1;
        while (most + 1 < points_.size() && !points_[most].seam) ++most;
        // A closed branch in one piece goes nowhere.
        if (trace.closed && i == 0 && most + 1 == points_.size()) most = std::max<std::size_t>(1, most - 1);
        std::size_t good = i, bad = most + 1;
        std::optional<Bound> best;
        Piece chosen{};
        for (std::size_t j = std::min(i + step, most); j > i;) {
            const Piece p = piece(frames_[i], frames_[j], t);
            const auto proven = looks_good(p, i, j) ? prove(p) : std::nullopt;
            if (proven)
                good = j, best = proven, chosen = p;
            else
                bad = j;
            if (good >= most || bad <= good + 1) break;
            // Not to the last point: a few per cent of length are not worth a proof.
            if (bad <= most && bad - good <= 1 + (good - i) / 16 && good > i) break;
            j = bad > most ? std::min(most, good + std::max<std::size_t>(1, good - i))
                           : good + (bad - good) / 2;
        }
        if (!best) {
            if (refined < 4096 && refine(i)) {
                ++refined, step = 1;
                continue;
            }
            good = i + 1;
            chosen = piece(frames_[i], frames_[good], t);
            best = by_size(chosen);
        }
        for (std::size_t k = 0; k < 2; ++k) bound[k] = std::max(bound[k], (*best)[k]);
        pieces.push_back(chosen);
        t += chosen.length;
        step = good - i;
        i = good;
    }
    SurfaceBranch out = spline(pieces);
    out.closed = trace.closed;
    out.bound_a = bound[0], out.bound_b = bound[1];
    return out;
}

SurfaceBranch TraceFit::spline(const std::vector<Piece>& pieces) const {
    std::vector<Vec<3>> space{pieces[0].space[0]};
    std::array<std::vector<Vec<2>>, 2> at{{{pieces[0].at[0][0]}, {pieces[0].at[1][0]}}};
    std::vector<double> knots(4, 0.0);
    std::array<std::vector<double>, 2> at_knots{knots, knots};
    double t = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Piece& p = pieces[i];
        const bool last = i + 1 == pieces.size();
        t += p.length;
        space.insert(space.end(), {p.space[1], p.space[2]});
        // A join with one tangent has two knots; with two tangents three; a jump four.
        const bool smooth = !last && p.tangent[1] == pieces[i + 1].tangent[0];
        if (!smooth) space.push_back(p.space[3]);
        knots.insert(knots.end(), last ? 4 : smooth ? 2 : 3, t);
        for (std::size_t k = 0; k < 2; ++k) {
            at[k].insert(at[k].end(), {p.at[k][1], p.at[k][2]});
            const bool jump = !last && p.at[k][3] != pieces[i + 1].at[k][0];
            const bool same = smooth && !jump && p.slope[k][1] == pieces[i + 1].slope[k][0];
            if (!same) at[k].push_back(p.at[k][3]);
            if (jump) at[k].push_back(pieces[i + 1].at[k][0]);
            at_knots[k].insert(at_knots[k].end(), last || jump ? 4 : same ? 2 : 3, t);
        }
    }
    const auto curve = [](std::vector<double> all, auto points) {
        using V = typename decltype(points)::value_type;
        const int n = int(points.size());
        return Curve<V>::trusted({*BSplineBasis::make(3, std::move(all))}, Net<1, V>({n}, std::move(points)));
    };
    return {curve(std::move(knots), std::move(space)),
            curve(std::move(at_knots[0]), std::move(at[0])),
            curve(std::move(at_knots[1]), std::move(at[1])),
            false,
            {kAtBorder, kAtBorder},
            0,
            0};
}

}  // namespace freiform::detail

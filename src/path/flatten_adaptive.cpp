// The fewest segments: each one as long as can be proven.
//
// Idea: if the distance of a part of the curve from its chord only grows when the part grows, then always
// taking the longest possible step gives the least number of segments whose ends are on the curve: by
// induction, the k-th end lies nowhere before the k-th end of any other solution. So the number is near the
// least as far as (a) the bound that decides is near the true distance and (b) the step near the longest.
//
// Method: the bound of a step is that of its Bezier blocks (flatten_detail.hpp), halved until they are within
// the tolerance, or have a point that is not, at most kDeepest times and at least twice where the bound is
// not small anyway. The distance of a short part from its chord is as the square of its length (cube at an
// inflection), so from the distance v found for a step h the next trial is h sqrt(tolerance / v), kept inside
// the interval between the longest step that was proven and the shortest that was not; it ends at 98.5 % of
// the tolerance. A step may pass breaks between pieces, but no corner: corners stay.
//
// Where the distance is not monotone (a curve that runs around and comes back) the result is still within
// the tolerance, only not the least.
//
// Cost: about 3 trials for a segment, each 7 evaluations of the bound for every piece that it meets.
//
// Why not halving: it gives up to twice the segments, the factor depends on the tolerance by chance. Why not
// a formula for the number of segments with equal shares of its integrand [Levien 2019]: fast, and an
// estimate.
#include "path/flatten_detail.hpp"

#include <freiform/core/constants.hpp>

#include <optional>

namespace freiform::detail {

namespace {

constexpr int kDeepest = 5;            // halvings of a block; 3 p + 3 p + 5 p roundings in all
constexpr double kNearEnough = 0.985;  // of the tolerance

template <class P>
class Greedy {
public:
    static constexpr int D = Space<P>::kDim;
    using Point = Vec<D>;

    Greedy(const Chain<P>& chain, double tolerance, std::size_t most)
        : chain_(chain), tolerance_(tolerance), most_(most), size_(std::size_t(chain.degree()) + 1) {}

    // Appends what follows the last point up to the end of piece `last`. False: too many, or no step is
    // possible.
    bool run(int last, std::optional<Point> end, Polyline<D>& out) {
        const double stop = chain_.at(last + 1);
        last_ = last;
        end_ = end;
        double s = out.parameters.back(), step = first_guess(s);
        while (s < stop) {
            if (out.points.size() > most_) return false;
            const auto found = longest(s, out.points.back(), step, stop);
            if (!found) return false;
            step = found->t - s;
            s = found->t;
            out.points.push_back(found->end);
            out.parameters.push_back(s);
            out.bound = std::max(out.bound, found->distance);
        }
        return true;
    }

private:
    struct Trial {
        double t = 0;
        Point end{};
        double distance = 0;  // proven if <= tolerance, else a hint
    };

    double first_guess(double s) const {
        const int i = chain_.starting(s);
        return (chain_.at(i + 1) - chain_.at(i)) /
               steps_for(second_derivative<P>(chain_.piece(i)), tolerance_);
    }

    std::optional<Trial> longest(double s, const Point& a, double step, double stop) {
        constexpr int kMostTrials = 100;
        std::optional<Trial> best;
        double proven = s, refuted = std::numeric_limits<double>::infinity();
        double t = s + step;
        for (int k = 0; k < kMostTrials; ++k) {
            t = std::min(t, stop);
            if (!(t > proven) || !(t < refuted)) break;
            const Trial now = attempt(s, a, t);
            if (now.distance <= tolerance_) {
                best = now;
                proven = t;
                if (t == stop || now.distance >= kNearEnough * tolerance_) break;
            } else {
                refuted = t;
            }
            if (refuted - s <= (proven - s) * 1.001) break;
            double factor = std::sqrt(0.995 * tolerance_ / now.distance);  // infinite for a straight part
            factor = std::clamp(factor, 0.05, 16.0);
            double next = s + (t - s) * factor;
            if (!(next > proven && next < refuted) || (k > 6 && refuted <= stop))
                next = refuted <= stop ? proven + (refuted - proven) / 2 : stop;
            t = next;
        }
        return best;
    }

    Trial attempt(double s, const Point& a, double t) {
        Trial trial{t, {}, 0};
        const int from = chain_.starting(s), to = std::min(chain_.ending(t), last_);
        P* b = stack_;
        const double x1 = chain_.local(to, t);
        chain_.copy_left(to, x1, b);
        trial.end = to == last_ && t >= chain_.at(to + 1) && end_ ? *end_ : project(b[chain_.degree()]);
        const Segment<D> segment(a, trial.end);
        const double h = t - s;
        double slope = 0;
        for (int i = to; i >= from && trial.distance <= tolerance_; --i) {
            const double x0 = i == from ? chain_.local(i, s) : 0;
            if (i < to) std::ranges::copy(chain_.piece(i), b);
            chain_.cut_left(x0, i == to ? x1 : 1, b);
            Point l0{}, l1{};
            if constexpr (D == 1) {  // compared at equal parameters
                l0 = i == from ? a : a + ((chain_.at(i) - s) / h) * (trial.end - a);
                l1 = i == to ? trial.end : a + ((chain_.at(i + 1) - s) / h) * (trial.end - a);
                // Parameters are rounded, and a part begins up to 2 u x0 before its parameter.
                slope = 8 * kUnitRoundoff * norm(trial.end - a) * ((chain_.at(i + 1) - chain_.at(i)) / h);
            }
            trial.distance = std::max(trial.distance, of_block(segment, l0, l1) + slope);
        }
        return trial;
    }

    // Of the block at the bottom of the stack.
    double of_block(const Segment<D>& segment, const Point& l0, const Point& l1) {
        struct Part {
            int depth;
            Point l0, l1;
        } parts[kDeepest + 2];
        parts[0] = {0, l0, l1};
        int count = 1;
        double worst = 0;
        while (count > 0) {
            const Part part = parts[--count];
            const std::span<P> b(stack_ + std::size_t(count) * size_, size_);
            const double bound = bound_of(b, segment, part.l0, part.l1);
            const bool fine = bound <= tolerance_;
            if (fine && (part.depth >= 2 || bound <= 0.5 * tolerance_)) {
                worst = std::max(worst, bound);
                continue;
            }
            if (part.depth == kDeepest || !std::isfinite(bound)) return bound;
            const std::span<P> right(stack_ + std::size_t(count + 1) * size_, size_);
            halve(b, right);
            const Point middle = project(right[0]), l = 0.5 * (part.l0 + part.l1);
            const double here = D == 1 ? std::abs(middle[0] - l[0]) : distance(middle, segment);
            if (here > tolerance_) return here;
            parts[count++] = {part.depth + 1, part.l0, l};
            parts[count++] = {part.depth + 1, l, part.l1};
        }
        return worst;
    }

    double bound_of(std::span<const P> b, const Segment<D>& segment, const Point& l0, const Point& l1) const {
        if constexpr (D == 1)
            return difference_bound<P>(b, l0, l1);
        else
            return distance_bound<P>(b, segment);
    }

    const Chain<P>& chain_;
    double tolerance_;
    std::size_t most_, size_;
    int last_ = 0;
    std::optional<Point> end_;
    P stack_[(kDeepest + 2) * (kMaxDegree + 1)];
};

// The direction in which a piece leaves its start (or arrives at its end, reversed); zero for a piece that
// is a point.
template <class P>
Vec<Space<P>::kDim> direction(std::span<const P> b, bool at_end, double rounding) {
    const auto n = b.size();
    const auto from = project(at_end ? b[n - 1] : b[0]);
    for (std::size_t i = 1; i < n; ++i) {
        const auto leg = project(at_end ? b[n - 1 - i] : b[i]) - from;
        if (norm(leg) > 1e5 * rounding) return unit(leg);
    }
    return {};
}

template <class P>
bool corner_at(const Chain<P>& chain, int i) {
    const double rounding = chain.error(0);
    const auto in = direction<P>(chain.piece(i - 1), true, rounding);
    const auto out = direction<P>(chain.piece(i), false, rounding);
    return max_abs(in) > 0 && max_abs(out) > 0 && norm(in + out) > kCornerAngle;
}

}  // namespace

template <class P>
Result<Polyline<Space<P>::kDim>> flatten_adaptive(const Chain<P>& chain, double tolerance, std::size_t most) {
    constexpr int D = Space<P>::kDim;
    const double slip = chain.error(11 * chain.degree());
    if (!(tolerance > 1.5 * slip)) return below_rounding(chain, tolerance, 2 * slip);
    Polyline<D> out;
    Greedy<P> greedy(chain, tolerance - slip, most);
    out.points.push_back(project(chain.piece(0)[0]));
    out.parameters.push_back(chain.at(0));
    for (int i = 0; i < chain.pieces(); ++i) {
        const bool end = i + 1 == chain.pieces();
        if (!end && !chain.jumps_at(i + 1) && (D == 1 || !corner_at(chain, i + 1))) continue;
        std::optional<Vec<D>> last;
        if (end && chain.closed()) last = out.points[0];
        if (!greedy.run(i, last, out)) {
            if (out.points.size() > most) return too_many(chain, tolerance - slip, most);
            return refuse(RefusalKind::ill_conditioned, "tolerance",
                          text("cannot be reached at parameter ", out.parameters.back(),
                               ": parameters that doubles can tell apart are too far from each other"));
        }
        if (!end && chain.jumps_at(i + 1)) {
            out.parts.push_back(out.points.size());
            out.points.push_back(project(chain.piece(i + 1)[0]));
            out.parameters.push_back(chain.at(i + 1));
        }
    }
    out.bound += slip;
    out.closed = chain.closed() && out.parts.size() == 1;
    return out;
}

#define FF_INSTANTIATE(P) \
    template Result<Polyline<Space<P>::kDim>> flatten_adaptive(const Chain<P>&, double, std::size_t);
FF_INSTANTIATE(Vec<1>)
FF_INSTANTIATE(Vec<2>)
FF_INSTANTIATE(Vec<3>)
FF_INSTANTIATE(Vec<4>)
FF_INSTANTIATE(Hom<1>)
FF_INSTANTIATE(Hom<2>)
FF_INSTANTIATE(Hom<3>)
FF_INSTANTIATE(Hom<4>)
#undef FF_INSTANTIATE

}  // namespace freiform::detail

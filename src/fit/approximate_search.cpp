// Idea: What a point costs depends on where knots are, not only on how many there are; and half of the error
// at fixed parameters is tangential, which the curve does not have to pay for. So knots follow the data,
// parameters follow the curve, and weights follow the largest error.
//
// Method:
//   1 Grow. From one piece (closed: four) on, every span that holds a point farther away than the tolerance
//   is
//     split in the middle of its points, until there is none.
//   2 Spread. The result tells where the curve needs knots (knot_placement_detail.hpp). Bisection finds the
//     smallest number of spans that suffices when they are spread accordingly.
//   3 Remove. Knots whose jump matters least are left out, many at once, then fewer, then one by one.
// For each set of knots: least squares; every parameter moves to where the curve is nearest to its point (one
// step of Gauss and Newton, not beyond the middle between its neighbours); points with large errors get more
// weight, which leads from least squares towards the smallest maximum [Lawson 1961]; and again, a few times,
// or until the tolerance is met or hopeless.
//
// Cost: O(m p^2) for each least-squares problem, of which there are a few hundred; above 6000 points these
// are solved for some 3000 of them, and only growing (from those knots) and removing for all. Memory O(m p).
//
// Accuracy: only what is measured in the end counts (fit_report_detail.hpp).
//
// References: [deBoor 1978], [Hoschek 1988] (parameters), [Lawson 1961], [Park & Lee 2007] (knots from data).
//
// Why not the removal of knots from the interpolant of all points: it keeps the parameters, and where points
// carry errors of the size of the tolerance it cannot average them. Measured on a noisy circle it keeps
// several times the knots (500 points, noise a 1000th and tolerance a 500th of the radius: 199 coefficients
// instead of 8).
#include "approximate_search_detail.hpp"
#include "fit_report_detail.hpp"
#include "knot_placement_detail.hpp"

#include <freiform/core/sort.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace freiform::detail {

constexpr int kMostRounds = 64;  // of growing: backstop, spans halve

template <int D>
std::optional<typename ApproximationSearch<D>::Candidate> ApproximationSearch<D>::fitted(
    const std::vector<double>& inner, const std::vector<double>& start, int steps) {
    const auto basis = basis_on(inner);
    if (!basis || kept_.size() > std::size_t(basis->size())) return std::nullopt;
    std::optional<Candidate> best;
    std::vector<double> at = start, weight, distance(points_.size());
    std::vector<Vec<D>> error;
    double previous = 0;
    for (int step = 0; step < steps; ++step) {
        if (options_.smoothing == 0 && !detail::check_determined(*basis, at, kept_)) break;
        LeastSquaresSystem system(*basis, detail::values_at(*basis, at), weight, kept_,
                                  {options_.smoothing, options_.smoothing_order});
        ++solves_;
        if (system.factor()) break;
        Net<1, Vec<D>> net({basis->size()});
        const Vec<D> none{};
        system.solve(&points_[0].c[0], kept_.empty() ? &none.c[0] : &kept_values_[0].c[0],
                     &net.flat()[0].c[0], D, !kept_.empty());
        if (!options_.closed)
            for (std::size_t k = 0; k < kept_.size(); ++k) {  // a value at an end is a coefficient
                if (kept_[k].order == 0 && kept_[k].at == start_.front())
                    net.flat().front() = kept_values_[k];
                if (kept_[k].order == 0 && kept_[k].at == end_) net.flat().back() = kept_values_[k];
            }
        auto curve = Curve<Vec<D>>::make({*basis}, std::move(net));
        if (!curve) break;
        detail::errors_at<D>(system.values(), curve->net().flat(), points_, error);
        double largest = 0;
        for (std::size_t i = 0; i < error.size(); ++i)
            largest = std::max(largest, distance[i] = norm(error[i]));
        const double bound = detail::with_rounding(largest, *curve);
        if (!best || bound < best->error) best = Candidate{*curve, at, distance, bound};
        if (good(best) || !(largest > 0)) break;
        // A few per cent are found by weights; more than that only if the steps so far promise it.
        if (step >= 2 && best->error > 3 * options_.tolerance &&
            best->error * std::pow(std::min(largest / previous, 1.0), steps - step) > options_.tolerance)
            break;
        previous = largest;
        if (options_.move_parameters) move_parameters(*curve, at);
        if (step > 0) {
            weight.resize(points_.size(), 1.0);
            double sum = 0;
            for (std::size_t i = 0; i < weight.size(); ++i)
                sum += weight[i] = std::clamp(weight[i] * (0.25 + distance[i] / largest), 1e-3, 1e3);
            for (double& w : weight) w *= double(weight.size()) / sum;
        }
    }
    return best;
}

template <int D>
void ApproximationSearch<D>::move_parameters(const Curve<Vec<D>>& curve, std::vector<double>& at) const {
    const std::size_t m = at.size();
    const std::vector<double> old = at;
    for (std::size_t i = 0, next = 0; i < m; i = next) {
        bool fixed = false;  // equal points share their parameter
        for (next = i; next < m && old[next] == old[i]; ++next) fixed = fixed || fixed_[next];
        if (fixed) continue;
        const auto jet = curve.template jet<1>(old[i]);
        const double step = dot(jet.d[0] - points_[i], jet.d[1]) / dot(jet.d[1], jet.d[1]);
        if (!std::isfinite(step)) continue;
        const double before = old[i] - (i > 0 ? old[i] - old[i - 1] : 0) / 2;
        const double after = old[i] + ((next < m ? old[next] : end_) - old[i]) / 2;
        for (std::size_t k = i; k < next; ++k) at[k] = std::clamp(old[i] - step, before, after);
    }
}

// The inner knots of c and more: every span with a point that is too far away is split between its points.
template <int D>
std::vector<double> ApproximationSearch<D>::split(const Candidate& c) const {
    const auto breaks = c.curve.basis().breaks();
    std::vector<double> inner;
    std::size_t i = 0;
    for (std::size_t s = 0; s + 1 < breaks.size(); ++s) {
        const std::size_t first = i;
        double worst = 0;
        const bool last = s + 2 == breaks.size();
        for (; i < c.at.size() && (last || c.at[i] < breaks[s + 1]); ++i)
            worst = std::max(worst, c.distance[i]);
        if (s > 0) inner.push_back(breaks[s]);
        if (!(worst > 0.999 * options_.tolerance) || i - first < 2) continue;
        const std::size_t middle = first + (i - first) / 2;
        const double t = c.at[middle - 1] + (c.at[middle] - c.at[middle - 1]) / 2;
        if (breaks[s] < t && t < breaks[s + 1]) inner.push_back(t);
    }
    return inner;
}

template <int D>
std::optional<typename ApproximationSearch<D>::Candidate> ApproximationSearch<D>::grown(
    std::vector<double> inner) {
    std::optional<Candidate> best;
    std::vector<double> at = start_;
    for (int round = 0; round < kMostRounds; ++round) {
        auto c = fitted(inner, at, round == 0 ? 40 : 4);
        if (!c) return best;
        if (good(c)) return c;
        auto more = split(*c);
        if (!best || c->error < best->error) best = c;
        if (more.size() == inner.size()) return best;
        inner = std::move(more);
        at = c->at;
    }
    return best;
}

// The last resort: as many coefficients as there are distinct points.
template <int D>
std::optional<typename ApproximationSearch<D>::Candidate> ApproximationSearch<D>::as_many_as_points() {
    std::vector<double> site = start_, inner;
    for (const KeptRow& k : kept_)
        if (k.order > 0) site.push_back(k.at);
    sort(site.begin(), site.end());
    // Sites that repeat are one, but for the derivatives that are kept there.
    const std::size_t derivatives =
        std::size_t(std::count_if(kept_.begin(), kept_.end(), [](const KeptRow& k) { return k.order > 0; }));
    if (derivatives == 0) site.erase(std::unique(site.begin(), site.end()), site.end());
    if (options_.closed) {
        site.erase(std::unique(site.begin(), site.end()), site.end());
        if (site.size() > 1 && site.back() == end_) site.pop_back();
        const bool odd = degree_ % 2 == 1;
        for (std::size_t i = 1; i < site.size(); ++i)
            inner.push_back(odd ? site[i] : site[i - 1] + (site[i] - site[i - 1]) / 2);
    } else {
        if (site.size() < std::size_t(degree_) + 1) return std::nullopt;
        const auto basis = averaged_basis(degree_, site);
        if (!basis) return std::nullopt;
        const auto b = basis->breaks();
        inner.assign(b.begin() + 1, b.end() - 1);
    }
    return fitted(inner, start_, 1);
}

template <int D>
void ApproximationSearch<D>::spread(Candidate& best) {
    // Twice, as the guide gets better. Parameters that have moved belong to the curve that they followed, so
    // the first ones are tried as well; and even knots, where the guide is too coarse to tell.
    for (int pass = 0; pass < 2; ++pass) {
        const Candidate guide = best;
        int high = int(inner_of(best).size()) + 1, low = std::max(options_.closed ? 2 : 1, high / 5) - 1;
        while (high - low > 1) {
            const int middle = low + (high - low) / 2;
            const auto inner = detail::equidistributed(guide.curve, middle);
            auto c = fitted(inner, start_, 10);
            if (!good(c)) c = fitted(inner, guide.at, 10);
            if (!good(c)) c = fitted(even_knots(middle), start_, 10);
            if (good(c)) {
                best = std::move(*c);
                high = middle;
            } else {
                low = middle;
            }
        }
    }
}

template <int D>
void ApproximationSearch<D>::thin(Candidate& best) {
    const int allowed = solves_ + int(std::clamp(2e6 / double(points_.size()), 40.0, 600.0));
    for (std::size_t group = std::max<std::size_t>(inner_of(best).size() / 8, 1); group > 0;) {
        const auto inner = inner_of(best);
        if (inner.empty() || (options_.closed && inner.size() < 2)) return;
        const auto breaks = best.curve.basis().breaks();
        const auto jump = detail::jumps(best.curve, breaks);
        std::vector<double> matter;
        for (std::size_t i = 0; i < inner.size(); ++i) {
            const double a = breaks[i + 1] - breaks[i], b = breaks[i + 2] - breaks[i + 1];
            matter.push_back(jump[i] * std::pow(a * b / (a + b), degree_));
        }
        std::vector<std::size_t> order(inner.size());
        std::iota(order.begin(), order.end(), std::size_t(0));
        sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) {
            return matter[x] != matter[y] ? matter[x] < matter[y] : x < y;
        });
        group = std::min(group, inner.size());
        bool removed = false;
        // Groups of knots in the order of what they matter; of single ones as many as the budget allows.
        for (std::size_t first = 0;
             first + group <= order.size() && first < (group > 1 ? group : order.size()) && !removed;
             first += group) {
            if (solves_ > allowed) return;
            std::vector<char> leave(inner.size(), 0);
            for (std::size_t k = first; k < first + group; ++k) leave[order[k]] = 1;
            std::vector<double> fewer;
            for (std::size_t k = 0; k < inner.size(); ++k)
                if (!leave[k]) fewer.push_back(inner[k]);
            auto c = fitted(fewer, best.at, 8);
            if (!good(c)) continue;
            best = std::move(*c);
            removed = true;
        }
        if (!removed) group /= 2;
    }
}

template <int D>
std::optional<typename ApproximationSearch<D>::Candidate> ApproximationSearch<D>::run(bool& done) {
    auto best = grown(even_knots(options_.closed ? int(std::min<std::size_t>(4, points_.size())) : 1));
    if (!good(best)) {
        auto all = as_many_as_points();
        if (!best || (all && all->error < best->error)) best = std::move(all);
    }
    done = good(best);
    if (!done) return best;
    spread(*best);
    thin(*best);
    return best;
}

template <int D>
std::optional<typename ApproximationSearch<D>::Candidate> ApproximationSearch<D>::run_from(
    const std::vector<double>& inner, bool& done) {
    auto best = grown(inner);
    done = good(best);
    if (done) thin(*best);
    return best;
}

template class ApproximationSearch<1>;
template class ApproximationSearch<2>;
template class ApproximationSearch<3>;
template class ApproximationSearch<4>;

}  // namespace freiform::detail

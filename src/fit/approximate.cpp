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
#include "fit_report_detail.hpp"
#include "knot_placement_detail.hpp"
#include "least_squares_detail.hpp"

#include <freiform/fit/approximate.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace freiform {

namespace {

using detail::KeptRow;
using detail::LeastSquaresSystem;

constexpr int kMostRounds = 64;  // of growing: backstop, spans halve

template <int D>
class Search {
public:
    Search(std::span<const Vec<D>> points, std::vector<double> at, double end, int degree,
           const ApproximateOptions& options, std::span<const KeptPoint<D>> kept)
        : points_(points), degree_(degree), options_(options), start_(std::move(at)), end_(end) {
        fixed_.assign(points.size(), 0);
        fixed_.front() = 1;
        if (!options.closed) fixed_.back() = 1;
        for (const auto& k : kept) {
            fixed_[std::size_t(k.point)] = 1;
            kept_.push_back({start_[std::size_t(k.point)], k.order});
            kept_values_.push_back(k.value);
        }
    }

    struct Candidate {
        Curve<Vec<D>> curve;
        std::vector<double> at;
        std::vector<double> distance;  // of each point
        double error = 0;              // the largest, with rounding
    };

    // Least squares on these inner knots, with parameters and weights that adapt. Nothing where the points do
    // not determine such a curve.
    std::optional<Candidate> fitted(const std::vector<double>& inner, const std::vector<double>& at,
                                    int steps);
    // The answer, or the best that was found.
    std::optional<Candidate> run(bool& done);
    // The same, beginning with knots that are known to be nearly right.
    std::optional<Candidate> run_from(const std::vector<double>& inner, bool& done);
    int solves() const { return solves_; }
    bool good(const std::optional<Candidate>& c) const { return c && c->error <= options_.tolerance; }
    static std::vector<double> inner_of(const Candidate& c) {
        const auto b = c.curve.basis().breaks();
        return {b.begin() + 1, b.end() - 1};
    }

private:
    Result<BSplineBasis> basis_on(const std::vector<double>& inner) const {
        const std::size_t ends = options_.closed ? 1 : std::size_t(degree_) + 1;
        std::vector<double> t(ends, start_.front());
        t.insert(t.end(), inner.begin(), inner.end());
        t.insert(t.end(), ends, end_);
        return options_.closed ? BSplineBasis::periodic(degree_, std::move(t))
                               : BSplineBasis::make(degree_, std::move(t));
    }
    std::vector<double> even_knots(int spans) const {
        std::vector<double> inner;
        for (int k = 1; k < spans; ++k) inner.push_back(start_.front() + (end_ - start_.front()) * k / spans);
        return inner;
    }
    void move_parameters(const Curve<Vec<D>>& curve, std::vector<double>& at) const;
    std::vector<double> split(const Candidate& c) const;
    std::optional<Candidate> grown(std::vector<double> inner);
    std::optional<Candidate> as_many_as_points();
    void spread(Candidate& best);
    void thin(Candidate& best);

    std::span<const Vec<D>> points_;
    int degree_;
    ApproximateOptions options_;
    std::vector<double> start_;
    double end_;
    std::vector<char> fixed_;
    std::vector<KeptRow> kept_;
    std::vector<Vec<D>> kept_values_;
    int solves_ = 0;
};

template <int D>
std::optional<typename Search<D>::Candidate> Search<D>::fitted(const std::vector<double>& inner,
                                                               const std::vector<double>& start, int steps) {
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
void Search<D>::move_parameters(const Curve<Vec<D>>& curve, std::vector<double>& at) const {
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
std::vector<double> Search<D>::split(const Candidate& c) const {
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
std::optional<typename Search<D>::Candidate> Search<D>::grown(std::vector<double> inner) {
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
std::optional<typename Search<D>::Candidate> Search<D>::as_many_as_points() {
    std::vector<double> site = start_, inner;
    for (const KeptRow& k : kept_)
        if (k.order > 0) site.push_back(k.at);
    std::sort(site.begin(), site.end());
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
void Search<D>::spread(Candidate& best) {
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
void Search<D>::thin(Candidate& best) {
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
        std::sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) {
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
std::optional<typename Search<D>::Candidate> Search<D>::run(bool& done) {
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
std::optional<typename Search<D>::Candidate> Search<D>::run_from(const std::vector<double>& inner,
                                                                 bool& done) {
    auto best = grown(inner);
    done = good(best);
    if (done) thin(*best);
    return best;
}

// Of many points every k-th says where the knots have to be; all of them decide.
template <int D>
std::vector<double> knots_from_some(std::span<const Vec<D>> points, const std::vector<double>& at, double end,
                                    int degree, const ApproximateOptions& options, int& solves) {
    constexpr std::size_t kEnough = 3000;
    const std::size_t step = points.size() / kEnough;
    if (step < 2) return {};
    std::vector<Vec<D>> some;
    std::vector<double> some_at;
    for (std::size_t i = 0; i < points.size();
         i = i + 1 < points.size() ? std::min(i + step, points.size() - 1) : points.size())
        some.push_back(points[i]), some_at.push_back(at[i]);
    Search<D> search(some, some_at, end, degree, options, {});
    bool done = false;
    const auto best = search.run(done);
    solves += search.solves();
    return done ? Search<D>::inner_of(*best) : std::vector<double>();
}

// Parameters of the points; equal neighbours share one.
template <int D>
Result<std::vector<double>> shared_parameters(std::span<const Vec<D>> points, const ApproximateOptions& o,
                                              double& end) {
    std::vector<Vec<D>> distinct;
    std::vector<std::size_t> which;
    for (const Vec<D>& q : points) {
        if (distinct.empty() || distinct.back() != q) distinct.push_back(q);
        which.push_back(distinct.size() - 1);
    }
    const bool returns = o.closed && distinct.size() > 1 && distinct.back() == distinct.front();
    if (returns) distinct.pop_back();
    const std::size_t least = o.closed ? 3 : 2;
    if (distinct.size() < least)
        return refuse(RefusalKind::invalid, "points",
                      distinct.size() == 1 && points.size() > 1
                          ? text("all ", points.size(), " points are equal")
                          : text(distinct.size(), distinct.size() == 1 ? " point; " : " different points; ",
                                 o.closed ? "a closed curve" : "a curve", " needs ", least));
    auto at = parameters<D>(distinct, o.spacing, o.closed);
    if (!at) return at;
    end = at->back();
    std::vector<double> out;
    for (const std::size_t k : which) out.push_back(k < distinct.size() ? (*at)[k] : end);
    return out;
}

template <int D>
Result<void> check(std::span<const Vec<D>> points, const ApproximateOptions& o,
                   std::span<const KeptPoint<D>> kept) {
    if (!(o.tolerance > 0) || !std::isfinite(o.tolerance))
        return refuse(RefusalKind::invalid, "tolerance", text(o.tolerance, " is not a positive distance"));
    if (o.degree < 1 || o.degree > kMaxDegree)
        return refuse(o.degree < 1 ? RefusalKind::invalid : RefusalKind::unsupported, "degree",
                      text("degree ", o.degree, " is outside 1..", kMaxDegree));
    if (!(o.smoothing >= 0) || !std::isfinite(o.smoothing))
        return refuse(RefusalKind::invalid, "smoothing", text(o.smoothing, " is not a number >= 0"));
    if (o.smoothing_order < 1 || o.smoothing_order > kMaxDegree)
        return refuse(RefusalKind::invalid, "smoothing_order",
                      text(o.smoothing_order, " is outside 1..", kMaxDegree));
    if (points.size() < 2)
        return refuse(RefusalKind::invalid, "points",
                      text(points.size(), points.size() == 1 ? " point; " : " points; ", "a curve needs 2"));
    if (points.size() > 0x08000000) return refuse(RefusalKind::limit, "points", "more than 2^27 points");
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"),
                          "has a coordinate that is not finite");
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const auto where = text("kept[", i, "]");
        if (kept[i].point < 0 || std::size_t(kept[i].point) >= points.size())
            return refuse(RefusalKind::invalid, where, text("point ", kept[i].point, " does not exist"));
        if (kept[i].order < 0 || kept[i].order > o.degree)
            return refuse(RefusalKind::invalid, where,
                          text("order ", kept[i].order, " is outside 0..", o.degree));
        if (!is_finite(kept[i].value))
            return refuse(RefusalKind::nonfinite, where, "has a coordinate that is not finite");
        for (std::size_t j = 0; j < i; ++j)
            if (kept[j].point == kept[i].point && kept[j].order == kept[i].order)
                return refuse(RefusalKind::invalid, where,
                              text("is about the same derivative as kept[", j, "]"));
        if (kept[i].order == 0 && norm(kept[i].value - points[std::size_t(kept[i].point)]) > o.tolerance)
            return refuse(RefusalKind::invalid, where,
                          text("is farther than the tolerance from point ", kept[i].point));
    }
    return {};
}

}  // namespace

template <int D>
Result<Fitted<D>> approximate(std::span<const Vec<D>> points, const ApproximateOptions& options,
                              std::span<const KeptPoint<D>> kept) {
    if (auto ok = check(points, options, kept); !ok) return std::unexpected(ok.error());
    double end = 0;
    auto at = shared_parameters(points, options, end);
    if (!at) return std::unexpected(at.error());
    // Few points determine a curve of lower degree, which is raised in the end.
    std::size_t conditions = 1;
    for (std::size_t i = 1; i < at->size(); ++i) conditions += (*at)[i] != (*at)[i - 1];
    for (const auto& k : kept) conditions += k.order > 0;
    const int degree = options.closed || options.smoothing > 0
                           ? options.degree
                           : int(std::min<std::size_t>(std::size_t(options.degree), conditions - 1));
    Search<D> search(points, *at, end, degree, options, kept);
    bool done = false;
    int solves = 0;
    std::optional<typename Search<D>::Candidate> best;
    if (const auto inner =
            kept.empty() ? knots_from_some(points, *at, end, degree, options, solves) : std::vector<double>();
        !inner.empty())
        best = search.run_from(inner, done);
    if (!done) best = search.run(done);
    if (!best)
        return refuse(RefusalKind::no_answer, "points",
                      "do not determine a curve: too few of them are different, or the conditions contradict "
                      "each other");
    if (!done)
        return refuse(RefusalKind::no_answer, "tolerance",
                      text("the closest curve found, with ", best->curve.basis().size(),
                           " coefficients, is at a distance of ", best->error));
    auto curve = elevate(best->curve, 0, options.degree - degree);
    if (!curve) return std::unexpected(curve.error());
    std::vector<Datum<D>> values;
    for (const auto& k : kept) values.push_back({best->at[std::size_t(k.point)], k.order, k.value});
    return detail::reported<D>(std::move(*curve), points, std::move(best->at), values,
                               solves + search.solves());
}

#define FF_APPROXIMATE(D)                                                                      \
    template Result<Fitted<D>> approximate(std::span<const Vec<D>>, const ApproximateOptions&, \
                                           std::span<const KeptPoint<D>>);
FF_APPROXIMATE(1)
FF_APPROXIMATE(2)
FF_APPROXIMATE(3)
FF_APPROXIMATE(4)

}  // namespace freiform

// The search for the smallest curve within a tolerance of points: approximate_search.cpp.
#pragma once
#include "least_squares_detail.hpp"

#include <freiform/fit/approximate.hpp>

#include <optional>
#include <vector>

namespace freiform::detail {

template <int D>
class ApproximationSearch {
public:
    ApproximationSearch(std::span<const Vec<D>> points, std::vector<double> at, double end, int degree,
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

}  // namespace freiform::detail

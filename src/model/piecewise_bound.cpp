#include "piecewise_bound_detail.hpp"

#include <freiform/core/result.hpp>
#include <freiform/core/sort.hpp>

#include <algorithm>

namespace freiform {

namespace {

constexpr double kEven = 1.25;  // largest by smallest: little is to be had

}  // namespace

double PiecewiseBound::steady(Interval on) const {
    FF_REQUIRE(!pieces_.empty());
    auto p = std::upper_bound(pieces_.begin(), pieces_.end(), on.lo,
                              [](double t, const Piece& x) { return t < x.end; });
    if (p == pieces_.end()) --p;
    const auto last = std::prev(pieces_.end());
    if (p == last || on.hi <= p->end) return p->most;
    std::vector<std::pair<double, double>> parts;  // what is the most, the length
    parts.reserve(8);
    double sum = 0, least = p->most;
    for (double at = on.lo;; ++p) {
        const double end = p == last ? on.hi : std::min(p->end, on.hi);
        parts.push_back({p->most, end - at});
        sum += end - at;
        least = std::min(least, p->most);
        at = end;
        if (!(at < on.hi)) break;
    }
    sort(parts.begin(), parts.end());
    const double most = parts.back().first;
    if (!(most > kEven * least)) return most;
    double longer = 0, excess = 0;  // of those that exceed the median
    std::size_t k = parts.size();
    while (longer + parts[k - 1].second < sum / 2) longer += parts[--k].second;
    const double median = parts[k - 1].first;
    for (std::size_t i = k; i < parts.size(); ++i) excess += (parts[i].first - median) * parts[i].second;
    const double rounding = 1 + 0x1p-51 * (double(parts.size()) + 8);
    return std::min(most, (median + 2 * excess / on.length()) * rounding);
}

}  // namespace freiform

#include "piecewise_bound_detail.hpp"

#include <freiform/core/result.hpp>

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
    struct Part {
        double most, length;
    };
    std::vector<Part> parts;
    parts.reserve(8);
    double sum = 0, least = p->most, most = 0;
    for (double at = on.lo;; ++p) {
        const double end = p == last ? on.hi : std::min(p->end, on.hi);
        parts.push_back({p->most, end - at});
        sum += parts.back().length;
        least = std::min(least, p->most), most = std::max(most, p->most);
        at = end;
        if (!(at < on.hi)) break;
    }
    if (!(most > kEven * least)) return most;
    std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.most > b.most; });
    double longer = 0, excess = 0;  // of those that exceed the median
    std::size_t k = 0;
    while (longer + parts[k].length < sum / 2) longer += parts[k++].length;
    const double median = parts[k].most;
    for (std::size_t i = 0; i < k; ++i) excess += (parts[i].most - median) * parts[i].length;
    const double rounding = 1 + 0x1p-51 * (double(parts.size()) + 8);
    return std::min(most, (median + 2 * excess / on.length()) * rounding);
}

}  // namespace freiform

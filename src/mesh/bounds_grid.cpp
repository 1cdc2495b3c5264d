#include "bounds_grid_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <limits>

namespace freiform {

BoundsGrid::BoundsGrid(const Box<2>& whole, const Vec<2>& part) : whole_(whole) {
    for (int d = 0; d < 2; ++d) {
        const double size = whole.hi[d] - whole.lo[d], count = std::min(size / part[d], kMostCells);
        count_[std::size_t(d)] = count >= 1 ? int(count) : 1;
        scale_[d] = count / size < kInfinity ? count_[std::size_t(d)] / size : 0;
    }
    cells_.resize(std::size_t(count_[0]) * std::size_t(count_[1]));
}

int BoundsGrid::cell_of(double x, std::size_t d) const {
    return std::clamp(int((x - whole_.lo[int(d)]) * scale_[int(d)]), 0, count_[d] - 1);
}

BoundsGrid::Range BoundsGrid::range_of(const Box<2>& box) const {
    Range r;
    for (std::size_t d = 0; d < 2; ++d)
        r.lo[d] = cell_of(box.lo[int(d)], d), r.hi[d] = cell_of(box.hi[int(d)], d);
    return r;
}

BoundsGrid::Cell BoundsGrid::above(const Bounds& bounds) {
    using Limits = std::numeric_limits<float>;
    Cell out;
    for (std::size_t k = 0; k < out.size(); ++k) {
        const float near = bounds[k] > double(Limits::max()) ? Limits::infinity() : float(bounds[k]);
        const float step = std::max(near * Limits::epsilon(), Limits::denorm_min());  // one number at least
        out[k] = double(near) < bounds[k] ? near + step : near;
    }
    return out;
}

std::optional<BoundsGrid::Bounds> BoundsGrid::over(const Box<2>& box) const {
    if (cells_.empty() || !whole_.contains(box.lo) || !whole_.contains(box.hi)) return std::nullopt;
    const Range r = range_of(box);
    if ((r.hi[0] - r.lo[0] + 1) * (r.hi[1] - r.lo[1] + 1) > kMostLookedAt) return std::nullopt;
    Cell all{};
    for (int i = r.lo[0]; i <= r.hi[0]; ++i)
        for (int j = r.lo[1]; j <= r.hi[1]; ++j) include(all, cells_[place(i, j)]);
    return Bounds{all[0], all[1], all[2], all[3]};
}

}  // namespace freiform

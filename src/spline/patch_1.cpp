#include "patch_detail.hpp"

namespace freiform {

FF_INSTANTIATE_PATCHES(1, 1)
FF_INSTANTIATE_PATCHES(1, 2)
FF_INSTANTIATE_PATCHES(1, 3)
FF_INSTANTIATE_PATCHES(1, 4)

template <int D>
Result<std::vector<Hom<D>>> make_rational(std::span<const Vec<D>> points, std::span<const double> weights) {
    if (points.size() != weights.size())
        return refuse(RefusalKind::invalid, "weights",
                      text(weights.size(), " weights for ", points.size(), " points"));
    std::vector<Hom<D>> out;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!std::isfinite(weights[i]) || !is_finite(points[i]) ||
            !is_finite(weighted(points[i], weights[i])))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"),
                          "point, weight or their product is not finite");
        out.push_back(weighted(points[i], weights[i]));
    }
    return out;
}
template Result<std::vector<Hom<1>>> make_rational(std::span<const Vec<1>>, std::span<const double>);
template Result<std::vector<Hom<2>>> make_rational(std::span<const Vec<2>>, std::span<const double>);
template Result<std::vector<Hom<3>>> make_rational(std::span<const Vec<3>>, std::span<const double>);
template Result<std::vector<Hom<4>>> make_rational(std::span<const Vec<4>>, std::span<const double>);

}  // namespace freiform

// Where a surface is not smooth: knots of low multiplicity of what it is made of, and the ends of splines.
#pragma once
#include <freiform/core/visit.hpp>
#include <freiform/spline/geometry.hpp>

#include <algorithm>
#include <vector>

namespace freiform {

// A place along one axis of the surface with less than two continuous derivatives.
struct SurfaceSeam {
    double at = 0;
    int smooth = 0;  // derivatives that are continuous; -1 at a tear
};

// `less`: by how much the surface is less smooth than the spline.
inline void add_seams(std::vector<SurfaceSeam>& seams, const BSplineBasis& basis, int less) {
    const auto breaks = basis.breaks();
    for (std::size_t i = 0; i < breaks.size(); ++i) {
        const bool end = i == 0 || i + 1 == breaks.size();
        const int smooth = end ? 0 : basis.degree() - basis.multiplicity(breaks[i]) - less;
        if (smooth < 2) seams.push_back({breaks[i], std::max(smooth, -1)});
    }
}

inline void add_seams(std::vector<SurfaceSeam>& seams, const CurveGeometry<3>& profile, int less) {
    visit_one(
        [&](const auto& c) {
            if constexpr (requires { c.net(); }) add_seams(seams, c.basis(), less);
        },
        profile);
}

inline std::array<std::vector<SurfaceSeam>, 2> seams_of(const SurfaceGeometry& outer) {
    const auto* offset = std::get_if<OffsetSurface>(&outer);
    const int less = offset ? 1 : 0;
    std::array<std::vector<SurfaceSeam>, 2> seams;
    visit_one(
        [&](const auto& s) {
            using S = std::remove_cvref_t<decltype(s)>;
            if constexpr (std::same_as<S, Extrusion>) {
                add_seams(seams[0], s.profile, less);
            } else if constexpr (std::same_as<S, Revolution>) {
                add_seams(seams[1], s.profile, less);
            } else if constexpr (!std::same_as<S, OffsetSurface>) {
                add_seams(seams[0], s.basis(0), less);
                add_seams(seams[1], s.basis(1), less);
            }
        },
        offset ? *offset->base : outer);
    return seams;
}

}  // namespace freiform

// Curves and surfaces of every sort as rational Bezier pieces on [0, 1], with the way back to their
// parameters.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/spline/geometry.hpp>

#include <vector>

namespace freiform {

// The parameter at the place s of a piece: linear over `on` (bow = 0), or the middle of `on` plus
// 2 atan(bow (2 s - 1)) (bow > 0: an angle), or plus 2 atanh(-bow (2 s - 1)) (bow < 0: of a hyperbola).
struct ParameterMap {
    Interval on;
    double bow = 0;
    double operator()(double s) const;
    // Bounds of the first two derivatives.
    double slope() const;
    double bend() const;
};

template <int D>
struct CurvePiece {
    ParameterMap map;
    std::vector<Hom<D>> net;
};

// Over `on`, in order. Refuses infinite intervals and closed splines over more than a thousand periods.
template <int D>
Result<std::vector<CurvePiece<D>>> rational_pieces(const CurveGeometry<D>& curve, Interval on);

struct SurfacePieces {
    std::vector<ParameterMap> u, v;  // columns and rows
    Index<2> degree{};
    std::vector<Net<2, Hom<3>>> nets;  // of column i and row j: nets[i * v.size() + j]
    double distance = 0;               // along the normal: of an offset surface
};

// The part over `on`, where splines end cut back to them. Refuses what is above, and (unsupported) offsets of
// offsets.
Result<SurfacePieces> rational_pieces(const SurfaceGeometry& surface, std::array<Interval, 2> on);

}  // namespace freiform

// Surfaces of bicubic Bezier patches through a grid of points, continuous in the first derivatives, with
// twists to choose: what is left when points and tangents are given.
#pragma once
#include <freiform/fit/local.hpp>

namespace freiform {

// The mixed derivatives S_uv at the points.
enum class Twists {
    tensor,  // of the tensor product of the scheme of catmull_rom
    zero,    // 0: Ferguson's patches, with flat spots
    adini,   // of the Coons patch between the curves through the neighbouring points
    bessel,  // of the biquadratic through the point and its eight neighbours
};
std::string_view name_of(Twists twists);

// A grid of m x n points with derivatives by the first and the second parameter, all of the same extents.
template <int D>
struct GridDerivatives {
    Net<2, Vec<D>> du, dv;
};

// The derivatives of the scheme of catmull_rom along both axes: parabolas through three points; at open ends
// f'' = 0. Parameters as there: increasing, of a closed axis one more, the end of the period.
template <int D>
Result<GridDerivatives<D>> grid_derivatives(const Net<2, Vec<D>>& points,
                                            const std::array<std::span<const double>, 2>& at,
                                            const std::array<bool, 2>& closed = {});

// Adini reproduces surfaces f(u) + v g(u) + h(v) + u k(v) where the derivatives are theirs; Bessel
// biquadratics.
template <int D>
Result<Net<2, Vec<D>>> twists(const Net<2, Vec<D>>& points, const GridDerivatives<D>& derivatives,
                              const std::array<std::span<const double>, 2>& at,
                              const std::array<bool, 2>& closed, Twists kind);

// The patches with these points, derivatives and twists: (m - 1)(n - 1) of them, of a closed axis one more.
// All four are met, the points to the bit; so patches join with C^1.
template <int D>
Result<Surface<Vec<D>>> bicubic_through(const Net<2, Vec<D>>& points, const GridDerivatives<D>& derivatives,
                                        const Net<2, Vec<D>>& twists,
                                        const std::array<std::span<const double>, 2>& at,
                                        const std::array<bool, 2>& closed = {});

// All three in one: 7 x 7 points make 36 patches.
//   auto s = bicubic_through(grid, {u, v}, {false, false}, Twists::adini);
template <int D>
Result<Surface<Vec<D>>> bicubic_through(const Net<2, Vec<D>>& points,
                                        const std::array<std::span<const double>, 2>& at,
                                        const std::array<bool, 2>& closed = {}, Twists kind = Twists::tensor);

}  // namespace freiform

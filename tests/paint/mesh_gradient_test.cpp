#include "square_ring.hpp"

#include <freiform/paint/mesh_gradient.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

TEST(PaintMeshGradient, is_a_shading_of_patches_in_pdf_and_a_picture_in_png) {
    const auto square = test::square_ring();
    const std::array<Colour, 4> corners = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}}};
    const auto g = *MeshGradient::coons(square, corners);
    const auto pdf = to_pdf(*g.pieces(1), g.box(), 300);
    ASSERT_TRUE(pdf);
    EXPECT_TRUE(pdf->starts_with("%PDF"));
    EXPECT_NE(pdf->find("/ShadingType 7"), pdf->npos);
    EXPECT_FALSE(to_pdf({}, {{{0, 0}}, {{1, 0}}}, 300));
    const auto png = png_of(*picture_of(std::array{g}, g.box(), 32));
    ASSERT_TRUE(png);
    EXPECT_EQ(png->substr(1, 3), "PNG");
}

}  // namespace
}  // namespace freiform

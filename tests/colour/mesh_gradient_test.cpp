#include "random.hpp"
#include "refusal.hpp"
#include "square_ring.hpp"

#include <freiform/colour/mesh_gradient.hpp>
#include <freiform/make/coons.hpp>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Random;

const std::array<Colour, 4> kCorners = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}}};

std::array<Vec<2>, 12> ring(Random& random) {
    auto p = test::square_ring();
    for (Vec<2>& x : p) x += Vec<2>{{random.real(-0.3, 0.3), random.real(-0.3, 0.3)}};
    return p;
}

TEST(MeshGradient, coons_patches_blend_their_boundary) {
    Random random(51);
    for (int round = 0; round < 20; ++round) {
        const auto p = ring(random);
        const auto g = *MeshGradient::coons(p, kCorners);
        const auto cubic = [](const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d, double t) {
            const double s = 1 - t;
            return s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d;
        };
        for (double u = 0; u <= 1; u += 0.25)
            for (double v = 0; v <= 1; v += 0.25) {
                const Vec<2> left = cubic(p[0], p[1], p[2], p[3], v),
                             right = cubic(p[9], p[8], p[7], p[6], v),
                             low = cubic(p[0], p[11], p[10], p[9], u),
                             high = cubic(p[3], p[4], p[5], p[6], u);
                const Vec<2> bilinear =
                    (1 - u) * (1 - v) * p[0] + (1 - u) * v * p[3] + u * v * p[6] + u * (1 - v) * p[9];
                const Vec<2> expected = (1 - u) * left + u * right + (1 - v) * low + v * high - bilinear;
                EXPECT_LE(norm(g.point(u, v) - expected), 1e-14);
            }
        EXPECT_EQ(g.colour(0, 0), kCorners[0]);
        EXPECT_EQ(g.colour(0, 1), kCorners[1]);
        EXPECT_EQ(g.colour(1, 1), kCorners[2]);
        EXPECT_EQ(g.colour(1, 0), kCorners[3]);
        EXPECT_NEAR(g.colour(0.5, 0.5).r, 0.5, 1e-15);
    }
}

TEST(MeshGradient, pieces_are_the_surface) {
    Random random(52);
    std::vector<Vec<2>> net;
    std::vector<Colour> colours;
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 4; ++j) {
            net.push_back({{i + random.real(-0.2, 0.2), j + random.real(-0.2, 0.2)}});
            colours.push_back({random.real(0.6, 1), random.real(0.3, 0.6), random.real(0, 0.3)});
        }
    const auto surface =
        *Surface<Vec<2>>::make({*BSplineBasis::clamped_uniform(2, 5), *BSplineBasis::clamped_uniform(1, 4)},
                               Net<2, Vec<2>>({5, 4}, net));
    for (const ColourSpace space : {ColourSpace::srgb, ColourSpace::oklab, ColourSpace::oklch}) {
        const auto g = *MeshGradient::make(surface, colours, space);
        const int cells = g.cells_for(0.01);
        const auto pieces = *g.pieces(cells);
        ASSERT_EQ(pieces.size(), std::size_t(9 * cells * cells));
        double off = 0;
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            const int row = int(k) / (3 * cells), column = int(k) % (3 * cells);
            const Interval u = surface.domain()[0], v = surface.domain()[1];
            const auto at = [&](double s, double t) {
                return Param<2>{u.lo + u.length() * (row + s) / (3 * cells),
                                v.lo + v.length() * (column + t) / (3 * cells)};
            };
            for (const double s : {0.0, 0.3, 1.0})
                for (const double t : {0.0, 0.6, 1.0}) {
                    Vec<2> q{};
                    const auto b = [](int i, double x) {
                        return std::array{(1 - x) * (1 - x) * (1 - x), 3 * x * (1 - x) * (1 - x),
                                          3 * x * x * (1 - x), x * x * x}[std::size_t(i)];
                    };
                    for (int i = 0; i < 4; ++i)
                        for (int j = 0; j < 4; ++j)
                            q += b(i, s) * b(j, t) * pieces[k].net[std::size_t(i)][std::size_t(j)];
                    EXPECT_LE(norm(q - surface(at(s, t))), 1e-13);
                    const Colour c = g.colour(at(s, t)[0], at(s, t)[1]);
                    const auto& corner = pieces[k].corner;
                    const double mixed = (1 - s) * ((1 - t) * corner[0][0].r + t * corner[0][1].r) +
                                         s * ((1 - t) * corner[1][0].r + t * corner[1][1].r);
                    off = std::max(off, std::abs(mixed - c.r));
                }
        }
        EXPECT_LE(off, 0.015) << name_of(space);
    }
}

// Every sample inside is painted once, none is left between triangles; what is outside stays.
TEST(MeshGradient, pictures_have_no_cracks) {
    Random random(53);
    for (int round = 0; round < 6; ++round) {
        const std::array<Colour, 4> black{};
        const auto g = *MeshGradient::coons(ring(random), black);
        Box<2> box = g.box();
        const auto image = *picture_of(std::array{g}, box, 160);
        // Within a row, and away from the boundary, everything between two black pixels is black.
        for (int y = 0; y < image.height; ++y) {
            int changes = 0;
            for (int x = 0; x + 1 < image.width; ++x) {
                const int a = image.pixel(x, y)[0], b = image.pixel(x + 1, y)[0];
                changes += (a < 128) != (b < 128);
            }
            EXPECT_LE(changes, 4) << y;
        }
        // Half opaque, twice painted would be darker.
        std::array<Colour, 4> grey;
        grey.fill({0, 0, 0, 0.5});
        const auto half = *picture_of(std::array{*MeshGradient::coons(ring(random), grey)}, box, 160);
        int inside = 0;
        for (int y = 0; y < half.height; ++y)
            for (int x = 0; x < half.width; ++x) {
                EXPECT_GE(half.pixel(x, y)[0], 127);
                inside += half.pixel(x, y)[0] <= 128;
            }
        EXPECT_GT(inside, 10000);
    }
}

TEST(MeshGradient, pictures_show_the_colours_at_their_places) {
    const auto square = test::square_ring();
    for (const ColourSpace space : {ColourSpace::srgb, ColourSpace::linear, ColourSpace::oklab}) {
        const auto g = *MeshGradient::coons(square, kCorners, space);
        const auto image = *picture_of(std::array{g}, g.box(), 90);
        ASSERT_EQ(image.height, 90);
        for (const int x : {0, 20, 45, 89})
            for (const int y : {0, 33, 89}) {
                const Colour c = g.colour((x + 0.5) / 90, 1 - (y + 0.5) / 90);
                const unsigned char* p = image.pixel(x, y);
                EXPECT_NEAR(p[0], 255 * c.r, 3);
                EXPECT_NEAR(p[1], 255 * c.g, 3);
                EXPECT_NEAR(p[2], 255 * c.b, 3);
            }
    }
}

TEST(MeshGradient, refuses_what_does_not_fit) {
    const auto surface = *Surface<Vec<2>>::make({*BSplineBasis::bezier(1), *BSplineBasis::bezier(4)},
                                                Net<2, Vec<2>>({2, 5}, std::vector<Vec<2>>(10)));
    test::expect_refusal(MeshGradient::make(surface, kCorners), RefusalKind::invalid, "colours", "10");
    std::vector<Colour> ten(10);
    ten[3].g = 2;
    test::expect_refusal(MeshGradient::make(surface, ten), RefusalKind::invalid, "colours[3]");
    ten[3].g = 1;
    const auto flat = *MeshGradient::make(surface, ten);
    test::expect_refusal(flat.pieces(1), RefusalKind::unsupported, "surface");
    test::expect_refusal(picture_of(std::array{flat}, flat.box(), 10), RefusalKind::invalid, "box");
    test::expect_refusal(picture_of(std::array{flat}, {{{0, 0}}, {{1, 1e6}}}, 1000), RefusalKind::limit,
                         "width");
}

}  // namespace
}  // namespace freiform

// Trimmed squares from above against their exact regions.
#include "compared_pictures.hpp"
#include "support/random.hpp"
#include "support/solids.hpp"

#include <freiform/gpu/surfaces.hpp>
#include <freiform/trim/inside.hpp>

#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using Loops = std::vector<std::vector<CurveGeometry<2>>>;

// A wavy ring with a hole.
Loops random_loops(test::Random& random) {
    std::vector<double> breaks;
    for (int i = 0; i <= 9; ++i) breaks.push_back(i);
    std::vector<Vec<2>> net;
    for (int i = 0; i < 9; ++i) {
        const double r = random.real(0.15, 0.48), a = 2 * test::kPi * i / 9;
        net.push_back({{0.5 + r * std::cos(a), 0.5 + r * std::sin(a)}});
    }
    return {{Curve<Vec<2>>::trusted({*BSplineBasis::periodic(3, breaks)}, Net<1, Vec<2>>({9}, net))},
            {Conic<2>{ConicKind::ellipse, {{0.5, 0.5}}, {{0.07, 0.02}}, {{-0.01, 0.05}}}}};
}

SurfaceBuffers trimmed_square(const Loops& loops, const RenderOptions& options) {
    ModelBuilder builder;
    const auto basis = *BSplineBasis::bezier(1);
    const auto square = *Surface<Vec<3>>::make(
        {basis, basis}, Net<2, Vec<3>>({2, 2}, {{{0, 0, 0}}, {{0, 1, 0}}, {{1, 0, 0}}, {{1, 1, 0}}}));
    EXPECT_TRUE(builder.add_trimmed(square, loops));
    const Model model = *std::move(builder).finish();
    return test::must(surface_buffers(
        model, {.edge_tolerance = summary(model).box.diagonal() / 16000, .colour = options.colour}));
}

// What part of each pixel the region covers, and if it is grown or shrunk by half a pixel in both directions.
struct Shares {
    double exact = 0, grown = 0, shrunk = 0;
};
class ExactPicture {
public:
    // The frame fills the picture but for the margin, in one direction or the other.
    ExactPicture(const Loops& loops, const std::vector<Vec<3>>& extent, const RenderOptions& options)
        : width_(options.width), height_(options.height), columns_(kPer * width_ + 2 * kHalf) {
        Box<3> box;
        for (const Vec<3>& p : extent) box.add(p);
        const double margin = 2 * options.margin * height_;
        const double scale = std::min((width_ - margin) / (box.hi[0] - box.lo[0]),
                                      (height_ - margin) / (box.hi[1] - box.lo[1]));
        const auto query = test::must(InsideQuery::make(loops, 1e-12));
        const int rows = kPer * height_ + 2 * kHalf;
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns_; ++i) {
                const double x = (i - kHalf + 0.5) / kPer, y = (j - kHalf + 0.5) / kPer;
                const Vec<2> at{{(x - width_ / 2.0) / scale + (box.lo[0] + box.hi[0]) / 2,
                                 (height_ / 2.0 - y) / scale + (box.lo[1] + box.hi[1]) / 2}};
                is_in_.push_back(query.at(at).place != Place::outside);
            }
    }
    Shares at(int x, int y) const {
        Shares out;
        for (int i = kPer * x; i < kPer * (x + 1); ++i)
            for (int j = kPer * y; j < kPer * (y + 1); ++j) {
                int around = 0;
                for (int k = -kHalf; k <= kHalf; ++k)
                    for (int l = -kHalf; l <= kHalf; ++l) around += is_in(i + k, j + l);
                out.exact += is_in(i, j), out.grown += around > 0;
                out.shrunk += around == (2 * kHalf + 1) * (2 * kHalf + 1);
            }
        for (double* share : {&out.exact, &out.grown, &out.shrunk}) *share /= kPer * kPer;
        return out;
    }

private:
    static constexpr int kPer = 4, kHalf = 2;  // places in a pixel, in half a pixel
    int is_in(int i, int j) const { return is_in_[std::size_t((j + kHalf) * columns_ + i + kHalf)]; }
    int width_, height_, columns_;
    std::vector<char> is_in_;
};

struct EdgeErrors {
    int beyond = 0, boundary = 0;  // pixels that show more or less than half a pixel allows; that are crossed
    double area = 0;               // too much of it, in pixels
    Vec<2> moved{};                // how far the picture fits best, in pixels
};
EdgeErrors errors_of(const Image& drawn, const ExactPicture& exact) {
    constexpr double kSample = 0.26;  // of four, one may stand for more or less than its quarter
    EdgeErrors out;
    const int full = test::background(drawn, 0, 0);
    double xx = 0, xy = 0, yy = 0, x_off = 0, y_off = 0;
    for (int y = 1; y + 1 < drawn.height; ++y)
        for (int x = 1; x + 1 < drawn.width; ++x) {
            const double share = 1 - double(test::background(drawn, x, y)) / full;
            const Shares s = exact.at(x, y);
            const double more = s.grown == 0 ? 0.02 : kSample, less = s.shrunk == 1 ? 0.1 : kSample;
            out.beyond += share > s.grown + more || share < s.shrunk - less;
            out.boundary += s.exact > 0 && s.exact < 1;
            out.area += share - s.exact;
            if (s.grown == s.shrunk) continue;
            const double dx = (exact.at(x - 1, y).exact - exact.at(x + 1, y).exact) / 2,
                         dy = (exact.at(x, y - 1).exact - exact.at(x, y + 1).exact) / 2,
                         off = share - s.exact;
            xx += dx * dx, xy += dx * dy, yy += dy * dy, x_off += dx * off, y_off += dy * off;
        }
    const double det = xx * yy - xy * xy;
    out.moved = {{(yy * x_off - xy * y_off) / det, (xx * y_off - xy * x_off) / det}};
    return out;
}

class TrimmedEdges : public testing::TestWithParam<SurfacePipeline> {};

// With seams, which are wider than nothing, and without them, for they could hide what trimming does wrong.
TEST_P(TrimmedEdges, are_within_half_a_pixel) {
    RenderOptions options;
    options.width = 160, options.height = 120, options.supersampling = 1;
    options.outlines = false;
    options.top = options.bottom = {1, 0, 1, 1};
    options.colour = {0.6, 0.6, 0.6, 1};
    options.view = *parse_view("top");
    test::Random random(7);
    for (int round = 0; round < 2; ++round) {
        const Loops loops = random_loops(random);
        SurfaceBuffers buffers = trimmed_square(loops, options);
        options.frame = buffers.extent;
        const ExactPicture exact(loops, buffers.extent, options);
        for (const bool seams : {true, false}) {
            if (!seams) buffers.seams.clear();
            auto renderer = SurfaceRenderer::make(buffers, GetParam());
            if (!renderer && renderer.error().kind == RefusalKind::unavailable)
                GTEST_SKIP() << renderer.error().message;
            const EdgeErrors e = errors_of(test::must(test::must(std::move(renderer)).draw(options)), exact);
            EXPECT_EQ(e.beyond, 0) << seams;
            EXPECT_GT(e.boundary, 150);
            EXPECT_LT(std::abs(e.area), (seams ? 0.4 : 0.05) * e.boundary) << seams;
            EXPECT_LT(norm(e.moved), 0.1) << seams << " " << e.moved[0] << " " << e.moved[1];
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Pipelines, TrimmedEdges,
                         testing::Values(SurfacePipeline::tessellation, SurfacePipeline::grid),
                         [](const auto& made) {
                             return made.param == SurfacePipeline::grid ? "grid" : "tessellation";
                         });

}  // namespace
}  // namespace freiform

// Every kernel there is against exact rational arithmetic: those that this processor runs, those for ARM
// (NEON) and for WebAssembly (SIMD128), compiled by another compiler and run by an emulator.
#include <freiform/spline/prepared.hpp>

#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <prepared.hpp>
#include <random.hpp>
#include <reference.hpp>
#include <remote_kernels.hpp>
#include <sanitizer.hpp>

namespace freiform {
namespace {

using test::Random;
using test::Rational;
using test::RemoteKernels;

class EveryKernel : public testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        const std::string_view on = GetParam();
        if (on == "here") return;
        const std::string_view command = on == "neon" ? FREIFORM_ARM_KERNELS : FREIFORM_WASM_KERNELS;
        if (command.empty())
            GTEST_SKIP()
                << (on == "neon"
                        ? "aarch64-linux-gnu-g++ and qemu-aarch64 were not there (tools/setup.sh ci), or "
                          "FREIFORM_QUICK leaves them out"
                        : "clang++-22 with what it takes for WebAssembly, and node, were not there "
                          "(tools/setup.sh ci), or FREIFORM_QUICK leaves them out");
        std::vector<std::string> words(1);
        for (const char c : command) {
            if (c == '|')
                words.emplace_back();
            else
                words.back() += c;
        }
        remote_ = std::make_unique<RemoteKernels>(words);
        ASSERT_TRUE(remote_->running()) << command;
        ASSERT_EQ(remote_->kernels().name, on);
    }
    template <class F>
    void with_each(F&& check) {
        if (!remote_) return test::with_every_variant(check);
        SCOPED_TRACE(GetParam());
        const kernel::Kernels& before = kernel::kernels();
        kernel::choose(remote_->kernels());
        check();
        kernel::choose(before);
    }

private:
    std::unique_ptr<RemoteKernels> remote_;
};
INSTANTIATE_TEST_SUITE_P(On, EveryKernel, testing::Values("here", "neon", "simd128"),
                         [](const auto& on) { return std::string(on.param); });

// The largest errors, by the order of the derivative, in units of 2^-53 c prod_d (2 p_d / h_d)^a_d: c is the
// largest coordinate of a control point, h_d the length of the span, p_d the degree, a_d how often the
// derivative goes along the axis; of what is rational times (W / w)^|a|, W and w the largest and the smallest
// weight. So 2 p c / h bounds the derivative of a polynomial curve, and 2 p / h W / w that of the weight over
// the weight.
struct Errors {
    double order[3] = {};
    double normal = 0;     // in units of those of its two tangents, seen from their product
    double share[3] = {};  // of the proven bounds
    double normal_share = 0;
    void take(const Errors& other) {
        for (int k = 0; k < 3; ++k) {
            order[k] = std::max(order[k], other.order[k]);
            share[k] = std::max(share[k], other.share[k]);
        }
        normal = std::max(normal, other.normal), normal_share = std::max(normal_share, other.normal_share);
    }
};

// An exact number as a sum of two doubles, which is off by 2^-106 of it.
struct Twice {
    double high = 0, low = 0;
    explicit Twice(const Rational& x)
        : high(x.convert_to<double>()), low(Rational(x - Rational(high)).convert_to<double>()) {}
};
double gap(double found, const Twice& exact) { return std::abs((found - exact.high) - exact.low); }

// A patch, the points of a grid on it and what is exact at a few of them, for exact arithmetic is slow.
template <std::size_t N, class P>
struct ExactGrid {
    using Point = PointOf<P>;
    Patch<N, P> patch;
    std::array<std::vector<double>, N> axes;
    std::vector<Param<N>> at;
    std::vector<std::size_t> judged;  // points of `at`
    std::vector<std::vector<std::vector<Twice>>> jets;
    std::vector<Vec<3>> products;  // S_u x S_v
    double largest = 0;            // coordinate of a control point
    double weights = 1;            // the largest over the smallest

    ExactGrid(Random& random, Patch<N, P> of, const std::array<int, N>& counts) : patch(std::move(of)) {
        for (const P& p : patch.net().flat()) largest = std::max(largest, max_abs(project(p)));
        if constexpr (Space<P>::kRational) {
            double least = std::numeric_limits<double>::infinity(), most = 0;
            for (const P& p : patch.net().flat())
                least = std::min(least, p.weight()), most = std::max(most, p.weight());
            weights = most / least;
        }
        Index<N> extent{};
        for (std::size_t d = 0; d < N; ++d) {
            const auto some = test::parameters(random, patch.basis(int(d)), counts[d]);
            for (int i = 0; i < counts[d]; ++i)
                axes[d].push_back(
                    some[random.chance(0.3) ? std::size_t(random.integer(0, int(some.size()) - 1))
                                            : some.size() - 1 - std::size_t(i)]);
            extent[d] = counts[d];
        }
        each_index(extent, [&](const Index<N>& i) {
            std::array<double, N> u{};
            for (std::size_t d = 0; d < N; ++d) u[d] = axes[d][std::size_t(i[d])];
            at.push_back(test::to_param<N>(u));
            if (!random.chance(0.3)) return;
            judged.push_back(at.size() - 1);
            const auto exact = test::jet_of<Rational>(patch, at.back(), 2);
            jets.emplace_back();
            for (const auto& slot : exact) jets.back().emplace_back(slot.begin(), slot.end());
            if constexpr (N == 2 && Point::kCoords == 3) {
                const auto &a = exact[1], &b = exact[2];
                Vec<3> n;
                for (std::size_t c = 0, d = 1, e = 2; c < 3; ++c, d = (d + 1) % 3, e = (e + 1) % 3)
                    n[int(c)] = Rational(a[d] * b[e] - a[e] * b[d]).convert_to<double>();
                products.push_back(n);
            }
        });
    }
    std::array<std::span<const double>, N> views() const {
        std::array<std::span<const double>, N> out;
        for (std::size_t d = 0; d < N; ++d) out[d] = axes[d];
        return out;
    }
    double unit(std::size_t i, const Index<N>& orders) const {
        double unit = largest * 0x1p-53;
        for (std::size_t d = 0; d < N; ++d) {
            const BSplineBasis& basis = patch.basis(int(d));
            const int s = basis.span(component<N>(at[judged[i]], d));
            for (int k = 0; k < orders[d]; ++k)
                unit *= weights * 2 * basis.degree() / (basis.knot(s + 1) - basis.knot(s));
        }
        return unit;
    }
    template <int K>
    void judge(const std::vector<Jet<N, K, Point>>& found, const PreparedPatch<N, P>& by,
               Errors& worst) const {
        const auto orders = jet_orders<N>(K);
        for (std::size_t i = 0; i < judged.size(); ++i)
            for (std::size_t s = 0; s < orders.size(); ++s) {
                int total = 0;
                for (const int a : orders[s]) total += a;
                for (int c = 0; c < Point::kCoords; ++c) {
                    const double off = gap(found[judged[i]].d[s][c], jets[i][s][std::size_t(c)]);
                    worst.order[total] = std::max(worst.order[total], off / unit(i, orders[s]));
                    const double bound = by.error_bound(orders[s]);
                    EXPECT_LE(off, bound);
                    if (bound > 0) worst.share[total] = std::max(worst.share[total], off / bound);
                }
            }
    }
    void judge_values(const std::vector<Point>& found, double bound, Errors& worst) const {
        for (std::size_t i = 0; i < judged.size(); ++i)
            for (int c = 0; c < Point::kCoords; ++c) {
                const double off = gap(found[judged[i]][c], jets[i][0][std::size_t(c)]);
                worst.order[0] = std::max(worst.order[0], off / unit(i, {}));
                worst.share[0] = std::max(worst.share[0], off / bound);
            }
    }
    void judge_normals(const std::vector<Vec<3>>& found, const PreparedPatch<N, P>& by, Errors& worst) const {
        const auto length = [](const std::vector<Twice>& x) {
            return std::hypot(x[0].high, x[1].high, x[2].high);
        };
        for (std::size_t i = 0; i < judged.size(); ++i) {
            const double one = unit(i, {1, 0}) * length(jets[i][2]) + unit(i, {0, 1}) * length(jets[i][1]);
            const double off = test::distance(freiform::unit(products[i]), found[judged[i]]);
            worst.normal = std::max(worst.normal, off / (one / norm(products[i]) + 0x1p-53));
            const double bound =
                by.normal_error_bound(length(jets[i][1]), length(jets[i][2]), norm(products[i]));
            worst.normal_share = std::max(worst.normal_share, off / bound);
        }
    }
};

// All ways of evaluating, scattered and as a grid.
template <std::size_t N, class P>
Errors errors_of(const ExactGrid<N, P>& exact, const PreparedPatch<N, P>& fast) {
    using Point = PointOf<P>;
    Errors worst;
    const auto axes = exact.views();
    std::vector<Point> points(exact.at.size());
    std::vector<Jet<N, 1, Point>> first(exact.at.size());
    std::vector<Jet<N, 2, Point>> second(exact.at.size());
    std::vector<Vec<3>> normals(exact.at.size());
    const auto judge = [&](bool ran) {
        ASSERT_TRUE(ran);
        exact.judge_values(points, fast.value_error_bound(), worst);
        exact.judge(first, fast, worst);
        exact.judge(second, fast, worst);
        if constexpr (N == 2 && Point::kCoords == 3) exact.judge_normals(normals, fast, worst);
    };
    if constexpr (N == 2 && Point::kCoords == 3) {
        judge(fast.evaluate(exact.at, std::span(first), std::span(normals)) &&
              fast.evaluate(exact.at, std::span(second)) && fast.evaluate(exact.at, std::span(points)));
        judge(fast.evaluate_grid(axes, std::span(points), std::span(normals)) &&
              fast.evaluate_grid(axes, std::span(first)) && fast.evaluate_grid(axes, std::span(second)));
        judge(fast.evaluate_grid(axes, std::span(points)) &&
              fast.evaluate(exact.at, std::span(points), std::span(normals)));
    } else {
        judge(fast.evaluate(exact.at, std::span(points)) && fast.evaluate(exact.at, std::span(first)) &&
              fast.evaluate(exact.at, std::span(second)));
        judge(fast.evaluate_grid(axes, std::span(points)) && fast.evaluate_grid(axes, std::span(first)) &&
              fast.evaluate_grid(axes, std::span(second)));
    }
    return worst;
}

// Patches of these degrees, the same along all axes (most of them have kernels of their own) and one that
// differs.
template <std::size_t N, class P, class F>
Errors worst_of(F&& with_each, std::vector<int> degrees, std::array<int, N> counts, std::uint64_t seed) {
    Random random(seed);
    Errors worst;
    if (test::kAddressSanitizer) degrees.resize(2);  // exact arithmetic takes ten times as long there
    for (const int p : degrees) {
        const auto basis = [&](std::size_t axis) {
            const int q = p == 4 && axis > 0 ? 2 : p;
            const auto ends = random.chance(0.5) ? test::Ends::clamped : test::Ends::closed;
            return test::random_basis(random, q, {.ends = ends, .spans = random.integer(q + 1, q + 2)});
        };
        auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
            return std::array<BSplineBasis, N>{basis(I)...};
        }
        (std::make_index_sequence<N>{});
        const ExactGrid<N, P> exact(random, test::random_patch_on<N, P>(random, std::move(bases)), counts);
        const auto fast = test::prepared(exact.patch);
        with_each([&] { worst.take(errors_of(exact, fast)); });
    }
    return worst;
}

void expect_below(const char* what, const Errors& found, const Errors& limit) {
    std::printf("  %-22s %8.2f %8.2f %8.2f %8.2f %9.4f %8.4f %8.4f %8.4f\n", what, found.order[0],
                found.order[1], found.order[2], found.normal, found.share[0], found.share[1], found.share[2],
                found.normal_share);
    for (int k = 0; k < 3; ++k) EXPECT_LE(found.order[k], limit.order[k]) << what << " order " << k;
    EXPECT_LE(found.normal, limit.normal) << what;
    for (int k = 0; k < 3; ++k) EXPECT_LE(found.share[k], 1) << what << " order " << k;
    EXPECT_LE(found.normal_share, 1) << what;
}

// The table of docs/evaluation.md. Printed: units of a value, of first and second derivatives and normals;
// the parts of the proven bounds of all four.
TEST_P(EveryKernel, gives_curves_within_the_documented_distance_of_exact_arithmetic) {
    const auto each = [&](const auto& check) { with_each(check); };
    expect_below("curve", worst_of<1, Vec<3>>(each, {1, 2, 3, 4, 5, 8}, {31}, 1), {{10, 6, 6}});
    expect_below("curve, rational", worst_of<1, Hom<3>>(each, {1, 2, 3, 4, 5, 8}, {31}, 2), {{10, 6, 6}});
    Errors others;  // other numbers of coordinates take other ways through the kernels
    others.take(worst_of<1, Vec<1>>(each, {3, 5}, {12}, 7));
    others.take(worst_of<1, Hom<4>>(each, {3, 5}, {12}, 8));
    expect_below("curve, 1 or 4 coordinates", others, {{10, 6, 6}});
}
TEST_P(EveryKernel, gives_surfaces_within_the_documented_distance_of_exact_arithmetic) {
    const auto each = [&](const auto& check) { with_each(check); };
    expect_below("surface", worst_of<2, Vec<3>>(each, {1, 2, 3, 4, 5}, {2, 9}, 3), {{10, 6, 6}, 2});
    expect_below("surface, rational", worst_of<2, Hom<3>>(each, {1, 2, 3, 4, 5}, {2, 9}, 4), {{10, 6, 6}, 2});
}
TEST_P(EveryKernel, gives_volumes_within_the_documented_distance_of_exact_arithmetic) {
    const auto each = [&](const auto& check) { with_each(check); };
    expect_below("volume", worst_of<3, Vec<3>>(each, {1, 3}, {1, 2, 5}, 5), {{10, 6, 6}});
    expect_below("volume, rational", worst_of<3, Hom<3>>(each, {1, 2}, {1, 2, 5}, 6), {{10, 6, 6}});
    Errors others;
    others.take(worst_of<2, Vec<2>>(each, {3, 4}, {1, 9}, 9));
    others.take(worst_of<2, Hom<4>>(each, {3, 4}, {1, 9}, 10));
    others.take(worst_of<3, Hom<4>>(each, {1, 2}, {1, 2, 5}, 11));
    expect_below("2 or 4 coordinates", others, {{10, 6, 6}});
}

// The same answer to parameters that are not in the domain, whatever the kernel: a refusal that names the
// first before anything is written, or NaN there and the bits of the others.
template <std::size_t N, class P>
void expect_outside_is_outside(std::uint64_t seed) {
    using Point = PointOf<P>;
    Random random(seed);
    const double inf = std::numeric_limits<double>::infinity();
    std::array<BSplineBasis, N> bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<BSplineBasis, N>{test::random_basis(random, 2 + int(I), {.spans = 3})...};
    }
    (std::make_index_sequence<N>{});
    const auto patch = test::random_patch_on<N, P>(random, std::move(bases));
    const auto fast = test::prepared(patch);
    const auto good = test::parameters<N, P>(random, patch, 70);
    std::vector<Jet<N, 2, Point>> jets(good.size());
    std::vector<Point> points(good.size());
    ASSERT_TRUE(fast.evaluate(good, std::span(jets)));
    ASSERT_TRUE(fast.evaluate(good, std::span(points)));
    for (std::size_t d = 0; d < N; ++d) {
        const Interval on = patch.basis(int(d)).domain();
        for (const double bad : {std::numeric_limits<double>::quiet_NaN(), inf, -inf, 1e300, -1e300,
                                 std::nextafter(on.hi, inf), std::nextafter(on.lo, -inf)}) {
            const RefusalKind kind = std::isfinite(bad) ? RefusalKind::out_of_domain : RefusalKind::nonfinite;
            auto at = good;
            for (const std::size_t i : {std::size_t(3), std::size_t(66)})
                if constexpr (N == 1)
                    at[i] = bad;
                else
                    at[i][d] = bad;
            std::vector<Jet<N, 2, Point>> out(at.size());
            std::vector<Point> values(at.size());
            std::vector<float> single(at.size() * std::size_t(Point::kCoords), 7);
            for (const auto& refused :
                 {fast.evaluate(at, std::span(out)), fast.evaluate(at, std::span(values)),
                  fast.evaluate(at, std::span(single))}) {
                ASSERT_FALSE(refused);
                EXPECT_EQ(refused.error().where, N == 1 ? "at[3]" : text("at[3][", d, "]"));
                EXPECT_EQ(refused.error().kind, kind);
            }
            for (std::size_t i = 0; i < at.size(); ++i)
                ASSERT_TRUE(out[i].d == (Jet<N, 2, Point>().d) && values[i] == Point() && single[i] == 7);
            ASSERT_TRUE(fast.evaluate(at, std::span(out), Outside::nan));
            ASSERT_TRUE(fast.evaluate(at, std::span(values), Outside::nan));
            ASSERT_TRUE(fast.evaluate(at, std::span(single), Outside::nan));
            for (std::size_t i = 0; i < at.size(); ++i) {
                const bool here = i == 3 || i == 66;
                if (!here) ASSERT_TRUE(out[i].d == jets[i].d && values[i] == points[i]) << i;
                for (int c = 0; c < Point::kCoords; ++c) {
                    ASSERT_EQ(std::isnan(single[i * std::size_t(Point::kCoords) + std::size_t(c)]), here)
                        << i;
                    ASSERT_EQ(std::isnan(values[i][c]), here) << i;
                    for (const Point& x : out[i].d) ASSERT_EQ(std::isnan(x[c]), here) << i;
                }
            }
            std::array<std::vector<double>, N> axes;
            std::array<std::span<const double>, N> views;
            for (std::size_t k = 0; k < N; ++k) {
                axes[k].assign(k + 2, patch.basis(int(k)).domain().lo);
                if (k == d) axes[k][1] = bad;
                views[k] = axes[k];
            }
            std::vector<Point> grid(N == 1 ? 2 : N == 2 ? 6 : 24);
            const auto refused = fast.evaluate_grid(views, std::span(grid));
            ASSERT_FALSE(refused);
            EXPECT_EQ(refused.error().where, text("axes[", d, "][1]"));
            EXPECT_EQ(refused.error().kind, kind);
            for (const Point& x : grid) ASSERT_EQ(x, Point());
        }
    }
}

TEST_P(EveryKernel, refuses_what_is_outside_or_gives_nan_there) {
    with_each([] {
        expect_outside_is_outside<1, Hom<3>>(21);
        expect_outside_is_outside<1, Vec<1>>(22);
        expect_outside_is_outside<2, Hom<3>>(23);
        expect_outside_is_outside<2, Vec<4>>(24);
        expect_outside_is_outside<3, Hom<2>>(25);
    });
}

TEST_P(EveryKernel, gives_nan_for_normals_and_curvatures_outside_and_wraps_closed_axes) {
    Random random(31);
    const auto ring = *BSplineBasis::periodic(3, {0, 1, 2, 3, 4});
    const auto patch = test::random_patch_on<2, Hom<3>>(random, {ring, *BSplineBasis::bezier(3)});
    const auto fast = test::prepared(patch);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Param<2>> at{{0.5, 0.25}, {4.5, 0.25}, {-3.5, 0.25}, {4e15 + 0.5, 0.25},
                                   {nan, 0.25}, {0.5, nan},  {0.5, 1.5}};
    with_each([&] {
        std::vector<Vec<3>> points(at.size()), normals(at.size());
        std::vector<Curvatures> bent(at.size());
        EXPECT_EQ(fast.evaluate(at, points, normals).error().where, "at[4][0]");
        EXPECT_EQ(fast.evaluate(at, bent).error().where, "at[4][0]");
        ASSERT_TRUE(fast.evaluate(at, points, normals, Outside::nan));
        ASSERT_TRUE(fast.evaluate(at, bent, Outside::nan));
        for (std::size_t i = 0; i < at.size(); ++i) {
            if (i < 4) {
                EXPECT_TRUE(points[i] == points[0] && normals[i] == normals[0]) << i;
                EXPECT_TRUE(bent[i].gauss == bent[0].gauss && bent[i].mean == bent[0].mean) << i;
            }
            EXPECT_EQ(std::isnan(bent[i].gauss) && std::isnan(bent[i].mean), i >= 4) << i;
            for (int c = 0; c < 3; ++c)
                EXPECT_TRUE(std::isnan(points[i][c]) == (i >= 4) && std::isnan(normals[i][c]) == (i >= 4))
                    << i;
        }
    });
}

}  // namespace
}  // namespace freiform

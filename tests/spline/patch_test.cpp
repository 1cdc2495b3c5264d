// The laws of spline patches, for every number of parameters, polynomial and rational, open and closed.
#include "support/random.hpp"

#include <freiform/spline/bezier.hpp>
#include <freiform/spline/patch.hpp>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace freiform {
namespace {

using test::Ends;
using test::must;
using test::Random;

template <std::size_t N_, class P_, Ends kEnds_>
struct Law {
    static constexpr std::size_t N = N_;
    using P = P_;
    static constexpr Ends kEnds = kEnds_;
    static constexpr int kDegree = N == 1 ? 9 : N == 2 ? 6 : 3;
};

template <class L>
class PatchLaws : public testing::Test {
public:
    using Object = Patch<L::N, typename L::P>;

    // f(random, patch) for a dozen patches.
    template <class F>
    static void each(F&& f, bool jumps = false, bool dyadic = false) {
        Random random(100 + L::N);
        for (int k = 0; k < 12; ++k)
            f(random, test::random_patch<L::N, typename L::P>(random, L::kDegree,
                                                              {L::kEnds, L::N == 3 ? 2 : 4, jumps, dyadic}));
    }
    static double size(const Object& s) {
        double m = 0;
        for (const auto& p : points(s)) m = std::max(m, max_abs(p));
        return m;
    }
    static void expect_same(Random& random, const Object& a, const Object& b, double tolerance,
                            bool on_knots = true) {
        for (const auto& u : test::parameters(random, a, 20, on_knots))
            ASSERT_LT(test::distance(a(u), b(u)), tolerance * size(a));
    }
};

using V1 = Vec<1>;
using V2 = Vec<2>;
using V3 = Vec<3>;
using V4 = Vec<4>;
using H1 = Hom<1>;
using H2 = Hom<2>;
using H3 = Hom<3>;
using H4 = Hom<4>;
constexpr Ends kC = Ends::clamped, kU = Ends::unclamped, kO = Ends::closed;
using Laws = testing::Types<Law<1, V1, kC>, Law<1, V2, kU>, Law<1, V3, kO>, Law<1, V4, kC>, Law<1, H1, kO>,
                            Law<1, H2, kC>, Law<1, H3, kU>, Law<1, H4, kO>, Law<2, V1, kO>, Law<2, V2, kC>,
                            Law<2, V3, kU>, Law<2, H2, kO>, Law<2, H3, kC>, Law<2, H4, kU>, Law<3, V1, kU>,
                            Law<3, V3, kC>, Law<3, H3, kO>, Law<3, H1, kU>>;
TYPED_TEST_SUITE(PatchLaws, Laws);

TYPED_TEST(PatchLaws, values_are_in_the_convex_hull_coordinate_by_coordinate) {
    this->each(
        [&](Random& random, const auto& s) {
            const auto all = points(s);
            const double bound = s.value_error_bound();
            for (const auto& u : test::parameters(random, s, 20)) {
                const auto x = s(u);
                for (int c = 0; c < Space<typename TypeParam::P>::kDim; ++c) {
                    double lo = all[0][c], hi = lo;
                    for (const auto& p : all) lo = std::min(lo, p[c]), hi = std::max(hi, p[c]);
                    ASSERT_TRUE(lo - 2 * bound <= x[c] && x[c] <= hi + 2 * bound);
                }
            }
        },
        true);
}

TYPED_TEST(PatchLaws, affine_maps_of_the_coefficients_are_affine_maps_of_the_values) {
    using P = typename TypeParam::P;
    constexpr int D = Space<P>::kDim;
    this->each([&](Random& random, const auto& s) {
        double m[D][D], b[D];
        for (int i = 0; i < D; ++i) {
            b[i] = random.real(-3, 3);
            for (int j = 0; j < D; ++j) m[i][j] = random.real(-1, 1);
        }
        const auto map = [&](const Vec<D>& x) {
            Vec<D> y;
            for (int i = 0; i < D; ++i) {
                y[i] = b[i];
                for (int j = 0; j < D; ++j) y[i] += m[i][j] * x[j];
            }
            return y;
        };
        auto net = s.net();
        for (P& p : net.flat()) p = Space<P>::lift(map(project(p)), Space<P>::weight(p));
        const auto t = must(Patch<TypeParam::N, P>::make(s.bases(), net));
        for (const auto& u : test::parameters(random, s, 20))
            ASSERT_LT(test::distance(t(u), map(s(u))), 1e-12);
    });
}

TYPED_TEST(PatchLaws, projective_maps_of_the_coefficients_are_projective_maps_of_the_values) {
    using P = typename TypeParam::P;
    if constexpr (Space<P>::kRational) {
        constexpr int C = P::kCoords;
        this->each([&](Random& random, const auto& s) {
            double m[C][C];
            for (int i = 0; i < C; ++i)
                for (int j = 0; j < C; ++j)
                    m[i][j] = i == C - 1 ? (j == i ? 5 : random.real(-0.5, 0.5)) : random.real(-1, 1);
            const auto map = [&](const P& x) {
                P y{};
                for (int i = 0; i < C; ++i)
                    for (int j = 0; j < C; ++j) y[i] += m[i][j] * x[j];
                return y;
            };
            auto net = s.net();
            for (P& p : net.flat()) p = map(p);
            const auto t = must(Patch<TypeParam::N, P>::make(s.bases(), net));
            for (const auto& u : test::parameters(random, s, 20))
                ASSERT_LT(test::distance(t(u), project(map(weighted(s(u), 1)))), 1e-12);
        });
    }
}

TYPED_TEST(PatchLaws, clamped_patches_begin_and_end_in_their_corner_coefficients) {
    constexpr std::size_t N = TypeParam::N;
    Random random(3);
    for (int k = 0; k < 10; ++k) {
        auto s = test::random_patch<N, typename TypeParam::P>(random, TypeParam::kDegree, {Ends::clamped, 3});
        for (std::size_t d = 0; d < N; ++d) s = must(restrict_to(s, int(d), s.basis(int(d)).domain()));
        for (int corner = 0; corner < 1 << N; ++corner) {
            std::array<double, N> u{};
            Index<N> at{};
            for (std::size_t d = 0; d < N; ++d) {
                const bool end = (corner >> d & 1) != 0;
                u[d] = end ? s.domain()[d].hi : s.domain()[d].lo;
                at[d] = end ? s.net().extent()[d] - 1 : 0;
            }
            EXPECT_EQ(s(test::to_param<N>(u)), project(s.net().view()(at)));
        }
    }
}

TYPED_TEST(PatchLaws, inserting_knots_leaves_the_map_unchanged) {
    this->each(
        [&](Random& random, const auto& s) {
            for (int axis = 0; axis < int(TypeParam::N); ++axis) {
                const auto on = s.basis(axis).domain();
                const std::vector<double> more{on.lo + 0.25 * on.length(), on.lo + 0.5 * on.length(),
                                               on.lo + 0.75 * on.length()};
                const auto t = must(insert_knots(s, axis, more));
                EXPECT_EQ(t.net().extent()[std::size_t(axis)], s.net().extent()[std::size_t(axis)] + 3);
                this->expect_same(random, s, t, 1e-12);
            }
        },
        true);
}

TYPED_TEST(PatchLaws, elevation_leaves_the_map_unchanged) {
    this->each(
        [&](Random& random, const auto& s) {
            const int axis = random.integer(0, int(TypeParam::N) - 1);
            const auto t = must(elevate(s, axis, 2));
            EXPECT_EQ(t.basis(axis).degree(), s.basis(axis).degree() + 2);
            this->expect_same(random, s, t, 1e-12);
        },
        true);
}

TYPED_TEST(PatchLaws, restriction_is_the_same_map_on_less) {
    this->each([&](Random& random, const auto& s) {
        const int axis = random.integer(0, int(TypeParam::N) - 1);
        const auto on = s.basis(axis).domain();
        const double a = random.real(on.lo, on.hi), b = random.real(on.lo, on.hi);
        const auto t = must(restrict_to(s, axis, {std::min(a, b), std::max(a, b)}));
        this->expect_same(random, t, s, 1e-12);
        const auto whole = must(restrict_to(s, axis, on));
        this->expect_same(random, s, whole, 1e-12);
    });
}

TYPED_TEST(PatchLaws, reversal_runs_through_the_map_backwards) {
    constexpr std::size_t N = TypeParam::N;
    this->each(
        [&](Random& random, const auto& s) {
            const int axis = random.integer(0, int(N) - 1);
            const auto t = reverse(s, axis);
            const auto on = s.basis(axis).domain();
            for (int k = 0; k < 20; ++k) {
                std::array<double, N> u{}, v{};
                for (std::size_t d = 0; d < N; ++d) {
                    const auto in = s.domain()[d];
                    u[d] = v[d] = in.lo + random.integer(0, 4096) / 4096.0 * in.length();
                }
                v[std::size_t(axis)] = on.lo + (on.hi - u[std::size_t(axis)]);
                ASSERT_LT(test::distance(s(test::to_param<N>(u)), t(test::to_param<N>(v))), 1e-11);
            }
            EXPECT_EQ(reverse(t, axis), s);
        },
        false, true);
}

TYPED_TEST(PatchLaws, bezier_pieces_are_the_patch_between_its_breaks) {
    constexpr std::size_t N = TypeParam::N;
    this->each(
        [&](Random& random, const auto& s) {
            const auto pieces = decompose(s);
            each_index(pieces.extent(), [&](const Index<N>& at) {
                const auto piece = pieces.piece(at);
                EXPECT_EQ(piece.domain(), pieces.box(at));
                std::array<double, N> u{};
                for (std::size_t d = 0; d < N; ++d)
                    u[d] = random.real(piece.domain()[d].lo, piece.domain()[d].hi);
                const auto v = test::to_param<N>(u);
                ASSERT_LT(test::distance(s(v), piece(v)), 1e-12);
            });
        },
        true);
}

TYPED_TEST(PatchLaws, the_derivative_patch_gives_the_derivatives_of_jets) {
    constexpr std::size_t N = TypeParam::N;
    if constexpr (!Space<typename TypeParam::P>::kRational)
        this->each([&](Random& random, const auto& s) {
            for (std::size_t axis = 0; axis < N; ++axis) {
                Index<N> order{};
                order[axis] = 1;
                const auto t = derivative(s, int(axis));
                for (const auto& u : test::parameters(random, s, 20))
                    ASSERT_LT(test::distance(t(u), s.template jet<1>(u)(order)),
                              1e-12 * (this->size(s) + this->size(t)));
            }
        });
}

TYPED_TEST(PatchLaws, iso_patches_and_boundaries_are_the_patch_with_one_parameter_fixed) {
    constexpr std::size_t N = TypeParam::N;
    if constexpr (N >= 2)
        this->each(
            [&](Random& random, const auto& s) {
                for (std::size_t axis = 0; axis < N; ++axis)
                    for (int which = 0; which < 3; ++which) {
                        const auto on = s.basis(int(axis)).domain();
                        const double at = which == 0 ? on.lo : which == 1 ? on.hi : random.real(on.lo, on.hi);
                        const auto face = which < 2 ? boundary(s, int(axis), which) : iso(s, int(axis), at);
                        for (const auto& v : test::parameters(random, face, 6)) {
                            std::array<double, N> u{};
                            for (std::size_t d = 0, k = 0; d < N; ++d)
                                u[d] = d == axis ? at : component<N - 1>(v, k++);
                            ASSERT_LT(test::distance(face(v), s(test::to_param<N>(u))),
                                      1e-13 * this->size(s));
                        }
                    }
            },
            true);
}

TYPED_TEST(PatchLaws, a_grid_is_its_points_within_the_bound) {
    constexpr std::size_t N = TypeParam::N;
    this->each(
        [&](Random& random, const auto& s) {
            std::array<std::vector<double>, N> at;
            std::array<std::span<const double>, N> axes;
            for (std::size_t d = 0; d < N; ++d) {
                at[d] = test::parameters(random, s.basis(int(d)), 2);
                if (at[d].size() > 9) at[d].resize(9);
                axes[d] = at[d];
            }
            const auto grid = must(evaluate_grid(s, axes));
            each_index(grid.extent(), [&](const Index<N>& i) {
                std::array<double, N> u{};
                for (std::size_t d = 0; d < N; ++d) u[d] = at[d][std::size_t(i[d])];
                ASSERT_LE(max_abs(grid.view()(i) - s(test::to_param<N>(u))), 2 * s.value_error_bound());
                if constexpr (N == 1) {
                    ASSERT_EQ(grid.view()(i), s(test::to_param<N>(u)));
                }
            });
            axes[0] = {};
            EXPECT_EQ(must(evaluate_grid(s, axes)).extent()[0], 0);
            const double bad[] = {s.domain()[0].lo, std::numeric_limits<double>::quiet_NaN()};
            axes[0] = bad;
            const auto refused = evaluate_grid(s, axes);
            ASSERT_FALSE(refused.has_value());
            EXPECT_EQ(refused.error().where, "axes[0][1]");
        },
        true);
}

TYPED_TEST(PatchLaws, scaling_by_powers_of_two_scales_every_result_to_the_bit) {
    constexpr std::size_t N = TypeParam::N;
    using P = typename TypeParam::P;
    this->each([&](Random& random, const auto& s) {
        const auto us = test::parameters(random, s, 3);
        for (int k = -900; k <= 900; k += 100) {
            auto net = s.net();
            for (P& p : net.flat())
                for (int c = 0; c < Space<P>::kDim; ++c) p[c] = std::scalbn(p[c], k);
            const auto big = must(Patch<N, P>::make(s.bases(), net));
            EXPECT_EQ(big.value_error_bound(), std::scalbn(s.value_error_bound(), k));
            const auto stretched_bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
                return std::array<BSplineBasis, N>{[&](const BSplineBasis& b) {
                    std::vector<double> t(b.defining().begin(), b.defining().end());
                    for (double& x : t) x = std::scalbn(x, k);
                    return must(b.same_kind(b.degree(), std::move(t)));
                }(s.basis(int(I)))...};
            }
            (std::make_index_sequence<N>{});
            const auto stretched = must(Patch<N, P>::make(stretched_bases, s.net()));
            for (const auto& u : us) {
                std::array<double, N> v{};
                for (std::size_t d = 0; d < N; ++d) v[d] = std::scalbn(component<N>(u, d), k);
                const auto j = s.template jet<1>(u), jb = big.template jet<1>(u);
                const auto js = stretched.template jet<1>(test::to_param<N>(v));
                for (std::size_t i = 0; i < j.d.size(); ++i)
                    for (int c = 0; c < Space<P>::kDim; ++c) {
                        ASSERT_EQ(jb.d[i][c], std::scalbn(j.d[i][c], k));
                        ASSERT_EQ(js.d[i][c], std::scalbn(j.d[i][c], i == 0 ? 0 : -k));
                    }
            }
            // Refinements, too.
            const auto on = s.basis().domain(), on2 = stretched.basis().domain();
            const double x = on.lo + 0.375 * on.length(), x2 = on2.lo + 0.375 * on2.length();
            EXPECT_EQ(must(insert_knots(s, 0, std::span(&x, 1))).net(),
                      must(insert_knots(stretched, 0, std::span(&x2, 1))).net());
            EXPECT_EQ(must(elevate(s, 0)).net(), must(elevate(stretched, 0)).net());
        }
    });
}

TYPED_TEST(PatchLaws, evaluation_of_many_refuses_the_first_bad_parameter_by_its_index) {
    constexpr std::size_t N = TypeParam::N;
    Random random(7);
    const auto s = test::random_patch<N, typename TypeParam::P>(random, 3, {TypeParam::kEnds, 3});
    auto us = test::parameters(random, s, 5);
    std::vector<typename Patch<N, typename TypeParam::P>::Point> out(us.size());
    ASSERT_TRUE(s.evaluate(us, out).has_value());
    for (std::size_t i = 0; i < us.size(); ++i) EXPECT_EQ(out[i], s(us[i]));
    const auto set = [&](double x) {
        if constexpr (N == 1)
            us[3] = x;
        else
            us[3][0] = x;
    };
    const std::string where = N == 1 ? "at[3]" : "at[3][0]";
    std::vector<Jet<N, 1, typename Patch<N, typename TypeParam::P>::Point>> jets(us.size());
    for (double x : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        set(x);
        for (const auto& r : {s.evaluate(us, out), s.template evaluate<1>(us, jets)}) {
            ASSERT_FALSE(r.has_value());
            EXPECT_EQ(r.error().kind, RefusalKind::nonfinite);
            EXPECT_EQ(r.error().where, where);
        }
    }
    set(s.domain()[0].hi + 1);
    const auto r = s.evaluate(us, out);
    EXPECT_EQ(r.has_value(), s.basis().is_closed());
    if (!r) {
        EXPECT_EQ(r.error().kind, RefusalKind::out_of_domain);
        EXPECT_EQ(r.error().where, where);
    }
}

TYPED_TEST(PatchLaws, the_rational_form_of_a_polynomial_patch_is_the_same_map) {
    if constexpr (!Space<typename TypeParam::P>::kRational)
        this->each([&](Random& random, const auto& s) {
            const auto r = to_rational(s);
            for (double w : weights(r)) EXPECT_EQ(w, 1);
            EXPECT_EQ(points(r), points(s));
            for (const auto& u : test::parameters(random, s, 10))
                ASSERT_LT(test::distance(r(u), s(u)), 1e-14 * 64);
        });
}

}  // namespace
}  // namespace freiform

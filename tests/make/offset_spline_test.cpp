// Splines near offsets: no place may be off by more than the bound; the proof alone, where the distance is
// known.
#include <freiform/make/offset_spline.hpp>

#include <cmath>
#include <make/offset_bound_detail.hpp>
#include <support/random.hpp>
#include <support/refusal.hpp>

namespace freiform::test {
namespace {

OffsetSurface offset(SurfaceGeometry base, double by) {
    return {std::make_shared<const SurfaceGeometry>(std::move(base)), by};
}

// Hills over a square of 10, of any degrees, with knots of this multiplicity inside.
template <class P>
Surface<P> hills(int p, int q, int spans, int multiplicity, Random& r) {
    const auto basis = [&](int degree) {
        std::vector<double> knots(std::size_t(degree) + 1, 0);
        for (int k = 1; k < spans; ++k)
            knots.insert(knots.end(), std::size_t(multiplicity), double(k) / spans);
        knots.insert(knots.end(), std::size_t(degree) + 1, 1);
        return *BSplineBasis::make(degree, std::move(knots));
    };
    const BSplineBasis u = basis(p), v = basis(q);
    std::vector<P> net;
    for (int i = 0; i < u.size(); ++i)
        for (int j = 0; j < v.size(); ++j) {
            const Vec<3> at{{10.0 * i / (u.size() - 1), 10.0 * j / (v.size() - 1), r.real(-0.4, 0.4)}};
            if constexpr (Space<P>::kRational)
                net.push_back(weighted(at, r.real(0.7, 1.4)));
            else
                net.push_back(at);
        }
    return *Surface<P>::make({u, v}, Net<2, P>({u.size(), v.size()}, std::move(net)));
}

double farthest(const OffsetSurface& o, const Surface<Vec<3>>& s, int n = 60) {
    const SurfaceGeometry given = o;
    double most = 0;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
            const Interval u = s.basis(0).domain(), v = s.basis(1).domain();
            const Param<2> at{i == n ? u.hi : u.lo + u.length() * i / n,
                              j == n ? v.hi : v.lo + v.length() * j / n};
            most = std::max(most, norm(s(at) - jet<0>(given, at).value()));
        }
    return most;
}

TEST(OffsetSpline, is_within_its_bound_which_is_within_the_tolerance) {
    Random r(7);
    const auto law = [&](const SurfaceGeometry& base, double by, double tolerance) {
        const OffsetSurface o = offset(base, by);
        const auto made = must(offset_spline(o, domain(base), tolerance));
        EXPECT_LE(made.bound, tolerance);
        const double found = farthest(o, made.surface);
        EXPECT_LE(found, made.bound) << by << " " << tolerance;
        EXPECT_GE(found, 0.02 * made.bound) << "pieces for nothing";
    };
    for (const auto& [p, q] : {std::pair{2, 2}, {3, 3}, {3, 2}, {5, 3}, {1, 3}})
        for (const double by : {0.4, -0.2, 1e-4}) {
            law(hills<Vec<3>>(p, q, p == 1 ? 1 : 4, 1, r), by, 1e-3);
            law(hills<Hom<3>>(p, q, p == 1 ? 1 : 3, 1, r), by, 1e-3);
        }
    law(hills<Vec<3>>(3, 3, 5, 1, r), 0.3, 1e-6);
    law(hills<Hom<3>>(3, 3, 2, 1, r), -0.3, 1e-5);
}

TEST(OffsetSpline, has_tangents_where_the_offset_has) {
    Random r(8);
    // Curvatures jump at double knots of cubics, and so do tangents of the offset.
    for (const int multiplicity : {1, 2}) {
        const auto base = hills<Vec<3>>(3, 3, 3, multiplicity, r);
        const OffsetSurface o = offset(base, 0.3);
        const auto made = must(offset_spline(o, domain(SurfaceGeometry(base)), 1e-4));
        EXPECT_LE(farthest(o, made.surface), made.bound);
        for (int axis = 0; axis < 2; ++axis)
            for (const double at : made.surface.basis(axis).breaks())
                if (0 < at && at < 1) {
                    const bool own = std::ranges::binary_search(base.basis(axis).breaks(), at);
                    EXPECT_EQ(made.surface.basis(axis).multiplicity(at), own && multiplicity == 2 ? 3 : 2)
                        << at;
                }
    }
}

// Rational arcs with double knots are smooth all the same.
TEST(OffsetSpline, creases_are_those_of_the_surface_not_of_its_knots) {
    const double w = std::sqrt(0.5);
    std::vector<Hom<3>> net;
    for (const auto& [x, y, weight] :
         {std::tuple{2.0, 0.0, 1.0}, {2.0, 2.0, w}, {0.0, 2.0, 1.0}, {-2.0, 2.0, w}, {-2.0, 0.0, 1.0}})
        for (const double z : {0.0, 3.0}) net.push_back(weighted(Vec<3>{{x, y, z}}, weight));
    const auto base =
        *Surface<Hom<3>>::make({*BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 2}), *BSplineBasis::bezier(1)},
                               Net<2, Hom<3>>({5, 2}, net));
    const auto made = must(offset_spline(offset(base, 0.5), domain(SurfaceGeometry(base)), 1e-5));
    EXPECT_LE(farthest(offset(base, 0.5), made.surface), made.bound);
    for (int i = 0; i <= 40; ++i) {
        const Vec<3> p = made.surface(2.0 * i / 40, 0.5);
        EXPECT_NEAR(std::hypot(p[0], p[1]), 2.5, made.bound);
    }
}

TEST(OffsetSpline, covers_the_part_that_is_asked_for) {
    Random r(9);
    const auto base = hills<Hom<3>>(3, 3, 4, 1, r);
    const std::array<Interval, 2> on{Interval{0.2, 0.63}, Interval{0.5, 1}};
    const OffsetSurface o = offset(base, 0.3);
    const auto made = must(offset_spline(o, on, 1e-4));
    EXPECT_EQ(made.surface.basis(0).domain(), on[0]);
    EXPECT_EQ(made.surface.basis(1).domain(), on[1]);
    EXPECT_LE(farthest(o, made.surface), made.bound);
    EXPECT_LT(made.surface.net().flat().size(),
              must(offset_spline(o, domain(SurfaceGeometry(base)), 1e-4)).surface.net().flat().size());
}

// All middles of sides are flat: only the proof sees the bump.
TEST(OffsetSpline, a_bump_between_the_places_that_are_looked_at_is_seen) {
    const auto basis = *BSplineBasis::clamped_uniform(3, 24);
    std::vector<Vec<3>> net;
    for (int i = 0; i < basis.size(); ++i)
        for (int j = 0; j < basis.size(); ++j)
            net.push_back({{double(i), double(j), i == 11 && j == 12 ? 1.0 : 0.0}});
    const auto base =
        *Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({basis.size(), basis.size()}, net));
    const OffsetSurface o = offset(base, 0.5);
    const auto made = must(offset_spline(o, domain(SurfaceGeometry(base)), 1e-3));
    EXPECT_LE(farthest(o, made.surface, 400), made.bound);
}

TEST(OffsetSpline, offsets_of_a_plane_are_of_one_piece) {
    const auto basis = *BSplineBasis::bezier(1, {0, 2});
    const auto base = *Surface<Vec<3>>::make(
        {basis, basis}, Net<2, Vec<3>>({2, 2}, {{{0, 0, 0}}, {{0, 3, 0}}, {{4, 0, 0}}, {{4, 3, 0}}}));
    const auto made = must(offset_spline(offset(base, 2), domain(SurfaceGeometry(base)), 1e-9));
    EXPECT_EQ(made.surface.net().extent(), (Index<2>{4, 4}));
    EXPECT_LT(made.bound, 1e-11);
    EXPECT_NEAR(norm(made.surface(1, 1) - Vec<3>{{2, 1.5, 2}}), 0, 1e-14);
}

TEST(OffsetSpline, refuses_what_has_no_spline_near_it) {
    Random r(10);
    const auto refused = [](SurfaceGeometry base, double tolerance, RefusalKind kind, std::string_view where,
                            std::string_view what) {
        const auto on = domain(base);
        expect_refusal(offset_spline(offset(std::move(base), 0.1), on, tolerance), kind, where, what);
    };
    refused(hills<Vec<3>>(2, 2, 2, 2, r), 1e-3, RefusalKind::unsupported, "base", "has a crease at u = 0.5");
    refused(hills<Vec<3>>(2, 13, 1, 1, r), 1e-3, RefusalKind::unsupported, "base", "is of degree 13");
    refused(hills<Vec<3>>(2, 2, 1, 1, r), 0, RefusalKind::invalid, "tolerance", "0");
    refused(hills<Vec<3>>(3, 3, 4, 1, r), 1e-15, RefusalKind::limit, "tolerance", "pieces");
    refused(Extrusion{Line<3>{{}, {{1, 0, 0}}}, {{0, 1, 0}}, SurfaceKind::plane}, 1e-3,
            RefusalKind::unsupported, "base", "is no spline");
    // A side that is a point.
    const auto basis = *BSplineBasis::bezier(1);
    refused(*Surface<Vec<3>>::make(
                {basis, basis}, Net<2, Vec<3>>({2, 2}, {{{0, 0, 0}}, {{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}})),
            1e-3, RefusalKind::ill_conditioned, "base", "normal");
}

// The plane z = 0 as a patch, raised by `by`, and a patch that is off from that by a constant.
template <class P>
double bound_of_plane(double by, const Vec<3>& off, double weight = 1) {
    std::vector<P> base;
    std::vector<Vec<3>> h;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const Vec<3> at{{1.5 * i, 2.0 * j, 0}};
            if constexpr (Space<P>::kRational)
                base.push_back(weighted(at, weight));
            else
                base.push_back(at);
            h.push_back(at + Vec<3>{{0, 0, by}} + off);
        }
    return detail::offset_bound<P>(NetView<2, const Vec<3>>{h.data(), {3, 3}, {3, 1}},
                                   NetView<2, const P>{base.data(), {3, 3}, {3, 1}}, by, 10);
}

TEST(OffsetBound, is_the_distance_of_what_is_off_by_a_constant) {
    for (const double by : {0.5, -2.0})
        for (const Vec<3>& off : {Vec<3>{{1e-3, 0, 0}}, {{0, -1e-3, 0}}, {{0, 0, 1e-3}}, {{0, 0, -1e-3}}}) {
            // Along the plane it may be that along both tangents, along the normal a little more than half of
            // the square of the whole.
            const double most = off[2] != 0 ? 2.01e-3 : 1.01e-3;
            for (const double found :
                 {bound_of_plane<Vec<3>>(by, off), bound_of_plane<Hom<3>>(by, off),
                  bound_of_plane<Hom<3>>(by, off, 3), bound_of_plane<Hom<3>>(by, off, 0.1)}) {
                EXPECT_GE(found, 1e-3);
                EXPECT_LE(found, most);
            }
        }
    EXPECT_LT(bound_of_plane<Vec<3>>(0.5, {}), 1e-10);
    EXPECT_LT(bound_of_plane<Hom<3>>(0.5, {}, 2), 1e-10);
    // Small distances: no more than there and back.
    EXPECT_NEAR(bound_of_plane<Vec<3>>(1e-9, {{0, 0, 1e-3}}), 1e-3, 1e-8);
    // The other side.
    EXPECT_GE(bound_of_plane<Vec<3>>(0.5, {{0, 0, -1}}), 1);
}

// A part of a cylinder of radius 2 and of one near radius 3, both rational: what h misses is its own,
// whatever is seen in the middle.
TEST(OffsetBound, holds_where_tangents_turn) {
    Random r(11);
    for (int round = 0; round < 200; ++round) {
        std::vector<Hom<3>> base;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                base.push_back(
                    weighted(Vec<3>{{double(i), double(j), r.real(-0.3, 0.3)}}, r.real(0.8, 1.25)));
        const Bernstein cubic = *Bernstein::make(3);
        const auto s = Patch<2, Hom<3>, Bernstein>::trusted({cubic, cubic}, Net<2, Hom<3>>({4, 4}, base));
        const double by = r.real(0.05, 0.5);
        std::vector<Vec<3>> h;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                const auto k = s.jet<1>({i / 3.0, j / 3.0});
                h.push_back(k.value() + by * unit(cross(k(1, 0), k(0, 1))));
            }
        const auto near = Patch<2, Vec<3>, Bernstein>::trusted({cubic, cubic}, Net<2, Vec<3>>({4, 4}, h));
        const double bound = detail::offset_bound<Hom<3>>(near.net().view(), s.net().view(), by, 4);
        double found = 0;
        for (int i = 0; i <= 20; ++i)
            for (int j = 0; j <= 20; ++j) {
                const auto k = s.jet<1>({i / 20.0, j / 20.0});
                found = std::max(
                    found, norm(near(i / 20.0, j / 20.0) - k.value() - by * unit(cross(k(1, 0), k(0, 1)))));
            }
        EXPECT_LE(found, bound) << round;
    }
}

}  // namespace
}  // namespace freiform::test

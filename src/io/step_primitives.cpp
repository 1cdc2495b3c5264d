// The primitives of constructive solid geometry, as what a polygon, a disc or a half disc sweeps. Each stands
// in the frame of its position.
//
// References: ISO 10303-42:2014, 6.4 (block, right_angular_wedge, right_circular_cone,
// right_circular_cylinder, sphere, torus).
#include "step_shape.hpp"
#include "step_swept.hpp"

#include <cmath>
#include <numbers>

namespace freiform::step {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

std::vector<CurveGeometry<2>> polygon(const std::vector<Vec<2>>& corners) {
    std::vector<CurveGeometry<2>> out;
    for (std::size_t i = 0; i < corners.size(); ++i)
        if (const Vec<2>& next = corners[(i + 1) % corners.size()]; next != corners[i])
            out.push_back(segment(corners[i], next));
    return out;
}

// The half disc to the right of the second axis.
std::vector<CurveGeometry<2>> half_disc(double r) {
    const double w = std::numbers::sqrt2 / 2;
    std::vector<Hom<2>> net{weighted(Vec<2>{{0, -r}}, 1.0), weighted(Vec<2>{{r, -r}}, w),
                            weighted(Vec<2>{{r, 0}}, 1.0), weighted(Vec<2>{{r, r}}, w),
                            weighted(Vec<2>{{0, r}}, 1.0)};
    return {Curve<Hom<2>>::trusted({*BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 2})},
                                   Net<1, Hom<2>>({5}, std::move(net))),
            segment({{0, r}}, {{0, -r}})};
}

// The frame of a profile that turns about the axis of `at`: (x, z, -y).
Placement across(const Placement& at) { return {at.o, at.x, at.z, -1.0 * at.y}; }

}  // namespace

Result<ShapeReader::SweptModel> ShapeReader::primitive(const Fields& f, Type type) {
    const bool is_ball = type == Type::SPHERE, is_cone = type == Type::RIGHT_CIRCULAR_CONE,
               is_wedge = type == Type::RIGHT_ANGULAR_WEDGE, is_box = is_wedge || type == Type::BLOCK,
               is_torus = type == Type::TORUS;
    constexpr std::string_view kBox[] = {"x", "y", "z", "ltx"}, kRing[] = {"major radius", "minor radius"},
                               kRound[] = {"height", "radius", "semi-angle"}, kBall[] = {"radius"};
    const std::string_view* names = is_box ? kBox : is_torus ? kRing : is_ball ? kBall : kRound;
    const int count = is_wedge ? 4 : is_box || is_cone ? 3 : is_ball ? 1 : 2;
    std::array<double, 4> n{};
    for (int k = 0; k < count; ++k) {
        const auto x = f.number(k + (is_ball ? 1 : 2), names[k]);
        if (!x) return std::unexpected(x.error());
        const bool may_be_zero = (is_cone && k == 1) || k == 3;
        if (!(may_be_zero ? *x >= 0 : *x > 0))
            return f.refused(text("has the ", names[k], " ", *x), RefusalKind::invalid);
        n[std::size_t(k)] = *x;
    }
    const auto at = f.reference(is_ball ? 2 : 1, "position");
    if (!at) return std::unexpected(at.error());
    Placement frame;
    if (is_ball) {
        const auto centre = geometry_.point(*at);
        if (!centre) return std::unexpected(centre.error());
        frame.o = *centre;
    } else {
        const auto placed = geometry_.placement(*at);
        if (!placed) return std::unexpected(placed.error());
        frame = *placed;
    }
    // Swept along the third axis of the frame by this, or about it.
    const double height = is_box ? n[2] : is_ball || is_cone || is_torus ? 0 : n[0];
    if (height == 0) frame = across(frame);
    RegionLoops region(1);
    if (is_box) {
        region[0] = polygon({{{0, 0}}, {{n[0], 0}}, {{is_wedge ? n[3] : n[0], n[1]}}, {{0, n[1]}}});
    } else if (is_cone) {
        const double angle = n[2] * geometry_.angle, far = n[1] + n[0] * std::tan(angle);
        if (!(far > 0 && angle < std::numbers::pi / 2))
            return f.refused(text("has the semi-angle ", n[2]), RefusalKind::invalid);
        region[0] = polygon({{{0, 0}}, {{n[1], 0}}, {{far, n[0]}}, {{0, n[0]}}});
    } else if (is_ball) {
        region[0] = half_disc(n[0]);
    } else {
        auto disc = circle_about({{is_torus ? n[0] : 0, 0}}, n[1]);
        if (!disc) return std::unexpected(disc.error());
        region[0] = *std::move(disc);
    }
    auto made =
        height > 0 ? prism(region, {{0, 0, height}}) : solid_of_revolution(region, {{}, {{0, 1, 0}}}, kTurn);
    if (!made) return std::unexpected(made.error());
    return SweptModel{*std::move(made), motion_to(frame), 0};
}

}  // namespace freiform::step

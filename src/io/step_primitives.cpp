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
    const auto placed = [&](int k) -> Result<Placement> {
        const auto at = f.reference(k, "position");
        if (!at) return std::unexpected(at.error());
        return geometry_.placement(*at);
    };
    std::array<double, 4> n{};
    const auto read = [&](int first, std::initializer_list<std::string_view> names) -> Result<void> {
        for (std::size_t k = 0; k < names.size(); ++k) {
            const std::string_view name = names.begin()[k];
            const auto x = f.number(first + int(k), name);
            if (!x) return std::unexpected(x.error());
            const bool may_be_zero = (type == Type::RIGHT_CIRCULAR_CONE && k == 1) || name == "ltx";
            if (!(may_be_zero ? *x >= 0 : *x > 0))
                return f.refused(text("has the ", name, " ", *x), RefusalKind::invalid);
            n[k] = *x;
        }
        return {};
    };
    SweptModel out;
    const auto done = [&](const Result<Placement>& at, Result<Model> made) -> Result<SweptModel> {
        if (!at) return std::unexpected(at.error());
        if (!made) return std::unexpected(made.error());
        out.to = motion_to(*at);
        out.model = *std::move(made);
        return std::move(out);
    };
    const auto turned = [&](Result<Placement> at, Result<RegionLoops> region) -> Result<SweptModel> {
        if (!region) return std::unexpected(region.error());
        if (at) at = across(*at);
        return done(at, solid_of_revolution(*region, {{}, {{0, 1, 0}}}, kTurn));
    };
    Result<void> ok;
    switch (type) {
        case Type::BLOCK:
        case Type::RIGHT_ANGULAR_WEDGE: {
            const bool wedge = type == Type::RIGHT_ANGULAR_WEDGE;
            ok = wedge ? read(2, {"x", "y", "z", "ltx"}) : read(2, {"x", "y", "z"});
            if (!ok) break;
            const double top = wedge ? n[3] : n[0];
            return done(placed(1), prism({polygon({{{0, 0}}, {{n[0], 0}}, {{top, n[1]}}, {{0, n[1]}}})},
                                         {{0, 0, n[2]}}));
        }
        case Type::RIGHT_CIRCULAR_CYLINDER: {
            if (ok = read(2, {"height", "radius"}); !ok) break;
            auto disc = circle_about({}, n[1]);
            if (!disc) return std::unexpected(disc.error());
            return done(placed(1), prism({*std::move(disc)}, {{0, 0, n[0]}}));
        }
        case Type::RIGHT_CIRCULAR_CONE: {
            if (ok = read(2, {"height", "radius", "semi-angle"}); !ok) break;
            const double far = n[1] + n[0] * std::tan(n[2] * geometry_.angle);
            if (!(far > 0 && n[2] * geometry_.angle < std::numbers::pi / 2))
                return f.refused(text("has the semi-angle ", n[2]), RefusalKind::invalid);
            return turned(placed(1),
                          RegionLoops{polygon({{{0, 0}}, {{n[1], 0}}, {{far, n[0]}}, {{0, n[0]}}})});
        }
        case Type::SPHERE: {
            if (ok = read(1, {"radius"}); !ok) break;
            const auto at = f.reference(2, "centre");
            const auto centre = at ? geometry_.point(*at) : Result<Vec<3>>(std::unexpected(at.error()));
            if (!centre) return std::unexpected(centre.error());
            return turned(Placement{*centre}, RegionLoops{half_disc(n[0])});
        }
        default: {
            if (ok = read(2, {"major radius", "minor radius"}); !ok) break;
            auto disc = circle_about({{n[0], 0}}, n[1]);
            if (!disc) return std::unexpected(disc.error());
            return turned(placed(1), RegionLoops{*std::move(disc)});
        }
    }
    return std::unexpected(ok.error());
}

}  // namespace freiform::step

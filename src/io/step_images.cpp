// Images of edges on surfaces that the file brings with it (PCURVE). Nothing rests on them alone: programs
// write images that lie beside their edges, or have other parameters than these. They are taken where they
// hold, and say where to look first where a surface folds.
//
// References: ISO 10303-42:2014, 4.4 (pcurve, surface_curve).
#include "step_geometry.hpp"
#include "step_trace.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

constexpr int kPlacesOfImage = 64;

Vec<2> first_two(const Vec<3>& p) { return {{p[0], p[1]}}; }

}  // namespace

std::vector<CurveGeometry<3>> GeometryReader::images(std::uint32_t curve, std::uint32_t surface) {
    std::vector<CurveGeometry<3>> found;
    for (const Type t : {Type::SURFACE_CURVE, Type::SEAM_CURVE, Type::INTERSECTION_CURVE}) {
        if (!f_.is(curve, t)) continue;
        const Fields f(f_, curve, f_.part(curve, t));
        const auto ids = f.references(f_.type(curve) == Type::unknown ? 1 : 2, "associated geometry");
        if (!ids) continue;
        for (const std::uint32_t id : *ids) {
            const auto p = Fields::of(f_, id, Type::PCURVE, 2);
            const auto on = p ? p->reference(p->size() - 2, "surface") : Result<std::uint32_t>(kMissing);
            if (!p || !on || *on != surface) continue;
            const auto items = items_of_pcurve(id);
            if (!items) continue;
            for (const std::uint32_t item : *items)
                if (auto c = this->curve(item)) found.push_back(std::move(c->curve));
        }
    }
    return found;
}

std::optional<CurveGeometry<2>> without_last_coordinate(const CurveGeometry<3>& c) {
    return visit_one(
        [](const auto& g) -> std::optional<CurveGeometry<2>> {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (std::same_as<G, Line<3>>) {
                return Line<2>{first_two(g.origin), first_two(g.direction)};
            } else if constexpr (std::same_as<G, Conic<3>>) {
                return std::nullopt;
            } else {
                using P = std::conditional_t<Space<typename G::Coefficients>::kRational, Hom<2>, Vec<2>>;
                Net<1, P> net(g.net().extent());
                for (std::size_t i = 0; i < net.flat().size(); ++i) {
                    const auto& from = g.net().flat()[i];
                    if constexpr (std::same_as<P, Hom<2>>)
                        net.flat()[i] = {{from[0], from[1], from.weight()}};
                    else
                        net.flat()[i] = first_two(from);
                }
                return Curve<P>::trusted(g.bases(), std::move(net));
            }
        },
        c);
}

bool begins_and_ends_with(const CurveGeometry<3>& image, Interval on) {
    return visit_one(
        [&](const auto& g) {
            if constexpr (requires { g.net(); }) {
                const BSplineBasis& b = g.basis();
                return b.domain() == on && b.multiplicity(on.lo) >= b.degree() &&
                       b.multiplicity(on.hi) >= b.degree();
            } else {
                return requires { g.direction; };
            }
        },
        image);
}

std::optional<CurveGeometry<3>> image_over(const CurveGeometry<3>& image, Interval on) {
    if (begins_and_ends_with(image, on)) return image;
    return visit_one(
        [&](const auto& g) -> std::optional<CurveGeometry<3>> {
            if constexpr (requires { g.net(); })
                if (g.domain()[0].contains(on.lo) && g.domain()[0].contains(on.hi))
                    if (auto part = restrict_to(g, 0, on)) return *part;
            return std::nullopt;
        },
        image);
}

Foot foot_by_images(const Chart& chart, const Vec<3>& p, const Vec<3>& motion, double t, Interval on,
                    double accuracy, std::span<const CurveGeometry<3>> images) {
    const Foot start = chart.foot(p, motion, chart.locate(p));
    if (!chart.is_spline(0) || !chart.is_spline(1)) return start;
    for (const CurveGeometry<3>& image : images) {
        const Interval all = domain(image)[0], over = std::isfinite(all.length()) ? all : on;
        Vec<2> nearest{};
        double least = kInfinity;
        for (int i = -1; i <= kPlacesOfImage; ++i) {
            const double s =
                i < 0 ? std::clamp(t, over.lo, over.hi) : over.lo + over.length() * i / kPlacesOfImage;
            const Vec<2> uv = first_two(jet<0>(image, s).value());
            const double distance = norm(chart.point(uv) - p);
            if (distance < least) least = distance, nearest = uv;
        }
        if (!(least < kInfinity)) continue;
        const Foot f = chart.foot(p, motion, nearest);
        if (f.regular && f.distance <= 1.1 * start.distance + accuracy) return f;
    }
    return start;
}

}  // namespace freiform::step

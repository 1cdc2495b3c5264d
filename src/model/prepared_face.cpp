// The part of a surface that a face needs: its loops, and some more at all sides, so that the borders of the
// part play no role; a whole turn where there is no room for that.
#include "prepared_face_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform {

namespace {

constexpr double kBeyondLoops = 1.0 / 16;  // of the size of a face, that its part is larger
constexpr std::size_t kChordsOfLoops = 256;
// Chords leave the loops by some, so that a turn looks longer than it is.
constexpr double kTurnSlack = 0x1p-10;

// What a parameter of an analytic surface is.
enum class AxisKind { straight, angle, latitude, given };

AxisKind kind_of_profile(const CurveGeometry<3>& c) {
    if (const auto* conic = std::get_if<Conic<3>>(&c))
        return conic->kind == ConicKind::ellipse ? AxisKind::angle : AxisKind::straight;
    return std::holds_alternative<Line<3>>(c) ? AxisKind::straight : AxisKind::given;
}
std::array<AxisKind, 2> axes_of(const SurfaceGeometry& s) {
    if (const auto* e = std::get_if<Extrusion>(&s)) return {kind_of_profile(e->profile), AxisKind::straight};
    if (const auto* r = std::get_if<Revolution>(&s)) {
        AxisKind across = kind_of_profile(r->profile);
        // Beyond a pole the surface comes back over itself.
        if (across == AxisKind::angle && r->kind != SurfaceKind::torus) across = AxisKind::latitude;
        return {AxisKind::angle, across};
    }
    if (const auto* o = std::get_if<OffsetSurface>(&s)) return axes_of(*o->base);  // which is no offset
    return {AxisKind::given, AxisKind::given};
}

// What the part covers of one parameter: the loops, and some more where there is more.
Result<Interval> window(const Interval& loops, AxisKind kind, const Interval& domain) {
    const double more = kBeyondLoops * loops.length();
    switch (kind) {
        case AxisKind::given:
            return domain;
        case AxisKind::straight:
            return Interval{loops.lo - more, loops.hi + more};
        case AxisKind::latitude:
            if (constexpr double kPole = std::numbers::pi / 2;
                loops.lo >= -kPole * (1 + kTurnSlack) && loops.hi <= kPole * (1 + kTurnSlack))
                return Interval{std::max(loops.lo - more, -kPole), std::min(loops.hi + more, kPole)};
            return loops;
        case AxisKind::angle:
            break;
    }
    if (loops.length() > kTwoPi * (1 + kTurnSlack))
        return refuse(RefusalKind::unsupported, "loops", "go round the surface more than once");
    if (loops.length() + 2 * more < kTwoPi) return Interval{loops.lo - more, loops.hi + more};
    // The seam is where the loops have it, or in the middle of what is left.
    const double lo = loops.middle() - kTwoPi / 2;
    return Interval{lo, lo + kTwoPi};
}

}  // namespace

Result<PreparedFace> PreparedFace::make(const Model& model, const Face& face) {
    const auto rough = FaceRegion::rough(face, model.edges);
    if (!rough) return std::unexpected(rough.error());
    const Vec<2> size{{rough->box().side(0).length(), rough->box().side(1).length()}};
    const auto too_much = [&](const Box<2>&, const Vec<2>& sag) {
        double most = 0;
        for (int i = 0; i < 2; ++i)
            if (sag[i] > 0) most = std::max(most, 0x1p12 * sag[i] / size[i]);
        return most;
    };
    auto region = FaceRegion::make(face, model.edges, too_much, kChordsOfLoops);
    if (!region) return std::unexpected(region.error());
    const auto kinds = axes_of(face.surface);
    const auto whole = domain(face.surface);
    PreparedFace out{{face.surface, {}}, {}, std::move(*region), {}};
    for (int k = 0; k < 2; ++k) {
        const auto side = window(out.region.box().side(k), kinds[std::size_t(k)], whole[std::size_t(k)]);
        if (!side) return std::unexpected(side.error());
        out.part.on[std::size_t(k)] = *side;
    }
    const DerivativeQuery<2, 3> surface(face.surface);
    const auto d = surface(out.part.on, 1);
    auto loops = FaceLoops::make(face, model.edges, {{d(1, 0), d(0, 1)}});
    if (!loops) return std::unexpected(loops.error());
    out.loops = std::move(*loops);
    auto box = box_of_part(out.part);
    if (!box) return std::unexpected(box.error());
    out.box = *box;
    return out;
}

}  // namespace freiform

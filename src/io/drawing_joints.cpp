// Joints and A-frames. Joints are the knots inside curves and the ends of curves that meet, in the colour of
// the order of geometric continuity that query/continuity.hpp finds, with both orders beside them.
//
// Ends meet, and jumps count as none, within kMeet of the size of the drawing: a distance that cannot be
// seen, and yet far above the rounding of the coordinates.
#include "io/drawing_detail.hpp"

#include <freiform/query/continuity.hpp>
#include <freiform/spline/a_frame.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::drawing {

namespace {

constexpr double kMeet = 1e-9;
constexpr int kOrders = 3;  // of G that are told apart
constexpr std::size_t kMostNamed = 60, kMostJoints = 100'000;
// Of G^-1 (a gap) to G^3.
constexpr std::array<Colour, kOrders + 2> kOfOrder{{{0.55, 0.00, 0.10, 1},
                                                    {0.80, 0.30, 0.00, 1},
                                                    {0.72, 0.55, 0.00, 1},
                                                    {0.00, 0.50, 0.36, 1},
                                                    {0.00, 0.33, 0.62, 1}}};
constexpr std::array<std::string_view, kOrders + 2> kSaid{"a gap", "*G*^0: a corner", "*G*^1: one tangent",
                                                          "*G*^2: one curvature", "*G*^3 or smoother"};

ContinuityOptions how(const Sketch& s) {
    ContinuityOptions o;
    o.orders = kOrders;
    o.tolerance = kMeet * s.size;
    return o;
}

void mark(Sketch& s, const Continuity& joint) {
    const auto& p = joint.point;
    const Vec<3> place{{p[0], p[1], p[2]}};
    const Vec<2> at{{dot(s.plane.right, place), dot(s.plane.up, place)}};
    const std::size_t order = std::size_t(std::clamp(joint.g_order, -1, kOrders) + 1);
    DrawnGroup& g = s.group("joints", kOfOrder[order], 1.2);
    g.discs.push_back({at, 5, false});
    g.legend = formula(kSaid[order]);
    if (++s.joints > kMostNamed || joint.c_order < 0) return;
    s.notes.push_back({at, formula(text("*C*^{", joint.c_order, "} *G*^{", joint.g_order, "}")),
                       mixed(g.colour, kInk, 0.3), 14});
}

// In the coordinates of the sketch, where third derivatives stay in the range of double.
template <class P>
Curve<P> scaled(const Sketch& s, const Curve<P>& curve) {
    std::vector<P> c(curve.net().flat().begin(), curve.net().flat().end());
    for (P& p : c)
        for (int i = 0; i < 3; ++i) p[i] = std::scalbn(p[i], -s.plane.exponent);
    const int n = int(c.size());
    return Curve<P>::trusted(curve.bases(), Net<1, P>({n}, std::move(c)));
}

}  // namespace

template <class P>
void add_joints(Sketch& s, const Curve<P>& given) {
    const Curve<P> curve = scaled(s, given);
    const ContinuityOptions options = how(s);
    const auto knots = continuity(curve, options);
    if (!knots) return s.leave_out(text("its joints: ", knots.error().message));
    for (const KnotContinuity& k : *knots) mark(s, k.joint);
    s.ends.push_back(ends_of(curve, options));
}

void join_curves(Sketch& s) {
    const ContinuityOptions options = how(s);
    const auto found = joints(s.ends, options.tolerance, options, kMostJoints);
    if (!found) return s.leave_out(text("joints of curves: ", found.error().message));
    for (const CurveJoint& j : *found)
        if (j.meeting.first != j.meeting.second) mark(s, j.joint);  // else a seam, which is marked already
}

template <class P>
void add_a_frames(Sketch& s, const Curve<P>& curve) {
    if (curve.basis().degree() < 2) return;
    const auto frames = a_frames(curve);
    if (!frames) return s.leave_out(text("its A-frames: ", frames.error().message));
    if (frames->empty()) return;
    DrawnGroup& g = s.group("a-frames", kPalette[1], 1.5);
    g.fill = 0.12;
    g.legend = plain_text("A-frames");
    for (const AFrame<P>& f : *frames) {
        // The apex is extrapolated: of a rational curve it may lie behind the plane of weight 0.
        if (!(Space<P>::weight(f.apex) > 0)) continue;
        const auto at = [&](const P& p) { return s.plane(project(p)); };
        s.take(g, line_through(std::array{at(f.from_left[1]), at(f.apex), at(f.from_right[1])}, true));
        s.take(g, line_through(std::array{at(f.from_left[0]), at(f.from_left[1])}));
        s.take(g, line_through(std::array{at(f.from_right[0]), at(f.from_right[1])}));
        for (const P& p : {f.from_left[0], f.from_left[1], f.joint, f.from_right[1], f.from_right[0], f.apex})
            g.discs.push_back({at(p), 3, false});
    }
}

template void add_a_frames(Sketch&, const Curve<Vec<3>>&);
template void add_a_frames(Sketch&, const Curve<Hom<3>>&);
template void add_joints(Sketch&, const Curve<Vec<3>>&);
template void add_joints(Sketch&, const Curve<Hom<3>>&);

}  // namespace freiform::drawing

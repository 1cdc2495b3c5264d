// Faces of splines that lie in a plane, as planes. In the parameters of such a spline a straight edge or a
// circle may be anything, and chords there bend in space: a disc as a square patch takes eight times as many
// triangles as its circle asks for.
//
// Idea: the plane stands for the spline, and the edges, projected, for its parameter curves. Nothing else
// needs to know. To be proven: the face S(D), D what its loops enclose in the parameter plane, is what their
// image encloses in the plane, no more and no less.
//
// Argument. The degree of S over a point y of the plane, off the image of the boundary, is how often that
// image goes round y. Where S_u x S_v is on one side of the plane for all of D, images of places count with
// one sign, so y is in S(D) just where its degree is not 0. One loop that does not cross itself in the plane
// (which the mesh asks for) goes round what it encloses once. With holes: the turns of tangents along all
// loops add up to the Euler characteristic of D, 1 - holes, as S has no folds; so just one loop runs
// counter-clockwise in the plane, and as no degree is negative the others are inside of it, and not inside of
// each other. So D has to be of one piece: which loops are inside of which is asked of the parameter curves
// themselves (face_loops.cpp). Loops that crossed themselves there would do so in the plane, too.
//
// Where it is not known on which side S_u x S_v is (corners of a square patch that is a disc have none), in
// boxes B_i: a point of S(D) that the loop does not enclose is in some S(B_i), for its degree is 0. S(D)
// hangs together, so it is at most the sum of the diameters of all S(B_i) away: with one loop that is small
// enough. What the loop encloses is covered all the same.
//
// The loop in the plane is that of the projected edges, and the mesh has chords of these; S along a parameter
// curve is off the edge by what edge_gap bounds. A homotopy along the straight lines between them changes how
// often they go round a point only where the point is on such a line, so it is that far from both.
#include "face_loops_detail.hpp"
#include "stand_ins_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/make/image_curve.hpp>
#include <freiform/model/edge_gap.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace freiform {

namespace {

constexpr double kApart = 1.0 / 32;  // of the tolerance, in all
constexpr double kLittle = 0x1p-10;  // of the tolerance: bends that need no points, gaps known well enough
constexpr std::size_t kMostBoxes = 4096, kMostLoops = 64;
constexpr double kResolved = 1e-12;  // of the product of tangents: beyond what they are rounded by
constexpr double kRoundings = 32;    // of coordinates

struct Frame {
    Vec<3> origin, x, y, normal;
    double off = 0;  // no control point is farther from the plane
    Vec<2> operator()(const Vec<3>& p) const { return {{dot(p - origin, x), dot(p - origin, y)}}; }
};

// A plane that all points are near, if they are.
template <class Points>
std::optional<Frame> frame_of(const Points& points, double most) {
    const Vec<3> a = project(points.front());
    const auto farthest = [&](auto&& measure) {
        Vec<3> best = a;
        for (const auto& p : points)
            if (measure(project(p)) > measure(best)) best = project(p);
        return best;
    };
    const Vec<3> b = farthest([&](const Vec<3>& p) { return norm(p - a); });
    const Vec<3> c = farthest([&](const Vec<3>& p) { return norm(cross(p - a, b - a)); });
    const Vec<3> n = cross(b - a, c - a);
    if (!(norm(n) > 0) || !std::isfinite(norm(n))) return std::nullopt;
    Frame out{a, unit(b - a), {}, unit(n), 0};
    out.y = unit(cross(out.normal, out.x));
    for (const auto& p : points) {
        out.off = std::max(out.off, std::abs(dot(project(p) - a, out.normal)));
        if (!(out.off <= most)) return std::nullopt;
    }
    out.off += kRoundings * kUnitRoundoff * (max_abs(a) + norm(b - a));
    return out.off <= most ? std::optional(out) : std::nullopt;
}

std::optional<Frame> frame_of(const SurfaceGeometry& surface, double most) {
    return visit_one(
        [&](const auto& s) -> std::optional<Frame> {
            if constexpr (requires { s.net(); })
                return frame_of(s.net().flat(), most);
            else
                return std::nullopt;
        },
        surface);
}

CurveGeometry<2> projected(const Frame& frame, const CurveGeometry<3>& curve) {
    const auto linear = [&](const Vec<3>& d) { return Vec<2>{{dot(d, frame.x), dot(d, frame.y)}}; };
    return visit_one(
        [&](const auto& c) -> CurveGeometry<2> {
            using C = std::remove_cvref_t<decltype(c)>;
            if constexpr (std::same_as<C, Line<3>>) {
                return Line<2>{frame(c.origin), linear(c.direction)};
            } else if constexpr (std::same_as<C, Conic<3>>) {
                return Conic<2>{c.kind, frame(c.centre), linear(c.x), linear(c.y)};
            } else if constexpr (std::same_as<C, Curve<Vec<3>>>) {
                std::vector<Vec<2>> p;
                for (const auto& q : c.net().flat()) p.push_back(frame(q));
                return Curve<Vec<2>>::trusted(c.bases(), Net<1, Vec<2>>(c.net().extent(), std::move(p)));
            } else {
                std::vector<Hom<2>> p;
                for (const auto& q : c.net().flat()) p.push_back(weighted(frame(project(q)), q.weight()));
                return Curve<Hom<2>>::trusted(c.bases(), Net<1, Hom<2>>(c.net().extent(), std::move(p)));
            }
        },
        curve);
}

// Differences of control points that are rounded as values are, over the shortest piece; quotients of these.
Vec<2> tangents_rounded_by(const DerivativeQuery<2, 3>& surface, const Box<2>& box) {
    Vec<2> out{};
    visit_one(
        [&](const auto& s) {
            if constexpr (requires { s.net(); })
                for (int axis = 0; axis < 2; ++axis) {
                    const auto breaks = s.basis(axis).breaks();
                    double shortest = kInfinity;
                    for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
                        shortest = std::min(shortest, breaks[k + 1] - breaks[k]);
                    out[axis] = kRoundings * s.basis(axis).degree() / shortest * surface.weight_spread() *
                                surface.value_error({box.side(0), box.side(1)});
                }
        },
        surface.geometry());
    return out;
}

// How large the images of those parts of the box are in sum where the surface is not known to be on this side
// of its plane; infinite where that takes too long to bring below `most`.
double doubtful(const DerivativeQuery<2, 3>& surface, const Vec<3>& normal, const Box<2>& box, double most) {
    struct Part {
        double size;
        Box<2> box;
        bool operator<(const Part& o) const { return size < o.size; }
    };
    const Vec<2> rounding = tangents_rounded_by(surface, box);
    std::vector<Part> heap;
    std::size_t boxes = 0;
    const auto look = [&](const Box<2>& b) {
        ++boxes;
        const Vec<2> half = 0.5 * (b.hi - b.lo);
        const auto j = jet<1>(surface.geometry(), (0.5 * (b.lo + b.hi)).c);
        const auto d = surface({b.side(0), b.side(1)});
        // What first derivatives vary by from the middle.
        const double u = d(2, 0) * half[0] + d(1, 1) * half[1], v = d(1, 1) * half[0] + d(0, 2) * half[1];
        const double a = norm(j.d[1]) + rounding[0], c = norm(j.d[2]) + rounding[1];
        const double less = a * (v + rounding[1]) + c * (u + rounding[0]) + u * v;
        if (dot(cross(j.d[1], j.d[2]), normal) > less + kResolved * a * c) return;
        heap.push_back({d(1, 0) * b.side(0).length() + d(0, 1) * b.side(1).length(), b});
        std::push_heap(heap.begin(), heap.end());
    };
    std::array<std::vector<double>, 2> lines;
    for (int axis = 0; axis < 2; ++axis) {
        auto& at = lines[std::size_t(axis)];
        at = {box.lo[axis], box.hi[axis]};
        for (const Kink& k : surface.kinks(axis))
            if (box.lo[axis] < k.at && k.at < box.hi[axis]) at.insert(at.end() - 1, k.at);
    }
    if ((lines[0].size() - 1) * (lines[1].size() - 1) > kMostBoxes) return kInfinity;
    for (std::size_t i = 0; i + 1 < lines[0].size(); ++i)
        for (std::size_t j = 0; j + 1 < lines[1].size(); ++j)
            look({{{lines[0][i], lines[1][j]}}, {{lines[0][i + 1], lines[1][j + 1]}}});
    for (;;) {
        double sum = 0;
        for (const Part& p : heap) sum += p.size;
        if (sum <= most) return sum;
        if (boxes > kMostBoxes || !std::isfinite(sum)) return kInfinity;
        // All that are not small against what is allowed, before the sum is looked at again.
        std::vector<Box<2>> large;
        while (!heap.empty() && heap.front().size > most / (2 * double(heap.size() + large.size()))) {
            large.push_back(heap.front().box);
            std::pop_heap(heap.begin(), heap.end());
            heap.pop_back();
        }
        for (const Box<2>& b : large) {
            const Vec<2> m = 0.5 * (b.lo + b.hi);
            if (!(b.lo[0] < m[0] && m[0] < b.hi[0] && b.lo[1] < m[1] && m[1] < b.hi[1])) return kInfinity;
            look({b.lo, m}), look({{{m[0], b.lo[1]}}, {{b.hi[0], m[1]}}});
            look({{{b.lo[0], m[1]}}, {{m[0], b.hi[1]}}}), look({m, b.hi});
        }
    }
}

// One loop that has all others inside, none of which has another one; known from a place of each.
bool is_of_one_piece(const Model& model, const Face& face, const Vec<2>& stretch) {
    const std::size_t n = face.loops.size();
    if (n == 1) return true;
    if (n > kMostLoops) return false;
    std::vector<int> around(n, 0);
    for (std::size_t k = 0; k < n; ++k) {
        Face alone;
        alone.loops = {face.loops[k]};
        const auto loop = FaceLoops::make(alone, model.edges, stretch);
        if (!loop) return false;
        for (std::size_t l = 0; l < n; ++l) {
            if (l == k) continue;
            const Coedge& c = face.loops[l].coedges.front();
            Box<2> box;
            box.add(jet<0>(c.curve, model.edges[std::size_t(c.edge)].range.middle()).value());
            const Place place = loop->place(box).place;
            if (place == Place::boundary) return false;  // too near to tell
            around[l] += place == Place::inside;
        }
    }
    return std::ranges::count(around, 0) == 1 && std::ranges::count(around, 1) == std::ptrdiff_t(n) - 1;
}

// At the parameters of the curve, which a conic's image does not have.
Result<CurveGeometry<3>> image_of(const SurfaceGeometry& surface, const CurveGeometry<2>& curve) {
    if (std::holds_alternative<Conic<2>>(curve)) return refuse(RefusalKind::unsupported, "", "");
    const auto spline = parameter_spline(curve, domain(curve)[0]);
    if (!spline) return std::unexpected(spline.error());
    return image_curve(surface, *spline);
}

}  // namespace

Box<2> box_of_curves(const Model& model, const Face& face) {
    const auto domain = limits(face.surface);
    Box<2> box;
    for (const Loop& l : face.loops)
        for (const Coedge& c : l.coedges) {
            const DerivativeQuery<1, 2> query(c.curve);
            const Interval on = model.edges[std::size_t(c.edge)].range;
            const auto bounds = coordinate_bounds(query, on);
            const Vec<2> middle = jet<0>(c.curve, on.middle()).value();
            for (int i = 0; i < 2; ++i) {
                const double reach = bounds.coordinate[std::size_t(i)](1) * on.length() / 2;
                Vec<2> lo = middle, hi = middle;
                lo[i] -= reach, hi[i] += reach;
                box.add(clamped(lo, domain)), box.add(clamped(hi, domain));
            }
        }
    return box;
}

std::optional<StandIn> plane_for(const Model& model, const Face& face, double tolerance, Face& standing) {
    const double most = kApart * tolerance;
    const auto frame = frame_of(face.surface, most / 4);
    if (!frame || face.loops.empty()) return std::nullopt;
    std::set<int> edges;
    for (const Loop& l : face.loops)
        for (const Coedge& c : l.coedges) {
            const Edge& e = model.edges[std::size_t(c.edge)];
            if (e.degenerate || !edges.insert(c.edge).second) return std::nullopt;
        }
    const DerivativeQuery<2, 3> surface(face.surface);
    const Box<2> box = box_of_curves(model, face);
    const auto d = surface({box.side(0), box.side(1)});
    const Vec<2> size = box.hi - box.lo;
    if (!(d(2, 0) * size[0] * size[0] + 2 * d(1, 1) * size[0] * size[1] + d(0, 2) * size[1] * size[1] >
          kLittle * tolerance))
        return std::nullopt;  // affine: there is nothing to gain
    const auto j = jet<1>(face.surface, (0.5 * (box.lo + box.hi)).c);
    Frame on = *frame;
    if (dot(cross(j.d[1], j.d[2]), on.normal) < 0) on.normal = -on.normal, on.y = -on.y;
    if (!is_of_one_piece(model, face, {{d(1, 0), d(0, 1)}})) return std::nullopt;
    const double beside = doubtful(surface, on.normal, box, face.loops.size() == 1 ? most / 2 : 0);
    if (!(beside < kInfinity)) return std::nullopt;
    StandIn out{&face, true, 0, 0};
    double more = 0;
    standing = face;
    standing.surface = Extrusion{Line<3>{on.origin, on.x}, on.y, SurfaceKind::plane};
    for (Loop& l : standing.loops)
        for (Coedge& c : l.coedges) {
            const Edge& e = model.edges[std::size_t(c.edge)];
            const auto own = e.curve ? Result<CurveGeometry<3>>(*e.curve) : image_of(face.surface, c.curve);
            if (!own) return std::nullopt;
            const EdgeGap gap = edge_gap(surface, c.curve, *own, e.range, {.target = kLittle * tolerance});
            if (!std::isfinite(gap.bound)) return std::nullopt;  // also where the surface is torn
            out.gap = std::max(out.gap, gap.found);
            more = std::max(more, gap.bound - gap.found);
            c.curve = projected(on, *own);
        }
    out.apart = on.off + beside + more;
    return out.apart <= most ? std::optional(out) : std::nullopt;
}

}  // namespace freiform

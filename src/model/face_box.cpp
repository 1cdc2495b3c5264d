// Tight boxes of faces.
//
// Idea: most of a face lies inside the box of the edges; only parts that may reach beyond it are cut finer,
// those first that may reach farthest. A part of a face is within its error of two triangles
// (face_parts.cpp), so its box is that of its corners, wider by the error, and that of the control points of
// the pieces there (hull_box), whichever is less on each side; parts outside the boundary are left out, which
// a box over all parameters between the loops cannot do. Where too many parts are left, the tight box of the
// whole spline is one as well, and the intersection of both is taken. Cost: at most kMostBoxParts parts for
// each face, as many pieces of a spline; a plane face, which its boundary encloses, needs none. Accuracy:
// contains the face; beyond it by kBoxEnough of the diagonal, where the number of parts suffices, or that of
// the spline where the face is most of it.
#include "face_box_detail.hpp"
#include "face_parts_detail.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/query/bounds.hpp>
#include <freiform/spline/hull_box.hpp>

#include <algorithm>
#include <limits>

namespace freiform {

namespace {

constexpr int kMostBoxParts = 400, kBoundarySamples = 8;
constexpr double kBoxEnough = 1.0 / 128;    // of the diagonal of the box of the edges
constexpr double kBoxBoundary = 1.0 / 512;  // likewise, how well boundaries are known

Box<3> box_around(const FacePart& part, const SurfaceGeometry& surface) {
    Box<3> box;
    for (const Vec<3>& c : part.corner) {
        box.add(c - Box<3>::filled(part.error));
        box.add(c + Box<3>::filled(part.error));
    }
    const auto hull = hull_box(surface, {part.box.side(0), part.box.side(1)});
    return hull ? common(box, *hull) : box;
}

bool is_divisible(const FacePart& p) {
    for (int d = 0; d < 2; ++d)
        if (const double m = p.box.side(d).middle(); p.box.lo[d] < m && m < p.box.hi[d]) return true;
    return false;
}

// Of the whole surface, where it is a spline.
Box<3> box_of_spline(const SurfaceGeometry& surface, double accuracy) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const Box<3> all{Box<3>::filled(-kInfinity), Box<3>::filled(kInfinity)};
    return visit_one(
        [&](const auto& s) {
            if constexpr (requires { s.net(); }) {
                const auto tight = tight_box(s, accuracy, kMostBoxParts);
                return tight ? tight->box : all;
            } else {
                return all;
            }
        },
        surface);
}

// How far the inner box is exceeded.
double beyond(const Box<3>& box, const Box<3>& inner) {
    double most = 0;
    for (int i = 0; i < 3; ++i) most = std::max({most, inner.lo[i] - box.lo[i], box.hi[i] - inner.hi[i]});
    return most;
}

}  // namespace

std::optional<Box<3>> box_of_face(const Face& face, const std::vector<Edge>& edges, const Box<3>& known) {
    Box<3> inner = known, out;
    const auto ends = limits(face.surface);
    for (const Loop& l : face.loops)  // the edges may have no curves in space
        for (const Coedge& c : l.coedges)
            for (int k = 0; k <= kBoundarySamples; ++k) {
                const Interval on = edges[std::size_t(c.edge)].range;
                const double t = on.lo + on.length() * k / kBoundarySamples;
                inner.add(jet<0>(face.surface, clamped(jet<0>(c.curve, t).value(), ends).c).value());
            }
    const auto parts = FaceParts::make(face, edges, kBoxBoundary * inner.diagonal());
    if (!parts) return std::nullopt;
    const auto whole = parts->whole();
    if (!whole) return Box<3>{};
    struct Boxed {
        FacePart part;
        Box<3> box;
        double beyond;
    };
    std::vector<Boxed> heap;
    const auto push = [&](FacePart part) {
        if (!part.crossing)
            for (const Vec<3>& c : part.corner) inner.add(c);
        const Box<3> box = box_around(part, face.surface);
        heap.push_back({std::move(part), box, beyond(box, inner)});
        std::ranges::push_heap(heap, {}, &Boxed::beyond);
    };
    push(*whole);
    for (int seen = 1; seen < kMostBoxParts && !heap.empty();) {
        std::ranges::pop_heap(heap, {}, &Boxed::beyond);
        const Boxed top = std::move(heap.back());
        heap.pop_back();
        if (beyond(top.box, inner) <= kBoxEnough * inner.diagonal() || !is_divisible(top.part)) {
            out.add(top.box);
            continue;
        }
        for (FacePart& half : parts->halves(top.part)) push(std::move(half));
        seen += 2;
    }
    for (const Boxed& left : heap) out.add(left.box);
    if (!heap.empty()) out = common(out, box_of_spline(face.surface, kBoxEnough * inner.diagonal()));
    if (!out.is_empty() && !std::isfinite(out.diagonal())) return std::nullopt;
    return out;
}

}  // namespace freiform

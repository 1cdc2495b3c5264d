// Idea. Branch and bound over parts of faces (face_parts.cpp) and of their boundaries, the part that may be
// nearest first. The nearest point of a face is either inside it, where the distance has a critical point, or
// on its boundary. So a part of the surface without critical point is done, wherever the boundary runs
// through it, and boundaries are curves of their own: what is nearest on an edge costs no more than on a
// curve, and nothing outside of the boundary is ever in the way.
//
// Bounds. A part is within e of two triangles. For any vector n of length 1 a triangle is at least min n . (q
// - c) over its corners c away from q; n from the point that the triangle has nearest to q is the best, and
// any other is right too. It is within a smaller error of the hull of its four corners, which near poles is
// the better bound. Boundaries: face_rim.cpp. Rounding: 64 u of the size of the numbers; values of the
// surface carry value_error_bound.
//
// Cost. A tree of boxes over parts that are a fiftieth of the model or flatter, so that most faces are never
// looked at; then e falls by four with each two halvings, and about a dozen parts of each size are left.
//
// Why not nearest_search.cpp: analytic surfaces and offsets have no control points, and a polynomial in one
// variable that stands for u, v and the boundary is of a degree beyond use.
//
// References. [Johnson Cohen 1998] for the search.
#include "near_parts_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/query/checks.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kRoundings = 64 * 0x1p-53;
double away_from(const Box<3>& box, const Vec<3>& q) {
    Vec<3> d;
    for (int k = 0; k < 3; ++k) d[k] = std::max({box.lo[k] - q[k], q[k] - box.hi[k], 0.0});
    return std::max(0.0, norm(d) * (1 - 8 * 0x1p-53) - kRoundings * max_abs(q));
}

// No point of the hull of the corners is nearer to q. `near`: the point of it that is thought to be nearest.
double away_from(std::span<const Vec<3>> corners, const Vec<3>& near, const Vec<3>& q) {
    const Vec<3> d = q - near;
    const double length = norm(d);
    if (!(length > 0) || !std::isfinite(length)) return 0;
    const Vec<3> n = (1 / length) * d;
    double least = kInfinity, scale = max_abs(q);
    for (const Vec<3>& c : corners) {
        least = std::min(least, dot(n, q - c));
        scale = std::max(scale, max_abs(c));
    }
    return std::max(0.0, least - kRoundings * scale);
}

// By the second derivatives, and by the first ones alone, where the second have no bounds.
double away_from(const FacePart& part, const Vec<3>& q) {
    const double reach = 2 * part.size + part.rounding;
    double least = norm(q - part.corner[0]) - reach - kRoundings * (max_abs(q) + max_abs(part.corner[0]));
    if (!std::isfinite(reach)) least = 0;
    if (std::isfinite(part.hull_error)) {
        double flat = kInfinity, nearest = kInfinity;
        Vec<3> near{};
        for (const Triangle3& t : part.triangles()) {
            const Vec<3> x = closest_point(t, q);
            flat = std::min(flat, away_from(t, x, q));
            if (const double d = norm(x - q); d < nearest) nearest = d, near = x;
        }
        least = std::max({least, flat - part.error, away_from(part.corner, near, q) - part.hull_error});
    }
    return std::max(0.0, least);
}

double along_chord(const FaceRim& rim, const Vec<3>& q) {
    const Vec<3> d = rim.end[1] - rim.end[0];
    const double length = dot(d, d);
    return length > 0 ? std::clamp(dot(q - rim.end[0], d) / length, 0.0, 1.0) : 0;
}

double away_from(const FaceRim& rim, const Vec<3>& q) {
    if (!std::isfinite(rim.error)) return 0;
    const double s = along_chord(rim, q);
    return std::max(0.0, away_from(rim.end, (1 - s) * rim.end[0] + s * rim.end[1], q) - rim.error);
}

}  // namespace

namespace {

// The way from boxes to parts to smaller parts, for one point.
class NearSearch {
public:
    // `without`: faces that take no part; the answer has no face where there is none within `limit`.
    NearSearch(const detail::ModelParts& all, const Vec<3>& q, const ModelNearestOptions& options,
               std::span<const char> without = {}, double limit = kInfinity)
        : q_(q),
          without_(without),
          accuracy_(std::max(options.accuracy > 0 ? options.accuracy : 0x1p-30 * all.size,
                             8 * kRoundings * max_abs(q))),
          parts_left_(options.max_parts) {
        best_.distance = kInfinity;
        push({away_from(all.nodes[0].box, q_), Kind::node, 0, 0, -1});
        while (!heap_.empty()) {
            std::ranges::pop_heap(heap_, {}, key);
            const Item item = heap_.back();
            heap_.pop_back();
            if (item.lower >= best_.distance - accuracy_ || item.lower > limit || parts_left_ <= 0) {
                proven_ = std::min(proven_, item.lower);
                break;
            }
            if (item.kind == Kind::node)
                open_node(all, item.index);
            else if (item.kind == Kind::part)
                open_part(all, item);
            else
                open_rim(all, item);
        }
        for (std::size_t f = 0; best_.face < 0 && proven_ <= limit && f < all.faces.size(); ++f)
            for (const Vec<2>& uv : all.faces[f].region().points())  // the budget was too small
                if (!is_left_out(int(f))) take(all, int(f), uv);
        best_.lower_bound = std::min(proven_, best_.distance);
    }

    const ModelNearest& best() const { return best_; }

private:
    enum class Kind { node, part, rim };
    struct Item {
        double lower;
        Kind kind;
        int index;
        long order;  // of two that are as near the first comes first
        int face;
    };
    static std::pair<double, long> key(const Item& i) { return {-i.lower, -i.order}; }
    void push(Item item) {
        item.order = ++count_;
        heap_.push_back(item);
        std::ranges::push_heap(heap_, {}, key);
    }
    bool is_left_out(int face) const { return !without_.empty() && without_[std::size_t(face)]; }
    void push_part(int face, FacePart part, double at_least) {
        if (is_left_out(face)) return;
        const double lower = std::max(at_least, away_from(part, q_));
        parts_.push_back(std::move(part));
        push({lower, Kind::part, int(parts_.size()) - 1, 0, face});
    }
    void push_rim(const FaceRim& rim, double at_least) {
        if (is_left_out(rim.owner)) return;
        rims_.push_back(rim);
        push({std::max(at_least, away_from(rim, q_)), Kind::rim, int(rims_.size()) - 1, 0, rim.owner});
    }

    void open_node(const detail::ModelParts& all, int index) {
        const NearNode& n = all.nodes[std::size_t(index)];
        if (n.left >= 0) {
            for (const int child : {n.left, n.left + 1})
                push({away_from(all.nodes[std::size_t(child)].box, q_), Kind::node, child, 0, -1});
            return;
        }
        for (int i = n.begin; i < n.end; ++i) {
            const NearLeaf& leaf = all.leaves[std::size_t(i)];
            if (leaf.part >= 0)
                push_part(leaf.face, all.parts[std::size_t(leaf.part)], 0);
            else
                push_rim(all.rims[std::size_t(leaf.rim)], 0);
        }
    }

    bool take(const detail::ModelParts& all, int face, const Vec<2>& uv) {
        const Vec<3> x = all.faces[std::size_t(face)].value(uv);
        const double d = norm(x - q_);
        if (!(d < best_.distance)) return false;
        best_ = {};
        best_.face = face;
        best_.uv = uv;
        best_.point = x;
        best_.distance = d;
        const Interval u{uv[0], uv[0]}, v{uv[1], uv[1]};
        best_.point_error = 2 * value_error_bound(all.model.faces[std::size_t(face)].surface, {u, v}) +
                            kRoundings * std::max(max_abs(x), max_abs(q_));
        return true;
    }

    // A step of Gauss and Newton's from the middle of the box. Where it leaves the box along one parameter,
    // the other one is that of the nearest place on that side.
    Vec<2> stepped(const SurfaceGeometry& surface, const Box<2>& box) const {
        const Vec<2> middle = 0.5 * (box.lo + box.hi);
        const auto j = jet<1>(surface, middle.c);
        const Vec<3> r = q_ - j.value(), along[2] = {j(1, 0), j(0, 1)};
        const double a = dot(along[0], along[0]), b = dot(along[0], along[1]), c = dot(along[1], along[1]),
                     det = a * c - b * b, x = dot(r, along[0]), y = dot(r, along[1]);
        Vec<2> uv = middle;
        if (det > 0) uv = middle + Vec<2>{{(c * x - b * y) / det, (a * y - b * x) / det}};
        const auto into_box = [&](int k) {
            return std::isfinite(uv[k]) ? std::clamp(uv[k], box.lo[k], box.hi[k]) : middle[k];
        };
        for (int k = 0; k < 2; ++k) {
            const double held = into_box(k), square = k == 0 ? c : a;
            if (held != uv[k] && square > 0)
                uv[1 - k] = middle[1 - k] + dot(r - (held - middle[k]) * along[k], along[1 - k]) / square;
            uv[k] = held;
        }
        return {{into_box(0), into_box(1)}};
    }

    void open_part(const detail::ModelParts& all, const Item& item) {
        const FacePart part = std::move(parts_[std::size_t(item.index)]);
        const FaceParts& parts = all.faces[std::size_t(item.face)];
        --parts_left_;
        if (!all.model.faces[std::size_t(item.face)].loops.empty() && !parts.may_have_foot(part, q_)) return;
        if (const Vec<2> uv = stepped(all.model.faces[std::size_t(item.face)].surface, part.box);
            parts.holds(part, uv))
            take(all, item.face, uv);
        bool can = false;
        for (int k = 0; k < 2; ++k) {
            const double m = part.box.side(k).middle();
            can = can || (part.box.lo[k] < m && m < part.box.hi[k]);
        }
        if (!can || part.size < accuracy_ / 8) {
            proven_ = std::min(proven_, item.lower);
            return;
        }
        for (FacePart& half : parts.halves(part, part.hull_error > accuracy_ / 8 && part.may_be_long()))
            push_part(item.face, std::move(half), item.lower);
    }

    void open_rim(const detail::ModelParts& all, const Item& item) {
        const FaceRim rim = rims_[std::size_t(item.index)];
        --parts_left_;
        const double s = along_chord(rim, q_);
        const Face& face = all.model.faces[std::size_t(rim.owner)];
        if (!rim.coedge) {  // its ends are on other parts
            proven_ = std::min(proven_, item.lower);
            return;
        }
        const double t = s >= 1 ? rim.on.hi : clamped(rim.on.lo + s * rim.on.length(), rim.on);
        if (take(all, rim.owner, clamped(jet<0>(rim.coedge->curve, t).value(), limits(face.surface)))) {
            const Edge& edge = all.model.edges[std::size_t(rim.coedge->edge)];
            best_.edge = rim.coedge->edge;
            best_.t = t;
            best_.vertex = t <= edge.range.lo || edge.degenerate ? edge.start
                           : t >= edge.range.hi                  ? edge.end
                                                                 : -1;
        }
        const double middle = rim.on.middle();
        if (!(rim.on.lo < middle && middle < rim.on.hi)) {
            proven_ = std::min(proven_, item.lower);
            return;
        }
        for (const Interval half : {Interval{rim.on.lo, middle}, Interval{middle, rim.on.hi}})
            push_rim(all.rim_over(rim.owner, rim.coedge, rim.curve, half), item.lower);
    }

    Vec<3> q_;
    std::span<const char> without_;
    double accuracy_, proven_ = kInfinity;
    int parts_left_;
    long count_ = 0;
    ModelNearest best_;
    std::vector<Item> heap_;
    std::vector<FacePart> parts_;
    std::vector<FaceRim> rims_;
};

}  // namespace

Result<ModelNearestQuery> ModelNearestQuery::make(Model model) {
    auto prepared = std::make_shared<detail::ModelParts>(std::move(model));
    if (auto done = prepared->prepare(); !done) return std::unexpected(done.error());
    ModelNearestQuery q;
    q.prepared_ = std::move(prepared);
    return q;
}

const Model& ModelNearestQuery::model() const { return prepared_->model; }

Result<void> ModelNearestQuery::nearest(std::span<const Vec<3>> points, std::span<ModelNearest> out,
                                        const ModelNearestOptions& options) const {
    FF_REQUIRE(out.size() == points.size());
    if (auto ok = detail::check_points<3>(points, options.accuracy, options.max_parts); !ok) return ok;
    parallel_for(points.size(), 1,
                 [&](std::size_t i) { out[i] = NearSearch(*prepared_, points[i], options).best(); });
    return {};
}

Result<ModelNearest> ModelNearestQuery::nearest(const Vec<3>& point,
                                                const ModelNearestOptions& options) const {
    ModelNearest out;
    if (auto done = nearest(std::span(&point, 1), std::span(&out, 1), options); !done)
        return std::unexpected(done.error());
    return out;
}

Result<NearestFaces> ModelNearestQuery::nearest_faces(const Vec<3>& point, int count, double radius,
                                                      const ModelNearestOptions& options) const {
    if (auto ok = detail::check_points<3>(std::span(&point, 1), options.accuracy, options.max_parts); !ok)
        return std::unexpected(ok.error());
    if (count < 1) return refuse(RefusalKind::invalid, "count", text("must be positive, found ", count));
    if (!(radius >= 0)) return refuse(RefusalKind::invalid, "radius", text(radius, " is not a distance"));
    NearestFaces out;
    std::vector<char> without(model().faces.size(), 0);
    for (;;) {
        const ModelNearest n = NearSearch(*prepared_, point, options, without, radius).best();
        out.others = n.lower_bound;
        if (n.face < 0 || n.lower_bound > radius || int(out.faces.size()) == count) return out;
        without[std::size_t(n.face)] = 1;
        out.faces.push_back(n);
    }
}

}  // namespace freiform

// Idea. Of a point p(t) = a + t d of a segment and a triangle, "in the triangle in the picture" says that
// three linear functions of t are not negative, and "behind its plane by more than the tolerance" that a
// fourth one is: each triangle hides an interval of t, found by clipping [0, 1] four times. The hidden part
// is the union.
//
// Why the distance from the plane and not the difference of depths: let a smooth surface of radius of
// curvature R be replaced by triangles within e, and p be a point of its outline. The triangles cover p by up
// to e in the picture; where they do, they are nearer in depth by up to sqrt(2 R e), which is far more than
// e, but p lies behind their planes by at most 2 e + e (with p at R - e from the axis of a circle of radius
// R, the tangent at the same height is at the distance R - (R - e)^2 / R < 2 e from p). A tolerance of 4 e
// therefore keeps outlines, and costs what is less than 4 e behind something: not to be seen in the picture.
//
// Method. A tree of boxes of triangles in space, halved at the median along the longer side in the picture.
// A query leaves out boxes beside the segment and boxes that are wholly behind it.
//
// Cost. Building O(n log n); a query visits the boxes that the box of the segment meets.
//
// Accuracy. The functions are evaluated in doubles; ends of intervals move by the rounding of coordinates.
// Between triangles that share an edge rounding may leave a gap of that size; `seen_parts` closes it.
//
// References. [Appel 1967] follows the number of surfaces in front along a line and changes it where outlines
// are crossed; [Hertzmann and Zorin 2000] give the outlines of a mesh as zero sets of n . view.
//
// Why not Appel's counting: one missed crossing spoils the rest of the line, and crossings are missed or
// found twice exactly where a curve touches an outline, which every isoline of a surface does.
#include <freiform/core/sort.hpp>
#include <freiform/mesh/visibility.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr int kLeaf = 6;

// Keeps the t of `on` with f0 + t (f1 - f0) >= 0.
bool clip(Interval& on, double f0, double f1) {
    if (f0 >= 0 && f1 >= 0) return true;
    if (f0 < 0 && f1 < 0) return false;
    const double t = f0 / (f0 - f1);
    if (f0 < 0)
        on.lo = std::max(on.lo, t);
    else
        on.hi = std::min(on.hi, t);
    return on.lo < on.hi;
}

double side(const Vec<3>& a, const Vec<3>& b, const Vec<3>& p) {
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

Box<3> box_of(const std::array<Vec<3>, 3>& t) {
    Box<3> box;
    for (const Vec<3>& p : t) box.add(p);
    return box;
}

void unite(std::vector<Interval>& parts) {
    sort(parts, {}, &Interval::lo);
    std::size_t n = 0;
    for (const Interval& p : parts) {
        if (n > 0 && p.lo <= parts[n - 1].hi)
            parts[n - 1].hi = std::max(parts[n - 1].hi, p.hi);
        else
            parts[n++] = p;
    }
    parts.resize(n);
}

double length_in_picture(std::span<const Vec<3>> points) {
    double sum = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
        sum += std::hypot(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1]);
    return sum;
}

// Appends a part that begins where the last one ends.
void append(std::vector<SeenPart>& parts, SeenPart p) {
    if (parts.empty() || parts.back().hidden != p.hidden)
        parts.push_back(std::move(p));
    else
        parts.back().points.insert(parts.back().points.end(), p.points.begin() + 1, p.points.end());
}

}  // namespace

Occluders::Occluders(std::vector<std::array<Vec<3>, 3>> triangles, double tolerance)
    : triangles_(std::move(triangles)), tolerance_(tolerance) {
    std::erase_if(triangles_, [](std::array<Vec<3>, 3>& t) {
        const double area = side(t[0], t[1], t[2]);
        if (area < 0) std::swap(t[1], t[2]);
        return !(area != 0 && std::isfinite(area));
    });
    build();
}

void Occluders::build() {
    nodes_.push_back({{}, 0, int(triangles_.size()), -1});
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
        Node node = nodes_[k];
        Box<3> middles;
        for (int i = node.begin; i < node.end; ++i) {
            const Box<3> box = box_of(triangles_[std::size_t(i)]);
            node.box.add(box);
            middles.add(0.5 * (box.lo + box.hi));
        }
        if (node.end - node.begin > kLeaf) {
            const int axis = middles.side(0).length() >= middles.side(1).length() ? 0 : 1;
            const int half = node.begin + (node.end - node.begin) / 2;
            const auto at = triangles_.begin();
            std::nth_element(at + node.begin, at + half, at + node.end, [axis](const auto& a, const auto& b) {
                const Box<3> p = box_of(a), q = box_of(b);
                return p.lo[axis] + p.hi[axis] < q.lo[axis] + q.hi[axis];
            });
            node.left = int(nodes_.size());
            nodes_.push_back({{}, node.begin, half, -1});
            nodes_.push_back({{}, half, node.end, -1});
        }
        nodes_[k] = node;
    }
}

std::vector<Interval> Occluders::hidden(const Vec<3>& from, const Vec<3>& to) const {
    std::vector<Interval> out;
    Box<3> segment;
    segment.add(from);
    segment.add(to);
    std::array<int, 128> stack{0};  // two per level, of which there are less than 32
    for (std::size_t n = 1; n > 0;) {
        const Node& node = nodes_[std::size_t(stack[--n])];
        const Box<3>& b = node.box;
        if (!b.side(0).overlaps(segment.side(0)) || !b.side(1).overlaps(segment.side(1)) ||
            !(b.hi[2] > segment.lo[2]))
            continue;
        if (node.left >= 0) {
            stack[n++] = node.left;
            stack[n++] = node.left + 1;
            continue;
        }
        for (int i = node.begin; i < node.end; ++i) {
            const auto& [p, q, r] = triangles_[std::size_t(i)];
            Interval on{0, 1};
            if (!clip(on, side(p, q, from), side(p, q, to)) || !clip(on, side(q, r, from), side(q, r, to)) ||
                !clip(on, side(r, p, from), side(r, p, to)))
                continue;
            const Vec<3> normal = unit(cross(q - p, r - p));  // towards the eye
            const double before = -tolerance_ - dot(normal, from - p),
                         after = -tolerance_ - dot(normal, to - p);
            if (clip(on, before, after) && on.lo < on.hi) out.push_back(on);
        }
    }
    unite(out);
    return out;
}

std::vector<SeenPart> seen_parts(const Occluders& occluders, std::span<const Vec<3>> polyline) {
    std::vector<SeenPart> parts;
    for (std::size_t i = 1; i < polyline.size(); ++i) {
        const Vec<3>&a = polyline[i - 1], &b = polyline[i];
        const auto at = [&](double t) { return t <= 0 ? a : t >= 1 ? b : a + t * (b - a); };
        double done = 0;
        const auto add = [&](double to, bool hidden) {
            if (to > done) append(parts, {hidden, {at(done), at(to)}});
            done = std::max(done, to);
        };
        for (const Interval& h : occluders.hidden(a, b)) {
            add(h.lo, false);
            add(h.hi, true);
        }
        add(1, false);
    }
    // Visible specks first, then gaps in what is visible.
    for (const bool hidden : {false, true}) {
        if (parts.size() < 2) break;
        std::vector<SeenPart> joined;
        for (SeenPart& p : parts) {
            if (p.hidden == hidden && length_in_picture(p.points) < occluders.tolerance()) p.hidden = !hidden;
            append(joined, std::move(p));
        }
        parts = std::move(joined);
    }
    return parts;
}

}  // namespace freiform

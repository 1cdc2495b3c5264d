// See face_mesh.cpp for the whole.
#include "filler_detail.hpp"
#include "serial_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/mesh/normal_cone.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace freiform {

namespace {

constexpr double kPole = 1.0 / 64;
constexpr double kLittleError = 1.0 / 64;     // of the tolerance: triangles without feet had better be large
constexpr std::size_t kTrianglesAtOnce = 32;  // that a thread judges
constexpr std::size_t kJudgedAtOnce = 1024;   // by all threads
constexpr std::size_t kPatienceForAngles = 32;  // times the points to begin with
constexpr double kAboutAsLong = 0.75;           // of a given side: what is left to halve
constexpr double kNearPoint = 1e-3;             // of a leaf: likewise, for other points
constexpr double kLeastLength = 1e-9;           // of the box of the face: shorter is rounding
constexpr double kLeastWidth = 0x1p-60;         // likewise: only near 0 do doubles go on from there
constexpr double kNearBoundary =
    0.3;  // leaf corners nearer to the boundary than this part of a leaf make slivers

// The largest first.
void sort_down(std::array<std::pair<double, int>, 3>& x) {
    for (const std::size_t k : {0, 1, 0})
        if (x[k] < x[k + 1]) std::swap(x[k], x[k + 1]);
}

// By what is seen in the middle.
double least_error(const Jet<2, 2, Vec<3>>& middle, const std::array<Vec<2>, 3>& corner, bool along_normal) {
    const Vec<3> m = cross(middle(1, 0), middle(0, 1));
    if (along_normal && norm(m) > 0) {
        const Vec<3> n = unit(m);
        return Quadratic{dot(n, middle(2, 0)), dot(n, middle(1, 1)), dot(n, middle(0, 2))}.error(corner);
    }
    return quadratic_error({middle(2, 0), middle(1, 1), middle(0, 2)}, corner, 0);
}

}  // namespace

Filler::Filler(Triangulation& t, const CurvatureTree& tree, const Judge& judge,
               const DerivativeQuery<2, 3>& surface, Vec<2> scale, const FaceDemands& demands)
    : t_(t), tree_(tree), judge_(judge), surface_(surface), scale_(scale), demands_(demands) {
    Box<2> box;
    for (const Vec<2>& p : t.points()) box.add(unscaled(p));
    least_ = kLeastLength * (box.hi - box.lo);
    if (!std::isfinite(demands.max_angle)) return;
    Box<3> size;
    for (std::size_t v = 0; v < t.points().size(); ++v) size.add(position(int(v)));
    angle_floor_ = angle_floor(demands.tolerance, demands.max_angle, norm(size.hi - size.lo));
}

Vec<3> Filler::position(int vertex) {
    const std::size_t v = std::size_t(vertex);
    if (positions_.size() <= v) positions_.resize(std::max(t_.points().size(), v + 1));
    if (!positions_[v]) positions_[v] = looked_up(vertex);
    return *positions_[v];
}

Vec<3> Filler::looked_up(int vertex) const { return jet<0>(surface_.geometry(), uv(vertex).c).value(); }

std::pair<double, int> Filler::longest_side(int triangle) {
    std::pair<double, int> longest{0, -1};
    const auto v = t_.vertices(triangle);
    for (std::size_t e = 0; e < 3; ++e) {
        if (t_.is_constrained(triangle, int(e))) continue;
        const double length = norm(position(v[(e + 2) % 3]) - position(v[(e + 1) % 3]));
        if (length > longest.first) longest = {length, int(e)};
    }
    return longest;
}

Filler::LongestSide Filler::longest_of_all(int triangle) {
    LongestSide out;
    double given = 0, free = 0;
    const auto v = t_.vertices(triangle);
    for (std::size_t e = 0; e < 3; ++e) {
        const double length = norm(position(v[(e + 2) % 3]) - position(v[(e + 1) % 3]));
        if (t_.is_constrained(triangle, int(e)))
            given = std::max(given, length);
        else if (length > free)
            free = length, out.edge = int(e);
    }
    out.longest = std::max(given, free);
    if (free < kAboutAsLong * given) out.edge = -1;
    return out;
}

// A corner where a first derivative is tiny beside what it is inside: no box with it has bounded normals.
// Or too narrow, along the surface: beside a side of the boundary, which stays, halving the others brings
// points nearer to it each time, and the nearer they are, the more triangles lean towards its arc.
bool Filler::is_narrow_or_at_pole(const std::array<Vec<2>, 3>& corner, double longest) const {
    const Vec<2> middle = (1.0 / 3) * (corner[0] + corner[1] + corner[2]);
    const auto inside = jet<1>(surface_.geometry(), middle.c);
    const double twice_area =
        norm(cross(inside.d[1], inside.d[2])) * std::abs(cross(corner[1] - corner[0], corner[2] - corner[0]));
    if (!(twice_area > kAngleWidth * angle_floor_ * longest)) return true;
    for (const Vec<2>& c : corner) {
        const auto j = jet<1>(surface_.geometry(), c.c);
        for (std::size_t d = 1; d < 3; ++d)
            if (norm(j.d[d]) < kPole * norm(inside.d[d])) return true;
    }
    return false;
}

// Sides of the boundary are given, and a triangle between them and inner points that are clearly nearer than
// they are long cannot turn less by further points.
int Filler::turning_side(int triangle) {
    if (!std::isfinite(demands_.max_angle)) return -1;
    const LongestSide s = longest_of_all(triangle);
    if (s.edge < 0 || !(s.longest > angle_floor_)) return -1;
    if (t_.points().size() > most_for_angles_) return -1;
    const auto& v = t_.vertices(triangle);
    if (is_narrow_or_at_pole({uv(v[0]), uv(v[1]), uv(v[2])}, s.longest)) return -1;
    const std::array<Vec<2>, 3> corner{uv(v[0]), uv(v[1]), uv(v[2])};
    const double angle =
        normal_angle_bound(surface_, corner, {position(v[0]), position(v[1]), position(v[2])});
    if (angle <= demands_.max_angle) return -1;
    Box<2> box;
    for (const Vec<2>& p : corner) box.add(p);
    return has_narrow_cones(surface_, box, demands_.max_angle) ? s.edge : -1;
}

bool Filler::is_fine(int triangle) {
    return bound(triangle) <= demands_.tolerance &&
           (!std::isfinite(demands_.max_edge) || longest_side(triangle).first <= demands_.max_edge) &&
           turning_side(triangle) < 0;
}

bool Filler::is_near_boundary(int triangle, const Vec<2>& x, const Vec<2>& leaf) const {
    // Distances in the metric where the leaf is a unit square. Leaves between two kinks that differ by
    // rounding only are too thin to measure by.
    const auto local = [&](const Vec<2>& d) {
        return Vec<2>{{d[0] / (std::max(leaf[0], least_[0]) * scale_[0]),
                       d[1] / (std::max(leaf[1], least_[1]) * scale_[1])}};
    };
    const auto& v = t_.vertices(triangle);
    for (std::size_t e = 0; e < 3; ++e) {
        const Vec<2> a = t_.points()[std::size_t(v[(e + 1) % 3])],
                     b = t_.points()[std::size_t(v[(e + 2) % 3])];
        const Vec<2> ab = local(b - a), ax = local(x - a);
        if (max_abs(ax) < kNearPoint) return true;
        if (!t_.is_constrained(triangle, int(e))) continue;
        const double along = std::clamp(dot(ab, ax) / dot(ab, ab), 0.0, 1.0);
        if (norm(ax - along * ab) < kNearBoundary) return true;
    }
    return false;
}

void Filler::insert_corners(std::span<const CurvatureTree::Corner> corners) {
    int hint = -1;  // the last that was inserted may be far away, when many are not
    for (const auto& corner : corners) {
        const Vec<2> x = scaled(corner.at);
        hint = t_.locate(x, hint).triangle;
        t_.insert(x, hint, [&](int triangle) { return is_near_boundary(triangle, x, corner.leaf); });
    }
    most_for_angles_ = kPatienceForAngles * (t_.points().size() + 600);
}

bool Filler::is_plain(int vertex) const {
    return tree_.is_all_plain() || (std::size_t(vertex) < plain_.size() && plain_[std::size_t(vertex)]);
}

void Filler::keep_feet(int first, std::span<const char> marked, std::span<const char> plain) {
    first_kept_ = first;
    kept_.assign(marked.begin(), marked.end());
    plain_.assign(std::size_t(first), 0);
    plain_.insert(plain_.end(), plain.begin(), plain.end());
}

// Its vertices whose feet others count on.
bool Filler::note_kept(int triangle) {
    bool any = false;
    for (const int v : t_.vertices(triangle))
        if (!is_plain(v) && has_kept_foot(v)) stuck_at_.push_back(uv(v)), any = true;
    return any;
}

// At a side of a block, and no wider than rounding: no point would make it better.
bool Filler::note_sliver(int triangle, std::vector<Vec<2>>& at) const {
    constexpr double kNoWidth = 0x1p-20;  // of the side
    const auto& v = t_.vertices(triangle);
    for (std::size_t e = 0; e < 3; ++e) {
        const int a = v[(e + 1) % 3], b = v[(e + 2) % 3];
        if (!t_.is_constrained(triangle, int(e)) || std::min(a, b) < first_kept_) continue;
        const Vec<2> p = t_.points()[std::size_t(a)], side = t_.points()[std::size_t(b)] - p,
                     beside = t_.points()[std::size_t(v[e])] - p;
        if (std::abs(cross(side, beside)) > kNoWidth * dot(side, side)) continue;
        at.push_back(uv(a)), at.push_back(uv(b));
        return true;
    }
    return false;
}

bool Filler::make_plain(int triangle, std::vector<int>& judge_again) {
    if (note_kept(triangle)) return false;
    bool any = false;
    for (const int v : t_.vertices(triangle)) {
        if (is_plain(v)) continue;
        if (plain_.size() <= std::size_t(v)) plain_.resize(t_.points().size());
        plain_[std::size_t(v)] = any = true;
        const int first = t_.triangle_of(v);
        int t = first;
        do {
            if (std::size_t(t) < known_.size()) known_[std::size_t(t)].any = false;
            if (t_.is_inside(t)) judge_again.push_back(t);
            t = t_.neighbour(t, (t_.corner_of(t, v) + 1) % 3);
        } while (t != first);
    }
    return any;
}

// What the tree says of the leaves that the triangle meets; where that is not enough, what can be said of its
// own box, which may be much smaller than a leaf.
Filler::Known Filler::found(int triangle, int& place, const Positions& position_of) const {
    const auto& v = t_.vertices(triangle);
    const std::array<Vec<2>, 3> corner{uv(v[0]), uv(v[1]), uv(v[2])};
    Box<2> box;
    for (const Vec<2>& p : corner) box.add(p);
    const int plain = is_plain(v[0]) + is_plain(v[1]) + is_plain(v[2]);
    const bool is_deep = std::min({v[0], v[1], v[2]}) >= first_kept_;  // those of the boundary come first
    place = tree_.place_of(box, place);
    const Bending over = tree_.over(box, place);
    Known k{judge_(over, box, corner, plain, place, is_deep), t_.stamp(triangle), true};
    if (k.bound <= demands_.tolerance) return k;
    const auto judge_by = [&](Bending own) {
        own.full.restrict_to(over.full);
        const Judgement second = judge_(own, box, corner, plain, place, is_deep);
        if (second.bound < k.bound || (second.bound == k.bound && second.whole <= k.whole))
            static_cast<Judgement&>(k) = second;
    };
    const auto middle = jet<2>(surface_.geometry(), (0.5 * (box.lo + box.hi)).c);
    const bool thin = is_thin({scaled(corner[0]), scaled(corner[1]), scaled(corner[2])});
    const bool hopeless =
        !tree_.cone() && !thin && !(least_error(middle, corner, plain == 0) <= demands_.tolerance);
    if (const Variation* varies = tree_.variation_in(place))
        judge_by(bending_from_middle(surface_, box, plain < 3, middle, *varies));
    if (k.bound <= demands_.tolerance || hopeless) return k;
    const Box<2> wide = room_for_fit(surface_, box);
    const bool fits = !tree_.cone() && is_fitted(surface_, wide);
    if (fits) {
        TriangleOn on{corner, {}};
        for (std::size_t i = 0; i < 3; ++i) on.at[i] = position_of(v[i]);
        const auto seen = wide == box ? middle : jet<2>(surface_.geometry(), (0.5 * (wide.lo + wide.hi)).c);
        judge_by(bending_by_fit(surface_, wide, plain < 3, seen, &on));
    }
    // Edges count on what derivatives alone say of slivers at them (edge_error.cpp).
    if (!(k.bound <= demands_.tolerance) && (!fits || (thin && !is_deep)))
        judge_by(tree_.cone() ? tree_.bending_in(surface_, box, plain < 3, middle)
                              : bending_of(surface_, box, plain < 3, middle));
    return k;
}

const Filler::Known& Filler::known(int triangle) {
    const std::size_t i = std::size_t(triangle);
    if (known_.size() <= i) known_.resize(std::max(std::size_t(t_.size()), i + 1));
    if (!is_known(triangle)) known_[i] = found(triangle, place_, [&](int v) { return position(v); });
    return known_[i];
}

double Filler::bound(int triangle) { return known(triangle).bound; }

// Whether points beside it would differ by nothing that a surface can tell. Beside a given side whose error
// is too large this is where halving others ends.
bool Filler::has_no_width(const Vec<2> (&corner)[3]) const {
    const auto in_box = [&](const Vec<2>& d) {
        return Vec<2>{{kLeastLength * d[0] / least_[0], kLeastLength * d[1] / least_[1]}};
    };
    const Vec<2> a = in_box(corner[1] - corner[0]), b = in_box(corner[2] - corner[0]);
    return std::abs(cross(a, b)) <= kLeastWidth * std::max({norm(a), norm(b), norm(b - a)});
}

// Inserts a point that makes the triangle better; false if there is none.
bool Filler::improve(int triangle) {
    const auto v = t_.vertices(triangle);
    const Vec<2> corner[3] = {uv(v[0]), uv(v[1]), uv(v[2])};
    if (has_no_width(corner)) return false;
    Box<2> box;
    for (const Vec<2>& p : corner) box.add(p);
    const Curvature c = known(triangle).curvature;
    const auto attempt = [&](const Vec<2>& at) {
        return t_.insert(scaled(at), triangle).status == Triangulation::Insert::done;
    };
    // Where the side that spans most of a kink crosses it.
    const auto attempt_on = [&](const std::pair<int, double>& kink) {
        const auto [axis, at] = kink;
        std::array<std::pair<double, int>, 3> spans;
        for (int e = 0; e < 3; ++e)
            spans[std::size_t(e)] = {std::abs(corner[(e + 2) % 3][axis] - corner[(e + 1) % 3][axis]), e};
        sort_down(spans);
        for (const auto& [span, e] : spans) {
            const Vec<2> p = corner[(e + 1) % 3], q = corner[(e + 2) % 3];
            if (t_.is_constrained(triangle, e) || (p[axis] - at) * (q[axis] - at) >= 0) continue;
            if (std::min(std::abs(p[axis] - at), std::abs(q[axis] - at)) <= least_[axis]) continue;
            Vec<2> x = p + ((at - p[axis]) / (q[axis] - p[axis])) * (q - p);
            x[axis] = at;
            if (attempt(x)) return true;
        }
        return false;
    };
    if (known(triangle).bound <= demands_.tolerance) {  // too long, then, or turning
        const int turning = turning_side(triangle);
        const auto [length, longest] = longest_side(triangle);
        if (const auto kink = tree_.worst_kink(box); kink && turning >= 0 && attempt_on(*kink)) return true;
        const int e = turning >= 0 && length <= demands_.max_edge ? turning : longest;
        return e >= 0 && attempt(0.5 * (corner[(e + 1) % 3] + corner[(e + 2) % 3]));
    }
    std::array<std::pair<double, int>, 3> sides;  // by the error that they stand for
    for (int e = 0; e < 3; ++e) {
        const Vec<2> d = corner[(e + 2) % 3] - corner[(e + 1) % 3];
        sides[std::size_t(e)] = {c.along(d[0], d[1]), e};
    }
    if (const auto kink = tree_.worst_kink(box);
        kink && tree_.kink_bound(box) > demands_.tolerance / 4 && attempt_on(*kink))
        return true;
    sort_down(sides);
    for (const auto& [error, e] : sides)
        if (!t_.is_constrained(triangle, e) && attempt(0.5 * (corner[(e + 1) % 3] + corner[(e + 2) % 3])))
            return true;
    return attempt((1.0 / 3) * (corner[0] + corner[1] + corner[2]));
}

// By all threads. Most triangles that there are at first are the last ones, and others mostly stay until it
// is their turn: of some at a time it is a third more than what is asked for later where little is fine, and
// the same. What became plain meanwhile is judged with those that are queued again, by any number of threads.
void Filler::judge(std::span<const Entry> entries) {
    known_.resize(std::size_t(t_.size()));
    std::vector<int> unknown;
    for (const auto& [triangle, stamp] : entries)
        if (t_.stamp(triangle) == stamp && !is_known(triangle)) unknown.push_back(triangle);
    sort(unknown.begin(), unknown.end());  // entries may repeat each other
    unknown.erase(std::unique(unknown.begin(), unknown.end()), unknown.end());
    const auto in_parts = [](std::size_t all, auto&& of_part) {
        parallel_for((all + kTrianglesAtOnce - 1) / kTrianglesAtOnce, 1, [&](std::size_t part) {
            of_part(part * kTrianglesAtOnce, std::min(all, (part + 1) * kTrianglesAtOnce));
        });
    };
    std::vector<int> corners;  // that nobody has asked for
    positions_.resize(std::max(positions_.size(), t_.points().size()));
    for (const int i : unknown)
        for (const int v : t_.vertices(i))
            if (auto& p = positions_[std::size_t(v)]; !p) p.emplace(), corners.push_back(v);
    in_parts(corners.size(), [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) positions_[std::size_t(corners[i])] = looked_up(corners[i]);
    });
    in_parts(unknown.size(), [&](std::size_t first, std::size_t end) {
        int place = 0;
        for (std::size_t i = first; i < end; ++i)
            known_[std::size_t(unknown[i])] =
                found(unknown[i], place, [&](int v) { return *positions_[std::size_t(v)]; });
    });
}

bool Filler::refine(std::size_t max_points) {
    const bool by_threads = demands_.is_shared && !is_serial();
    std::vector<Entry> queue;
    std::size_t judged = 0;  // of the queue
    std::vector<int> again;
    std::vector<std::size_t> latest;  // of triangles that are queued again: the entry that counts
    std::size_t gone = 0;             // entries before those in the queue
    std::vector<Vec<2>> slivers;
    bool is_full = false;
    for (int i = 0; i < t_.size(); ++i)
        if (t_.is_inside(i)) queue.push_back({i, t_.stamp(i)});
    const auto queue_changed = [&] {
        for (const int i : t_.changed())
            if (t_.is_inside(i)) queue.push_back({i, t_.stamp(i)});
    };
    for (std::size_t head = 0; head < queue.size(); ++head) {
        if (by_threads && head >= judged) {
            judged = std::min(queue.size(), head + kJudgedAtOnce);
            judge(std::span(queue).subspan(head, judged - head));
        }
        const Entry entry = queue[head];
        if (t_.stamp(entry.triangle) != entry.stamp) continue;
        if (const auto i = std::size_t(entry.triangle); i < latest.size() && gone + head < latest[i])
            continue;
        if (is_fine(entry.triangle)) continue;
        // Where points have no foot, at poles and kinks, and need none.
        if (const Known& k = known(entry.triangle); !k.shifted && k.whole <= demands_.tolerance) {
            again.clear();
            if (make_plain(entry.triangle, again)) {
                latest.resize(std::size_t(t_.size()));
                for (const int i : again) {
                    latest[std::size_t(i)] = gone + queue.size();
                    queue.push_back({i, t_.stamp(i)});
                }
                continue;
            }
            // Smaller ones may have feet.
            if (is_stuck() && k.whole > kLittleError * demands_.tolerance &&
                t_.points().size() < max_points && improve(entry.triangle)) {
                stuck_at_.clear();
                queue_changed();
                continue;
            }
            if (is_stuck()) {  // where else?
                for (std::size_t i = head + 1; i < queue.size(); ++i)
                    if (const int t = queue[i].triangle; t_.stamp(t) == queue[i].stamp)
                        if (const Known& other = known(t); !(other.bound <= demands_.tolerance) &&
                                                           !other.shifted &&
                                                           other.whole <= demands_.tolerance)
                            note_kept(t);
                return false;
            }
        }
        if (note_sliver(entry.triangle, slivers)) continue;
        if (t_.points().size() >= max_points) {
            is_full = true;
            break;
        }
        if (!improve(entry.triangle)) continue;  // its bound stands, and the caller will see it
        queue_changed();
        if (head > 4096 && head > queue.size() / 2) {
            queue.erase(queue.begin(), queue.begin() + std::ptrdiff_t(head) + 1);
            judged -= std::min(judged, head + 1);
            gone += head + 1;
            head = std::size_t(-1);
        }
    }
    stuck_at_ = slivers;
    return slivers.empty() && !is_full;
}

}  // namespace freiform

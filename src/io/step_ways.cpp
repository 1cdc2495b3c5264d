// On a lattice over the strip. A node is as free as outlines are far; a hop between neighbours is free if the
// discs around both overlap. The way with the fewest free hops, found breadth first, is pulled straight as
// far as nothing is across. A lattice too coarse for any way is made finer.
#include "step_ways.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

constexpr int kCoarsest = 16, kFinest = 512;  // nodes in each direction
constexpr double kReach = 2.5;                // of corners, and how far distances matter; in cells, as all
constexpr double kOverlap = 0.25;             // of discs
constexpr double kApartOnWay = 0.25;          // of straight parts from outlines
constexpr double kFarthest = 1e6;             // of x and y: others are no parameters of faces
constexpr std::size_t kMostSegments = 100000;
constexpr double kMostCells = 3e7;                       // that outlines are near to
constexpr double kSameOnWay = 1e-7;                      // of corners
constexpr std::array<double, 2> kBesideWay{0.37, 0.41};  // of nodes, so that they are on no outline

using Segment = std::array<Vec<2>, 2>;

double distance(const Vec<2>& p, const Segment& s) {
    const Vec<2> along = s[1] - s[0];
    const double t = dot(p - s[0], along) / dot(along, along);
    return norm(p - (s[0] + (t > 0 ? std::min(t, 1.0) : 0.0) * along));
}

// 0 if they cross.
double distance(const Segment& x, const Segment& y) {
    const auto side = [](const Segment& s, const Vec<2>& p) { return cross(s[1] - s[0], p - s[0]); };
    if (side(x, y[0]) * side(x, y[1]) < 0 && side(y, x[0]) * side(y, x[1]) < 0) return 0;
    return std::min({distance(x[0], y), distance(x[1], y), distance(y[0], x), distance(y[1], x)});
}

class Lattice {
public:
    Lattice(const Strip& strip, int n)
        : strip_(strip), n_(n), free_(std::size_t(n) * std::size_t(n), kReach) {
        for (const Segment& s : strip.outlines)
            for (int period = -1; period <= 1; ++period) {
                const Vec<2> by{{period - std::floor(s[0][0]), 0}};
                add({double(n) * (s[0] + by), double(n) * (s[1] + by)});
            }
    }

    std::optional<Way> find() const {
        struct Known {
            Vec<2> at{};
            int from = 0;  // a node, or -1 - a corner
        };
        std::vector<std::optional<Known>> known(free_.size());
        std::vector<std::size_t> todo;
        const auto come = [&](std::size_t node, const Vec<2>& at, int from) {
            if (known[node]) return;
            known[node] = {at, from};
            todo.push_back(node);
        };
        for (std::size_t c = 0; c < strip_.from.size(); ++c) {
            const Vec<2> corner = double(n_) * strip_.from[c];
            each_near(corner, [&](std::size_t node, const Vec<2>& at) {
                if (!known[node] && can_leave(corner, at)) come(node, at, -1 - int(c));
            });
        }
        for (std::size_t next = 0; next < todo.size(); ++next) {
            const std::size_t node = todo[next];
            const Known here = *known[node];
            Way way;
            if (arrives(here.at, way)) {
                std::vector<Vec<2>> points{way.end, here.at};
                int from = here.from;
                for (; from >= 0; from = known[std::size_t(from)]->from)
                    points.push_back(known[std::size_t(from)]->at);
                way.from = std::size_t(-1 - from);
                points.push_back(double(n_) * strip_.from[way.from]);
                std::ranges::reverse(points);
                straighten(points);
                for (std::size_t i = 1; i + 1 < points.size(); ++i)
                    way.inner.push_back((1.0 / n_) * points[i]);
                way.end = (1.0 / n_) * points.back();
                return way;
            }
            const int i = int(node) / n_, k = int(node) % n_;
            for (int di = -1; di <= 1; ++di)
                for (int dk = -1; dk <= 1; ++dk) {
                    if (k + dk < 0 || k + dk >= n_) continue;
                    const std::size_t to = number(i + di, k + dk);
                    const Vec<2> hop{{double(di), double(dk)}};
                    if (free_[node] + free_[to] > norm(hop) + kOverlap) come(to, here.at + hop, int(node));
                }
        }
        return std::nullopt;
    }

private:
    std::size_t number(int i, int k) const {
        return std::size_t((i % n_ + n_) % n_) * std::size_t(n_) + std::size_t(k);
    }
    static Vec<2> place(int i, int k) { return {{i + kBesideWay[0], k + kBesideWay[1]}}; }

    void add(const Segment& s) {
        outlines_.push_back(s);
        const auto within = [&](double x) { return int(std::clamp(x, 0.0, double(n_))); };
        const auto first = [&](double x) { return within(std::floor(x - kReach)); };
        const auto end = [&](double x) { return within(std::ceil(x + kReach)); };
        const auto [left, right] = std::minmax({s[0][0], s[1][0]});
        const auto [low, high] = std::minmax({s[0][1], s[1][1]});
        for (int i = first(left); i < end(right); ++i)
            for (int k = first(low); k < end(high); ++k) {
                double& free = free_[number(i, k)];
                free = std::min(free, distance(place(i, k), s));
            }
    }

    template <class F>
    void each_near(const Vec<2>& p, F visit) const {
        const auto least = [](double x) { return int(std::floor(x - kReach)); };
        for (int i = least(p[0]); i <= p[0] + kReach; ++i)
            for (int k = std::max(least(p[1]), 0); k <= p[1] + kReach && k < n_; ++k)
                if (const Vec<2> at = place(i, k); norm(at - p) <= kReach) visit(number(i, k), at);
    }

    // Of the outlines near the straight line from p to q, in the period of p.
    template <class F>
    bool none_along(const Vec<2>& p, const Vec<2>& q, F is_across) const {
        const Vec<2> by{{std::floor(p[0] / n_) * n_, 0}};
        const auto is_apart = [&](const Segment& s, int k) {
            const auto [lo, hi] = std::minmax({p[k] - by[k], q[k] - by[k]});
            return (s[0][k] < lo - kApartOnWay && s[1][k] < lo - kApartOnWay) ||
                   (s[0][k] > hi + kApartOnWay && s[1][k] > hi + kApartOnWay);
        };
        return std::ranges::none_of(outlines_, [&](const Segment& s) {
            return !is_apart(s, 0) && !is_apart(s, 1) && is_across(Segment{s[0] + by, s[1] + by});
        });
    }
    bool is_free(const Vec<2>& a, const Vec<2>& b) const {
        return std::abs(a[0] - b[0]) < n_ && none_along(a, b, [&](const Segment& s) {
                   return distance(Segment{a, b}, s) < kApartOnWay;
               });
    }
    // From a corner, where outlines meet.
    bool can_leave(const Vec<2>& corner, const Vec<2>& to) const {
        const Vec<2> middle = 0.5 * (corner + to);
        return std::abs(corner[0] - to[0]) < n_ && none_along(corner, to, [&](const Segment& s) {
                   const bool meets =
                       norm(s[0] - corner) <= kSameOnWay * n_ || norm(s[1] - corner) <= kSameOnWay * n_;
                   return distance(Segment{middle, to}, s) < (meets ? 0.5 * kApartOnWay : kApartOnWay) ||
                          (!meets && distance(Segment{corner, to}, s) <= kSameOnWay * n_);
               });
    }

    bool arrives(const Vec<2>& at, Way& way) const {
        if (strip_.pole) {
            way.end = {{at[0], n_ * *strip_.pole}};
            return norm(way.end - at) <= kReach && is_free(at, way.end);
        }
        for (way.to = 0; way.to < strip_.to.size(); ++way.to) {
            way.end = double(n_) * strip_.to[way.to];
            way.end[0] += std::round((at[0] - way.end[0]) / n_) * n_;
            if (norm(way.end - at) <= kReach && can_leave(way.end, at)) return true;
        }
        return false;
    }

    void straighten(std::vector<Vec<2>>& way) const {
        std::vector<Vec<2>> out{way.front()};
        const std::size_t end = way.size() - 1;
        for (std::size_t i = 0; i < end;) {
            std::size_t next = i + 1;
            for (std::size_t by = 2; next < end; by *= 2) {  // twice as far each time
                const std::size_t k = std::min(i + by, end);
                if (i == 0 && k == end) break;
                const bool at_corner = k == end && !strip_.pole;
                const Vec<2> to{{k == end && strip_.pole ? way[i][0] : way[k][0], way[k][1]}};
                if (!(i == 0      ? can_leave(way[i], to)
                      : at_corner ? can_leave(to, way[i])
                                  : is_free(way[i], to)))
                    break;
                next = k, way[k] = to;
            }
            out.push_back(way[i = next]);
        }
        way = std::move(out);
    }

    const Strip& strip_;
    int n_;
    std::vector<Segment> outlines_;
    std::vector<double> free_;
};

}  // namespace

std::optional<Way> find_way(const Strip& strip) {
    const auto is_near = [](const Vec<2>& p) { return max_abs(p) < kFarthest; };
    if (strip.outlines.size() > kMostSegments || !std::ranges::all_of(strip.from, is_near) ||
        !std::ranges::all_of(strip.to, is_near) ||
        !std::ranges::all_of(strip.outlines,
                             [&](const Segment& s) { return is_near(s[0]) && is_near(s[1]); }))
        return std::nullopt;
    for (int n = kCoarsest; n <= kFinest; n *= 2) {
        double cells = 0;
        const auto along = [&](double d) { return n * std::min(std::abs(d), 1.0) + 2 * kReach + 2; };
        for (const auto& [a, b] : strip.outlines) cells += 3 * along(a[0] - b[0]) * along(a[1] - b[1]);
        if (cells > kMostCells) break;
        if (auto way = Lattice(strip, n).find()) return way;
    }
    return std::nullopt;
}

}  // namespace freiform::step

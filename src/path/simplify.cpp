// Fewer cubics for a path.
//
// Method. From each point where a segment begins, the run of following segments that one cubic can replace is
// made longer: 2, 4, 8, .. of them, then the longest by halving between the last that went and the first that
// did not. For a run: places at equal shares of each segment; the two lengths along the end tangents by least
// squares, then parameters by Newton steps towards the nearest points, and so again [Schneider 1990].
//
// Accuracy. A cubic is taken only with a proof: each segment of the run is compared with the part of the
// cubic between the parameters nearest to its ends. Both are written over the same parameter, so control
// points of the difference bound their distance (path_detail.hpp), rounding included; where that is too much,
// both are halved, the cubic at the point nearest to the middle of the segment, as often as kDeepest.
// Parameters never run backwards, so it is a bound of the Frechet distance.
//
// Cost. Of n segments about n log(longest run) fits of 8 places for each segment.
//
// Why not all the optimal break points? They are found by trying all pairs: n^2 fits for a few cubics less.
//
// References: [Schneider 1990].
#include "path_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/path/simplify.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using Cubic = std::array<Vec<2>, 4>;
using HomogeneousPiece = std::vector<Hom<2>>;

constexpr int kDeepest = 7;            // halvings in a proof
constexpr int kPlaces = 8;             // of each segment
constexpr int kMostRounds = 24;        // of least squares
constexpr std::size_t kMostRun = 256;  // segments for one cubic

Vec<2> on_cubic(const Cubic& c, double t) {
    const double s = 1 - t;
    return s * s * s * c[0] + 3 * s * s * t * c[1] + 3 * s * t * t * c[2] + t * t * t * c[3];
}
Vec<2> cubic_derivative(const Cubic& c, double t) {
    const double s = 1 - t;
    return 3.0 * (s * s * (c[1] - c[0]) + 2 * s * t * (c[2] - c[1]) + t * t * (c[3] - c[2]));
}
Cubic part_of_cubic(Cubic c, double a, double b) {
    keep_left(Fibre<Vec<2>>{c.data(), 4, 1}, b);
    if (b > 0) keep_right(Fibre<Vec<2>>{c.data(), 4, 1}, std::min(1.0, a / b));
    return c;
}

HomogeneousPiece piece_of(const PathSegment& s) {
    HomogeneousPiece p;
    for (int i = 0; i <= s.degree; ++i)
        p.push_back(weighted(s.points[std::size_t(i)], s.degree == 2 && i == 1 ? s.weight : 1.0));
    return p;
}
Vec<2> on_piece(HomogeneousPiece p, double t) {
    keep_left(Fibre<Hom<2>>{p.data(), int(p.size()), 1}, t);
    return project(p.back());
}

// Of length 1, into the segment at its begin, out of it at its end; zero where all of it is one point.
Vec<2> direction_at(const PathSegment& s, bool at_end) {
    const auto n = std::size_t(s.degree);
    for (std::size_t i = 1; i <= n; ++i) {
        const Vec<2> d = at_end ? s.points[n] - s.points[n - i] : s.points[i] - s.points[0];
        if (max_abs(d) > 0) return unit(d);
    }
    return {};
}

// Of the segment over [0, 1].
double speed_at(const PathSegment& s, bool at_end) {
    const auto n = std::size_t(s.degree);
    return double(n) * (n == 2 ? s.weight : 1.0) *
           norm(at_end ? s.points[n] - s.points[n - 1] : s.points[1] - s.points[0]);
}

// The parameter in [lo, 1] near `guess` at which the cubic is nearest to p: Newton's method, an estimate.
double nearest_on_cubic(const Cubic& c, const Vec<2>& p, double guess, double lo) {
    double t = std::clamp(guess, lo, 1.0);
    for (int i = 0; i < 8; ++i) {
        const Vec<2> d = cubic_derivative(c, t), off = on_cubic(c, t) - p;
        const double speed = dot(d, d);
        if (!(speed > 0)) break;
        t = std::clamp(t - dot(off, d) / speed, lo, 1.0);
    }
    return t;
}

class Simplifier {
public:
    explicit Simplifier(const SimplifyOptions& options) : options_(options) {}

    Subpath run(const Subpath& in) {
        Subpath out{in.start, {}, in.closed};
        const std::vector<PathSegment>& all = in.segments;
        for (std::size_t i = 0; i < all.size();) {
            std::size_t most = i + 1;
            while (most < all.size() && most - i < kMostRun && goes_on(all[most - 1], all[most])) ++most;
            i = longest(all, i, most, out);
        }
        return out;
    }
    double bound() const { return bound_; }

private:
    bool goes_on(const PathSegment& a, const PathSegment& b) const {
        const Vec<2> d = direction_at(a, true), e = direction_at(b, false);
        return max_abs(d) > 0 && max_abs(e) > 0 &&
               std::atan2(std::abs(cross(d, e)), dot(d, e)) <= options_.corner;
    }

    // Appends one segment for those from i up to what is returned.
    std::size_t longest(const std::vector<PathSegment>& all, std::size_t i, std::size_t most, Subpath& out) {
        std::size_t good = i + 1, bad = most + 1;
        PathSegment best = all[i];
        double best_bound = 0;
        for (std::size_t step = 1; good < bad - 1;) {
            const std::size_t next = std::min({i + 2 * step, bad - 1, most});
            if (next <= good) break;
            if (const auto fit = replaced(all, i, next)) {
                good = next, best = fit->first, best_bound = fit->second, step *= 2;
                if (next == most) break;
            } else {
                bad = next;
                break;
            }
        }
        while (bad <= most && good + 1 < bad) {
            const std::size_t middle = good + (bad - good) / 2;
            if (const auto fit = replaced(all, i, middle))
                good = middle, best = fit->first, best_bound = fit->second;
            else
                bad = middle;
        }
        bound_ = std::max(bound_, best_bound);
        out.segments.push_back(best);
        return good;
    }

    // The direction at the begin of segment i: of two that meet there without a corner the mean. Where lines
    // begin or end at a corner they are taken for chords of a curve, if they are about equally long.
    Vec<2> direction_before(const std::vector<PathSegment>& all, std::size_t i) const {
        const bool starts = i < all.size() && (i == 0 || !goes_on(all[i - 1], all[i])),
                   ends = i > 0 && (i == all.size() || starts);
        if (!starts && !ends) return unit(direction_at(all[i - 1], true) + direction_at(all[i], false));
        return {};
    }
    Vec<2> at_corner(const PathSegment& s, const PathSegment* next, bool at_end) const {
        const Vec<2> d = direction_at(s, at_end);
        if (!next || s.degree != 1 || next->degree != 1 || !(at_end ? goes_on(*next, s) : goes_on(s, *next)))
            return d;
        const double a = norm(s.back() - s.front()), b = norm(next->back() - next->front());
        if (!(a < 2 * b && b < 2 * a)) return d;
        const Vec<2> e = direction_at(*next, at_end);
        const double turn = std::atan2(cross(e, d), dot(e, d)) / 2;
        return {
            {d[0] * std::cos(turn) - d[1] * std::sin(turn), d[0] * std::sin(turn) + d[1] * std::cos(turn)}};
    }

    // One segment for those from i up to `end`.
    std::optional<std::pair<PathSegment, double>> replaced(const std::vector<PathSegment>& all, std::size_t i,
                                                           std::size_t end) const {
        const std::span<const PathSegment> run = std::span(all).subspan(i, end - i);
        // Parameters so that the speed does not jump between segments: those of a cubic that was cut are met
        // at once.
        std::vector<Vec<2>> places;
        std::vector<double> at = {0};
        double share = 1, length = 0;
        for (std::size_t m = 0; m < run.size(); ++m) {
            const HomogeneousPiece p = piece_of(run[m]);
            if (m > 0) {
                const double ratio = speed_at(run[m], false) / speed_at(run[m - 1], true);
                share *= ratio > 0.01 && ratio < 100 ? ratio : 1;
            }
            for (int k = places.empty() ? 0 : 1; k <= kPlaces; ++k) {
                places.push_back(on_piece(p, double(k) / kPlaces));
                if (places.size() == 1) continue;
                at.push_back(at.back() + share);
                length += norm(places.back() - places[places.size() - 2]);
            }
        }
        if (!(length > 0)) return std::nullopt;
        const double all_of_it = at.back();
        for (double& t : at) t /= all_of_it;
        Vec<2> first = direction_before(all, i), last = direction_before(all, end);
        if (!(max_abs(first) > 0)) first = at_corner(run[0], &run[1], false);
        if (!(max_abs(last) > 0)) last = at_corner(run.back(), &run[run.size() - 2], true);
        // A line, where all are lines in one direction.
        const bool lines = std::ranges::all_of(run, [](const PathSegment& s) { return s.degree == 1; });
        if (lines) {
            const PathSegment line{1, {run.front().front(), run.back().back()}, 1};
            const Vec<2> d = line.back() - line.front();
            const Cubic raised = {line.front(), line.front() + (1.0 / 3) * d, line.front() + (2.0 / 3) * d,
                                  line.back()};
            if (const auto bound = proven(run, raised, at)) return std::pair(line, *bound);
        }
        Cubic c = fitted(places, at, first, last, length);
        double before = kInfinity;
        for (int round = 0; round < kMostRounds; ++round) {
            double worst = 0;
            for (std::size_t k = 1; k + 1 < places.size(); ++k) {
                at[k] = nearest_on_cubic(c, places[k], at[k], 0);
                worst = std::max(worst, norm(on_cubic(c, at[k]) - places[k]));
            }
            if (worst <= 0.9 * options_.tolerance) break;
            // It will not come that near.
            if (worst > before || worst > (1 + 4 * (kMostRounds - round)) * options_.tolerance)
                return std::nullopt;
            before = worst;
            c = fitted(places, at, first, last, length);
        }
        if (const auto bound = proven(run, c, at)) return std::pair(PathSegment{3, c, 1}, *bound);
        return std::nullopt;
    }

    // The lengths a, b of P + a first, Q - b last by least squares; a third of the length where that fails.
    static Cubic fitted(std::span<const Vec<2>> places, std::span<const double> at, const Vec<2>& first,
                        const Vec<2>& last, double length) {
        const Vec<2> p = places.front(), q = places.back();
        double m00 = 0, m01 = 0, m11 = 0, r0 = 0, r1 = 0;
        for (std::size_t k = 1; k + 1 < places.size(); ++k) {
            const double t = at[k], s = 1 - t;
            const double b0 = s * s * s, b1 = 3 * s * s * t, b2 = 3 * s * t * t, b3 = t * t * t;
            const Vec<2> u = b1 * first, v = -b2 * last, rest = places[k] - ((b0 + b1) * p + (b2 + b3) * q);
            m00 += dot(u, u), m01 += dot(u, v), m11 += dot(v, v), r0 += dot(u, rest), r1 += dot(v, rest);
        }
        const double det = m00 * m11 - m01 * m01;
        double a = (r0 * m11 - r1 * m01) / det, b = (r1 * m00 - r0 * m01) / det;
        if (!(a > 1e-6 * length && b > 1e-6 * length && a < 3 * length && b < 3 * length)) a = b = length / 3;
        return {p, p + a * first, q - b * last, q};
    }

    // Within the tolerance of the run?
    std::optional<double> proven(std::span<const PathSegment> run, const Cubic& c,
                                 std::span<const double> at) const {
        double from = 0, most = 0;
        for (std::size_t i = 0; i < run.size(); ++i) {
            const std::size_t k = (i + 1) * kPlaces;
            const double to = i + 1 == run.size() ? 1 : nearest_on_cubic(c, run[i].back(), at[k], from);
            const auto bound = proven(piece_of(run[i]), c, from, to, kDeepest);
            if (!bound) return std::nullopt;
            most = std::max(most, *bound);
            from = to;
        }
        return most;
    }
    std::optional<double> proven(HomogeneousPiece p, const Cubic& c, double from, double to,
                                 int deeper) const {
        const double bound = detail::distance_bound(p, part_of_cubic(c, from, to)) + rounding(c, p);
        if (bound <= options_.tolerance) return bound;
        if (deeper == 0) return std::nullopt;
        HomogeneousPiece left = p;
        keep_left(Fibre<Hom<2>>{left.data(), int(left.size()), 1}, 0.5);
        keep_right(Fibre<Hom<2>>{p.data(), int(p.size()), 1}, 0.5);
        const Vec<2> middle = project(left.back());
        const double at = std::min(to, nearest_on_cubic(c, middle, from / 2 + to / 2, from));
        if (norm(on_cubic(c, at) - middle) > options_.tolerance) return std::nullopt;
        const auto low = proven(std::move(left), c, from, at, deeper - 1);
        if (!low) return std::nullopt;
        const auto high = proven(std::move(p), c, at, to, deeper - 1);
        return high ? std::optional(std::max(*low, *high)) : std::nullopt;
    }
    // Of parts of the cubic and of halves of the segment: kDeepest + 2 cuts at 9 u each and their parameters,
    // in two coordinates, over weights that are at least 1/2 once a segment was cut: less than 300 u of the
    // largest number.
    static double rounding(const Cubic& c, const HomogeneousPiece& p) {
        double size = 0;
        for (const Vec<2>& x : c) size = std::max(size, max_abs(x));
        for (const Hom<2>& h : p) size = std::max({size, std::abs(h[0]), std::abs(h[1])});
        return 512 * kUnitRoundoff * size;
    }

    SimplifyOptions options_;
    double bound_ = 0;
};

}  // namespace

Result<SimplifiedPath> simplified(const Path& path, const SimplifyOptions& options) {
    if (!(options.tolerance > 0))
        return refuse(RefusalKind::invalid, "tolerance", "a positive number is expected");
    SimplifiedPath out;
    Simplifier simplifier(options);
    for (std::size_t i = 0; i < path.subpaths.size(); ++i) {
        const Subpath& s = path.subpaths[i];
        for (std::size_t k = 0; k < s.segments.size(); ++k)
            for (int j = 0; j <= s.segments[k].degree; ++j)
                if (!is_finite(s.segments[k].points[std::size_t(j)]) || !std::isfinite(s.segments[k].weight))
                    return refuse(RefusalKind::nonfinite, text("subpaths[", i, "].segments[", k, "]"),
                                  "numbers are expected");
        out.before += s.segments.size();
        out.path.subpaths.push_back(simplifier.run(s));
        out.after += out.path.subpaths.back().segments.size();
    }
    out.bound = simplifier.bound();
    return out;
}

}  // namespace freiform

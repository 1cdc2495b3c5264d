// Pairs of plane cubic splines, their true intersections by the plain method, and what an answer is worth.
//
// The plain method: halve what overlaps by boxes until it is small, then Newton's method, and drop what is
// found twice. It proves nothing, but on these pairs, which cross at angles, all others that are right agree
// with it. Lines of the answer:
//     task seconds_per_pair roots missed invented doubled
#pragma once
#include "curve_tasks.hpp"
#include "evaluation_inputs.hpp"

namespace freiform::bench {

struct PlaneSpline {
    std::vector<double> knots;
    std::vector<std::array<double, 2>> points;
};
struct PlanePiece {
    std::array<std::array<double, 2>, 4> b;
    double lo = 0, hi = 1;
};
using Meeting = std::array<double, 2>;
struct PlanePair {
    std::array<PlaneSpline, 2> curve;
    std::array<std::vector<PlanePiece>, 2> pieces;
    std::vector<Meeting> truth;
};

inline PlaneSpline random_spline(int n, Sequence& random) {
    PlaneSpline s{uneven_knots(n, random), {}};
    for (int i = 0; i < n; ++i) {
        const double x = random.next();
        s.points.push_back({x, random.next()});
    }
    return s;
}

// Control points of the pieces, as values of the blossom at (lo, .., hi, ..).
inline std::vector<PlanePiece> pieces_of(const PlaneSpline& s) {
    std::vector<PlanePiece> out;
    for (std::size_t k = 3; k < s.points.size(); ++k) {
        PlanePiece p;
        p.lo = s.knots[k], p.hi = s.knots[k + 1];
        for (std::size_t j = 0; j < 4; ++j) {
            std::array<std::array<double, 2>, 4> d;
            for (std::size_t i = 0; i < 4; ++i) d[i] = s.points[k - 3 + i];
            for (std::size_t level = 1; level <= 3; ++level)
                for (std::size_t i = 3; i >= level; --i) {
                    const double t = level <= j ? p.hi : p.lo;
                    const double from = s.knots[k - 3 + i], to = s.knots[k + 1 + i - level];
                    const double a = (t - from) / (to - from);
                    for (std::size_t c = 0; c < 2; ++c) d[i][c] = (1 - a) * d[i - 1][c] + a * d[i][c];
                }
            p.b[j] = d[3];
        }
        out.push_back(p);
    }
    return out;
}

class PlainSearch {
public:
    explicit PlainSearch(const PlanePair& pair) : pair_(pair) {}
    std::vector<Meeting> run() {
        for (const PlanePiece& a : pair_.pieces[0])
            for (const PlanePiece& b : pair_.pieces[1]) look(a, b, 0);
        return std::move(found_);
    }

private:
    static double spread(const PlanePiece& p, std::size_t c, double& lo, double& hi) {
        lo = std::min(std::min(p.b[0][c], p.b[1][c]), std::min(p.b[2][c], p.b[3][c]));
        hi = std::max(std::max(p.b[0][c], p.b[1][c]), std::max(p.b[2][c], p.b[3][c]));
        return hi - lo;
    }
    static void halve(const PlanePiece& p, PlanePiece& left, PlanePiece& right) {
        for (std::size_t c = 0; c < 2; ++c) {
            const double a = (p.b[0][c] + p.b[1][c]) / 2, b = (p.b[1][c] + p.b[2][c]) / 2,
                         d = (p.b[2][c] + p.b[3][c]) / 2;
            const double e = (a + b) / 2, f = (b + d) / 2, m = (e + f) / 2;
            left.b[0][c] = p.b[0][c], left.b[1][c] = a, left.b[2][c] = e, left.b[3][c] = m;
            right.b[0][c] = m, right.b[1][c] = f, right.b[2][c] = d, right.b[3][c] = p.b[3][c];
        }
        left.lo = p.lo, right.hi = p.hi;
        left.hi = right.lo = (p.lo + p.hi) / 2;
    }
    void look(const PlanePiece& a, const PlanePiece& b, int depth) {
        double size_a = 0, size_b = 0;
        for (std::size_t c = 0; c < 2; ++c) {
            double lo, hi, from, to;
            size_a = std::max(size_a, spread(a, c, lo, hi));
            size_b = std::max(size_b, spread(b, c, from, to));
            if (hi < from - 1e-14 || to < lo - 1e-14) return;
        }
        if ((size_a < 2e-5 && size_b < 2e-5) || depth > 60) {
            refine((a.lo + a.hi) / 2, (b.lo + b.hi) / 2);
            return;
        }
        PlanePiece left, right;
        halve(size_a >= size_b ? a : b, left, right);
        for (const PlanePiece* half : {&left, &right})
            size_a >= size_b ? look(*half, b, depth + 1) : look(a, *half, depth + 1);
    }
    // Value and derivative.
    std::array<double, 4> at(std::size_t which, double t) const {
        const auto& all = pair_.pieces[which];
        const auto after = std::upper_bound(all.begin(), all.end(), t,
                                            [](double x, const PlanePiece& p) { return x < p.lo; });
        const PlanePiece& p = after == all.begin() ? all.front() : *(after - 1);
        const double x = (t - p.lo) / (p.hi - p.lo), y = 1 - x;
        std::array<double, 4> out;
        for (std::size_t c = 0; c < 2; ++c) {
            const double d = y * p.b[0][c] + x * p.b[1][c], e = y * p.b[1][c] + x * p.b[2][c],
                         f = y * p.b[2][c] + x * p.b[3][c], g = y * d + x * e, h = y * e + x * f;
            out[c] = y * g + x * h;
            out[2 + c] = 3 * (h - g) / (p.hi - p.lo);
        }
        return out;
    }
    void refine(double s, double t) {
        for (int i = 0; i < 40; ++i) {
            const auto p = at(0, s), q = at(1, t);
            const double x = p[0] - q[0], y = p[1] - q[1], det = p[3] * q[2] - p[2] * q[3];
            if (det == 0) return;
            const double ds = (x * q[3] - y * q[2]) / det, dt = (x * p[3] - y * p[2]) / det;
            s += ds, t += dt;
            const double step = std::abs(ds) + std::abs(dt);
            if (!(step <= 0.2)) return;
            if (step < 1e-15) break;
        }
        if (s < -1e-13 || s > 1 + 1e-13 || t < -1e-13 || t > 1 + 1e-13) return;
        s = std::clamp(s, 0.0, 1.0), t = std::clamp(t, 0.0, 1.0);
        const auto p = at(0, s), q = at(1, t);
        if (std::hypot(p[0] - q[0], p[1] - q[1]) > 1e-11) return;
        for (const Meeting& m : found_)
            if (std::abs(m[0] - s) < 1e-8 && std::abs(m[1] - t) < 1e-8) return;
        found_.push_back({s, t});
    }

    const PlanePair& pair_;
    std::vector<Meeting> found_;
};

inline std::vector<PlanePair> plane_pairs(int count, int points, std::uint64_t seed) {
    Sequence random(seed);
    std::vector<PlanePair> all{std::size_t(count)};
    for (PlanePair& p : all) {
        for (std::size_t i = 0; i < 2; ++i)
            p.curve[i] = random_spline(points, random), p.pieces[i] = pieces_of(p.curve[i]);
        p.truth = PlainSearch(p).run();
    }
    return all;
}

struct Judged {
    long roots = 0, missed = 0, invented = 0, doubled = 0;
    void add(const std::vector<Meeting>& truth, const std::vector<Meeting>& found) {
        std::vector<int> hits(truth.size(), 0);
        roots += long(truth.size());
        for (const Meeting& f : found) {
            std::size_t best = truth.size();
            double least = 1e-4;
            for (std::size_t i = 0; i < truth.size(); ++i) {
                const double d = std::max(std::abs(f[0] - truth[i][0]), std::abs(f[1] - truth[i][1]));
                if (d < least) least = d, best = i;
            }
            if (best == truth.size())
                ++invented;
            else if (hits[best]++ > 0)
                ++doubled;
        }
        missed += long(std::count(hits.begin(), hits.end(), 0));
    }
};

struct IntersectTask {
    const char* name;
    int count, points;
    std::uint64_t seed;
};
inline constexpr IntersectTask kIntersectTasks[] = {{"cubics", 1000, 4, 7001}, {"splines", 50, 30, 7002}};

inline void print_task(const char* task, const char* method, double seconds, const Judged& j) {
    std::printf("%s%s %.9g roots=%ld missed=%ld invented=%ld doubled=%ld\n", task, method, seconds, j.roots,
                j.missed, j.invented, j.doubled);
}

}  // namespace freiform::bench

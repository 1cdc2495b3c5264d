// Idea. Files often hold no parameter curves, and the reader then interpolates through two dozen points,
// which is off by up to 1e-4 of the length. The point of the surface nearest to c(t) is found by Newton's
// method from a good guess, and its derivative by the chain rule; a cubic that takes both at two parameters
// follows the exact parameter curve with an error of fourth order, so that halving pieces soon reaches
// rounding.
//
// Method. With J = (S_u, S_v) and r = c(t) - S: the step solves J^T J d = J^T r, which converges fast as r is
// small at the solution; the derivative solves J^T J w' = J^T c'.
#include "refit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace freiform::occt {

namespace {

constexpr int kMostPieces = 1000;  // backstop
constexpr double kDegenerate = 1e-10;

struct Node {
    double t = 0;
    Vec<2> at{}, slope{};
    double distance = 0;  // of the surface from the curve
};

// Solves J^T J d = J^T r. False where the directions of the parameters are all but parallel.
bool solve(const Vec<3>& su, const Vec<3>& sv, const Vec<3>& r, Vec<2>& d) {
    const double a = dot(su, su), b = dot(su, sv), c = dot(sv, sv), det = a * c - b * b;
    if (!(det > kDegenerate * a * c)) return false;
    const double p = dot(su, r), q = dot(sv, r);
    d = {{(c * p - b * q) / det, (a * q - b * p) / det}};
    return true;
}

// The nearest point that Newton's method finds; what is worth of it, the caller sees from the gaps.
bool foot(const SurfaceGeometry& s, const CurveGeometry<3>& c, double t, const Vec<2>& guess, Node& best) {
    const auto target = jet<1>(c, t);
    best.t = t;
    best.distance = std::numeric_limits<double>::infinity();
    Vec<2> at = guess;
    for (int i = 0; i < 20; ++i) {
        const auto j = jet<1>(s, at.c);
        const Vec<3> r = target.d[0] - j.d[0];
        const double distance = norm(r);
        Vec<2> slope, step;
        if (!std::isfinite(distance) || !solve(j.d[1], j.d[2], target.d[1], slope) ||
            !solve(j.d[1], j.d[2], r, step))
            break;
        const bool settled = !(distance < 0.999999 * best.distance);
        if (distance < best.distance) best.at = at, best.slope = slope, best.distance = distance;
        if (settled && i > 3) break;
        at = at + step;
    }
    return std::isfinite(best.distance);
}

Vec<2> hermite(const Node& a, const Node& b, double t) {
    const double h = b.t - a.t, x = (t - a.t) / h, y = 1 - x;
    return (y * y * (1 + 2 * x)) * a.at + (x * x * (1 + 2 * y)) * b.at + (h * x * y * y) * a.slope +
           (-h * x * x * y) * b.slope;
}

CurveGeometry<2> joined(const std::vector<Node>& nodes) {
    std::vector<double> knots(2, nodes.front().t);
    std::vector<Vec<2>> net;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& n = nodes[i];
        knots.insert(knots.end(), 2, n.t);
        net.push_back(i == 0 ? n.at : n.at - ((n.t - nodes[i - 1].t) / 3) * n.slope);
        net.push_back(i + 1 == nodes.size() ? n.at : n.at + ((nodes[i + 1].t - n.t) / 3) * n.slope);
    }
    knots.insert(knots.end(), 2, nodes.back().t);
    const int size = int(net.size());
    return Curve<Vec<2>>::trusted({*BSplineBasis::make(3, std::move(knots))},
                                  Net<1, Vec<2>>({size}, std::move(net)));
}

// The largest value found among samples, and between the neighbours of the largest of them.
template <class F>
double largest(const F& f, Interval on, int samples) {
    const auto at = [&](int i) { return on.lo + on.length() * i / samples; };
    double worst = 0;
    int place = 0;
    for (int i = 0; i <= samples; ++i)
        if (const double x = f(at(i)); x > worst) worst = x, place = i;
    const Interval near{at(std::max(place - 1, 0)), at(std::min(place + 1, samples))};
    for (int i = 1; i < 16; ++i) worst = std::max(worst, f(near.lo + near.length() * i / 16));
    return worst;
}

// Several in each piece of a spline.
int samples_for(const Edge& e, const CurveGeometry<2>& on_surface) {
    std::size_t pieces = 1;
    const auto count = [&](const auto& g) {
        if constexpr (requires { g.net(); }) pieces = std::max(pieces, g.net().flat().size());
    };
    if (e.curve) std::visit(count, *e.curve);
    std::visit(count, on_surface);
    return int(std::clamp<std::size_t>(6 * pieces, 48, 6000));
}

}  // namespace

std::optional<CurveGeometry<2>> refit(const SurfaceGeometry& s, const CurveGeometry<3>& c,
                                      const CurveGeometry<2>& guess, Interval on, double accuracy) {
    // Pieces begin where a spline is less smooth.
    std::vector<double> breaks;
    for (int i = 0; i <= 8; ++i) breaks.push_back(i == 8 ? on.hi : on.lo + on.length() * i / 8);
    std::visit(
        [&](const auto& g) {
            if constexpr (requires { g.net(); })
                for (double t : g.basis().breaks())
                    if (t > on.lo && t < on.hi) breaks.push_back(t);
        },
        c);
    std::sort(breaks.begin(), breaks.end());
    const double shortest = 1e-6 * on.length();
    std::vector<Node> todo, done;  // `todo` from the end to the beginning
    for (double t : breaks) {
        if (!todo.empty() && t - todo.back().t < shortest && t != on.hi) continue;
        if (!todo.empty() && t == on.hi && t - todo.back().t < shortest && todo.size() > 1) todo.pop_back();
        Node n;
        if (!foot(s, c, t, jet<0>(guess, t).value(), n)) return std::nullopt;
        todo.push_back(n);
    }
    std::reverse(todo.begin(), todo.end());
    done.push_back(todo.back());
    todo.pop_back();
    while (!todo.empty()) {
        const Node &a = done.back(), &b = todo.back();
        bool good = true;
        for (double x : {0.21, 0.5, 0.79}) {
            const double t = a.t + x * (b.t - a.t);
            const Vec<2> at = hermite(a, b, t);
            Node n;
            if (!foot(s, c, t, at, n)) return std::nullopt;
            const double gap = norm(jet<0>(s, at.c).value() - jet<0>(c, t).value());
            if (gap > 1.1 * n.distance + accuracy) good = false;
        }
        if (!good && b.t - a.t < 2 * shortest) return std::nullopt;
        if (good) {
            done.push_back(b);
            todo.pop_back();
        } else {
            Node middle;
            const double t = a.t + (b.t - a.t) / 2;
            if (!foot(s, c, t, hermite(a, b, t), middle)) return std::nullopt;
            todo.push_back(middle);
        }
        if (done.size() + todo.size() > kMostPieces) return std::nullopt;
    }
    return joined(done);
}

double sampled_gap(const SurfaceGeometry& s, const Edge& e, const Vec<3>& vertex,
                   const CurveGeometry<2>& on_surface) {
    if (!e.curve && !e.degenerate) return 0;
    const auto on = limits(s);
    const auto gap = [&](double t) {
        const Vec<3> on_face = jet<0>(s, clamped(jet<0>(on_surface, t).value(), on).c).value();
        return norm(on_face - (e.curve ? jet<0>(*e.curve, t).value() : vertex));
    };
    return largest(gap, e.range, samples_for(e, on_surface));
}

}  // namespace freiform::occt

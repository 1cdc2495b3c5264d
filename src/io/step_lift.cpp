// A cubic spline near t -> S(c(t)): points and slopes at its knots, which are the breaks of c and halves
// between them where the spline strays at three places. What it misses is then proven, not sampled, by
// edge_gap (model/edge_gap.hpp), which bounds the distance of a curve from the image of a parameter curve.
//
// Accuracy. A piece of length h is off by h^4 / 384 max|(S o c)''''|, so that pieces grow like target^-1/4.
// Where c has corners, so has the spline; where S has some inside of a piece, halving closes in on them.
//
// Why not the exact image (make/image_curve.hpp)? It has none on surfaces of revolution and offsets, and
// degrees up to 25 elsewhere.
#include "step_lift.hpp"

#include "step_trace.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/model/edge_gap.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

constexpr std::size_t kMostLiftPieces = 200;

class Lifter {
public:
    Lifter(const SurfaceGeometry& s, const CurveGeometry<2>& c, Interval on)
        : s_(s), c_(c), on_(on), limits_(limits(s)) {}

    Result<Curve<Vec<3>>> spline(double target) const {
        const std::vector<double> first = places();
        std::vector<Knot> todo, done;
        for (auto t = first.rbegin(); t != first.rend(); ++t) todo.push_back(knot(*t));
        done.push_back(todo.back());
        todo.pop_back();
        while (!todo.empty()) {
            const Knot a = done.back(), b = todo.back();
            const bool room = done.size() + todo.size() <= kMostLiftPieces &&
                              b.t - a.t > 1e-9 * (on_.length() + std::abs(a.t) + std::abs(b.t));
            if (room && !follows(a, b, target)) {
                todo.push_back(knot(a.t + (b.t - a.t) / 2));
                continue;
            }
            done.push_back(b);
            todo.pop_back();
        }
        return joined(done);
    }

private:
    struct Knot {
        double t = 0;
        Vec<3> at{}, before{}, after{};
    };

    Vec<3> point(double t) const { return jet<0>(s_, clamped(jet<0>(c_, t).value(), limits_).c).value(); }
    Vec<3> slope(double t) const {
        const auto j = jet<1>(c_, t);
        const auto k = jet<1>(s_, clamped(j.value(), limits_).c);
        return j(1)[0] * k(1, 0) + j(1)[1] * k(0, 1);
    }
    bool has_corner(double t) const {
        return visit_one(
            [&](const auto& g) {
                if constexpr (requires { g.net(); })
                    return on_.lo < t && t < on_.hi && g.basis().multiplicity(t) >= g.basis().degree();
                else
                    return false;
            },
            c_);
    }
    Knot knot(double t) const {
        Knot k{t, point(t), slope(t), {}};
        k.after = k.before;
        if (has_corner(t)) k.before = slope(std::nextafter(t, on_.lo));
        return k;
    }

    // The ends, the breaks, and a few between them.
    std::vector<double> places() const {
        std::vector<double> all = places_along(c_, on_, 4, kMostLiftPieces / 2);
        all.erase(std::ranges::unique(all).begin(), all.end());
        return all;
    }

    bool follows(const Knot& a, const Knot& b, double target) const {
        const double h = b.t - a.t;
        return std::ranges::all_of(std::array{0.21, 0.5, 0.79}, [&](double x) {
            const double y = 1 - x;
            const Vec<3> p = (y * y * (1 + 2 * x)) * a.at + (x * x * (1 + 2 * y)) * b.at +
                             (h * x * y * y) * a.after + (-h * x * x * y) * b.before;
            return norm(p - point(a.t + x * h)) <= target;
        });
    }

    Result<Curve<Vec<3>>> joined(const std::vector<Knot>& all) const {
        std::vector<double> t(2, on_.lo);
        std::vector<Vec<3>> net;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Knot& k = all[i];
            const bool last = i + 1 == all.size();
            t.insert(t.end(), 2, k.t);
            net.push_back(i == 0 ? k.at : k.at - ((k.t - all[i - 1].t) / 3) * k.before);
            if (i > 0 && !last && !(k.before == k.after)) t.push_back(k.t), net.push_back(k.at);
            net.push_back(last ? k.at : k.at + ((all[i + 1].t - k.t) / 3) * k.after);
        }
        t.insert(t.end(), 2, on_.hi);
        auto basis = BSplineBasis::make(3, std::move(t));
        if (!basis) return std::unexpected(basis.error());
        const int size = int(net.size());
        return Curve<Vec<3>>::make({std::move(*basis)}, Net<1, Vec<3>>({size}, std::move(net)));
    }

    const SurfaceGeometry& s_;
    const CurveGeometry<2>& c_;
    Interval on_;
    std::array<Interval, 2> limits_;
};

}  // namespace

Result<Lift> lift(const SurfaceGeometry& surface, const CurveGeometry<2>& c, Interval on, double target,
                  double most, int samples) {
    auto spline = Lifter(surface, c, on).spline(target);
    if (!spline) return std::unexpected(spline.error());
    EdgeGapOptions options;
    options.target = 2 * target;
    options.factor = 2;
    options.max_samples = samples;
    const EdgeGap gap = edge_gap(DerivativeQuery<2, 3>(surface), c, CurveGeometry<3>(*spline), on, options);
    if (!(gap.bound <= most))
        return refuse(RefusalKind::ill_conditioned, "curve",
                      text("is followed by no spline that is proven to be near: it jumps, turns on the spot, "
                           "or bends too often"));
    return Lift{std::move(*spline), gap.bound};
}

}  // namespace freiform::step

// Idea. On a plane the parameter curve is the edge in other coordinates. On every other surface the first
// guess is a straight line in the parameters: lines and circles on elementary surfaces are such, and
// isoparametric curves of splines. It is what the edge says at its middle, place and slope; if points on both
// sides of it agree, it is the answer. Else a cubic spline follows the edge: at each of its knots it has the
// parameters of the nearest point of the surface and their derivative, so that its error is of fourth order,
// and pieces are halved until their inner points agree.
//
// Where both fail, at poles and folds, it is a polygon of nearest points, if that is near enough.
//
// The middle, because the ends of an edge may be at a pole, where one parameter means nothing; there both
// curves are continued from inside.
#include "step_trace.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

constexpr int kMostPieces = 600;  // backstop
constexpr double kApart = 1e-6;   // of the range: places where pieces begin
// Of an edge: where its parameter curve begins, the first of them near enough to the surface. Near is so much
// of what is asked for, and so many times as far as the place before.
constexpr double kMiddles[] = {0.46875, 0.21875, 0.78125, 0.09375, 0.90625};
constexpr double kNear = 10, kFarther = 2;
constexpr double kNearer = 0.9;  // than the point that a path led to: one elsewhere
constexpr double kRougher = 10,
                 kLastDigits = 1e-2;  // of what is rough: the most of all, and what digits leave
constexpr double kOnSeam = 1e-9;      // of the period
constexpr double kPlacesOfLine[] = {0, 0.07, 0.23, 0.38, 0.62, 0.81, 0.94, 1};

int spans_of(const CurveGeometry<3>& c) {
    return visit_one(
        [](const auto& g) {
            if constexpr (requires { g.net(); })
                return std::min(2 * int(g.net().flat().size()), 400);
            else
                return 0;
        },
        c);
}

struct TraceNode {
    double t = 0;
    Vec<2> at{}, before{}, after{};  // the slopes on both sides: the edge may have a corner here
    double gap = 0;                  // how far from the edge it is on the surface
};

class Tracer {
public:
    Tracer(const Chart& chart, const CurveGeometry<3>& c, Interval on, double accuracy, double rough,
           std::span<const CurveGeometry<3>> images)
        : chart_(chart), c_(c), on_(on), accuracy_(accuracy), rough_(rough), images_(images) {}

    Result<Trace> run(bool to_poles) {
        if (auto flat = trace_on_plane(chart_.surface(), c_, on_)) return *flat;
        auto t = on_curved();
        if (t && chart_.has_pole_across(t->curve, on_)) t = through_pole();
        // Beside a pole what follows an edge well may run around the pole all the same.
        const bool follows = t && t->gap <= kNear * accuracy_;
        if (to_poles && (!follows || t->fitted))
            if (auto ended =
                    trace_up_to_poles(chart_, c_, on_, accuracy_, follows ? kLastDigits * rough_ : rough_))
                t = *std::move(ended);
        if (!(t && t->gap <= kNear * accuracy_))
            if (auto told = nearest_image(t ? t->gap : rough_)) return *told;
        if (!t)
            // Of spheres there are others, with other poles.
            if (auto feet = polygon_of_feet(chart_, c_, on_, kRougher * rough_);
                feet && !(chart_.is_sphere() && chart_.has_pole_across(feet->curve, on_)))
                return *feet;
        return t;
    }

private:
    static std::unexpected<Refusal> through_pole() {
        return refuse(RefusalKind::ill_conditioned, "parameter curve",
                      "runs through a pole or a fold of the surface");
    }
    Result<Trace> on_curved() {
        if (auto told = image()) return *told;
        if (auto side = along_side()) return *side;
        double middle = 0;
        Foot start;
        start.distance = kInfinity;
        for (const double x : kMiddles) {
            if (start.distance <= kNear * accuracy_) break;
            const double t = on_.lo + x * on_.length();
            const auto j = jet<1>(c_, t);
            const Foot f = foot_by_images(chart_, j.d[0], j.d[1], t, on_, accuracy_, images_);
            if (f.regular && f.distance < start.distance) start = f, middle = t;
        }
        if (!start.regular) return through_pole();
        if (auto straight = line(start, middle)) return *straight;
        return spline(start, middle);
    }

    // An image that has the parameter of the edge is the answer, if it is as near to the edge everywhere as
    // others have to be; one with another parameter says where to begin.
    std::optional<Trace> image() {
        if (!chart_.is_spline(0) || !chart_.is_spline(1)) return std::nullopt;
        for (const CurveGeometry<3>& c : images_) {
            if (!begins_and_ends_with(c, on_)) continue;
            const auto flat = without_last_coordinate(c);
            if (!flat) continue;
            Trace out{*flat, 0, false, true};
            if (holds_everywhere(out, std::max(spans_of(c_), spans_of(c)))) return out;
        }
        return std::nullopt;
    }

    // The image that is nearest to the edge at the places where others are tested, if it is nearer than that:
    // beside bends that are sharp another point than the one that belongs there may be as near.
    std::optional<Trace> nearest_image(double limit) const {
        std::optional<Trace> best;
        if (!chart_.is_spline(0) || !chart_.is_spline(1)) return best;
        for (const CurveGeometry<3>& given : images_) {
            const auto c = image_over(given, on_);
            const auto flat = c ? without_last_coordinate(*c) : std::nullopt;
            if (!flat || chart_.has_pole_across(*flat, on_)) continue;
            Trace out{*flat, 0, false, true};
            const auto is_nearer = [&](double t) {
                out.gap = std::max(out.gap, gap_at(jet<0>(*flat, t).value(), t));
                return out.gap < limit;
            };
            if (at_all_places(std::max(spans_of(c_), spans_of(*c)), is_nearer))
                limit = out.gap, best = std::move(out);
        }
        return best;
    }

    std::optional<Trace> along_side() const {
        for (const Line<2>& line : lines_along_sides(chart_, c_, on_, accuracy_))
            if (Trace out{line}; holds_everywhere(out, spans_of(c_)) && out.gap <= accuracy_) return out;
        return std::nullopt;
    }

    double gap_at(const Vec<2>& uv, double t) const { return norm(chart_.point(uv) - jet<0>(c_, t).value()); }

    // An end of the straight line: where the edge itself says it, rather than continued from the middle.
    Vec<2> end(double t, const Vec<2>& guess) const {
        const auto j = jet<1>(c_, t);
        const Foot f = chart_.foot(j.d[0], j.d[1], guess);
        return f.regular && near(f.at, guess) ? f.at : chart_.inside(guess);
    }
    // Not a period further, and not elsewhere on the surface.
    bool near(const Vec<2>& a, const Vec<2>& b) const {
        for (int k = 0; k < 2; ++k)
            if (chart_.period(k) > 0 && std::abs(a[k] - b[k]) > 0.05 * chart_.period(k)) return false;
        return true;
    }

    std::optional<Trace> line(const Foot& start, double middle) const {
        const auto guess = [&](double t) { return start.at + (t - middle) * start.slope; };
        const Vec<2> from = guess(on_.lo), to = guess(on_.hi);
        Vec<2> a = end(on_.lo, from), b = end(on_.hi, to);
        // Isoparametric lines exactly so.
        const auto j = jet<1>(chart_.surface(), chart_.wrapped(start.at).c);
        const auto moves = [&](int k) { return std::abs(from[k] - to[k]) * norm(j.d[std::size_t(k) + 1]); };
        for (int k = 0; k < 2; ++k)
            if (moves(k) <= 0.5 * accuracy_ && moves(1 - k) > 2 * moves(k)) a[k] = b[k] = start.at[k];
        if (a == b) a = from, b = to;
        for (const Pole& p : chart_.poles())  // meridians end exactly there
            for (Vec<2>* x : {&a, &b})
                if (std::abs((*x)[p.axis] - p.at) <=
                    1e-9 * (std::abs(p.at) + std::abs(a[p.axis] - b[p.axis])))
                    (*x)[p.axis] = p.at;
        snap(a, b);
        const Vec<2> d = (1 / on_.length()) * (b - a);
        if (max_abs(d) == 0) return std::nullopt;
        Trace out;
        out.curve = Line<2>{a - on_.lo * d, d};
        if (!holds_everywhere(out, spans_of(c_))) return std::nullopt;
        return out;
    }
    // At `more` places besides those that lines have: splines need them.
    template <class Is>
    bool at_all_places(int more, const Is& is) const {
        for (const double x : kPlacesOfLine)
            if (!is(x == 1 ? on_.hi : on_.lo + x * on_.length())) return false;
        for (int i = 0; i < more; ++i)
            if (!is(on_.lo + on_.length() * (i + 0.5) / more)) return false;
        return true;
    }
    bool holds_everywhere(Trace& out, int more) const {
        return at_all_places(more, [&](double t) { return holds(jet<0>(out.curve, t).value(), t, out.gap); });
    }
    // Along the end of a spline exactly so.
    void snap(Vec<2>& a, Vec<2>& b) const {
        for (int k = 0; k < 2; ++k) {
            if (!chart_.is_spline(k)) continue;
            const Interval on = chart_.whole()[std::size_t(k)];
            for (const double x : {on.lo, on.hi})
                if (a[k] == b[k] && std::abs(a[k] - x) <= 1e-9 * on.length()) a[k] = b[k] = x;
        }
    }
    // Whether uv is as near to the edge as the surface is, or almost.
    bool holds(const Vec<2>& uv, double t, double& worst) const {
        const double gap = gap_at(uv, t);
        if (!std::isfinite(gap)) return false;
        if (gap > accuracy_) {
            const auto j = jet<1>(c_, t);
            if (gap > 1.1 * chart_.foot(j.d[0], j.d[1], uv).distance + accuracy_) return false;
        }
        worst = std::max(worst, gap);
        return true;
    }

    // Where pieces begin: at the knots of the edge, and often enough.
    std::vector<double> places() const {
        const std::vector<double> all = places_along(c_, on_, 6, 200);
        std::vector<double> out;
        for (const double t : all)
            if (out.empty() || t - out.back() > kApart * on_.length()) out.push_back(t);
        if (out.size() > 1) out.back() = on_.hi;
        return out;
    }

    // A node at out.t, where the nearest point is.
    void place(const Foot& f, TraceNode& out) const {
        out.at = f.at;
        out.gap = f.distance;
        out.before = out.after = f.slope;
        if (!has_corner(out.t)) return;
        const auto left = jet<1>(c_, std::nextafter(out.t, on_.lo));
        if (const Foot g = chart_.foot(left.d[0], left.d[1], f.at); g.regular) out.before = g.slope;
    }
    // A step that is too long beside the pole of a sphere leads over it: to parameters beyond it that are,
    // half a turn back, also near to where it began.
    std::optional<Vec<2>> on_this_side(const Vec<2>& at, const Vec<2>& from) const {
        const Interval on = chart_.whole()[1];
        if (!chart_.is_sphere() || on.contains(at[1])) return std::nullopt;
        const double by = std::remainder(at[0] + kTwoPi / 2 - from[0], kTwoPi);
        if (std::abs(by) > kTwoPi / 4) return std::nullopt;
        return Vec<2>{{from[0] + by, 2 * (at[1] > on.hi ? on.hi : on.lo) - at[1]}};
    }
    // From a known node to the next place. False where the surface has no tangent plane there.
    bool node(double t, const TraceNode& from, TraceNode& out) const {
        const double h = t - from.t;
        Vec<2> guess = from.at + h * (h > 0 ? from.after : from.before);
        const auto j = jet<1>(c_, t);
        Foot f = chart_.foot(j.d[0], j.d[1], guess);
        if (const auto before_pole = on_this_side(f.at, from.at)) {
            guess = *before_pole;
            f = chart_.foot(j.d[0], j.d[1], guess);
        }
        out.t = t;
        const bool is_end = t == on_.lo || t == on_.hi;
        // All parameters of a pole are as near.
        const bool at_pole = is_end && std::ranges::any_of(chart_.poles(), [&](const Pole& p) {
                                 return norm(p.point - j.d[0]) <= f.distance + accuracy_;
                             });
        if (f.regular && near(f.at, guess) && !at_pole) {
            place(f, out);
            if (is_end) keep_side(from, j.d[1], out);
            return true;
        }
        if (!is_end) return false;
        // At a pole: continued from a place just inside.
        const double inside = t + (t == on_.lo ? 1 : -1) * 1e-4 * on_.length();
        const auto k = jet<1>(c_, inside);
        const Foot g =
            chart_.foot(k.d[0], k.d[1], from.at + (inside - from.t) * (h > 0 ? from.after : from.before));
        if (!g.regular) return false;
        out.at = chart_.inside(g.at + (t - inside) * g.slope);
        // A corner where the directions of the parameters are parallel.
        if (!at_pole && near(f.at, out.at) && f.distance < norm(chart_.point(out.at) - j.d[0])) out.at = f.at;
        for (const Pole& p : chart_.poles())
            if (norm(p.point - j.d[0]) <= norm(chart_.point(out.at) - j.d[0]) + accuracy_)
                out.at[p.axis] = p.at;
        out.before = out.after = g.slope;
        out.gap = norm(chart_.point(out.at) - j.d[0]);
        return true;
    }
    // An end on the seam of a spline, which may have a crease there, leaves it on the side of `from`.
    void keep_side(const TraceNode& from, const Vec<3>& motion, TraceNode& n) const {
        Vec<2> beside = n.at;
        for (int k = 0; k < 2; ++k) {
            const double period = chart_.is_spline(k) ? chart_.period(k) : 0;
            if (!(period > 0)) continue;
            const double off = std::remainder(n.at[k] - chart_.whole()[std::size_t(k)].lo, period);
            if (std::abs(off) <= kOnSeam * period)
                beside[k] += std::copysign(2 * kOnSeam * period, from.at[k] - n.at[k]);
        }
        if (beside == n.at) return;
        if (const Foot f = chart_.foot(chart_.point(beside), motion, beside); f.regular)
            n.before = n.after = f.slope;
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

    static Vec<2> hermite(const TraceNode& a, const TraceNode& b, double t) {
        const double h = b.t - a.t, x = (t - a.t) / h, y = 1 - x;
        return (y * y * (1 + 2 * x)) * a.at + (x * x * (1 + 2 * y)) * b.at + (h * x * y * y) * a.after +
               (-h * x * x * y) * b.before;
    }

    // Near the middle, and not beside a place: derivatives of a piece as short as rounding have no bound.
    TraceNode first_node(const Foot& start, double middle, const std::vector<double>& all) const {
        TraceNode first;
        first.t = middle;
        place(start, first);
        for (const double t : all)
            if (TraceNode n; std::abs(t - middle) <= kApart * on_.length() && node(t, first, n)) return n;
        return first;
    }

    Result<Trace> spline(const Foot& start, double middle) const {
        const auto lost = [] {
            return refuse(
                RefusalKind::not_converged, "parameter curve",
                "cannot be followed on the surface: it runs through a pole or a fold, or far beside it");
        };
        const auto all = places();
        const TraceNode first = first_node(start, middle, all);
        middle = first.t;
        std::vector<TraceNode> left, right{first};
        for (const double t : all) {
            if (t < middle) continue;
            TraceNode n;
            if (!advance(right.back(), t, n)) return lost();
            if (t > middle) right.push_back(n);
        }
        left.push_back(first);
        for (auto t = all.rbegin(); t != all.rend(); ++t) {
            if (*t >= middle) continue;
            TraceNode n;
            if (!advance(left.back(), *t, n)) return lost();
            left.push_back(n);
        }
        // `todo` from the end to the beginning.
        std::vector<TraceNode> todo(right.rbegin(), right.rend()), done;
        todo.insert(todo.end(), left.begin() + 1, left.end());
        done.push_back(todo.back());
        todo.pop_back();
        Trace out;
        out.fitted = true;
        while (!todo.empty()) {
            const TraceNode a = done.back(), b = todo.back();
            bool good = true;
            for (const double x : {0.21, 0.5, 0.79}) {
                const double t = a.t + x * (b.t - a.t);
                if (good) good = holds(hermite(a, b, t), t, out.gap);
            }
            TraceNode m;
            if (!good && done.size() + todo.size() <= std::size_t(kMostPieces) &&
                b.t - a.t > 1e-7 * on_.length() && advance(a, a.t + (b.t - a.t) / 2, m)) {
                todo.push_back(m);
                continue;
            }
            if (!good) {  // the best that there is; the gap says how good
                for (const double x : {0.21, 0.5, 0.79})
                    out.gap = std::max(out.gap,
                                       gap_at(hermite(a, b, a.t + x * (b.t - a.t)), a.t + x * (b.t - a.t)));
                if (!std::isfinite(out.gap)) return lost();
            }
            done.push_back(b);
            todo.pop_back();
        }
        out.curve = joined(done);
        return out;
    }
    // As `node`, in smaller steps where one is too large: where the surface folds it may lead to another part
    // of it, which is farther from the edge.
    bool advance(const TraceNode& from, double t, TraceNode& out) const {
        bool found = false;
        for (int steps = 1; steps <= 64; steps *= 8) {
            TraceNode at = from, next;
            bool good = true;
            for (int i = 1; i <= steps && good; ++i) {
                const double to = i == steps ? t : from.t + (t - from.t) * i / steps;
                good = node(to, at, next);
                at = next;
            }
            if (good && (!found || at.gap < out.gap)) out = at, found = true;
            if (found && out.gap <= kNear * accuracy_ + kFarther * from.gap) return true;
        }
        // Where the surface bends sharply beside the edge, the nearest point is elsewhere.
        const auto j = jet<1>(c_, t);
        const Foot f = foot_by_images(chart_, j.d[0], j.d[1], t, on_, accuracy_, images_);
        if (f.regular && near(f.at, from.at) && !(found && kNearer * out.gap <= f.distance)) {
            out.t = t, found = true;
            place(f, out);
        }
        return found;
    }

    static CurveGeometry<2> joined(const std::vector<TraceNode>& nodes) {
        std::vector<double> knots(2, nodes.front().t);
        std::vector<Vec<2>> net;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const TraceNode& n = nodes[i];
            knots.insert(knots.end(), 2, n.t);
            net.push_back(i == 0 ? n.at : n.at - ((n.t - nodes[i - 1].t) / 3) * n.before);
            net.push_back(i + 1 == nodes.size() ? n.at : n.at + ((nodes[i + 1].t - n.t) / 3) * n.after);
            if (i > 0 && i + 1 < nodes.size() && !(n.before == n.after)) {  // a corner
                knots.push_back(n.t);
                net.insert(net.end() - 1, n.at);
            }
        }
        knots.insert(knots.end(), 2, nodes.back().t);
        const int size = int(net.size());
        return Curve<Vec<2>>::trusted({*BSplineBasis::make(3, std::move(knots))},
                                      Net<1, Vec<2>>({size}, std::move(net)));
    }

    const Chart& chart_;
    const CurveGeometry<3>& c_;
    Interval on_;
    double accuracy_, rough_;
    std::span<const CurveGeometry<3>> images_;
};

}  // namespace

Result<Trace> trace(const Chart& chart, const CurveGeometry<3>& c, Interval on, double accuracy, double rough,
                    std::span<const CurveGeometry<3>> images, bool to_poles) {
    return Tracer(chart, c, on, accuracy, rough, images).run(to_poles);
}

}  // namespace freiform::step

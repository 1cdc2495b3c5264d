// Self-intersections of a curve by subdivision with certificates.
//
// Idea. A part of a curve does not meet itself if all its tangents lie in an open half-space: it then moves
// on in one direction. Two parts do not meet if their hulls are apart. Two parts of a plane curve meet at
// most once if no tangent of one is parallel to one of the other. Halving makes one of the three true
// everywhere but where the curve touches itself, and at cusps.
//
// Notation. Parts are Bezier pieces or halves of them with projected control points P_i; legs are P_{i+1} -
// P_i. Weights are positive. e bounds the error of each coordinate of a P_i.
//
// Method. The tangents of a polynomial or rational piece are non-negative combinations of its legs: for
// polynomials by the hodograph; for rational ones because C(t) - C(s), s < t, is one (total positivity: the
// weight of P_i moves towards higher i). So is every chord, which is what the tests need:
//   - half-space: a vector a with a . leg > 0 for all legs. Legs that are exactly zero at an end of the
//     curve (repeated control points) are left out: the derivative vanishes there, but only there. The same
//     for two neighbours together: they have their joint in common and nothing else.
//   - apart: the boxes, or the projections on the normals of both chords.
//   - at most once: cross(leg of A, leg of B) has one sign for all pairs. Two meetings would give two chords
//     that are equal, one a combination of legs of A, the other of B, and their cross product is not zero.
//   - once: Poincare and Miranda. On a rectangle of parameters around the result of Newton's method the ends
//     of each arc lie on different sides of the strip that contains the other. Together with "at most once",
//     exactly one. A pair is settled by a crossing found before if the arcs of both together are still "at
//     most once".
// Pairs are looked at breadth first. Pairs as small as the accuracy, or parallel and as flat, are given up as
// uncertain; neighbouring ones are united. There the nearest pair of parameters is looked for, and whether
// the curve meets itself at one of the simple numbers beside it is decided in integers (self_contact.cpp).
//
// In space: points of a plane are told apart without one of their coordinates, so a curve in a plane has the
// meetings of its image. Distances in the plane are at most sqrt(3) times those in the image, if the
// coordinate that is left out is the one in which the normal is longest.
//
// Accuracy. Errors of coefficients as in bounds.cpp; legs are off by 2 e in each coordinate, and a . leg by
// 2 e |a|_1 and rounding; all comparisons leave that distance.
//
// Cost. Grows with the number of pieces squared for the first boxes, then with the number of meetings times
// log(1 / accuracy).
//
// References. [Sederberg Meyers 1988] (tangent cones), [Floater 1992] (derivatives of rational curves).
//
// Why not elimination (implicit form, resultants)? Degree (n - 1)(n - 2) in one parameter, with coefficients
// that doubles cannot hold for n > 4.
#include "arc_detail.hpp"
#include "halved_arcs_detail.hpp"
#include "self_contact_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/query/self_intersection.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <optional>
#include <type_traits>

namespace freiform {

namespace {

using detail::Arc;
using detail::meet_at_most_once;
using detail::moves_on;

template <class P>
class Search {
public:
    static constexpr int D = Space<P>::kDim;
    using Meeting = SelfIntersection<D>;

    // `closed`: stretches of the domain at whose ends the curve is in the same place. `errors`: what the
    // coefficients of each piece are off by; empty: nothing.
    Search(const Curve<P>& curve, std::span<const Interval> closed, std::span<const double> errors,
           double accuracy, int max_pairs)
        : curve_(curve),
          pieces_(curve, errors),
          accuracy_(accuracy),
          max_pairs_(max_pairs),
          closed_(closed.begin(), closed.end()),
          exact_(errors.empty()) {}

    // Of no more than `most` pairs of pieces that are near each other; else nothing.
    std::optional<std::vector<Meeting>> run(std::size_t most) {
        if (!queue_near_pieces(most)) return std::nullopt;
        for (int looked_at = 0; !queue_.empty(); ++looked_at) {
            const Pair pair = queue_.front();
            queue_.pop_front();
            if (pair.a == pair.b)
                look_at_one(pair.a, looked_at < max_pairs_);
            else
                look_at_two(pair, looked_at < max_pairs_);
        }
        unite_open();
        sort(found_.begin(), found_.end(), [](const Meeting& x, const Meeting& y) {
            return x.first.lo != y.first.lo ? x.first.lo < y.first.lo : x.second.lo < y.second.lo;
        });
        return std::move(found_);
    }

private:
    struct Pair {
        int a, b;  // a is left of b, or the same
        friend auto operator<=>(const Pair&, const Pair&) = default;
    };

    // Pieces whose boxes overlap along the first coordinate, found from left to right.
    bool queue_near_pieces(std::size_t most) {
        std::vector<int> order;
        order.resize(std::size_t(pieces_.count()));
        std::iota(order.begin(), order.end(), 0);
        sort(order.begin(), order.end(), [&](int i, int j) { return arc(i).box.lo[0] < arc(j).box.lo[0]; });
        double error = 0;
        for (int i = 0; i < pieces_.count(); ++i) error = std::max(error, 2.02 * arc(i).error);
        std::vector<Pair> pairs;
        for (std::size_t k = 0; k < order.size(); ++k) {
            const int i = order[k];
            pairs.push_back({i, i});
            for (std::size_t l = k + 1; l < order.size(); ++l) {
                const int j = order[l];
                if (arc(j).box.lo[0] > arc(i).box.hi[0] + error) break;
                if (!detail::are_apart(arc(i), arc(j))) pairs.push_back({std::min(i, j), std::max(i, j)});
            }
            if (pairs.size() > most) return false;
        }
        sort(pairs.begin(), pairs.end());
        queue_.assign(pairs.begin(), pairs.end());
        return true;
    }

    const Arc<D>& arc(int i) const { return pieces_.arc(i); }

    // By more than the ends of halves, whose parameters are rounded, may be off.
    bool overlap(const Interval& a, const Interval& b) const {
        return std::min(a.hi, b.hi) - std::max(a.lo, b.lo) > pieces_.parameter_error();
    }

    void look_at_one(int i, bool may_halve) {
        if (pieces_.is_point(i) || moves_on<D>({&arc(i)})) return;
        const bool small = arc(i).box.diagonal() <= smallest(arc(i));
        const auto halves = may_halve && !small ? pieces_.halves(i) : std::nullopt;
        if (!halves) {
            open_.push_back(given_up(may_halve, arc(i).on, arc(i).on));
            return;
        }
        const auto [left, right] = *halves;
        queue_.push_back({left, left});
        queue_.push_back({right, right});
        queue_.push_back({left, right});
    }

    static Meeting given_up(bool looked_at, const Interval& a, const Interval& b) {
        Meeting m;
        m.kind = looked_at ? SelfContact::near : SelfContact::unresolved;
        m.first = a, m.second = b;
        return m;
    }

    double smallest(const Arc<D>& a) const { return std::max(accuracy_, 16 * a.error); }

    bool are_neighbours(const Arc<D>& a, const Arc<D>& b) const {
        if (a.on.hi == b.on.lo) return !pieces_.jumps_at(b.on.lo);
        return std::any_of(closed_.begin(), closed_.end(),
                           [&](const Interval& whole) { return a.on.lo == whole.lo && b.on.hi == whole.hi; });
    }

    void look_at_two(const Pair& pair, bool may_halve) {
        const Arc<D>&a = arc(pair.a), &b = arc(pair.b);
        const bool neighbours = are_neighbours(a, b);
        bool parallel = true;
        if (neighbours) {
            if (a.on.hi == b.on.lo ? moves_on<D>({&a, &b}) : moves_on<D>({&b, &a})) return;
        } else {
            if (detail::are_apart(a, b)) return;
            if constexpr (D == 2) {
                parallel = !meet_at_most_once({&a}, {&b});
                if (!parallel && settle(a, b)) return;
            }
        }
        const double size_a = a.box.diagonal(), size_b = b.box.diagonal(),
                     least = std::max(smallest(a), smallest(b));
        const bool small = std::max(size_a, size_b) <= least;
        const bool flat = !neighbours && parallel &&
                          std::max(detail::thickness(a), detail::thickness(b)) <= least && D == 2;
        const int larger = size_a >= size_b ? pair.a : pair.b;
        const auto halves = may_halve && !small && !flat ? pieces_.halves(larger) : std::nullopt;
        if (!halves) {
            open_.push_back(given_up(may_halve, arc(pair.a).on, arc(pair.b).on));
            return;
        }
        for (const int half : *halves)
            queue_.push_back(larger == pair.a ? Pair{half, pair.b} : Pair{pair.a, half});
    }

    // One crossing of the arcs at most. True: it has been found, here or before. (Plane curves.)
    bool settle(const Arc<2>& a, const Arc<2>& b) {
        for (std::size_t i = 0; i < found_.size(); ++i)
            if (overlap(found_[i].first, a.on) && overlap(found_[i].second, b.on) &&
                meet_at_most_once({&a, &arcs_[i].first}, {&b, &arcs_[i].second}))
                return true;
        // Newton's method for C(s) = C(t).
        const Interval domain = curve_.basis().domain();
        double s = a.on.middle(), t = b.on.middle();
        for (int k = 0; k < 12; ++k) {
            const auto js = curve_.template jet<1>(s), jt = curve_.template jet<1>(t);
            const Vec<2> f = js.value() - jt.value(), u = js.d[1], v = jt.d[1];
            const double det = cross(u, v);
            if (det == 0) return false;
            const double ds = -cross(f, v) / det, dt = -cross(f, u) / det;
            if (!(std::abs(ds) <= 2 * a.on.length() && std::abs(dt) <= 2 * b.on.length())) return false;
            s = std::clamp(s + ds, domain.lo, domain.hi);
            t = std::clamp(t + dt, domain.lo, domain.hi);
            if (std::abs(ds) <= 4 * kUnitRoundoff * std::abs(s) &&
                std::abs(dt) <= 4 * kUnitRoundoff * std::abs(t))
                break;
        }
        const auto near = [](const Interval& on, double x) {
            return on.lo - 0.1 * on.length() <= x && x <= on.hi + 0.1 * on.length();
        };
        if (!near(a.on, s) || !near(b.on, t)) return false;
        const double vs = norm(curve_.template jet<1>(s).d[1]), vt = norm(curve_.template jet<1>(t).d[1]);
        double size = 0.4 * accuracy_;
        for (int k = 0; k < 14; ++k, size *= 4) {
            const auto around = [&](double x, double speed, const Interval& whole) {
                const double r = std::max(
                    size / speed, 4 * kUnitRoundoff * std::max(std::abs(whole.lo), std::abs(whole.hi)));
                return Interval{std::max(whole.lo, x - r), std::min(whole.hi, x + r)};
            };
            const Arc<2> p = pieces_.arc_over(around(s, vs, pieces_.stretch_around(s))),
                         q = pieces_.arc_over(around(t, vt, pieces_.stretch_around(t)));
            if (p.on.overlaps(q.on)) return false;
            if (!detail::is_certainly_crossing(p, q)) continue;
            if (!overlap(p.on, a.on) || !overlap(q.on, b.on) || !meet_at_most_once({&a, &p}, {&b, &q}))
                return false;
            const Vec<2> x = curve_(s);
            double bound = 0;
            for (const Arc<2>* side : {&p, &q})
                for (const Vec<2>& y : side->points) bound = std::max(bound, norm(y - x) + 2 * side->error);
            found_.push_back({SelfContact::crossing,
                              p.on,
                              q.on,
                              x,
                              bound * (1 + 8 * kUnitRoundoff) + 2 * curve_.value_error_bound(),
                              {s, t}});
            arcs_.push_back({p, q});
            return true;
        }
        return false;
    }

    // Pairs that were given up: those that touch are one answer.
    void unite_open() {
        sort(open_.begin(), open_.end(), [](const Meeting& x, const Meeting& y) {
            return x.first.lo != y.first.lo ? x.first.lo < y.first.lo : x.second.lo < y.second.lo;
        });
        std::vector<Meeting> united;
        for (const Meeting& m : open_) {
            Meeting all = m;
            // Growing one answer may make it touch another.
            for (bool again = true; again;) {
                again = false;
                for (std::size_t i = 0; i < united.size(); ++i) {
                    const Meeting u = united[i];
                    if (!u.first.overlaps(all.first) || !u.second.overlaps(all.second)) continue;
                    if (u.kind == SelfContact::unresolved) all.kind = u.kind;
                    all.first = hull(u.first, all.first);
                    all.second = hull(u.second, all.second);
                    united[i] = united.back();
                    united.pop_back();
                    again = true;
                    break;
                }
            }
            united.push_back(all);
        }
        for (Meeting& m : united) {
            for (Interval* on : {&m.first, &m.second}) {
                const Interval stretch = pieces_.stretch_around(on->middle());  // not over a jump
                *on = {std::max(stretch.lo, on->lo - pieces_.parameter_error()),
                       std::min(stretch.hi, on->hi + pieces_.parameter_error())};
            }
            m.point = 0.5 * (curve_(m.first.middle()) + curve_(m.second.middle()));
            for (const Interval& on : {m.first, m.second}) {
                const Arc<D> a = pieces_.arc_over(on);
                for (const Vec<D>& y : a.points) m.bound = std::max(m.bound, norm(y - m.point) + 2 * a.error);
            }
            m.bound = m.bound * (1 + 8 * kUnitRoundoff) + 2 * curve_.value_error_bound();
            if (exact_) detail::describe(curve_, m);
            found_.push_back(m);
        }
    }

    const Curve<P>& curve_;
    detail::HalvedArcs<P> pieces_;
    double accuracy_;
    int max_pairs_;
    std::vector<Interval> closed_;
    bool exact_;  // the coefficients are those given
    std::deque<Pair> queue_;
    std::vector<Meeting> found_, open_;
    std::vector<std::pair<Arc<D>, Arc<D>>> arcs_;  // of the certain ones in found_
};

template <class P>
std::vector<SelfIntersection<Space<P>::kDim>> all_meetings(const Curve<P>& curve, double accuracy,
                                                           int max_pairs) {
    const std::array<Interval, 1> whole = curve.domain();
    return *Search<P>(curve, std::span(whole).first(curve.basis().is_closed() ? 1 : 0), {}, accuracy,
                      max_pairs)
                .run(std::numeric_limits<std::size_t>::max());
}

// The image of a curve of three coordinates, without one of them. Exact.
template <class P>
auto without(const Curve<P>& curve, int coordinate) {
    using Flat = std::conditional_t<Space<P>::kRational, Hom<2>, Vec<2>>;
    std::vector<Flat> net;
    for (const P& p : curve.net().flat()) {
        Flat q;
        for (int c = 0, k = 0; c < P::kCoords; ++c)
            if (c != coordinate) q[k++] = p[c];
        net.push_back(q);
    }
    return Curve<Flat>::make({curve.basis()}, Net<1, Flat>({curve.basis().size()}, std::move(net)));
}

// The meetings of a curve in a plane of space, from those of its image.
template <class P>
std::vector<SelfIntersection<3>> lifted(const Curve<P>& curve, const std::vector<SelfIntersection<2>>& image,
                                        double image_error) {
    const double error = 2 * curve.value_error_bound();  // of the distance of a point
    std::vector<SelfIntersection<3>> out;
    for (const SelfIntersection<2>& m : image) {
        SelfIntersection<3> x{m.kind, m.first, m.second, curve(m.first.middle()), 0, m.at, 0};
        // From the point over the middle of `first` to m.point and on: both in the image.
        x.bound = 1.7320508075688774 * (2 * m.bound + 2 * image_error) * (1 + 8 * kUnitRoundoff) + error;
        if (m.kind == SelfContact::near)
            x.distance = (norm(curve(m.at[0]) - curve(m.at[1])) + 2 * error) * (1 + 8 * kUnitRoundoff);
        out.push_back(x);
    }
    return out;
}

}  // namespace

std::string_view name_of(SelfContact kind) {
    constexpr std::string_view kNames[] = {"crossing", "meeting", "near", "cusp", "unresolved"};
    return kNames[int(kind)];
}

template <class P>
requires(Space<P>::kDim == 2 || Space<P>::kDim == 3)
    Result<std::vector<SelfIntersection<Space<P>::kDim>>> self_intersections(const Curve<P>& curve,
                                                                             double accuracy, int max_pairs) {
    if (!(accuracy > 0))
        return refuse(RefusalKind::invalid, "accuracy", text(accuracy, " is not a length > 0"));
    if constexpr (Space<P>::kDim == 3)
        if (const auto spare = detail::spare_coordinate(tuples(curve.net().flat())))
            if (const auto image = without(curve, *spare))
                return lifted(curve, all_meetings(*image, accuracy / 4, max_pairs),
                              2 * image->value_error_bound());
    return all_meetings(curve, accuracy, max_pairs);
}

Result<std::vector<SelfIntersection<2>>> self_intersections(const Curve<Hom<2>>& chains,
                                                            std::span<const Interval> closed,
                                                            std::span<const double> errors, double accuracy,
                                                            int max_pairs) {
    if (!(accuracy > 0))
        return refuse(RefusalKind::invalid, "accuracy", text(accuracy, " is not a length > 0"));
    auto found = Search<Hom<2>>(chains, closed, errors, accuracy, max_pairs).run(std::size_t(max_pairs));
    if (!found)
        return refuse(
            RefusalKind::limit, "curve",
            text("more than ", max_pairs, " pairs of its ", errors.size(), " pieces lie on each other"));
    return *std::move(found);
}

template Result<std::vector<SelfIntersection<2>>> self_intersections(const Curve<Vec<2>>&, double, int);
template Result<std::vector<SelfIntersection<2>>> self_intersections(const Curve<Hom<2>>&, double, int);
template Result<std::vector<SelfIntersection<3>>> self_intersections(const Curve<Vec<3>>&, double, int);
template Result<std::vector<SelfIntersection<3>>> self_intersections(const Curve<Hom<3>>&, double, int);

}  // namespace freiform

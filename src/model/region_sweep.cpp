// Idea. Each loop becomes a ring of walls, whose parameters are those of the curve and of the sweep, so that
// every parameter curve is a straight line. The flat faces have the region's own coordinates as parameters;
// there the loops themselves are the parameter curves.
//
//          after ---- far curve ----> next      wall of one curve: u along it and v along the sweep (prism,
//            ^                          ^       solid along a rail), or v along it and u the angle
//          rail                       rail      (revolution)
//            |                          |       rails: what vertices sweep
//          start ---- curve --------> next
//
// Orientation. orient_loops puts the region on the left of each loop. A wall c(u) + v by of a prism has the
// normal c' x by; for by upwards that points to the right of c, outwards. A wall of revolution has (axis x r)
// x c', which points to the right of c where the region is on the right of the axis. The other cases are
// reversed.
//
// Axis. Points of it that curves begin or end at stay where they are: their rails are poles of the walls
// beside. Curves that lie on it have no wall; where the turn is not full both flat faces have them as one
// edge. The curves between two such points sweep a closed surface of their own: that from the end of the axis
// where the loop leaves it outwards goes round all the others, which are hollows.
//
// Parts. Loops of even depth bound a part, with the loops one deeper inside them as holes. Loops do not
// cross, so one point of a hole tells in which: of several that contain it the one next to it has the right
// depth.
#include "elementary_curve_detail.hpp"
#include "region_sweep_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/trim/loops.hpp>
#include <freiform/trim/trimmed_surface.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace freiform::detail {

namespace {

Line<2> from_to(Interval on, const Vec<2>& from, const Vec<2>& to) {
    const Vec<2> direction = (1 / on.length()) * (to - from);
    return {from - on.lo * direction, direction};
}

class Sweeper {
public:
    Sweeper(const RegionSweep& sweep, const OrientedLoops& loops, double gap)
        : sweep_(sweep), loops_(loops), gap_(gap) {}

    Result<Model> model() {
        for (const auto& loop : loops_.loops)
            if (auto ok = walls(loop); !ok) return std::unexpected(ok.error());
        for (std::size_t l = 0; l < loops_.loops.size(); ++l)
            if (loops_.depth[l] % 2 == 0)
                if (auto ok = part(l); !ok) return std::unexpected(ok.error());
        return make_model(std::move(model_));
    }

private:
    struct Ring {  // of one loop: edges of its curves at both ends of the sweep, and its walls
        std::vector<int> near, far;
        std::vector<std::vector<int>> faces;  // that belong together; what goes round the others first
        std::vector<SweptCurve::Flat> curves;
    };

    int add(Edge edge) {
        model_.edges.push_back(std::move(edge));
        return int(model_.edges.size()) - 1;
    }

    Vec<2> at(double t, double s) const { return sweep_.turns ? Vec<2>{{s, t}} : Vec<2>{{t, s}}; }

    std::optional<double> on_axis(const CurveGeometry<2>& c, bool at_end) const {
        const Interval t = domain(c)[0];
        return sweep_.on_axis ? sweep_.on_axis(jet<0>(c, at_end ? t.hi : t.lo).value()) : std::nullopt;
    }
    bool lies_on_axis(const CurveGeometry<2>& c) const {
        return sweep_.on_axis && std::ranges::all_of(spline_of(c).net, [&](const Hom<2>& p) {
                   return bool(sweep_.on_axis(project(p)));
               });
    }

    Result<void> walls(const std::vector<CurveGeometry<2>>& loop) {
        const std::size_t n = loop.size();
        Ring ring;
        std::vector<std::array<int, 2>> vertices(n, {-1, -1});  // at the starts of curves, made when needed
        std::vector<int> rails;                                 // the edges that these sweep
        std::vector<SweptCurve> swept;
        for (const auto& c : loop) {
            auto made = sweep_.curve(c);
            if (!made) return std::unexpected(made.error());
            swept.push_back(*std::move(made));
        }
        const auto stays = [&](std::size_t i) { return on_axis(loop[i], false).has_value(); };
        const auto vertex = [&](std::size_t i, bool at_far) {
            int& v = vertices[i][at_far && !sweep_.full && !stays(i) ? 1 : 0];
            if (v < 0) {
                v = int(model_.vertices.size());
                model_.vertices.push_back({at_far ? swept[i].start_far : swept[i].start, swept[i].tolerance});
            }
            return v;
        };
        for (std::size_t i = 0; i < n; ++i)
            rails.push_back(stays(i) ? -1
                                     : add({swept[i].rail, false, sweep_.range, vertex(i, false),
                                            vertex(i, true), swept[i].tolerance, ""}));
        for (std::size_t i = 0; i < n; ++i) {
            const SweptCurve& c = swept[i];
            ring.curves.push_back(c.flat ? *c.flat : SweptCurve::Flat{loop[i], domain(loop[i])[0]});
            const auto& flat = ring.curves.back();
            const std::size_t next = (i + 1) % n;
            const bool lies = lies_on_axis(loop[i]), is_seam = sweep_.full && !lies && !c.level;
            const auto edge = [&](const CurveGeometry<3>& curve, bool at_far) {
                const int from = vertex(flat.against ? next : i, at_far),
                          to = vertex(flat.against ? i : next, at_far);
                return add({curve, false, flat.on, from, to, c.tolerance, ""});
            };
            ring.near.push_back(is_seam || !sweep_.full ? edge(c.near, false) : -1);
            ring.far.push_back(sweep_.full || lies ? ring.near.back() : edge(c.far, true));
        }
        const auto rail = [&](std::size_t k) {
            if (rails[k] >= 0) return rails[k];
            const int pole = vertex(k, false);
            return add({{}, true, sweep_.range, pole, pole, swept[k].tolerance, ""});
        };
        const std::size_t first = outermost(loop);
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t i = (first + k) % n, next = (i + 1) % n;
            if (k == 0 || on_axis(loop[i], false)) ring.faces.emplace_back();
            if (lies_on_axis(loop[i])) continue;
            const bool against = ring.curves[i].against;
            const Interval t = ring.curves[i].on, s = sweep_.range;
            const auto along = [&](double at_s) { return from_to(t, at(t.lo, at_s), at(t.hi, at_s)); };
            const auto across = [&](double at_t) { return from_to(s, at(at_t, s.lo), at(at_t, s.hi)); };
            const std::size_t lo = against ? next : i, hi = against ? i : next;
            Face face;
            face.surface = std::move(swept[i].wall);
            // Planes look along the axis, revolutions of such lines against it.
            face.reversed = (sweep_.reversed != against) != swept[i].level.has_value();
            if (swept[i].level) {
                face.loops = level_loops(*swept[i].level, ring, i, {rails[lo], rails[hi]});
            } else {
                Loop around{{{ring.near[i], false, along(s.lo)},
                             {rail(hi), false, across(t.hi)},
                             {ring.far[i], true, along(s.hi)},
                             {rail(lo), true, across(t.lo)}}};
                if (sweep_.turns) {  // (s, t) are (u, v): the same way round is the other way
                    std::ranges::reverse(around.coedges);
                    for (Coedge& e : around.coedges) e.reversed = !e.reversed;
                }
                face.loops = {std::move(around)};
            }
            ring.faces.back().push_back(int(model_.faces.size()));
            model_.faces.push_back(std::move(face));
        }
        std::erase_if(ring.faces, [](const auto& faces) { return faces.empty(); });
        rings_.push_back(std::move(ring));
        return {};
    }

    // Of a plane about the axis, with the rails of the ends of its line, -1 on the axis itself: a ring, or a
    // disc, of a full turn, which has no seam, else a sector.
    std::vector<Loop> level_loops(const Interval& from_axis, const Ring& ring, std::size_t i,
                                  const std::array<int, 2>& rails) const {
        const auto circle = [](double r) { return Conic<2>{ConicKind::ellipse, {}, {{r, 0}}, {{0, r}}}; };
        const auto line = [&](double angle) {
            const Vec<2> way{{std::cos(angle), std::sin(angle)}};
            return from_to(ring.curves[i].on, from_axis.lo * way, from_axis.hi * way);
        };
        const Coedge outer{rails[1], false, circle(from_axis.hi)},
            inner{rails[0], true, circle(from_axis.lo)};
        if (sweep_.full) {
            std::vector<Loop> loops{{{outer}}};
            if (inner.edge >= 0) loops.push_back({{inner}});
            return loops;
        }
        Loop around{{{ring.near[i], false, line(sweep_.range.lo)},
                     outer,
                     {ring.far[i], true, line(sweep_.range.hi)}}};
        if (inner.edge >= 0) around.coedges.push_back(inner);
        return {around};
    }

    // The curve that leaves the axis for what goes round everything else.
    std::size_t outermost(const std::vector<CurveGeometry<2>>& loop) const {
        std::size_t first = 0;
        double least = kInfinity;
        for (std::size_t i = 0; i < loop.size(); ++i)
            if (const auto place = on_axis(loop[i], false); place && *place < least)
                least = *place, first = i;
        return first;
    }

    // A flat face over the loops, at the near or the far end.
    int cap(const std::vector<std::size_t>& loops, bool at_far) {
        Face face;
        face.surface = sweep_.cap(at_far);
        // Upwards is outwards at the far end of a prism, and at the near end of a turn to the right of the
        // axis.
        face.reversed = (at_far == sweep_.turns) != sweep_.reversed;
        for (const std::size_t l : loops) {
            Loop around;
            for (std::size_t i = 0; i < loops_.loops[l].size(); ++i) {
                const auto& flat = rings_[l].curves[i];
                around.coedges.push_back(
                    {(at_far ? rings_[l].far : rings_[l].near)[i], flat.against, flat.curve});
            }
            face.loops.push_back(std::move(around));
        }
        model_.faces.push_back(std::move(face));
        return int(model_.faces.size()) - 1;
    }

    int shell(const std::vector<int>& faces) {
        Shell s;
        s.closed = true;
        for (const int f : faces) s.faces.push_back({f, false});
        model_.shells.push_back(std::move(s));
        return int(model_.shells.size()) - 1;
    }

    Result<void> part(std::size_t outer) {
        const auto inside = InsideQuery::make(std::span(&loops_.loops[outer], 1), gap_);
        if (!inside) return std::unexpected(inside.error());
        std::vector<std::size_t> loops{outer};
        for (std::size_t l = 0; l < loops_.loops.size(); ++l) {
            if (loops_.depth[l] != loops_.depth[outer] + 1) continue;
            const CurveGeometry<2>& c = loops_.loops[l][0];
            if (inside->at(jet<0>(c, domain(c)[0].middle()).value()).place == Place::inside)
                loops.push_back(l);
        }
        Body body;
        body.solid = true;
        std::vector<int> all;
        for (const std::size_t l : loops)
            for (const std::vector<int>& faces : rings_[l].faces) {
                if (sweep_.full) body.shells.push_back(shell(faces));
                all.insert(all.end(), faces.begin(), faces.end());
            }
        if (!sweep_.full) {
            for (const bool at_far : {false, true}) all.push_back(cap(loops, at_far));
            body.shells = {shell(all)};
        }
        model_.bodies.push_back(std::move(body));
        return {};
    }

    const RegionSweep& sweep_;
    const OrientedLoops& loops_;
    double gap_;
    std::vector<Ring> rings_;
    Model model_;
};

}  // namespace

Result<void> each_point(const RegionLoops& region, const std::function<void(const Vec<2>&)>& f) {
    for (std::size_t l = 0; l < region.size(); ++l)
        for (std::size_t c = 0; c < region[l].size(); ++c) {
            const PlaneSpline spline = spline_of(region[l][c]);
            for (const Hom<2>& p : spline.net) f(project(p));
            if (spline.basis == nullptr)
                return refuse(RefusalKind::unsupported, text("loops[", l, "][", c, "]"),
                              "is no spline; write ellipses as rational ones");
        }
    return {};
}

Result<Model> sweep_region(const RegionLoops& region, const RegionSweep& how) {
    Box<2> box;
    if (auto ok = each_point(region, [&](const Vec<2>& p) { box.add(p); }); !ok)
        return std::unexpected(ok.error());
    if (box.is_empty()) return refuse(RefusalKind::no_answer, "loops", "there is no region");
    const double gap = TrimmedSurface::kSlack * box.diagonal();
    const auto loops = orient_loops(region, {gap, gap});
    if (!loops) return std::unexpected(loops.error());
    return Sweeper(how, *loops, gap).model();
}

}  // namespace freiform::detail

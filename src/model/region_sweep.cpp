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
// Parts. Loops of even depth bound a part, with the loops one deeper inside them as holes. Loops do not
// cross, so one point of a hole tells in which: of several that contain it the one next to it has the right
// depth.
#include "region_sweep_detail.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/trim/loops.hpp>
#include <freiform/trim/trimmed_surface.hpp>

#include <algorithm>

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
        std::vector<int> near, far, faces;
    };

    int add(Edge edge) {
        model_.edges.push_back(std::move(edge));
        return int(model_.edges.size()) - 1;
    }

    Vec<2> at(double t, double s) const { return sweep_.turns ? Vec<2>{{s, t}} : Vec<2>{{t, s}}; }

    Result<void> walls(const std::vector<CurveGeometry<2>>& loop) {
        const int n = int(loop.size()), first = int(model_.vertices.size());
        const int step = sweep_.full ? 1 : 2;  // vertices for each start of a curve
        Ring ring;
        std::vector<int> rails;
        std::vector<SweptCurve> swept;
        for (const auto& c : loop) {
            auto made = sweep_.curve(c);
            if (!made) return std::unexpected(made.error());
            const int v = int(model_.vertices.size());
            model_.vertices.push_back({made->start, made->tolerance});
            if (step == 2) model_.vertices.push_back({made->start_far, made->tolerance});
            rails.push_back(add({made->rail, false, sweep_.range, v, v + step - 1, made->tolerance, ""}));
            swept.push_back(*std::move(made));
        }
        for (int i = 0; i < n; ++i) {
            const SweptCurve& c = swept[std::size_t(i)];
            const Interval t = domain(loop[std::size_t(i)])[0];
            const int a = first + i * step, b = first + (i + 1) % n * step;
            ring.near.push_back(add({c.near, false, t, a, b, c.tolerance, ""}));
            ring.far.push_back(sweep_.full ? ring.near.back()
                                           : add({c.far, false, t, a + 1, b + 1, c.tolerance, ""}));
        }
        for (int i = 0; i < n; ++i) {
            const Interval t = domain(loop[std::size_t(i)])[0], s = sweep_.range;
            const auto along = [&](double at_s) { return from_to(t, at(t.lo, at_s), at(t.hi, at_s)); };
            const auto across = [&](double at_t) { return from_to(s, at(at_t, s.lo), at(at_t, s.hi)); };
            const std::size_t k = std::size_t(i);
            Loop around{{{ring.near[k], false, along(s.lo)},
                         {rails[(k + 1) % rails.size()], false, across(t.hi)},
                         {ring.far[k], true, along(s.hi)},
                         {rails[k], true, across(t.lo)}}};
            if (sweep_.turns) {  // (s, t) are (u, v): the same way round is the other way
                std::ranges::reverse(around.coedges);
                for (Coedge& e : around.coedges) e.reversed = !e.reversed;
            }
            Face face;
            face.surface = std::move(swept[k].wall);
            face.reversed = sweep_.reversed;
            face.loops = {std::move(around)};
            ring.faces.push_back(int(model_.faces.size()));
            model_.faces.push_back(std::move(face));
        }
        rings_.push_back(std::move(ring));
        return {};
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
            for (std::size_t i = 0; i < loops_.loops[l].size(); ++i)
                around.coedges.push_back(
                    {(at_far ? rings_[l].far : rings_[l].near)[i], false, loops_.loops[l][i]});
            face.loops.push_back(std::move(around));
        }
        model_.faces.push_back(std::move(face));
        return int(model_.faces.size()) - 1;
    }

    int shell(const std::vector<std::size_t>& loops, std::initializer_list<int> caps) {
        Shell s;
        s.closed = true;
        for (const std::size_t l : loops)
            for (const int f : rings_[l].faces) s.faces.push_back({f, false});
        for (const int f : caps) s.faces.push_back({f, false});
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
        if (sweep_.full)
            for (const std::size_t l : loops) body.shells.push_back(shell({l}, {}));
        else
            body.shells = {shell(loops, {cap(loops, false), cap(loops, true)})};
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
            const bool spline = visit_one(
                [&](const auto& curve) {
                    if constexpr (requires { curve.net(); }) {
                        for (const auto& p : curve.net().flat()) f(project(p));
                        return true;
                    }
                    return false;
                },
                region[l][c]);
            if (!spline)
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

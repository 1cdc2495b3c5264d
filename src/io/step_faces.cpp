// Faces. A face is taken on its surface as it stands: its loops run counter-clockwise in the parameters, and
// the flag `reversed` turns its normal. So the edges of a face whose normal is against that of its surface
// are run through the other way.
#include "step_shape.hpp"
#include "step_tangles.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/model/edge_gap.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

// Relative to the size of the face: parameter curves follow their edges as well as kFollows, or as
// kFollowsRoughly where the tolerance of the file is a thousand times that; those that are further off than
// kHopeless describe another face. At poles and folds, where no method follows, kRough has to do.
constexpr double kFollows = 1e-9, kFollowsRoughly = 1e-7, kHopeless = 0.25, kRough = 1e-3;
// Samples miss the largest value of a smooth function by little: below the tolerance by this factor they are
// believed, of what the file promises.
constexpr double kMargin = 1.5;
// Edges that are off by more than this, of what their parameter curves are asked for, lie beside the surface.
// Those that follow them loosely are off by at most so many times as much (step_trace.cpp).
constexpr double kBeside = 10, kPlain = 2.2;
// Of the tolerance: how far polygons may be from edges that run into themselves, one try after the other.
constexpr double kLoose[] = {1, 4, 16};
constexpr int kLoosest = 1 + int(std::size(kLoose));

// How far a curve is from a sphere, at some places.
double off_sphere(const FoundSphere& sphere, const CurveGeometry<3>& c, Interval on) {
    constexpr int kPlaces = 32;
    double off = 0;
    for (int i = 0; i <= kPlaces; ++i) {
        const Vec<3> p = jet<0>(c, on.lo + on.length() * i / kPlaces).value();
        off = std::max(off, std::abs(norm(p - sphere.centre) - sphere.radius));
    }
    return off;
}

}  // namespace

Result<ShapeReader::SurfaceMade*> ShapeReader::surface(std::uint32_t i) {
    if (const auto known = surfaces_.find(i); known != surfaces_.end()) return known->second.get();
    auto s = geometry_.surface(i);
    if (!s) return std::unexpected(s.error());
    auto made = std::make_unique<SurfaceMade>();
    made->surface = std::move(*s);
    made->chart = std::make_unique<Chart>(made->surface, tolerance_);
    SurfaceMade* at = made.get();
    surfaces_.emplace(i, std::move(made));
    charts_.emplace(at->chart.get(), i);
    return at;
}

double ShapeReader::accuracy_for(double size) const {
    return std::max(kFollows * size, std::min(kFollowsRoughly * size, 1e-3 * tolerance_));
}

bool ShapeReader::is_beside(double gap, double size) const { return gap > kBeside * accuracy_for(size); }

std::vector<CurveGeometry<3>> ShapeReader::images_of(const EdgeMade& made, const Chart& chart) {
    const auto on = charts_.find(&chart);
    if (on == charts_.end() || made.curve == kMissing) return {};
    return geometry_.images(made.curve, on->second);
}

Result<Use> ShapeReader::use_of(const EdgeMade& made, bool forward, const Chart& chart, double size,
                                int loosely) {
    return use_of(made, images_of(made, chart), forward, chart, size, loosely);
}

Result<Use> ShapeReader::use_of(const EdgeMade& made, std::span<const CurveGeometry<3>> images, bool forward,
                                const Chart& chart, double size, int loosely) const {
    const Edge& e = out_.model.edges[std::size_t(made.edge)];
    const double rough = std::max(tolerance_, kRough * size);
    auto t = trace(chart, *e.curve, e.range, accuracy_for(size), rough, images);
    if (!t) return std::unexpected(t.error());
    if (loosely > 1 && is_beside(t->gap, size))
        if (auto polygon = coarse_polygon(chart, *e.curve, e.range, t->curve, t->gap,
                                          std::max(t->gap, kLoose[loosely - 2] * tolerance_)))
            t = std::move(*polygon);
    if (loosely == 1 && is_beside(t->gap, size))
        if (auto plain = trace(chart, *e.curve, e.range, t->gap, rough, images);
            plain && plain->gap <= kPlain * t->gap)
            t = std::move(plain);
    if (strict_ && !t->cut && is_beside(t->gap, size) && t->gap > 2 * off_sphere(*strict_, *e.curve, e.range))
        return refuse(RefusalKind::ill_conditioned, "parameter curve",
                      "runs too near to a pole to be followed");
    if (size > 0 && !(t->gap < kHopeless * size))
        return refuse(RefusalKind::ill_conditioned, "edge",
                      text("lies ", t->gap, " beside the surface; the face has a size of ", size));
    Use u = make_use({made.edge, forward == made.flipped, std::move(t->curve)}, e);
    u.gap = t->gap;
    u.fitted = t->fitted, u.told = t->told;
    return u;
}

Result<void> ShapeReader::add_bound(std::uint32_t i, bool forward, const Chart& chart, double size,
                                    int loosely, LoopBuilder& loops) {
    const bool outer = f_.is(i, Type::FACE_OUTER_BOUND);
    const auto f = Fields::of(f_, i, outer ? Type::FACE_OUTER_BOUND : Type::FACE_BOUND, 3);
    if (!f) return std::unexpected(f.error());
    if (!f->flag(2)) forward = !forward;
    const auto at = f->reference(1, "loop");
    if (!at) return std::unexpected(at.error());
    std::vector<Use> uses;
    // Each edge is followed by itself, by any thread.
    const auto append = [&](std::vector<LoopPiece> pieces) -> Result<void> {
        std::erase_if(pieces, [](const LoopPiece& p) { return p.made.empty; });
        std::vector<std::vector<CurveGeometry<3>>> images;
        for (const LoopPiece& p : pieces) images.push_back(images_of(p.made, chart));
        std::vector<std::optional<Result<Use>>> followed(pieces.size());
        const bool takes_long = chart.is_spline(0) || chart.is_spline(1);
        parallel_for(pieces.size(), takes_long ? 1 : pieces.size(), [&](std::size_t k) {
            followed[k] = use_of(pieces[k].made, images[k], pieces[k].along, chart, size, loosely);
        });
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            auto& u = *followed[k];
            if (!u)
                return refuse(u.error().kind, f_.label(pieces[k].of),
                              text(u.error().where, ": ", u.error().message));
            if (auto ok = accept_gap(pieces[k].of, *u, chart, size); !ok) return ok;
            uses.push_back(std::move(*u));
        }
        return {};
    };
    if (f_.is(*at, Type::VERTEX_LOOP)) {
        const auto g = Fields::of(f_, *at, Type::VERTEX_LOOP, 2);
        const auto v = g ? g->reference(1, "vertex") : Result<std::uint32_t>(std::unexpected(g.error()));
        if (!v) return std::unexpected(v.error());
        const auto made = vertex(*v);
        if (!made) return std::unexpected(made.error());
        loops.add_vertex(*made);
        return {};
    }
    if (f_.is(*at, Type::POLY_LOOP)) {
        const auto made = polygon_edges(*at, forward);
        if (!made) return std::unexpected(made.error());
        std::vector<LoopPiece> pieces;
        for (const EdgeMade& e : *made) pieces.push_back({e, true, *at});
        if (auto ok = append(std::move(pieces)); !ok) return ok;
    } else {
        const auto g = Fields::of(f_, *at, Type::EDGE_LOOP, 2);
        if (!g) return std::unexpected(g.error());
        auto ids = g->references(1, "edges");
        if (!ids) return std::unexpected(ids.error());
        if (!forward) std::reverse(ids->begin(), ids->end());
        std::vector<Oriented> around;
        for (const std::uint32_t id : *ids) {
            const auto o = Fields::of(f_, id, Type::ORIENTED_EDGE, 5);
            if (!o) return std::unexpected(o.error());
            const auto of = o->reference(3, "edge");
            if (!of) return std::unexpected(of.error());
            const auto made = edge(*of);
            if (!made) return std::unexpected(made.error());
            around.push_back({id, *of, {made->begin(), made->end()}, o->flag(4) == forward});
        }
        turn_edges(around);
        std::vector<LoopPiece> pieces;
        for (const Oriented& e : around)
            for (std::size_t k = 0; k < e.made.size(); ++k)
                pieces.push_back({e.made[e.along ? k : e.made.size() - 1 - k], e.along, e.edge});
        fold_twins(pieces);
        if (auto ok = append(std::move(pieces)); !ok) return ok;
    }
    if (uses.empty()) return {};
    if (auto ok = close_loop(*at, uses, chart, size, loosely); !ok) return ok;
    loops.add(std::move(uses));
    return {};
}

// The loops of the face, its surface over all of them, and what its parameter curves miss. `tangled`: asks
// whether they run into themselves where edges lie beside the surface; if so, nothing is made.
Result<Face> ShapeReader::close_face(Face face, LoopBuilder& loops, const Chart& chart, std::uint32_t i,
                                     double size, bool* tangled) {
    Model& m = out_.model;
    const std::size_t edges = m.edges.size(), vertices = m.vertices.size();
    auto made = loops.finish();
    if (!made) return std::unexpected(made.error());
    tell_turn(i, loops);
    const bool beside = std::ranges::any_of(*made, [&](const auto& uses) {
        return std::ranges::any_of(uses, [&](const Use& u) { return is_beside(u.gap, size); });
    });
    if (tangled != nullptr && beside && is_tangled(*made, m, chart)) {
        *tangled = true;
        m.edges.resize(edges), m.vertices.resize(vertices);  // without its seams
        return refuse(RefusalKind::invalid, f_.label(i), "has a boundary that runs into itself");
    }
    Box<2> box;
    bool prove = false;
    for (const auto& uses : *made)
        for (const Use& u : uses) {
            const Edge& e = out_.model.edges[std::size_t(u.coedge.edge)];
            for (int k = 0; k <= 4; ++k)
                box.add(jet<0>(u.coedge.curve, e.range.lo + e.range.length() * k / 4).value());
            prove = prove || u.fitted || u.told || kMargin * u.gap > e.tolerance;
        }
    face.surface = unwound(chart.surface(), chart, box);
    std::optional<DerivativeQuery<2, 3>> query;
    if (prove) query.emplace(face.surface);
    out_.released.insert(out_.released.end(), loops.released.begin(), loops.released.end());
    if (!loops.note.empty())
        report(-1, text(f_.label(i), ": ", loops.note),
               loops.note_off > 0 ? std::nullopt : std::optional(0.0), loops.note_off);
    for (auto& uses : *made) {
        Loop loop;
        for (Use& u : uses) {
            if (auto ok = check(u.coedge.curve); !ok)
                return refuse(ok.error().kind, "parameter curve", ok.error().message);
            Edge& e = out_.model.edges[std::size_t(u.coedge.edge)];
            const bool beyond = kMargin * u.gap > e.tolerance;
            if ((u.fitted || u.told || beyond) && e.curve) {
                EdgeGapOptions options;
                options.target = std::max(e.tolerance, u.fitted ? accuracy_for(size) : 0);
                options.factor = 2;
                options.max_samples = 4000;
                const EdgeGap gap = edge_gap(*query, u.coedge.curve, *e.curve, e.range, options);
                // What closes a loop may move a parameter curve.
                if (size > 0 && !options_.repair && is_far(gap.found, size))
                    return far_beside("edge", gap.found, size);
                const double found = std::max(u.gap, gap.found);
                const bool proven = std::isfinite(gap.bound);
                const double distance = proven ? gap.bound : kMargin * found;
                std::string what;
                if (u.fitted)
                    what = text("its parameter curve on ", f_.label(i), " is a spline that follows it");
                if (distance > e.tolerance)
                    what += text(what.empty() ? "" : ", and ", "it lies up to ", found, " beside ",
                                 f_.label(i), "; the file says at most ", tolerance_);
                if (!what.empty())
                    report(u.coedge.edge, std::move(what),
                           proven ? std::optional<double>(gap.bound) : std::nullopt, distance);
                e.tolerance = std::max(e.tolerance, distance);
            }
            loop.coedges.push_back(std::move(u.coedge));
        }
        face.loops.push_back(std::move(loop));
    }
    return face;
}

// The extent of the edges of a face, from points on them. `used`: the edges, as often as they are used.
Result<double> ShapeReader::size_of(const Fields& f, std::vector<Vec<3>>& seen, std::vector<int>& used) {
    Box<3> box;
    const auto bounds = f.references(1, "bounds");
    if (!bounds) return std::unexpected(bounds.error());
    for (const std::uint32_t b : *bounds) {
        const bool outer = f_.is(b, Type::FACE_OUTER_BOUND);
        const auto g = Fields::of(f_, b, outer ? Type::FACE_OUTER_BOUND : Type::FACE_BOUND, 3);
        if (!g) return std::unexpected(g.error());
        const auto at = g->reference(1, "loop");
        if (!at) return std::unexpected(at.error());
        if (f_.is(*at, Type::POLY_LOOP)) {
            const auto ids = corners_of(*at);
            if (!ids) return std::unexpected(ids.error());
            for (const std::uint32_t id : *ids)
                if (const auto p = geometry_.point(id)) box.add(*p);
            continue;
        }
        if (!f_.is(*at, Type::EDGE_LOOP)) continue;
        const auto ids = Fields(f_, *at, f_.part(*at, Type::EDGE_LOOP)).references(1, "edges");
        if (!ids) return std::unexpected(ids.error());
        for (const std::uint32_t id : *ids) {
            const auto o = Fields::of(f_, id, Type::ORIENTED_EDGE, 5);
            if (!o) return std::unexpected(o.error());
            const auto of = o->reference(3, "edge");
            if (!of) return std::unexpected(of.error());
            const auto made = edge(*of);
            if (!made) return std::unexpected(made.error());
            for (const EdgeMade& part : *made) {
                if (part.empty) continue;
                used.push_back(part.edge);
                const Edge& e = out_.model.edges[std::size_t(part.edge)];
                const int n = std::holds_alternative<Line<3>>(*e.curve) ? 1 : 6;
                for (int k = 0; k <= n; ++k)
                    seen.push_back(jet<0>(*e.curve, e.range.lo + e.range.length() * k / n).value());
            }
        }
    }
    for (const Vec<3>& p : seen) box.add(p);
    return box.diagonal();
}

// A face, or a part of one: bounds of its own on the surface of another.
Result<Face> ShapeReader::make_face(std::uint32_t i, std::uint32_t whole, Type type) {
    const auto f = whole == i ? Fields::of(f_, i, type, 4) : Fields::of(f_, i, Type::SUBFACE, 3);
    if (!f) return std::unexpected(f.error());
    const auto of = Fields::of(f_, whole, type, 4);
    if (!of) return std::unexpected(of.error());
    const auto on = of->reference(2, "surface");
    if (!on) return std::unexpected(on.error());
    const auto bounds = f->references(1, "bounds");
    if (!bounds) return std::unexpected(bounds.error());
    const auto s = surface(*on);
    if (!s) return std::unexpected(s.error());
    bool same = of->flag(3);
    std::vector<Vec<3>> on_edges;
    std::vector<int> used;
    const auto size = size_of(*f, on_edges, used);
    if (!size) return std::unexpected(size.error());
    const std::size_t repairs = out_.model.repairs.size(), told = out_.approximated.size();
    const auto once = [&](const Chart& chart, int loosely, bool* tangled) -> Result<Face> {
        LoopBuilder loops(chart, out_.model, tolerance_);
        loops.wrong_way = options_.repair ? LoopBuilder::WrongWay::turned : LoopBuilder::WrongWay::told;
        out_.model.repairs.resize(repairs);  // without what another attempt said
        out_.model.approximations.resize(told), out_.approximated.resize(told);
        turned_now_.reset();
        twins_now_.clear();
        for (const std::uint32_t b : *bounds)
            if (auto ok = add_bound(b, same, chart, *size, loosely, loops); !ok)
                return std::unexpected(ok.error());
        Face face;
        face.reversed = !same;
        face.tolerance = tolerance_;
        return close_face(std::move(face), loops, chart, i, *size, tangled);
    };
    const auto attempt = [&](const Chart& chart) -> Result<Face> {
        bool tangled = false;
        auto made = once(chart, 0, &tangled);
        if (!tangled) return made;
        for (int loosely = 1; loosely <= kLoosest && !made; ++loosely) made = once(chart, loosely, &tangled);
        if (!made) return once(chart, 0, nullptr);
        report(-1,
               text(f_.label(i),
                    ": its boundary runs into itself where edges lie beside the surface; its "
                    "parameter curves follow those less closely"),
               0.0, 0);
        return made;
    };
    if (const auto own = own_plane(i, *on)) {
        same = true;
        auto made = attempt(Chart(*own, tolerance_));
        if (made)
            report(-1,
                   text(f_.label(i), ": polygons miss ", f_.label(*on),
                        "; the plane through its corners stands for that"),
                   0.0, 0);
        return made;
    }
    if (const auto half = other_half(*(*s)->chart, used)) return attempt(Chart(*half, tolerance_));
    const Chart& chart = chart_of(**s, *on, used);
    strict_ = sphere_of(chart, tolerance_);
    auto made = attempt(chart);
    if (&chart != (*s)->chart.get()) {
        if (made)
            tell_seam(i, chart, used);
        else
            made = attempt(*(*s)->chart);
    }
    if (!made)
        if (const auto turned = other_poles(chart, used)) {
            same = same != turned->inwards;
            if (auto again = attempt(Chart(turned->surface, tolerance_))) {
                made = std::move(again);
                if (turned->off > 0)
                    report(-1, text(f_.label(i), ": a sphere stands for its surface"), turned->off,
                           turned->off);
            }
            same = same != turned->inwards;
        }
    if (std::exchange(strict_, std::nullopt) && !made) made = attempt(chart);
    if (!made) out_.model.repairs.resize(repairs), turned_now_.reset();
    return made;
}

int ShapeReader::face(std::uint32_t i) {
    if (const auto known = faces_.find(i); known != faces_.end()) return known->second;
    const auto whole = whole_of(i, Type::SUBFACE, 2);
    Type type = Type::unknown;
    for (const Type t : {Type::ADVANCED_FACE, Type::FACE_SURFACE})
        if (whole && f_.is(*whole, t)) type = t;
    auto made = !whole                  ? std::unexpected(whole.error())
                : type != Type::unknown ? make_face(i, *whole, type)
                                        : bare_face(i);
    int at = -1;
    if (!made) {
        twins_now_.clear();
        refuse_item(i, made.error());
    } else {
        const Fields f(f_, i, f_.instances[i].first + 1);
        made->name = name_in(f);
        made->colour = colour_of(i);
        styles_.add_layers(made->layers, i);
        at = int(out_.model.faces.size());
        twins_.merge(std::exchange(twins_now_, {}));
        if (turned_now_) turned_.emplace(at, *std::exchange(turned_now_, std::nullopt));
        out_.model.faces.push_back(std::move(*made));
    }
    faces_.emplace(i, at);
    return at;
}

}  // namespace freiform::step

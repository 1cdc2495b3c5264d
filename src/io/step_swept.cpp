// Solids that are said by what sweeps them: plane regions along a direction or about an axis, and discs along
// a curve.
//
// Idea. A region is read as a face is, its edges are projected into its plane, and prism, solid_of_revolution
// and solid_along (model/swept_solid.hpp) make the solid; then it is put where the plane is. So walls are
// planes, cylinders, cones, spheres and tori where they can be, and exact. Only discs along curves other than
// lines and circles have walls that are splines within the tolerance, which is told.
//
// The parameters between which a directrix is used are those of the curve that was trimmed, or count from
// its start; programs write both, and lengths, too. Where neither fits, all of the directrix is meant.
//
// References: ISO 10303-42:2014, 6.4 (extruded_area_solid, revolved_area_solid, swept_disk_solid).
#include "step_swept.hpp"

#include "step_shape.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/make/conic.hpp>
#include <freiform/make/image_curve.hpp>
#include <freiform/model/swept_solid.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace freiform::step {

namespace {

constexpr double kWholeTurn = 2 * std::numbers::pi, kRoundings = 8, kMoved = 64;
constexpr double kAll = 1e-6;        // of its parameters: a row is asked for from end to end
constexpr double kTurnsMiss = 1e-5;  // radians: an angle that is a turn but for its digits
constexpr double kFine = 1e-7;       // of the size: walls that are splines are not asked to be nearer

// Coordinates, without those that are but the rounding of zero.
Vec<3> seen_from(const Placement& frame, const Vec<3>& d) {
    Vec<3> out{{dot(d, frame.x), dot(d, frame.y), dot(d, frame.z)}};
    for (int k = 0; k < 3; ++k)
        if (std::abs(out[k]) <= kRoundings * kUnitRoundoff * norm(d)) out[k] = 0;
    return out;
}

// Its shadow in z = 0, which is at most `off` away.
CurveGeometry<2> flattened(const CurveGeometry<3>& spline, double& off) {
    const auto shadow = [&]<class Flat>(const auto& c, auto&& of) -> CurveGeometry<2> {
        std::vector<Flat> net;
        for (const auto& p : c.net().flat()) {
            off = std::max(off, std::abs(project(p)[2]));
            net.push_back(of(p));
        }
        return Curve<Flat>::trusted(c.bases(), Net<1, Flat>(c.net().extent(), std::move(net)));
    };
    if (const auto* c = std::get_if<Curve<Vec<3>>>(&spline))
        return shadow.operator()<Vec<2>>(*c, [](const Vec<3>& p) { return Vec<2>{{p[0], p[1]}}; });
    return shadow.operator()<Hom<2>>(std::get<Curve<Hom<3>>>(spline), [](const Hom<3>& p) {
        return weighted(Vec<2>{{project(p)[0], project(p)[1]}}, p.weight());
    });
}

CurveGeometry<2> backwards(const CurveGeometry<2>& spline) {
    if (const auto* c = std::get_if<Curve<Vec<2>>>(&spline)) return reverse(*c, 0);
    return reverse(std::get<Curve<Hom<2>>>(spline), 0);
}

// Of a polyline each side.
void add_sides(std::vector<CurveGeometry<2>>& loop, CurveGeometry<2> spline) {
    const auto* c = std::get_if<Curve<Vec<2>>>(&spline);
    if (c == nullptr || c->basis().degree() != 1) return loop.push_back(std::move(spline));
    const auto& corners = c->net().flat();
    for (std::size_t k = 0; k + 1 < corners.size(); ++k)
        if (corners[k] != corners[k + 1]) loop.push_back(segment(corners[k], corners[k + 1]));
}

// The last control point of a spline that ends there, and how far that is away.
double end_at(CurveGeometry<2>& curve, const Vec<2>& p) {
    return visit_one(
        [&](auto& c) -> double {
            if constexpr (requires { c.net(); }) {
                auto net = c.net();
                auto& last = net.flat().back();
                using Point = std::remove_cvref_t<decltype(last)>;
                const double off = norm(project(last) - p);
                last = Space<Point>::lift(p, Space<Point>::weight(last));
                c = std::remove_cvref_t<decltype(c)>::trusted(c.bases(), std::move(net));
                return off;
            }
            return 0;
        },
        curve);
}

// Polylines as lines, all else as it is.
void add_rail(const CurveGeometry<3>& c, Interval on, bool backward, std::vector<RailPart>& out) {
    const auto* polyline = std::get_if<Curve<Vec<3>>>(&c);
    if (polyline == nullptr || polyline->basis().degree() != 1) return out.push_back({c, on, backward});
    std::vector<double> at{on.lo};
    for (const double t : polyline->basis().breaks())
        if (at.back() < t && t < on.hi) at.push_back(t);
    at.push_back(on.hi);
    std::vector<Vec<3>> corners;
    for (const double t : at) corners.push_back(jet<0>(c, t).value());
    if (backward) std::ranges::reverse(corners);
    for (std::size_t k = 0; k + 1 < corners.size(); ++k)
        if (const Vec<3> way = corners[k + 1] - corners[k]; norm(way) > 0)
            out.push_back({Line<3>{corners[k], way}, {0, 1}, false});
}

double reach_of(const RegionLoops& loops, const Vec<2>& from) {
    double most = 0;
    for (const auto& loop : loops)
        for (const auto& c : loop)
            visit_one(
                [&](const auto& g) {
                    if constexpr (requires { g.net(); })
                        for (const auto& p : g.net().flat()) most = std::max(most, norm(project(p) - from));
                },
                c);
    return most;
}

}  // namespace

CurveGeometry<2> segment(const Vec<2>& a, const Vec<2>& b) {
    return Curve<Vec<2>>::trusted({*BSplineBasis::bezier(1)}, Net<1, Vec<2>>({2}, {a, b}));
}

Result<std::vector<CurveGeometry<2>>> circle_about(const Vec<2>& centre, double radius) {
    const auto made = circle(centre, radius);
    if (!made) return std::unexpected(made.error());
    const auto arc = conic_arc(*made, {0, kWholeTurn});
    if (!arc) return std::unexpected(arc.error());
    return std::vector<CurveGeometry<2>>{arc->curve};
}

// A region with the frame that its plane is z = 0 of.
Result<ShapeReader::SweptRegion> ShapeReader::swept_region(std::uint32_t i) {
    Type type = Type::unknown;
    for (const Type t : {Type::ADVANCED_FACE, Type::FACE_SURFACE})
        if (f_.is(i, t)) type = t;
    const std::size_t edges = out_.model.edges.size();
    const auto face = type != Type::unknown ? make_face(i, i, type) : bare_face(i);
    turned_now_.reset();
    for (std::size_t e = edges; e < out_.model.edges.size(); ++e) out_.released.push_back(int(e));
    if (!face) return std::unexpected(face.error());
    const auto* plane = std::get_if<Extrusion>(&face->surface);
    const auto* line = plane != nullptr ? std::get_if<Line<3>>(&plane->profile) : nullptr;
    if (line == nullptr || plane->kind != SurfaceKind::plane)
        return refuse(RefusalKind::unsupported, f_.label(i), "is not in a plane; only plane faces are swept");
    SweptRegion out;
    out.frame = {line->origin, line->direction, plane->direction, cross(line->direction, plane->direction)};
    const Motion down = motion_from(out.frame);
    std::set<int> used;
    for (const Loop& l : face->loops) {
        auto& loop = out.loops.emplace_back();
        for (const Coedge& c : l.coedges) {
            const Edge& e = out_.model.edges[std::size_t(c.edge)];
            used.insert(c.edge);
            if (e.degenerate || !e.curve) continue;
            const auto spline = space_spline(moved(*e.curve, down), e.range);
            if (!spline) return std::unexpected(spline.error());
            CurveGeometry<2> flat = flattened(*spline, out.off);
            add_sides(loop, c.reversed ? backwards(flat) : std::move(flat));
        }
    }
    // What is told of an edge is true of the solid, whose edges are others.
    for (std::size_t k = 0; k < out_.approximated.size(); ++k)
        if (used.contains(out_.approximated[k])) {
            out_.approximated[k] = -1;
            out_.model.approximations[k].where = f_.label(i);
        }
    double joint = 0;
    for (auto& loop : out.loops)
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const CurveGeometry<2>& next = loop[(k + 1) % loop.size()];
            joint = std::max(joint, end_at(loop[k], jet<0>(next, domain(next)[0].lo).value()));
        }
    out.off += joint;
    return out;
}

Result<ShapeReader::SweptModel> ShapeReader::swept_by(const Fields& f, bool turns) {
    const auto of = f.reference(1, "swept area"), by = f.reference(2, turns ? "axis" : "direction");
    const auto most = f.number(3, turns ? "angle" : "depth");
    if (!of || !by || !most) return std::unexpected(!of ? of.error() : !by ? by.error() : most.error());
    const auto region = swept_region(*of);
    if (!region) return std::unexpected(region.error());
    const auto named = [&](const Refusal& r) {
        return refuse(r.kind,
                      r.where == "by"     ? "its direction"
                      : r.where == "axis" ? "its axis"
                                          : r.where,
                      r.message);
    };
    SweptModel out;
    out.to = motion_to(region->frame);
    out.off = region->off;
    if (!turns) {
        const auto d = geometry_.direction(*by);
        if (!d) return std::unexpected(d.error());
        if (!(*most > 0)) return f.refused(text("has the depth ", *most), RefusalKind::invalid);
        auto made = prism(region->loops, *most * seen_from(region->frame, *d));
        if (!made) return named(made.error());
        out.model = *std::move(made);
        return out;
    }
    const auto at = geometry_.placement(*by);
    if (!at) return std::unexpected(at.error());
    Axis axis{seen_from(region->frame, at->o - region->frame.o), seen_from(region->frame, at->z)};
    const double reach = reach_of(region->loops, {{axis.origin[0], axis.origin[1]}});
    double angle = *most * geometry_.angle;
    // What leaves the plane by less than the tolerance is in it. Turns about two axes through a point differ
    // by (1 + sqrt 2) times what their directions do, and by twice what the axes are apart.
    const double leaves = std::abs(axis.origin[2]) + std::abs(axis.direction[2]) * reach,
                 misses = std::abs(angle - kWholeTurn) * reach;
    if (leaves > 0 && leaves <= tolerance_) axis.origin[2] = axis.direction[2] = 0, out.off += 2.5 * leaves;
    // An angle of few digits may be more than a turn.
    if (misses > 0 && misses <= std::max(tolerance_, kTurnsMiss * reach))
        angle = kWholeTurn, out.off += misses;
    auto made = solid_of_revolution(region->loops, axis, angle);
    if (!made) return named(made.error());
    out.model = *std::move(made);
    return out;
}

// What the directrix consists of, as its solid uses it.
Result<std::vector<RailPart>> ShapeReader::rail_of(const Fields& f, std::uint32_t item) {
    auto at = f.reference(1, "directrix");
    if (!at) return std::unexpected(at.error());
    std::uint32_t composite = composite_in(f_, *at);
    for (; composite != kMissing; composite = composite_in(f_, *at)) {
        const auto segments = segments_in(f_, composite);
        if (!segments) return std::unexpected(segments.error());
        if (segments->size() != 1 || items_left_ == 0) break;
        --items_left_;
        at = segments->front().curve;
    }
    if (composite == kMissing) {
        const auto c = directrix(f, item, *at);
        if (!c) return std::unexpected(c.error());
        std::vector<RailPart> out;
        add_rail(c->curve, *c->range, false, out);
        return out;
    }
    auto row = segments_of(composite);
    if (!row) return std::unexpected(row.error());
    turn_segments(*row, tolerance_);
    double sum = 0;  // the parameters of a row count on
    std::vector<RailPart> out;
    for (const Segment& s : *row) {
        sum += s.on.length();
        add_rail(s.shape, s.on, s.backward, out);
    }
    if (f.is_omitted(4) && f.is_omitted(5)) return out;
    const auto from = f.number(4, "start parameter"), to = f.number(5, "end parameter");
    if (!from || !to) return std::unexpected(from ? to.error() : from.error());
    const double given = *to - *from;
    if (std::abs(given - sum) > kAll * sum && given != double(row->size()))
        report(-1,
               text(f_.label(item), ": its directrix of ", row->size(), " segments is asked for from ", *from,
                    " to ", *to, "; all of it is swept"),
               0.0, 0);
    return out;
}

// The part of a directrix of one curve that its solid uses.
Result<BoundedCurve> ShapeReader::directrix(const Fields& f, std::uint32_t item, std::uint32_t curve) {
    auto c = curve_in_space(curve, nullptr);
    if (!c) return c;
    const Interval whole = domain(c->curve)[0], given = c->range.value_or(whole);
    const auto* conic = std::get_if<Conic<3>>(&c->curve);
    const bool goes_round = conic != nullptr && conic->kind == ConicKind::ellipse;
    if (f.is_omitted(4) && f.is_omitted(5)) {
        c->range = given;
    } else {
        const auto from = f.number(4, "start parameter"), to = f.number(5, "end parameter");
        if (!from || !to) return std::unexpected(from ? to.error() : from.error());
        const bool angles = c->has_angles || goes_round;
        const double unit = angles ? geometry_.angle : 1;
        const Interval on{*from * unit, *to * unit};
        if (!(on.lo < on.hi))
            return f.refused(text("is swept from ", *from, " to ", *to), RefusalKind::invalid);
        const double slack = 1e-9 * on.length();
        const auto fits = [&](Interval part) {
            return part.lo >= given.lo - slack && part.hi <= given.hi + slack;
        };
        const Interval later = c->reversed ? Interval{given.hi - on.hi, given.hi - on.lo}
                                           : Interval{given.lo + on.lo, given.lo + on.hi};
        const bool is_whole = goes_round && !c->range;
        c->range = given;
        if (is_whole && on.length() <= kWholeTurn + slack)  // from anywhere, over the seam
            c->range = on;
        else if (fits(on) && !c->reversed)
            c->range = {std::max(on.lo, given.lo), std::min(on.hi, given.hi)};
        else if (fits(later))
            c->range = {std::max(later.lo, given.lo), std::min(later.hi, given.hi)};
        else
            report(-1,
                   text(f_.label(item), ": its directrix has no parameters from ", *from, " to ", *to,
                        "; all of it is swept"),
                   0.0, 0);
    }
    if (!std::isfinite(c->range->length()) || !(c->range->lo < c->range->hi))
        return f.refused("has a directrix without an end", RefusalKind::invalid);
    if (goes_round) c->range->hi = std::min(c->range->hi, c->range->lo + kWholeTurn);
    return c;
}

Result<ShapeReader::SweptModel> ShapeReader::swept_disc(const Fields& f, std::uint32_t item) {
    const auto radius = f.number(2, "radius");
    const auto hole = f.is_omitted(3) ? Result<double>(0) : f.number(3, "inner radius");
    if (!radius || !hole) return std::unexpected(radius ? hole.error() : radius.error());
    if (!(*hole >= 0 && *hole < *radius))
        return f.refused(text("has the radii ", *radius, " and ", *hole), RefusalKind::invalid);
    const auto rail = rail_of(f, item);
    if (!rail) return std::unexpected(rail.error());
    SweptModel out;
    auto exact = pipe(*rail, *radius, *hole, tolerance_);
    if (exact) {
        out.model = *std::move(exact);
        return out;
    }
    if (rail->size() > 1 || is_line_or_circle(rail->front().curve)) {
        const Refusal& r = exact.error();
        const bool of_rail = r.where.starts_with("rail");
        return refuse(r.kind, of_rail ? text("its directrix", r.where.substr(4)) : r.where, r.message);
    }
    RegionLoops ring;
    for (const double r : {*radius, *hole}) {
        if (r == 0) continue;
        auto loop = circle_about({}, r);
        if (!loop) return std::unexpected(loop.error());
        ring.push_back(*std::move(loop));
    }
    const auto spline = space_spline(rail->front().curve, rail->front().on);
    if (!spline) return std::unexpected(spline.error());
    const auto* plain = std::get_if<Curve<Vec<3>>>(&*spline);
    const auto along = plain != nullptr ? to_rational(*plain) : std::get<Curve<Hom<3>>>(*spline);
    Box<3> box;
    for (const Hom<3>& p : along.net().flat()) box.add(project(p));
    auto made = solid_along(ring, along, {.tolerance = std::max(tolerance_, kFine * box.diagonal())});
    if (!made) return std::unexpected(made.error());
    out.off = made->bound;
    out.model = std::move(made->model);
    return out;
}

bool ShapeReader::add_swept(std::uint32_t item) {
    std::uint32_t at = item;
    if (f_.is(item, Type::CSG_SOLID)) {
        const auto root = Fields(f_, item, f_.part(item, Type::CSG_SOLID)).reference(1, "root");
        if (!root) return refuse_item(item, root.error()), true;
        at = *root;
    }
    for (const Type t :
         {Type::EXTRUDED_AREA_SOLID, Type::EXTRUDED_FACE_SOLID, Type::REVOLVED_AREA_SOLID,
          Type::REVOLVED_FACE_SOLID, Type::SWEPT_DISK_SOLID, Type::BLOCK, Type::RIGHT_ANGULAR_WEDGE,
          Type::RIGHT_CIRCULAR_CYLINDER, Type::RIGHT_CIRCULAR_CONE, Type::SPHERE, Type::TORUS}) {
        if (!f_.is(at, t)) continue;
        const auto f = Fields::of(f_, at, t, t == Type::SPHERE ? 3 : 4);
        auto made = !f ? std::unexpected(f.error())
                    : t == Type::EXTRUDED_AREA_SOLID || t == Type::EXTRUDED_FACE_SOLID ? swept_by(*f, false)
                    : t == Type::REVOLVED_AREA_SOLID || t == Type::REVOLVED_FACE_SOLID ? swept_by(*f, true)
                    : t == Type::SWEPT_DISK_SOLID                                      ? swept_disc(*f, at)
                                                                                       : primitive(*f, t);
        if (made)
            take(item, *std::move(made));
        else
            refuse_item(item, made.error());
        return true;
    }
    return false;
}

// The solids of a sweep, in its frame, as those of an item.
void ShapeReader::take(std::uint32_t item, SweptModel made) {
    Model& m = out_.model;
    const int vertices = int(m.vertices.size()), edges = int(m.edges.size()), faces = int(m.faces.size()),
              shells = int(m.shells.size());
    Box<3> box;
    for (const Vertex& v : made.model.vertices) {
        m.vertices.push_back({made.to.point(v.point), v.tolerance});
        box.add(v.point);
    }
    for (Edge& e : made.model.edges) {
        if (e.curve) e.curve = moved(*e.curve, made.to);
        e.start += vertices, e.end += vertices;
        m.edges.push_back(std::move(e));
    }
    for (Face& f : made.model.faces) {
        f.surface = moved(f.surface, made.to);
        for (Loop& l : f.loops)
            for (Coedge& c : l.coedges) c.edge += edges;
        m.faces.push_back(std::move(f));
    }
    for (Shell& s : made.model.shells) {
        for (FaceUse& u : s.faces) u.face += faces;
        m.shells.push_back(std::move(s));
    }
    for (Body& b : made.model.bodies) {
        for (int& s : b.shells) s += shells;
        body_of(item, std::move(b.shells), true, {});
    }
    if (made.off > accuracy_for(box.scale()))
        report(-1, text(f_.label(item), ": a solid near it stands for it"),
               made.off + kMoved * kUnitRoundoff * (box.scale() + max_abs(made.to.to.o)), 0);
}

}  // namespace freiform::step

// Notation. A joint: the place o where a part begins, its direction t there, and directions e, f across, t =
// e x f. e is carried along: it stays on lines, and arcs turn it about their axis, so that the point o + r e
// draws a line or a circle on each wall, which is the wall's seam. Walls between joints j and j + 1 run from
// the circle o_j + r (cos u e_j + sin u f_j):
//     cylinder  S(u, v) = circle(u) + v t
//     torus     S(u, v) = the circle from its outermost point over the arc's axis, turned by u
// with normals outwards. On tori the circle runs the other way: with out = (o - centre) / bend, t = axis x
// out and e = cos(w) out + sin(w) axis it is at v = w - u.
//
// Accuracy. A wall ends at the circle that its part carries there; the edge is the circle of the next joint.
// With joints d apart, directions t and t' of unit length, and e' the part of e across t', circles of radius
// r are no more than d + 4 r |t - t'| apart at equal angles: |e - e'| <= 2 |t - t'|, as the part of e along
// t' is e . (t' - t), and |f - f'| <= 3 |t - t'|. Rounding: every number comes from few operations with those
// of the part, and circles are such but for 2^-46 of their radius: 2^-44 of what is farthest.
//
// Why not prism and solid_of_revolution for each part: what they have at both of their ends would have to be
// taken away, and their edges joined.
#include <freiform/core/constants.hpp>
#include <freiform/model/pipe.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace freiform {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kRounding = 0x1p-44;
constexpr double kNothing = 0x1p-36;   // of what is farthest: circles may always be so far apart at joints
constexpr double kCircle = 0x1p-46;    // of its radius: how far an ellipse is from being a circle
constexpr double kStraight = 0x1p-40;  // the sine of a corner that is none

// A part as it is run through.
struct Run {
    bool turns = false;
    Vec<3> from{}, to{}, along{};  // `along`: the direction at the beginning
    double length = 0;             // of a line
    Vec<3> centre{}, axis{};       // of an arc, which turns counter-clockwise about it
    double angle = 0, bend = 0;    // likewise, and its radius

    Vec<3> turned(const Vec<3>& d) const {
        if (!turns) return d;
        const Vec<3> part = dot(axis, d) * axis;
        return part + std::cos(angle) * (d - part) + std::sin(angle) * cross(axis, d);
    }
};

Result<Run> run_of(const RailPart& part, std::size_t i) {
    const auto where = [&] { return text("rail[", i, "]"); };
    if (auto ok = check(part.curve); !ok) return refuse(ok.error().kind, where(), ok.error().message);
    if (!(part.on.lo < part.on.hi) || !std::isfinite(part.on.length()))
        return refuse(RefusalKind::invalid, where(), "has no length, or no end");
    Run run;
    const auto ends = std::array{jet<1>(part.curve, part.on.lo), jet<1>(part.curve, part.on.hi)};
    const auto& first = ends[part.reversed ? 1 : 0];
    run.from = first.value(), run.to = ends[part.reversed ? 0 : 1].value();
    run.along = (part.reversed ? -1.0 : 1.0) * unit(first.d[1]);
    if (std::holds_alternative<Line<3>>(part.curve)) {
        run.length = norm(run.to - run.from);
        if (!(run.length > 0)) return refuse(RefusalKind::invalid, where(), "has no length");
        return run;
    }
    if (!is_line_or_circle(part.curve))
        return refuse(RefusalKind::unsupported, where(), "is neither a line nor an arc of a circle");
    const auto* c = &std::get<Conic<3>>(part.curve);
    run.turns = true, run.centre = c->centre, run.bend = norm(c->x), run.angle = part.on.length();
    run.axis = (part.reversed ? -1.0 : 1.0) * unit(cross(c->x, c->y));
    if (!(run.angle <= kTurn * (1 + kRounding)))
        return refuse(RefusalKind::invalid, where(), "is more than a full turn");
    return run;
}

struct Joint {
    Vec<3> o{}, t{}, e{}, f{};
    double off = 0;  // of the circles that meet there
};

Vec<3> any_across(const Vec<3>& t) {
    int least = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(t[k]) < std::abs(t[least])) least = k;
    Vec<3> d;
    d[least] = 1;
    return unit(cross(d, t));
}

class Builder {
public:
    Builder(std::vector<Run> runs, double joint) : runs_(std::move(runs)), joint_(joint) {}

    // Of circles with this radius, the larger one.
    Result<void> join(double radius) {
        double far = radius;
        for (const Run& r : runs_) far = std::max({far, max_abs(r.from), max_abs(r.to), max_abs(r.centre)});
        rounding_ = kRounding * (far + radius);
        const Run& last = runs_.back();
        const double misses = norm(last.to - runs_.front().from);
        const double most = joint_ + kNothing * (far + radius);
        closed_ = misses <= most && (runs_.size() > 1 || last.turns);
        Vec<3> e = first_across();
        for (std::size_t i = 0; i <= runs_.size(); ++i) {
            const bool at_end = i == runs_.size();
            const Run* before = i > 0 ? &runs_[i - 1] : nullptr;
            if (before != nullptr) e = before->turned(e);
            const Vec<3> carried = before != nullptr ? before->turned(before->along) : Vec<3>{};
            Joint j;
            j.o = at_end ? last.to : runs_[i].from;
            j.t = at_end ? carried : runs_[i].along;
            if (at_end && closed_) j = joints_.front();
            if (before != nullptr) {
                const double apart = norm(before->to - j.o), turn = norm(carried - j.t);
                const double off = apart + 4 * radius * turn;
                if (!(off <= most))
                    return refuse(RefusalKind::invalid, text("rail[", i - 1, "]"),
                                  text("ends ", apart, " from where ", at_end ? "the first" : "the next",
                                       " part begins, and turns by ", turn, " there"));
                if (at_end && closed_) {
                    const double back = radius * norm(e - j.e);
                    if (!(off + back <= most))
                        return refuse(
                            RefusalKind::unsupported, "rail",
                            text("ends where it begins, and the disc comes back turned by ", norm(e - j.e)));
                    joints_.front().off = off + back;
                    break;
                }
                j.off = off;
            }
            e = unit(e - dot(e, j.t) * j.t);
            j.e = e, j.f = cross(j.t, e);
            joints_.push_back(j);
        }
        return {};
    }

    Model model(double radius, double hole) && {
        const bool is_tube = hole > 0;
        Shell outer, inner;
        add_walls(radius, false, outer);
        if (is_tube) add_walls(hole, true, closed_ ? inner : outer);
        if (!closed_)
            for (const bool far : {false, true}) add_cap(radius, hole, far, outer);
        Body body;
        body.solid = true;
        for (Shell* s : {&outer, &inner}) {
            if (s->faces.empty()) continue;
            s->closed = true;
            body.shells.push_back(int(out_.shells.size()));
            out_.shells.push_back(std::move(*s));
        }
        out_.bodies.push_back(std::move(body));
        return std::move(out_);
    }

private:
    // Along the axis of the first bend, so that the seam is where its torus changes from curved like a sphere
    // to curved like a saddle, and halves of it are either: up to a third fewer triangles than elsewhere.
    Vec<3> first_across() const {
        const Vec<3>& t = runs_.front().along;
        const auto bend = std::ranges::find_if(runs_, &Run::turns);
        if (bend == runs_.end()) return any_across(t);
        const Vec<3> e = bend->axis - dot(bend->axis, t) * t;
        return norm(e) > 0.5 ? unit(e) : any_across(t);
    }
    // The edges around joints, one of each circle. Those of the larger radius come first.
    int circle_of(std::size_t joint) const { return circles_ + int(joint % joints_.size()); }
    int vertex_of(std::size_t joint) const { return vertices_ + int(joint % joints_.size()); }

    void add_walls(double r, bool is_hole, Shell& shell) {
        vertices_ = int(out_.vertices.size());
        circles_ = int(out_.edges.size());
        for (std::size_t i = 0; i < joints_.size(); ++i) {
            const Joint& j = joints_[i];
            const double off = j.off + rounding_;
            out_.vertices.push_back({j.o + r * j.e, off});
            Edge circle;
            circle.curve = Conic<3>{ConicKind::ellipse, j.o, r * j.e, r * j.f};
            circle.range = {0, kTurn};
            circle.start = circle.end = vertex_of(i);
            circle.tolerance = off;
            out_.edges.push_back(std::move(circle));
        }
        if (is_hole)
            inner_ = circles_;
        else
            outer_ = circles_;
        for (std::size_t i = 0; i < runs_.size(); ++i) {
            const Run& run = runs_[i];
            const Joint& j = joints_[i];
            const Vec<3> p = j.o + r * j.e;
            const Conic<3> circle{ConicKind::ellipse, j.o, r * j.e, r * j.f};
            Edge seam;
            seam.start = vertex_of(i), seam.end = vertex_of(i + 1);
            seam.range = {0, run.turns ? run.angle : run.length};
            seam.tolerance = std::max(out_.vertices[std::size_t(seam.start)].tolerance,
                                      out_.vertices[std::size_t(seam.end)].tolerance);
            Face face;
            face.reversed = is_hole;
            double w = 0;
            if (run.turns) {
                const Vec<3> from = run.centre + dot(run.axis, p - run.centre) * run.axis;
                seam.curve = Conic<3>{ConicKind::ellipse, from, p - from, cross(run.axis, p - from)};
                const Vec<3> out = unit(j.o - run.centre);
                w = std::atan2(dot(j.e, run.axis), dot(j.e, out));
                const Conic<3> profile{ConicKind::ellipse, j.o, r * out, r * run.axis};
                face.surface = Revolution{profile, run.centre, run.axis, SurfaceKind::torus};
            } else {
                seam.curve = Line<3>{p, j.t};
                face.surface = Extrusion{circle, j.t, SurfaceKind::cylinder};
            }
            const int along = int(out_.edges.size());
            const double far = seam.range.hi;
            out_.edges.push_back(std::move(seam));
            // Parameters (along, around) of tori, (around, along) of cylinders.
            const auto line = [](double a, double b, double du, double dv) {
                return Line<2>{{{a, b}}, {{du, dv}}};
            };
            const int near_circle = circle_of(i), far_circle = circle_of(i + 1);
            Loop loop;
            if (run.turns)
                loop.coedges = {{along, false, line(0, w - kTurn, 1, 0)},
                                {far_circle, true, line(far, w, 0, -1)},
                                {along, true, line(0, w, 1, 0)},
                                {near_circle, false, line(0, w, 0, -1)}};
            else
                loop.coedges = {{near_circle, false, line(0, 0, 1, 0)},
                                {along, false, line(kTurn, 0, 0, 1)},
                                {far_circle, true, line(0, far, 1, 0)},
                                {along, true, line(0, 0, 0, 1)}};
            face.loops.push_back(std::move(loop));
            shell.faces.push_back({int(out_.faces.size()), false});
            out_.faces.push_back(std::move(face));
        }
    }

    void add_cap(double radius, double hole, bool far, Shell& shell) {
        const std::size_t at = far ? joints_.size() - 1 : 0;
        const Joint& j = joints_[at];
        Face face;
        face.surface = Extrusion{Line<3>{j.o, j.e}, j.f, SurfaceKind::plane};
        face.reversed = !far;
        const auto add = [&](int edge, double r, bool backward) {
            Loop loop;
            loop.coedges.push_back(
                {edge, backward, Conic<2>{ConicKind::ellipse, {}, Vec<2>{{r, 0}}, Vec<2>{{0, r}}}});
            face.loops.push_back(std::move(loop));
        };
        add(outer_ + int(at), radius, false);
        if (hole > 0) add(inner_ + int(at), hole, true);
        shell.faces.push_back({int(out_.faces.size()), false});
        out_.faces.push_back(std::move(face));
    }

    std::vector<Run> runs_;
    double joint_, rounding_ = 0;
    bool closed_ = false;
    std::vector<Joint> joints_;
    Model out_;
    int vertices_ = 0, circles_ = 0, outer_ = 0, inner_ = 0;  // the first of each
};

}  // namespace

bool is_line_or_circle(const CurveGeometry<3>& curve) {
    if (std::holds_alternative<Line<3>>(curve)) return true;
    const auto* c = std::get_if<Conic<3>>(&curve);
    if (c == nullptr || c->kind != ConicKind::ellipse) return false;
    const double size = norm(c->x);
    return std::abs(norm(c->y) - size) <= kCircle * size &&
           std::abs(dot(c->x, c->y)) <= kCircle * size * size;
}

Result<Model> pipe(std::span<const RailPart> rail, double radius, double hole, double joint) {
    if (!(radius > 0) || !std::isfinite(radius))
        return refuse(RefusalKind::invalid, "radius", text("a positive number, not ", radius));
    if (!(hole >= 0) || !(radius - hole > kRounding * radius))
        return refuse(RefusalKind::invalid, "hole",
                      text("between 0 and the radius ", radius, ", not ", hole));
    if (!(joint >= 0)) return refuse(RefusalKind::invalid, "joint", "a number that is not negative");
    if (rail.empty()) return refuse(RefusalKind::invalid, "rail", "has no parts");
    std::vector<Run> runs;
    for (std::size_t i = 0; i < rail.size(); ++i) {
        auto run = run_of(rail[i], i);
        if (!run) return std::unexpected(run.error());
        if (run->turns && !(run->bend > radius * (1 + kRounding)))
            return refuse(RefusalKind::unsupported, text("rail[", i, "]"),
                          text("bends with the radius ", run->bend, "; that of the pipe is ", radius));
        runs.push_back(*run);
    }
    Builder builder(std::move(runs), joint);
    if (auto ok = builder.join(radius); !ok) return std::unexpected(ok.error());
    return std::move(builder).model(radius, hole);
}

Result<std::vector<RailPart>> bent_polyline(std::span<const Vec<3>> corners, double bend, bool closed) {
    const std::size_t n = corners.size();
    if (n < (closed ? 3u : 2u))
        return refuse(RefusalKind::invalid, "corners",
                      text(closed ? "at least three" : "at least two", ", not ", n));
    if (!(bend >= 0) || !std::isfinite(bend))
        return refuse(RefusalKind::invalid, "bend", text("a radius, not ", bend));
    const std::size_t sides = closed ? n : n - 1;
    std::vector<Vec<3>> way(sides);
    for (std::size_t i = 0; i < sides; ++i) {
        const Vec<3> d = corners[(i + 1) % n] - corners[i];
        if (!(norm(d) > 0) || !std::isfinite(norm(d)))
            return refuse(RefusalKind::invalid, text("corners[", i, "]"), "is where the next one is");
        way[i] = unit(d);
    }
    // What the arc at each corner takes of the sides beside it.
    std::vector<double> taken(n, 0.0);
    for (std::size_t i = closed ? 0 : 1; i < (closed ? n : n - 1); ++i) {
        const Vec<3>&a = way[(i + sides - 1) % sides], &b = way[i];
        const double sine = norm(cross(a, b)), cosine = dot(a, b);
        if (sine <= kStraight && cosine > 0) continue;
        if (sine <= kStraight) return refuse(RefusalKind::invalid, text("corners[", i, "]"), "turns back");
        if (!(bend > 0))
            return refuse(RefusalKind::invalid, text("corners[", i, "]"), "needs an arc: `bend` is 0");
        taken[i] = bend * sine / (1 + cosine);
    }
    for (std::size_t i = 0; i < sides; ++i)
        if (const double side = norm(corners[(i + 1) % n] - corners[i]), both = taken[i] + taken[(i + 1) % n];
            both > side * (1 + kRounding))
            return refuse(RefusalKind::no_answer, text("corners[", i, "]"),
                          text("the arcs at it and the next one take ", both, " of a side of ", side));
    std::vector<RailPart> out;
    for (std::size_t i = 0; i < sides; ++i) {
        const std::size_t next = (i + 1) % n;
        const double side = norm(corners[next] - corners[i]);
        const Interval on{taken[i], side - taken[next]};
        if (on.length() > kRounding * side) out.push_back({Line<3>{corners[i], way[i]}, on, false});
        if (!(taken[next] > 0)) continue;
        const Vec<3>&a = way[i], &b = way[(i + 1) % sides];
        const Vec<3> axis = unit(cross(a, b)), from = corners[next] - taken[next] * a,
                     centre = from + bend * cross(axis, a);
        out.push_back({Conic<3>{ConicKind::ellipse, centre, from - centre, bend * a},
                       {0, std::atan2(norm(cross(a, b)), dot(a, b))},
                       false});
    }
    return out;
}

}  // namespace freiform

// Surfaces as a textbook prints them: borders, outlines and isolines, and of these only what is in front.
//
// Method. All faces become one mesh (watertight, within the tolerance of the drawing); lines are found on it
// (model/surface_lines.hpp, mesh/level_lines.hpp), turned into the view, and cut by what the triangles hide
// (mesh/visibility.hpp). What is left is thinned out within the tolerance once more.
//
// Accuracy. A line is within three tolerances of what it stands for: two of the mesh, one of thinning out. A
// point of it is hidden if a surface is in front of it by more than eight, four times that of the mesh; see
// visibility.cpp for why four. Where faces cross each other without an edge, no line is drawn.
#include "io/drawing_detail.hpp"
#include "io/drawing_lift.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/mesh/level_lines.hpp>
#include <freiform/mesh/visibility.hpp>
#include <freiform/model/surface_lines.hpp>
#include <freiform/model/tessellate.hpp>

#include <algorithm>

namespace freiform::drawing {

namespace {

constexpr double kCrease = 0.1;            // radians: less is a smooth border
constexpr double kMesh = 2, kInFront = 8;  // tolerances
constexpr long long kMostTriangles = 4'000'000;
constexpr std::size_t kMostColours = 4;  // objects; more are drawn alike
constexpr std::size_t kThinned = 512;    // points at a time, which keeps thinning linear

// From back to front.
enum Role { hidden_lines, hidden_nets, iso, smooth, border, outline, nets, kRoles };

struct Style {
    std::string_view role;
    double width, whiten;
    std::string_view legend;
};
constexpr std::array<Style, kRoles> kStyles{{{"hidden", 0.7, 0.45, "hidden edges"},
                                             {"control-behind", 0.6, 0.75, ""},
                                             {"isolines", 0.7, 0.4, "isolines"},
                                             {"smooth-edges", 0.9, 0.15, ""},
                                             {"edges", 1.6, 0, "edges"},
                                             {"silhouettes", 1.6, 0, "outline"},
                                             {"control", 1, 0.45, "control net"}}};

struct Line {
    Role role;
    std::size_t object;
    std::string part;
    std::vector<Vec<3>> points;  // in the view
};

double distance(const Vec<2>& p, const Vec<2>& a, const Vec<2>& b) {
    const Vec<2> d = b - a;
    const double square = dot(d, d);
    const double t = square > 0 ? std::clamp(dot(p - a, d) / square, 0.0, 1.0) : 0;
    return norm(p - (a + t * d));
}

// The fewest of the points that halving finds, so that the rest is within the tolerance.
std::vector<Vec<2>> thinned(const std::vector<Vec<2>>& p, double tolerance) {
    std::vector<Vec<2>> out{p.front()};
    for (std::size_t first = 0; first + 1 < p.size(); first += kThinned) {
        std::vector<std::size_t> ends{std::min(first + kThinned, p.size() - 1)};
        for (std::size_t a = first; !ends.empty();) {
            const std::size_t b = ends.back();
            std::size_t worst = a;
            double most = tolerance;
            for (std::size_t i = a + 1; i < b; ++i)
                if (const double d = distance(p[i], p[a], p[b]); d > most) most = d, worst = i;
            if (worst != a) {
                ends.push_back(worst);
                continue;
            }
            out.push_back(p[b]);
            a = b;
            ends.pop_back();
        }
    }
    return out;
}

// Surfaces of one coordinate as the graphs that they are drawn as.
Document in_space(const Document& document, std::span<const std::size_t> objects) {
    Document out;
    out.unit = document.unit;
    for (const std::size_t i : objects) {
        Object object = document.objects[i];
        visit_one(
            [&](const auto& s) {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (TensorPatch<S>)
                    if constexpr (S::kParams == 2)
                        if (auto graph = lifted(s)) object.shape = Shape(std::move(*graph));
            },
            document.objects[i].shape);
        out.objects.push_back(std::move(object));
    }
    return out;
}

class Faces {
public:
    Faces(Sketch& s, const Document& document, std::span<const std::size_t> objects)
        : s_(s), document_(document), objects_(objects) {}

    bool mesh(double tolerance) {
        const Document lifted = in_space(document_, objects_);
        auto scene = scene_with_owners(lifted);
        if (!scene) return fail(scene.error());
        scene_ = std::move(*scene);
        for (const Refusal& r : scene_.model.refused) s_.left_out.push_back(r);
        auto t = tessellate(scene_.model, {.tolerance = std::scalbn(tolerance, s_.plane.exponent),
                                           .max_triangles = kMostTriangles});
        if (!t) return fail(t.error());
        for (const RefusedFace& r : t->refused)
            s_.left_out.push_back({r.reason.kind, text("face ", r.face, " ", r.name), r.reason.message});
        mesh_ = std::move(t->mesh);
        return true;
    }
    Box<2> box() const {
        Box<2> box;
        for (const Vec<3>& p : mesh_.points) box.add(s_.plane(p));
        return box;
    }
    void draw() {
        std::vector<std::array<Vec<3>, 3>> triangles;
        for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
            const auto p = mesh_.points_of(i);
            triangles.push_back({point(p[0]), point(p[1]), point(p[2])});
        }
        const Occluders& occluders = s_.occluders.emplace(std::move(triangles), kInFront * s_.tolerance);
        add_lines();
        std::vector<std::vector<SeenPart>> seen(lines_.size());
        parallel_for(lines_.size(), 16,
                     [&](std::size_t i) { seen[i] = seen_parts(occluders, lines_[i].points); });
        make_groups();
        for (std::size_t i = 0; i < lines_.size(); ++i)
            for (SeenPart& part : seen[i]) put(lines_[i], part);
        if (s_.options.control) add_points();
        for (DrawnGroup& g : groups_)
            if (!g.paths.empty() || !g.discs.empty()) s_.groups.push_back(std::move(g));
    }

private:
    bool fail(const Refusal& why) {
        s_.failure = why.kind == RefusalKind::limit
                         ? Refusal{why.kind, why.where,
                                   text(why.message, " of the drawing; a smaller picture needs fewer")}
                         : why;
        return false;
    }
    Vec<3> point(int i) const { return s_.plane.deep(mesh_.points[std::size_t(i)]); }

    bool of_model(int face) const {
        const std::size_t object = scene_.object_of_face[std::size_t(face)];
        return std::holds_alternative<Model>(document_.objects[objects_[object]].shape);
    }
    // Faces have the name of their object, or in a model their own.
    std::string name_of(int face) const {
        const std::size_t object = scene_.object_of_face[std::size_t(face)];
        std::string name = document_.objects[objects_[object]].name;
        if (name.empty()) name = object_label(document_, objects_[object]);
        if (!of_model(face)) return name;
        const std::string& own = scene_.model.faces[std::size_t(face)].name;
        return own.empty() ? text(name, " face ", face) : text(name, " ", own);
    }
    void add_line(Role role, int face, std::string part, std::span<const Vec<3>> points) {
        Line line{role, scene_.object_of_face[std::size_t(face)], std::move(part), {}};
        for (const Vec<3>& p : points) line.points.push_back(s_.plane.deep(p));
        lines_.push_back(std::move(line));
    }
    void add_lines() {
        for (const SurfaceLine& l : isolines(scene_.model, mesh_, s_.options.isolines))
            if (s_.options.isolines || !of_model(l.face)) add_line(iso, l.face, name_of(l.face), l.points);
        for (const SurfaceLine& l : silhouettes(scene_.model, mesh_, cross(s_.plane.right, s_.plane.up)))
            add_line(outline, l.face, name_of(l.face), l.points);
        for (const Outline& o : outlines(mesh_, kCrease)) {
            const int face = mesh_.parts[std::size_t(o.parts[0])].face;
            const int other = o.parts[1] < 0 ? -1 : mesh_.parts[std::size_t(o.parts[1])].face;
            std::vector<Vec<3>> points;
            for (const int p : o.points) points.push_back(mesh_.points[std::size_t(p)]);
            add_line(o.smooth ? smooth : border, face,
                     other < 0 || other == face ? name_of(face) : text(name_of(face), " to ", name_of(other)),
                     points);
        }
        if (!s_.options.control) return;
        nets_ = control_nets(document_, objects_);
        for (const ControlNet& net : nets_) {
            const auto object = std::size_t(std::ranges::find(objects_, net.object) - objects_.begin());
            for (const auto& points : net.lines) {
                Line line{nets, object, {}, {}};
                for (const Vec<3>& p : points) line.points.push_back(s_.plane.deep(p));
                lines_.push_back(std::move(line));
            }
        }
    }

    bool alike() const { return objects_.size() > kMostColours && s_.options.palette.empty(); }
    void make_groups() {
        for (const Style& style : kStyles)
            for (std::size_t k = 0; k < (alike() ? 1 : objects_.size()); ++k) {
                const std::size_t index = objects_[k];
                const std::string& own = document_.objects[index].name;
                const Colour ink = alike() ? kPalette[0] : s_.colour_of(index);
                DrawnGroup g{
                    alike()       ? std::string("surfaces")
                    : own.empty() ? object_label(document_, index)
                                  : own,
                    std::string(style.role),
                    mixed(style.whiten > 0 ? ink : mixed(ink, kInk, 0.6), {1, 1, 1, 1}, style.whiten),
                    style.width,
                    {},
                    {},
                    {}};
                if (style.role == "hidden") g.dashes = {4, 3};
                g.legend = plain_text(style.legend);
                groups_.push_back(std::move(g));
            }
    }
    DrawnGroup& group(Role role, std::size_t object) {
        return groups_[std::size_t(role) * (alike() ? 1 : objects_.size()) + (alike() ? 0 : object)];
    }
    void put(const Line& line, const SeenPart& part) {
        Role role = line.role;
        if (part.hidden) {
            if (role == nets)
                role = hidden_nets;
            else if (s_.options.hidden == HiddenLines::dashed && (role == border || role == outline))
                role = hidden_lines;
            else
                return;
        }
        std::vector<Vec<2>> points;
        for (const Vec<3>& p : part.points) points.push_back({{p[0], p[1]}});
        points = thinned(points, s_.tolerance);
        const bool closed = points.size() > 3 && points.front() == points.back();
        if (closed) points.pop_back();
        DrawnPath path = line_through(points, closed);
        path.part = line.part;
        s_.take(group(role, line.object), std::move(path));
    }
    void add_points() {
        for (const ControlNet& net : nets_) {
            const auto object = std::size_t(std::ranges::find(objects_, net.object) - objects_.begin());
            double mean = 0;
            for (const double w : net.weights) mean += w / double(net.weights.size());
            for (std::size_t i = 0; i < net.points.size(); ++i) {
                const Vec<2> p = s_.plane(net.points[i]);
                const bool behind = s_.is_behind(net.points[i]);
                const double radius = std::clamp(2.6 * std::sqrt(net.weights[i] / mean), 1.5, 8.0);
                group(behind ? hidden_nets : nets, object)
                    .discs.push_back({p, behind ? 0.8 * radius : radius, false});
            }
        }
    }

    Sketch& s_;
    const Document& document_;
    const std::span<const std::size_t> objects_;
    Scene scene_;
    TriangleMesh mesh_;
    std::vector<Line> lines_;
    std::vector<ControlNet> nets_;
    std::vector<DrawnGroup> groups_;
};

}  // namespace

bool has_faces(const Shape& shape) {
    return visit_one(
        [](const auto& s) {
            using S = std::remove_cvref_t<decltype(s)>;
            if constexpr (TensorPatch<S>) {
                if constexpr (S::kParams == 2)
                    return lifted(s).has_value();
                else
                    return false;
            } else if constexpr (TriangularPatch<S>) {
                return Space<typename S::Coefficients>::kDim == 3;
            } else {
                return true;
            }
        },
        shape);
}

Box<2> box_of_faces(Sketch& sketch, const Document& document, std::span<const std::size_t> objects) {
    Faces faces(sketch, document, objects);
    return faces.mesh(kMesh * sketch.tolerance) ? faces.box() : Box<2>{};
}

void add_faces(Sketch& sketch, const Document& document, std::span<const std::size_t> objects) {
    Faces faces(sketch, document, objects);
    if (faces.mesh(kMesh * sketch.tolerance)) faces.draw();
}

}  // namespace freiform::drawing

// Idea. Text, structure, shapes, places: each representation is converted once, and then put where the
// assembly has it, as often as it does. Nothing recurses on what the file says; a list of visits with the
// product of the places on the way takes the place of the stack.
#include "step_structure.hpp"

#include <freiform/io/step_read.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace step {

namespace {

constexpr int kMostDepth = 200;

class Placer {
public:
    Placer(const File& file, const StepReadOptions& options) : f_(file), options_(options) {}

    Result<Model> run() {
        structure_ = structure_of(f_);
        parts_.resize(structure_.nodes.size());
        largest_ = largest_uncertainty(f_);
        model_.refused = f_.refused;
        append(model_.refused, structure_.refused);
        const bool products = std::any_of(structure_.nodes.begin(), structure_.nodes.end(),
                                          [&](const Node& n) { return n.product && has_shapes(n); });
        for (const Node& n : structure_.nodes)
            if (model_.unit.empty() && has_items(n)) model_.unit = n.context.unit, length_ = n.context.length;
        std::vector<Visit> todo;
        for (std::size_t n = structure_.nodes.size(); n-- > 0;)
            if (!structure_.nodes[n].has_parent && (!products || structure_.nodes[n].product))
                todo.push_back({std::uint32_t(n), {}, {}, {}, 0});
        while (!todo.empty()) {
            Visit v = std::move(todo.back());
            todo.pop_back();
            if (auto ok = visit(std::move(v), todo); !ok) return std::unexpected(ok.error());
        }
        take_curves();
        if (model_.faces.empty() && model_.edges.empty()) return nothing();
        return make_model(std::move(model_));
    }

private:
    struct Visit {
        std::uint32_t node = 0;
        Motion at;
        std::string name;
        std::optional<Colour> colour;
        int depth = 0;
    };

    static void append(std::vector<Refusal>& to, const std::vector<Refusal>& more) {
        for (const Refusal& r : more)
            if (to.size() < 1000) to.push_back(r);
    }
    static bool has_items(const Node& n) { return !n.items.empty() || !n.replicas.empty(); }
    static bool has_shapes(const Node& n) { return has_items(n) || !n.children.empty(); }

    Result<Model> nothing() const {
        if (model_.refused.empty())
            return refuse(
                RefusalKind::no_answer, "file",
                text("the file has ", f_.instances.size(), " instances, but no faces and no curves"));
        const Refusal& last = model_.refused.front();
        return refuse(last.kind, last.where, text("nothing of the file could be taken over: ", last.message));
    }

    Part& part_of(std::uint32_t n) {
        if (!parts_[n]) {
            const Node& node = structure_.nodes[n];
            ShapeReader reader(f_, structure_.styles, node.context.angle,
                               std::min(node.context.tolerance, largest_));
            for (const std::uint32_t i : node.items) reader.add(i);
            parts_[n] = reader.finish();
            append(model_.refused, parts_[n]->model.refused);
        }
        return *parts_[n];
    }

    Result<void> visit(Visit v, std::vector<Visit>& todo) {
        const Node& node = structure_.nodes[v.node];
        if (v.depth > kMostDepth)
            return refuse(RefusalKind::invalid, "assembly", "contains itself, or is nested too deep");
        if (++visits_ > options_.memory_bytes / 256)
            return refuse(RefusalKind::limit, "assembly", text("has more than ", visits_, " places"));
        if (!node.name.empty()) v.name = node.name;
        Motion scale;
        scale.scale = node.context.length / length_;
        const Motion here = v.at * scale;
        if (!node.items.empty())
            if (auto ok = place(part_of(v.node), here, v); !ok) return ok;
        for (const auto& [item, by] : node.replicas) {
            ShapeReader reader(f_, structure_.styles, node.context.angle,
                               std::min(node.context.tolerance, largest_));
            reader.add(item);
            const Part part = reader.finish();
            append(model_.refused, part.model.refused);
            if (auto ok = place(part, here * by, v); !ok) return ok;
        }
        for (std::size_t k = node.children.size(); k-- > 0;) {
            const Node::Child& c = node.children[k];
            // The place is said in the unit of the parent.
            Motion at = c.at;
            at.to.o = scale.scale * at.to.o;
            todo.push_back({c.node, v.at * at, v.name, v.colour ? v.colour : c.colour, v.depth + 1});
        }
        return {};
    }

    Result<void> place(const Part& part, const Motion& at, const Visit& v) {
        bytes_ += part.bytes;
        if (bytes_ > options_.memory_bytes)
            return refuse(RefusalKind::limit, "file",
                          text("the model takes more than the ", options_.memory_bytes,
                               " bytes that it may; ", bytes_, " so far"));
        const bool same = at.is_identity();
        const Model& m = part.model;
        Model& out = model_;
        const int vertices = int(out.vertices.size()), edges = int(out.edges.size()),
                  faces = int(out.faces.size()), shells = int(out.shells.size());
        // Edges that a face or nothing else has; free ones come last, if there is nothing else at all.
        std::vector<char> used(m.edges.size(), 0);
        for (const Face& f : m.faces)
            for (const Loop& l : f.loops)
                for (const Coedge& c : l.coedges) used[std::size_t(c.edge)] = 1;
        std::vector<int> to(m.edges.size(), -1), vertex(m.vertices.size(), -1);
        const auto vertex_of = [&](int i) {
            int& k = vertex[std::size_t(i)];
            if (k < 0) {
                k = int(out.vertices.size());
                const Vertex& x = m.vertices[std::size_t(i)];
                out.vertices.push_back({same ? x.point : at.point(x.point), at.scale * x.tolerance});
            }
            return k;
        };
        const auto moved_edge = [&](const Edge& e) {
            Edge x = e;
            x.start = vertex_of(e.start), x.end = vertex_of(e.end);
            x.tolerance *= at.scale;
            if (x.curve && !same) x.curve = moved(*x.curve, at);
            return x;
        };
        for (std::size_t i = 0; i < m.edges.size(); ++i) {
            if (!used[i]) {
                if (m.edges[i].curve)
                    free_.push_back({m.edges[i], m.vertices[std::size_t(m.edges[i].start)],
                                     m.vertices[std::size_t(m.edges[i].end)], at});
                continue;
            }
            to[i] = int(out.edges.size());
            out.edges.push_back(moved_edge(m.edges[i]));
        }
        (void)vertices, (void)edges;
        for (const Face& f : m.faces) {
            Face x = f;
            if (!same) x.surface = moved(f.surface, at);
            x.tolerance *= at.scale;
            x.reversed = f.reversed != at.mirrored;
            for (Loop& l : x.loops)
                for (Coedge& c : l.coedges) c.edge = to[std::size_t(c.edge)];
            out.faces.push_back(std::move(x));
        }
        for (const Shell& s : m.shells) {
            Shell x = s;
            for (FaceUse& u : x.faces) u.face += faces;
            out.shells.push_back(std::move(x));
        }
        for (const Body& b : m.bodies) {
            Body x = b;
            for (int& s : x.shells) s += shells;
            if (!v.name.empty()) x.name = v.name;
            if (!x.colour) x.colour = v.colour;
            out.bodies.push_back(std::move(x));
        }
        for (std::size_t i = 0; i < m.approximations.size(); ++i) {
            const int e = part.approximated[i];
            Approximation a = m.approximations[i];
            if (e >= 0 && to[std::size_t(e)] < 0) continue;
            a.where = e < 0 ? std::string("file") : text("edges[", to[std::size_t(e)], "]");
            if (a.bound) a.bound = at.scale * *a.bound;
            a.estimate *= at.scale;
            out.approximations.push_back(std::move(a));
        }
        return {};
    }

    // Curves that bound no face are the model of a file that has no faces at all; else they are construction.
    void take_curves() {
        if (free_.empty()) return;
        if (!model_.faces.empty()) {
            model_.refused.push_back({RefusalKind::unsupported, "file",
                                      text(free_.size(), " curves that bound no face are left out")});
            return;
        }
        for (Free& c : free_) {
            Edge e = std::move(c.edge);
            const bool closed = e.start == e.end;
            e.start = int(model_.vertices.size());
            model_.vertices.push_back({c.at.point(c.a.point), c.at.scale * c.a.tolerance});
            e.end = e.start;
            if (!closed) {
                e.end = int(model_.vertices.size());
                model_.vertices.push_back({c.at.point(c.b.point), c.at.scale * c.b.tolerance});
            }
            e.tolerance *= c.at.scale;
            e.curve = moved(*e.curve, c.at);
            model_.edges.push_back(std::move(e));
        }
    }

    struct Free {
        Edge edge;
        Vertex a, b;
        Motion at;
    };

    const File& f_;
    StepReadOptions options_;
    Structure structure_;
    std::vector<std::optional<Part>> parts_;
    std::vector<Free> free_;
    Model model_;
    double length_ = 1, largest_ = 0;
    std::uint64_t visits_ = 0, bytes_ = 0;  // also where addresses have 32 bits
};

}  // namespace

}  // namespace step

Result<Model> read_step(std::string_view bytes, const StepReadOptions& options) {
    const auto file = step::parse(bytes);
    if (!file) return std::unexpected(file.error());
    return step::Placer(*file, options).run();
}

}  // namespace freiform

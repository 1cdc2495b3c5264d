// Idea. Text, structure, shapes, places: each representation is converted once, and then put where the
// assembly has it, as often as it does (step_walk.hpp).
#include "step_walk.hpp"

#include <freiform/io/step_read.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_set>

namespace freiform {

namespace step {

namespace {

class Placer {
public:
    Placer(const File& file, const StepReadOptions& options) : f_(file), options_(options) {}

    Result<Model> run() {
        structure_ = structure_of(f_);
        parts_.resize(structure_.nodes.size());
        largest_ = largest_uncertainty(f_);
        model_.refused = f_.refused;
        append(model_.refused, structure_.refused);
        model_.layers = structure_.styles.layers;
        model_.approximations = structure_.approximations;
        if (const Context* c = context_of_model(structure_)) model_.unit = c->unit, length_ = c->length;
        if (auto ok = each_place(structure_, length_, options_.memory_bytes / 256,
                                 [this](const Place& p) { return visit(p); });
            !ok)
            return std::unexpected(ok.error());
        tell_tessellated();
        take_curves();
        tell_layers();
        if (model_.faces.empty() && model_.edges.empty()) return nothing();
        return make_model(std::move(model_));
    }

private:
    static void append(std::vector<Refusal>& to, const std::vector<Refusal>& more) {
        for (const Refusal& r : more)
            if (to.size() < 1000) to.push_back(r);
    }

    // Of shapes that are on layers of their own, of what they consist of, and of the places that they stand
    // at.
    void tell_layers() {
        if (const std::size_t n = structure_.styles.left_out)
            model_.approximations.push_back(
                {"file",
                 text(n,
                      " times a layer is left out: shapes, with what they consist of and are part of, "
                      "are kept on ",
                      kMostLayers, " layers"),
                 0});
    }

    // Triangles that stand beside what is exact are not needed; where there is nothing else, they are a mesh.
    void tell_tessellated() {
        if (tessellated_ == 0 || (model_.faces.empty() && free_.empty())) return;
        model_.refused.push_back(
            {RefusalKind::unsupported, "file",
             text(tessellated_, tessellated_ == 1 ? " tessellated item is" : " tessellated items are",
                  " left out, beside shapes that are exact")});
    }

    Result<Model> nothing() const {
        if (tessellated_ > 0 && model_.refused.empty())
            return refuse(RefusalKind::no_answer, "file",
                          text("the file has triangles (", tessellated_,
                               " tessellated items), but no faces and no curves; they are read as a mesh"));
        if (model_.refused.empty())
            return refuse(
                RefusalKind::no_answer, "file",
                text("the file has ", f_.instances.size(), " instances, but no faces and no curves"));
        const Refusal& last = model_.refused.front();
        return refuse(last.kind, last.where, text("nothing of the file could be taken over: ", last.message));
    }

    Part read_items(const Node& node, std::span<const std::uint32_t> items) {
        ShapeReader reader(f_, structure_.styles, node.context.angle,
                           std::min(node.context.tolerance, largest_), options_);
        for (const std::uint32_t i : items) reader.add(i);
        Part part = reader.finish();
        append(model_.refused, part.model.refused);
        if (!told_.insert(items[0]).second) return part;
        tessellated_ += part.tessellated;
        for (Repair& r : part.model.repairs) {
            r.distance *= node.context.length / length_;
            model_.repairs.push_back(std::move(r));
        }
        return part;
    }

    Result<void> visit(const Place& p) {
        const Node& node = structure_.nodes[p.node];
        if (!node.items.empty()) {
            if (!parts_[p.node]) parts_[p.node] = read_items(node, node.items);
            if (auto ok = place(*parts_[p.node], p.at, p); !ok) return ok;
        }
        for (const auto& [item, by] : node.replicas)
            if (auto ok = place(read_items(node, {&item, 1}), p.at * by, p); !ok) return ok;
        return {};
    }

    Result<void> place(const Part& part, const Motion& at, const Place& v) {
        bytes_ += part.bytes;
        if (bytes_ > options_.memory_bytes)
            return refuse(RefusalKind::limit, "file",
                          text("the model takes more than the ", options_.memory_bytes,
                               " bytes that it may; ", bytes_, " so far"));
        ++places_;
        const bool same = at.is_identity();
        const Model& m = part.model;
        Model& out = model_;
        const int faces = int(out.faces.size()), shells = int(out.shells.size());
        // Edges that a face or nothing else has; free ones come last, if there is nothing else at all.
        std::vector<char> used(m.edges.size(), 0);
        for (const Face& f : m.faces)
            for (const Loop& l : f.loops)
                for (const Coedge& c : l.coedges) used[std::size_t(c.edge)] = 1;
        std::vector<char> released(m.edges.size(), 0);
        for (const int e : part.released) released[std::size_t(e)] = 1;
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
                if (m.edges[i].curve && !released[i])
                    free_.push_back({m.edges[i], m.vertices[std::size_t(m.edges[i].start)],
                                     m.vertices[std::size_t(m.edges[i].end)], at, places_});
                continue;
            }
            to[i] = int(out.edges.size());
            out.edges.push_back(moved_edge(m.edges[i]));
        }
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
            x.layers = structure_.styles.joined_layers(x.layers, v.layers);
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
        std::map<std::pair<int, int>, int> known;  // by the place and the number there
        for (Free& c : free_) {
            Edge e = std::move(c.edge);
            const bool same = c.at.is_identity();
            const auto vertex = [&](int number, const Vertex& v) {
                const auto [found, fresh] = known.try_emplace({c.place, number}, int(model_.vertices.size()));
                if (fresh)
                    model_.vertices.push_back(
                        {same ? v.point : c.at.point(v.point), c.at.scale * v.tolerance});
                return found->second;
            };
            e.start = vertex(e.start, c.a), e.end = vertex(e.end, c.b);
            e.tolerance *= c.at.scale;
            if (!same) e.curve = moved(*e.curve, c.at);
            model_.edges.push_back(std::move(e));
        }
    }

    struct Free {
        Edge edge;
        Vertex a, b;
        Motion at;
        int place;  // those of one place share vertices
    };

    const File& f_;
    StepReadOptions options_;
    Structure structure_;
    std::vector<std::optional<Part>> parts_;
    std::vector<Free> free_;
    int places_ = 0;
    Model model_;
    double length_ = 1, largest_ = 0;
    std::uint64_t bytes_ = 0;  // also where addresses have 32 bits
    std::size_t tessellated_ = 0;
    std::unordered_set<std::uint32_t> told_;  // the first items of what has been read, also as a replica
};

}  // namespace

}  // namespace step

Result<Model> read_step(std::string_view bytes, const StepReadOptions& options) {
    const auto file = step::parse(bytes);
    if (!file) return std::unexpected(file.error());
    return step::Placer(*file, options).run();
}

}  // namespace freiform

// Idea. Text, structure, shapes, places: each representation is converted once, and then put where the
// assembly has it, as often as it does (step_walk.hpp). So is what an assembly has in other files.
#include "step_walk.hpp"

#include <freiform/io/step_read.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_set>

namespace freiform {

namespace step {

namespace {

constexpr int kDeepestFile = 32;  // of files in each other
constexpr std::size_t kMostFiles = 10'000;

// What another file holds, or why it does not.
struct Other {
    std::string path;  // from the folder of the first file
    bool read = false;
    Part part = {};
    double length = 1;  // millimetres in its unit
    Refusal why{RefusalKind::invalid, "", "contains itself"};
};

// The other files of an assembly, each read once.
struct Others {
    std::vector<std::unique_ptr<Other>> all;
    std::vector<std::string_view> open;  // those that contain what is being read
    std::vector<Layer> layers;           // of all files, numbered together
    std::uint64_t bytes = 0;             // that all of it takes, also where addresses have 32 bits
};

class Placer {
public:
    // `folder`: of the file, seen from the first one; `depth`: how many contain it.
    Placer(const File& file, const StepReadOptions& options, Others& others, std::string_view folder = {},
           int depth = 0)
        : f_(file), options_(options), others_(others), folder_(folder), depth_(depth) {}

    double length() const { return length_; }
    Part& part() { return out_; }

    Result<void> run() {
        structure_ = structure_of(f_, others_.layers);
        others_.layers = structure_.styles.layers;
        parts_.resize(structure_.nodes.size());
        largest_ = largest_uncertainty(f_);
        model_.refused = f_.refused;
        append(model_.refused, structure_.refused);
        model_.approximations = structure_.approximations;
        out_.approximated.resize(model_.approximations.size(), -1);
        if (const Context* c = context_of_model(structure_)) model_.unit = c->unit, length_ = c->length;
        if (auto ok = each_place(structure_, length_, options_.memory_bytes / 256,
                                 [this](const Place& p) { return visit(p); });
            !ok)
            return std::unexpected(ok.error());
        tell_tessellated();
        take_curves();
        tell_layers();
        if (model_.faces.empty() && model_.edges.empty()) return nothing();
        model_.layers = others_.layers;
        out_.approximated.resize(model_.approximations.size(), -1);
        return {};
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

    Result<void> nothing() const {
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

    // Of the file that a shape is in; none, which is told once, if there is nothing to be had of it: of the
    // first name, or of one that there is a file of.
    const Other* other(std::uint32_t document) {
        const Document& d = structure_.documents[document];
        const Other* told = nullptr;
        for (const std::string& name : d.names)
            for (std::string& path : paths_beside(folder_, name)) {
                const Other* o = other_at(std::move(path));
                if (o->read) return o;
                if (!told || (told->why.kind == RefusalKind::io && o->why.kind != RefusalKind::io)) told = o;
            }
        if (told_.insert(d.instance).second)
            append(model_.refused, {{told->why.kind, f_.label(d.instance),
                                     text("its shape is in the file '", told->path, "': ", told->why.where,
                                          told->why.message)}});
        return nullptr;
    }

    const Other* other_at(std::string path) {
        for (const auto& o : others_.all)
            if (o->path == path) return o.get();
        Other& out = *others_.all.emplace_back(std::make_unique<Other>());
        out.path = std::move(path);
        if (auto ok = read_other(out); !ok) {
            out.why = ok.error();
            if (!out.why.where.empty()) out.why.where += ": ";
        }
        return &out;
    }

    Result<void> read_other(Other& out) {
        if (!options_.open) return refuse(RefusalKind::unsupported, "", "no other file is at hand");
        if (depth_ == kDeepestFile || others_.all.size() > kMostFiles)
            return refuse(RefusalKind::limit, "", "files are nested too deep, or too many");
        const auto bytes = options_.open(out.path);
        if (!bytes) return refuse(bytes.error().kind, "", bytes.error().message);
        if (std::ranges::find(others_.open, *bytes) != others_.open.end()) return std::unexpected(out.why);
        others_.bytes += bytes->size();
        if (auto ok = within_memory(); !ok) return ok;
        const auto file = parse(*bytes);
        if (!file) return std::unexpected(file.error());
        Placer inner(*file, options_, others_, out.path.substr(0, out.path.rfind('/') + 1), depth_ + 1);
        others_.open.push_back(*bytes);
        const auto ok = inner.run();
        others_.open.pop_back();
        if (!ok) return ok;
        out.length = inner.length();
        out.part = std::move(inner.part());
        out.read = true;
        take_over(out);
        return {};
    }

    // What is told of another file is told of this one.
    void take_over(Other& other) {
        Model& m = other.part.model;
        const std::string name = other.path + ": ";
        for (Refusal& r : m.refused) {
            std::string& first = r.where == "file" ? r.message : r.where;  // "file" is what is no face
            first = name + first;
        }
        append(model_.refused, std::exchange(m.refused, {}));
        for (Repair& r : m.repairs) {
            r.where = name + r.where;
            r.distance *= other.length / length_;
            model_.repairs.push_back(std::move(r));
        }
        for (std::size_t i = 0; i < m.approximations.size(); ++i) {
            Approximation& a = m.approximations[i];
            if (other.part.approximated[i] >= 0)
                a.what = name + a.what;
            else
                a.where = name + a.where;
        }
    }

    Result<void> within_memory() const {
        if (others_.bytes <= options_.memory_bytes) return {};
        return refuse(RefusalKind::limit, "file",
                      text("the model takes more than the ", options_.memory_bytes, " bytes that it may; ",
                           others_.bytes, " so far"));
    }

    Result<void> visit(const Place& p) {
        const Node& node = structure_.nodes[p.node];
        if (node.document != kMissing) {
            const Other* o = other(node.document);
            if (!o) return {};
            Motion scale;
            scale.scale = o->length / node.context.length;
            return place(o->part, p.at * scale, p);
        }
        if (!node.items.empty()) {
            if (!parts_[p.node]) parts_[p.node] = read_items(node, node.items);
            if (auto ok = place(*parts_[p.node], p.at, p); !ok) return ok;
        }
        for (const auto& [item, by] : node.replicas)
            if (auto ok = place(read_items(node, {&item, 1}), p.at * by, p); !ok) return ok;
        return {};
    }

    Result<void> place(const Part& part, const Motion& at, const Place& v) {
        out_.bytes += part.bytes, others_.bytes += part.bytes;
        if (auto ok = within_memory(); !ok) return ok;
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
            const bool own = structure_.nodes[v.node].document != kMissing && !x.name.empty();
            if (!v.name.empty() && !own) x.name = v.name;
            if (!x.colour) x.colour = v.colour;
            x.layers = structure_.styles.joined_layers(x.layers, v.layers);
            out.bodies.push_back(std::move(x));
        }
        for (std::size_t i = 0; i < m.approximations.size(); ++i) {
            const int e = part.approximated[i];
            Approximation a = m.approximations[i];
            if (e >= 0 && to[std::size_t(e)] < 0) continue;
            if (e >= 0)
                a.where = text("edges[", to[std::size_t(e)], "]");
            else if (a.where.empty())
                a.where = "file";
            out_.approximated.push_back(e < 0 ? -1 : to[std::size_t(e)]);
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
            model_.refused.push_back(
                {RefusalKind::unsupported, "file",
                 text(free_.size(), free_.size() == 1 ? " curve that bounds no face is left out"
                                                      : " curves that bound no face are left out")});
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
    const StepReadOptions& options_;
    Others& others_;
    std::string folder_;
    int depth_;
    Structure structure_;
    std::vector<std::optional<Part>> parts_;
    std::vector<Free> free_;
    int places_ = 0;
    Part out_;
    Model& model_ = out_.model;
    double length_ = 1, largest_ = 0;
    std::size_t tessellated_ = 0;
    // The first items of what has been read, also as a replica, and documents that could not be.
    std::unordered_set<std::uint32_t> told_;
};

}  // namespace

}  // namespace step

Result<Model> read_step(std::string_view bytes, const StepReadOptions& options) {
    const auto file = step::parse(bytes);
    if (!file) return std::unexpected(file.error());
    step::Others others;
    others.open.push_back(bytes);
    step::Placer placer(*file, options, others);
    if (auto ok = placer.run(); !ok) return std::unexpected(ok.error());
    return make_model(std::move(placer.part().model));
}

}  // namespace freiform

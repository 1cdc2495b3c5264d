#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/model/assemble.hpp>
#include <freiform/spline/in_space.hpp>
#include <freiform/spline/simplex_convert.hpp>

#include <unordered_map>

namespace freiform {

namespace {

// The layers of `from` among those of `to`, by their names.
std::vector<int> joined_layers(Model& to, std::vector<Layer>&& from) {
    std::vector<int> at;
    std::unordered_map<std::string, int> known;
    for (std::size_t i = 0; i < to.layers.size() && !from.empty(); ++i)
        known.emplace(to.layers[i].name, int(i));
    for (Layer& l : from) {
        const auto [found, fresh] = known.emplace(l.name, int(to.layers.size()));
        at.push_back(found->second);
        if (fresh) to.layers.push_back(std::move(l));
    }
    return at;
}

// Appends a model; indices move up by what is there.
void append(Model& to, Model from) {
    const int vertices = int(to.vertices.size()), edges = int(to.edges.size()), faces = int(to.faces.size()),
              shells = int(to.shells.size());
    for (Edge& e : from.edges) e.start += vertices, e.end += vertices;
    for (Face& f : from.faces)
        for (Loop& l : f.loops)
            for (Coedge& c : l.coedges) c.edge += edges;
    for (Shell& s : from.shells)
        for (FaceUse& u : s.faces) u.face += faces;
    for (Body& b : from.bodies)
        for (int& s : b.shells) s += shells;
    const std::vector<int> layers = joined_layers(to, std::move(from.layers));
    const auto number = [&](auto& things) {
        for (auto& x : things)
            for (int& l : x.layers) l = layers[std::size_t(l)];
    };
    number(from.edges), number(from.faces), number(from.bodies);
    const auto move_all = [](auto& a, auto& b) {
        a.insert(a.end(), std::make_move_iterator(b.begin()), std::make_move_iterator(b.end()));
    };
    move_all(to.vertices, from.vertices);
    move_all(to.edges, from.edges);
    move_all(to.faces, from.faces);
    move_all(to.shells, from.shells);
    move_all(to.bodies, from.bodies);
    move_all(to.refused, from.refused);
    move_all(to.approximations, from.approximations);
    move_all(to.repairs, from.repairs);
}

class SceneBuilder {
public:
    explicit SceneBuilder(const Document& document) : document_(document), builder_(document.unit) {}

    Result<void> add(std::size_t index) {
        return visit_one([&](const auto& s) { return add_shape(index, s); }, document_.objects[index].shape);
    }

    Result<Scene> finish() && {
        Scene scene;
        Model& all = scene.model;
        all.unit = document_.unit;
        if (has_surfaces_) {
            auto loose = std::move(builder_).finish();
            if (!loose) return std::unexpected(loose.error());
            append(all, std::move(*loose));
            scene.object_of_face = loose_;
        }
        for (const auto& [index, m] : models_) {
            scene.object_of_face.insert(scene.object_of_face.end(), m->faces.size(), index);
            if (!m->unit.empty() && !all.unit.empty() && m->unit != all.unit)
                return refuse(RefusalKind::unsupported, "unit",
                              text("a model in ", m->unit, " cannot be joined with others in ", all.unit));
            if (all.unit.empty()) all.unit = m->unit;
            append(all, *m);
        }
        all.approximations.insert(all.approximations.end(), approximations_.begin(), approximations_.end());
        all.refused.insert(all.refused.end(), without_faces_.begin(), without_faces_.end());
        if (all.faces.empty())
            return refuse(RefusalKind::no_answer, "objects", "there is no surface among them");
        auto checked = make_model(std::move(all));
        if (!checked) return std::unexpected(checked.error());
        scene.model = std::move(*checked);
        return scene;
    }

private:
    template <class S>
    Result<void> add_shape(std::size_t index, const S& s) {
        const std::string& name = document_.objects[index].name;
        Result<int> added = 0;
        if constexpr (std::same_as<S, Surface<Vec<3>>> || std::same_as<S, Surface<Hom<3>>>) {
            added = builder_.add(s, name);
        } else if constexpr (std::same_as<S, Surface<Vec<2>>> || std::same_as<S, Surface<Hom<2>>>) {
            added = builder_.add(in_space(s), name);
        } else if constexpr (std::same_as<S, Triangle<Vec<3>>> || std::same_as<S, Triangle<Hom<3>>>) {
            if (s.degree() == 0)
                return refuse(RefusalKind::no_answer, object_label(document_, index),
                              "a triangle of degree 0 is a point");
            bool flat = false;
            if constexpr (std::same_as<S, Triangle<Vec<3>>>) flat = s.degree() == 1;
            if (flat)
                added = builder_.add({project(s.coefficient(0, 0)), project(s.coefficient(1, 0)),
                                      project(s.coefficient(0, 1))},
                                     name);
            else
                added = add_triangle(index, s);
        } else if constexpr (std::same_as<S, TrimmedSurface>) {
            added = s.loops.empty() ? builder_.add(s.surface, name)
                                    : builder_.add_trimmed(s.surface, s.loops, name);
        } else if constexpr (std::same_as<S, Model>) {
            models_.emplace_back(index, &s);
            return {};
        } else {
            without_faces_.push_back(
                {RefusalKind::unsupported, object_label(document_, index),
                 text("a ", type_name(document_.objects[index].shape), " has no faces in space")});
            return {};
        }
        if (!added) return refuse_within(object_label(document_, index), added.error());
        has_surfaces_ = true;
        loose_.resize(std::size_t(*added) + 1, index);
        return {};
    }

    // As a surface with a pole; what rounding moves is told.
    template <class P>
    Result<int> add_triangle(std::size_t index, const Triangle<P>& s) {
        auto surface = to_surface(s);
        if (surface.bound > 0)
            approximations_.push_back(
                {object_label(document_, index), "a triangle, as a surface with a pole", surface.bound, 0});
        return builder_.add(std::move(surface.parts[0]), document_.objects[index].name);
    }

    const Document& document_;
    ModelBuilder builder_;
    bool has_surfaces_ = false;
    std::vector<std::size_t> loose_;  // the objects of the faces of builder_
    std::vector<std::pair<std::size_t, const Model*>> models_;
    std::vector<Refusal> without_faces_;
    std::vector<Approximation> approximations_;
};

}  // namespace

Result<Scene> scene_with_owners(const Document& document, std::span<const std::size_t> objects) {
    SceneBuilder scene(document);
    for (std::size_t k = 0; k < (objects.empty() ? document.objects.size() : objects.size()); ++k)
        if (auto ok = scene.add(objects.empty() ? k : objects[k]); !ok) return std::unexpected(ok.error());
    return std::move(scene).finish();
}

Result<Model> scene_of(const Document& document, std::span<const std::size_t> objects) {
    auto scene = scene_with_owners(document, objects);
    if (!scene) return std::unexpected(scene.error());
    return std::move(scene->model);
}

}  // namespace freiform

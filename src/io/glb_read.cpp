// Plain glTF 2.0 in one binary file: the meshes of one scene with their nodes' matrices, turned to Z up. A
// root node of our own writer names the unit of the model; its matrix, which only goes to metres and Y up, is
// left out, so that the stored floats come back as they are.
//
// Every offset is compared with the bytes that are there; nodes are walked with a stack of our own, and one
// that is met twice is refused, so that a cycle ends.
#include "io/glb_chunks.hpp"
#include "io/gltf_matrix.hpp"
#include "io/mesh_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <ranges>

namespace freiform {
namespace {

using gltf::elements, gltf::Found, gltf::member, gltf::string_of, gltf::whole;

// One accessor whose bytes have been found and measured.
struct BufferView {
    const char* first = nullptr;
    std::size_t count = 0, stride = 0;
    int type = 0;
};

class GlbReader {
public:
    GlbReader(const std::string& name, const MeshReadOptions& options) : name_(name), builder_(options) {}

    Result<TriangleMesh> read(std::string_view bytes) {
        const auto chunks = chunks_of_glb(bytes);
        if (!chunks) return within_file(chunks.error());
        // Nothing here goes down a tree by recursion.
        const auto tree = json::parse(chunks->json, chunks->json.size());
        if (!tree) {
            Refusal r = tree.error();
            r.where = text("JSON, ", r.where);
            return within_file(std::move(r));
        }
        binary_ = chunks->binary;
        const json::Value root = tree->root();
        if (!root.is(json::Kind::object)) return damaged("JSON", "expected an object");
        if (const auto required = elements(member(root, "extensionsRequired")); !required.empty())
            return refuse(RefusalKind::unsupported, name_,
                          text("needs the extension ", shown(string_of(required[0]))));
        for (List list : {nodes, scenes, meshes, accessors, buffer_views, buffers, materials})
            lists_[list] = elements(member(root, kNames[list]));
        if (auto r = walk(root); !r) return std::unexpected(r.error());
        return builder_.finish(unit_);
    }

private:
    enum List : std::size_t { nodes, scenes, meshes, accessors, buffer_views, buffers, materials };
    static constexpr std::string_view kNames[] = {"nodes",       "scenes",  "meshes",   "accessors",
                                                  "bufferViews", "buffers", "materials"};

    std::unexpected<Refusal> within_file(Refusal r) const {
        r.where = r.where.empty() ? name_ : text(name_, ": ", r.where);
        return std::unexpected(std::move(r));
    }
    std::unexpected<Refusal> damaged(std::string where, std::string message) const {
        return refuse(RefusalKind::unreadable, text(name_, ": ", where), std::move(message));
    }

    // An integer that is not negative, or `missing`; nothing if it is something else.
    static std::optional<std::size_t> integer(const json::Value& object, std::string_view key,
                                              std::optional<std::size_t> missing) {
        const Found v = member(object, key);
        return v ? whole(v) : missing;
    }
    Found item(List list, std::optional<std::size_t> i) const {
        return i && *i < lists_[list].size() ? Found(lists_[list][*i]) : std::nullopt;
    }

    // The numbers of a field of n; `missing` if it is not there.
    template <std::size_t N>
    Result<std::array<double, N>> numbers(const json::Value& object, std::string_view key,
                                          std::array<double, N> missing, const std::string& where) const {
        const Found v = member(object, key);
        if (!v) return missing;
        const auto all = elements(v);
        if (all.size() != N ||
            !std::ranges::all_of(all, [](const auto& x) { return x.is(json::Kind::number); }))
            return damaged(text(where, ".", key), text("expected ", N, " numbers"));
        for (std::size_t i = 0; i < N; ++i) {
            missing[i] = all[i].number();
            if (!std::isfinite(missing[i])) return damaged(text(where, ".", key), "a number is not finite");
        }
        return missing;
    }

    Result<NodeMatrix> matrix_of(const json::Value& node, const std::string& where) const {
        if (member(node, "matrix")) return numbers<16>(node, "matrix", kIdentity, where);
        const auto t = numbers<3>(node, "translation", {0, 0, 0}, where);
        const auto q = numbers<4>(node, "rotation", {0, 0, 0, 1}, where);
        const auto s = numbers<3>(node, "scale", {1, 1, 1}, where);
        if (!t) return std::unexpected(t.error());
        if (!q) return std::unexpected(q.error());
        if (!s) return std::unexpected(s.error());
        const auto [x, y, z, w] = *q;
        const auto [a, b, c] = *s;
        return NodeMatrix{a * (1 - 2 * (y * y + z * z)),
                          a * 2 * (x * y + z * w),
                          a * 2 * (x * z - y * w),
                          0,
                          b * 2 * (x * y - z * w),
                          b * (1 - 2 * (x * x + z * z)),
                          b * 2 * (y * z + x * w),
                          0,
                          c * 2 * (x * z + y * w),
                          c * 2 * (y * z - x * w),
                          c * (1 - 2 * (x * x + y * y)),
                          0,
                          (*t)[0],
                          (*t)[1],
                          (*t)[2],
                          1};
    }

    struct Visit {
        std::size_t node = 0;
        NodeMatrix matrix = kYUpToZUp;
    };

    Result<void> push_nodes(const Found& list, const NodeMatrix& matrix, std::vector<Visit>& stack,
                            const std::string& where) {
        if (!list) return {};
        if (!list->is(json::Kind::array)) return damaged(where, "expected a list of nodes");
        for (const json::Value& v : std::views::reverse(elements(list))) {
            const auto node = whole(v);
            if (!node) return damaged(where, "expected a list of nodes");
            stack.push_back({*node, matrix});
        }
        return {};
    }

    Result<void> walk(const json::Value& root) {
        const auto number = integer(root, "scene", 0);
        if (!number) return damaged("scene", "expected an index");
        const Found scene = item(scenes, number);
        if (!scene) return {};  // a library of meshes that shows nothing
        std::vector<Visit> stack;
        if (auto r = push_nodes(member(*scene, "nodes"), kYUpToZUp, stack, "scenes.nodes"); !r) return r;
        std::vector<bool> met(lists_[nodes].size());
        const bool single_root = stack.size() == 1;
        bool at_root = true;
        while (!stack.empty()) {
            const Visit visit = stack.back();
            stack.pop_back();
            const std::string where = text("nodes[", visit.node, "]");
            const Found node = item(nodes, visit.node);
            if (!node || !node->is(json::Kind::object))
                return damaged(where, text("there are ", met.size(), " nodes"));
            if (met[visit.node]) return damaged(where, "is the child of two nodes");
            met[visit.node] = true;
            const auto own = matrix_of(*node, where);
            if (!own) return std::unexpected(own.error());
            NodeMatrix matrix = product(visit.matrix, *own);
            if (at_root && single_root) {
                unit_ = "m";
                if (const Found extras = member(*node, "extras"))
                    if (const Found u = member(*extras, "freiform_unit"); u && u->is(json::Kind::string)) {
                        unit_ = u->string();
                        matrix = kIdentity;
                    }
            }
            at_root = false;
            if (member(*node, "mesh"))
                if (auto r = read_mesh_of(*node, matrix, where); !r) return r;
            if (auto r = push_nodes(member(*node, "children"), matrix, stack, text(where, ".children")); !r)
                return r;
        }
        if (unit_.empty() && !single_root) unit_ = "m";
        return {};
    }

    Result<void> read_mesh_of(const json::Value& node, const NodeMatrix& matrix, const std::string& where) {
        const auto number = integer(node, "mesh", std::nullopt);
        const Found mesh = item(meshes, number);
        if (!mesh) return damaged(text(where, ".mesh"), "there is no such mesh");
        const Found primitives = member(*mesh, "primitives");
        if (!primitives || !primitives->is(json::Kind::array))
            return damaged(text("meshes[", *number, "].primitives"), "expected a list");
        std::string name = string_of(member(*mesh, "name"));
        if (name.empty() && !member(node, "children")) name = string_of(member(node, "name"));
        std::size_t i = 0;
        for (const json::Value& primitive : primitives->elements()) {
            const std::string here = text("meshes[", *number, "].primitives[", i++, "]");
            if (auto r = read_primitive(primitive, name, matrix, here); !r) return r;
        }
        return {};
    }

    Result<BufferView> view_of(const json::Value& holder, std::string_view key, std::string_view type,
                               const std::string& where) const {
        const std::string here = text(where, ".", key);
        const Found accessor = item(accessors, integer(holder, key, std::nullopt));
        if (!accessor) return damaged(here, "there is no such accessor");
        if (string_of(member(*accessor, "type")) != type)
            return damaged(here, text("expected an accessor of type ", type));
        if (member(*accessor, "sparse"))
            return refuse(RefusalKind::unsupported, text(name_, ": ", here), "a sparse accessor");
        const auto component = integer(*accessor, "componentType", 0),
                   count = integer(*accessor, "count", std::nullopt);
        const auto offset = integer(*accessor, "byteOffset", 0);
        const Found buffer_view = item(buffer_views, integer(*accessor, "bufferView", std::nullopt));
        if (!component || !count || !offset || !buffer_view)
            return damaged(here, "the accessor has no view, count or offset");
        const auto view_offset = integer(*buffer_view, "byteOffset", 0),
                   length = integer(*buffer_view, "byteLength", std::nullopt);
        const auto buffer = integer(*buffer_view, "buffer", std::nullopt);
        const Found first_buffer = item(buffers, 0);
        if (!buffer || *buffer != 0 || !first_buffer || member(*first_buffer, "uri"))
            return refuse(RefusalKind::unsupported, text(name_, ": ", here),
                          "the data are not in the file itself");
        if (!view_offset || !length || *view_offset > binary_.size() ||
            *length > binary_.size() - *view_offset)
            return damaged(here,
                           text("its view leads outside the ", binary_.size(), " bytes of the binary chunk"));

        const bool scalar = type == "SCALAR";
        const std::size_t size = scalar ? (*component == 5121   ? 1
                                           : *component == 5123 ? 2
                                           : *component == 5125 ? 4
                                                                : 0)
                                        : (*component == 5126 ? 12 : 0);
        if (size == 0)
            return refuse(RefusalKind::unsupported, text(name_, ": ", here),
                          text("components of type ", *component));
        const auto stride = integer(*buffer_view, "byteStride", size);
        if (!stride || *stride < size || *stride > 252)
            return damaged(here, "a stride that does not fit the components");
        if (*count > 0 && (*offset > *length || *length - *offset < size ||
                           (*count - 1) > (*length - *offset - size) / *stride))
            return damaged(here,
                           text(*count, " items of ", *stride, " bytes do not fit into ", *length, " bytes"));
        return BufferView{binary_.data() + *view_offset + *offset, *count, *stride, int(*component)};
    }

    std::optional<Colour> colour_of(const json::Value& primitive) const {
        const Found material = item(materials, integer(primitive, "material", std::nullopt));
        const Found surface = material ? member(*material, "pbrMetallicRoughness") : std::nullopt;
        if (!surface || !member(*surface, "baseColorFactor")) return std::nullopt;
        const auto c = numbers<4>(*surface, "baseColorFactor", {1, 1, 1, 1}, "materials");
        if (!c) return std::nullopt;
        const auto encoded = [](double x) {
            x = std::clamp(x, 0.0, 1.0);
            return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
        };
        const auto [r, g, b, a] = *c;
        return Colour{std::clamp(encoded(r), 0.0, 1.0), std::clamp(encoded(g), 0.0, 1.0),
                      std::clamp(encoded(b), 0.0, 1.0), std::clamp(a, 0.0, 1.0)};
    }

    static Vec<3> vector_at(const BufferView& view, std::size_t i) {
        std::array<float, 3> x;
        std::memcpy(x.data(), view.first + i * view.stride, sizeof x);
        return {{x[0], x[1], x[2]}};
    }
    static std::size_t index_at(const BufferView& view, std::size_t i) {
        const char* at = view.first + i * view.stride;
        std::uint32_t x = 0;
        std::memcpy(&x, at, view.type == 5121 ? 1 : view.type == 5123 ? 2 : 4);
        return x;
    }

    Result<void> read_primitive(const json::Value& primitive, const std::string& part,
                                const NodeMatrix& matrix, const std::string& where) {
        const auto mode = integer(primitive, "mode", 4);
        if (!mode || *mode != 4)
            return refuse(RefusalKind::unsupported, text(name_, ": ", where),
                          "only lists of triangles are read (mode 4)");
        const Found attributes = member(primitive, "attributes");
        if (!attributes) return damaged(where, "has no attributes");
        const auto positions = view_of(*attributes, "POSITION", "VEC3", where);
        if (!positions) return std::unexpected(positions.error());
        std::optional<BufferView> normals, indices;
        if (member(*attributes, "NORMAL")) {
            auto view = view_of(*attributes, "NORMAL", "VEC3", where);
            if (!view) return std::unexpected(view.error());
            if (view->count < positions->count) return damaged(where, "fewer normals than positions");
            normals = *view;
        }
        if (member(primitive, "indices")) {
            auto view = view_of(primitive, "indices", "SCALAR", where);
            if (!view) return std::unexpected(view.error());
            indices = *view;
        }
        const std::size_t corners = indices ? indices->count : positions->count;
        if (corners % 3) return damaged(where, text(corners, " indices are no triangles"));
        if (!builder_.room_for(corners / 3))
            return refuse(RefusalKind::limit, text(name_, ": ", where),
                          text(corners / 3, " more triangles than the limit allows"));

        builder_.begin_part(part, colour_of(primitive));
        const bool mirrored = determinant(matrix) < 0;
        std::array<int, 3> v{};
        for (std::size_t i = 0; i < corners; ++i) {
            const std::size_t k = indices ? index_at(*indices, i) : i;
            if (k >= positions->count)
                return damaged(where, text("index ", k, " at place ", i, ", there are ", positions->count,
                                           " positions"));
            const Vec<3> p = moved(matrix, vector_at(*positions, k));
            if (!is_finite(p))
                return refuse(RefusalKind::nonfinite, text(name_, ": ", where),
                              text("position ", k, " is not finite"));
            const Vec<3> n = normals ? turned(matrix, vector_at(*normals, k)) : Vec<3>{};
            v[i % 3] = builder_.vertex(builder_.point(p), n);
            if (i % 3 < 2) continue;
            if (mirrored) std::swap(v[1], v[2]);
            if (auto r = builder_.triangle(name_, v[0], v[1], v[2]); !r) return r;
        }
        return {};
    }

    const std::string& name_;
    MeshBuilder builder_;
    std::array<std::vector<json::Value>, 7> lists_;
    std::string_view binary_;
    std::string unit_;
};

}  // namespace

Result<TriangleMesh> parse_glb(std::string_view bytes, const std::string& name,
                               const MeshReadOptions& options) {
    return GlbReader(name, options).read(bytes);
}

}  // namespace freiform

// Plain glTF 2.0 in one binary file: the meshes of one scene with their nodes' matrices, turned to Z up. A
// root node of our own writer names the unit of the model; its matrix, which only goes to metres and Y up, is
// left out, so that the stored floats come back as they are.
//
// Every offset is compared with the bytes that are there; nodes are walked with a stack of our own, and one
// that is met twice is refused, so that a cycle ends.
#include "io/glb_read_detail.hpp"
#include "io/mesh_builder.hpp"

#include <array>
#include <cmath>
#include <cstring>

namespace freiform {
namespace {

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
        if (auto r = split(bytes); !r) return std::unexpected(r.error());
        if (const Json* required = find(json_, "extensionsRequired"); required && !required->empty())
            return refuse(
                RefusalKind::unsupported, name_,
                text("needs the extension ", required->is_array() && (*required)[0].is_string()
                                                 ? shown((*required)[0].get_ref<const std::string&>())
                                                 : "?"));
        if (auto r = walk(); !r) return std::unexpected(r.error());
        return builder_.finish(unit_);
    }

private:
    auto damaged(std::string where, std::string message) const {
        return refuse(RefusalKind::unreadable, text(name_, ": ", where), std::move(message));
    }

    Result<void> split(std::string_view bytes) {
        const auto word = [&](std::size_t at) {
            std::uint32_t w = 0;
            std::memcpy(&w, bytes.data() + at, 4);
            return w;
        };
        if (bytes.size() < 20 || word(0) != 0x46546c67)
            return refuse(RefusalKind::unreadable, name_, "the file does not begin with \"glTF\"");
        if (word(4) != 2)
            return refuse(RefusalKind::unsupported, name_, text("glTF version ", word(4), ", expected 2"));
        const std::size_t total = word(8), json_size = word(12);
        if (total > bytes.size() || total < 20)
            return damaged("byte 8", text("the length says ", total, " bytes, the file has ", bytes.size()));
        if (word(16) != 0x4e4f534a || json_size > total - 20)
            return damaged("byte 12", text("expected a JSON chunk, found one of ", json_size, " bytes, ",
                                           total - 20, " are left"));
        const std::string_view text_of_json = bytes.substr(20, json_size);
        json_ = Json::parse(text_of_json, nullptr, false);
        if (json_.is_discarded()) {
            Locator locator;
            Json::sax_parse(text_of_json, &locator);
            return damaged(text("byte ", 20 + locator.byte), "not JSON");
        }
        if (!json_.is_object()) return damaged("byte 20", "the JSON is not an object");
        const std::size_t at = 20 + json_size;
        if (total - at < 8) return {};
        const std::size_t size = word(at);
        if (word(at + 4) != 0x004e4942) return {};
        if (size > total - at - 8)
            return damaged(text("byte ", at),
                           text("a chunk of ", size, " bytes, ", total - at - 8, " are left"));
        binary_ = bytes.substr(at + 8, size);
        return {};
    }

    static const Json* find(const Json& object, const char* key) {
        if (!object.is_object()) return nullptr;
        const auto it = object.find(key);
        return it == object.end() ? nullptr : &*it;
    }
    // An integer that is not negative, or `missing`; nothing if it is something else.
    static std::optional<std::size_t> integer(const Json& object, const char* key,
                                              std::optional<std::size_t> missing) {
        const Json* v = find(object, key);
        if (!v) return missing;
        if (v->is_number_unsigned()) return v->get<std::size_t>();
        return std::nullopt;
    }
    const Json* item(const char* list, std::size_t i) const {
        const Json* array = find(json_, list);
        return array && array->is_array() && i < array->size() ? &(*array)[i] : nullptr;
    }
    static std::string name_of_json(const Json& object) {
        const Json* v = find(object, "name");
        return v && v->is_string() ? v->get<std::string>() : "";
    }

    // The numbers of a field of n; `missing` if it is not there.
    template <std::size_t N>
    Result<std::array<double, N>> numbers(const Json& object, const char* key, std::array<double, N> missing,
                                          const std::string& where) const {
        const Json* v = find(object, key);
        if (!v) return missing;
        if (!v->is_array() || v->size() != N)
            return damaged(text(where, ".", key), text("expected ", N, " numbers"));
        for (std::size_t i = 0; i < N; ++i) {
            if (!(*v)[i].is_number()) return damaged(text(where, ".", key), text("expected ", N, " numbers"));
            missing[i] = (*v)[i].template get<double>();
            if (!std::isfinite(missing[i])) return damaged(text(where, ".", key), "a number is not finite");
        }
        return missing;
    }

    Result<NodeMatrix> matrix_of(const Json& node, const std::string& where) const {
        if (find(node, "matrix")) return numbers<16>(node, "matrix", kIdentity, where);
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

    Result<void> push_nodes(const Json* list, const NodeMatrix& matrix, std::vector<Visit>& stack,
                            const std::string& where) {
        if (!list) return {};
        if (!list->is_array()) return damaged(where, "expected a list of nodes");
        for (auto it = list->rbegin(); it != list->rend(); ++it) {
            if (!it->is_number_unsigned()) return damaged(where, "expected a list of nodes");
            stack.push_back({it->get<std::size_t>(), matrix});
        }
        return {};
    }

    Result<void> walk() {
        const auto number = integer(json_, "scene", 0);
        if (!number) return damaged("scene", "expected an index");
        const Json* scene = item("scenes", *number);
        if (!scene) return {};  // a library of meshes that shows nothing
        std::vector<Visit> stack;
        if (auto r = push_nodes(find(*scene, "nodes"), kYUpToZUp, stack, "scenes.nodes"); !r) return r;
        std::vector<bool> met(
            find(json_, "nodes") && find(json_, "nodes")->is_array() ? find(json_, "nodes")->size() : 0);
        const bool single_root = stack.size() == 1;
        bool at_root = true;
        while (!stack.empty()) {
            const Visit visit = stack.back();
            stack.pop_back();
            const std::string where = text("nodes[", visit.node, "]");
            const Json* node = item("nodes", visit.node);
            if (!node || !node->is_object()) return damaged(where, text("there are ", met.size(), " nodes"));
            if (met[visit.node]) return damaged(where, "is the child of two nodes");
            met[visit.node] = true;
            const auto own = matrix_of(*node, where);
            if (!own) return std::unexpected(own.error());
            NodeMatrix matrix = product(visit.matrix, *own);
            if (at_root && single_root) {
                unit_ = "m";
                if (const Json* extras = find(*node, "extras"))
                    if (const Json* u = find(*extras, "freiform_unit"); u && u->is_string()) {
                        unit_ = u->get<std::string>();
                        matrix = kIdentity;
                    }
            }
            at_root = false;
            if (find(*node, "mesh"))
                if (auto r = read_mesh_of(*node, matrix, where); !r) return r;
            if (auto r = push_nodes(find(*node, "children"), matrix, stack, text(where, ".children")); !r)
                return r;
        }
        if (unit_.empty() && !single_root) unit_ = "m";
        return {};
    }

    Result<void> read_mesh_of(const Json& node, const NodeMatrix& matrix, const std::string& where) {
        const auto number = integer(node, "mesh", std::nullopt);
        const Json* mesh = number ? item("meshes", *number) : nullptr;
        if (!mesh) return damaged(text(where, ".mesh"), "there is no such mesh");
        const Json* primitives = find(*mesh, "primitives");
        if (!primitives || !primitives->is_array())
            return damaged(text("meshes[", *number, "].primitives"), "expected a list");
        std::string name = name_of_json(*mesh);
        if (name.empty() && !find(node, "children")) name = name_of_json(node);
        for (std::size_t i = 0; i < primitives->size(); ++i) {
            const std::string here = text("meshes[", *number, "].primitives[", i, "]");
            if (auto r = read_primitive((*primitives)[i], name, matrix, here); !r) return r;
        }
        return {};
    }

    Result<BufferView> view_of(const Json& holder, const char* key, std::string_view type,
                               const std::string& where) const {
        const std::string here = text(where, ".", key);
        const auto number = integer(holder, key, std::nullopt);
        const Json* accessor = number ? item("accessors", *number) : nullptr;
        if (!accessor) return damaged(here, "there is no such accessor");
        const Json* given = find(*accessor, "type");
        if (!given || !given->is_string() || given->get_ref<const std::string&>() != type)
            return damaged(here, text("expected an accessor of type ", type));
        if (find(*accessor, "sparse"))
            return refuse(RefusalKind::unsupported, text(name_, ": ", here), "a sparse accessor");
        const auto component = integer(*accessor, "componentType", 0),
                   count = integer(*accessor, "count", std::nullopt);
        const auto offset = integer(*accessor, "byteOffset", 0),
                   index = integer(*accessor, "bufferView", std::nullopt);
        const Json* buffer_view = index ? item("bufferViews", *index) : nullptr;
        if (!component || !count || !offset || !buffer_view)
            return damaged(here, "the accessor has no view, count or offset");
        const auto view_offset = integer(*buffer_view, "byteOffset", 0),
                   length = integer(*buffer_view, "byteLength", std::nullopt);
        const auto buffer = integer(*buffer_view, "buffer", std::nullopt);
        const Json* first_buffer = item("buffers", 0);
        if (!buffer || *buffer != 0 || !first_buffer || find(*first_buffer, "uri"))
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

    std::optional<Colour> colour_of(const Json& primitive) const {
        const auto number = integer(primitive, "material", std::nullopt);
        const Json* material = number ? item("materials", *number) : nullptr;
        const Json* surface = material ? find(*material, "pbrMetallicRoughness") : nullptr;
        if (!surface || !find(*surface, "baseColorFactor")) return std::nullopt;
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

    Result<void> read_primitive(const Json& primitive, const std::string& part, const NodeMatrix& matrix,
                                const std::string& where) {
        const auto mode = integer(primitive, "mode", 4);
        if (!mode || *mode != 4)
            return refuse(RefusalKind::unsupported, text(name_, ": ", where),
                          "only lists of triangles are read (mode 4)");
        const Json* attributes = find(primitive, "attributes");
        if (!attributes) return damaged(where, "has no attributes");
        const auto positions = view_of(*attributes, "POSITION", "VEC3", where);
        if (!positions) return std::unexpected(positions.error());
        std::optional<BufferView> normals, indices;
        if (find(*attributes, "NORMAL")) {
            auto view = view_of(*attributes, "NORMAL", "VEC3", where);
            if (!view) return std::unexpected(view.error());
            if (view->count < positions->count) return damaged(where, "fewer normals than positions");
            normals = *view;
        }
        if (find(primitive, "indices")) {
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
    Json json_;
    std::string_view binary_;
    std::string unit_;
};

}  // namespace

Result<TriangleMesh> parse_glb(std::string_view bytes, const std::string& name,
                               const MeshReadOptions& options) {
    return GlbReader(name, options).read(bytes);
}

}  // namespace freiform

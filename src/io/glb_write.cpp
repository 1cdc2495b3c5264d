// Idea. One buffer with four views: positions, normals, 16-bit and 32-bit indices. A group collects the parts
// of one name and one colour and becomes one primitive; the groups of one name are one mesh with one node.
//
//     node 0 (unit -> metre, Z up -> Y up) - node per name (moves and scales back if need be) - mesh -
//     primitives
//
// Accuracy. Positions are floats. Where the model is more than eight times as far from the origin as it is
// large they are taken relative to its middle, so that the rounding error stays below 2^-20 of its size;
// where the size leaves [2^-60, 2^60] they are scaled by a power of two. The nodes undo both.
//
// Why a matrix and not a rotation: the quaternion of a right angle is irrational, the matrix is exact.
#include "io/mesh_bytes.hpp"

#include <freiform/io/mesh_file.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

namespace freiform {
namespace {

using Json = nlohmann::ordered_json;

enum { kByteStrideOfPoint = 12, kArrayBuffer = 34962, kElementArrayBuffer = 34963 };
enum { kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126 };

struct Group {
    std::size_t mesh = 0, material = 0;
    std::vector<MeshPart> parts;
    // Filled by `emit`: what the primitive takes of the four views.
    std::size_t first_vertex = 0, vertices = 0, indices = 0, index_offset = 0;
    bool wide = false;
    FloatPoint lo{}, hi{};
};

struct Groups {
    std::vector<Group> groups;
    std::vector<std::string> meshes;               // names
    std::vector<std::optional<Colour>> materials;  // colours
};

Groups group_parts(const TriangleMesh& mesh) {
    Groups out;
    std::map<std::string, std::size_t> mesh_index;
    std::map<std::array<double, 5>, std::size_t> material_index;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> group_index;
    for (MeshPart& part : parts_of(mesh)) {
        const Colour c = part.colour.value_or(Colour{});
        const auto [m, new_mesh] = mesh_index.try_emplace(part.name, out.meshes.size());
        if (new_mesh) out.meshes.push_back(part.name);
        const auto [k, new_material] = material_index.try_emplace(
            std::array{part.colour ? 1.0 : 0.0, c.r, c.g, c.b, c.a}, out.materials.size());
        if (new_material) out.materials.push_back(part.colour);
        const auto [g, new_group] = group_index.try_emplace({m->second, k->second}, out.groups.size());
        if (new_group) out.groups.push_back({.mesh = m->second, .material = k->second, .parts = {}});
        out.groups[g->second].parts.push_back(std::move(part));
    }
    return out;
}

Placement placement_of(const TriangleMesh& mesh) {
    Placement placement;
    const Box<3> box = box_of(mesh);
    if (box.is_empty()) return placement;
    Vec<3> half, middle;
    for (int d = 0; d < 3; ++d) {
        half[d] = box.hi[d] / 2 - box.lo[d] / 2;
        middle[d] = box.lo[d] / 2 + box.hi[d] / 2;
    }
    const double size = max_abs(half);
    if (size == 0) return placement;
    if (box.scale() > 16 * size) placement.centre = middle;
    const int exponent = std::ilogb(size);
    if (std::abs(exponent) > 60) placement.exponent = exponent;
    return placement;
}

class GlbWriter {
public:
    GlbWriter(const TriangleMesh& mesh, const MeshWriteOptions& options) : mesh_(mesh), options_(options) {}

    Result<std::string> bytes() {
        if (auto r = validate(mesh_); !r) return std::unexpected(r.error());
        placement_ = placement_of(mesh_);
        auto points = float_points(mesh_, placement_);
        if (!points) return std::unexpected(points.error());
        points_ = std::move(*points);
        all_ = group_parts(mesh_);
        vertex_in_group_.assign(mesh_.vertices.size(), {-1, 0});
        for (std::size_t g = 0; g < all_.groups.size(); ++g) emit(all_.groups[g], int(g));
        std::erase_if(all_.groups, [](const Group& g) { return g.indices == 0; });
        return assemble();
    }

private:
    std::uint32_t add_vertex(Group& group, int point, const Vec<3>& normal) {
        const FloatPoint& p = points_[std::size_t(point)];
        const Vec<3> n =
            normal == Vec<3>{} ? Vec<3>{{0, 0, 1}} : unit(normal);  // the format demands a direction
        positions_.push_back(p);
        normals_.push_back({float(n[0]), float(n[1]), float(n[2])});
        if (group.vertices == 0) group.lo = group.hi = p;
        for (std::size_t d = 0; d < 3; ++d) {
            group.lo[d] = std::min(group.lo[d], p[d]);
            group.hi[d] = std::max(group.hi[d], p[d]);
        }
        return std::uint32_t(group.vertices++);
    }

    void emit(Group& group, int number) {
        group.first_vertex = positions_.size();
        std::vector<std::uint32_t> indices;
        for (const MeshPart& part : group.parts)
            for (int i = part.first; i < part.first + part.count; ++i) {
                const auto t = std::size_t(i);
                if (!has_three_points(points_, mesh_.points_of(t))) continue;
                for (int v : mesh_.triangles[t]) {
                    const MeshVertex& vertex = mesh_.vertices[std::size_t(v)];
                    if (vertex.normal == Vec<3>{}) {
                        indices.push_back(add_vertex(group, vertex.point, triangle_normal(mesh_, t)));
                        continue;
                    }
                    auto& [in_group, index] = vertex_in_group_[std::size_t(v)];
                    if (in_group != number) index = add_vertex(group, vertex.point, vertex.normal);
                    in_group = number;
                    indices.push_back(index);
                }
            }
        // 65535 restarts a primitive and is no index.
        group.indices = indices.size();
        group.wide = group.vertices > 65535;
        group.index_offset = group.wide ? 4 * wide_.size() : 2 * narrow_.size();
        if (group.wide)
            wide_.insert(wide_.end(), indices.begin(), indices.end());
        else
            for (std::uint32_t i : indices) narrow_.push_back(std::uint16_t(i));
    }

    Json nodes() const {
        const double s = metres_per(mesh_.unit).value_or(1);
        Json root{{"name", "model"}, {"matrix", {s, 0, 0, 0, 0, 0, -s, 0, 0, s, 0, 0, 0, 0, 0, 1}}};
        root["extras"] = {{"freiform_unit", mesh_.unit}};
        root["children"] = Json::array();
        Json out = Json::array({std::move(root)});
        const double k = std::scalbn(1.0, placement_.exponent);
        const Vec<3>& c = placement_.centre;
        for (std::size_t i = 0; i < all_.meshes.size(); ++i) {
            Json node{{"mesh", i}};
            if (!all_.meshes[i].empty()) node["name"] = all_.meshes[i];
            if (k != 1 || c != Vec<3>{})
                node["matrix"] = {k, 0, 0, 0, 0, k, 0, 0, 0, 0, k, 0, c[0], c[1], c[2], 1};
            out[0]["children"].push_back(i + 1);
            out.push_back(std::move(node));
        }
        return out;
    }

    Json materials() const {
        const auto linear = [](double x) {
            return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
        };
        Json out = Json::array();
        for (const auto& c : all_.materials) {
            Json surface{{"metallicFactor", 0}, {"roughnessFactor", 0.5}};
            if (c) surface["baseColorFactor"] = {linear(c->r), linear(c->g), linear(c->b), c->a};
            Json material{{"pbrMetallicRoughness", std::move(surface)}, {"doubleSided", true}};
            if (c && c->a < 1) material["alphaMode"] = "BLEND";
            out.push_back(std::move(material));
        }
        return out;
    }

    // Meshes and accessors together, as the first refer to the second.
    void add_primitives(Json& json) const {
        Json meshes = Json::array(), accessors = Json::array();
        for (const std::string& name : all_.meshes) {
            meshes.push_back({{"primitives", Json::array()}});
            if (!name.empty()) meshes.back()["name"] = name;
        }
        for (const Group& g : all_.groups) {
            const std::size_t first = accessors.size(), offset = kByteStrideOfPoint * g.first_vertex;
            meshes[g.mesh]["primitives"].push_back(
                {{"attributes", {{"POSITION", first}, {"NORMAL", first + 1}}},
                 {"indices", first + 2},
                 {"material", g.material}});
            const Json vertices{{"componentType", kFloat}, {"count", g.vertices}, {"type", "VEC3"}};
            Json positions{{"bufferView", 0}, {"byteOffset", offset}},
                normals{{"bufferView", 1}, {"byteOffset", offset}};
            positions.update(vertices);
            positions["min"] = {double(g.lo[0]), double(g.lo[1]), double(g.lo[2])};
            positions["max"] = {double(g.hi[0]), double(g.hi[1]), double(g.hi[2])};
            normals.update(vertices);
            accessors.push_back(std::move(positions));
            accessors.push_back(std::move(normals));
            accessors.push_back({{"bufferView", g.wide && !narrow_.empty() ? 3 : 2},
                                 {"byteOffset", g.index_offset},
                                 {"componentType", g.wide ? kUnsignedInt : kUnsignedShort},
                                 {"count", g.indices},
                                 {"type", "SCALAR"}});
        }
        json["meshes"] = std::move(meshes);
        json["accessors"] = std::move(accessors);
    }

    // Meshes and materials that lost all their triangles would be without use, and a mesh must not be empty.
    void drop_unused() {
        const auto keep_used = [this](auto& items, std::size_t Group::*member) {
            std::vector<std::size_t> new_index(items.size(), 0);
            std::vector<bool> used(items.size(), false);
            for (const Group& g : all_.groups) used[g.*member] = true;
            std::size_t n = 0;
            for (std::size_t i = 0; i < items.size(); ++i)
                if (used[i]) {
                    new_index[i] = n;
                    if (n != i) items[n] = std::move(items[i]);
                    ++n;
                }
            items.resize(n);
            for (Group& g : all_.groups) g.*member = new_index[g.*member];
        };
        keep_used(all_.meshes, &Group::mesh);
        keep_used(all_.materials, &Group::material);
    }

    Result<std::string> assemble() {
        drop_unused();
        if (narrow_.size() % 2) narrow_.push_back(0);
        const std::array<std::size_t, 4> sizes{kByteStrideOfPoint * positions_.size(),
                                               kByteStrideOfPoint * normals_.size(), 2 * narrow_.size(),
                                               4 * wide_.size()};
        Json json{{"asset", {{"version", "2.0"}, {"generator", options_.generator}}}, {"scene", 0}};
        json["scenes"] = Json::array({Json::object()});
        std::size_t binary = 0;
        if (!all_.groups.empty()) {
            json["scenes"][0]["nodes"] = Json::array({0});
            json["nodes"] = nodes();
            json["materials"] = materials();
            add_primitives(json);
            json["bufferViews"] = Json::array();
            for (std::size_t i = 0; i < 4; ++i) {
                if (sizes[i] == 0) continue;
                Json view{{"buffer", 0}, {"byteOffset", binary}, {"byteLength", sizes[i]}};
                if (i < 2) view["byteStride"] = int(kByteStrideOfPoint);
                view["target"] = int(i < 2 ? kArrayBuffer : kElementArrayBuffer);
                json["bufferViews"].push_back(std::move(view));
                binary += sizes[i];
            }
            json["buffers"] = Json::array({Json{{"byteLength", binary}}});
        }
        std::string head = json.dump(-1, ' ', false, Json::error_handler_t::replace);
        head.append((4 - head.size() % 4) % 4, ' ');

        const std::size_t total = 12 + 8 + head.size() + (binary ? 8 + binary : 0);
        if (total > std::numeric_limits<std::uint32_t>::max())
            return refuse(RefusalKind::limit, "mesh",
                          text("needs ", total, " bytes; a .glb file has at most ", std::uint32_t(-1)));
        std::string bytes(total, '\0');
        ByteCursor out(bytes.data());
        const auto put = [&out](const void* data, std::size_t n) {
            if (n > 0) std::memcpy(out.at(), data, n);
            out = ByteCursor(out.at() + n);
        };
        for (std::uint32_t word :
             {0x46546c67u, 2u, std::uint32_t(total), std::uint32_t(head.size()), 0x4e4f534au})
            out.put(word);
        put(head.data(), head.size());
        if (binary == 0) return bytes;
        out.put(std::uint32_t(binary));
        out.put(0x004e4942u);
        put(positions_.data(), sizes[0]);
        put(normals_.data(), sizes[1]);
        put(narrow_.data(), sizes[2]);
        put(wide_.data(), sizes[3]);
        return bytes;
    }

    const TriangleMesh& mesh_;
    const MeshWriteOptions& options_;
    Placement placement_;
    std::vector<FloatPoint> points_, positions_, normals_;
    Groups all_;
    std::vector<std::pair<int, std::uint32_t>> vertex_in_group_;
    std::vector<std::uint16_t> narrow_;
    std::vector<std::uint32_t> wide_;
};

}  // namespace

Result<std::string> to_glb(const TriangleMesh& mesh, const MeshWriteOptions& options) {
    return GlbWriter(mesh, options).bytes();
}

}  // namespace freiform

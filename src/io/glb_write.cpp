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
#include "io/glb_chunks.hpp"
#include "io/mesh_bytes.hpp"

#include <freiform/io/mesh_file.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

namespace freiform {
namespace {

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

    void add_nodes(json::Writer& w) const {
        const double s = metres_per(mesh_.unit).value_or(1);
        w.key("nodes").begin_array().begin_object().field("name", "model");
        w.key("matrix").array(std::array<double, 16>{s, 0, 0, 0, 0, 0, -s, 0, 0, s, 0, 0, 0, 0, 0, 1});
        w.key("extras").begin_object().field("freiform_unit", mesh_.unit).end_object();
        w.key("children").begin_array();
        for (std::size_t i = 0; i < all_.meshes.size(); ++i) w.value(i + 1);
        w.end_array().end_object();
        const double k = std::scalbn(1.0, placement_.exponent);
        const Vec<3>& c = placement_.centre;
        for (std::size_t i = 0; i < all_.meshes.size(); ++i) {
            w.begin_object().field("mesh", i);
            if (!all_.meshes[i].empty()) w.field("name", all_.meshes[i]);
            if (k != 1 || c != Vec<3>{})
                w.key("matrix").array(
                    std::array<double, 16>{k, 0, 0, 0, 0, k, 0, 0, 0, 0, k, 0, c[0], c[1], c[2], 1});
            w.end_object();
        }
        w.end_array();
    }

    void add_materials(json::Writer& w) const {
        const auto linear = [](double x) {
            return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
        };
        w.key("materials").begin_array();
        for (const auto& c : all_.materials) {
            w.begin_object().key("pbrMetallicRoughness").begin_object();
            w.field("metallicFactor", 0).field("roughnessFactor", 0.5);
            if (c) w.key("baseColorFactor").array(std::array{linear(c->r), linear(c->g), linear(c->b), c->a});
            w.end_object().field("doubleSided", true);
            if (c && c->a < 1) w.field("alphaMode", "BLEND");
            w.end_object();
        }
        w.end_array();
    }

    // A group's accessors: positions, normals, indices.
    void add_meshes(json::Writer& w) const {
        std::vector<std::vector<std::size_t>> groups_of(all_.meshes.size());
        for (std::size_t g = 0; g < all_.groups.size(); ++g) groups_of[all_.groups[g].mesh].push_back(g);
        w.key("meshes").begin_array();
        for (std::size_t m = 0; m < all_.meshes.size(); ++m) {
            w.begin_object().key("primitives").begin_array();
            for (const std::size_t g : groups_of[m]) {
                w.begin_object().key("attributes").begin_object();
                w.field("POSITION", 3 * g).field("NORMAL", 3 * g + 1).end_object();
                w.field("indices", 3 * g + 2).field("material", all_.groups[g].material).end_object();
            }
            w.end_array();
            if (!all_.meshes[m].empty()) w.field("name", all_.meshes[m]);
            w.end_object();
        }
        w.end_array();
    }

    void add_accessors(json::Writer& w) const {
        const auto begin = [&w](int view, std::size_t offset, int component, std::size_t count,
                                std::string_view type) {
            w.begin_object().field("bufferView", view).field("byteOffset", offset);
            w.field("componentType", component).field("count", count).field("type", type);
        };
        w.key("accessors").begin_array();
        for (const Group& g : all_.groups) {
            const std::size_t offset = kByteStrideOfPoint * g.first_vertex;
            begin(0, offset, kFloat, g.vertices, "VEC3");
            w.key("min").array(std::array<double, 3>{g.lo[0], g.lo[1], g.lo[2]});
            w.key("max").array(std::array<double, 3>{g.hi[0], g.hi[1], g.hi[2]}).end_object();
            begin(1, offset, kFloat, g.vertices, "VEC3");
            w.end_object();
            begin(g.wide && !narrow_.empty() ? 3 : 2, g.index_offset, g.wide ? kUnsignedInt : kUnsignedShort,
                  g.indices, "SCALAR");
            w.end_object();
        }
        w.end_array();
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
        const std::array<std::string_view, 4> parts{bytes_of(positions_), bytes_of(normals_),
                                                    bytes_of(narrow_), bytes_of(wide_)};
        json::Writer w;
        w.begin_object().key("asset").begin_object().field("version", "2.0");
        w.field("generator", options_.generator).end_object().field("scene", 0);
        w.key("scenes").begin_array().begin_object();
        if (all_.groups.empty()) {
            w.end_object().end_array().end_object();
            return glb_file(w.take(), {});
        }
        w.key("nodes").begin_array().value(0).end_array().end_object().end_array();
        add_nodes(w);
        add_materials(w);
        add_meshes(w);
        add_accessors(w);
        std::size_t size = 0;
        w.key("bufferViews").begin_array();
        for (std::size_t i = 0; i < 4; ++i) {
            if (parts[i].empty()) continue;
            w.begin_object()
                .field("buffer", 0)
                .field("byteOffset", size)
                .field("byteLength", parts[i].size());
            if (i < 2) w.field("byteStride", int(kByteStrideOfPoint));
            w.field("target", int(i < 2 ? kArrayBuffer : kElementArrayBuffer)).end_object();
            size += parts[i].size();
        }
        w.end_array().key("buffers").begin_array().begin_object().field("byteLength", size);
        w.end_object().end_array().end_object();
        return glb_file(w.take(), parts);
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

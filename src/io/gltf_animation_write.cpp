// A moving body as .glb: one buffer with times, places (tangent, value, tangent), turns, the body's corners
// and the line.
//
//     node 0 (Z up -> Y up) - node 1 (the body, animated), node 2 (the line)
#include "io/mesh_bytes.hpp"

#include <freiform/io/gltf_animation.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace freiform {
namespace {

using GltfJson = nlohmann::ordered_json;

// Accessors and views over one growing buffer of floats.
class Buffer {
public:
    // Adds numbers, `components` for an element, as an accessor whose index is returned.
    std::size_t add(std::span<const double> numbers, std::size_t components, bool with_range) {
        static constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
        GltfJson accessor{{"bufferView", views_.size()},
                          {"componentType", 5126},
                          {"count", numbers.size() / components},
                          {"type", kTypes[components]}};
        views_.push_back(
            {{"buffer", 0}, {"byteOffset", 4 * floats_.size()}, {"byteLength", 4 * numbers.size()}});
        for (const double x : numbers) {
            in_range_ = in_range_ && std::abs(x) <= double(std::numeric_limits<float>::max());
            floats_.push_back(float(x));
        }
        if (with_range) {
            GltfJson lo = GltfJson::array(), hi = GltfJson::array();
            const auto first = floats_.end() - std::ptrdiff_t(numbers.size());
            for (std::size_t k = 0; k < components; ++k) {
                float least = first[std::ptrdiff_t(k)], most = least;
                for (auto i = first + std::ptrdiff_t(k); i < floats_.end(); i += std::ptrdiff_t(components)) {
                    least = std::min(least, *i), most = std::max(most, *i);
                    if (floats_.end() - i <= std::ptrdiff_t(components)) break;
                }
                lo.push_back(double(least)), hi.push_back(double(most));
            }
            accessor["min"] = lo, accessor["max"] = hi;
        }
        accessors_.push_back(std::move(accessor));
        return accessors_.size() - 1;
    }

    bool in_range() const { return in_range_; }
    std::string glb(GltfJson json) const {
        json["accessors"] = accessors_, json["bufferViews"] = views_;
        json["buffers"] = GltfJson::array({GltfJson{{"byteLength", 4 * floats_.size()}}});
        std::string head = json.dump(-1, ' ', false, GltfJson::error_handler_t::replace);
        head.append((4 - head.size() % 4) % 4, ' ');
        const std::size_t binary = 4 * floats_.size(), total = 12 + 8 + head.size() + 8 + binary;
        std::string bytes(total, '\0');
        ByteCursor out(bytes.data());
        for (const std::uint32_t word :
             {0x46546c67u, 2u, std::uint32_t(total), std::uint32_t(head.size()), 0x4e4f534au})
            out.put(word);
        std::memcpy(out.at(), head.data(), head.size());
        out = ByteCursor(out.at() + head.size());
        out.put(std::uint32_t(binary)), out.put(0x004e4942u);
        std::memcpy(out.at(), floats_.data(), binary);
        return bytes;
    }

private:
    std::vector<float> floats_;
    GltfJson accessors_ = GltfJson::array(), views_ = GltfJson::array();
    bool in_range_ = true;
};

void append(std::vector<double>& out, const Vec<3>& v) { out.insert(out.end(), v.c.begin(), v.c.end()); }

// The body's triangles, each with its own corners and normals.
void add_body(double size, std::vector<double>& corners, std::vector<double>& normals) {
    const Vec<3> tip{{0.7 * size, 0, 0}}, left{{-0.3 * size, 0.25 * size, 0}},
        right{{-0.3 * size, -0.25 * size, 0}}, fin{{-0.3 * size, 0, 0.3 * size}};
    const Vec<3> faces[4][3] = {{tip, right, left}, {tip, left, fin}, {tip, fin, right}, {left, right, fin}};
    for (const auto& f : faces) {
        const Vec<3> normal = unit(cross(f[1] - f[0], f[2] - f[0]));
        for (const Vec<3>& corner : f) append(corners, corner), append(normals, normal);
    }
}

}  // namespace

Result<std::string> to_animated_glb(const GltfMotion& m) {
    const std::size_t n = m.times.size();
    if (n == 0 || m.places.size() != n || m.velocities.size() != n ||
        (!m.facing.empty() && m.facing.size() != n))
        return refuse(RefusalKind::invalid, "times",
                      "as many places, velocities and turns as times are expected");
    constexpr std::size_t kMost = std::size_t(1) << 26;
    if (n > kMost || m.line.size() > kMost)
        return refuse(RefusalKind::limit, "times", text("more than ", kMost, " are not written"));
    for (std::size_t i = 1; i < n; ++i)
        if (!(float(m.times[i]) > float(m.times[i - 1])))
            return refuse(RefusalKind::limit, text("times[", i, "]"),
                          text(m.times[i], " and the time before are the same in the floats of glTF"));
    Buffer buffer;
    std::vector<double> places, turns, line, corners, normals;
    for (std::size_t i = 0; i < n; ++i) {
        append(places, m.velocities[i]), append(places, m.places[i]), append(places, m.velocities[i]);
        if (!m.facing.empty()) {
            const Quaternion& q = m.facing[i];
            turns.insert(turns.end(), {q.x, q.y, q.z, q.w});
        }
    }
    for (const Vec<3>& p : m.line) append(line, p);
    add_body(m.size, corners, normals);
    const std::size_t time = buffer.add(m.times, 1, true), place = buffer.add(places, 3, false);
    GltfJson samplers =
        GltfJson::array({{{"input", time}, {"output", place}, {"interpolation", "CUBICSPLINE"}}});
    GltfJson channels =
        GltfJson::array({{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}});
    if (!turns.empty()) {
        samplers.push_back(
            {{"input", time}, {"output", buffer.add(turns, 4, false)}, {"interpolation", "LINEAR"}});
        channels.push_back({{"sampler", 1}, {"target", {{"node", 1}, {"path", "rotation"}}}});
    }
    const std::size_t corner = buffer.add(corners, 3, true), normal = buffer.add(normals, 3, false);
    GltfJson meshes = GltfJson::array(
        {{{"primitives", GltfJson::array({{{"attributes", {{"POSITION", corner}, {"NORMAL", normal}}},
                                           {"material", 0}}})}}});
    GltfJson root{
        {"name", "motion"}, {"matrix", {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1}}, {"children", {1}}};
    GltfJson nodes = GltfJson::array({root, {{"name", m.name}, {"mesh", 0}}});
    if (line.size() >= 6) {
        meshes.push_back(
            {{"primitives",
              GltfJson::array({{{"attributes", {{"POSITION", buffer.add(line, 3, true)}}}, {"mode", 3}}})}});
        nodes[0]["children"].push_back(2);
        nodes.push_back({{"name", "way"}, {"mesh", 1}});
    }
    if (!buffer.in_range())
        return refuse(RefusalKind::limit, "", "a number is outside the range of the floats of glTF");
    return buffer.glb(
        {{"asset", {{"version", "2.0"}, {"generator", "freiform"}}},
         {"scene", 0},
         {"scenes", {{{"nodes", {0}}}}},
         {"nodes", nodes},
         {"meshes", meshes},
         {"materials",
          {{{"pbrMetallicRoughness",
             {{"metallicFactor", 0}, {"roughnessFactor", 0.5}, {"baseColorFactor", {0.8, 0.25, 0.1, 1}}}},
            {"doubleSided", true}}}},
         {"animations", {{{"name", m.name}, {"channels", channels}, {"samplers", samplers}}}}});
}

}  // namespace freiform

// A moving body as .glb: one buffer with times, places (tangent, value, tangent), turns, the body's corners
// and the line.
//
//     node 0 (Z up -> Y up) - node 1 (the body, animated), node 2 (the line)
#include "io/glb_chunks.hpp"
#include "io/mesh_bytes.hpp"

#include <freiform/io/gltf_animation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace freiform {
namespace {

// Accessors, each with a view of its own, over one growing buffer of floats.
class Buffer {
public:
    // Adds numbers, `components` for an element, as an accessor whose index is returned.
    std::size_t add(std::span<const double> numbers, std::size_t components, bool with_range) {
        Accessor a{floats_.size(), numbers.size(), components, {}, {}};
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            in_range_ = in_range_ && std::abs(numbers[i]) <= double(std::numeric_limits<float>::max());
            const auto x = float(numbers[i]);
            floats_.push_back(x);
            if (!with_range) continue;
            if (i < components) a.lo.push_back(x), a.hi.push_back(x);
            double &lo = a.lo[i % components], &hi = a.hi[i % components];
            lo = std::min(lo, double(x)), hi = std::max(hi, double(x));
        }
        accessors_.push_back(std::move(a));
        return accessors_.size() - 1;
    }

    bool in_range() const { return in_range_; }
    // The file, from JSON whose outermost object is open.
    Result<std::string> glb(json::Writer w) const {
        static constexpr std::string_view kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
        w.key("accessors").begin_array();
        for (std::size_t i = 0; i < accessors_.size(); ++i) {
            const Accessor& a = accessors_[i];
            w.begin_object().field("bufferView", i).field("componentType", 5126);
            w.field("count", a.size / a.components).field("type", kTypes[a.components]);
            if (!a.lo.empty()) w.key("min").array(a.lo).key("max").array(a.hi);
            w.end_object();
        }
        w.end_array().key("bufferViews").begin_array();
        for (const Accessor& a : accessors_) {
            w.begin_object().field("buffer", 0).field("byteOffset", 4 * a.first);
            w.field("byteLength", 4 * a.size).end_object();
        }
        w.end_array().key("buffers").begin_array().begin_object().field("byteLength", 4 * floats_.size());
        w.end_object().end_array().end_object();
        const std::array parts{bytes_of(floats_)};
        return glb_file(w.take(), parts);
    }

private:
    struct Accessor {
        std::size_t first, size, components;
        std::vector<double> lo, hi;  // nothing: not wanted
    };
    std::vector<float> floats_;
    std::vector<Accessor> accessors_;
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
    json::Writer w;
    const auto turn = turns.empty() ? 0 : buffer.add(turns, 4, false);
    const std::size_t corner = buffer.add(corners, 3, true), normal = buffer.add(normals, 3, false);
    const bool has_line = line.size() >= 6;
    const std::size_t way = has_line ? buffer.add(line, 3, true) : 0;
    if (!buffer.in_range())
        return refuse(RefusalKind::limit, "", "a number is outside the range of the floats of glTF");

    w.begin_object().key("asset").begin_object().field("version", "2.0").field("generator", "freiform");
    w.end_object().field("scene", 0).key("scenes").begin_array().begin_object();
    w.key("nodes").array(std::array{0}).end_object().end_array();

    w.key("nodes").begin_array().begin_object().field("name", "motion");
    w.key("matrix").array(std::array{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1});
    w.key("children").begin_array().value(1);
    if (has_line) w.value(2);
    w.end_array().end_object().begin_object().field("name", m.name).field("mesh", 0).end_object();
    if (has_line) w.begin_object().field("name", "way").field("mesh", 1).end_object();
    w.end_array();

    w.key("meshes").begin_array().begin_object().key("primitives").begin_array().begin_object();
    w.key("attributes").begin_object().field("POSITION", corner).field("NORMAL", normal).end_object();
    w.field("material", 0).end_object().end_array().end_object();
    if (has_line) {
        w.begin_object().key("primitives").begin_array().begin_object();
        w.key("attributes").begin_object().field("POSITION", way).end_object();
        w.field("mode", 3).end_object().end_array().end_object();
    }
    w.end_array();

    w.key("materials").begin_array().begin_object().key("pbrMetallicRoughness").begin_object();
    w.field("metallicFactor", 0).field("roughnessFactor", 0.5);
    w.key("baseColorFactor").array(std::array{0.8, 0.25, 0.1, 1.0});
    w.end_object().field("doubleSided", true).end_object().end_array();

    w.key("animations").begin_array().begin_object().field("name", m.name);
    w.key("channels").begin_array();
    const auto channel = [&w](int sampler, std::string_view path) {
        w.begin_object().field("sampler", sampler).key("target").begin_object();
        w.field("node", 1).field("path", path).end_object().end_object();
    };
    channel(0, "translation");
    if (!turns.empty()) channel(1, "rotation");
    w.end_array().key("samplers").begin_array();
    const auto sampler = [&w, time](std::size_t output, std::string_view interpolation) {
        w.begin_object().field("input", time).field("output", output);
        w.field("interpolation", interpolation).end_object();
    };
    sampler(place, "CUBICSPLINE");
    if (!turns.empty()) sampler(turn, "LINEAR");
    w.end_array().end_object().end_array();
    return buffer.glb(std::move(w));
}

}  // namespace freiform

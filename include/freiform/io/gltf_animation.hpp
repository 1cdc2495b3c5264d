// Animations of glTF 2.0: read, evaluated, written.
#pragma once
#include <freiform/animate/rotation.hpp>
#include <freiform/core/result.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace freiform {

enum class GltfPath { translation, rotation, scale, weights };
enum class GltfInterpolation { step, linear, cubic_spline };
std::string_view name_of(GltfPath path);
std::string_view name_of(GltfInterpolation interpolation);

// What one property of one node does over time.
struct GltfChannel {
    std::string node;  // its name, or "nodes[i]"
    GltfPath path = GltfPath::translation;
    GltfInterpolation interpolation = GltfInterpolation::linear;
    std::size_t components = 3;  // of a value: 3, of rotations 4, of weights any number
    std::vector<double> times;   // seconds, increasing
    // For each time a value; of cubic splines the tangent arriving, the value, and the tangent leaving.
    std::vector<double> values;
};

struct GltfAnimation {
    std::string name;
    std::vector<GltfChannel> channels;
};

// Of a .glb file or of the text of a .gltf file, whose buffers are in it, are data URIs, or lie beside it in
// `folder` (empty: these are refused). Names of files that lead out of the folder, and addresses, are
// refused. Refuses (unreadable) by "animations[i].channels[j]" and the like what contradicts itself, times
// that do not increase, numbers that are not finite, (unsupported) sparse accessors and targets without a
// node, whose meaning extensions define.
Result<std::vector<GltfAnimation>> read_gltf_animations(std::string_view bytes,
                                                        const std::filesystem::path& folder = {});

// The value at a time by the rules of the specification: held before the first and after the last key,
// rotations turned at constant speed the shorter way (linear) or normalised (cubic spline). REQUIRES values
// as the channel says, and out.size() == components.
void evaluate(const GltfChannel& channel, double time, std::span<double> out);

// A scene that shows a moving body: a tetrahedron whose tip points along x and whose fin points along z, and
// lines.
struct GltfMotion {
    std::string name = "body";
    double size = 1;  // length of the body
    std::vector<double> times;
    std::vector<Vec<3>> places, velocities;  // cubic splines
    std::vector<Quaternion> facing;          // none: it does not turn
    std::vector<Vec<3>> line;                // where it goes along
};
// As .glb, with z turned up into glTF's y. Refuses (invalid) counts that disagree, (limit) what leaves the
// range of float.
Result<std::string> to_animated_glb(const GltfMotion& motion);

}  // namespace freiform

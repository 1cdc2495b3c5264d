// The container of .glb files: a head, a chunk of JSON, perhaps one of numbers; and access to that JSON.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/io/json.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace freiform {

struct GlbChunks {
    std::string_view json, binary;
};
// Refuses, by "byte N", sizes that contradict each other, and (unsupported) versions other than 2.
Result<GlbChunks> chunks_of_glb(std::string_view bytes);

// Refuses (limit) what has more bytes than the format can count. The parts of the binary chunk have a
// multiple of 4 bytes together.
Result<std::string> glb_file(std::string json, std::span<const std::string_view> binary);

namespace gltf {

using Found = std::optional<json::Value>;

// Of an object; nothing of anything else.
Found member(const json::Value& object, std::string_view key);
// A number that is whole and not negative.
std::optional<std::size_t> whole(const Found& v);
std::string string_of(const Found& v);                  // "" if it is none
std::vector<json::Value> elements(const Found& array);  // none of anything else

}  // namespace gltf
}  // namespace freiform

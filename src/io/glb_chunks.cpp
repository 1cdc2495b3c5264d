#include "io/glb_chunks.hpp"

#include "io/mesh_bytes.hpp"

#include <cmath>
#include <limits>

namespace freiform {
namespace {

constexpr std::uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBinary = 0x004e4942;
constexpr std::size_t kHead = 20;  // three words, and the two of the first chunk

std::size_t word_at(std::string_view bytes, std::size_t at) {
    std::uint32_t w = 0;
    std::memcpy(&w, bytes.data() + at, sizeof w);
    return w;
}

}  // namespace

Result<GlbChunks> chunks_of_glb(std::string_view bytes) {
    const auto damaged = [](std::size_t at, std::string message) {
        return refuse(RefusalKind::unreadable, text("byte ", at), std::move(message));
    };
    if (bytes.size() < kHead || word_at(bytes, 0) != kMagic)
        return refuse(
            RefusalKind::unreadable, "",
            text("the file does not begin with \"glTF\" and ", kHead - 4, " bytes that tell its size"));
    if (word_at(bytes, 4) != 2)
        return refuse(RefusalKind::unsupported, "", text("glTF version ", word_at(bytes, 4), ", expected 2"));
    const std::size_t total = word_at(bytes, 8), json_size = word_at(bytes, 12);
    if (total > bytes.size() || total < kHead)
        return damaged(8, text("the length says ", total, " bytes, the file has ", bytes.size()));
    if (word_at(bytes, 16) != kJson || json_size > total - kHead)
        return damaged(12, text("expected a JSON chunk, found one of ", json_size, " bytes, ", total - kHead,
                                " are left"));
    GlbChunks out{bytes.substr(kHead, json_size), {}};
    const std::size_t at = kHead + json_size;
    if (total - at < 8 || word_at(bytes, at + 4) != kBinary) return out;
    const std::size_t size = word_at(bytes, at);
    if (size > total - at - 8)
        return damaged(at, text("a chunk of ", size, " bytes, ", total - at - 8, " are left"));
    out.binary = bytes.substr(at + 8, size);
    return out;
}

Result<std::string> glb_file(std::string json, std::span<const std::string_view> binary) {
    json.append((4 - json.size() % 4) % 4, ' ');
    std::size_t size = 0;
    for (const std::string_view part : binary) size += part.size();
    const std::size_t total = kHead + json.size() + (size ? 8 + size : 0);
    if (total > std::numeric_limits<std::uint32_t>::max())
        return refuse(RefusalKind::limit, "mesh",
                      text("needs ", total, " bytes; a .glb file has at most ", std::uint32_t(-1)));
    std::string bytes(total, '\0');
    ByteCursor out(bytes.data());
    const auto put = [&out](std::string_view part) {
        if (!part.empty()) std::memcpy(out.at(), part.data(), part.size());
        out = ByteCursor(out.at() + part.size());
    };
    for (const std::uint32_t word : {kMagic, 2u, std::uint32_t(total), std::uint32_t(json.size()), kJson})
        out.put(word);
    put(json);
    if (size == 0) return bytes;
    out.put(std::uint32_t(size)), out.put(kBinary);
    for (const std::string_view part : binary) put(part);
    return bytes;
}

namespace gltf {

Found member(const json::Value& object, std::string_view key) {
    if (object.is(json::Kind::object))
        for (const json::Member& m : object.members())
            if (m.key == key) return m.value;
    return std::nullopt;
}

std::optional<std::size_t> whole(const Found& v) {
    constexpr double kMost = 9007199254740992.0;
    if (!v || !v->is(json::Kind::number)) return std::nullopt;
    const double x = v->number();
    if (!(x >= 0 && x < kMost && x == std::floor(x))) return std::nullopt;
    return std::size_t(x);
}

std::string string_of(const Found& v) { return v && v->is(json::Kind::string) ? v->string() : std::string(); }

std::vector<json::Value> elements(const Found& array) {
    std::vector<json::Value> out;
    if (array && array->is(json::Kind::array))
        for (const json::Value& v : array->elements()) out.push_back(v);
    return out;
}

}  // namespace gltf
}  // namespace freiform

// Reading animations of glTF 2.0.
//
// A channel names a node and one of its properties, and a sampler; a sampler names two accessors, of times
// and of values; an accessor is a typed view of a part of a buffer. Every index, count and offset is checked
// against what it counts before anything is read, so memory is bounded by the size of the buffers.
//
// References: the glTF 2.0 specification, sections 3.6, 3.11 and appendix C.
#include "io/glb_chunks.hpp"

#include <freiform/io/file.hpp>
#include <freiform/io/gltf_animation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

namespace freiform {

std::string_view name_of(GltfPath path) {
    static constexpr std::string_view kNames[] = {"translation", "rotation", "scale", "weights"};
    return kNames[int(path)];
}
std::string_view name_of(GltfInterpolation interpolation) {
    static constexpr std::string_view kNames[] = {"STEP", "LINEAR", "CUBICSPLINE"};
    return kNames[int(interpolation)];
}

namespace {

using gltf::elements, gltf::Found, gltf::member, gltf::string_of, gltf::whole;

std::unexpected<Refusal> broken_gltf(std::string where, std::string why) {
    return refuse(RefusalKind::unreadable, std::move(where), std::move(why));
}

std::optional<std::string> from_base64(std::string_view s) {
    std::string out;
    unsigned bits = 0, held = 0;
    while (!s.empty() && s.back() == '=') s.remove_suffix(1);
    for (const char c : s) {
        const unsigned v = c >= 'A' && c <= 'Z'   ? unsigned(c - 'A')
                           : c >= 'a' && c <= 'z' ? unsigned(c - 'a') + 26
                           : c >= '0' && c <= '9' ? unsigned(c - '0') + 52
                           : c == '+'             ? 62
                           : c == '/'             ? 63
                                                  : 64;
        if (v == 64) return std::nullopt;
        held = held << 6 | v, bits += 6;
        if (bits >= 8) bits -= 8, out.push_back(char(held >> bits & 0xff));
    }
    return out;
}

class GltfReader {
public:
    GltfReader(const json::Value& root, std::string_view binary, const std::filesystem::path& folder)
        : root_(root), binary_(binary), folder_(folder) {
        static constexpr std::string_view kNames[] = {"nodes", "accessors", "bufferViews", "buffers"};
        for (std::size_t i = 0; i < 4; ++i) arrays_[i] = elements(member(root, kNames[i]));
        buffers_.resize(arrays_[kBuffers].size());
    }

    Result<std::vector<GltfAnimation>> animations() {
        if (string_of(member(member(root_, "asset").value_or(root_), "version")).substr(0, 2) != "2.")
            return broken_gltf("asset.version", "this is not glTF 2");
        std::vector<GltfAnimation> out;
        const auto all = member(root_, "animations");
        if (!all) return out;
        if (!all->is(json::Kind::array)) return broken_gltf("animations", "an array is expected");
        for (const json::Value& a : all->elements()) {
            auto read = animation(a);
            if (!read) return refuse_within(text("animations[", out.size(), "]"), read.error());
            out.push_back(*std::move(read));
        }
        return out;
    }

private:
    enum Array : std::size_t { kNodes, kAccessors, kViews, kBuffers };
    Found element(Array array, std::size_t i) const {
        const std::vector<json::Value>& all = arrays_[array];
        return i < all.size() ? Found(all[i]) : std::nullopt;
    }

    Result<std::string_view> buffer(std::size_t index) {
        const auto b = element(kBuffers, index);
        const std::string where = text("buffers[", index, "]");
        if (!b) return broken_gltf(where, "there is no such buffer");
        const auto uri = member(*b, "uri");
        if (!uri) return binary_;
        std::optional<std::string>& held = buffers_[index];
        if (held) return std::string_view(*held);
        const std::string name = string_of(uri);
        if (name.starts_with("data:")) {
            const std::size_t comma = name.find(";base64,");
            auto data =
                comma == name.npos ? std::nullopt : from_base64(std::string_view(name).substr(comma + 8));
            if (!data) return broken_gltf(where, "its data URI is not base64");
            held = std::move(data);
        } else {
            const std::filesystem::path path(name);
            const bool leads_out = path.is_absolute() || name.find(':') != name.npos ||
                                   std::ranges::find(path, std::filesystem::path("..")) != path.end();
            if (folder_.empty() || leads_out)
                return refuse(RefusalKind::unsupported, where,
                              text("\"", name.substr(0, 60), "\" is outside the file",
                                   leads_out ? " and its folder" : ""));
            auto data = read_file((folder_ / path).string(), kMostBytes);
            if (!data) return std::unexpected(data.error());
            held = *std::move(data);
        }
        bytes_ += held->size();
        if (bytes_ > kMostBytes)
            return refuse(RefusalKind::limit, where,
                          text("all buffers have more than ", kMostBytes >> 20, " MiB"));
        return std::string_view(*held);
    }

    // All numbers of an accessor, those of an element one after the other.
    struct Numbers {
        std::size_t count = 0, components = 0;
        std::vector<double> values;
    };
    Result<Numbers> accessor(std::size_t index) {
        const std::string where = text("accessors[", index, "]");
        const auto a = element(kAccessors, index);
        if (!a) return broken_gltf(where, "there is no such accessor");
        if (member(*a, "sparse")) return refuse(RefusalKind::unsupported, where, "it is sparse");
        const auto view = whole(member(*a, "bufferView")), count = whole(member(*a, "count")),
                   type = whole(member(*a, "componentType"));
        const std::string shape = string_of(member(*a, "type"));
        const std::size_t n = shape == "SCALAR" ? 1
                              : shape == "VEC2" ? 2
                              : shape == "VEC3" ? 3
                              : shape == "VEC4" ? 4
                                                : 0;
        const std::size_t bytes = type == 5126                   ? 4
                                  : type == 5122 || type == 5123 ? 2
                                  : type == 5120 || type == 5121 ? 1
                                                                 : 0;
        if (!view || !count || n == 0 || bytes == 0)
            return broken_gltf(where, "bufferView, count, type and componentType of numbers are expected");
        const auto v = element(kViews, *view);
        if (!v) return broken_gltf(where, text("there is no bufferViews[", *view, "]"));
        const auto in = buffer(whole(member(*v, "buffer")).value_or(0));
        if (!in) return std::unexpected(in.error());
        const std::size_t begin = whole(member(*v, "byteOffset")).value_or(0),
                          length = whole(member(*v, "byteLength")).value_or(0),
                          offset = whole(member(*a, "byteOffset")).value_or(0),
                          stride = whole(member(*v, "byteStride")).value_or(n * bytes);
        // With sizes below 2^53 no sum overflows, and with the first test no product.
        if (*count > in->size() || stride > 252 || begin > in->size() || length > in->size() - begin ||
            offset > length || (*count > 0 && (*count - 1) * stride + n * bytes > length - offset))
            return broken_gltf(where,
                               text(*count, " elements go beyond the buffer of ", in->size(), " bytes"));
        const auto scale = member(*a, "normalized");
        const bool normalized = scale && scale->is(json::Kind::boolean) && scale->boolean();
        read_ += *count * n;
        if (read_ > kMostNumbers)
            return refuse(RefusalKind::limit, where,
                          text("all channels together have more than ", kMostNumbers, " numbers"));
        Numbers out{*count, n, {}};
        out.values.reserve(*count * n);
        const char* first = in->data() + begin + offset;
        for (std::size_t i = 0; i < *count; ++i)
            for (std::size_t k = 0; k < n; ++k) {
                const double x = number(first + i * stride + k * bytes, *type, normalized);
                if (!std::isfinite(x))
                    return refuse(RefusalKind::nonfinite, text(where, "[", i, "]"), "a number is expected");
                out.values.push_back(x);
            }
        return out;
    }
    template <class T>
    static double plain(const char* at) {
        T x;
        std::memcpy(&x, at, sizeof x);
        return double(x);
    }
    static double number(const char* at, std::size_t type, bool normalized) {
        switch (type) {
            case 5120:
                return normalized ? std::max(plain<std::int8_t>(at) / 127, -1.0) : plain<std::int8_t>(at);
            case 5121:
                return plain<std::uint8_t>(at) / (normalized ? 255 : 1);
            case 5122:
                return normalized ? std::max(plain<std::int16_t>(at) / 32767, -1.0) : plain<std::int16_t>(at);
            case 5123:
                return plain<std::uint16_t>(at) / (normalized ? 65535 : 1);
            default:
                return plain<float>(at);
        }
    }

    Result<GltfAnimation> animation(const json::Value& a) {
        GltfAnimation out{string_of(member(a, "name")), {}};
        const auto channels = member(a, "channels"), samplers = member(a, "samplers");
        if (!channels || !channels->is(json::Kind::array) || !samplers || !samplers->is(json::Kind::array))
            return broken_gltf("", "arrays of channels and samplers are expected");
        const std::vector<json::Value> all = elements(samplers);
        std::size_t i = 0;
        for (const json::Value& c : channels->elements()) {
            const auto sampler = whole(member(c, "sampler"));
            auto read = sampler && *sampler < all.size() ? channel(c, all[*sampler])
                                                         : broken_gltf("sampler", "there is no such sampler");
            if (!read) return refuse_within(text("channels[", i, "]"), read.error());
            out.channels.push_back(*std::move(read));
            ++i;
        }
        return out;
    }

    Result<GltfChannel> channel(const json::Value& c, const json::Value& sampler) {
        GltfChannel out;
        const auto target = member(c, "target");
        const auto node = target ? whole(member(*target, "node")) : std::nullopt;
        if (!node) return refuse(RefusalKind::unsupported, "target", "it has no node");
        const auto n = element(kNodes, *node);
        if (!n) return broken_gltf("target", text("there is no nodes[", *node, "]"));
        out.node = string_of(member(*n, "name"));
        if (out.node.empty()) out.node = text("nodes[", *node, "]");
        const std::string path = string_of(member(*target, "path")),
                          way = string_of(member(sampler, "interpolation"));
        bool known = false;
        for (const GltfPath p :
             {GltfPath::translation, GltfPath::rotation, GltfPath::scale, GltfPath::weights})
            if (name_of(p) == path) out.path = p, known = true;
        if (!known) return broken_gltf("target.path", text("\"", path.substr(0, 40), "\" is not one"));
        known = way.empty();
        for (const auto w :
             {GltfInterpolation::step, GltfInterpolation::linear, GltfInterpolation::cubic_spline})
            if (name_of(w) == way) out.interpolation = w, known = true;
        if (!known) return broken_gltf("interpolation", text("\"", way.substr(0, 40), "\" is not one"));
        const auto in = whole(member(sampler, "input")), to = whole(member(sampler, "output"));
        if (!in || !to) return broken_gltf("sampler", "input and output are expected");
        auto times = accessor(*in);
        if (!times) return std::unexpected(times.error());
        auto values = accessor(*to);
        if (!values) return std::unexpected(values.error());
        if (times->components != 1 || times->count == 0) return broken_gltf("input", "times are expected");
        for (std::size_t i = 1; i < times->count; ++i)
            if (!(times->values[i] > times->values[i - 1]))
                return broken_gltf("input", text("time ", i, " is ", times->values[i], ", not after ",
                                                 times->values[i - 1]));
        const std::size_t each = out.interpolation == GltfInterpolation::cubic_spline ? 3 : 1,
                          keys = times->count * each;
        const std::size_t wanted = out.path == GltfPath::rotation ? 4 : out.path == GltfPath::weights ? 1 : 3;
        if (values->components != wanted || values->count % keys != 0 || values->count == 0 ||
            (out.path != GltfPath::weights && values->count != keys))
            return broken_gltf("output", text(values->count, " values of ", values->components,
                                              " numbers do not go with ", times->count, " times"));
        out.components = values->values.size() / keys;
        out.times = std::move(times->values), out.values = std::move(values->values);
        return out;
    }

    static constexpr std::size_t kMostBytes = std::size_t(256) << 20;
    static constexpr std::size_t kMostNumbers = std::size_t(1) << 24;  // channels may share accessors
    json::Value root_;
    std::string_view binary_;
    const std::filesystem::path& folder_;
    std::array<std::vector<json::Value>, 4> arrays_;
    std::vector<std::optional<std::string>> buffers_;
    std::size_t read_ = 0, bytes_ = 0;
};

}  // namespace

Result<std::vector<GltfAnimation>> read_gltf_animations(std::string_view bytes,
                                                        const std::filesystem::path& folder) {
    const auto chunks = bytes.starts_with("glTF") ? chunks_of_glb(bytes) : GlbChunks{bytes, {}};
    if (!chunks) return std::unexpected(chunks.error());
    const auto tree = json::parse(chunks->json);
    if (!tree) return std::unexpected(tree.error());
    return GltfReader(tree->root(), chunks->binary, folder).animations();
}

void evaluate(const GltfChannel& channel, double time, std::span<double> out) {
    const std::size_t n = channel.components;
    const bool cubic = channel.interpolation == GltfInterpolation::cubic_spline;
    FF_REQUIRE(out.size() == n && channel.values.size() == channel.times.size() * n * (cubic ? 3 : 1));
    const auto value = [&](std::size_t key, std::size_t part, std::size_t k) {
        return channel.values[((cubic ? 3 * key + part : key)) * n + k];
    };
    const std::vector<double>& t = channel.times;
    const auto next = std::size_t(std::ranges::upper_bound(t, time) - t.begin());
    const std::size_t a = next == 0 ? 0 : next - 1;
    const bool turns = channel.path == GltfPath::rotation;
    const auto put = [&](const Quaternion& q) { out[0] = q.x, out[1] = q.y, out[2] = q.z, out[3] = q.w; };
    if (next == 0 || next == t.size() || channel.interpolation == GltfInterpolation::step) {
        for (std::size_t k = 0; k < n; ++k) out[k] = value(a, 1, k);
        return;
    }
    const double h = t[next] - t[a], x = (time - t[a]) / h;
    if (!cubic && turns) {
        const auto key = [&](std::size_t i) {
            return unit(Quaternion{value(i, 0, 0), value(i, 0, 1), value(i, 0, 2), value(i, 0, 3)});
        };
        return put(slerp(key(a), key(next), x));
    }
    const double y = 1 - x, h00 = y * y * (1 + 2 * x), h10 = h * x * y * y, h01 = x * x * (3 - 2 * x),
                 h11 = -h * x * x * y;
    for (std::size_t k = 0; k < n; ++k)
        out[k] = cubic ? h00 * value(a, 1, k) + h10 * value(a, 2, k) + h01 * value(next, 1, k) +
                             h11 * value(next, 0, k)
                       : y * value(a, 0, k) + x * value(next, 0, k);
    if (turns) put(unit(Quaternion{out[0], out[1], out[2], out[3]}));
}

}  // namespace freiform

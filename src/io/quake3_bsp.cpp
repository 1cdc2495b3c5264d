// The layout, little-endian: "IBSP", version, 17 lumps as (offset, length); of these the textures (1: name of
// 64 bytes, flags, contents), the vertices (10: position, 2 x 2 texture coordinates, normal as floats, colour
// as 4 bytes), the indices into a face's vertices (11) and the faces (13: 26 numbers of 4 bytes).
#include "quake3_detail.hpp"

#include <freiform/io/quake3.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace freiform {

namespace {

using quake3::Grid;

static_assert(std::endian::native == std::endian::little);

constexpr int kLumps = 17, kTextures = 1, kVertices = 10, kIndices = 11, kFaces = 13;
enum FaceType { kPolygon = 1, kPatch = 2, kMesh = 3, kBillboard = 4 };

struct Record {  // a face
    std::int32_t texture, effect, type, vertex, vertices, index, indices;
    std::int32_t light[12], normal[3];  // of the lightmap and the plane; floats among them, not used here
    std::int32_t more[2], width, height;
};
static_assert(sizeof(Record) == 104);

struct StoredVertex {
    float position[3], texture[2], light[2], normal[3];
    std::uint8_t colour[4];
};
static_assert(sizeof(StoredVertex) == 44);

struct Texture {
    char name[64];
    std::int32_t flags, contents;
};
static_assert(sizeof(Texture) == 72);

std::unexpected<Refusal> damaged(std::string where, std::string message) {
    return refuse(RefusalKind::unreadable, std::move(where), std::move(message));
}

template <class T>
T at(std::string_view bytes, std::size_t index) {
    T x;
    std::memcpy(&x, bytes.data() + index * sizeof(T), sizeof(T));
    return x;
}

class Level {
public:
    static Result<Level> open(std::string_view bytes) {
        constexpr std::size_t kHeader = 8 + kLumps * 8;
        if (!bytes.starts_with("IBSP")) return damaged("header", "does not begin with \"IBSP\"");
        if (bytes.size() < kHeader)
            return damaged("header", text("the file has ", bytes.size(), " bytes, its header ", kHeader));
        if (const auto version = at<std::int32_t>(bytes, 1); version != 46)
            return refuse(RefusalKind::unsupported, "header",
                          text("is of version ", version, ", expected 46 (Quake 3)"));
        Level level;
        const auto lump = [&](int i, std::size_t record, std::string_view& out) -> Result<void> {
            const auto offset = at<std::uint32_t>(bytes, std::size_t(2 + 2 * i));
            const auto length = at<std::uint32_t>(bytes, std::size_t(3 + 2 * i));
            const std::string where = text("lump ", i);
            if (offset > bytes.size() || length > bytes.size() - offset)
                return damaged(where, text("has ", length, " bytes from byte ", offset, ", the file ends at ",
                                           bytes.size()));
            if (length % record != 0)
                return damaged(where, text("has ", length, " bytes, no multiple of ", record));
            out = bytes.substr(offset, length);
            return {};
        };
        for (auto ok : {lump(kTextures, sizeof(Texture), level.textures_),
                        lump(kVertices, sizeof(StoredVertex), level.vertices_),
                        lump(kIndices, sizeof(std::int32_t), level.indices_),
                        lump(kFaces, sizeof(Record), level.faces_)})
            if (!ok) return std::unexpected(ok.error());
        return level;
    }

    std::size_t faces() const { return faces_.size() / sizeof(Record); }

    // Appends the shapes of a face.
    Result<void> add(std::size_t face, std::vector<Object>& to) const {
        const auto r = at<Record>(faces_, face);
        if (r.type == kBillboard) return {};
        if (r.type < kPolygon || r.type > kBillboard)
            return damaged("type", text("is ", r.type, ", expected 1 to 4"));
        const auto count = std::int64_t(vertices_.size() / sizeof(StoredVertex));
        if (r.vertex < 0 || r.vertices < 0 || std::int64_t(r.vertex) + r.vertices > count)
            return damaged("vertices", text(r.vertices, " from ", r.vertex, ", there are ", count));
        auto material = texture(r.texture);
        if (!material) return std::unexpected(material.error());
        return r.type == kPatch ? add_patch(r, *material, text("face ", face), to)
                                : add_triangles(r, *material, text("face ", face), to);
    }

private:
    Result<std::string> texture(std::int32_t index) const {
        const auto count = std::int64_t(textures_.size() / sizeof(Texture));
        if (index < 0 || index >= count) return damaged("texture", text("is ", index, ", there are ", count));
        const auto t = at<Texture>(textures_, std::size_t(index));
        std::string name(t.name, ::strnlen(t.name, sizeof t.name));
        for (char& c : name)
            if (c < ' ' || c > '~') c = '?';
        return name;
    }

    Result<quake3::Vertex> vertex(std::int64_t index) const {
        const auto v = at<StoredVertex>(vertices_, std::size_t(index));
        quake3::Vertex out;
        for (int d = 0; d < 3; ++d) {
            out.position[d] = v.position[d], out.normal[d] = v.normal[d];
            if (!std::isfinite(v.position[d]))
                return refuse(RefusalKind::nonfinite, text("vertices[", index, "]"), "is not finite");
            if (!std::isfinite(v.normal[d])) out.normal[d] = 0;
        }
        const auto part = [&](int i) { return v.colour[i] / 255.0; };
        out.colour = {part(0), part(1), part(2), part(3)};
        return out;
    }

    Result<void> add_patch(const Record& r, const std::string& material, std::string name,
                           std::vector<Object>& to) const {
        if (std::int64_t(r.width) * r.height != r.vertices)
            return damaged("grid", text(r.width, " x ", r.height, " for ", r.vertices, " vertices"));
        Grid grid{r.width, r.height, {}};
        if (auto ok = grid.check(); !ok) return ok;
        for (int i = 0; i < r.width; ++i)
            for (int j = 0; j < r.height; ++j) {
                auto v = vertex(r.vertex + std::int64_t(j) * r.width + i);
                if (!v) return std::unexpected(v.error());
                grid.vertices.push_back(*v);
            }
        auto object = grid.object(std::move(name), material);
        if (!object) return std::unexpected(object.error());
        to.push_back(std::move(*object));
        return {};
    }

    Result<void> add_triangles(const Record& r, const std::string& material, const std::string& name,
                               std::vector<Object>& to) const {
        const auto count = std::int64_t(indices_.size() / sizeof(std::int32_t));
        if (r.index < 0 || r.indices < 0 || std::int64_t(r.index) + r.indices > count)
            return damaged("indices", text(r.indices, " from ", r.index, ", there are ", count));
        if (r.indices % 3 != 0) return damaged("indices", text(r.indices, " are no whole triangles"));
        for (int t = 0; t < r.indices; t += 3) {
            std::array<quake3::Vertex, 3> corner;
            for (int k = 0; k < 3; ++k) {
                const auto i = at<std::int32_t>(indices_, std::size_t(r.index + t + k));
                if (i < 0 || i >= r.vertices)
                    return damaged(text("indices[", r.index + t + k, "]"),
                                   text("is ", i, ", the face has ", r.vertices, " vertices"));
                auto v = vertex(std::int64_t(r.vertex) + i);
                if (!v) return std::unexpected(v.error());
                corner[std::size_t(k)] = *v;
            }
            const auto p = [&](int k) { return corner[std::size_t(k)].position; };
            const Vec<3> side = cross(p(1) - p(0), p(2) - p(0));
            if (max_abs(side) == 0) continue;  // no area
            if (dot(side, corner[0].normal + corner[1].normal + corner[2].normal) < 0)
                std::swap(corner[1], corner[2]);
            Object o{name, Triangle<Vec<3>>::trusted(1, {p(0), p(1), p(2)}), {}};
            o.material = material;
            for (const auto& c : corner) o.colours.push_back(c.colour);
            to.push_back(std::move(o));
        }
        return {};
    }

    std::string_view textures_, vertices_, indices_, faces_;
};

}  // namespace

Result<Document> read_quake3_bsp(std::string_view bytes) {
    auto level = Level::open(bytes);
    if (!level) return std::unexpected(level.error());
    Document document;
    for (std::size_t i = 0; i < level->faces(); ++i)
        if (auto ok = level->add(i, document.objects); !ok)
            return refuse_within(text("faces[", i, "]"), ok.error());
    if (document.objects.empty())
        return refuse(RefusalKind::no_answer, "faces", "the level has no face with a shape");
    return document;
}

}  // namespace freiform

#include "io/mesh_bytes.hpp"

#include <freiform/io/mesh_file.hpp>

namespace freiform {
namespace {

// A name must be one word on one line.
std::string one_word(std::string_view name) {
    std::string out(name);
    for (char& c : out)
        if (static_cast<unsigned char>(c) <= ' ' || c == '\x7f' || c == '\\') c = '_';
    return out;
}

template <class Number>
void append_numbers(std::string& out, std::string_view key, const std::array<Number, 3>& x) {
    out += key;
    for (const Number v : x) {
        out += ' ';
        append_text(out, v);
    }
    out += '\n';
}

// vn lines for the vertices that have a normal; the index of each, 0 where there is none.
std::vector<int> append_normals(std::string& out, const TriangleMesh& mesh) {
    std::vector<int> index(mesh.vertices.size(), 0);
    FloatPoint last{};
    int count = 0;
    for (std::size_t i = 0; i < index.size(); ++i) {
        const Vec<3> n = unit(mesh.vertices[i].normal);
        const FloatPoint rounded{float(n[0]), float(n[1]), float(n[2])};
        if (rounded == FloatPoint{}) continue;
        if (count == 0 || rounded != last) {
            append_numbers(out, "vn", rounded);
            last = rounded;
            ++count;
        }
        index[i] = count;
    }
    return index;
}

}  // namespace

Result<std::string> to_obj(const TriangleMesh& mesh, const MeshWriteOptions& options) {
    if (auto r = validate(mesh); !r) return std::unexpected(r.error());
    std::string out = text("# ", one_word(options.generator), "\n");
    if (!mesh.unit.empty()) out += text("# unit ", one_word(mesh.unit), "\n");
    for (const Vec<3>& p : mesh.points) append_numbers(out, "v", p.c);
    const std::vector<int> normal = append_normals(out, mesh);
    int number = 0;
    for (const MeshPart& part : parts_of(mesh)) {
        ++number;
        out += part.name.empty() ? text("g part_", number, "\n") : text("g ", one_word(part.name), "\n");
        if (const auto& c = part.colour)
            out += text("# colour ", c->r, " ", c->g, " ", c->b, " ", c->a, "\n");
        for_each_polygon(mesh, part, [&](std::span<const int> corners) {
            bool with_normals = true;
            for (int v : corners) with_normals &= normal[std::size_t(v)] != 0;
            out += 'f';
            for (int v : corners) {
                out += ' ';
                append_text(out, mesh.vertices[std::size_t(v)].point + 1LL);
                if (!with_normals) continue;
                out += "//";
                append_text(out, normal[std::size_t(v)]);
            }
            out += '\n';
        });
    }
    return out;
}

}  // namespace freiform

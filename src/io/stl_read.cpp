// A binary file is told by its size, which its number of triangles determines; many begin with "solid" like
// the text form. The normals of the file are dropped: they repeat what the corners say.
#include "io/mesh_builder.hpp"

#include <array>
#include <cstring>

namespace freiform {
namespace {

constexpr std::size_t kPreamble = 84, kFacetBytes = 50;

std::uint64_t binary_size(std::string_view bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    return kPreamble + kFacetBytes * std::uint64_t(count);
}

// "binary STL; unit mm; ..." as our writer has it.
std::string unit_in(std::string_view header) {
    constexpr std::string_view kKey = "binary STL; unit ";
    if (!header.starts_with(kKey)) return "";
    header.remove_prefix(kKey.size());
    const std::string unit(header.substr(0, std::min(header.find(';'), header.size())));
    return unit == "unknown" ? "" : unit;
}

Result<TriangleMesh> parse_binary(std::string_view bytes, const std::string& name,
                                  const MeshReadOptions& options) {
    const std::size_t count = (bytes.size() - kPreamble) / kFacetBytes;
    if (count > options.max_triangles)
        return refuse(RefusalKind::limit, name,
                      text("has ", count, " triangles, the limit is ", options.max_triangles));
    MeshBuilder builder(options);
    for (std::size_t t = 0; t < count; ++t) {
        const std::size_t at = kPreamble + kFacetBytes * t;
        std::array<float, 9> x;
        std::memcpy(x.data(), bytes.data() + at + 12, sizeof x);
        std::array<int, 3> v;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec<3> p{{x[3 * i], x[3 * i + 1], x[3 * i + 2]}};
            if (!is_finite(p))
                return refuse(RefusalKind::nonfinite, text(name, ": byte ", at + 12 + 12 * i),
                              text("a coordinate of triangle ", t, " is not a finite number"));
            v[i] = builder.vertex(builder.point(p), {});
        }
        if (auto r = builder.triangle(name, v[0], v[1], v[2]); !r) return std::unexpected(r.error());
    }
    return builder.finish(unit_in(bytes.substr(0, 80)));
}

Result<void> expect(Words& words, std::string_view key) {
    const std::string_view word = words.next();
    if (equal_words(word, key)) return {};
    return words.refuse_here(text("expected \"", key, "\", found ", shown(word)));
}

Result<std::array<int, 3>> facet(Words& words, MeshBuilder& builder) {
    std::array<int, 3> v{};
    if (auto r = expect(words, "normal"); !r) return std::unexpected(r.error());
    for (int i = 0; i < 3; ++i) words.next();  // often nonsense, never needed
    for (std::string_view key : {"outer", "loop"})
        if (auto r = expect(words, key); !r) return std::unexpected(r.error());
    for (int& corner : v) {
        if (auto r = expect(words, "vertex"); !r) return std::unexpected(r.error());
        Vec<3> p;
        for (double& x : p.c) {
            const auto number = words.number();
            if (!number) return std::unexpected(number.error());
            x = *number;
        }
        corner = builder.vertex(builder.point(p), {});
    }
    for (std::string_view key : {"endloop", "endfacet"})
        if (auto r = expect(words, key); !r) return std::unexpected(r.error());
    return v;
}

Result<TriangleMesh> parse_text(std::string_view bytes, const std::string& name,
                                const MeshReadOptions& options) {
    MeshBuilder builder(options);
    Words words(bytes, name);
    bool inside = false;
    for (;;) {
        const std::string_view word = words.next();
        if (word.empty()) break;
        if (!inside && equal_words(word, "solid")) {
            builder.begin_part(std::string(words.rest_of_line()), std::nullopt);
            inside = true;
        } else if (inside && equal_words(word, "endsolid")) {
            words.rest_of_line();
            inside = false;
        } else if (inside && equal_words(word, "facet")) {
            const auto v = facet(words, builder);
            if (!v) return std::unexpected(v.error());
            if (auto r = builder.triangle(name, (*v)[0], (*v)[1], (*v)[2]); !r)
                return std::unexpected(r.error());
        } else {
            return words.refuse_here(text("expected ", inside ? "\"facet\" or \"endsolid\"" : "\"solid\"",
                                          ", found ", shown(word)));
        }
    }
    if (inside) return words.refuse_here("expected \"endsolid\", found the end");
    return builder.finish("");
}

}  // namespace

Result<TriangleMesh> parse_stl(std::string_view bytes, const std::string& name,
                               const MeshReadOptions& options) {
    if (bytes.size() >= kPreamble && bytes.size() == binary_size(bytes))
        return parse_binary(bytes, name, options);
    std::size_t begin = 0;
    while (begin < bytes.size() && (bytes[begin] == ' ' || (bytes[begin] >= '\t' && bytes[begin] <= '\r')))
        ++begin;
    if (equal_words(bytes.substr(begin, 5), "solid")) return parse_text(bytes, name, options);
    if (bytes.size() < kPreamble)
        return refuse(
            RefusalKind::unreadable, name,
            text("has ", bytes.size(), " bytes; an STL file begins with \"solid\" or has at least 84"));
    return refuse(
        RefusalKind::unreadable, text(name, ": byte 80"),
        text("the number of triangles asks for ", binary_size(bytes), " bytes, the file has ", bytes.size()));
}

}  // namespace freiform

// The header lists elements and their properties in any order and of any type; what is not a vertex or a face
// is stepped over. Counts are compared with the bytes that are left before they are believed.
#include "io/mesh_builder.hpp"

#include <array>
#include <cstring>
#include <utility>

namespace freiform {
namespace {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };
constexpr std::array<std::size_t, 8> kBytes{1, 1, 2, 2, 4, 4, 4, 8};
constexpr std::array<std::pair<std::string_view, Type>, 16> kPlyTypes{{{"char", Type::i8},
                                                                       {"uchar", Type::u8},
                                                                       {"short", Type::i16},
                                                                       {"ushort", Type::u16},
                                                                       {"int", Type::i32},
                                                                       {"uint", Type::u32},
                                                                       {"float", Type::f32},
                                                                       {"double", Type::f64},
                                                                       {"int8", Type::i8},
                                                                       {"uint8", Type::u8},
                                                                       {"int16", Type::i16},
                                                                       {"uint16", Type::u16},
                                                                       {"int32", Type::i32},
                                                                       {"uint32", Type::u32},
                                                                       {"float32", Type::f32},
                                                                       {"float64", Type::f64}}};

struct Property {
    std::string name;
    Type type = Type::f32;
    std::optional<Type> count;  // of a list
};

struct Element {
    std::string name;
    std::uint64_t size = 0;
    std::vector<Property> properties;
};

struct PlyVertex {
    Vec<3> position{}, normal{};
    std::array<double, 4> rgba{0, 0, 0, 1};
};

template <class T>
double loaded(const char* at) {
    T x;
    std::memcpy(&x, at, sizeof x);
    return double(x);
}

class PlyReader {
public:
    PlyReader(std::string_view bytes, const std::string& name, const MeshReadOptions& options)
        : bytes_(bytes), name_(name), options_(options), words_(bytes, name), builder_(options) {}

    Result<TriangleMesh> read() {
        if (auto r = read_header(); !r) return std::unexpected(r.error());
        at_ = words_.at() + 1;  // the byte after the end of the line
        for (const Element& element : elements_) {
            if (auto r = check_count(element); !r) return std::unexpected(r.error());
            if (auto r = read_element(element); !r) return std::unexpected(r.error());
        }
        if (auto r = build(); !r) return std::unexpected(r.error());
        return builder_.finish(unit_);
    }

private:
    Result<void> read_header() {
        if (words_.next() != "ply") return words_.refuse_here("the file does not begin with \"ply\"");
        if (words_.next() != "format") return words_.refuse_here("expected \"format\"");
        const std::string_view format = words_.next();
        binary_ = format == "binary_little_endian";
        if (format == "binary_big_endian")
            return refuse(RefusalKind::unsupported, words_.where(), "big-endian PLY is not read");
        if (!binary_ && format != "ascii")
            return words_.refuse_here(text("expected ascii or binary_little_endian, found ", shown(format)));
        words_.rest_of_line();
        for (;;) {
            const std::string_view key = words_.next();
            if (key == "end_header") break;
            if (key == "element") {
                if (auto r = read_element_line(); !r) return r;
            } else if (key == "property") {
                if (auto r = read_property_line(); !r) return r;
            } else if (key == "comment" || key == "obj_info") {
                std::string_view rest = words_.rest_of_line();
                if (rest.starts_with("unit ")) unit_ = rest.substr(5, 20);
                continue;
            } else {
                return words_.refuse_here(
                    text("expected element, property or end_header, found ", shown(key)));
            }
            words_.rest_of_line();
        }
        words_.rest_of_line();
        return {};
    }

    Result<void> read_element_line() {
        Element element;
        element.name = words_.next();
        const auto size = words_.integer();
        if (!size) return std::unexpected(size.error());
        if (*size < 0)
            return words_.refuse_here(text("the element ", shown(element.name), " has ", *size, " entries"));
        element.size = std::uint64_t(*size);
        elements_.push_back(std::move(element));
        return {};
    }

    Result<void> read_property_line() {
        if (elements_.empty()) return words_.refuse_here("a property before the first element");
        Property property;
        const auto type = [this]() -> Result<Type> {
            const std::string_view word = words_.next();
            for (const auto& [name, value] : kPlyTypes)
                if (word == name) return value;
            return words_.refuse_here(text("not a type of PLY: ", shown(word)));
        };
        const std::size_t before = words_.at();
        if (words_.next() == "list") {
            const auto count = type();
            if (!count) return std::unexpected(count.error());
            if (*count == Type::f32 || *count == Type::f64)
                return words_.refuse_here("a list with a count that is no integer");
            property.count = *count;
        } else {
            words_.seek(before);
        }
        const auto value = type();
        if (!value) return std::unexpected(value.error());
        property.type = *value;
        property.name = words_.next();
        elements_.back().properties.push_back(std::move(property));
        return {};
    }

    Result<void> check_count(const Element& element) const {
        std::size_t least = 0;
        for (const Property& p : element.properties)
            least += binary_ ? kBytes[std::size_t(p.count.value_or(p.type))] : 2;  // a digit and a space
        const std::size_t left = bytes_.size() + 1 - std::min(bytes_.size() + 1, at_);
        if (element.size == 0 || (least > 0 && element.size <= left / least)) return {};
        return refuse(RefusalKind::unreadable, name_,
                      text("declares ", element.size, " entries of ", shown(element.name), " of at least ",
                           least, " bytes each; ", left, " bytes are left"));
    }

    Result<double> value(Type type) {
        if (!binary_) {
            const auto x = words_.number();
            at_ = words_.at();
            return x;
        }
        const std::size_t n = kBytes[std::size_t(type)];
        if (n > bytes_.size() - std::min(at_, bytes_.size()))
            return refuse(RefusalKind::unreadable, text(name_, ": byte ", at_),
                          "the file ends inside a number");
        const char* from = bytes_.data() + at_;
        at_ += n;
        switch (type) {
            case Type::i8:
                return loaded<std::int8_t>(from);
            case Type::u8:
                return loaded<std::uint8_t>(from);
            case Type::i16:
                return loaded<std::int16_t>(from);
            case Type::u16:
                return loaded<std::uint16_t>(from);
            case Type::i32:
                return loaded<std::int32_t>(from);
            case Type::u32:
                return loaded<std::uint32_t>(from);
            case Type::f32:
                return loaded<float>(from);
            case Type::f64:
                break;
        }
        return loaded<double>(from);
    }
    std::string where() const { return binary_ ? text(name_, ": byte ", at_) : words_.where(); }

    Result<void> read_element(const Element& element) {
        const bool vertices = element.name == "vertex", faces = element.name == "face";
        if (element.name == "tristrips")
            return refuse(RefusalKind::unsupported, name_, "triangle strips are not read");
        for (std::uint64_t i = 0; i < element.size; ++i) {
            PlyVertex vertex;
            for (const Property& p : element.properties) {
                if (p.count) {
                    if (auto r = read_list(p, faces); !r) return r;
                    continue;
                }
                const auto x = value(p.type);
                if (!x) return std::unexpected(x.error());
                if (vertices) store(vertex, p, *x);
            }
            if (!vertices) continue;
            if (!is_finite(vertex.position))
                return refuse(RefusalKind::nonfinite, where(),
                              text("vertex ", i, " has a coordinate that is not finite"));
            vertices_.push_back(vertex);
        }
        has_colours_ |= vertices && has_property(element, "red");
        return {};
    }

    static bool has_property(const Element& element, std::string_view name) {
        for (const Property& p : element.properties)
            if (p.name == name) return true;
        return false;
    }

    static void store(PlyVertex& v, const Property& p, double x) {
        constexpr std::array<std::string_view, 3> kPosition{"x", "y", "z"}, kNormal{"nx", "ny", "nz"};
        constexpr std::array<std::string_view, 4> kColour{"red", "green", "blue", "alpha"};
        for (std::size_t i = 0; i < 3; ++i) {
            if (p.name == kPosition[i]) v.position.c[i] = x;
            if (p.name == kNormal[i]) v.normal.c[i] = x;
        }
        const double largest = p.type == Type::u8 ? 255 : p.type == Type::u16 ? 65535 : 1;
        for (std::size_t i = 0; i < 4; ++i)
            if (p.name == kColour[i]) v.rgba[i] = x >= 0 ? std::min(x / largest, 1.0) : 0;
    }

    Result<void> read_list(const Property& p, bool faces) {
        const auto count = value(*p.count);
        if (!count) return std::unexpected(count.error());
        if (!(*count >= 0))
            return refuse(RefusalKind::unreadable, where(), text("a list of ", *count, " numbers"));
        const bool corners = faces && (p.name == "vertex_indices" || p.name == "vertex_index");
        if (corners && *count < 3)
            return refuse(RefusalKind::unreadable, where(),
                          text("a face of ", *count, " corners, at least 3 expected"));
        // Every turn reads at least one byte or refuses.
        std::array<int, 3> v{};
        for (double k = 0; k < *count; ++k) {
            const auto x = value(p.type);
            if (!x) return std::unexpected(x.error());
            if (!corners) continue;
            if (!(*x >= 0 && *x <= 0x7fffffff) || *x != double(int(*x)))
                return refuse(RefusalKind::unreadable, where(), text("the vertex ", *x, " of a face"));
            v[k == 0 ? 0 : 2] = int(*x);
            if (k >= 2) {
                if (triangles_.size() >= options_.max_triangles)
                    return refuse(RefusalKind::limit, where(),
                                  text("more than ", options_.max_triangles, " triangles, the limit"));
                triangles_.push_back(v);
            }
            if (k >= 1) v[1] = v[2];
        }
        return {};
    }

    // A run of triangles of one colour is a part.
    Result<void> build() {
        std::optional<std::array<double, 4>> present;
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            std::array<int, 3> v = triangles_[t];
            for (int i : v)
                if (std::size_t(i) >= vertices_.size())
                    return refuse(RefusalKind::unreadable, name_,
                                  text("vertex ", i, " of a face, the file has ", vertices_.size()));
            const auto& c = vertices_[std::size_t(v[0])].rgba;
            if (has_colours_ && present != c) {
                builder_.begin_part("", Colour{c[0], c[1], c[2], c[3]});
                present = c;
            }
            for (int& i : v) {
                const PlyVertex& from = vertices_[std::size_t(i)];
                i = builder_.vertex(builder_.point(from.position), from.normal);
            }
            if (auto r = builder_.triangle(name_, v[0], v[1], v[2]); !r) return r;
        }
        return {};
    }

    std::string_view bytes_;
    const std::string& name_;
    const MeshReadOptions& options_;
    Words words_;
    MeshBuilder builder_;
    bool binary_ = false, has_colours_ = false;
    std::size_t at_ = 0;
    std::vector<Element> elements_;
    std::vector<PlyVertex> vertices_;
    std::vector<std::array<int, 3>> triangles_;
    std::string unit_;
};

}  // namespace

Result<TriangleMesh> parse_ply(std::string_view bytes, const std::string& name,
                               const MeshReadOptions& options) {
    return PlyReader(bytes, name, options).read();
}

}  // namespace freiform

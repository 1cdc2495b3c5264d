// What the parts of the document's reader and writer share.
#pragma once
#include <freiform/core/spelling.hpp>
#include <freiform/core/tuples.hpp>
#include <freiform/io/json.hpp>
#include <freiform/shape.hpp>

#include <optional>

namespace freiform::document_detail {

inline constexpr int kVersion = 1;

// In the order of ConicKind and SurfaceKind.
inline constexpr std::string_view kConicNames[] = {"ellipse", "hyperbola", "parabola"};
inline constexpr std::string_view kSurfaceKinds[] = {"general", "plane",  "cylinder",
                                                     "cone",    "sphere", "torus"};

// Every reader below refuses with a place relative to the value that it was given; callers put their own in
// front.

std::unexpected<Refusal> expected(std::string_view what, json::Value found, std::string where = "");
Result<double> read_number(json::Value v);
Result<int> read_int(json::Value v);
Result<bool> read_bool(json::Value v);
Result<std::string> read_string(json::Value v);
Result<std::vector<double>> read_numbers(json::Value v);
Result<std::optional<Colour>> read_colour(json::Value v);  // [r, g, b] or [r, g, b, a]

// The members of one object, of which `allowed` may occur.
class Fields {
public:
    static Result<Fields> read(json::Value v, std::string_view what,
                               std::span<const std::string_view> allowed);

    bool has(std::string_view key) const { return find(key) != nullptr; }
    // Refuses a missing field.
    Result<json::Value> get(std::string_view key) const;

    // The field through `read`, with its name in refusals; get: it must be there, or_default: it need not be.
    template <class Read>
    auto get(std::string_view key, Read&& read) const -> decltype(read(std::declval<json::Value>())) {
        const auto v = get(key);
        if (!v) return std::unexpected(v.error());
        auto result = read(*v);
        if (!result) return refuse_within(key, result.error());
        return result;
    }
    template <class Read, class T>
    auto get_or(std::string_view key, Read&& read, T otherwise) const
        -> decltype(read(std::declval<json::Value>())) {
        if (!has(key)) return otherwise;
        return get(key, std::forward<Read>(read));
    }

private:
    explicit Fields(json::Value object) : object_(object) {}
    const json::Value* find(std::string_view key) const;
    json::Value object_;
    std::vector<json::Member> members_;
};

// The elements of an array, each through `read`.
template <class Read>
auto read_list(json::Value v, Read&& read)
    -> Result<std::vector<typename decltype(read(std::declval<json::Value>()))::value_type>> {
    if (!v.is(json::Kind::array)) return expected("an array", v);
    std::vector<typename decltype(read(std::declval<json::Value>()))::value_type> out;
    out.reserve(v.size());
    std::size_t i = 0;
    for (const json::Value element : v.elements()) {
        auto x = read(element);
        if (!x) return refuse_within(text("[", i, "]"), x.error());
        out.push_back(std::move(*x));
        ++i;
    }
    return out;
}

// A shape, with the points as they were given.
struct ReadShape {
    Shape shape;
    std::vector<double> given_points;
    // Knots that weights of zero and below needed, and how far from the function that was given the shape is.
    int inserted = 0;
    double moved = 0;
};
template <std::size_t N>
Result<ReadShape> read_patch(json::Value v);  // a tensor product patch of N parameters
Result<ReadShape> read_triangle(json::Value v);
// The bases of a patch of n parameters, from "degree(s)", "closed" and "knots".
Result<std::vector<BSplineBasis>> read_bases(const Fields& fields, std::size_t n, const Index<3>& points);

// The same where a space of D coordinates is needed. `type` may be left out.
Result<CurveGeometry<2>> read_plane_curve(json::Value v);
Result<CurveGeometry<3>> read_space_curve(json::Value v);
Result<SurfaceGeometry> read_surface_geometry(json::Value v);
Result<Shape> read_trimmed(json::Value v);
Result<Shape> read_model(json::Value v);

// What the readers above changed in the patches of an object that they have accepted: its own, or those of
// its faces, edges and loops.
std::vector<Approximation> changes_in(json::Value object);

// The type of an object: its field `type`, or `otherwise` if there is none and that is not empty.
Result<std::string> read_type(json::Value v, std::string_view otherwise,
                              std::span<const std::string_view> known);

void write_curve(json::Writer& w, const CurveGeometry<2>& c);
void write_curve(json::Writer& w, const CurveGeometry<3>& c);
void write_surface(json::Writer& w, const SurfaceGeometry& s);
void write_model(json::Writer& w, const Model& m);  // the fields, without the braces

// The fields of a patch, without the braces. `given`: points to prefer, see Object::given_points; may be
// empty.
void write_tensor(json::Writer& w, std::span<const BSplineBasis> bases, const Tuples& net,
                  std::span<const double> given);
void write_triangle(json::Writer& w, int degree, const Tuples& net, std::span<const double> given);

template <std::size_t N, class P>
void write_patch(json::Writer& w, const Patch<N, P>& patch, std::span<const double> given) {
    write_tensor(w, patch.bases(), tuples(patch.net().flat()), given);
}
template <class P>
void write_triangle(json::Writer& w, const Triangle<P>& triangle, std::span<const double> given) {
    write_triangle(w, triangle.degree(), tuples(triangle.coefficients()), given);
}

template <int D>
Result<Vec<D>> read_vec(json::Value v) {
    if (!v.is(json::Kind::array) || v.size() != std::size_t(D))
        return expected(text("an array of ", D, " numbers"), v);
    Vec<D> x;
    int i = 0;
    for (const json::Value element : v.elements()) {
        const auto c = read_number(element);
        if (!c) return refuse_within(text("[", i, "]"), c.error());
        x[i++] = *c;
    }
    return x;
}

}  // namespace freiform::document_detail

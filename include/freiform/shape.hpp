// Everything that a document stores. The variant is closed: a program that has to know what kind of thing it
// holds visits it once, at its edge; algorithms take the types themselves.
#pragma once
#include <freiform/core/visit.hpp>
#include <freiform/model/model.hpp>
#include <freiform/spline/patch.hpp>
#include <freiform/spline/simplex.hpp>
#include <freiform/trim/trimmed_surface.hpp>

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace freiform {

template <class P>
using Triangle = SimplexPatch<2, P>;

using Shape = std::variant<Curve<Vec<1>>, Curve<Vec<2>>, Curve<Vec<3>>, Curve<Vec<4>>,              //
                           Curve<Hom<1>>, Curve<Hom<2>>, Curve<Hom<3>>, Curve<Hom<4>>,              //
                           Surface<Vec<1>>, Surface<Vec<2>>, Surface<Vec<3>>, Surface<Vec<4>>,      //
                           Surface<Hom<1>>, Surface<Hom<2>>, Surface<Hom<3>>, Surface<Hom<4>>,      //
                           Volume<Vec<1>>, Volume<Vec<2>>, Volume<Vec<3>>, Volume<Vec<4>>,          //
                           Volume<Hom<1>>, Volume<Hom<2>>, Volume<Hom<3>>, Volume<Hom<4>>,          //
                           Triangle<Vec<1>>, Triangle<Vec<2>>, Triangle<Vec<3>>, Triangle<Vec<4>>,  //
                           Triangle<Hom<1>>, Triangle<Hom<2>>, Triangle<Hom<3>>, Triangle<Hom<4>>,  //
                           TrimmedSurface, Model>;

// A curve, surface or volume: `visit` with `if constexpr (TensorPatch<S>)`.
template <class S>
concept TensorPatch = requires(const S& s) {
    S::kParams;
    s.bases();
    s.net();
};

// A triangular patch.
template <class S>
concept TriangularPatch = requires(const S& s) {
    s.coefficient(0, 0);
    s.coefficients();
};

// "curve", "surface", "volume", "triangle", "trimmed", "model": the `type` of the document.
inline std::string_view type_name(const Shape& shape) {
    return visit_one(
        [](const auto& s) -> std::string_view {
            using S = std::remove_cvref_t<decltype(s)>;
            if constexpr (TensorPatch<S>)
                return S::kParams == 1 ? "curve" : S::kParams == 2 ? "surface" : "volume";
            else if constexpr (TriangularPatch<S>)
                return "triangle";
            else if constexpr (std::same_as<S, TrimmedSurface>)
                return "trimmed";
            else
                return "model";
        },
        shape);
}

struct Object {
    std::string name;  // may be empty
    Shape shape;
    // Of a rational patch or triangle, optional: its points as they were given, one after the other. The
    // patch holds w x, from which x comes back only up to rounding. Whoever changes the shape leaves this
    // empty; the writer uses only numbers that fit the shape.
    std::vector<double> given_points = {};
    // Of a patch or triangle, optional: the name of its texture or material, and a colour for every control
    // point, in the order of the points.
    std::string material = {};
    std::vector<Colour> colours = {};
    // What the reader had to change, with bounds; `where` counts from the object. A model carries its own.
    std::vector<Approximation> approximations = {};
};

struct Document {
    std::string unit;  // "mm", "m", "inch", ...; may be empty
    std::vector<Object> objects;
    std::vector<Refusal> left_out = {};  // what of a file has no object, and why
};

}  // namespace freiform

// The shapes that a page holds, by number.
#pragma once
#include "module.hpp"

#include <freiform/query/nearest.hpp>
#include <freiform/shape.hpp>
#include <freiform/spline/prepared.hpp>
#if FREIFORM_MODELS
#include <freiform/model/nearest.hpp>
#endif

#include <optional>

namespace freiform::wasm {

struct Held {
    explicit Held(Object held_object) : object(std::move(held_object)) {}
    Object object;
    // Made when first asked for; a patch that cannot be prepared is evaluated point by point.
    bool asked = false;
    std::optional<detail::PreparedNet> prepared;
    std::optional<NearestQuery> nearest;
#if FREIFORM_MODELS
    std::optional<ModelNearestQuery> model_nearest;
#endif
};

int hold(Object object);
Held& held(int handle);  // refuses to the page what is not there
void let_go(int handle);

// Of a tensor patch or triangle; all of it empty for others.
struct Parts {
    std::span<const BSplineBasis> bases;  // of a triangle none
    int degree = 0;                       // of a triangle
    Tuples coefficients;
    int parameters = 0;
};
Parts parts_of(const Shape& shape);

#if FREIFORM_MODELS
// Of a model or trimmed surface: the reply of ff_nearest; false of anything else.
bool nearest_of_model(Held& h, std::span<const double> points, double accuracy);
#endif

}  // namespace freiform::wasm

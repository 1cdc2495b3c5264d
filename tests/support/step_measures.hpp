// What models read from STEP files are asked for.
#pragma once
#include "random.hpp"

#include <freiform/model/tessellate.hpp>

#include <algorithm>
#include <gtest/gtest.h>
#include <string_view>

namespace freiform::test {

// Of all faces, by triangles within the tolerance.
inline double area_of(const Model& m, double tolerance = 1e-5) {
    const auto t = must(tessellate(m, {.tolerance = tolerance}));
    EXPECT_TRUE(t.refused.empty()) << t.refused[0].reason.message;
    double sum = 0;
    for (const auto& f : t.mesh.triangles) {
        const auto at = [&](int k) {
            return t.mesh.points[std::size_t(t.mesh.vertices[std::size_t(f[std::size_t(k)])].point)];
        };
        sum += norm(cross(at(1) - at(0), at(2) - at(0))) / 2;
    }
    return sum;
}

// How many approximations of the model say so.
inline std::ptrdiff_t times_told(const Model& m, std::string_view what) {
    return std::ranges::count_if(m.approximations,
                                 [&](const Approximation& a) { return a.what.find(what) != a.what.npos; });
}

}  // namespace freiform::test

// Law: what a face has in a part is within the part's error of its clipped triangles, whatever its loops are.
#include "model/face_parts_detail.hpp"
#include "support/sanitizer.hpp"
#include "support/trimmed_faces.hpp"

#include <freiform/mesh/triangle_tree.hpp>

#include <gtest/gtest.h>
#include <queue>

namespace freiform::test {
namespace {

double distance_from(const std::array<ClippedTriangle, 2>& triangles, const Vec<3>& p) {
    double least = kInfinity;
    for (const ClippedTriangle& t : triangles)
        for (std::size_t k = 2; k < std::size_t(t.size); ++k)
            least = std::min(
                least, norm(p - closest_point(Triangle3{t.corner[0], t.corner[k - 1], t.corner[k]}, p)));
    return least;
}

TEST(FaceParts, clipped_triangles_are_near_all_that_the_face_has_there) {
    TrimmedFaces faces(11);
    int clipped = 0, looked = 0;
    for (int i = 0; i < cases(40); ++i) {
        const TrimmedFace f = faces.next();
        for (const double accuracy : {1e-2, 1e-5}) {
            const auto parts = must(FaceParts::make(f.model.faces[0], f.model.edges, accuracy));
            const auto smaller = [](const FacePart& a, const FacePart& b) { return a.size < b.size; };
            std::priority_queue<FacePart, std::vector<FacePart>, decltype(smaller)> all(smaller);
            all.push(*parts.whole());
            while (!all.empty() && all.size() < 300) {
                FacePart part = all.top();
                all.pop();
                const auto triangles = parts.clipped(part);
                const int corners = triangles[0].size + triangles[1].size;
                clipped += part.crossing && corners != 6;
                for (int k = 0; k < 49 && std::isfinite(part.error); ++k) {
                    const Vec<2> size = part.box.hi - part.box.lo,
                                 uv = part.box.lo + Vec<2>{{k % 7 / 6.0 * size[0], k / 7 / 6.0 * size[1]}};
                    if (!parts.holds(part, uv)) continue;
                    ++looked;
                    ASSERT_LE(distance_from(triangles, parts.value(uv)), part.error + 1e-14 * f.size)
                        << i << " (" << name_of(f.nasty) << ") at " << uv[0] << ", " << uv[1];
                }
                for (FacePart& half : parts.halves(part)) all.push(std::move(half));
            }
        }
    }
    EXPECT_GT(clipped, 10 * cases(40));
    EXPECT_GT(looked, 1000 * cases(40));
}

}  // namespace
}  // namespace freiform::test

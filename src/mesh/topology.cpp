// Idea. Counts from the list of edges; a triangle has no area exactly if its three projections to the
// coordinate planes have none.
//
// Method. For each projection the determinant of the differences is compared with a bound on its rounding
// error [Shewchuk 1997]; almost every triangle is settled by one of the three. The others are decided
// exactly: the determinant is the sum of six products of coordinates, each product is the sum of two doubles
// (fma), and the twelve are added into an expansion that represents the sum without error.
//
// Accuracy. Exact, unless coordinates along one axis of one triangle differ in size by more than 2^400, where
// a product may underflow; powers of two are taken out per axis first, so that the size of the model plays no
// part.
//
// Why not the rounded cross product: it errs both ways. Differences that are rounded give area to collinear
// points, and two products that differ only in a bit beyond the 53rd take it from thin triangles.
#include <freiform/mesh/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {
namespace {

using Corners = std::array<Vec<3>, 3>;

// (3 + 16 eps) eps with eps = 2^-53, rounded up.
constexpr double kDeterminantError = 3.3306690738754731e-16;
// Below this a product of differences may have lost bits to underflow.
constexpr double kNoUnderflow = 1e-280;

bool surely_has_area(const Corners& p, int x, int y) {
    const double left = (p[1][x] - p[0][x]) * (p[2][y] - p[0][y]);
    const double right = (p[1][y] - p[0][y]) * (p[2][x] - p[0][x]);
    const double det = std::abs(left - right), size = std::abs(left) + std::abs(right);
    return det > kDeterminantError * size && det > kNoUnderflow && std::isfinite(size);
}

// A sum of doubles without error, smallest first.
struct Expansion {
    std::array<double, 16> part{};
    std::size_t size = 0;

    void add(double b) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const double sum = b + part[i], back = sum - b;
            const double error = (b - (sum - back)) + (part[i] - back);
            if (error != 0) part[kept++] = error;
            b = sum;
        }
        if (b != 0) part[kept++] = b;
        size = kept;
    }
    void add_product(double a, double b) {
        const double product = a * b;
        add(std::fma(a, b, -product));
        add(product);
    }
};

std::array<double, 3> axis_scaled_to_one(const Corners& p, int axis) {
    const double m = std::max({std::abs(p[0][axis]), std::abs(p[1][axis]), std::abs(p[2][axis])});
    const int e = m > 0 ? std::ilogb(m) : 0;
    return {std::scalbn(p[0][axis], -e), std::scalbn(p[1][axis], -e), std::scalbn(p[2][axis], -e)};
}

bool has_area(const Corners& p, int xi, int yi) {
    const auto x = axis_scaled_to_one(p, xi), y = axis_scaled_to_one(p, yi);
    Expansion det;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        det.add_product(x[i], y[j]);
        det.add_product(-y[i], x[j]);
    }
    return det.size > 0;
}

bool is_degenerate(const Corners& p) {
    for (int k = 0; k < 3; ++k)
        if (surely_has_area(p, k, (k + 1) % 3)) return false;
    for (int k = 0; k < 3; ++k)
        if (has_area(p, k, (k + 1) % 3)) return false;
    return true;
}

}  // namespace

MeshTopology topology(const TriangleMesh& mesh) {
    MeshTopology out;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = mesh.points_of(t);
        out.degenerate_triangles += is_degenerate(
            {mesh.points[std::size_t(a)], mesh.points[std::size_t(b)], mesh.points[std::size_t(c)]});
    }
    for (const MeshEdge& edge : edges(mesh)) {
        const int uses = edge.forward + edge.backward;
        out.open_edges += uses == 1;
        out.non_manifold_edges += uses > 2;
        out.misoriented_edges += uses == 2 && edge.forward != 1;
    }
    return out;
}

}  // namespace freiform

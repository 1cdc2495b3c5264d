// Where a surface curves how much: a binary tree of parameter boxes, each with proven bounds of the second
// derivatives, fine where the surface needs fine triangles.
#pragma once
#include <freiform/mesh/face_mesh.hpp>

#include <optional>
#include <vector>

namespace freiform {

// Bounds of |S_uu|, |S_uv|, |S_vv|.
struct Curvature {
    double uu = 0, uv = 0, vv = 0;

    void include(const Curvature& o) {
        uu = std::max(uu, o.uu);
        uv = std::max(uv, o.uv);
        vv = std::max(vv, o.vv);
    }
    // Bound of |D^2 S (d, d)| for d = (du, dv).
    double along(double du, double dv) const {
        return uu * du * du + 2 * uv * std::abs(du * dv) + vv * dv * dv;
    }
};

// Bound of the distance between S and its linear interpolant at the corners of the triangle, on the triangle,
// from second derivatives that `c` bounds there. See the essay in curvature_tree.cpp.
double linear_interpolation_bound(const Curvature& c, const Vec<2>& a, const Vec<2>& b, const Vec<2>& d);

class CurvatureTree {
public:
    // Splits the box of `polygon` (closed by `segments`, pairs of indices) until a leaf inside it can be cut
    // into two triangles whose interpolation bound is at most demands.tolerance, with sides along the axes of
    // at most demands.max_edge. Boxes wholly outside by the odd-even rule are left. Refuses (limit) when more
    // than `max_leaves` are needed, (ill_conditioned) where no bound is finite.
    static Result<CurvatureTree> make(const DerivativeQuery<2, 3>& surface, std::span<const Vec<2>> polygon,
                                      std::span<const std::array<int, 2>> segments,
                                      const FaceDemands& demands, std::size_t max_leaves);

    // Bounds over the part of the box that is not wholly outside the polygon.
    Curvature over(const Box<2>& box) const;
    // What kinks of the surface inside the box add to the interpolation bound.
    double kink_bound(const Box<2>& box) const;
    // The kink that adds most, if any: its axis and parameter.
    std::optional<std::pair<int, double>> worst_kink(const Box<2>& box) const;

    struct Corner {
        Vec<2> at{}, leaf{};  // leaf: side lengths of a leaf that has it
    };
    // Corners of the leaves that are not outside, each once, neighbours near each other in the list.
    std::vector<Corner> corners() const;
    // Mean side lengths of those leaves.
    Vec<2> mean_leaf() const;

private:
    struct Node {
        Box<2> box;
        Curvature curvature;
        int child = -1;  // the first of two neighbours in nodes_; -1: a leaf
        bool outside = false;
    };
    std::vector<Node> nodes_;
    std::array<std::vector<Kink>, 2> kinks_;
};

}  // namespace freiform

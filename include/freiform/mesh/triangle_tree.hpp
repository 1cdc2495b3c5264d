// The nearest of many triangles.
#pragma once
#include <freiform/core/interval.hpp>

#include <array>
#include <limits>
#include <vector>

namespace freiform {

using Triangle3 = std::array<Vec<3>, 3>;

// The point of the closed triangle that is nearest to p. Also of a triangle without area.
Vec<3> closest_point(const Triangle3& t, const Vec<3>& p);

// Boxes over triangles; const, to be asked from many threads.
class TriangleTree {
public:
    // Takes time O(n log n).
    explicit TriangleTree(std::vector<Triangle3> triangles);

    struct Found {
        int triangle = -1;  // -1: none is nearer than asked for
        double distance = std::numeric_limits<double>::infinity();
        Vec<3> point{};  // of that triangle
    };
    // The nearest triangle among those nearer than `within`; about O(log n) for points near them.
    Found nearest(const Vec<3>& p, double within = std::numeric_limits<double>::infinity()) const;

    const std::vector<Triangle3>& triangles() const { return triangles_; }

private:
    struct Node {
        Box<3> box;
        int begin = 0, end = 0;  // of order_
        int left = -1;           // the children are `left` and `left` + 1; -1: a leaf
    };
    std::vector<Triangle3> triangles_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

}  // namespace freiform

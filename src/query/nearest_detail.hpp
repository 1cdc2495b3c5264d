// The search for nearest points on numbers alone: no templates on the number of parameters, coordinates, or
// weights. See nearest_search.cpp for the method.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/core/result.hpp>

#include <array>
#include <limits>
#include <vector>

namespace freiform::detail {

inline constexpr int kMostParams = 3, kMostCoords = 4;

// The Bezier pieces of an object.
struct NearestSource {
    int params = 1, coords = 1;
    bool rational = false, triangle = false;
    std::array<int, kMostParams> degree{};
    std::vector<std::array<Interval, kMostParams>> boxes;  // the part of the domain of each piece
    // For each piece its coefficients, the last parameter fastest, each coords + 1 numbers (w x, w).
    std::vector<double> coefficients;
    int roundings = 0;  // that convex combinations of exact coefficients took to make them

    std::size_t per_piece() const {
        std::size_t n = 1;
        for (int d = 0; d < params; ++d) n *= std::size_t(degree[std::size_t(d)] + 1);
        return n;
    }
};

struct NearestFound {
    std::size_t object = 0;
    std::array<double, kMostParams> at{};
    std::array<double, kMostCoords> point{};
    double distance = 0, point_error = 0, lower_bound = 0;
};

class NearestTree {
public:
    static Result<NearestTree> make(std::vector<const NearestSource*> sources, std::size_t max_bytes);

    int coords() const { return coords_; }

    struct Scratch;
    NearestFound find(const double* point, double accuracy, int max_parts, Scratch& scratch) const;

    using Parameters = std::array<double, kMostParams>;
    using Coords = std::array<double, kMostCoords>;

    // A piece: x = centre + N / W, N and W in Bernstein form of degree p_d.
    struct Piece {
        int params = 1;
        bool rational = false, triangle = false;
        std::uint32_t object = 0;
        std::array<int, kMostParams> degree{};
        std::array<Interval, kMostParams> domain;
        Coords centre{};
        std::size_t coefficients = 0;  // in numbers_: per_piece x (coords + 1)
        // In numbers_: coords + 2 runs of `products` numbers, |N|^2, -2 N_k W, W^2 in Bernstein form of
        // degree 2 p_d.
        std::size_t forms = 0;
        int products = 0;
        double radius = 0;                  // |N| <= radius
        double lightest = 1, heaviest = 1;  // W

        std::size_t control_points() const {
            std::size_t n = 1;
            for (std::size_t d = 0; d < std::size_t(params); ++d) n *= std::size_t(degree[d] + 1);
            return n;
        }
    };
    struct Node {
        Coords lo{}, hi{};
        int first = 0, count = 0;  // pieces of a leaf
        int right = 0;             // inner: the left child follows, the right one is here
    };

private:
    template <int D>
    friend struct NearestSearch;
    template <int D>
    NearestFound find_in(const double* point, double accuracy, int max_parts, Scratch& scratch) const;
    void build(int begin, int end, std::vector<Node>& boxes);

    int coords_ = 1, exponent_ = 0;
    double largest_ = 0;  // |coordinate|, in units of 2^exponent_
    double slip_ = 0;     // pieces are at most so far from the objects, in these units
    std::vector<Piece> pieces_;
    std::vector<Node> nodes_;
    std::vector<double> numbers_;
};

// What a search needs of memory, kept from one to the next.
struct NearestTree::Scratch {
    std::vector<double> blocks;
    std::vector<std::pair<double, int>> nodes;
};

}  // namespace freiform::detail

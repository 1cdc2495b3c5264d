// The search for nearest points on numbers alone: no templates on the number of parameters, coordinates, or
// weights. See nearest_search.cpp for the method.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/core/interval.hpp>
#include <freiform/core/result.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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
    double distance = 0, point_error = 0;
    double bound = 0;  // lower or upper, as was asked for
};

struct NearestFootFound {
    NearestFound foot;
    std::array<Interval, kMostParams> box{};
    bool stretch = false;
};

// A cell of parameters, of points that may be as near as asked for.
struct NearestCell {
    std::uint32_t object = 0;
    std::array<Interval, kMostParams> box{};  // of the object
    int piece = 0;
    std::array<double, kMostParams> at{};  // in the piece: the nearest point that was looked at
    double square = 0;                     // of its distance, in divided units
    bool whole = false;                    // all points of the cell are as near, but for rounding
    bool stretch = false;                  // `whole`, and a sixteenth of a piece or more along some axis
};
// Cells of one object whose closed boxes touch as one, with the nearest point of all.
std::vector<NearestCell> regions_of(std::vector<NearestCell> cells);

class NearestTree {
public:
    static Result<NearestTree> make(std::vector<const NearestSource*> sources, std::size_t max_bytes);

    int coords() const { return coords_; }
    int exponent() const { return exponent_; }  // coordinates are kept in units of 2^exponent

    struct Scratch;
    NearestFound find(const double* point, double accuracy, int max_parts, Scratch& scratch) const;
    NearestFound find_farthest(const double* point, double accuracy, int max_parts, Scratch& scratch) const;
    // All that is nearer than `radius` is in the cells, none of which is longer than `finest` of a piece
    // unless it is `whole`, or the budget is spent and `complete` becomes false.
    std::vector<NearestCell> cells(const double* point, double radius, double finest, int max_parts,
                                   Scratch& scratch, bool& complete) const;
    NearestFound found(const NearestCell& cell, const double* point) const;
    // The `count` nearest local minima of the distance, nearest first; `others`: all that are not among them
    // are at least so far.
    std::vector<NearestFootFound> feet(const double* point, int count, int max_parts, Scratch& scratch,
                                       double& others, bool& complete) const;

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
    friend struct NearestBlocks;
    template <int D>
    friend struct NearestSearch;
    template <int D>
    friend struct NearestExtent;
    template <int D>
    friend struct NearestFeetSearch;
    template <int D>
    friend class PieceSide;
    template <int D>
    NearestFound find_in(const double* point, double accuracy, int max_parts, Scratch& scratch) const;
    template <int D>
    NearestFound found_at(int piece, const Parameters& at, const double* point) const;
    template <class F>
    auto with_coords(F&& f) const;  // f(integral constant of coords_)
    std::array<Interval, kMostParams> box_of(int piece, const Parameters& lo, const Parameters& hi) const;

    static double in_domain(const Interval& on, double t) {
        return t >= 1 ? on.hi : std::clamp(on.lo + t * (on.hi - on.lo), on.lo, on.hi);
    }
    // By 2^exponent_: powers of two, which a product does not round, where they are doubles.
    double divided(double x) const { return moderate_ ? x * down_ : std::scalbn(x, -exponent_); }
    double multiplied(double x) const { return moderate_ ? x * up_ : std::scalbn(x, exponent_); }
    // What multiplied() is off by at most: it rounds where its result is below the normal range.
    double underflow() const { return exponent_ < -900 ? std::numeric_limits<double>::denorm_min() : 0; }
    double multiplied_down(double x) const { return std::max(0.0, multiplied(x) - underflow()); }
    // A bound, for points of a piece: 3 p + 3 roundings along each axis in N and in W, the quotient, the sum
    // with the centre.
    double evaluation_error(const Piece& p) const {
        double steps = 4;
        for (int d = 0; d < p.params; ++d) steps += 3 * p.degree[std::size_t(d)] + 3;
        return std::sqrt(double(coords_)) * 1.03 * (2 * steps + 2) * kUnitRoundoff * largest_ * 2;
    }
    void build(int begin, int end, std::vector<Node>& boxes);

    int coords_ = 1, exponent_ = 0;
    bool moderate_ = true;
    double down_ = 1, up_ = 1;
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

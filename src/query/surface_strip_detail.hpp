// Two lines that meet, in matching parts, as polynomials: what jumps along them are made of.
#pragma once
#include <freiform/poly/form.hpp>
#include <freiform/query/surface_continuity.hpp>

#include <array>

namespace freiform::detail {

// The Bernstein coefficients on the part [x, y] of [0, 1].
std::vector<Bounded> restricted(std::vector<Bounded> c, const std::array<Bounded, 2>& on);

struct LineMatch {
    std::size_t a = 0, b = 0;           // pieces
    std::array<Bounded, 2> on_a, on_b;  // fractions of these pieces
    Interval on;                        // parameters of the first line
};

// Polynomials of one side on a part; lengths times 2^-length, the parameter across times 2^across.
struct Strip {
    std::vector<std::vector<Form<Bounded>>> d;  // [order][coordinate], the last one is the weight
    const std::vector<Form<Bounded>>& operator[](std::size_t k) const { return d[k]; }
    const Form<Bounded>& w(std::size_t k = 0) const { return d[k].back(); }
};

// A joint on all its parts. The sides and options are those that it was made from.
struct JointStrips {
    const SurfaceSide &a, &b;
    const ContinuityOptions& options;
    int length = 0, across = 0;  // common scales
    std::vector<LineMatch> parts;
    std::vector<Strip> first, second;

    // The lines cut at the breaks of both; breaks that agree as far as is known are one.
    static JointStrips make(const SurfaceSide& a, const SurfaceSide& b, const ContinuityOptions& options);
    // The same joint with every part in two.
    JointStrips halved() const;

private:
    void add(const LineMatch& p);
};

}  // namespace freiform::detail

// What intersections answer: contacts, overlaps, and what is left open.
#pragma once
#include <freiform/core/interval.hpp>

#include <array>
#include <string_view>
#include <vector>

namespace freiform {

enum class ContactKind {
    crossing,  // at an angle: one root, simple
    tangent,   // touching, or through a cusp: one root, of multiplicity 2 or more
    end,       // an end of an open curve, or the boundary of a surface, lies on the other object
    possible,  // within rounding the two may meet here, `least` to `most` times, or pass by at most `gap`
               // apart
};
std::string_view name_of(ContactKind kind);

// D coordinates, N parameters: those of the first object, then those of the second.
template <int D, std::size_t N>
struct Contact {
    ContactKind kind = ContactKind::possible;
    std::array<double, N> at{};
    std::array<Interval, N> box{};  // contains `at`, and the parameters of all roots that are meant
    Vec<D> point{};                 // of one of the objects at `at`
    // Bound: how far the points of both objects at `at` are from each other. What parameters are rounded by,
    // far from zero in their domain, is counted to first order.
    double gap = 0;
    // So many isolated points of `box` are roots. Where the two run along each other, all of a `possible` box
    // may be.
    int least = 1, most = 1;
    // Of intersection, as in Bezout's theorem: 1 at an angle, 2 for circles that touch, 3 where one crosses
    // its osculating circle. 0: not known.
    int multiplicity = 1;

    // Exactly one root in `box`, by proof.
    bool is_proven() const { return least == 1 && most == 1; }
};

// The curves are the same over these intervals.
struct Overlap {
    Interval a, b;
    bool reversed = false;  // b runs against a
    // bound: how far a point of one curve over its interval is from the other one. 0: the same points,
    // exactly; the ends of the intervals are then rounded.
    double gap = 0;
};

template <int D, std::size_t N>
struct Intersections {
    std::vector<Contact<D, N>> contacts;  // ordered by `at`
    std::vector<Overlap> overlaps;        // ordered by `a`; of two curves
    // Parameters of which nothing is known: the budget ended.
    std::vector<std::array<Interval, N>> undecided;
};

struct IntersectOptions {
    // A length: curves that run along each other at most this far apart are an overlap; 0: only as far as
    // rounding asks for.
    double accuracy = 0;
    // A backstop: pairs of parts that are looked at for each pair of Bezier pieces. Transversal contacts need
    // a few dozen, tangential ones a few hundred.
    int max_parts = 50000;
};

}  // namespace freiform

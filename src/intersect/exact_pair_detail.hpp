// Two Bezier curves in integers: what rounding leaves open of their contacts is decided here.
#pragma once
#include <freiform/core/hom.hpp>
#include <freiform/poly/form.hpp>
#include <freiform/poly/integer_roots.hpp>

#include <optional>
#include <span>
#include <vector>

namespace freiform::detail {

// A curve in homogeneous coordinates, of the least degree: elevations are undone.
struct ExactCurve {
    std::array<Form<Integer>, 3> x;  // x, y and the weight
    Form<Integer> third;             // of curves in space the coordinate that x leaves out
    int degree() const { return x[2].degree(); }
    bool is_point() const;
};

// Parameters of the pieces at which both curves are in the same place; of one, exactly this.
struct ExactContact {
    Interval a, b;
    int multiplicity = 0;  // 0: not known
};

class ExactPair {
public:
    // Degrees whose product is larger take too long.
    static constexpr int kMaxProduct = 40, kMaxDegree = 8;

    ExactPair(std::span<const Hom<2>> a, std::span<const Hom<2>> b);
    // Curves in space: those of the plane that their image without one coordinate is, and then that one.
    ExactPair(std::span<const Hom<3>> a, std::span<const Hom<3>> b, int third);

    // Not more than the work that is bearable?
    bool is_bearable() const;
    // Do both run on the same algebraic curve?
    bool coincide();
    // All contacts in a box of parameters; nothing if something was left open: curves that coincide, run
    // along themselves, or meet in a double point of one of them.
    std::optional<std::vector<ExactContact>> contacts(const Interval& a, const Interval& b);
    // All pairs of parameters of which one is an end of its curve. Nothing if a curve is a single point.
    std::optional<std::vector<ExactContact>> ends() const;
    // All parameters of the other curve at which it passes through this one, which is a point.
    std::vector<Interval> at_point(bool first) const;

private:
    struct Side {
        std::vector<Integer>
            resultant;  // Bernstein coefficients of the equation of one curve along the other
        std::vector<Root> roots;
        // The parameter of the other curve is v1 / (v0 + v1): near 0, and near 1.
        std::array<std::array<Form<Integer>, 2>, 2> place;
    };
    void prepare();
    // Are the points at this root of `on`, and at a parameter in `cell` of the other curve, the same?
    static std::optional<bool> meets(const Side& side, const Root& root, const Interval& cell, bool high,
                                     const ExactCurve& on, const ExactCurve& of);
    static Side side(const ExactCurve& along, const ExactCurve& of);

    ExactCurve a_, b_;
    std::optional<std::array<Side, 2>> sides_;
};

}  // namespace freiform::detail

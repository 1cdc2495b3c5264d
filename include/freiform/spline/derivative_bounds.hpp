// Proven bounds of first and second derivatives over parameter boxes: what makes a tessellation certain
// instead of sampled.
#pragma once
#include <freiform/spline/bezier.hpp>
#include <freiform/spline/geometry.hpp>

#include <memory>
#include <optional>
#include <span>
#include <variant>

namespace freiform {

inline constexpr int kBoundOrder = 3;

// d[slot] >= |partial derivative| on the whole box, Euclidean norm, graded order (jet_slot) up to order 3;
// d[0] is the radius of a ball that contains the values. May be infinite.
template <std::size_t N>
struct DerivativeBounds {
    std::array<double, jet_size(N, kBoundOrder)> d{};

    template <std::convertible_to<int>... I>
    requires(sizeof...(I) == N) double operator()(I... orders) const {
        return d[jet_slot(Index<N>{int(orders)...})];
    }
    void include(const DerivativeBounds& o) {
        for (std::size_t i = 0; i < d.size(); ++i) d[i] = d[i] < o.d[i] ? o.d[i] : d[i];
    }
};

// Of one Bezier block (coefficients `net` over a box of side lengths `width`), up to total order `order` <=
// 3; the higher ones are left 0. `size`: coefficients are off by as much as if they were of this size.
template <std::size_t N, class P>
DerivativeBounds<N> derivative_bounds(const NetView<N, const P>& net, const std::array<double, N>& width,
                                      int order = 2, double size = 0);

// A place where the first derivative along `axis` jumps: a knot of multiplicity >= degree; for an offset one
// of its base of multiplicity >= degree - 1.
struct Kink {
    double at = 0;  // parameter
    double jump =
        0;  // bound of |f_d(at+) - f_d(at-)| along the whole line; infinite where the value itself jumps
};

// What kinks inside `on` add to the error of linear interpolation over it (see curvature_tree.cpp): a jump J
// with a and b of the interval on its sides adds J a b / (a + b).
inline double kink_bound_of(std::span<const Kink> kinks, Interval on) {
    double sum = 0;
    for (const Kink& k : kinks)
        if (on.lo < k.at && k.at < on.hi) sum += k.jump * ((k.at - on.lo) * (on.hi - k.at) / on.length());
    return sum;
}

template <std::size_t N, int D>
struct GeometryOf;
template <int D>
struct GeometryOf<1, D> {  // D = 1, 2, 3
    using type = CurveGeometry<D>;
};
template <>
struct GeometryOf<2, 3> {
    using type = SurfaceGeometry;
};

// A function M that is quadratic along each axis of a box: bilinear in the values at its corners, and
// s (1 - s) bulge[0] + t (1 - t) bulge[1] more, s and t from 0 to 1.
struct BoxQuadratic {
    std::array<Interval, 2> box;
    std::array<Vec<3>, 4> corner{};  // (lo, lo), (hi, lo), (lo, hi), (hi, hi)
    std::array<Vec<3>, 2> bulge{};

    Vec<3> operator()(double s, double t) const {
        return (1 - t) * ((1 - s) * corner[0] + s * corner[1]) + t * ((1 - s) * corner[2] + s * corner[3]) +
               s * (1 - s) * bulge[0] + t * (1 - t) * bulge[1];
    }
};
// Such a function beside a surface f: bounds over the box of f - M and its derivatives to order 2, and of
// their coordinate along a vector n; graded order.
struct QuadraticFit {
    BoxQuadratic m;
    std::array<double, jet_size(2, 2)> all, along;
};

struct PlaneCurveBounds;

// Prepared once for a curve (N = 1) or surface (N = 2), asked for many boxes; const and safe to share between
// threads. The geometry must outlive it.
template <std::size_t N, int D>
class DerivativeQuery {
public:
    using Geometry = typename GeometryOf<N, D>::type;

    explicit DerivativeQuery(const Geometry& geometry);
    const Geometry& geometry() const { return *geometry_; }
    // Bounds on `box` up to total order `order` <= 3 (of an offset: 2). The part of the box outside the
    // domain of a spline is ignored. Infinite where no bound exists (at singular points of an offset).
    DerivativeBounds<N> operator()(const std::array<Interval, N>& box, int order = 2) const;
    // Of the coordinate n . f instead of f, for a vector n of length 1: bounds of |n . f_a|.
    DerivativeBounds<N> along(const Vec<D>& n, const std::array<Interval, N>& box, int order = 2) const;
    // Along two vectors, for little more than one costs.
    std::array<DerivativeBounds<N>, 2> along_two(const std::array<Vec<D>, 2>& n,
                                                 const std::array<Interval, N>& box, int order = 2) const;
    // Both of f and of n . f: what is said above, for little more than one costs.
    struct Both {
        DerivativeBounds<N> all, along;
    };
    Both both(const Vec<D>& n, const std::array<Interval, N>& box, int order = 2) const;
    // Of a surface that is a spline, by that function, or by one with the same bulges that it meets at the
    // corners of the box. n has length 1, or 0. Infinite bounds where there is no spline, or it ends within
    // the box. With more cuts, into equal parts along each axis, bounds are sharper.
    QuadraticFit fit(const BoxQuadratic& m, bool at_corners, const Vec<3>& n,
                     const std::array<int, 2>& cuts = {1, 1}) const requires(N == 2 && D == 3);
    // The smallest side along the axis of a polynomial or rational piece; infinite where there is no spline.
    // First derivatives are rounded as if values were divided by no less.
    double thinnest_piece(int axis) const { return thinnest_[std::size_t(axis)]; }
    // value_error_bound of the geometry, which for splines takes as long as they are large, found once.
    double value_error(const std::array<Interval, N>& box) const {
        return value_error_ ? *value_error_ : value_error_bound(*geometry_, box);
    }
    // Inside the domain, in increasing order. Between kinks the first derivative is continuous.
    std::span<const Kink> kinks(int axis) const { return kinks_[std::size_t(axis)]; }
    // Of a spline: the ends of its domain, and where second derivatives may jump, in increasing order. Else
    // empty.
    std::span<const double> bends(int axis) const { return bends_[std::size_t(axis)]; }
    // Of a spline: the ends of its polynomial or rational pieces, in increasing order. Else empty.
    std::span<const double> breaks(int axis) const;
    // How many numbers the control points of a polynomial or rational piece are; 0 where there is no spline.
    long long piece_numbers() const { return piece_numbers_; }
    // The largest quotient of two weights of one piece; 1 where there are none.
    double weight_spread() const { return weight_spread_; }
    // Whether the box is one of a spline and within its domain, and second derivatives are continuous in it.
    bool is_twice_smooth(const std::array<Interval, N>& box) const;
    // Of such a spline: |jet<2> - exact| of the second derivative along both axes is at most this.
    double second_rounding(int axis, int other) const {
        return second_rounding_ / (thinnest_[std::size_t(axis)] * thinnest_[std::size_t(other)]);
    }

    // Of an extrusion or revolution; else none.
    const DerivativeQuery<1, 3>* profile() const { return profile_.get(); }
    // Of an offset: of what it is an offset of. Else none.
    const DerivativeQuery<2, 3>* base() const { return base_.get(); }

private:
    friend PlaneCurveBounds coordinate_bounds(const DerivativeQuery<1, 2>&, Interval);
    const Geometry* geometry_;
    std::array<std::vector<Kink>, N> kinks_;
    // Of a spline: its ends, and where second derivatives may jump.
    std::array<std::vector<double>, N> bends_;
    long long piece_numbers_ = 0;
    double weight_spread_ = 1;
    double second_rounding_ = 0;  // times two sides of the thinnest piece
    std::array<double, N> thinnest_;
    std::optional<double> value_error_;
    std::variant<std::monostate, BezierPieces<N, Vec<D>>, BezierPieces<N, Hom<D>>> pieces_;
    std::shared_ptr<const DerivativeQuery<1, 3>> profile_;  // of an extrusion or revolution
    std::shared_ptr<const DerivativeQuery<2, 3>> base_;     // of an offset
};

// Of each coordinate of a plane curve by itself, and of the curve, to order 2: what three queries would say,
// for little more than one costs.
struct PlaneCurveBounds {
    std::array<DerivativeBounds<1>, 2> coordinate;
    DerivativeBounds<1> both;
};
PlaneCurveBounds coordinate_bounds(const DerivativeQuery<1, 2>& curve, Interval on);

}  // namespace freiform

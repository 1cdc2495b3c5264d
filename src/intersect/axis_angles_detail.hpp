// Angles as the parameter of an axis along which a spline goes round ellipses: the same ones for every spline
// of the same shape, wherever its pieces begin.
//
// Notation. s: the parameter of the spline; tau in [0, 1]: the place in a piece of degree 2 with the weights
// w0, w1, w2 (up to a factor for each row); c = w1 / sqrt(w0 w2), r = sqrt(w2 / w0). With
//     tau' = r tau / (1 - tau + r tau)
// the weights are 1, c, 1, and for c = cos h < 1 the piece is an arc of 2 h of an ellipse, in whose angle
//     x = m + 2 atan(K (2 tau' - 1)),   K = tan(h / 2),   m the angle of its middle.
// Angles of pieces are added up; the first is 0. That a piece is an arc of an ellipse says nothing about the
// next one: whoever compares two surfaces in these parameters compares their control points, too.
#pragma once
#include <freiform/spline/bezier.hpp>

#include <vector>

namespace freiform::detail {

class AxisAngles {
public:
    // The parameter itself where the pieces are no arcs of ellipses, or not of the same one in all rows.
    static AxisAngles of(const Surface<Hom<3>>& surface, int axis);
    static AxisAngles identity(const Surface<Hom<3>>& surface, int axis);

    bool is_identity() const { return pieces_.empty(); }
    Interval range() const { return {at(breaks_.front()), at(breaks_.back())}; }
    const std::vector<double>& breaks() const { return breaks_; }  // of the spline
    double at(double s) const;
    double slope(double s) const;  // dx/ds
    double inverse(double x) const;
    // Contains x of all s of an interval; s of all x. Wider by kSlack of the domain: what weights of rows may
    // differ by, and rounding.
    Interval over(const Interval& s) const;
    Interval inverse_over(const Interval& x) const;

private:
    static constexpr double kSlack = 0x1p-37;
    struct Arc {
        double from = 0, half = 0, k = 0, ratio = 1;
    };
    std::size_t piece_of(double s) const;
    std::vector<double> breaks_;
    std::vector<Arc> pieces_;
};

}  // namespace freiform::detail

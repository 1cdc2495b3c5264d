// A surface as a tree of parts: what the search for the intersection of two surfaces asks of each of them.
//
// Notation. A part is a rectangle of parameters: of several Bezier pieces (it has a box then, and no more),
// or inside of one. Its surroundings are the rectangle that is longer by kMargin of its length at all sides;
// beyond the border of the surface the outermost polynomials go on, beyond a seam the surface itself does.
//
// Accuracy. A control point of a part that was halved k times is off by (k n + c) roundings of the largest
// one, c from the extraction (arc_pieces_detail.hpp). Derivatives of X / W over a part are averages of
//     n (d_i+1 - d_i) / W - (X / W - m) W' / W,    d = X - m W, m the middle of the part,
// so they are within the box of the first terms at the middle weight, widened by what W varies and by the
// second term (as in parts_detail.hpp).
#pragma once
#include "arc_pieces_detail.hpp"

#include <freiform/core/interval.hpp>

#include <deque>
#include <span>

namespace freiform::detail {

// Contains every derivative along an axis, and means of them.
struct SlopeBox {
    Vec<3> lo = Box<3>::filled(kInfinity), hi = Box<3>::filled(-kInfinity);
    Vec<3> middle() const { return 0.5 * (lo + hi); }
    Vec<3> radius() const { return 0.5 * (hi - lo); }
    void include(const SlopeBox& o) {
        for (int k = 0; k < 3; ++k) lo[k] = std::min(lo[k], o.lo[k]), hi[k] = std::max(hi[k], o.hi[k]);
    }
};

struct SheetPart {
    Box<3> box;
    std::array<Interval, 2> on{};     // parameters
    std::array<int, 2> from{}, to{};  // pieces, [from, to)
    std::array<Interval, 2> local{};  // of one piece, in [0, 1]
    Vec<3> normal{};                  // roughly; zero where there is none
    Interval slab;                    // of the control points along the normal
    double error = 0;                 // of each coordinate of the control points
    double roundings = 0;
    int net = -1, left = -1;            // first control point, first child
    std::array<int, 2> slopes{-1, -1};  // over the part, over its surroundings
    bool is_one_piece() const { return net >= 0; }
    double extent() const { return max_abs(box.hi - box.lo); }
};

class Sheet {
public:
    static constexpr double kMargin = 1.25;

    explicit Sheet(const Surface<Hom<3>>& surface);

    const SheetPart& operator[](int i) const { return parts_[std::size_t(i)]; }
    const Vec<3>* hull(int part) const { return hull_.data() + (*this)[part].net; }
    int block() const { return block_; }
    const std::array<Interval, 2>& domain() const { return domain_; }
    bool is_cyclic(int axis) const { return cyclic_[std::size_t(axis)]; }
    double scale() const { return scale_; }
    // Of each coordinate of a value in the domain, and at any place of the surroundings of parts.
    double inner_error() const { return inner_error_; }
    double value_error() const { return value_error_; }
    const std::vector<double>& breaks(int axis) const { return breaks_[std::size_t(axis)]; }

    // Both parts are whole pieces, of the same control points in the same or a reversed order, along the same
    // or the other axis each.
    bool has_piece_of(int part, const Sheet& other, int part_of_other) const;

    struct At {
        Vec<3> point{};
        std::array<Vec<3>, 2> d{};
    };
    // Beyond the domain: the outermost piece goes on, or the surface over the seam.
    At at(double u, double v) const;

    // False: parameters that can not be halved any more. Parts over which a cut runs are divided there first.
    bool split(int part);
    void cut_at(std::size_t axis, double at) { cuts_[axis].push_back(at); }
    using Slopes = std::array<SlopeBox, 2>;
    const Slopes& slopes(int part, bool around);

private:
    struct Piece {
        int index = 0;
        double t = 0;
    };
    int add(SheetPart part);
    void finish(SheetPart& part) const;
    Piece locate(std::size_t axis, double x) const;
    void add_slopes(int piece, const std::array<Interval, 2>& local, Slopes& out);
    void add_slopes_of(const Hom<3>* net, const std::array<double, 2>& width, double roundings,
                       Slopes& out) const;
    double width(std::size_t axis, int piece) const {
        return breaks_[axis][std::size_t(piece) + 1] - breaks_[axis][std::size_t(piece)];
    }

    std::array<int, 2> degree_{}, count_{};
    std::array<std::vector<double>, 2> breaks_;
    std::array<Interval, 2> domain_{};
    std::array<std::vector<double>, 2> cuts_;
    std::array<bool, 2> cyclic_{};
    int block_ = 0;
    double scale_ = 0, unit_ = 0, stretch_ = 1, inner_error_ = 0, value_error_ = 0;
    std::vector<Hom<3>> pieces_, nets_, restricted_;
    std::vector<Vec<3>> hull_;
    std::vector<SheetPart> parts_;
    std::deque<Slopes> slopes_;
};

}  // namespace freiform::detail

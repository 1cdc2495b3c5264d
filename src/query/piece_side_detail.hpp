// The Bezier pieces of prepared objects and their halves, as searches over parts take them
// (query/pair_search.hpp): hulls of control points, with how far a part may leave them.
#pragma once
#include "query/nearest_blocks_detail.hpp"

#include <freiform/query/pair_search.hpp>

namespace freiform::detail {

// The pieces of a tree and their halves.
template <int D>
class PieceSide {
public:
    using Parameters = NearestTree::Parameters;
    struct Place {
        int node = -1, piece = -1;  // one of them
        Parameters lo{}, hi{};
        std::size_t net = 0, hull = 0;
        std::size_t hulls = 0;  // points
        double halvings = 0;    // each as often as the degree
    };

    // `unit`: a power of two, how many of the common units one of the tree is.
    PieceSide(const NearestTree& tree, double unit) : tree_(tree), unit_(unit) { add_node(0); }

    const std::vector<PairPart<D>>& parts() const { return parts_; }
    const Place& place(int i) const { return places_[std::size_t(i)]; }
    std::span<const Vec<D>> hull(int i) const { return {points_.data() + place(i).hull, place(i).hulls}; }
    std::size_t bytes() const { return 8 * (net_.size() + D * points_.size()); }
    double slip() const { return tree_.slip_ * unit_; }
    double largest() const { return tree_.largest_ * unit_; }

    bool is_box(int i) const { return place(i).piece < 0; }
    // How far point k of a piece is from the multilinear interpolation of its corners at the same place:
    // these are, but for the slack, points of the object, and that is one of their hull.
    double apart(int i, int k) const {
        const auto& piece = tree_.pieces_[std::size_t(place(i).piece)];
        const auto points = hull(i);
        Vec<D> mean{};
        for (unsigned corner = 0; corner < 1u << piece.params; ++corner) {
            std::size_t at = 0, rest = std::size_t(k), step = 1;
            double share = 1;
            for (std::size_t d = std::size_t(piece.params); d-- > 0;) {
                const std::size_t p = std::size_t(piece.degree[d]), own = rest % (p + 1);
                const bool far = corner >> d & 1;
                const double x = p > 0 ? double(own) / double(p) : 0;
                share *= far ? x : 1 - x;
                at += far ? p * step : 0;
                rest /= p + 1, step *= p + 1;
            }
            if (share > 0) mean += share * points[at];
        }
        return norm(points[std::size_t(k)] - mean);
    }

    bool split(int i) {
        if (parts_[std::size_t(i)].first >= 0) return true;
        const int first = int(parts_.size());
        const Place p = place(i);
        if (p.piece < 0) {
            const auto& node = tree_.nodes_[std::size_t(p.node)];
            if (node.count > 0) {
                add_piece(node.first);
            } else {
                add_node(p.node + 1);
                add_node(node.right);
            }
        } else if (!add_halves(p)) {
            return false;
        }
        parts_[std::size_t(i)].first = first;
        parts_[std::size_t(i)].end = int(parts_.size());
        return true;
    }

    // x in common units, with derivatives up to order 2.
    LocalJet jet(int piece, const Parameters& at) const {
        const auto& p = tree_.pieces_[std::size_t(piece)];
        LocalJet j = SeenPiece<D>{&p, tree_.numbers_.data() + p.coefficients, {}}.jet(at);
        for (std::size_t k = 0; k < std::size_t(D); ++k) {
            j.value[k] = (p.centre[k] + j.value[k]) * unit_;
            for (std::size_t d = 0; d < std::size_t(p.params); ++d) {
                j.first[d][k] *= unit_;
                for (std::size_t e = 0; e <= d; ++e) j.second[d][e][k] *= unit_;
            }
        }
        return j;
    }
    std::size_t params(int piece) const { return std::size_t(tree_.pieces_[std::size_t(piece)].params); }
    NearestFound found(int piece, const Parameters& at) const {
        const std::array<double, kMostCoords> nothing{};
        return tree_.found_at<D>(piece, at, nothing.data());
    }

private:
    void add_node(int i) {
        const auto& node = tree_.nodes_[std::size_t(i)];
        Place p;
        p.node = i;
        p.hull = points_.size();
        p.hulls = std::size_t(1) << D;
        PairPart<D> part;
        for (unsigned corner = 0; corner < 1u << D; ++corner) {
            Vec<D> x;
            for (int k = 0; k < D; ++k) x[k] = (corner >> k & 1 ? node.hi : node.lo)[std::size_t(k)] * unit_;
            part.box.add(x);
            points_.push_back(x);
        }
        places_.push_back(p);
        parts_.push_back(part);
    }
    void add_piece(int i) {
        const auto& piece = tree_.pieces_[std::size_t(i)];
        Place p;
        p.piece = i;
        for (std::size_t d = 0; d < std::size_t(piece.params); ++d) p.hi[d] = 1;
        const double* n = tree_.numbers_.data() + piece.coefficients;
        add_part(p, std::vector<double>(n, n + piece.control_points() * (D + 1)));
    }
    void add_part(Place p, const std::vector<double>& net) {
        const auto& piece = tree_.pieces_[std::size_t(p.piece)];
        p.net = net_.size();
        p.hull = points_.size();
        p.hulls = piece.control_points();
        net_.insert(net_.end(), net.begin(), net.end());
        PairPart<D> part;
        for (std::size_t i = 0; i < net.size(); i += D + 1) {
            Vec<D> x;
            for (int k = 0; k < D; ++k)
                x[k] = (piece.centre[std::size_t(k)] + net[i + std::size_t(k)] / net[i + D]) * unit_;
            part.box.add(x);
            points_.push_back(x);
        }
        const double moved = piece.radius + piece.radius / piece.lightest * piece.heaviest;
        part.slack =
            1.01 * std::sqrt(double(D)) * p.halvings * kUnitRoundoff * moved / piece.lightest * unit_;
        places_.push_back(p);
        parts_.push_back(part);
    }

    // Along the axis whose rows of control points are longest.
    bool add_halves(const Place& p) {
        const auto& piece = tree_.pieces_[std::size_t(p.piece)];
        const std::size_t count = piece.control_points(), stride = D + 1;
        std::size_t axis = kMostParams, step_of_axis = 0, step = 1;
        double longest = -1;
        for (std::size_t d = std::size_t(piece.params); d-- > 0;) {
            const std::size_t size = std::size_t(piece.degree[d] + 1);
            double length = 0;
            for (std::size_t i = 0; i < count; ++i)
                if (i / step % size + 1 < size)
                    length = std::max(length, norm(points_[p.hull + i + step] - points_[p.hull + i]));
            length *= double(size - 1);
            const double middle = p.lo[d] + (p.hi[d] - p.lo[d]) / 2;
            if (length > longest && p.lo[d] < middle && middle < p.hi[d])
                longest = length, axis = d, step_of_axis = step;
            step *= size;
        }
        if (axis == kMostParams) return false;
        const std::size_t degree = std::size_t(piece.degree[axis]), run = step_of_axis * stride;
        std::vector<double> left(net_.begin() + std::ptrdiff_t(p.net),
                                 net_.begin() + std::ptrdiff_t(p.net + count * stride));
        std::vector<double> right = left;
        for (std::size_t o = 0; o < left.size(); o += (degree + 1) * run)
            for (std::size_t k = 0; k <= degree; ++k) {
                std::copy_n(left.data() + o + degree * run, run, right.data() + o + (degree - k) * run);
                for (std::size_t i = (degree + 1) * run; i-- > (k + 1) * run;)
                    left[o + i] = 0.5 * (left[o + i] + left[o + i - run]);
            }
        Place l = p, r = p;
        l.halvings = r.halvings = p.halvings + double(degree);
        l.hi[axis] = r.lo[axis] = p.lo[axis] + (p.hi[axis] - p.lo[axis]) / 2;
        add_part(l, left);
        add_part(r, right);
        return true;
    }

    const NearestTree& tree_;
    double unit_;
    std::vector<PairPart<D>> parts_;
    std::vector<Place> places_;
    std::vector<double> net_;  // of the parts, (N, W) about the centres of their pieces
    std::vector<Vec<D>> points_;
};

}  // namespace freiform::detail

// Idea. Branch and bound over pairs of parts of Bezier pieces, the pair that may be nearest first
// (query/pair_search.hpp): parts are within the hulls of their control points, halved where they are
// longest. For each pair that is opened Newton's iteration looks for the nearest points of the two parts, all
// parameters at once, those at their limits held there while the gradient points outwards. Its direction is
// what separates the hulls of the halves.
//
// Notation: x on the first, y on the second piece, r = x - y, half of |r|^2 is what is descended.
//
// Cost. Near a foot with some curvature a number of pairs that does not depend on the accuracy for each
// halving, about ten for two curves and some hundred for two surfaces; each takes the control points of one
// part.
//
// Accuracy. Control points of halves are averages: each halving along an axis of degree p adds p roundings of
// the largest number to N and to W, so that a projected point is moved by at most
//     sqrt(D) p u (max |N| + max |x| max W) / min W.
// From the pieces to the objects: slip_ (nearest_tree.cpp). Scalar products and boxes: 64 u of the
// coordinates.
//
// References. The pruning by boxes and hulls is [Johnson Cohen 1998].
//
// Why not the polynomial |x - y|^2 in all parameters, as for points: for two bicubic surfaces it has 2401
// coefficients, and halving it costs more than halving both nets ever does.
#include "query/nearest_blocks_detail.hpp"

#include <freiform/query/checks.hpp>
#include <freiform/query/distance.hpp>
#include <freiform/query/pair_search.hpp>

namespace freiform {

namespace detail {

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

}  // namespace detail

namespace {

using PairParameters = std::array<double, 2 * detail::kMostParams>;

// Half of |x - y|^2 with its derivatives in all parameters, those of x first.
struct PairJet {
    double square = 0;
    std::size_t n = 0;
    PairParameters gradient{};
    std::array<PairParameters, 2 * detail::kMostParams> bent{},
        straight{};  // Hessian; that of Gauss and Newton
};

template <int D>
PairJet pair_jet(const detail::LocalJet& x, std::size_t nx, const detail::LocalJet& y, std::size_t ny) {
    PairJet p;
    p.n = nx + ny;
    std::array<double, detail::kMostCoords> r{};
    for (std::size_t k = 0; k < std::size_t(D); ++k) {
        r[k] = x.value[k] - y.value[k];
        p.square += r[k] * r[k];
    }
    const auto first = [&](std::size_t i, std::size_t k) {
        return i < nx ? x.first[i][k] : -y.first[i - nx][k];
    };
    for (std::size_t i = 0; i < p.n; ++i) {
        for (std::size_t k = 0; k < std::size_t(D); ++k) p.gradient[i] += r[k] * first(i, k);
        for (std::size_t j = 0; j <= i; ++j) {
            double gauss = 0, bend = 0;
            for (std::size_t k = 0; k < std::size_t(D); ++k) {
                gauss += first(i, k) * first(j, k);
                if (i < nx) bend += r[k] * x.second[i][j][k];
                if (j >= nx) bend -= r[k] * y.second[i - nx][j - nx][k];
            }
            p.straight[i][j] = gauss;
            p.bent[i][j] = gauss + bend;
        }
    }
    return p;
}

// Cholesky's method on the lower half; false: not positive definite, clear of rounding.
bool solve_pair(std::array<PairParameters, 2 * detail::kMostParams> h, std::size_t n, PairParameters& x) {
    for (std::size_t d = 0; d < n; ++d)
        for (std::size_t e = 0; e <= d; ++e) {
            double v = h[d][e];
            for (std::size_t k = 0; k < e; ++k) v -= h[d][k] * h[e][k];
            if (d == e && !(v > 1e-14 * std::abs(h[d][d]))) return false;
            h[d][e] = d == e ? std::sqrt(v) : v / h[e][e];
        }
    for (std::size_t d = 0; d < n; ++d) {
        for (std::size_t k = 0; k < d; ++k) x[d] -= h[d][k] * x[k];
        x[d] /= h[d][d];
    }
    for (std::size_t d = n; d-- > 0;) {
        for (std::size_t k = d + 1; k < n; ++k) x[d] -= h[k][d] * x[k];
        x[d] /= h[d][d];
    }
    return true;
}

// Newton's step, or Gauss and Newton's, or down the gradient, with parameters held at their limits.
PairParameters step_of(const PairJet& j, const PairParameters& t, const PairParameters& lo,
                       const PairParameters& hi) {
    std::array<bool, 2 * detail::kMostParams> held{};
    PairParameters move{};
    for (std::size_t d = 0; d < j.n; ++d)
        held[d] = (t[d] <= lo[d] && j.gradient[d] >= 0) || (t[d] >= hi[d] && j.gradient[d] <= 0);
    for (const auto* hessian : {&j.bent, &j.straight}) {
        auto h = *hessian;
        for (std::size_t d = 0; d < j.n; ++d) {
            move[d] = held[d] ? 0 : -j.gradient[d];
            for (std::size_t e = 0; e <= d; ++e)
                if (held[d] || held[e]) h[d][e] = d == e ? 1 : 0;
        }
        if (solve_pair(h, j.n, move)) return move;
    }
    for (std::size_t d = 0; d < j.n; ++d)
        move[d] = held[d] || j.gradient[d] == 0 ? 0 : (j.gradient[d] > 0 ? -0.25 : 0.25) * (hi[d] - lo[d]);
    return move;
}

template <int D>
struct PairOfPieces {
    const detail::PieceSide<D>&a, &b;

    struct Found {
        double square = std::numeric_limits<double>::infinity();
        int pieces[2] = {0, 0};
        PairParameters at{};  // those of a's piece first
    } best;
    double least = std::numeric_limits<double>::infinity();  // the distance of `best`

    PairJet jet(int i, int k, const PairParameters& t, Vec<D>* difference = nullptr) const {
        const std::size_t nx = a.params(i), ny = b.params(k);
        detail::NearestTree::Parameters s{}, u{};
        std::copy_n(t.begin(), nx, s.begin());
        std::copy_n(t.begin() + std::ptrdiff_t(nx), ny, u.begin());
        const auto x = a.jet(i, s), y = b.jet(k, u);
        if (difference)
            for (int d = 0; d < D; ++d) (*difference)[d] = x.value[std::size_t(d)] - y.value[std::size_t(d)];
        return pair_jet<D>(x, nx, y, ny);
    }

    // The nearest points of two parts, as far as Newton's iteration finds them; their difference.
    Vec<D> look(int part_a, int part_b) {
        const auto &p = a.place(part_a), &q = b.place(part_b);
        Vec<D> difference{};
        if (p.piece < 0 || q.piece < 0) return difference;
        const std::size_t nx = a.params(p.piece), ny = b.params(q.piece);
        PairParameters lo{}, hi{}, t{};
        for (std::size_t d = 0; d < nx; ++d) lo[d] = p.lo[d], hi[d] = p.hi[d];
        for (std::size_t d = 0; d < ny; ++d) lo[nx + d] = q.lo[d], hi[nx + d] = q.hi[d];
        for (std::size_t d = 0; d < nx + ny; ++d) t[d] = lo[d] + (hi[d] - lo[d]) / 2;
        PairJet j = jet(p.piece, q.piece, t, &difference);
        for (int step = 0; step < 24; ++step) {  // a backstop: ordinary feet take four or five
            const PairParameters move = step_of(j, t, lo, hi);
            bool better = false;
            double factor = 1;
            for (int part = 0; part < 6 && !better; ++part, factor *= 0.25) {
                PairParameters next = t;
                for (std::size_t d = 0; d < j.n; ++d)
                    next[d] = std::clamp(t[d] + factor * move[d], lo[d], hi[d]);
                if (next == t) break;
                Vec<D> r{};
                const PairJet there = jet(p.piece, q.piece, next, &r);
                better = there.square < j.square;
                if (better) t = next, j = there, difference = r;
            }
            if (!better) break;
        }
        if (j.square < best.square) {
            best = {j.square, {p.piece, q.piece}, t};
            least = std::sqrt(j.square);
        }
        return difference;
    }
};

template <int D>
double distance_between(const Vec<D>& a, const Vec<D>& b) {
    const Vec<D> half = 0.5 * a - 0.5 * b;  // does not overflow
    const double scale = max_abs(half);
    return scale > 0 ? 2 * (scale * norm((1 / scale) * half)) : 0;
}

}  // namespace

template <int D>
Result<LeastDistance<D>> least_distance(const NearestQuery& a, const NearestQuery& b,
                                        const DistanceOptions& options) {
    if (a.coordinates() != b.coordinates())
        return refuse(RefusalKind::invalid, "objects",
                      text("the first have ", a.coordinates(), " coordinates, the second ", b.coordinates()));
    FF_REQUIRE(D == a.coordinates());
    if (auto ok = detail::check_accuracy(options.accuracy); !ok) return std::unexpected(ok.error());
    if (options.max_pairs < 1) return refuse(RefusalKind::invalid, "max_pairs", "is below 1");
    const int e = std::max(a.tree().exponent(), b.tree().exponent());
    detail::PieceSide<D> x(a.tree(), std::scalbn(1.0, a.tree().exponent() - e)),
        y(b.tree(), std::scalbn(1.0, b.tree().exponent() - e));
    const double size = x.largest() + y.largest();
    const double rounding = 64 * kUnitRoundoff * size + x.slip() + y.slip();
    const double accuracy =
        std::max(options.accuracy > 0 ? std::scalbn(options.accuracy, -e) : 0x1p-30 * size, 8 * rounding);
    PairOfPieces<D> pair{x, y, {}};
    const double lower = detail::least_of_pairs<D>(x, y, accuracy, rounding, options.max_pairs, pair.least,
                                                   [&](int i, int k) { return pair.look(i, k); });
    detail::NearestTree::Parameters s{}, t{};
    const std::size_t nx = x.params(pair.best.pieces[0]), ny = y.params(pair.best.pieces[1]);
    std::copy_n(pair.best.at.begin(), nx, s.begin());
    std::copy_n(pair.best.at.begin() + std::ptrdiff_t(nx), ny, t.begin());
    LeastDistance<D> out;
    std::array found{x.found(pair.best.pieces[0], s), y.found(pair.best.pieces[1], t)};
    for (std::size_t i = 0; i < 2; ++i) {
        out.object[i] = found[i].object;
        std::copy_n(found[i].at.begin(), 3, out.at[i].begin());
        for (int k = 0; k < D; ++k) out.point[i][k] = found[i].point[std::size_t(k)];
        out.point_error += found[i].point_error;
    }
    out.distance = distance_between(out.point[0], out.point[1]);
    out.lower_bound = std::min(std::scalbn(std::max(lower, 0.0), e), out.distance);
    return out;
}

#define FF_DISTANCE(D)                                                                            \
    template Result<LeastDistance<D>> least_distance<D>(const NearestQuery&, const NearestQuery&, \
                                                        const DistanceOptions&);
FF_DISTANCE(1)
FF_DISTANCE(2)
FF_DISTANCE(3)
FF_DISTANCE(4)
#undef FF_DISTANCE

}  // namespace freiform

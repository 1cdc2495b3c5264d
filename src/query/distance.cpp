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
#include "query/cholesky_detail.hpp"
#include "query/piece_side_detail.hpp"

#include <freiform/query/checks.hpp>
#include <freiform/query/distance.hpp>

namespace freiform {

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
        if (detail::solve_cholesky(h, j.n, move)) return move;
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

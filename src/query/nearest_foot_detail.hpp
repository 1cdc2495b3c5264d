// The foot of a point on one Bezier piece: jets of the piece about its centre, and Newton's iteration.
#pragma once
#include "query/cholesky_detail.hpp"
#include "query/nearest_detail.hpp"

#include <freiform/basis/bspline.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::detail {

constexpr int kMostTaps = kMaxDegree + 1;

// Bernstein polynomials of degree p at t with first and second derivatives.
struct Bernsteins {
    double b[3][2 * kMaxDegree + 1];

    Bernsteins() {}
    Bernsteins(int p, double t) { fill(p, t); }

    void fill(int p, double t) {
        const double s = 1 - t;
        double* v = b[0];
        v[0] = 1;
        if (p < 1) b[1][0] = 0;
        if (p < 2) b[2][0] = b[2][1] = 0;
        for (int k = 1; k <= p; ++k) {
            // Here v has degree k - 1: differences of it are derivatives of degree p.
            if (k == p - 1) {
                const double c = double(p) * (p - 1);
                b[2][0] = c * v[0], b[2][p] = c * v[k - 1];
                b[2][1] = (k > 1 ? c * v[1] : 0) - 2 * c * v[0];
                if (p > 2) b[2][p - 1] = c * v[p - 3] - 2 * c * v[p - 2];
                for (int i = 2; i < p - 1; ++i) b[2][i] = c * (v[i - 2] - 2 * v[i - 1] + v[i]);
            }
            if (k == p) {
                b[1][0] = -p * v[0], b[1][p] = p * v[p - 1];
                for (int i = 1; i < p; ++i) b[1][i] = p * (v[i - 1] - v[i]);
            }
            v[k] = t * v[k - 1];
            for (int i = k - 1; i >= 1; --i) v[i] = t * v[i - 1] + s * v[i];
            v[0] *= s;
        }
    }
};

// x = N / W (about the centre) with all derivatives up to order 2: first[d], second[d][e]. Of the parameters
// that there are.
struct LocalJet {
    NearestTree::Coords value;
    std::array<NearestTree::Coords, kMostParams> first;
    std::array<std::array<NearestTree::Coords, kMostParams>, kMostParams> second;
};

// Contracts the middle axis of an [outer][p + 1][kInner] array with the weights of kOrders derivatives.
template <int kInner, int kOrders>
void contract(const double* in, int outer, int p, const Bernsteins& weights,
              const std::array<double*, 3>& out) {
    for (int o = 0; o < outer; ++o) {
        double sum[kOrders][kInner];
        for (int e = 0; e < kOrders; ++e)
            for (int k = 0; k < kInner; ++k) sum[e][k] = weights.b[e][0] * in[k];
        in += kInner;
        for (int i = 1; i <= p; ++i, in += kInner)
            for (int e = 0; e < kOrders; ++e)
                for (int k = 0; k < kInner; ++k) sum[e][k] += weights.b[e][i] * in[k];
        for (int e = 0; e < kOrders; ++e)
            for (int k = 0; k < kInner; ++k) out[std::size_t(e)][o * kInner + k] = sum[e][k];
    }
}
template <int kInner>
void contract(int orders, const double* in, int outer, int p, const Bernsteins& weights,
              const std::array<double*, 3>& out) {
    if (orders == 1)
        contract<kInner, 1>(in, outer, p, weights, out);
    else if (orders == 2)
        contract<kInner, 2>(in, outer, p, weights, out);
    else
        contract<kInner, 3>(in, outer, p, weights, out);
}

// A piece, seen from a point q.
template <int D>
struct SeenPiece {
    const NearestTree::Piece* piece = nullptr;
    const double* coefficients = nullptr;
    NearestTree::Coords local{};  // q about the centre of the piece

    LocalJet jet(const NearestTree::Parameters& t) const {
        const NearestTree::Piece& p = *piece;
        constexpr int kStride = D + 1;
        std::array<Bernsteins, kMostParams> f;
        for (std::size_t d = 0; d < std::size_t(p.params); ++d) f[d].fill(p.degree[d], t[d]);
        // values[a][b][c]: derivative of orders a, b, c of (N, W).
        double values[3][3][3][kMostCoords + 1];
        double one[3][kMostTaps * kMostTaps * kStride], two[3][kMostTaps * kStride];
        const int p0 = p.degree[0], p1 = p.degree[1], p2 = p.degree[2];
        if (p.params > 2)
            contract<kStride>(3, coefficients, (p0 + 1) * (p1 + 1), p2, f[2], {one[0], one[1], one[2]});
        for (int c = 0; c <= (p.params > 2 ? 2 : 0); ++c) {
            const double* a = p.params > 2 ? one[c] : coefficients;
            if (p.params > 1) contract<kStride>(3 - c, a, p0 + 1, p1, f[1], {two[0], two[1], two[2]});
            for (int b = 0; b <= (p.params > 1 ? 2 - c : 0); ++b)
                contract<kStride>(3 - b - c, p.params > 1 ? two[b] : a, 1, p0, f[0],
                                  {values[0][b][c], values[1][b][c], values[2][b][c]});
        }
        LocalJet j;
        const double* v = values[0][0][0];
        const double w = v[D], over = 1 / w;
        for (int k = 0; k < D; ++k) j.value[std::size_t(k)] = v[k] / w;
        std::array<const double*, kMostParams> first{};
        for (int d = 0; d < p.params; ++d) {
            const double* g = values[d == 0][d == 1][d == 2];
            first[std::size_t(d)] = g;
            for (int k = 0; k < D; ++k)
                j.first[std::size_t(d)][std::size_t(k)] = (g[k] - g[D] * j.value[std::size_t(k)]) * over;
        }
        for (int d = 0; d < p.params; ++d)
            for (int e = 0; e <= d; ++e) {
                const double* h = values[(d == 0) + (e == 0)][(d == 1) + (e == 1)][(d == 2) + (e == 2)];
                for (std::size_t k = 0; k < std::size_t(D); ++k)
                    j.second[std::size_t(d)][std::size_t(e)][k] =
                        (h[k] - first[std::size_t(d)][D] * j.first[std::size_t(e)][k] -
                         first[std::size_t(e)][D] * j.first[std::size_t(d)][k] - h[D] * j.value[k]) *
                        over;
            }
        return j;
    }

    // The squared distance from q, without derivatives.
    double square_at(const NearestTree::Parameters& t) const {
        const NearestTree::Piece& p = *piece;
        constexpr int kStride = D + 1;
        Bernsteins f;
        double one[kMostTaps * kMostTaps * kStride], two[kMostTaps * kStride], v[kStride];
        const int p0 = p.degree[0], p1 = p.degree[1], p2 = p.degree[2];
        const double* a = coefficients;
        if (p.params > 2) {
            f.fill(p2, t[2]);
            contract<kStride, 1>(a, (p0 + 1) * (p1 + 1), p2, f, {one});
            a = one;
        }
        if (p.params > 1) {
            f.fill(p1, t[1]);
            contract<kStride, 1>(a, p0 + 1, p1, f, {two});
            a = two;
        }
        f.fill(p0, t[0]);
        contract<kStride, 1>(a, 1, p0, f, {v});
        double s = 0;
        for (std::size_t k = 0; k < std::size_t(D); ++k) {
            const double x = v[k] / v[D] - local[k];
            s += x * x;
        }
        return s;
    }

    double square(const LocalJet& j) const {
        double s = 0;
        for (std::size_t k = 0; k < std::size_t(D); ++k)
            s += (j.value[k] - local[k]) * (j.value[k] - local[k]);
        return s;
    }

    // Cholesky's method; whether the matrix (its lower half) is positive definite, clear of rounding.
    static bool solve(double (&h)[kMostParams][kMostParams], std::size_t n, NearestTree::Parameters& x) {
        if (n == 1) {
            x[0] /= h[0][0];
            return h[0][0] > 0;
        }
        return solve_cholesky(h, n, x);
    }

    // Newton's iteration for the least distance on the box [lo, hi], parameters at their limits held there
    // while the gradient points outwards; from and to t.
    double descend(const NearestTree::Parameters& lo, const NearestTree::Parameters& hi,
                   NearestTree::Parameters& t) {
        const std::size_t n = std::size_t(piece->params);
        LocalJet jets[2];
        jets[0] = jet(t);
        int now = 0;  // jets[now] is that at t
        double s = square(jets[0]);
        for (int step = 0; step < 64; ++step) {  // a backstop: ordinary feet take four or five, folds many
            const LocalJet& j = jets[now];
            NearestTree::Parameters g{}, move{};
            std::array<bool, kMostParams> held{};
            for (std::size_t d = 0; d < n; ++d) {
                for (std::size_t k = 0; k < std::size_t(D); ++k)
                    g[d] += (j.value[k] - local[k]) * j.first[d][k];
                held[d] = (t[d] <= lo[d] && g[d] >= 0) || (t[d] >= hi[d] && g[d] <= 0);
            }
            // Newton's step; where the Hessian is not positive, Gauss and Newton's, which goes down too.
            bool solved = false;
            for (int with_bend = 1; with_bend >= 0 && !solved; --with_bend) {
                double h[kMostParams][kMostParams];
                for (std::size_t d = 0; d < n; ++d)
                    for (std::size_t e = 0; e <= d; ++e) {
                        double x = 0;
                        for (std::size_t k = 0; k < std::size_t(D); ++k)
                            x += j.first[d][k] * j.first[e][k] +
                                 (with_bend ? (j.value[k] - local[k]) * j.second[d][e][k] : 0);
                        h[d][e] = held[d] || held[e] ? (d == e ? 1 : 0) : x;
                    }
                for (std::size_t d = 0; d < n; ++d) move[d] = held[d] ? 0 : -g[d];
                solved = solve(h, n, move);
            }
            if (!solved)
                for (std::size_t d = 0; d < n; ++d)
                    move[d] = held[d] || g[d] == 0 ? 0 : (g[d] > 0 ? -0.25 : 0.25) * (hi[d] - lo[d]);
            // What a step of Newton's would gain, if less than doubles can say: that step is the last.
            double gain = 0;
            for (std::size_t d = 0; d < n; ++d) gain -= g[d] * move[d];
            if (solved && gain <= 0x1p-54 * s) {
                for (std::size_t d = 0; d < n; ++d) t[d] = std::clamp(t[d] + move[d], lo[d], hi[d]);
                break;
            }
            bool better = false;
            double factor = 1;
            for (int half = 0; half < 8 && !better; ++half, factor *= 0.25) {
                NearestTree::Parameters next = t;
                bool moved = false;
                for (std::size_t d = 0; d < n; ++d) {
                    next[d] = std::clamp(t[d] + factor * move[d], lo[d], hi[d]);
                    moved = moved || next[d] != t[d];
                }
                if (!moved) break;
                jets[1 - now] = jet(next);
                const double s2 = square(jets[1 - now]);
                if (s2 < s) {
                    better = s2 < s * (1 - 1e-15) || half == 0;
                    t = next, now = 1 - now, s = s2;
                } else if (s2 <= s * (1 + 4e-16)) {
                    break;  // as good as doubles can say
                }
            }
            if (!better) break;
        }
        return s;
    }
};

}  // namespace freiform::detail

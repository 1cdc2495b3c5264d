// Idea: the minimum under equality constraints is where the gradient is a combination of theirs; with the
// multipliers as further unknowns this is one linear system.
//
// Notation: A values of the basis at the points, W weights, S the matrix of the smoothing integral, C rows of
// what is kept, c coefficients, y multipliers:
//     [ A^T W A + s S   C^T ] [ c ]   [ A^T W Q ]
//     [ C                0  ] [ y ] = [ V       ]
//
// Method: The upper left block has p diagonals on either side; a multiplier stands among the coefficients
// that its row touches, so the whole remains a band, and partial pivoting deals with the zeros on the
// diagonal. Rows of C are scaled by powers of two to entries of about 1. The integral is computed exactly (up
// to rounding) by Gauss quadrature on every span: f^(k) squared has degree 2 (p - k).
//
// Accuracy: normal equations square the condition of A; one step of iterative refinement, with the residual
// from A itself, makes up for that as long as the square is below 2^53. Bounds are built on measured
// residuals in any case.
//
// Cost: O(m p^2) to collect, O(n p^2) to factor, O((m + n) p) for each column.
//
// References: [deBoor 1978, ch. XIV], [Schoenberg & Whitney 1953], [GolubVanLoan2013, 6.1].
//
// Why not orthogonal factors: they cost twice as much, and kept rows would need a null space first, which is
// not banded.
#include "least_squares_detail.hpp"

#include <freiform/core/sort.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace freiform::detail {

namespace {

BandMap penalty_rows(const BSplineBasis& basis, const LeastSquaresSystem::Smoothing& s) {
    const int p = basis.degree();
    if (!(s.factor > 0) || s.order > p) return {basis.size(), p + 1, {}, {}};
    const Quadrature gauss = gauss_legendre(p - s.order + 1);
    const auto breaks = basis.breaks();
    std::vector<KeptRow> at;
    std::vector<double> factor;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        const double half = (breaks[i + 1] - breaks[i]) / 2;
        for (std::size_t k = 0; k < gauss.node.size(); ++k) {
            at.push_back(
                {std::clamp(breaks[i] + half * (1 + gauss.node[k]), breaks[i], breaks[i + 1]), s.order});
            factor.push_back(std::sqrt(s.factor * half * gauss.weight[k]));
        }
    }
    BandMap m = rows_at(basis, at);
    for (std::size_t r = 0; r < factor.size(); ++r)
        for (int k = 0; k <= p; ++k) m.entry[r * std::size_t(p + 1) + std::size_t(k)] *= factor[r];
    return m;
}

std::vector<double> scale_rows(BandMap& m) {
    std::vector<double> scale;
    const std::size_t width = std::size_t(m.width);
    for (std::size_t r = 0; r < std::size_t(m.rows()); ++r) {
        double most = 0;
        for (std::size_t k = 0; k < width; ++k) most = std::max(most, std::abs(m.entry[r * width + k]));
        scale.push_back(most > 0 && std::isfinite(most) ? std::scalbn(1.0, -std::ilogb(most)) : 1);
        for (std::size_t k = 0; k < width; ++k) m.entry[r * width + k] *= scale.back();
    }
    return scale;
}

// Places of coefficients and multipliers: a multiplier comes behind the middle of the columns of its row.
void arrange(int n, const BandMap& kept, std::vector<int>& place, std::vector<int>& multiplier) {
    std::vector<std::pair<int, int>> order;  // twice the place that is wanted, and which row
    for (int r = 0; r < kept.rows(); ++r)
        order.emplace_back((kept.first[std::size_t(r)] + kept.width / 2) % n, r);
    sort(order.begin(), order.end());
    multiplier.assign(std::size_t(kept.rows()), 0);
    int next = 0;
    std::size_t k = 0;
    for (int i = 0; i < n; ++i) {
        place.push_back(next++);
        for (; k < order.size() && order[k].first == i; ++k)
            multiplier[std::size_t(order[k].second)] = next++;
    }
}

// Largest distance of two unknowns that an equation couples.
int half_width(int n, bool closed, const BandMap& values, const BandMap& kept, const std::vector<int>& place,
               const std::vector<int>& multiplier) {
    const int total = n + kept.rows();
    const auto distance = [&](int a, int b) {
        const int d = std::abs(a - b);
        return closed ? std::min(d, total - d) : d;
    };
    int most = 0;
    for (int i = 0; i < n; ++i)
        for (int k = 1; k < values.width; ++k)
            if (closed || i + k < n)
                most = std::max(most, distance(place[std::size_t(i)], place[std::size_t((i + k) % n)]));
    for (int r = 0; r < kept.rows(); ++r)
        for (int k = 0; k < kept.width; ++k)
            most = std::max(most, distance(multiplier[std::size_t(r)],
                                           place[std::size_t((kept.first[std::size_t(r)] + k) % n)]));
    return std::min(most, total - 1);
}

// y += f x, of `width` numbers.
void add_scaled(double* y, double f, const double* x, std::size_t width) {
    for (std::size_t c = 0; c < width; ++c) y[c] += f * x[c];
}

// f(column, entry) for the entries of a row that are not zero.
template <class F>
void each_entry(const BandMap& m, int row, F&& f) {
    int column = m.first[std::size_t(row)] % m.cols;
    for (const double x : m.row(row)) {
        if (x != 0) f(std::size_t(column), x);
        if (++column == m.cols) column = 0;
    }
}

}  // namespace

BandMap rows_at(const BSplineBasis& basis, std::span<const KeptRow> rows) {
    const std::size_t width = std::size_t(basis.degree()) + 1;
    BandMap m{basis.size(), int(width), std::vector<int>(rows.size()),
              std::vector<double>(rows.size() * width)};
    for (std::size_t i = 0; i < rows.size(); ++i)
        m.first[i] = weights(basis, rows[i].at, rows[i].order, &m.entry[i * width]);
    return m;
}

LeastSquaresSystem::LeastSquaresSystem(const BSplineBasis& basis, BandMap values,
                                       std::span<const double> weights, std::span<const KeptRow> kept,
                                       Smoothing smoothing)
    : n_(basis.size()),
      values_(std::move(values)),
      kept_(rows_at(basis, kept)),
      penalty_(penalty_rows(basis, smoothing)),
      weight_(weights.begin(), weights.end()),
      scale_(scale_rows(kept_)),
      system_(1, 0, 0, false) {
    arrange(n_, kept_, place_, multiplier_);
    const int k = half_width(n_, basis.is_closed(), values_, kept_, place_, multiplier_);
    system_ = BandSystem(n_ + kept_.rows(), k, k, basis.is_closed());
    // Rows that begin at the same coefficient are summed in one small block before they go into the system.
    const std::size_t width = std::size_t(basis.degree()) + 1;
    std::vector<double> block(width * width);
    const auto collect = [&](const BandMap& m, const std::vector<double>& weight) {
        for (int r = 0; r < m.rows();) {
            const int first = m.first[std::size_t(r)];
            std::fill(block.begin(), block.end(), 0.0);
            for (; r < m.rows() && m.first[std::size_t(r)] == first; ++r) {
                const double w = weight.empty() ? 1 : weight[std::size_t(r)];
                const double* e = &m.entry[std::size_t(r) * width];
                for (std::size_t i = 0; i < width; ++i) {
                    const double x = w * e[i];
                    for (std::size_t j = 0; j <= i; ++j) block[i * width + j] += x * e[j];
                }
            }
            const auto place = [&](std::size_t j) {
                return place_[(std::size_t(first) + j) % std::size_t(n_)];
            };
            for (std::size_t i = 0; i < width; ++i)
                for (std::size_t j = 0; j < width; ++j)
                    system_.add(place(i), place(j), block[std::max(i, j) * width + std::min(i, j)]);
        }
    };
    collect(values_, weight_);
    collect(penalty_, {});
    for (int r = 0; r < kept_.rows(); ++r)
        each_entry(kept_, r, [&](std::size_t j, double x) {
            system_.add(multiplier_[std::size_t(r)], place_[j], x);
            system_.add(place_[j], multiplier_[std::size_t(r)], x);
        });
}

void LeastSquaresSystem::solve_once(const double* gradient, const double* defect, double* coefficients,
                                    double* multipliers, std::size_t width) const {
    std::vector<double> x(std::size_t(system_.size()) * width);
    const auto row = [&](int place) { return x.data() + std::size_t(place) * width; };
    for (int i = 0; i < n_; ++i)
        add_scaled(row(place_[std::size_t(i)]), 1, gradient + std::size_t(i) * width, width);
    for (int r = 0; r < kept_.rows(); ++r)
        add_scaled(row(multiplier_[std::size_t(r)]), 1, defect + std::size_t(r) * width, width);
    system_.solve(x.data(), width);
    for (int i = 0; i < n_; ++i)
        add_scaled(coefficients + std::size_t(i) * width, 1, row(place_[std::size_t(i)]), width);
    for (int r = 0; r < kept_.rows(); ++r)
        add_scaled(multipliers + std::size_t(r) * width, 1, row(multiplier_[std::size_t(r)]), width);
}

void LeastSquaresSystem::solve(const double* points, const double* kept, double* coefficients,
                               std::size_t width, bool refine) const {
    const std::size_t n = std::size_t(n_), k = std::size_t(kept_.rows());
    std::vector<double> gradient(n * width), defect(k * width), multipliers(k * width), value(width);
    std::fill(coefficients, coefficients + n * width, 0.0);
    for (int step = 0; step < 1 + refine; ++step) {
        std::fill(gradient.begin(), gradient.end(), 0.0);
        for (const bool penalty : {false, true}) {
            if (penalty && step == 0) continue;  // the solution is still zero
            const BandMap& m = penalty ? penalty_ : values_;
            for (int r = 0; r < m.rows(); ++r) {
                const double w = penalty || weight_.empty() ? 1 : weight_[std::size_t(r)];
                for (std::size_t c = 0; c < width; ++c)
                    value[c] = penalty ? 0 : points[std::size_t(r) * width + c];
                if (step > 0)
                    each_entry(m, r, [&](std::size_t j, double x) {
                        add_scaled(value.data(), -x, coefficients + j * width, width);
                    });
                each_entry(m, r, [&](std::size_t j, double x) {
                    add_scaled(&gradient[j * width], w * x, value.data(), width);
                });
            }
        }
        for (std::size_t r = 0; r < k; ++r) {
            for (std::size_t c = 0; c < width; ++c) defect[r * width + c] = scale_[r] * kept[r * width + c];
            each_entry(kept_, int(r), [&](std::size_t j, double x) {
                add_scaled(&defect[r * width], -x, coefficients + j * width, width);
                add_scaled(&gradient[j * width], -x, &multipliers[r * width], width);
            });
        }
        solve_once(gradient.data(), defect.data(), coefficients, multipliers.data(), width);
    }
}

Result<void> check_determined(const BSplineBasis& basis, std::span<const double> sites,
                              std::span<const KeptRow> kept) {
    const int p = basis.degree(), n = basis.size();
    std::vector<double> more, all;
    for (const KeptRow& k : kept) more.push_back(basis.wrap(k.at));
    sort(more.begin(), more.end());
    all.reserve(sites.size() + more.size());
    std::merge(sites.begin(), sites.end(), more.begin(), more.end(), std::back_inserter(all));
    std::vector<int> copies;  // how often a site may be used: once, and once more for every derivative kept
    std::vector<double> site;
    for (const double x : all) {
        if (site.empty() || x != site.back()) site.push_back(x), copies.push_back(1);
    }
    for (const KeptRow& k : kept)
        if (k.order > 0)
            ++copies[std::size_t(std::lower_bound(site.begin(), site.end(), basis.wrap(k.at)) -
                                 site.begin())];
    const Interval on = basis.domain();
    const auto sees = [&](int i, std::size_t k) {
        const double x = site[k], lo = basis.knot(i), hi = basis.knot(i + p + 1);
        return (lo < x || (lo == x && x == on.lo)) &&
               (x < hi || (x == hi && x == on.hi && i >= n - copies[k]));
    };
    // Greedy: function after function takes the first site in its support that is left. Of a closed basis
    // sites and supports repeat one period later, and each of the first sites that function 0 sees may be
    // where the sequence begins.
    const std::size_t m = site.size();
    const double period = on.length();
    const auto inside = [&](int i, std::size_t k) {
        if (!basis.is_closed()) return k < m && sees(i, k);
        const double x = site[k % m] + double(k / m) * period, lo = basis.knot(i), hi = basis.knot(i + p + 1);
        return (lo < x && x < hi) || (lo + period < x && x < hi + period);
    };
    std::size_t begin = 0;
    while (begin < m && !inside(0, begin)) ++begin;
    int failed = 0;
    for (std::size_t start = begin; start <= begin + (basis.is_closed() ? std::size_t(p) + 1 : 0); ++start) {
        std::size_t k = start;
        int used = 0, i = 0;
        for (; i < n; ++i) {
            while (k < start + m && !(inside(i, k) && used < copies[k % m])) ++k, used = 0;
            if (k >= start + m) break;
            ++used;
        }
        if (i == n) return {};
        failed = std::max(failed, i);
    }
    return refuse(RefusalKind::ill_conditioned, text("knots[", failed, "]"),
                  text("too few points up to ", basis.knot(failed + p + 1), " to determine function ", failed,
                       " of ", n));
}

Quadrature gauss_legendre(int n) {
    Quadrature q;
    for (int i = 0; i < n; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), derivative = 1;
        for (int step = 0; step < 20; ++step) {  // Newton; quadratic from a good start
            double p = 1, before = 0;
            for (int k = 0; k < n; ++k) {
                const double next = ((2 * k + 1) * x * p - k * before) / (k + 1);
                before = p;
                p = next;
            }
            derivative = n * (x * p - before) / (x * x - 1);
            const double dx = p / derivative;
            x -= dx;
            if (std::abs(dx) < 1e-15) break;
        }
        q.node.push_back(n % 2 == 1 && i == n / 2 ? 0.0 : x);
        q.weight.push_back(2 / ((1 - x * x) * derivative * derivative));
    }
    return q;
}

}  // namespace freiform::detail

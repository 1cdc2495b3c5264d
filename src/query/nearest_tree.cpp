// What the search for nearest points prepares: pieces about centres of their own, their squared forms, and a
// tree of boxes.
//
// Coordinates are divided by a power of two so that the largest is near 1, weights of a piece by another.
// Notation: x = c + N / W on a piece. |x - q|^2 W^2 = |N|^2 - 2 q' N W + |q'|^2 W^2 with q' = q - c, so it is
// enough to hold |N|^2, -2 N_k W and W^2 in Bernstein form: a product of Bernstein forms a and b of degree p
// has the coefficients sum_{i + j = k} C(p, i) C(p, j) / C(2 p, k) a_i b_j, a convex combination of products.
#include "query/nearest_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/chain.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::detail {

namespace {

using Tree = NearestTree;

// weights[d]: of a_i b_j in the coefficient i + j, along axis d.
std::vector<double> product_weights(int p) {
    std::vector<double> w(std::size_t((p + 1) * (p + 1)));
    for (int i = 0; i <= p; ++i)
        for (int j = 0; j <= p; ++j)
            w[std::size_t(i * (p + 1) + j)] = binomial(p, i) * (binomial(p, j) / binomial(2 * p, i + j));
    return w;
}

// The forms of one piece. `n`: coefficients x (coords + 1) numbers (N, W).
void fill_forms(const Tree::Piece& piece, int coords, const double* n, double* forms,
                const std::array<std::vector<double>, kMostParams>& weights) {
    const int stride = coords + 1;
    std::array<int, kMostParams> p{};
    for (int d = 0; d < piece.params; ++d) p[std::size_t(d)] = piece.degree[std::size_t(d)];
    const auto index = [&](int a, int b, int c, const std::array<int, kMostParams>& q) {
        return std::size_t((a * (q[1] + 1) + b) * (q[2] + 1) + c);
    };
    const std::array<int, kMostParams> twice{2 * p[0], 2 * p[1], 2 * p[2]};
    const auto weight = [&](int d, int i, int j) {
        return d < piece.params ? weights[std::size_t(d)][std::size_t(i * (p[std::size_t(d)] + 1) + j)] : 1.0;
    };
    std::fill_n(forms, std::size_t(piece.products) * std::size_t(coords + 2), 0.0);
    for (int a = 0; a <= p[0]; ++a)
        for (int b = 0; b <= p[1]; ++b)
            for (int c = 0; c <= p[2]; ++c) {
                const double* x = n + index(a, b, c, p) * std::size_t(stride);
                for (int e = 0; e <= p[0]; ++e)
                    for (int f = 0; f <= p[1]; ++f)
                        for (int g = 0; g <= p[2]; ++g) {
                            const double* y = n + index(e, f, g, p) * std::size_t(stride);
                            const double w = weight(0, a, e) * weight(1, b, f) * weight(2, c, g);
                            double* out = forms + index(a + e, b + f, c + g, twice);
                            double dot = 0;
                            for (int k = 0; k < coords; ++k) dot += x[k] * y[k];
                            *out += w * dot;
                            for (int k = 0; k < coords; ++k)
                                *(out += piece.products) += -2 * w * (x[k] * y[coords]);
                            out[piece.products] += w * (x[coords] * y[coords]);
                        }
            }
}

}  // namespace

Result<NearestTree> NearestTree::make(std::vector<const NearestSource*> sources, std::size_t max_bytes) {
    NearestTree t;
    t.coords_ = sources[0]->coords;
    const std::size_t D = std::size_t(t.coords_), stride = D + 1;
    double bytes = 0, largest = 0;
    int roundings = 0;
    for (const NearestSource* s : sources) {
        double products = double(D + 2), own = double(stride);
        for (int d = 0; d < s->params; ++d) {
            products *= 2 * s->degree[std::size_t(d)] + 1;
            own *= s->degree[std::size_t(d)] + 1;
        }
        bytes += double(s->boxes.size()) * (8 * (products + own) + sizeof(Piece) + 2 * sizeof(Node));
        roundings = std::max(roundings, s->roundings);
        for (std::size_t i = 0; i < s->coefficients.size(); i += stride)
            for (std::size_t k = 0; k < D; ++k)
                largest = std::max(largest, std::abs(s->coefficients[i + k] / s->coefficients[i + D]));
    }
    if (bytes > double(max_bytes))
        return refuse(RefusalKind::limit, "max_bytes",
                      text(std::ceil(bytes), " bytes are needed, ", max_bytes, " allowed"));
    if (!std::isfinite(largest))
        return refuse(RefusalKind::ill_conditioned, "objects", "a point divided by its weight is not finite");
    t.exponent_ = exponent_of(largest);
    t.moderate_ = std::abs(t.exponent_) < 1000;
    if (t.moderate_) t.down_ = std::scalbn(1.0, -t.exponent_), t.up_ = std::scalbn(1.0, t.exponent_);
    t.largest_ = std::scalbn(largest, -t.exponent_) * (1 + 4 * kUnitRoundoff);
    // Numerator and weight after k roundings: chain.hpp; and one more in N = w x - w c.
    t.slip_ = std::sqrt(double(D)) * 1.03 * (2 * roundings + 7) * kUnitRoundoff * t.largest_;
    std::vector<Node> boxes;
    for (std::size_t o = 0; o < sources.size(); ++o) {
        const NearestSource& s = *sources[o];
        std::array<std::vector<double>, kMostParams> weights;
        for (int d = 0; d < s.params; ++d)
            weights[std::size_t(d)] = product_weights(s.degree[std::size_t(d)]);
        const std::size_t count = s.per_piece();
        for (std::size_t i = 0; i < s.boxes.size(); ++i) {
            Piece piece;
            piece.params = s.params;
            piece.rational = s.rational;
            piece.triangle = s.triangle;
            piece.object = std::uint32_t(o);
            piece.degree = s.degree;
            piece.domain = s.boxes[i];
            piece.products = 1;
            for (int d = 0; d < s.params; ++d) piece.products *= 2 * s.degree[std::size_t(d)] + 1;
            const double* from = s.coefficients.data() + i * count * stride;
            double heaviest = 0;
            for (std::size_t c = 0; c < count; ++c) heaviest = std::max(heaviest, from[c * stride + D]);
            const int heavy = s.rational ? exponent_of(heaviest) : 0;
            Node box;
            box.lo.fill(std::numeric_limits<double>::infinity());
            box.hi.fill(-std::numeric_limits<double>::infinity());
            piece.coefficients = t.numbers_.size();
            for (std::size_t c = 0; c < count; ++c) {
                for (std::size_t k = 0; k < D; ++k) {
                    t.numbers_.push_back(std::scalbn(from[c * stride + k], -t.exponent_ - heavy));
                    const double x = std::scalbn(from[c * stride + k] / from[c * stride + D], -t.exponent_);
                    box.lo[k] = std::min(box.lo[k], x - 2 * kUnitRoundoff * std::abs(x));
                    box.hi[k] = std::max(box.hi[k], x + 2 * kUnitRoundoff * std::abs(x));
                }
                t.numbers_.push_back(std::scalbn(from[c * stride + D], -heavy));
            }
            for (std::size_t k = 0; k < D; ++k) piece.centre[k] = box.lo[k] + (box.hi[k] - box.lo[k]) / 2;
            double* n = t.numbers_.data() + piece.coefficients;
            piece.lightest = std::numeric_limits<double>::infinity();
            piece.heaviest = 0;
            for (std::size_t c = 0; c < count; ++c, n += stride) {
                double square = 0;
                for (std::size_t k = 0; k < D; ++k) {
                    n[k] -= n[D] * piece.centre[k];
                    square += n[k] * n[k];
                }
                piece.radius = std::max(piece.radius, std::sqrt(square) * (1 + 8 * kUnitRoundoff));
                piece.lightest = std::min(piece.lightest, n[D]);
                piece.heaviest = std::max(piece.heaviest, n[D]);
            }
            piece.forms = t.numbers_.size();
            t.numbers_.resize(piece.forms + std::size_t(piece.products) * (D + 2));
            fill_forms(piece, t.coords_, t.numbers_.data() + piece.coefficients,
                       t.numbers_.data() + piece.forms, weights);
            t.pieces_.push_back(piece);
            boxes.push_back(box);
        }
    }
    t.build(0, int(t.pieces_.size()), boxes);
    return t;
}

// Halves of equal count along the longest side of the boxes' centres.
void NearestTree::build(int begin, int end, std::vector<Node>& boxes) {
    struct Job {
        int begin, end, parent;  // parent: whose right child this is; -1: a left child, or the root
    };
    std::vector<int> order(boxes.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = int(i);
    std::vector<Job> jobs{{begin, end, -1}};
    while (!jobs.empty()) {
        const Job job = jobs.back();
        jobs.pop_back();
        const int at = int(nodes_.size());
        if (job.parent >= 0) nodes_[std::size_t(job.parent)].right = at;
        Node node;
        node.lo.fill(std::numeric_limits<double>::infinity());
        node.hi.fill(-std::numeric_limits<double>::infinity());
        Coords least = node.lo, most = node.hi;
        for (int i = job.begin; i < job.end; ++i) {
            const Node& b = boxes[std::size_t(order[std::size_t(i)])];
            for (std::size_t k = 0; k < std::size_t(coords_); ++k) {
                node.lo[k] = std::min(node.lo[k], b.lo[k]);
                node.hi[k] = std::max(node.hi[k], b.hi[k]);
                least[k] = std::min(least[k], b.lo[k] + b.hi[k]);
                most[k] = std::max(most[k], b.lo[k] + b.hi[k]);
            }
        }
        if (job.end - job.begin == 1) {
            node.first = job.begin;
            node.count = 1;
            nodes_.push_back(node);
            continue;
        }
        std::size_t axis = 0;
        for (std::size_t k = 1; k < std::size_t(coords_); ++k)
            if (most[k] - least[k] > most[axis] - least[axis]) axis = k;
        const int middle = job.begin + (job.end - job.begin) / 2;
        std::nth_element(order.begin() + job.begin, order.begin() + middle, order.begin() + job.end,
                         [&](int a, int b) {
                             const Node &l = boxes[std::size_t(a)], &r = boxes[std::size_t(b)];
                             const double x = l.lo[axis] + l.hi[axis], y = r.lo[axis] + r.hi[axis];
                             return x != y ? x < y : a < b;
                         });
        nodes_.push_back(node);
        jobs.push_back({middle, job.end, at});
        jobs.push_back({job.begin, middle, -1});  // next: the left child follows its parent
    }
    std::vector<Piece> sorted;
    sorted.reserve(pieces_.size());
    for (const int i : order) sorted.push_back(pieces_[std::size_t(i)]);
    pieces_ = std::move(sorted);
}

}  // namespace freiform::detail

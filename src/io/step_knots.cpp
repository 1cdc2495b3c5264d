// Knots that a file has with few digits may be one that were two. Functions between them have nothing to be
// on, whatever their control points are. Inside of a spline two functions are left that end and begin there,
// and their control points are where the pieces of the spline end and begin: as near to each other as what
// was between them was long. One of them, P with the weight w, is taken for both. Instead of a point Q that
// is a part N w / W <= 1 of the spline it moves that by |P - Q| at most; instead of a weight v, by |w - v| N
// / W' |P - C| with W' >= w N, that is |w - v| / w times the size of the net, which the spline C does not
// leave.
#include "step_knots.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ranges>

namespace freiform::step {

namespace {

// The knots that subtypes imply. Empty: none is of this type.
std::vector<double> implied_knots(const File& f, std::uint32_t i, std::string_view kind, int degree,
                                  int size) {
    const bool curve = kind == "CURVE";
    const auto has = [&](Type c, Type s) { return f.is(i, curve ? c : s); };
    std::vector<double> t;
    if (has(Type::BEZIER_CURVE, Type::BEZIER_SURFACE)) {
        if ((size - 1) % degree != 0) return t;
        const int pieces = (size - 1) / degree;
        t.push_back(0);
        for (int k = 0; k <= pieces; ++k) t.insert(t.end(), std::size_t(degree), k);
        t.push_back(pieces);
    } else if (has(Type::QUASI_UNIFORM_CURVE, Type::QUASI_UNIFORM_SURFACE)) {
        t.assign(std::size_t(degree), 0);
        for (int k = 0; k <= size - degree; ++k) t.push_back(k);
        t.insert(t.end(), std::size_t(degree), size - degree);
    } else if (has(Type::UNIFORM_CURVE, Type::UNIFORM_SURFACE)) {
        for (int k = 0; k <= size + degree; ++k) t.push_back(k - degree);
    }
    return t;
}

// Of each run of knots that is longer than a spline can have: what is left of it.
void join_knots(std::vector<double>& t, int degree, std::vector<int>& kept,
                std::vector<std::pair<int, int>>& joined) {
    const auto most = std::size_t(degree) + 1;
    const auto is_longer = [&](std::size_t k) { return k + most < t.size() && t[k] == t[k + most]; };
    if (std::ranges::none_of(std::views::iota(std::size_t(0), t.size()), is_longer)) return;
    kept.resize(t.size() - most);
    std::iota(kept.begin(), kept.end(), 0);
    for (std::size_t first = 0; first < t.size(); ++first) {
        std::size_t end = first;
        while (end < t.size() && t[end] == t[first]) ++end;
        std::size_t surplus = end - first > most ? end - first - most : 0;
        if (surplus == 0) {
            first = end - 1;
            continue;
        }
        kept.erase(kept.begin() + std::ptrdiff_t(first), kept.begin() + std::ptrdiff_t(first + surplus));
        if (first > 0 && end < t.size()) {
            joined.emplace_back(kept[first - 1], kept[first]);
            kept.erase(kept.begin() + std::ptrdiff_t(first));
            ++surplus;
        }
        t.erase(t.begin() + std::ptrdiff_t(first), t.begin() + std::ptrdiff_t(first + surplus));
        first = end - surplus - 1;
    }
}

}  // namespace

Result<Knots> knots_of(const File& f, std::uint32_t i, const Fields* with_knots, int multiplicities,
                       int knots, std::string_view what, int degree, int size) {
    if (degree < 1 || degree > kMaxDegree)
        return refuse(degree > kMaxDegree ? RefusalKind::unsupported : RefusalKind::invalid, f.label(i),
                      text("has the degree ", degree, "; 1 to ", kMaxDegree, " are read"));
    std::vector<double> t;
    if (with_knots != nullptr) {
        const auto m = with_knots->integers(multiplicities, "multiplicities");
        if (!m) return std::unexpected(m.error());
        const auto k = with_knots->numbers(knots, "knots");
        if (!k) return std::unexpected(k.error());
        if (m->size() != k->size())
            return with_knots->refused(text("has ", m->size(), " multiplicities for ", k->size(), " knots"),
                                       RefusalKind::invalid);
        for (std::size_t j = 0; j < k->size(); ++j) {
            if ((*m)[j] < 1 || (*m)[j] > degree + 1)
                return with_knots->refused(
                    text("has a knot of multiplicity ", (*m)[j], " with degree ", degree),
                    RefusalKind::invalid);
            t.insert(t.end(), std::size_t((*m)[j]), (*k)[j]);
        }
    } else {
        t = implied_knots(f, i, what, degree, size);
        if (t.empty())
            return refuse(RefusalKind::invalid, f.label(i),
                          "is a spline that neither has knots nor implies them");
    }
    const long long asked = (long long)(t.size()) - degree - 1;
    if (asked != size)
        return refuse(RefusalKind::invalid, f.label(i),
                      text("has ", size, " control points; its knots ask for ", asked));
    std::vector<int> kept;
    std::vector<std::pair<int, int>> joined;
    join_knots(t, degree, kept, joined);
    auto basis = BSplineBasis::make(degree, std::move(t));
    if (!basis)
        return refuse(basis.error().kind, f.label(i), text(basis.error().where, ": ", basis.error().message));
    return Knots{*std::move(basis), std::move(kept), std::move(joined)};
}

double moved_by_joining(const std::vector<Vec<3>>& net, const std::vector<double>& weights,
                        std::array<std::size_t, 2> extent, int axis, const Knots& knots) {
    if (knots.joined.empty()) return 0;
    Box<3> box;
    for (const Vec<3>& p : net) box.add(p);
    double apart = 0, uneven = 0;
    for (const auto& [a, b] : knots.joined) {
        double most = 0;
        for (std::size_t k = 0; k < extent[std::size_t(1 - axis)]; ++k) {
            const auto at = [&](int row) {
                return axis == 0 ? std::size_t(row) * extent[1] + k : k * extent[1] + std::size_t(row);
            };
            apart = std::max(apart, norm(net[at(a)] - net[at(b)]));
            if (!weights.empty())
                most = std::max(most, std::abs(weights[at(a)] - weights[at(b)]) / weights[at(a)]);
        }
        uneven += most;
    }
    return (apart + uneven * box.diagonal()) * (1 + 64 * kUnitRoundoff);
}

}  // namespace freiform::step

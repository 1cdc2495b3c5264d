// Grids over the parameters of an offset, and polynomials in their cells.
#pragma once
#include <freiform/core/vec.hpp>
#include <freiform/spline/jet.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace freiform::detail {

inline constexpr double kMostParts = 16;  // of an interval at once

// Between the places of Chebyshev and Lobatto: values there to Bernstein coefficients.
inline constexpr int kDegree = 5;
inline constexpr std::size_t kNodes = kDegree + 1;
struct Interpolation {
    std::array<double, kNodes> node{};
    std::array<std::array<double, kNodes>, kNodes> inverse{};  // coefficients from values
    std::array<double, kNodes> half{};                         // Bernstein functions in the middle

    Interpolation() {
        std::array<std::array<double, 2 * kNodes>, kNodes> m{};
        for (std::size_t a = 0; a < kNodes; ++a) {
            const double x = (1 - std::cos(std::numbers::pi * double(a) / kDegree)) / 2;
            node[a] = a == kDegree ? 1 : x;
            for (std::size_t i = 0; i < kNodes; ++i)
                m[a][i] = binomial(kDegree, int(i)) * std::pow(node[a], double(i)) *
                          std::pow(1 - node[a], double(kDegree - i));
            m[a][kNodes + a] = 1;
            half[a] = std::ldexp(binomial(kDegree, int(a)), -kDegree);
        }
        for (std::size_t k = 0; k < kNodes; ++k) {  // rows are where their functions are largest
            for (std::size_t j = 2 * kNodes; j-- > k;) m[k][j] /= m[k][k];
            for (std::size_t r = 0; r < kNodes; ++r)
                for (std::size_t j = 2 * kNodes; r != k && j-- > k;) m[r][j] -= m[r][k] * m[k][j];
        }
        for (std::size_t k = 0; k < kNodes; ++k)
            for (std::size_t j = 0; j < kNodes; ++j) inverse[k][j] = m[k][kNodes + j];
    }
};
inline const Interpolation& interpolation() {
    static const Interpolation made;
    return made;
}

struct GridLine {
    double at = 0;
    bool bends = false;  // tangents of the offset jump
};
using Lines = std::array<std::vector<GridLine>, 2>;
inline std::size_t cells_of(const Lines& lines) { return (lines[0].size() - 1) * (lines[1].size() - 1); }

// Each interval in as many parts; whether there are any more.
inline bool cut(Lines& lines, const std::array<std::vector<int>, 2>& parts) {
    bool any = false;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        std::vector<GridLine> out;
        for (std::size_t i = 0; i < parts[axis].size(); ++i) {
            const GridLine &a = lines[axis][i], &b = lines[axis][i + 1];
            out.push_back(a);
            for (int k = 1; k < parts[axis][i]; ++k) {
                const double at = a.at + (b.at - a.at) * k / parts[axis][i];
                if (out.back().at < at && at < b.at) out.push_back({at, false}), any = true;
            }
        }
        out.push_back(lines[axis].back());
        lines[axis] = std::move(out);
    }
    return any;
}

// What is known of a cell of a grid.
struct Errors {
    std::array<double, 2> off{};  // in the middle of a side along each axis
    double bound = 0;
};
// Errors fall with this power of the length of an interval: parts that bring them below `most`.
inline bool cut_by_sides(Lines& lines, const std::vector<Errors>& of, double most, int power) {
    const std::size_t rows = lines[0].size() - 1, columns = lines[1].size() - 1;
    std::array<std::vector<int>, 2> parts{std::vector<int>(rows, 1), std::vector<int>(columns, 1)};
    for (std::size_t k = 0; k < of.size(); ++k)
        for (std::size_t axis = 0; axis < 2; ++axis)
            if (const double off = of[k].off[axis]; off > most) {
                int& n = parts[axis][axis == 0 ? k / columns : k % columns];
                n = std::max(n, int(std::min(kMostParts, std::ceil(std::pow(off / most, 1.0 / power)))));
            }
    return cut(lines, parts);
}
inline bool cut_failed(Lines& lines, const std::vector<Errors>& of, double most) {
    const std::size_t rows = lines[0].size() - 1, columns = lines[1].size() - 1;
    std::array<std::vector<int>, 2> parts{std::vector<int>(rows, 1), std::vector<int>(columns, 1)};
    for (std::size_t k = 0; k < of.size(); ++k) {
        if (of[k].bound <= most) continue;
        const double larger = std::max(of[k].off[0], of[k].off[1]);
        for (std::size_t axis = 0; axis < 2; ++axis)
            if (4 * of[k].off[axis] >= larger) parts[axis][axis == 0 ? k / columns : k % columns] = 2;
    }
    return cut(lines, parts);
}
inline double largest_bound(const std::vector<Errors>& of) {
    double most = 0;
    for (const Errors& e : of) most = e.bound <= most ? most : e.bound;
    return most;
}

struct OffsetJet {
    Vec<3> value, u, v, uv;
};
// From the derivatives of the base to order 3. With m = S_u x S_v = l n: m_a = l_a n + l n_a.
inline std::optional<OffsetJet> offset_jet(const Jet<2, 3, Vec<3>>& s, double d) {
    const Vec<3> su = s(1, 0), sv = s(0, 1), m = cross(su, sv);
    const double l = norm(m);
    if (!(l > 0)) return std::nullopt;
    const Vec<3> n = (1 / l) * m, m_u = cross(s(2, 0), sv) + cross(su, s(1, 1)),
                 m_v = cross(s(1, 1), sv) + cross(su, s(0, 2)),
                 m_uv = cross(s(2, 1), sv) + cross(s(2, 0), s(0, 2)) + cross(su, s(1, 2));
    const double l_u = dot(n, m_u), l_v = dot(n, m_v);
    const Vec<3> n_u = (1 / l) * (m_u - l_u * n), n_v = (1 / l) * (m_v - l_v * n);
    const double l_uv = dot(n_v, m_u) + dot(n, m_uv);
    const Vec<3> n_uv = (1 / l) * (m_uv - l_uv * n - l_u * n_v - l_v * n_u);
    return OffsetJet{s.value() + d * n, su + d * n_u, sv + d * n_v, s(1, 1) + d * n_uv};
}

}  // namespace freiform::detail

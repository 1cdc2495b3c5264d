// Interpolation errors from what is known of a part of the plane: essay in bending.cpp.
#include "bending_detail.hpp"
#include "turning_error_detail.hpp"

namespace freiform {

namespace {

// The largest of (1 - x^2) p + x r for x from 0 to 1.
double largest_sum(double p, double r) { return r < 2 * p ? p + r * (r / (4 * p)) : r; }

}  // namespace

// What second derivatives seen in a cell are beside those in the middle of the box: `here`, and more away
// from the middle of the cell, by_u and by_v at its sides.
struct Bending::Rest {
    Vec<2> half{};
    Curvature here, by_u, by_v;

    // Bound of the interpolation error where that of the part with constant second derivatives is e0 / 2 at
    // most, and (u (1 - r_u^2) + v (1 - r_v^2)) / 2.
    double error(double e0, double u, double v) const {
        const double hu = half[0], hv = half[1], more_u = here.uu * hu * hu + here.uv * hu * hv,
                     more_v = here.vv * hv * hv + here.uv * hu * hv, at_u = by_u.along(hu, hv),
                     at_v = by_v.along(hu, hv);
        double best = kInfinity;
        for (const double part : {0.0, 0.5, 0.75, 1.0})
            best = std::min(best, part * e0 + largest_sum((1 - part) * u + more_u, at_u) +
                                      largest_sum((1 - part) * v + more_v, at_v));
        return best / 2 * (1 + 1e-13);
    }
};

namespace {

// Half the sides of the cell, and how far its middle is from that of the box.
std::array<Vec<2>, 2> place_of(const Box<2>& cell, const Vec<2>& middle) {
    const std::array<Interval, 2> on{cell.side(0), cell.side(1)};
    Vec<2> off{};
    for (int d = 0; d < 2; ++d) {
        const Interval& x = on[std::size_t(d)];
        off[d] = std::abs(x.middle() - middle[d]) +
                 4 * kUnitRoundoff * std::max({std::abs(x.lo), std::abs(x.hi), std::abs(middle[d])});
    }
    return {half_sides(on), off};
}

}  // namespace

// What normals turn by over that, at most.
double Bending::turned(double du, double dv) const {
    const double u = (across.uu * du + across.uv * dv) / a, v = (across.uv * du + across.vv * dv) / b;
    return kChord / least * std::sqrt(u * u + v * v);
}

Bending::Rest Bending::rest_in(const Box<2>& cell, double turn) const {
    const auto [h, off] = place_of(cell, middle.at);
    // alpha + what is seen of second derivatives so far away, and of those beside n by normals that turn.
    const auto of = [&](double du, double dv, double turns) {
        return change_by({{du, dv}}, middle.third, {}).plus(turns, beside);
    };
    const double still = turned(off[0], off[1]) + kChord / least * kBendingRounding + turn;
    const Curvature here = of(off[0] + h[0] / 3, off[1] + h[1] / 3, still);
    return {h, here.plus(1, {middle.off[0], middle.off[1], middle.off[2]}),
            of(h[0] * (2.0 / 3), 0, turned(h[0], 0)), of(0, h[1] * (2.0 / 3), turned(0, h[1]))};
}

// Of the quadratic function, of which the error along n is `most`, and of `times` the bounds of the rest.
double Bending::fit_error(const std::array<Vec<2>, 3>& corner, double turn, double most, double times,
                          double enough) const {
    TurningError error;
    const auto& [uu, uv, vv] = middle.whole_second;
    const auto& sizes = middle.whole_size;
    double slip = 0, most_beside = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec<2> d = corner[(k + 2) % 3] - corner[(k + 1) % 3];
        const Vec<3> x = d[0] * d[0] * uu + 2 * d[0] * d[1] * uv + d[1] * d[1] * vv;
        const double by_n = dot(n, x),
                     rounding = 16 * kUnitRoundoff *
                                (d[0] * d[0] * sizes[0] + 2 * std::abs(d[0] * d[1]) * sizes[1] +
                                 d[1] * d[1] * sizes[2]);
        error.along[k] = by_n, error.beside[k] = norm(x - by_n * n) + rounding;
        slip = std::max(slip, rounding), most_beside = std::max(most_beside, error.beside[k]);
    }
    error.more = times * fit.whole;
    const double rest = times * fit.along + slip,
                 rough = (most + (tilt + turn) * (most_beside / 6 + error.more) + rest) * (1 + 1e-13);
    if (rough <= enough || (enough > 0 && most >= enough)) return rough;
    const double still = kChord / least * kBendingRounding + turn, chord = kChord / least * (1 + 1e-14),
                 by_a = chord / a, by_b = chord / b;
    const auto turned_at = [&](const Vec<2>& p) {  // as `turned` says
        double off[2];
        for (const int d : {0, 1})
            off[d] = std::abs(p[d] - middle.at[d]) +
                     4 * kUnitRoundoff * std::max(std::abs(p[d]), std::abs(middle.at[d]));
        const double u = (across.uu * off[0] + across.uv * off[1]) * by_a,
                     v = (across.uv * off[0] + across.vv * off[1]) * by_b;
        return std::sqrt(u * u + v * v) + still;
    };
    for (std::size_t k = 0; k < 3; ++k) {
        error.at_corner[k] = turned_at(corner[k]);
        error.at_middle[k] = turned_at(0.5 * (corner[(k + 1) % 3] + corner[(k + 2) % 3]));
    }
    error.find();
    return std::min(rough, (std::min(error.together, most + error.turned) + rest) * (1 + 1e-13));
}

// Of the part with constant second derivatives Rest::error says what `most`, u and v are. The rest adds
// `times` its bound: at the corners of triangles too, if it is not zero there.
double Bending::of_part(const Box<2>& cell, const std::array<Vec<2>, 3>& corner, double turn, double most,
                        double u, double v, double times, double enough) const {
    double best = kInfinity;
    if (fit.exists()) {
        const double more = times * (fit.along + (tilt + turn) * fit.whole);
        best = fit_error(corner, turn, most / 2, times, enough);
        if (best <= enough) return best;
        const auto& off = middle.off;
        const Vec<2> half = half_sides({cell.side(0), cell.side(1)});
        // What follows has about that more, and normals turn for it as much or more.
        if (more <= Curvature{off[0], off[1], off[2]}.along(half[0], half[1]) / 2) return best;
    }
    return std::min(best, rest_in(cell, turn).error(most, u, v));
}

double Bending::whole_error(const Box<2>& cell, const std::array<Vec<2>, 3>& corner) const {
    const auto [h, off] = place_of(cell, middle.at);
    const auto& length = middle.whole_size;
    const std::array size{length[0] * h[0] * h[0], length[1] * h[0] * h[1], length[2] * h[1] * h[1]};
    const double slip = 128 * kUnitRoundoff * (size[0] + 2 * size[1] + size[2]),
                 quadratic = quadratic_error(middle.whole_second, corner, slip);
    double best = kInfinity;
    const Curvature slips{middle.whole_off[0], middle.whole_off[1], middle.whole_off[2]};
    if (fit.exists()) {
        const bool is_half =
            fit.of_triangle ||
            (cell == fit.box && std::all_of(corner.begin(), corner.end(), [&](const Vec<2>& c) {
                 return (c[0] == cell.lo[0] || c[0] == cell.hi[0]) &&
                        (c[1] == cell.lo[1] || c[1] == cell.hi[1]);
             }));
        const double more = (is_half ? 1 : 2) * fit.whole;
        best = (quadratic + more) * (1 + 1e-13);
        if (more <= slips.along(h[0], h[1]) / 2) return best;  // what follows has about that more
    }
    const auto& third = middle.whole_third;
    const Vec<2> third_of_half = off + (1.0 / 3) * h;
    const Rest rest{h, change_by(third_of_half, third, slips), change_by({{h[0] * (2.0 / 3), 0}}, third, {}),
                    change_by({{0, h[1] * (2.0 / 3)}}, third, {})};
    return std::min(best, rest.error(2 * quadratic, size[0] + size[1], size[2] + size[1]));
}

double Bending::whole_halves_error(const Box<2>& cell) const {
    return whole_error(cell, half_of(cell, prefers_rising(cell.hi - cell.lo)));
}

double Bending::seen_error(const Box<2>& cell, double turn) const {
    const Curvature seen = seen_along(tilt + turn);
    double error = seen.error(cell.hi - cell.lo);
    if (knows_middle()) error = std::min(error, steady_error(rest_in(cell, turn), seen));
    return error;
}

double Bending::steady_error(const Rest& rest, const Curvature& seen) const {
    const double hu = rest.half[0], hv = rest.half[1], uu = hu * hu, uv = hu * hv, vv = hv * hv;
    const Quadratic& q = middle.second;
    const Curvature here = rest.here.plus(1, {std::abs(q.uu), std::abs(q.uv), std::abs(q.vv)});
    const Curvature &by_u = rest.by_u, &by_v = rest.by_v;
    double error = largest_sum(here.uu * uu + here.uv * uv, by_u.along(hu, hv)) +
                   largest_sum(here.vv * vv + here.uv * uv, by_v.along(hu, hv));
    if (seen.is_saddle()) {
        const double mixed = seen.uv * seen.uv;
        const double up = largest_sum((here.uu + mixed / std::abs(seen.sure_vv)) * uu, by_u.uu * uu) +
                          by_v.uu * uu,
                     down = largest_sum((here.vv + mixed / std::abs(seen.sure_uu)) * vv, by_v.vv * vv) +
                            by_u.vv * vv;
        error = std::min(error, std::max(up, down));
    }
    return error / 2 * (1 + 1e-13);
}

double Bending::halves_error(const Box<2>& cell, double turn, double enough) const {
    const Vec<2> half = half_sides({cell.side(0), cell.side(1)});
    const Quadratic& q = middle.second;
    const bool rising = prefers_rising(cell.hi - cell.lo);
    const double hu = half[0], hv = half[1], uu = q.uu * hu * hu, vv = q.vv * hv * hv,
                 uv = (rising ? q.uv : -q.uv) * hu * hv;
    // Of S - L and of L - S.
    const double u = std::max({0.0, uu + std::max(uv, 0.0), -uu + std::max(-uv, 0.0)}),
                 v = std::max({0.0, vv + std::max(uv, 0.0), -vv + std::max(-uv, 0.0)}),
                 most = 2 * q.error(half_of(cell, rising));
    return of_part(cell, half_of(cell, rising), turn, most, u, v, cell == fit.box ? 1 : 2, enough);
}

double Bending::cells_error(const Vec<2>& box, const Vec<2>& cell, double turn) const {
    const Quadratic& q = middle.second;
    const double hu = box[0] / 2, hv = box[1] / 2, turns = tilt + turn;
    const auto& t = middle.third;
    const Curvature rest{hu * t[0] + hv * t[1] + middle.off[0] + turns * beside.uu,
                         hu * t[1] + hv * t[2] + middle.off[1] + turns * beside.uv,
                         hu * t[2] + hv * t[3] + middle.off[2] + turns * beside.vv};
    return (std::max(q.halves_error(cell), q.fan_error(cell)) + rest.along(cell[0], cell[1]) / 8) *
           (1 + 1e-13);
}

double Bending::triangle_error(const Box<2>& cell, const std::array<Vec<2>, 3>& corner, double turn,
                               double enough) const {
    const Vec<2> half = half_sides({cell.side(0), cell.side(1)});
    const Quadratic& q = middle.second;
    const double hu = half[0], hv = half[1], uv = std::abs(q.uv) * hu * hv, u = std::abs(q.uu) * hu * hu + uv,
                 v = std::abs(q.vv) * hv * hv + uv, most = 2 * q.error(corner);
    return of_part(cell, corner, turn, most, u, v, fit.of_triangle ? 1 : 2, enough);
}

}  // namespace freiform

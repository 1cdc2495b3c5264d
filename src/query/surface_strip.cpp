// Matching parts of two lines.
//
// Idea: lines are matched by fractions of their length in parameters, which are `Bounded`, so two breaks are
// one where their fractions agree as far as is known; a part lies on one piece of either side, and de
// Casteljau's algorithm in `Bounded` restricts both to it.
//
// Scales: powers of two near the largest coordinate and the shorter of the two spans across, which cost no
// rounding, keep products of many factors in range.
#include "surface_strip_detail.hpp"

#include <algorithm>
#include <cmath>

namespace freiform::detail {

namespace {

Bounded scaled(const Bounded& a, int e) { return {std::scalbn(a.value, e), std::scalbn(a.bound, e)}; }

// Fractions that agree as far as is known are one cut.
std::vector<LineMatch> parts_of(const SurfaceSide& a, const SurfaceSide& b, double roundings) {
    const double grant = roundings * (a.uncertainty + b.uncertainty);
    std::vector<LineMatch> all;
    std::array<Bounded, 2> from{Bounded(0), Bounded(0)};  // of the current pieces
    for (std::size_t i = 0, j = 0; i < a.pieces.size() && j < b.pieces.size();) {
        const auto &p = a.pieces[i], &q = b.pieces[j];
        const Bounded apart = p.to - q.to;
        const bool same = std::abs(apart.value) <= apart.bound + grant ||
                          (i + 1 == a.pieces.size() && j + 1 == b.pieces.size());
        const bool a_ends = same || apart.value < 0, b_ends = same || apart.value > 0;
        const auto local = [](const SurfaceSide::Piece& of, const Bounded& x) {
            return (x - of.from) / (of.to - of.from);
        };
        const Bounded to_a = a_ends ? Bounded(1) : local(p, q.to),
                      to_b = b_ends ? Bounded(1) : local(q, p.to);
        LineMatch part{i, j, {from[0], to_a}, {from[1], to_b}, {}};
        const auto parameter = [&](const Bounded& x) {
            return x.value == 0 ? p.on.lo : x.value == 1 ? p.on.hi : p.on.lo + x.value * (p.on.hi - p.on.lo);
        };
        part.on = {parameter(from[0]), parameter(to_a)};
        all.push_back(part);
        from = {a_ends ? Bounded(0) : to_a, b_ends ? Bounded(0) : to_b};
        i += a_ends, j += b_ends;
    }
    return all;
}

Strip strip_of(const SurfaceSide& side, const SurfaceSide::Piece& piece, const std::array<Bounded, 2>& on,
               int length, int across, int orders) {
    Strip s;
    const std::size_t width = std::size_t(side.dimension) + 1;
    for (std::size_t k = 0; k <= std::size_t(orders); ++k) {
        s.d.emplace_back();
        for (std::size_t c = 0; c < width; ++c) {
            const auto b = restricted(piece.derivative[k * width + c], on);
            Form<Bounded> f;
            bool zero = true;
            for (std::size_t i = 0; i < b.size(); ++i) {
                f.s.push_back(Bounded(binomial(int(b.size()) - 1, int(i))) *
                              scaled(b[i], int(k) * across - (c + 1 < width ? length : 0)));
                zero = zero && f.s.back().is_zero();
            }
            s.d.back().push_back(zero ? Form<Bounded>{} : f);
        }
    }
    return s;
}

// The power of two near the largest coordinate.
int scale_of(const SurfaceSide& s) {
    double most = 0;
    const std::size_t width = std::size_t(s.dimension) + 1;
    for (const auto& p : s.pieces)
        for (std::size_t r = 0; r < 2 * width; ++r)
            for (const Bounded& x : p.derivative[r])
                if (r % width + 1 < width)
                    most = std::max(most, std::abs(x.value) * (r < width ? 1 : s.span));
    return most > 0 && std::isfinite(most) ? std::ilogb(most) : 0;
}

}  // namespace

std::vector<Bounded> restricted(std::vector<Bounded> c, const std::array<Bounded, 2>& on) {
    const auto [x, y] = on;
    const auto step = [&](std::size_t rounds_to, const Bounded& t, bool left) {
        const Bounded s = Bounded(1) - t;
        const std::size_t n = c.size();
        for (std::size_t r = 1; r <= rounds_to; ++r)
            if (left)
                for (std::size_t i = n - 1; i >= r; --i) c[i] = s * c[i - 1] + t * c[i];
            else
                for (std::size_t i = 0; i + r < n; ++i) c[i] = s * c[i] + t * c[i + 1];
    };
    if (c.size() < 2) return c;
    if (!(y == Bounded(1))) step(c.size() - 1, y, true);
    if (!x.is_zero()) step(c.size() - 1, x / y, false);
    return c;
}

void JointStrips::add(const LineMatch& p) {
    const int orders = std::max(options.orders, 2);
    parts.push_back(p);
    first.push_back(strip_of(a, a.pieces[p.a], p.on_a, length, across, orders));
    second.push_back(strip_of(b, b.pieces[p.b], p.on_b, length, across, orders));
}

JointStrips JointStrips::make(const SurfaceSide& a, const SurfaceSide& b, const ContinuityOptions& options) {
    JointStrips j{a,  b,  options, std::max(scale_of(a), scale_of(b)), std::ilogb(std::min(a.span, b.span)),
                  {}, {}, {}};
    for (const LineMatch& p : parts_of(a, b, options.roundings)) j.add(p);
    return j;
}

JointStrips JointStrips::halved() const {
    JointStrips j{a, b, options, length, across, {}, {}, {}};
    for (const LineMatch& p : parts) {
        LineMatch left = p, right = p;
        for (auto [l, r] : {std::pair(&left.on_a, &right.on_a), {&left.on_b, &right.on_b}})
            (*l)[1] = (*r)[0] = Bounded(0.5) * ((*l)[0] + (*l)[1]);
        left.on.hi = right.on.lo = p.on.middle();
        j.add(left), j.add(right);
    }
    return j;
}

}  // namespace freiform::detail

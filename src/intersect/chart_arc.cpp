// One chart; charts_detail.hpp is the essay.
#include "charts_detail.hpp"

namespace freiform::detail {

namespace {

constexpr double kMostSlope = 2.4, kMostDefect = 0.8;

double spread(const Vec<3>& row, const Vec<3>& radius) {
    return std::abs(row[0]) * radius[0] + std::abs(row[1]) * radius[1] + std::abs(row[2]) * radius[2];
}
double triple(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) { return dot(a, cross(b, c)); }
// Of four columns without one: rows of the inverse, empty for that one. ArcZero determinant: infinite.
std::array<Vec<3>, 4> inverse_without(const std::array<Vec<3>, 4>& c, std::size_t free) {
    std::array<std::size_t, 3> i;
    for (std::size_t k = 0, n = 0; k < 4; ++k)
        if (k != free) i[n++] = k;
    const std::array<Vec<3>, 3> m{cross(c[i[1]], c[i[2]]), cross(c[i[2]], c[i[0]]), cross(c[i[0]], c[i[1]])};
    const double det = dot(c[i[0]], m[0]);
    std::array<Vec<3>, 4> y{};
    for (std::size_t k = 0; k < 3; ++k) y[i[k]] = (1 / det) * m[k];
    return y;
}
// The vector that four columns take to 0.
Place4 null_of(const std::array<Vec<3>, 4>& c) {
    return {triple(c[1], c[2], c[3]), -triple(c[0], c[2], c[3]), triple(c[0], c[1], c[3]),
            -triple(c[0], c[1], c[2])};
}

}  // namespace

Charts::Value Charts::value(const Place4& x) const {
    const Sheet::At a = sheets_[0]->at(x[0], x[1]), b = sheets_[1]->at(x[2], x[3]);
    return {a.point - b.point, {a.d[0], a.d[1], -b.d[0], -b.d[1]}};
}

double Charts::error_at(const Place4& x) const {
    double sum = 0;
    for (std::size_t i = 0; i < 2; ++i) {
        bool inside = true;
        for (std::size_t k = 2 * i; k < 2 * i + 2; ++k)
            inside = inside && (is_cyclic(k) || domain(k).contains(x[k]));
        sum += inside ? sheets_[i]->inner_error() : sheets_[i]->value_error();
    }
    return 1.01 * sum;
}

bool Charts::newton(Place4& x, std::size_t fixed, const std::array<double, 4>& width, double until) const {
    double last = kInfinity;
    for (int i = 0; i < 12; ++i) {
        const Value v = value(x);
        const auto y = inverse_without(v.d, fixed);
        double step = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            if (k == fixed) continue;
            const double d = dot(y[k], v.f);
            step = std::max(step, std::abs(d) / width[k]);
            x[k] -= d;
        }
        if (!(step < 4)) return false;
        // Convergence is quadratic: what is left is far below this step.
        if (step <= until || (step >= 0.5 * last && step < 0x1p-20)) return true;
        last = step;
    }
    return false;
}

std::optional<ArcZero> Charts::zero(const Chart& c, Place4 x, double until) const {
    const std::array<double, 4> width{c.width(0), c.width(1), c.width(2), c.width(3)};
    if (!newton(x, c.free, width, until)) return std::nullopt;
    const Value v = value(x);
    const double error = error_at(x);
    double off = 0;
    bool inside = true;
    for (std::size_t k = 0; k < 4; ++k) {
        const double at = (x[k] - c.core[k].middle()) / width[k];
        inside = inside && std::abs(at) <= 0.5 + Sheet::kMargin;
        if (k == c.free) continue;
        off = std::max(off, std::abs(dot(c.y[k], v.f)) + spread(c.y[k], {{error, error, error}}));
    }
    off = 1.01 * off / (1 - c.q);
    if (!inside || !(off < 0x1p-8)) return std::nullopt;
    return ArcZero{x, off};
}

Charts::Direction Charts::direction(const Place4& x) const {
    const Value v = value(x);
    Direction out;
    out.x = null_of(v.d);
    out.tangent = out.x[0] * v.d[0] + out.x[1] * v.d[1];
    const double speed = norm(out.tangent);
    if (speed > 0 && std::isfinite(speed)) {
        for (double& d : out.x) d /= speed;
        out.tangent = (1 / speed) * out.tangent;
    }
    return out;
}

// Y, q and S from derivatives over the surroundings (or the core alone). `drift`: how each parameter changes
// along the arc for one length of the free one, at least and at most: middle +- S q / (1 - q) or so.
bool Charts::set_up(Chart& c, const Sheet::Slopes& a, const Sheet::Slopes& b,
                    std::array<double, 4>& drift) const {
    std::array<Vec<3>, 4> middle, radius;
    for (std::size_t k = 0; k < 4; ++k) {
        const SlopeBox& s = k < 2 ? a[k] : b[k - 2];
        const double w = c.width(k);
        middle[k] = (k < 2 ? w : -w) * s.middle();
        radius[k] = w * s.radius();
    }
    const Place4 n = null_of(middle);
    c.free = 0;
    for (std::size_t k = 1; k < 4; ++k)
        if (std::abs(n[k]) > std::abs(n[c.free])) c.free = k;
    if (!(std::abs(n[c.free]) > 0)) return false;
    c.forward = n[c.free] > 0 ? 1 : -1;
    c.y = inverse_without(middle, c.free);
    c.q = c.slope = 0;
    for (std::size_t r = 0; r < 4; ++r) {
        if (r == c.free) continue;
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k)
            if (k != c.free) sum += spread(c.y[r], radius[k]);
        c.q = std::max(c.q, 1.0001 * sum + 0x1p-40);
        if (!(c.q < kMostDefect)) return false;
        drift[r] = -dot(c.y[r], middle[c.free]);
        c.slope = std::max(c.slope, 1.0001 * (std::abs(drift[r]) + spread(c.y[r], radius[c.free])));
    }
    c.slope /= 1 - c.q;
    if (!(c.slope < kMostSlope)) return false;
    for (std::size_t r = 0; r < 4; ++r)
        c.along[r] = r == c.free ? 1 : drift[r] * c.width(r) / c.width(c.free);
    // y' = -(1 + R)^-1 Y F_free, |R| <= q.
    std::array<double, 4> sure{};
    for (std::size_t r = 0; r < 4; ++r) {
        const double more = r == c.free ? 0 : spread(c.y[r], radius[c.free]) + c.q * c.slope;
        if (r == c.free) drift[r] = 1;
        sure[r] = std::abs(drift[r]) > 1.01 * more ? drift[r] : 0;
    }
    drift = sure;  // 0: no sign is certain
    return true;
}

Charts::Answer Charts::settle(PartPair p) {
    Chart c;
    c.parts = p;
    const SheetPart &a = (*sheets_[0])[p.a], &b = (*sheets_[1])[p.b];
    c.core = {a.on[0], a.on[1], b.on[0], b.on[1]};
    std::array<double, 4> drift{};
    if (!set_up(c, sheets_[0]->slopes(p.a, false), sheets_[1]->slopes(p.b, false), drift) || c.q > 0.25)
        return Answer::open;
    if (!set_up(c, sheets_[0]->slopes(p.a, true), sheets_[1]->slopes(p.b, true), drift)) return Answer::open;
    const Answer answer = seed(c, drift);
    if (answer == Answer::chart) charts_.push_back(c);
    return answer;
}

// The seed, or that there are no zeros in the core.
Charts::Answer Charts::seed(Chart& c, const std::array<double, 4>& drift) const {
    const double reach = 0.5 + 0.5 * c.slope;  // from the middle, of the zero that the core asks for
    Place4 x;
    for (std::size_t k = 0; k < 4; ++k) x[k] = c.core[k].middle();
    const double error = error_at(x);
    const Vec<3> f = value(x).f;
    for (std::size_t k = 0; k < 4; ++k) {
        if (k == c.free) continue;
        const double d = dot(c.y[k], f), e = spread(c.y[k], {{error, error, error}});
        if (std::abs(d) > 1.01 * (reach * (1 + c.q) + e)) return Answer::nothing;
        x[k] -= d * c.width(k);
    }
    const auto found = zero(c, x, 0x1p-7);
    if (!found) return Answer::open;
    c.seed = found->x;
    for (std::size_t k = 0; k < 4; ++k)
        if (std::abs(c.seed[k] - c.core[k].middle()) / c.width(k) > reach + 1.01 * found->off + 0x1p-40)
            return Answer::nothing;
    // Borders that the arc may reach between its seed and the core.
    std::array<std::pair<std::size_t, double>, 4> borders;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        if (is_cyclic(k)) continue;
        const double path = (k == c.free ? 0.5 : 0.5 * c.slope + found->off) * c.width(k) * (1 + 0x1p-30);
        const Interval on = domain(k);
        for (const double at : {on.lo, on.hi}) {
            if (at < c.seed[k] - path || at > c.seed[k] + path) continue;
            if (drift[k] == 0 || count == 4) return Answer::open;
            borders[count++] = {k, at};
        }
    }
    const auto is_inside = [&](const Place4& y) {
        for (std::size_t k = 0; k < 4; ++k) {
            const Interval on = domain(k);
            if (!is_cyclic(k) && (y[k] < on.lo || y[k] > on.hi)) return false;
        }
        return true;
    };
    if (is_inside(c.seed)) return Answer::chart;
    // The arc over the domain is one interval of it; it begins or ends at a border.
    const std::array<double, 4> width{c.width(0), c.width(1), c.width(2), c.width(3)};
    for (std::size_t i = 0; i < count; ++i) {
        Place4 y = c.seed;
        const auto [k, at] = borders[i];
        const double by = at - y[k];
        for (std::size_t r = 0; r < 4; ++r) y[r] += drift[r] / drift[k] * by / c.width(k) * c.width(r);
        y[k] = at;
        if (!newton(y, k, width)) return Answer::open;
        y[k] = at;
        if (is_inside(y)) {
            c.seed = y;
            return Answer::chart;
        }
    }
    return Answer::nothing;
}

}  // namespace freiform::detail

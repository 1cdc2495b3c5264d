// Equal parameter steps, forward differences, recursive halving.
//
// Equal steps. A function with |c''| <= m is within m h^2 / 8 of its linear interpolant over a step h
// [deBoor 2001, ch. II]; c'' is bounded over the eight parts of a piece by derivative_bounds.cpp, so the
// number of steps follows from the tolerance, or the bound from the number. Points come from Horner's scheme
// in Bernstein form: (((b_0 s + C(p,1) t b_1) s + C(p,2) t^2 b_2) s + ..), s = 1 - t, all terms convex: at
// most 3 p + 4 roundings. In powers of t the scheme has half the products, but coefficients up to 3^p times
// larger (the forms agree in flatten_test.cpp, suite R18).
//
// Forward differences add the drift, see forward_differences.hpp. Of a rational piece numerator and weight
// are stepped: with drift d of the numerator and e of the weight a point moves by at most
// (d + |c| e) / (w_min - e).
//
// Halving. A part is flat when the bound of its distance from its chord (flatten_detail.hpp) is within the
// tolerance. With `polygons` it is the distance between the part and its control polygon. Let l be the
// polygon over the parameters i / p. If b is a convex sequence, its Bezier function lies above l, and so
// every second difference of b contributes to c - l with the same sign; the sum is largest if all second
// differences are equal, for b_i = -i (p - i) / 2, where it is i (p - i) / (2 p) at i / p. Hence
//     |c - l| <= max |second difference| floor(p / 2) ceil(p / 2) / (2 p),
// which is [Nairn Peters Lutterkort 1999]'s bound.
// Of a rational part the quotient of the two polygons runs along the polygon; the estimate of the quotient
// is as in flatten_detail.hpp.
//
// By number of segments the part with the largest bound is halved until there are enough.
#include "path/flatten_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/path/forward_differences.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <queue>

namespace freiform::detail {

template <class P>
double second_derivative(std::span<const P> b) {
    constexpr int kParts = 3;  // halvings
    std::vector<P> parts(b.begin(), b.end());
    const std::size_t n = b.size();
    for (int k = 0; k < kParts; ++k) {
        std::vector<P> finer(2 * parts.size());
        for (std::size_t i = 0; i < parts.size(); i += n) {
            std::copy_n(parts.begin() + std::ptrdiff_t(i), n, finer.begin() + std::ptrdiff_t(2 * i));
            halve(std::span(finer).subspan(2 * i, n), std::span(finer).subspan(2 * i + n, n));
        }
        parts = std::move(finer);
    }
    double most = 0;
    for (std::size_t i = 0; i < parts.size(); i += n)
        most = std::max(most, derivative_bounds<1, P>({&parts[i], {int(n)}, {1}}, {1.0 / (1 << kParts)})(2));
    return most;
}

namespace {

// Horner's scheme in Bernstein form.
template <class P>
P horner_bernstein(std::span<const P> b, double t) {
    const int p = int(b.size()) - 1;
    if (p == 0) return b[0];
    const double s = 1 - t;
    P sum = s * b[0];
    double power = 1, choose = 1;
    for (int i = 1; i < p; ++i) {
        power *= t;
        choose = choose * (p - i + 1) / i;
        sum = s * (sum + (power * choose) * b[std::size_t(i)]);
    }
    return sum + (power * t) * b[std::size_t(p)];
}

template <int D>
void append(Polyline<D>& out, const Vec<D>& point, double parameter) {
    out.points.push_back(point);
    out.parameters.push_back(parameter);
}

// Appends the points of a piece after its first. Returns what they may be off.
template <class P>
double step_through(const Chain<P>& chain, int i, int n, bool forward, Polyline<Space<P>::kDim>& out) {
    constexpr int D = Space<P>::kDim;
    const auto b = chain.piece(i);
    const double h = 1.0 / n;
    if (forward && n > 1) {
        ForwardDifferences<P> f(b, n);
        double off = 0, least = 1;
        for (int k = 0; k < D; ++k) off = std::max(off, f.drift()[k]);
        if constexpr (Space<P>::kRational) {
            const double e = f.drift().weight();
            least = chain.lightest() - e;
            off += chain.size() * e;
        }
        for (int k = 1; k < n; ++k) {
            f.advance();
            append(out, project(f.value()), chain.global(i, k * h));
        }
        append(out, project(b.back()), chain.at(i + 1));
        if (!(least > 0)) return std::numeric_limits<double>::infinity();
        return chain.error(1) + 1.01 * std::sqrt(double(D)) * off / least;
    }
    for (int k = 1; k < n; ++k) append(out, project(horner_bernstein(b, k * h)), chain.global(i, k * h));
    append(out, project(b.back()), chain.at(i + 1));
    return chain.error(3 * chain.degree() + 4);
}

// The start of a piece is the end of the one before it, which may be so far from its own; and parameters are
// rounded, which moves places along the curve where the domain is far from zero.
template <class P>
double joint_slip(const Chain<P>& chain) {
    double most = 0;
    for (int i = 0; i < chain.pieces(); ++i) {
        const auto b = chain.piece(i);
        const double at = std::max(std::abs(chain.at(i)), std::abs(chain.at(i + 1))),
                     speed = derivative_bounds<1, P>({b.data(), {int(b.size())}, {1}}, {1.0})(1);
        // u for the length of the piece, for the product and for the sum of Chain::global.
        most = std::max(most, 1.01 * kUnitRoundoff * (at / (chain.at(i + 1) - chain.at(i)) + 2) * speed);
    }
    return 2 * chain.error(0) + most;
}

template <class P>
void begin_piece(const Chain<P>& chain, int i, Polyline<Space<P>::kDim>& out) {
    if (i > 0 && !chain.jumps_at(i)) return;
    if (i > 0) out.parts.push_back(out.points.size());
    append(out, project(chain.piece(i)[0]), chain.at(i));
}

// The distance of a part from its control polygon.
template <class P>
double polygon_bound(std::span<const P> b) {
    constexpr int D = Space<P>::kDim;
    const int p = int(b.size()) - 1;
    if (p < 2) return 0;
    const double factor = (p / 2) * (p - p / 2) / (2.0 * p);
    const Vec<D> o = project(b[0]);
    double bend = 0, weight_bend = 0, far = 0, lightest = Space<P>::weight(b[0]), heaviest = lightest;
    Vec<D> n[3];
    for (int i = 0; i <= p; ++i) {
        const P& a = b[std::size_t(i)];
        const Vec<D> d = project(a) - o;
        const double w = Space<P>::weight(a);
        n[i % 3] = w * d;
        far = std::max(far, norm(d));
        lightest = std::min(lightest, w);
        heaviest = std::max(heaviest, w);
        if (i < 2) continue;
        bend = std::max(bend, norm(n[i % 3] - 2 * n[(i + 2) % 3] + n[(i + 1) % 3]));
        if constexpr (Space<P>::kRational)
            weight_bend = std::max(weight_bend, std::abs(w - 2 * b[std::size_t(i) - 1].weight() +
                                                         b[std::size_t(i) - 2].weight()));
    }
    return factor * (bend + far * weight_bend + 32 * kUnitRoundoff * far * heaviest) / lightest *
           (1 + 16 * kUnitRoundoff);
}

template <class P>
struct Part {
    std::vector<P> b;
    double x0 = 0, x1 = 1;
    double bound = 0;
    int piece = 0, depth = 0;
    friend bool operator<(const Part& l, const Part& r) { return l.bound < r.bound; }
};

template <class P>
double bound_of(std::span<const P> b, bool polygons) {
    if constexpr (Space<P>::kDim == 1) {
        if (!polygons) return difference_bound<P>(b, project(b.front()), project(b.back()));
    } else if (!polygons) {
        return distance_bound<P>(b, {project(b.front()), project(b.back())});
    }
    return polygon_bound<P>(b);
}

template <class P>
Part<P> right_half(Part<P>& part, bool polygons) {
    Part<P> right{part.b, part.x0 + (part.x1 - part.x0) / 2, part.x1, 0, part.piece, part.depth + 1};
    halve(std::span(part.b), std::span(right.b));
    part.x1 = right.x0;
    ++part.depth;
    part.bound = bound_of<P>(part.b, polygons);
    right.bound = bound_of<P>(right.b, polygons);
    return right;
}

template <class P>
void append_part(const Chain<P>& chain, const Part<P>& part, bool polygons, Polyline<Space<P>::kDim>& out) {
    const int p = chain.degree();
    for (int k = polygons ? 1 : std::max(p, 1); k <= std::max(p, 1); ++k) {
        const double x = k >= p ? part.x1 : part.x0 + (part.x1 - part.x0) * k / p;
        append(out, project(part.b[std::size_t(std::min(k, p))]), chain.global(part.piece, x));
    }
    out.bound = std::max(out.bound, part.bound);
}

constexpr int kDeepestHalving = 52;

template <class P>
std::unexpected<Refusal> drifted(const Chain<P>& chain, double tolerance, double off, bool forward) {
    return refuse(
        RefusalKind::ill_conditioned, "tolerance",
        text(std::scalbn(tolerance, chain.exponent()), " leaves no room for the rounding of ",
             forward ? "so many forward differences, " : "the steps, ", std::scalbn(off, chain.exponent())));
}

std::unexpected<Refusal> not_allowed(const FlattenOptions& options) {
    return refuse(RefusalKind::limit, "max_segments",
                  text("is ", options.max_segments, ", wanted are ", options.segments));
}

}  // namespace

template <class P>
Result<Polyline<Space<P>::kDim>> flatten_uniform(const Chain<P>& chain, const FlattenOptions& options,
                                                 double tolerance) {
    constexpr int D = Space<P>::kDim;
    const bool forward = options.method == FlattenMethod::forward;
    const double slip = chain.error(3 * chain.degree() + 4) + joint_slip(chain);
    if (tolerance > 0 && !(tolerance > 1.5 * slip)) return below_rounding(chain, tolerance, 2 * slip);
    const int each = (options.segments + chain.pieces() - 1) / chain.pieces();
    Polyline<D> out;
    for (int i = 0; i < chain.pieces(); ++i) {
        begin_piece(chain, i, out);
        const auto b = chain.piece(i);
        const double second = second_derivative<P>(b);
        // A straight piece is flat at any speed.
        const double chord = bound_of<P>(b, false);
        double off = slip, deviation = 0;
        const std::size_t begun = out.points.size();
        for (int trial = 0;; ++trial) {  // forward differences drift more the more there are
            const double left = tolerance - 1.01 * off;
            const double n = tolerance <= 0  ? each
                             : chord <= left ? 1
                             : left > 0      ? steps_for(second, left)
                                             : 3e9;
            if (trial > 0 && n > 2e9) return drifted(chain, tolerance, off, forward);
            if (!(double(begun) + n <= double(options.max_segments) + double(out.parts.size())) || n > 2e9)
                return tolerance > 0 ? too_many(chain, tolerance - slip, options.max_segments)
                                     : not_allowed(options);
            off = step_through(chain, i, int(n), forward, out) + joint_slip(chain);
            // Steps from k h to (k + 1) h, both rounded.
            const double h = 1 / n + 2 * kUnitRoundoff;
            deviation = n == 1 ? std::min(chord, second * h * h / 8) : second * h * h / 8;
            if (tolerance <= 0 || deviation + off <= tolerance) break;
            if (trial == 5) return drifted(chain, tolerance, off, forward);
            out.points.resize(begun);
            out.parameters.resize(begun);
        }
        out.bound = std::max(out.bound, deviation + off);
    }
    out.closed = chain.closed() && out.parts.size() == 1;
    if (out.closed) {
        out.bound += norm(out.points.back() - out.points[0]);
        out.points.back() = out.points[0];
    }
    return out;
}

template <class P>
Result<Polyline<Space<P>::kDim>> flatten_halving(const Chain<P>& chain, const FlattenOptions& options,
                                                 double tolerance) {
    constexpr int D = Space<P>::kDim;
    const double slip = chain.error(chain.degree() * kDeepestHalving) + joint_slip(chain);
    if (tolerance > 0 && !(tolerance > 1.5 * slip)) return below_rounding(chain, tolerance, 2 * slip);
    const bool polygons = options.polygons;
    const std::size_t per_part = polygons ? std::size_t(std::max(chain.degree(), 1)) : 1;
    const auto whole = [&](int i) {
        const auto b = chain.piece(i);
        return Part<P>{{b.begin(), b.end()}, 0, 1, bound_of<P>(b, polygons), i, 0};
    };
    Polyline<D> out;
    if (tolerance > 0) {
        for (int i = 0; i < chain.pieces(); ++i) {
            begin_piece(chain, i, out);
            std::vector<Part<P>> open{whole(i)};
            while (!open.empty()) {
                Part<P>& part = open.back();
                if (part.bound <= tolerance - slip) {
                    if (out.points.size() + per_part > options.max_segments + out.parts.size())
                        return too_many(chain, tolerance - slip, options.max_segments);
                    append_part(chain, part, polygons, out);
                    open.pop_back();
                    continue;
                }
                if (part.depth == kDeepestHalving)
                    return refuse(RefusalKind::ill_conditioned, "tolerance",
                                  text("cannot be reached at parameter ", chain.global(i, part.x0)));
                Part<P> left = std::move(part);
                open.back() = right_half(left, polygons);
                open.push_back(std::move(left));
            }
        }
    } else {
        if (std::size_t(options.segments) > options.max_segments) return not_allowed(options);
        std::priority_queue<Part<P>> queue;
        for (int i = 0; i < chain.pieces(); ++i) queue.push(whole(i));
        while (queue.size() * per_part < std::size_t(options.segments) &&
               queue.top().depth < kDeepestHalving) {
            Part<P> left = queue.top();
            queue.pop();
            queue.push(right_half(left, polygons));
            queue.push(std::move(left));
        }
        std::vector<Part<P>> parts;
        for (; !queue.empty(); queue.pop()) parts.push_back(queue.top());
        sort(parts, [](const Part<P>& a, const Part<P>& b) {
            return a.piece != b.piece ? a.piece < b.piece : a.x0 < b.x0;
        });
        for (const Part<P>& part : parts) {
            if (part.x0 == 0) begin_piece(chain, part.piece, out);
            append_part(chain, part, polygons, out);
        }
    }
    out.bound += slip;
    out.closed = chain.closed() && out.parts.size() == 1;
    if (out.closed) {
        out.bound += norm(out.points.back() - out.points[0]);
        out.points.back() = out.points[0];
    }
    return out;
}

#define FF_INSTANTIATE(P)                                                                             \
    template double second_derivative<P>(std::span<const P>);                                         \
    template Result<Polyline<Space<P>::kDim>> flatten_uniform(const Chain<P>&, const FlattenOptions&, \
                                                              double);                                \
    template Result<Polyline<Space<P>::kDim>> flatten_halving(const Chain<P>&, const FlattenOptions&, double);
FF_INSTANTIATE(Vec<1>)
FF_INSTANTIATE(Vec<2>)
FF_INSTANTIATE(Vec<3>)
FF_INSTANTIATE(Vec<4>)
FF_INSTANTIATE(Hom<1>)
FF_INSTANTIATE(Hom<2>)
FF_INSTANTIATE(Hom<3>)
FF_INSTANTIATE(Hom<4>)
#undef FF_INSTANTIATE

}  // namespace freiform::detail

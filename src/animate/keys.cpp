// Key frames.
//
// Method: between two keys every way is a cubic in Bernstein form, of time itself (linear, hermite) or of a
// parameter that time is a cubic of (bezier, eased), which animate/easing.hpp inverts. All of it is computed
// with running error analysis (core/bounded.hpp), so bounds hold as far as that goes.
//
// Times of Bezier keys: with handles between the keys, time is monotone in the parameter, as for easings.
#include <freiform/animate/easing.hpp>
#include <freiform/animate/keys.hpp>
#include <freiform/make/named_curve.hpp>

#include <algorithm>
#include <limits>

namespace freiform {
namespace {

// Into the times of the keys. Repeating and mirroring round once more.
double brought_inside(double t, Interval on, BeyondKeys outside) {
    if (t >= on.lo && t <= on.hi) return t;
    const double length = on.hi - on.lo;
    if (outside == BeyondKeys::hold || !(length > 0)) return t < on.lo ? on.lo : on.hi;
    const bool mirror = outside == BeyondKeys::mirror;
    double rest = std::fmod(t - on.lo, mirror ? 2 * length : length);
    if (rest < 0) rest += mirror ? 2 * length : length;
    if (mirror && rest > length) rest = 2 * length - rest;
    return std::min(on.lo + rest, on.hi);
}

template <int D>
std::array<Bounded, std::size_t(D)> between_keys(const Key<D>& a, const Key<D>& b, double t) {
    std::array<Bounded, std::size_t(D)> out;
    const Bounded h = Bounded(b.time) - Bounded(a.time), x = (Bounded(t) - Bounded(a.time)) / h;
    const auto each = [&](auto&& f) {
        for (int d = 0; d < D; ++d) out[std::size_t(d)] = f(d);
    };
    switch (a.next) {
        case Between::step:
            each([&](int d) { return Bounded(a.value[d]); });
            break;
        case Between::linear:
            each([&](int d) { return (Bounded(1) - x) * Bounded(a.value[d]) + x * Bounded(b.value[d]); });
            break;
        case Between::hermite:
            each([&](int d) {
                const Bounded p(a.value[d]), q(b.value[d]);
                return detail::cubic_at({p, p + h * Bounded(a.leaving[d]) / Bounded(3),
                                         q - h * Bounded(b.arriving[d]) / Bounded(3), q},
                                        x);
            });
            break;
        case Between::bezier: {
            const auto s = detail::place_on_monotone_cubic({a.time, a.after.time, b.before.time, b.time}, t);
            each([&](int d) {
                return detail::cubic_at(
                    std::array{a.value[d], a.after.value[d], b.before.value[d], b.value[d]}, s);
            });
            break;
        }
        case Between::eased: {
            const auto [x1, y1, x2, y2] = a.easing;
            const std::array<double, 4> share = {0, x1, x2, 1};
            auto s = detail::place_on_monotone_cubic(share, x.value);
            if (x.bound > 0) {  // where x may be, and the parameter then
                const auto lo = detail::place_on_monotone_cubic(share, std::max(x.value - 2 * x.bound, 0.0)),
                           hi = detail::place_on_monotone_cubic(share, std::min(x.value + 2 * x.bound, 1.0));
                s.off = std::max({s.off, s.at - lo.at + lo.off, hi.at - s.at + hi.off}) * (1 + 0x1p-48);
            }
            const Bounded y = detail::cubic_at(std::array<double, 4>{0, y1, y2, 1}, s);
            each(
                [&](int d) { return Bounded(a.value[d]) + y * (Bounded(b.value[d]) - Bounded(a.value[d])); });
            break;
        }
    }
    return out;
}

}  // namespace

template <int D>
Result<Track<D>> Track<D>::make(std::vector<Key<D>> keys, BeyondKeys outside) {
    if (keys.empty()) return refuse(RefusalKind::invalid, "keys", "at least one key is expected");
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const Key<D>& k = keys[i];
        const auto bad = [&](RefusalKind kind, const char* what, std::string why) {
            return refuse(kind, text("keys[", i, "]", what), std::move(why));
        };
        if (!std::isfinite(k.time)) return bad(RefusalKind::nonfinite, ".time", "a number is expected");
        if (!is_finite(k.value) || !is_finite(k.arriving) || !is_finite(k.leaving) ||
            !is_finite(k.before.value) || !is_finite(k.after.value))
            return bad(RefusalKind::nonfinite, "", "numbers are expected");
        if (i > 0 && !(k.time > keys[i - 1].time))
            return bad(RefusalKind::invalid, ".time",
                       text("it is ", k.time, ", not after ", keys[i - 1].time, " of the key before"));
        if (i > 0 && !std::isfinite(k.time - keys[i - 1].time))
            return bad(RefusalKind::invalid, ".time", "the time between the keys is not a number");
        if (i + 1 == keys.size()) break;
        if (k.next == Between::eased) {
            if (auto e = CubicBezierEasing::make(k.easing[0], k.easing[1], k.easing[2], k.easing[3]); !e)
                return refuse_within(text("keys[", i, "].easing"), e.error());
        }
        if (k.next == Between::bezier) {
            const double from = k.time, to = keys[i + 1].time;
            if (!(k.after.time >= from && k.after.time <= to))
                return bad(RefusalKind::invalid, ".after.time",
                           text("it is ", k.after.time, ", not between ", from, " and ", to));
            if (const double t = keys[i + 1].before.time; !(t >= from && t <= to))
                return refuse(RefusalKind::invalid, text("keys[", i + 1, "].before.time"),
                              text("it is ", t, ", not between ", from, " and ", to));
        }
    }
    return Track(std::move(keys), outside);
}

template <int D>
void Track<D>::evaluate(std::span<const double> times, std::span<Vec<D>> out,
                        std::span<double> bounds) const {
    FF_REQUIRE(times.size() == out.size() && (bounds.empty() || bounds.size() == out.size()));
    for (std::size_t i = 0; i < times.size(); ++i) {
        double bound = 0;
        if (!std::isfinite(times[i])) {
            for (double& c : out[i].c) c = std::numeric_limits<double>::quiet_NaN();
            bound = std::numeric_limits<double>::infinity();
        } else {
            const double t = brought_inside(times[i], this->times(), outside_);
            const auto next = std::ranges::upper_bound(keys_, t, {}, &Key<D>::time);
            const Key<D>& a = *(next - 1);
            if (next == keys_.end() || t == a.time) {
                out[i] = a.value;
            } else {
                const auto v = between_keys(a, *next, t);
                for (int d = 0; d < D; ++d) {
                    out[i][d] = v[std::size_t(d)].value;
                    bound = std::max(bound, v[std::size_t(d)].bound);
                }
            }
        }
        if (!bounds.empty()) bounds[i] = bound;
    }
}

template <int D>
Vec<D> Track<D>::operator()(double time) const {
    Vec<D> out;
    evaluate({&time, 1}, {&out, 1});
    return out;
}

template <int D>
Result<Curve<Vec<D>>> Track<D>::curve() const {
    std::vector<double> times;
    std::vector<Vec<D>> points, arriving, leaving;
    for (const Key<D>& k : keys_) {
        times.push_back(k.time), points.push_back(k.value);
        arriving.push_back(k.arriving), leaving.push_back(k.leaving);
    }
    for (std::size_t i = 0; i + 1 < keys_.size(); ++i) {
        if (keys_[i].next == Between::linear) {
            const Vec<D> slope = (1 / (times[i + 1] - times[i])) * (points[i + 1] - points[i]);
            leaving[i] = arriving[i + 1] = slope;
        } else if (keys_[i].next != Between::hermite) {
            return refuse(RefusalKind::unsupported, text("keys[", i, "]"),
                          "what follows is no polynomial of time, as linear and hermite are");
        }
    }
    arriving.front() = leaving.front(), leaving.back() = arriving.back();
    return hermite_spline<Vec<D>>(points, arriving, times, leaving);
}

template <int D>
void set_tangents(std::span<Key<D>> keys, std::span<const TensionContinuityBias> settings) {
    FF_REQUIRE(settings.size() <= 1 || settings.size() == keys.size());
    const std::size_t n = keys.size();
    if (n == 1) keys[0].arriving = keys[0].leaving = {};
    for (std::size_t i = 0; i < n && n > 1; ++i) {
        const TensionContinuityBias setting =
            settings.empty() ? TensionContinuityBias{} : settings[settings.size() == 1 ? 0 : i];
        // Differences over the segments before and after; the missing one has the slope of the other.
        const double h = i > 0 ? keys[i].time - keys[i - 1].time : keys[1].time - keys[0].time,
                     k = i + 1 < n ? keys[i + 1].time - keys[i].time : h;
        const Vec<D> before = i > 0 ? keys[i].value - keys[i - 1].value : keys[1].value - keys[0].value,
                     after = i + 1 < n ? keys[i + 1].value - keys[i].value : before;
        const auto tangent = [&](const TangentWeights& w) {
            return (2 / (h + k)) * (w.before * before + w.after * after);
        };
        keys[i].arriving = tangent(arriving(setting));
        keys[i].leaving = tangent(leaving(setting));
        keys[i].next = Between::hermite;
    }
}

#define FF_KEYS(D)           \
    template class Track<D>; \
    template void set_tangents(std::span<Key<D>>, std::span<const TensionContinuityBias>);
FF_KEYS(1)
FF_KEYS(2)
FF_KEYS(3)
FF_KEYS(4)
#undef FF_KEYS

}  // namespace freiform

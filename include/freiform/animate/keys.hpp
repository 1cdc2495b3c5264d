// Key frames: values at times, and what happens between them.
#pragma once
#include <freiform/basis/named.hpp>
#include <freiform/spline/patch.hpp>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace freiform {

// From a key to the next one.
enum class Between {
    step,  // the value stays until the next key
    linear,
    hermite,  // the cubic with the derivatives `leaving` and, of the next key, `arriving`
    bezier,   // the cubic curve in time and value with the points `after` and, of the next key, `before`
    eased,    // on a line, at the speed of the easing
};

template <int D>
struct Key {
    struct Handle {
        double time = 0;
        Vec<D> value{};
    };
    double time = 0;
    Vec<D> value{};
    Between next = Between::linear;
    Vec<D> arriving{}, leaving{};                      // derivatives by time
    Handle before{}, after{};                          // absolute times and values
    std::array<double, 4> easing{0.25, 0.1, 0.25, 1};  // as of CubicBezierEasing::make
};

// What holds before the first key and after the last one.
enum class BeyondKeys { hold, repeat, mirror };

// Key frames that were checked; const and safe to share.
//   const auto track = *Track<1>::make({{.time = 0, .value = {{0}}, .next = Between::step}, {.time = 1,
//   ..}});
template <int D>
class Track {
public:
    // Keys in the order of time. Refuses, by "keys[i]", none at all, times that do not increase, numbers that
    // are not finite, handles whose time is not between that of their keys, easings that are no functions.
    static Result<Track> make(std::vector<Key<D>> keys, BeyondKeys outside = BeyondKeys::hold);

    const std::vector<Key<D>>& keys() const { return keys_; }
    Interval times() const { return {keys_.front().time, keys_.back().time}; }

    // At a time, by the last key that is not after it; at keys exactly their value. `bounds`, unless empty:
    // how far a coordinate may be off from that at the time, or, where times repeat, at the rounded time
    // within the keys. NaN and infinite times give NaN. REQUIRES spans of equal size.
    void evaluate(std::span<const double> times, std::span<Vec<D>> out, std::span<double> bounds = {}) const;
    Vec<D> operator()(double time) const;

    // The same as a spline of degree 3 over time, off by the rounding of its control points. Refuses
    // (unsupported), by "keys[i]", what is no polynomial of time: steps, Bezier curves and easings; (invalid)
    // a single key.
    Result<Curve<Vec<D>>> curve() const;

private:
    Track(std::vector<Key<D>> keys, BeyondKeys outside) : keys_(std::move(keys)), outside_(outside) {}
    std::vector<Key<D>> keys_;
    BeyondKeys outside_;
};

// Derivatives of the keys from their neighbours, and `hermite` between them: those of Kochanek and Bartels,
// of which all zeros (the default) are Catmull and Rom's (P[i+1] - P[i-1]) / (t[i+1] - t[i-1]). Where times
// are not equally far apart they are scaled by 2 / (t[i+1] - t[i-1]), so that without `continuity` the speed
// does not jump. At the ends the missing slope is that of the other side. One setting for each key, or one
// for all; REQUIRES that, and times that increase. Source: [Kochanek and Bartels 1984].
template <int D>
void set_tangents(std::span<Key<D>> keys, std::span<const TensionContinuityBias> settings = {});

}  // namespace freiform

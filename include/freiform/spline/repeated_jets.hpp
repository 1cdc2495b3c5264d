// Derivatives of a surface at many places whose parameters repeat, as where boxes are halved.
#pragma once
#include <freiform/spline/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace freiform {

// Bit for bit what `jet` says. Of B-splines up to degree 3 the weights of a parameter are kept for the next
// place that has it. For one thread; the surface must outlive it.
#if defined(__wasm__)  // for size
class RepeatedJets {
public:
    RepeatedJets(const SurfaceGeometry& surface, std::size_t) : surface_(surface) {}
    template <int K>
    Jet<2, K, Vec<3>> at(const Param<2>& uv) {
        return jet<K>(surface_, uv);
    }

private:
    const SurfaceGeometry& surface_;
};
#else
class RepeatedJets {
public:
    // About so many places will be asked for: that many parameters are kept.
    RepeatedJets(const SurfaceGeometry& surface, std::size_t places);
    // K = 1, 2.
    template <int K>
    Jet<2, K, Vec<3>> at(const Param<2>& uv);

private:
    struct Weights {
        std::uint64_t at;  // the bits of the parameter
        int first;         // of the coefficients
        double of_order[3][4];
    };
    template <class S>
    const Weights& weights(const S& surface, std::size_t axis, double x);

    const SurfaceGeometry* surface_;
    std::vector<Weights> kept_[2];  // by the bits of the parameter
};
#endif

}  // namespace freiform

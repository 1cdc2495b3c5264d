// Any bytes as a .gltf or .glb file: its animations are read or refused; what is read can be evaluated at any
// time.
#include "bytes.hpp"

#include <freiform/io/gltf_animation.hpp>

#include <algorithm>
#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace freiform;
    const auto animations = read_gltf_animations({reinterpret_cast<const char*>(data), size});
    if (!animations) return demand(!animations.error().message.empty()), 0;
    std::size_t asked = 0;
    for (const GltfAnimation& a : *animations)
        for (const GltfChannel& c : a.channels) {
            demand(!c.times.empty() && c.components > 0 &&
                   std::ranges::is_sorted(c.times, std::less_equal<>()));
            const std::size_t each = c.interpolation == GltfInterpolation::cubic_spline ? 3 : 1;
            demand(c.values.size() == each * c.components * c.times.size());
            std::vector<double> out(c.components);
            for (const double t :
                 {-1e300, c.times.front(), (c.times.front() + c.times.back()) / 2, c.times.back(), 1e300}) {
                if ((asked += out.size()) > 1'000'000) return 0;
                evaluate(c, t, out);
                for (const double x : out) demand(std::isfinite(x));
            }
        }
    return 0;
}

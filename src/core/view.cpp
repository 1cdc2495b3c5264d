#include <freiform/core/decimal.hpp>
#include <freiform/core/view.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace freiform {

Result<View> parse_view(std::string_view words) {
    constexpr double kRight = std::numbers::pi / 2;
    constexpr std::array<std::pair<std::string_view, View>, 7> kViews{{{"iso", {}},
                                                                       {"front", {-kRight, 0}},
                                                                       {"back", {kRight, 0}},
                                                                       {"left", {2 * kRight, 0}},
                                                                       {"right", {0, 0}},
                                                                       {"top", {-kRight, kRight}},
                                                                       {"bottom", {-kRight, -kRight}}}};
    for (const auto& [name, view] : kViews)
        if (words == name) return view;
    const ScannedReal azimuth = scan_real(words);
    if (azimuth.length > 0 && words.substr(azimuth.length).starts_with(',')) {
        const std::string_view rest = words.substr(azimuth.length + 1);
        const ScannedReal elevation = scan_real(rest);
        if (elevation.length > 0 && elevation.length == rest.size() && std::abs(azimuth.value) <= 360 &&
            std::abs(elevation.value) <= 90)
            return View{azimuth.value * kRight / 90, elevation.value * kRight / 90};
    }
    return refuse(RefusalKind::invalid, "view",
                  text("\"", words,
                       "\"; expected iso, front, back, left, right, top, bottom or AZIMUTH,ELEVATION in "
                       "degrees (-360 to 360, -90 to 90)"));
}

}  // namespace freiform

#include <freiform/core/view.hpp>

#include <array>
#include <charconv>
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
    View view;
    const char *at = words.data(), *end = at + words.size();
    const auto azimuth = std::from_chars(at, end, view.azimuth);
    if (azimuth.ec == std::errc() && azimuth.ptr != end && *azimuth.ptr == ',') {
        const auto elevation = std::from_chars(azimuth.ptr + 1, end, view.elevation);
        if (elevation.ec == std::errc() && elevation.ptr == end && std::abs(view.azimuth) <= 360 &&
            std::abs(view.elevation) <= 90)
            return View{view.azimuth * kRight / 90, view.elevation * kRight / 90};
    }
    return refuse(RefusalKind::invalid, "view",
                  text("\"", words,
                       "\"; expected iso, front, back, left, right, top, bottom or AZIMUTH,ELEVATION in "
                       "degrees (-360 to 360, -90 to 90)"));
}

}  // namespace freiform

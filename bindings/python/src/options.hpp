// Options that Python gives by name.
#pragma once

#include "handles.hpp"

#include <freiform/colour/gradient.hpp>
#include <freiform/core/view.hpp>

#if FREIFORM_HAS_GL
#include <freiform/gpu/render.hpp>
#endif

namespace freiform::python {

// The options that were given, by name; others are refused.
class Given {
public:
    explicit Given(const py::dict& d) : all_(d) {}
    template <class T>
    void read(const char* name, T& to) {
        known_.push_back(name);
        if (!all_.contains(name) || all_[name].is_none()) return;
        const py::handle value = all_[name];
        try {
            if constexpr (std::is_enum_v<T>)
                to = enum_of<T>(value.cast<std::string>(), name);
            else if constexpr (is_form<T, std::optional>)
                to = value.cast<typename T::value_type>();
            else
                to = value.cast<T>();
        } catch (const py::cast_error&) {
            reject(RefusalKind::invalid, name, text("cannot be ", std::string(py::repr(value))));
        }
    }
    void read_view(std::optional<View>& to) {
        known_.push_back("view");
        if (all_.contains("view") && !all_["view"].is_none())
            to = take(parse_view(all_["view"].cast<std::string>()));
    }
    void finish() const {
        for (const auto& item : all_) {
            const auto name = item.first.cast<std::string>();
            if (std::ranges::find(known_, name) == known_.end())
                reject(RefusalKind::invalid, name, "is no option" + did_you_mean(name, known_));
        }
    }

private:
    py::dict all_;
    std::vector<std::string_view> known_;
};

#if FREIFORM_HAS_GL
inline RenderOptions render_options(const py::dict& given) {
    RenderOptions o;
    Given g(given);
    std::optional<View> view;
    std::pair<double, double> range{o.range.lo, o.range.hi};
    std::string colour;
    g.read("width", o.width), g.read("height", o.height), g.read_view(view);
    g.read("perspective", o.perspective), g.read("outlines", o.outlines), g.read("edges", o.edges);
    g.read("zebra", o.zebra), g.read("isophotes", o.isophotes), g.read("painting", o.painting);
    g.read("range", range), g.read("supersampling", o.supersampling), g.read("margin", o.margin);
    g.read("colour", colour);
    g.finish();
    if (view) o.view = *view;
    if (!colour.empty()) o.colour = take(colour_named(colour));
    o.range = interval_of(range);
    return o;
}

inline py::array_t<unsigned char> picture_of(const Image& image) {
    py::array_t<unsigned char> a({image.height, image.width, 3});
    std::memcpy(a.mutable_data(), image.rgb.data(), image.rgb.size());
    return a;
}
#endif

}  // namespace freiform::python

// How the jumps of joints are written: orders, numbers and units.
#pragma once
#include <freiform/core/decimal.hpp>
#include <freiform/core/text.hpp>
#include <freiform/io/document.hpp>

#include <string>

namespace freiform::cli {

inline std::string unit_of(const Document& d) { return d.unit.empty() ? "unit" : d.unit; }
// Of the jump of a derivative by the parameter t, or by arc length.
inline std::string c_unit(const Document& d, int order) {
    return order == 0 ? unit_of(d) : order == 1 ? text(unit_of(d), "/t") : text(unit_of(d), "/t^", order);
}
inline std::string g_unit(const Document& d, int order) {
    return order == 0   ? unit_of(d)
           : order == 1 ? "rad"
           : order == 2 ? text("1/", unit_of(d))
                        : text("1/", unit_of(d), "^", order - 1);
}
inline std::string order_text(char kind, int order) { return order < 0 ? "-" : text(kind, order); }
// Six digits are enough to read; --json has all.
inline std::string rounded(double x) { return rounded_text(x, 6); }

}  // namespace freiform::cli

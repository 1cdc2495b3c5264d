#include <freiform/core/decimal.hpp>
#include <freiform/core/text.hpp>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <vector>

namespace freiform {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max(),
                 kLeast = std::numeric_limits<double>::denorm_min();

std::string fixed_text(const Decimal& d) {
    std::string s;
    append_fixed(s, d);
    return s;
}
std::string scientific_text(const Decimal& d) {
    std::string s;
    append_scientific(s, d);
    return s;
}

template <class T, class... Format>
std::string of_standard_library(T x, Format... format) {
    char buffer[400];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, x, format...).ptr};
}

// Of all sizes, of those that people write, whole ones beyond 2^53, and the ends of binades.
std::vector<double> numbers(int n) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<double> out{0.0,
                            -0.0,
                            1.0,
                            0.5,
                            9.5,
                            99.95,
                            1e21,
                            1e22,
                            1e23,
                            123456789012345680.0,
                            kLargest,
                            kLeast,
                            std::numeric_limits<double>::min(),
                            9007199254740993.0,
                            5e-324,
                            2e-323};
    for (int i = 0; i < n; ++i) {
        const double x = std::bit_cast<double>(random());
        if (std::isfinite(x)) out.push_back(x);
        out.push_back(unit(random) * std::pow(10.0, i % 40 - 12));
        out.push_back(std::round(unit(random) * 1e6) / std::pow(10.0, i % 9));
        out.push_back(std::round(std::ldexp(unit(random), 40 + i % 40)));
        out.push_back(std::ldexp(1.0, i % 2098 - 1074));
    }
    return out;
}

TEST(Decimal, texts_of_numbers_are_those_of_the_standard_library) {
    for (const double x : numbers(20'000)) {
        ASSERT_EQ(text(x), of_standard_library(x));
        ASSERT_EQ(scientific_text(shortest_decimal(x)),
                  of_standard_library(x, std::chars_format::scientific));
        if (std::abs(x) < 9007199254740992.0)  // beyond, it writes more digits than tell x
            ASSERT_EQ(fixed_text(shortest_decimal(x)), of_standard_library(x, std::chars_format::fixed));
    }
    EXPECT_EQ(text(HUGE_VAL, " ", -HUGE_VAL, " ", std::nan(""), " ", -std::nan("")), "inf -inf nan -nan");
}

TEST(Decimal, texts_of_floats_are_those_of_the_standard_library) {
    std::mt19937 random(8);
    for (int i = 0; i < 20'000; ++i) {
        const auto x = std::bit_cast<float>(std::uint32_t(random()));
        if (std::isfinite(x)) ASSERT_EQ(text(x), of_standard_library(x));
    }
    for (const float x :
         {0.0f, -0.0f, 0.1f, 16777216.0f, 1e-45f, std::numeric_limits<float>::max(), HUGE_VALF})
        EXPECT_EQ(text(x), of_standard_library(x));
}

TEST(Decimal, is_rounded_to_the_nearest) {
    const auto three = [](double x) { return fixed_text(rounded(shortest_decimal(x), 3)); };
    EXPECT_EQ(three(1.2344), "1.23");
    EXPECT_EQ(three(-1.235), "-1.24");
    EXPECT_EQ(three(1.225), "1.22");
    EXPECT_EQ(three(1.2251), "1.23");
    EXPECT_EQ(three(99.95), "100");
    EXPECT_EQ(three(0.0009996), "0.001");
    EXPECT_EQ(three(1.001), "1");
    EXPECT_EQ(three(0), "0");
    EXPECT_EQ(three(12), "12");
    for (const double x : numbers(20'000))
        for (const int digits : {1, 6, 12}) {
            const Decimal d = rounded(shortest_decimal(x), digits);
            const double y = std::strtod(scientific_text(d).c_str(), nullptr);
            ASSERT_LE(d.size, digits);
            if (std::abs(x) > 1e-290 && std::isfinite(y))
                ASSERT_LE(std::abs(y - x),
                          0.50001 * std::pow(10.0, d.exponent - digits) + 1e-15 * std::abs(x))
                    << text(x, " ", digits);
        }
}

TEST(Decimal, a_power_of_ten_is_written_where_zeros_would_pretend) {
    EXPECT_EQ(rounded_text(123456.4, 6), "123456");
    EXPECT_EQ(rounded_text(1234567, 6), "1.23457e+06");
    EXPECT_EQ(rounded_text(999999.9, 6), "1e+06");
    EXPECT_EQ(rounded_text(0.00012345678, 6), "0.000123457");
    EXPECT_EQ(rounded_text(0.000012, 6), "1.2e-05");
    EXPECT_EQ(rounded_text(-0.0, 6), "-0");
    EXPECT_EQ(rounded_text(HUGE_VAL, 6), "inf");
    // Where no half is in play it is what printf writes.
    for (const double x : numbers(5'000)) {
        if (x == std::round(x)) continue;
        char buffer[40];
        std::snprintf(buffer, sizeof buffer, "%.6g", x);
        const double theirs = std::strtod(buffer, nullptr);
        if (std::abs(x - theirs) < 0.499 * std::pow(10.0, shortest_decimal(theirs).exponent - 6))
            ASSERT_EQ(rounded_text(x, 6), buffer);
    }
}

TEST(ScanReal, reads_back_what_was_written) {
    for (const double x : numbers(20'000))
        for (const std::string& s : {text(x), scientific_text(shortest_decimal(x))}) {
            const ScannedReal back = scan_real(s);
            ASSERT_EQ(back.length, s.size()) << s;
            ASSERT_EQ(std::bit_cast<std::uint64_t>(back.value), std::bit_cast<std::uint64_t>(x)) << s;
        }
}

// More digits than a double has, halves between two doubles among them.
TEST(ScanReal, rounds_as_the_standard_library_does) {
    std::mt19937_64 random(9);
    for (int i = 0; i < 20'000; ++i) {
        std::string s;
        const int before = int(random() % 25), behind = int(random() % 25);
        for (int k = 0; k < before; ++k) s += char('0' + random() % 10);
        if (behind > 0) s += '.';
        for (int k = 0; k < behind; ++k) s += char('0' + random() % 10);
        if (before + behind == 0) s = "7";
        if (i % 3 > 0) s += text(i % 2 ? "e" : "E", int(random() % 640) - 320);
        const double expected = std::strtod(s.c_str(), nullptr);
        ASSERT_EQ(scan_real(s).value, expected) << s;
        ASSERT_EQ(scan_real(s).length, s.size()) << s;
    }
    EXPECT_EQ(scan_real("9007199254740993").value, 9007199254740992.0);
    EXPECT_EQ(scan_real("9007199254740993.00000000000000000000001").value, 9007199254740994.0);
}

TEST(ScanReal, takes_the_number_at_the_beginning) {
    const auto length = [](std::string_view s) { return scan_real(s).length; };
    EXPECT_EQ(length("1.5,2"), 3u);
    EXPECT_EQ(length("1.5e"), 3u);
    EXPECT_EQ(length("1.5e+x"), 3u);
    EXPECT_EQ(length("-.5"), 3u);
    EXPECT_EQ(length("5."), 2u);
    EXPECT_EQ(length("0x10"), 1u);
    for (const char* none : {"", "-", "+1", ".", "-.", "e5", "inf", "-inf", "nan", "infinity", " 1"})
        EXPECT_EQ(length(none), 0u) << none;
}

TEST(ScanReal, beyond_doubles_are_infinities_and_zeros) {
    const std::string zeros(400, '0');
    for (const std::string& large : {std::string("1e309"), "1" + zeros, "0." + zeros + "1e800",
                                     std::string("12345678901234567890e300")}) {
        EXPECT_EQ(scan_real(large).value, HUGE_VAL) << large;
        EXPECT_EQ(scan_real("-" + large).value, -HUGE_VAL) << large;
    }
    for (const std::string& small : {std::string("1e-400"), "0." + zeros + "1", "1" + zeros + "e-800"}) {
        EXPECT_EQ(scan_real(small).value, 0) << small;
        EXPECT_EQ(scan_real(small).length, small.size());
        EXPECT_TRUE(std::signbit(scan_real("-" + small).value)) << small;
    }
    EXPECT_EQ(scan_real("0e99999999999999999999").value, 0);
    EXPECT_EQ(scan_real("1e-310").value, 1e-310);
}

}  // namespace
}  // namespace freiform

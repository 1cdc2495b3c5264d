// Is this an AddressSanitizer build? Its shadow memory breaks every limit on memory that a test could set,
// and it takes some ten times as long.
#pragma once

namespace freiform::test {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kAddressSanitizer = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool kAddressSanitizer = true;
#else
inline constexpr bool kAddressSanitizer = false;
#endif
#else
inline constexpr bool kAddressSanitizer = false;
#endif

// How many random cases: there, a tenth of them. What is right is judged by the other builds, with all of
// them.
constexpr int cases(int n) { return kAddressSanitizer ? n / 10 : n; }

}  // namespace freiform::test

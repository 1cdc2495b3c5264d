// What somebody meant who wrote a word that does not exist.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace freiform {

// The candidate nearest to `word` (fewest letters changed, left out, added or swapped), if at most a third of
// its letters differ; else empty.
std::string_view closest(std::string_view word, std::span<const std::string_view> candidates);

// "; did you mean \"knots\"?" or nothing: to be put behind a message about `word`.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

// "a, b or c".
std::string listed(std::span<const std::string_view> words);

}  // namespace freiform

#include <freiform/core/spelling.hpp>
#include <freiform/core/text.hpp>

#include <algorithm>
#include <vector>

namespace freiform {

namespace {

// Levenshtein's distance, with a swap of neighbours as one step. Words beyond 64 letters are not compared.
std::size_t distance(std::string_view a, std::string_view b) {
    if (a.size() > 64 || b.size() > 64) return 64;
    const std::size_t n = b.size() + 1;
    std::vector<std::size_t> d((a.size() + 1) * n);
    for (std::size_t i = 0; i <= a.size(); ++i)
        for (std::size_t j = 0; j <= b.size(); ++j) {
            std::size_t& x = d[i * n + j];
            if (i == 0 || j == 0) {
                x = i + j;
                continue;
            }
            x = std::min({d[(i - 1) * n + j] + 1, d[i * n + j - 1] + 1,
                          d[(i - 1) * n + j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                x = std::min(x, d[(i - 2) * n + j - 2] + 1);
        }
    return d.back();
}

}  // namespace

std::string_view closest(std::string_view word, std::span<const std::string_view> candidates) {
    std::string_view best;
    std::size_t least = 64;
    for (const std::string_view c : candidates)
        if (const std::size_t d = distance(word, c); d < least) {
            least = d;
            best = c;
        }
    return 3 * least <= std::max(word.size(), best.size()) ? best : std::string_view();
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
    const std::string_view best = closest(word, candidates);
    return best.empty() ? std::string() : text("; did you mean \"", best, "\"?");
}

std::string listed(std::span<const std::string_view> words) {
    std::string s;
    for (std::size_t i = 0; i < words.size(); ++i)
        s += text(i == 0 ? "" : i + 1 == words.size() ? " or " : ", ", words[i]);
    return s;
}

}  // namespace freiform

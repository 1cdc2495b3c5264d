// Texts that somebody damaged: characters changed, some left out.
#pragma once
#include <random>
#include <string>

namespace freiform::test {

// REQUIRES a text that is longer than what is left out.
inline std::string damaged(std::string text, std::mt19937& random) {
    for (unsigned k = random() % 3 + 1; k > 0; --k)
        if (random() % 2)
            text[random() % text.size()] = "0123456789.-e \n#\xFF"[random() % 17];
        else
            text.erase(random() % text.size(), 1 + random() % 5);
    return text;
}

}  // namespace freiform::test

// One curve and its parameters as plain text, so that programs that link different libraries answer the same
// question.
//
//     degree n rational(0|1)    then n + degree + 1 knots, n pairs (weight * x, weight), a count, the
//     parameters
//
// all as hexadecimal doubles, white space between them. The answer: one line for each parameter.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace freiform::bench {

struct CurveValues {
    int degree = 0, rational = 0;
    std::vector<double> knots, x, w, at;  // x: weight times coordinate

    bool is_bezier() const {
        return int(x.size()) == degree + 1 && knots.front() == 0 && knots.back() == 1 && degree > 0;
    }
};

inline double next_number() {
    char word[64];
    if (std::scanf("%63s", word) != 1) {
        std::fprintf(stderr, "the input ends too early\n");
        std::exit(2);
    }
    return std::strtod(word, nullptr);
}

inline CurveValues read_curve() {
    CurveValues c;
    c.degree = int(next_number());
    const int n = int(next_number());
    c.rational = int(next_number());
    for (int i = 0; i < n + c.degree + 1; ++i) c.knots.push_back(next_number());
    for (int i = 0; i < n; ++i) {
        c.x.push_back(next_number());
        c.w.push_back(next_number());
    }
    const int count = int(next_number());
    for (int i = 0; i < count; ++i) c.at.push_back(next_number());
    return c;
}

}  // namespace freiform::bench

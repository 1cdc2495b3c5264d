#include "program.hpp"
#include "signals.hpp"

#include <algorithm>

int main(int argc, char** argv) {
    freiform::cli::catch_signals();
    return freiform::cli::run({argv + std::min(argc, 1), argv + argc});
}

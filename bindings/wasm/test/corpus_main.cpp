// Runs the C++ tests as a module (corpus.js calls it).
#include <cstdlib>
#include <gtest/gtest.h>

// Debian's library of builtins was compiled with a guard of the stack, which has no home here.
extern "C" {
extern const unsigned long __stack_chk_guard;
const unsigned long __stack_chk_guard = 0x5afe57ac;
[[noreturn]] void __stack_chk_fail() { std::abort(); }
}

int main(int count, char** arguments) {
    testing::InitGoogleTest(&count, arguments);
    return RUN_ALL_TESTS();
}

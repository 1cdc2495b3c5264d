// Prepared patches, and every variant of the kernels.
#pragma once
#include <freiform/spline/prepared.hpp>

#include <gtest/gtest.h>
#include <kernel/evaluate.hpp>

namespace freiform::test {

// Runs `check` with every variant that this machine has.
template <class F>
void with_every_variant(F&& check) {
    kernel::Variant all[8];
    const int count = kernel::variants(all, 8);
    const kernel::Kernels& before = kernel::kernels();
    int ran = 0;
    for (int i = 0; i < count; ++i) {
        if (!all[i].runs_here) continue;
        SCOPED_TRACE(all[i].kernels->name);
        kernel::choose(*all[i].kernels);
        check();
        ++ran;
    }
    kernel::choose(before);
    EXPECT_GE(ran, 1);
}

template <std::size_t N, class P>
PreparedPatch<N, P> prepared(const Patch<N, P>& patch) {
    auto made = PreparedPatch<N, P>::make(patch);
    EXPECT_TRUE(made) << made.error().message;
    return *made;
}

}  // namespace freiform::test

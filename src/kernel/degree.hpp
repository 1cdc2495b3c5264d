// The one switch on the degree: loops over it unroll where it is one of the common ones. Called once for a
// batch, never for a point.
#pragma once

namespace freiform::kernel {

template <int P>
struct Degree {
    static constexpr int kStatic = P;  // -1: known at run time only
};

// f(Degree<p>{}) for the degrees that models have, f(Degree<-1>{}) for the others.
template <class F>
__attribute__((always_inline)) inline void with_degree(int p, F&& f) {
    switch (p) {
        case 2:
            return f(Degree<2>{});
        case 3:
            return f(Degree<3>{});
#if !defined(__wasm__)  // modules are to be small
        case 1:
            return f(Degree<1>{});
        case 5:
            return f(Degree<5>{});
#endif
        default:
            return f(Degree<-1>{});
    }
}

}  // namespace freiform::kernel

#include "refine_detail.hpp"

namespace freiform {

#define FF_REFINE(N, P)                                                           \
    template Result<Reduced<N, P>> remove_knots(const Patch<N, P>&, int, double); \
    template Result<Reduced<N, P>> reduce_degree(const Patch<N, P>&, int, double);
#define FF_REFINE_ALL(D) \
    FF_REFINE(1, Vec<D>) \
    FF_REFINE(1, Hom<D>) \
    FF_REFINE(2, Vec<D>) \
    FF_REFINE(2, Hom<D>) \
    FF_REFINE(3, Vec<D>) \
    FF_REFINE(3, Hom<D>)
FF_REFINE_ALL(1)
FF_REFINE_ALL(2)
FF_REFINE_ALL(3)
FF_REFINE_ALL(4)

}  // namespace freiform

#include "patch_detail.hpp"

namespace freiform {

FF_INSTANTIATE_PATCHES(2, 1)
FF_INSTANTIATE_PATCHES(2, 2)
FF_INSTANTIATE_PATCHES(2, 3)
FF_INSTANTIATE_PATCHES(2, 4)

}  // namespace freiform

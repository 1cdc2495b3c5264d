#include "patch_detail.hpp"

namespace freiform {

FF_INSTANTIATE_PATCHES(3, 1)
FF_INSTANTIATE_PATCHES(3, 2)
FF_INSTANTIATE_PATCHES(3, 3)
FF_INSTANTIATE_PATCHES(3, 4)

}  // namespace freiform

// Four lanes: AVX2. The only unit that is compiled for it (CMakeLists.txt); see lanes.h for what that asks of it.
#if defined(__AVX2__)

#include "model/rigid/kernels_of_lanes.h"

namespace topple::rigid {

const LaneKernels& four_lanes() { return kKernels<4>; }

}  // namespace topple::rigid

#endif

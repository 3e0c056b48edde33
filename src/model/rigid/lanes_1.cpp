// One lane: plain numbers, for processors that have nothing else, and to compare with. The page's engine has two lanes and no choice.
#if !defined(__wasm__)

#include "model/rigid/kernels_of_lanes.h"

namespace topple::rigid {

const LaneKernels& one_lane() { return kKernels<1>; }

}  // namespace topple::rigid

#endif

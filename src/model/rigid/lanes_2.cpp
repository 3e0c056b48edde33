// Two lanes: SSE2, NEON, 128 bits of WebAssembly; what every processor has that we build for.
#include "model/rigid/kernels_of_lanes.h"

namespace topple::rigid {

const LaneKernels& two_lanes() { return kKernels<2>; }

}  // namespace topple::rigid

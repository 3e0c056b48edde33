#include "model/rigid/lane_kernels.h"

namespace topple::rigid {

// Each in its own unit.
const LaneKernels& one_lane();
const LaneKernels& two_lanes();
const LaneKernels& four_lanes();

namespace {

#if defined(TOPPLE_FOUR_LANES)
bool has_four() { return __builtin_cpu_supports("avx2") != 0; }
#endif

}  // namespace

const LaneKernels* lane_kernels(int lanes) {
#if defined(TOPPLE_FOUR_LANES)
  if ((lanes == 0 || lanes == 4) && has_four()) return &four_lanes();
#endif
  if (lanes == 0 || lanes == 2) return &two_lanes();
#if !defined(__wasm__)
  if (lanes == 1) return &one_lane();
#endif
  return nullptr;
}

}  // namespace topple::rigid

#include "model/rigid/lane_kernels.h"

#include <vector>

namespace topple::rigid {

// Each in its own unit.
const LaneKernels& one_lane();
const LaneKernels& two_lanes();
const LaneKernels& four_lanes();

bool has_four_lanes() {
#if defined(TOPPLE_FOUR_LANES)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

const LaneKernels* lane_kernels(int lanes, [[maybe_unused]] bool four) {
#if defined(TOPPLE_FOUR_LANES)
  if ((lanes == 0 || lanes == 4) && four) return &four_lanes();
#endif
  if (lanes == 0 || lanes == 2) return &two_lanes();
#if !defined(__wasm__)
  if (lanes == 1) return &one_lane();
#endif
  return nullptr;
}

std::string no_such_lanes(int lanes, bool four) {
  std::vector<int> all;
  for (const int some : {1, 2, 4}) {
    if (lane_kernels(some, four) != nullptr) all.push_back(some);
  }
  std::string allowed;
  for (std::size_t i = 0; i < all.size(); ++i) {
    allowed += (i == 0 ? "" : i + 1 < all.size() ? ", " : " or ") + std::to_string(all[i]);
  }
  return "lanes: " + std::to_string(lanes) + " is not a number of lanes that this processor has; it must be " + allowed +
         ", or be left out for as many as it has.";
}

}  // namespace topple::rigid

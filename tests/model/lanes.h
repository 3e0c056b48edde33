/// What tests of kernels in lanes share.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/rigid/lane_kernels.h"

namespace topple::rigid {

/// Those that this processor has, the least number of lanes first.
inline std::vector<const LaneKernels*> all_lanes() {
  std::vector<const LaneKernels*> all;
  for (const int lanes : {1, 2, 4}) {
    if (const LaneKernels* kernels = lane_kernels(lanes)) all.push_back(kernels);
  }
  return all;
}

/// Numbers from -1 to 1 with all their bits, always the same ones.
class Numbers {
 public:
  double next() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return 2.0 * (static_cast<double>(state_ >> 11) / 9007199254740992.0) - 1.0;
  }
  Vec3 vector() { return {next(), next(), next()}; }

 private:
  std::uint64_t state_ = 1;
};

/// To the last bit.
inline bool same_bits(const double* a, const double* b, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
  }
  return true;
}

}  // namespace topple::rigid

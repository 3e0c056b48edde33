/// Random numbers that are the same on every machine.
#pragma once

#include <cstdint>

namespace topple {

/// SplitMix64 [Steele2014]: one 64-bit state, passes BigCrush, and any seed is a good one.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits();
  double uniform();  ///< In (0, 1), never an end.
  double normal();   ///< Mean 0, standard deviation 1 (Box and Muller).

 private:
  std::uint64_t state_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace topple

/// The chained hash of a run: order matters, and a difference in the last bit of one number changes everything after it.
#pragma once

#include <bit>
#include <cstdint>

namespace topple {

class Hash {
 public:
  constexpr void add(std::uint64_t word) {
    value_ = (value_ ^ word) * 0x9E3779B97F4A7C15ULL;
    value_ ^= value_ >> 29;
  }
  constexpr void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  constexpr std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0x243F6A8885A308D3ULL;
};

}  // namespace topple

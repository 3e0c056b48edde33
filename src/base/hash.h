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

/// Three numbers mixed into one word, to be chained: the multiplications of many bricks then go on side by side.
constexpr std::uint64_t mixed(std::uint64_t first, double second, double third) {
  const std::uint64_t a = std::bit_cast<std::uint64_t>(second) * 0xBF58476D1CE4E5B9ULL;
  const std::uint64_t b = std::bit_cast<std::uint64_t>(third) * 0x94D049BB133111EBULL;
  return (a ^ (a >> 31)) + std::rotl(b ^ (b >> 29), 23) + first * 0x9E3779B97F4A7C15ULL;
}

}  // namespace topple

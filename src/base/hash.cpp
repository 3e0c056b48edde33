#include "base/hash.h"

#include "topple/base.h"

namespace topple {

std::string hash_digits(std::uint64_t hash) {
  std::string digits(16, '0');
  for (std::size_t i = digits.size(); i-- > 0; hash /= 16) digits[i] = "0123456789abcdef"[hash % 16];
  return digits;
}

}  // namespace topple

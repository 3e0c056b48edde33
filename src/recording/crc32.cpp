#include "recording/crc32.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace topple {
namespace {

// Eight tables: table k says what a byte does to the check when k more bytes follow it, so that eight bytes go at a time.
static_assert(std::endian::native == std::endian::little, "eight bytes are read as one number, the first one lowest");
using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr Tables make_tables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest & 1U) != 0 ? 0xEDB88320U ^ (rest >> 1) : rest >> 1;
    tables[0][byte] = rest;
  }
  for (std::size_t k = 1; k < 8; ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) tables[k][byte] = tables[0][tables[k - 1][byte] & 255U] ^ (tables[k - 1][byte] >> 8);
  }
  return tables;
}

constexpr Tables kTables = make_tables();

}  // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t check = 0xFFFFFFFFU;
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    std::uint64_t eight;
    std::memcpy(&eight, bytes.data() + i, sizeof eight);
    eight ^= check;
    check = 0;
    for (std::size_t k = 0; k < 8; ++k) check ^= kTables[7 - k][(eight >> (8 * k)) & 255U];
  }
  for (; i < bytes.size(); ++i) check = kTables[0][(check ^ bytes[i]) & 255U] ^ (check >> 8);
  return ~check;
}

}  // namespace topple

/// The check of a piece: CRC-32 as zlib and PNG have it.
#pragma once

#include <cstdint>
#include <span>

namespace topple {

std::uint32_t crc32(std::span<const std::uint8_t> bytes);

}  // namespace topple

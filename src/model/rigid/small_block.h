/// Small columns and blocks of numbers: what belongs to one brick, and what couples two.
#pragma once

#include <array>
#include <cstddef>

namespace topple::rigid {

template <int N>
using Column = std::array<double, static_cast<std::size_t>(N)>;

/// Three by three, row by row; of each row the fourth number only fills a register. Plain arrays, for what lanes.h says.
struct PlaneBlock {
  alignas(32) double row[3][4];
};

}  // namespace topple::rigid

/// The code of free knots that are whole multiples of FreeSteps.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "topple/recording.h"

namespace topple::free_code {

/// No knot takes more bytes.
inline constexpr std::size_t kMostBytes = 48;

/// Writes the knots to `out`, which has room for kMostBytes each, and moves it behind them. False where one cannot be coded: then
/// what was written means nothing. The last knot comes first, so that it is read without the others.
bool put(std::span<const FreeKnot> knots, std::uint8_t*& out);

/// The knots that put() wrote.
void get(const std::uint8_t* code, std::span<FreeKnot> knots);
FreeKnot get_last(const std::uint8_t* code);

}  // namespace topple::free_code

/// Values that JSON has no word for.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

#include "topple/base.h"

namespace topple::app {

/// Null where a number is not finite.
inline nlohmann::ordered_json number_json(double number) {
  return std::isfinite(number) ? nlohmann::ordered_json(number) : nlohmann::ordered_json(nullptr);
}

/// Null for no brick.
inline nlohmann::ordered_json brick_json(BrickId brick) {
  return brick == kNoBrick ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(brick);
}

}  // namespace topple::app

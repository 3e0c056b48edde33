/// What a run was, as lines for people and as one JSON object for programs (docs/run.md).
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "topple/recording.h"

namespace topple::app {

/// What this process has used so far.
struct Cost {
  double wall = 0.0;              ///< Since the program began [s].
  double cpu = 0.0;               ///< User and system time of all threads [s].
  std::uint64_t peak_memory = 0;  ///< Resident at most [bytes].
};
Cost cost_so_far();

nlohmann::ordered_json summary_json(const Recording& recording);
std::string summary_text(const Recording& recording);

}  // namespace topple::app

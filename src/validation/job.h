/// One run of one scene, and the numbers that are taken from it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "topple/base.h"

namespace topple::validation {

struct Job {
  std::string scene_text;
  std::string scene;                   ///< For messages.
  std::vector<std::string> overrides;  ///< The model among them; {x} stands for what `least` seeks.
  double from = 0.2, to = 0.8;
  int window = 1;
  double until = 0.0;         ///< [s]; 0: to the end.
  std::string profile;        ///< Which number of each brick is wanted as well; empty: none.
  std::vector<double> least;  ///< The least {x} between these two at which all bricks fall is sought.

  /// All that decides the outcome, but for the model itself.
  std::uint64_t key() const;
};

/// By name: speed_m_s, tilt_speed_m_s, interval_ms, interval_sd_ms, duration_s, fallen, failed, reached, reached_m, final_tilt_deg,
/// contact_tilt_deg, arrival_ms, landed_ms, least. Not a number where a run has none; only `refused` where the
/// model does not follow such a layout.
struct Outcome {
  std::map<std::string, double> numbers;
  std::vector<double> profile;  ///< Of brick 1, 2, ...
};

/// Runs a job; `stopped` is asked now and then. An interrupted job fails with an empty message.
Result<Outcome> run_job(const Job& job, const std::function<bool()>& stopped);

/// Changes whenever the model gives another motion for a scene that uses friction, restitution, a slippery floor and a bend.
Result<std::uint64_t> fingerprint(const std::string& model);

}  // namespace topple::validation

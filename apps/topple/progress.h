/// How far a long run has come, on standard error.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "topple/run.h"

namespace topple::app {

/// A bar on a terminal, otherwise a plain line every few seconds; nothing for a run that is over in a second.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(const RunProgress& progress);
  void show(std::int64_t done, std::int64_t of, const std::string& noun);  ///< "12 of 100 runs".
  void clear();  ///< Takes the bar away, so that what follows starts on an empty line.

 private:
  using Clock = std::chrono::steady_clock;
  void show(double share, const std::function<std::string(double wall)>& words);

  Clock::time_point start_;
  Clock::time_point next_;
  bool terminal_ = false;
  bool drawn_ = false;
};

}  // namespace topple::app

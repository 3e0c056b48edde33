/// From a series to the runs that it needs, and from finished runs to its numbers.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "validation/job.h"
#include "validation/source.h"

namespace topple::validation {

/// One run that a series needs: for setting s, the i-th x, the k-th repeat.
struct Planned {
  std::string model;
  Job job;
};
/// In the order in which `gather` takes them.
std::vector<Planned> plan(const Series& series);

/// What a series predicts.
struct Prediction {
  bool there = false;  ///< It was run.
  std::vector<double> x;
  std::vector<std::vector<double>> y;       ///< [setting][x]; the mean over the repeats.
  std::vector<std::vector<double>> spread;  ///< [setting][x]; their standard deviation.

  /// Not a number where the series has no such x.
  double at(std::size_t setting, double where) const;
};
Prediction gather(const Series& series, const std::vector<const Outcome*>& outcomes);

}  // namespace topple::validation

/// Verdicts and claims: what predictions say about published points.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "topple/validation.h"
#include "validation/prediction.h"
#include "validation/source.h"

namespace topple::validation {

/// A source with the predictions of its series, in the same order.
struct Judged {
  const Source* source = nullptr;
  std::vector<Prediction> predictions;
  std::vector<Comparison> comparisons;
};

const Prediction* prediction_of(const Judged& judged, const std::string& series);

/// Every compare under every reading, of those whose series was run.
std::vector<Comparison> compare_all(const Judged& judged);

/// Every claim whose series was run; needs the comparisons.
std::vector<ClaimCheck> check_claims(const Judged& judged);

/// A text with its numbers filled in, each from a {...}:
/// {y|SERIES|X}, {change|SERIES|X|SERIES|X} (second over first, in percent), {ratio|...}, {max|SERIES}, {min|SERIES}, {xmax|SERIES},
/// {spread|SERIES|X}; an X may be followed by |DIGITS. Fails on a name that is not there.
Result<std::string> filled(const std::string& text, const Judged& judged);

/// "1.23", "+4.5 %".
std::string percent(double share);

}  // namespace topple::validation

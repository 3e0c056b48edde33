// Claims: statements that we make, each with its tolerance, and whether they hold.
#include <algorithm>
#include <cmath>
#include <limits>

#include "export/gnuplot.h"
#include "validation/judge.h"

namespace topple::validation {
namespace {

const Series& series_of(const Source& source, const std::string& name) {
  return *std::find_if(source.series.begin(), source.series.end(), [&](const Series& one) { return one.name == name; });
}

double standard_value(const Judged& judged, const std::string& name, double x) {
  const Prediction* prediction = prediction_of(judged, name);
  return prediction == nullptr ? std::nan("") : prediction->at(standard_setting(series_of(*judged.source, name)), x);
}

ClaimCheck check_points(const Judged& judged, const Claim& claim) {
  ClaimCheck check{.name = claim.name, .why = claim.why, .found = {}, .holds = true};
  const auto& all = judged.source->points;
  const Points& points = *std::find_if(all.begin(), all.end(), [&](const Points& one) { return one.name == claim.points; });
  double worst = 0.0, where = points.x.front();
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const double deviation = standard_value(judged, claim.series, points.x[i]) / points.y[i] - 1.0;
    if (std::fabs(deviation) <= claim.tolerance && std::fabs(deviation) <= std::fabs(worst)) continue;
    if (!(std::fabs(deviation) <= claim.tolerance)) check.holds = false;
    if (std::isnan(deviation) || std::fabs(deviation) > std::fabs(worst)) {
      worst = deviation;
      where = points.x[i];
    }
    if (std::isnan(deviation)) break;
  }
  check.found = std::to_string(points.x.size()) + (points.x.size() == 1 ? " point: " : " points, the worst ") + percent(worst) + " at " +
                rounded(where, 4) + "; allowed ±" + rounded(100.0 * claim.tolerance, 3) + " %";
  return check;
}

ClaimCheck check_value(const Judged& judged, const Claim& claim) {
  ClaimCheck check{.name = claim.name, .why = claim.why, .found = {}, .holds = false};
  double value = standard_value(judged, claim.series, *claim.x);
  std::string what = rounded(value, 6);
  if (claim.over_x) {
    value /= standard_value(judged, claim.over_series.empty() ? claim.series : claim.over_series, *claim.over_x);
    what = "ratio " + rounded(value, 6);
  }
  if (claim.expect) {
    const double deviation = value / *claim.expect - 1.0;
    check.holds = std::fabs(deviation) <= claim.tolerance;
    check.found = what + ", expected " + rounded(*claim.expect, 6) + ": " + percent(deviation) + "; allowed ±" +
                  rounded(100.0 * claim.tolerance, 3) + " %";
    return check;
  }
  check.holds = !std::isnan(value) && (!claim.low || value >= *claim.low) && (!claim.high || value <= *claim.high);
  check.found = what + "; allowed";
  if (claim.low) check.found += " from " + rounded(*claim.low, 4);
  if (claim.high) check.found += (claim.low ? " to " : " up to ") + rounded(*claim.high, 4);
  return check;
}

ClaimCheck check_verdict(const Judged& judged, const Claim& claim) {
  ClaimCheck check{.name = claim.name, .why = claim.why, .found = "no such comparison", .holds = false};
  for (const Comparison& one : judged.comparisons) {
    if (one.name != claim.compare || one.reading != claim.reading) continue;
    check.found = std::string("verdict: ") + words_of(one.verdict);
    check.holds = words_of(one.verdict) == claim.verdict;
  }
  return check;
}

bool was_run(const Judged& judged, const Claim& claim) {
  if (!claim.verdict.empty()) {
    const auto& compares = judged.source->compares;
    const auto at = std::find_if(compares.begin(), compares.end(), [&](const Compare& one) { return one.name == claim.compare; });
    return prediction_of(judged, at->series) != nullptr;
  }
  return prediction_of(judged, claim.series) != nullptr &&
         (claim.over_series.empty() || prediction_of(judged, claim.over_series) != nullptr);
}

/// The parts of a {...}.
std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char letter : text) {
    if (letter == '|') {
      parts.emplace_back();
    } else {
      parts.back() += letter;
    }
  }
  return parts;
}

/// Fills in one {...}.
class Filler {
 public:
  Filler(const Judged& judged, std::vector<std::string> parts) : judged_(judged), parts_(std::move(parts)) {}

  Result<std::string> fill() {
    const std::string& what = parts_[0];
    const bool two = what == "change" || what == "ratio";
    const std::size_t needed = two ? 5 : what == "y" || what == "spread" ? 3 : 2;
    if (parts_.size() < needed) return failure("{" + what + "} needs " + std::to_string(needed - 1) + " parts");
    if (!known(parts_[1]) || (two && !known(parts_[3]))) return failure("{" + what + "} names a series that is not there: " + parts_[1]);
    if (prediction_of(judged_, parts_[1]) == nullptr || (two && prediction_of(judged_, parts_[3]) == nullptr)) return "(not run)";
    const int digits = parts_.size() > needed ? std::stoi(parts_[needed]) : 3;
    if (two) {
      const double ratio =
          standard_value(judged_, parts_[3], std::stod(parts_[4])) / standard_value(judged_, parts_[1], std::stod(parts_[2]));
      return what == "ratio" ? plain(ratio, digits) : percent(ratio - 1.0);
    }
    if (what == "y") return plain(standard_value(judged_, parts_[1], std::stod(parts_[2])), digits);
    return of_all(what, digits);
  }

 private:
  bool known(const std::string& name) const {
    const auto& series = judged_.source->series;
    return std::any_of(series.begin(), series.end(), [&](const Series& one) { return one.name == name; });
  }

  static std::string plain(double value, int digits) { return std::isnan(value) ? "none (the wave dies)" : rounded(value, digits); }

  Result<std::string> of_all(const std::string& what, int digits) const {
    const Prediction& all = *prediction_of(judged_, parts_[1]);
    const std::size_t standard = standard_setting(series_of(*judged_.source, parts_[1]));
    if (what == "spread") {
      for (std::size_t i = 0; i < all.x.size(); ++i) {
        if (std::fabs(all.x[i] - std::stod(parts_[2])) < 1e-9) return plain(all.spread[standard][i], digits);
      }
      return failure("{spread} names an x that is not there");
    }
    std::size_t low = 0, high = 0;
    const std::vector<double>& y = all.y[standard];
    for (std::size_t i = 0; i < y.size(); ++i) {
      if (y[i] < y[low] || std::isnan(y[low])) low = i;
      if (y[i] > y[high] || std::isnan(y[high])) high = i;
    }
    if (what == "max") return plain(y[high], digits);
    if (what == "min") return plain(y[low], digits);
    if (what == "xmax") return plain(all.x[high], digits);
    if (what == "xmin") return plain(all.x[low], digits);
    return failure("there is no {" + what + "}");
  }

  const Judged& judged_;
  std::vector<std::string> parts_;
};

}  // namespace

std::vector<ClaimCheck> check_claims(const Judged& judged) {
  std::vector<ClaimCheck> checks;
  for (const Claim& claim : judged.source->claims) {
    if (!was_run(judged, claim)) continue;
    checks.push_back(!claim.verdict.empty() ? check_verdict(judged, claim)
                     : claim.points.empty() ? check_value(judged, claim)
                                            : check_points(judged, claim));
  }
  return checks;
}

Result<std::string> filled(const std::string& text, const Judged& judged) {
  std::string out;
  std::size_t from = 0;
  for (std::size_t open = text.find('{'); open != std::string::npos; open = text.find('{', from)) {
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) return failure(judged.source->name + ": a { without its }");
    Result<std::string> value = Filler(judged, parts_of(text.substr(open + 1, close - open - 1))).fill();
    if (!value) return failure(judged.source->name + ": " + value.error().message);
    out += text.substr(from, open - from) + *value;
    from = close + 1;
  }
  return out + text.substr(from);
}

}  // namespace topple::validation

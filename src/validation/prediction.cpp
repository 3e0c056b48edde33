#include "validation/prediction.h"

#include <cmath>
#include <limits>

#include "export/gnuplot.h"

namespace topple::validation {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
  return text;
}

bool is_profile(const Series& series) { return series.take.starts_with("profile_"); }

/// A profile has all its x in one run.
std::size_t runs_along_x(const Series& series) { return is_profile(series) ? 1 : series.x.size(); }

Job make_job(const Series& series, std::size_t setting, std::size_t index, int seed) {
  Job job{.scene_text = series.scene_text, .scene = series.scene, .overrides = {"name=" + series.model}, .from = series.from};
  job.to = series.to;
  job.window = series.window;
  job.until = series.until;
  job.least = series.least;
  if (is_profile(series)) job.profile = series.take;
  const std::vector<double> fixed = setting_values(series, setting);
  for (std::size_t u = 0; u < fixed.size(); ++u) job.overrides.push_back(series.unknowns[u].key + "=" + decimal(fixed[u]));
  for (const std::string& one : series.set) {
    std::string override = replaced(one, "{seed}", std::to_string(seed));
    if (index < series.values.size()) override = replaced(override, "{v}", series.values[index]);
    job.overrides.push_back(series.least.empty() && index < series.values.size() ? replaced(override, "{x}", series.values[index])
                                                                                 : override);
  }
  return job;
}

double number_in(const Outcome& outcome, const std::string& name) {
  const auto at = outcome.numbers.find(name);
  return at == outcome.numbers.end() ? kNone : at->second;
}

/// Mean and standard deviation of those that are numbers.
void summarize_repeats(const std::vector<double>& values, double& mean, double& deviation) {
  double sum = 0.0, squares = 0.0, n = 0.0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    sum += value;
    n += 1.0;
  }
  mean = n > 0.0 ? sum / n : kNone;
  for (const double value : values) squares += std::isnan(value) ? 0.0 : (value - mean) * (value - mean);
  deviation = n > 1.0 ? std::sqrt(squares / (n - 1.0)) : 0.0;
}

}  // namespace

std::vector<Planned> plan(const Series& series) {
  std::vector<Planned> planned;
  for (std::size_t setting = 0; setting < setting_count(series); ++setting) {
    for (std::size_t index = 0; index < runs_along_x(series); ++index) {
      for (int k = 1; k <= series.repeat; ++k) planned.push_back({series.model, make_job(series, setting, index, k)});
    }
  }
  return planned;
}

Prediction gather(const Series& series, const std::vector<const Outcome*>& outcomes) {
  Prediction prediction{.there = true, .x = series.x, .y = {}, .spread = {}};
  const bool profile = is_profile(series);
  std::size_t next = 0;
  for (std::size_t setting = 0; setting < setting_count(series); ++setting) {
    std::vector<double> y, spread;
    for (std::size_t index = 0; index < runs_along_x(series); ++index) {
      std::vector<const Outcome*> repeats(outcomes.begin() + static_cast<std::ptrdiff_t>(next),
                                          outcomes.begin() + static_cast<std::ptrdiff_t>(next) + series.repeat);
      next += static_cast<std::size_t>(series.repeat);
      const std::size_t count = profile ? repeats.front()->profile.size() : 1;
      for (std::size_t i = 0; i < count; ++i) {
        std::vector<double> values;
        for (const Outcome* one : repeats) {
          const double found = !profile ? number_in(*one, series.take) : i < one->profile.size() ? one->profile[i] : kNone;
          values.push_back(series.scale * found);
        }
        y.emplace_back();
        spread.emplace_back();
        summarize_repeats(values, y.back(), spread.back());
        if (profile && setting == 0) prediction.x.push_back(static_cast<double>(i + 1));
      }
    }
    prediction.y.push_back(std::move(y));
    prediction.spread.push_back(std::move(spread));
  }
  return prediction;
}

double Prediction::at(std::size_t setting, double where) const {
  for (std::size_t i = 0; i < x.size() && setting < y.size() && i < y[setting].size(); ++i) {
    if (std::fabs(x[i] - where) <= 1e-9 * std::fmax(1.0, std::fabs(where))) return y[setting][i];
  }
  return kNone;
}

}  // namespace topple::validation

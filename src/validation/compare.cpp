// Verdicts: predictions over the plausible range of what is not known, against points with error bars.
#include <algorithm>
#include <cmath>
#include <limits>

#include "export/gnuplot.h"
#include "validation/judge.h"

namespace topple::validation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kFitSteps = 200;  // Of the first unknown between its least and its greatest value.

/// A series against points under one reading.
struct Contest {
  const Series& series;
  const Prediction& prediction;
  const Points& points;
  double factor = 1.0;

  std::size_t first_count() const { return series.unknowns.empty() ? 1 : series.unknowns[0].values.size(); }

  /// Of point i with the unknowns but the first as in `setting` and the first between two of its values.
  double predicted(std::size_t i, std::size_t setting, double share) const {
    const double low = prediction.at(setting, points.x[i]);
    if (share == 0.0) return low;
    return low + share * (prediction.at(setting + 1, points.x[i]) - low);
  }
  double deviation(std::size_t i, double predicted_y) const { return predicted_y / (factor * points.y[i]) - 1.0; }
  /// In error bars.
  double bars(std::size_t i, double predicted_y) const {
    const double miss = std::fabs(predicted_y - factor * points.y[i]);
    return std::isnan(miss) ? kInfinity : miss / std::fmax(factor * points.error[i], 1e-12 * std::fabs(points.y[i]));
  }
};

/// How far the worst point is outside its error bar, and the largest relative deviation of all points.
struct Misfit {
  double bars = 0.0;
  double worst = 0.0;
  std::size_t point = 0;
};

Misfit misfit(const Contest& contest, std::size_t setting, double share) {
  Misfit out;
  for (std::size_t i = 0; i < contest.points.x.size(); ++i) {
    const double y = contest.predicted(i, setting, share);
    out.bars = std::fmax(out.bars, contest.bars(i, y));
    const double deviation = contest.deviation(i, y);
    if (std::isnan(deviation)) {
      out.worst = std::numeric_limits<double>::quiet_NaN();
      out.point = i;
      return out;
    }
    if (std::fabs(deviation) > std::fabs(out.worst)) {
      out.worst = deviation;
      out.point = i;
    }
  }
  return out;
}

struct Best {
  Misfit misfit{.bars = kInfinity};
  std::size_t setting = 0;
  double share = 0.0;
};

/// Over every combination of the other unknowns, and finely over the first.
Best best_fit(const Contest& contest) {
  Best best;
  const std::size_t firsts = contest.first_count();
  for (std::size_t setting = 0; setting < setting_count(contest.series); ++setting) {
    const bool last = setting % firsts + 1 == firsts;
    const int steps = last ? 1 : std::max(1, kFitSteps / static_cast<int>(std::max<std::size_t>(1, firsts - 1)));
    for (int k = 0; k < steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      const Misfit here = misfit(contest, setting, share);
      if (here.bars < best.misfit.bars) best = {here, setting, share};
    }
  }
  return best;
}

std::string unknowns_in_words(const Contest& contest, const Best& best) {
  if (!std::isfinite(best.misfit.bars)) return {};
  std::string words;
  std::vector<double> values = setting_values(contest.series, best.setting);
  if (best.share > 0.0) {
    const double next = setting_values(contest.series, best.setting + 1)[0];
    values[0] += best.share * (next - values[0]);
  }
  for (std::size_t u = 0; u < values.size(); ++u) {
    words += (u == 0 ? "" : ", ") + contest.series.unknowns[u].name + " " + rounded(values[u], 2);
  }
  return words;
}

/// The value of the first unknown, the others at their defaults, at which one point is met; by straight lines between the values.
std::string fit_of_point(const Contest& contest, std::size_t i) {
  const std::vector<double>& values = contest.series.unknowns[0].values;
  const std::size_t standard = standard_setting(contest.series);
  const std::size_t base = standard - standard % values.size();
  const double wanted = contest.factor * contest.points.y[i];
  for (std::size_t k = 0; k + 1 < values.size(); ++k) {
    const double low = contest.prediction.at(base + k, contest.points.x[i]) - wanted;
    const double high = contest.prediction.at(base + k + 1, contest.points.x[i]) - wanted;
    if (low * high <= 0.0) return rounded(low == high ? values[k] : values[k] + (values[k + 1] - values[k]) * low / (low - high), 2);
  }
  const double first = std::fabs(contest.prediction.at(base, contest.points.x[i]) - wanted);
  const double last = std::fabs(contest.prediction.at(base + values.size() - 1, contest.points.x[i]) - wanted);
  if (std::isnan(first) || std::isnan(last)) return "none";
  return first < last ? "below " + rounded(values.front(), 2) : "above " + rounded(values.back(), 2);
}

std::string point_fits(const Contest& contest) {
  if (contest.series.unknowns.empty()) return {};
  std::string words;
  for (std::size_t i = 0; i < contest.points.x.size(); ++i) words += (i == 0 ? "" : ", ") + fit_of_point(contest, i);
  return words;
}

std::string miss_words(double worst) {
  return std::isnan(worst) ? "no prediction where it was measured (the wave dies, or the model refuses such a row)"
                           : "off by " + percent(worst) + " at worst";
}

std::string sentence(const Contest& contest, const Comparison& comparison, const Misfit& standard, const Best& best) {
  std::string words = words_of(comparison.verdict);
  if (contest.series.unknowns.empty()) return words + ": " + miss_words(standard.worst);
  switch (comparison.verdict) {
    case Verdict::agrees:
      return words + ": every point within its error bar at default surfaces, " + miss_words(standard.worst);
    case Verdict::agrees_for_some:
      return words + ": with " + comparison.best + ", " + miss_words(best.misfit.worst) + " (defaults: " + miss_words(standard.worst) + ")";
    case Verdict::does_not_agree:
      break;
  }
  if (comparison.best.empty()) return words + ": " + miss_words(best.misfit.worst);
  return words + ": even the best choice, " + comparison.best + ", is " + miss_words(best.misfit.worst);
}

Comparison judge(const Compare& compare, const Contest& contest, const Reading& reading) {
  Comparison out{.name = compare.name, .model = contest.series.model, .reading = reading.name};
  const Misfit standard = misfit(contest, standard_setting(contest.series), 0.0);
  const Best best = best_fit(contest);
  out.worst_default = standard.worst;
  out.worst_best = std::isfinite(best.misfit.bars) ? best.misfit.worst : std::numeric_limits<double>::quiet_NaN();
  out.best = unknowns_in_words(contest, best);
  out.point_fits = point_fits(contest);
  out.verdict = standard.bars <= 1.0 ? Verdict::agrees : best.misfit.bars <= 1.0 ? Verdict::agrees_for_some : Verdict::does_not_agree;
  Best shown = best;
  if (!std::isfinite(best.misfit.bars)) shown.misfit.worst = std::numeric_limits<double>::quiet_NaN();
  out.words = sentence(contest, out, standard, shown);
  return out;
}

}  // namespace

std::string percent(double share) {
  const double size = std::fabs(share);
  std::string text = rounded(100.0 * share, size < 0.01 ? 1 : size < 0.995 ? 2 : 3);
  if (share > 0.0) text.insert(0, "+");
  if (share < 0.0) text.replace(0, 1, "−");
  return text + " %";
}

const Prediction* prediction_of(const Judged& judged, const std::string& series) {
  for (std::size_t i = 0; i < judged.source->series.size(); ++i) {
    if (judged.source->series[i].name == series && judged.predictions[i].there) return &judged.predictions[i];
  }
  return nullptr;
}

std::vector<Comparison> compare_all(const Judged& judged) {
  std::vector<Comparison> out;
  const Source& source = *judged.source;
  for (const Compare& compare : source.compares) {
    const Prediction* prediction = prediction_of(judged, compare.series);
    if (prediction == nullptr) continue;
    const auto series =
        std::find_if(source.series.begin(), source.series.end(), [&](const Series& one) { return one.name == compare.series; });
    const auto points =
        std::find_if(source.points.begin(), source.points.end(), [&](const Points& one) { return one.name == compare.points; });
    for (const Reading& reading : points->readings) out.push_back(judge(compare, {*series, *prediction, *points, reading.factor}, reading));
  }
  return out;
}

}  // namespace topple::validation

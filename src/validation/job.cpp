#include "validation/job.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/hash.h"
#include "export/gnuplot.h"
#include "topple/measure.h"
#include "topple/run.h"

namespace topple::validation {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegree = 0.017453292519943295;
constexpr std::uint64_t kMeasures = 1;    // Counts the meanings that an outcome's numbers have had.
constexpr BrickId kFewBricks = 4;         // So few are recorded as well as single precision can, since the moment itself is measured.
constexpr double kFineTolerance = 1e-6;   // Of the thickness.
constexpr double kPlainTolerance = 0.01;  // Of the thickness: speeds come from events, which are exact.
constexpr int kHalvings = 14;             // The least value is known to 1/16,384 of the interval.

/// When each brick was touched first, when it passed 10 degrees, and what became of the first.
struct Times {
  std::vector<double> contact, arrival;
  double landed = kNone;  ///< Of brick 0 [s].
};

Times times_of(const Recording& recording) {
  const auto count = static_cast<std::size_t>(recording.layout().brick_count());
  Times times{std::vector<double>(count, kNone), std::vector<double>(count, kNone), kNone};
  for (std::int64_t i = 0; i < recording.event_count(); ++i) {
    const Event event = recording.event(i);
    const auto brick = static_cast<std::size_t>(event.brick);
    const bool touched = event.kind == EventKind::pushed || event.kind == EventKind::struck;
    if (touched && std::isnan(times.contact[brick])) times.contact[brick] = event.time;
    if (event.kind == EventKind::arrived && std::isnan(times.arrival[brick])) times.arrival[brick] = event.time;
    if (event.kind == EventKind::landed && event.brick == 0 && std::isnan(times.landed)) times.landed = event.time;
  }
  return times;
}

std::vector<double> places_along(const Layout& layout) {
  std::vector<double> places(layout.bricks.size(), 0.0);
  for (std::size_t i = 1; i < places.size(); ++i) places[i] = places[i - 1] + norm(layout.bricks[i].foot - layout.bricks[i - 1].foot);
  return places;
}

double speed_between(const std::vector<double>& places, const std::vector<double>& times, std::size_t from, std::size_t to) {
  const double took = times[to] - times[from];
  return took > 0.0 ? (places[to] - places[from]) / took : kNone;
}

double deviation_of_intervals(const std::vector<double>& times, std::size_t from, std::size_t to) {
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = from + 1; i <= to; ++i) {
    const double interval = times[i] - times[i - 1];
    sum += interval;
    squares += interval * interval;
  }
  const auto n = static_cast<double>(to - from);
  return n > 1.0 ? std::sqrt(std::fmax(0.0, (squares - sum * sum / n) / (n - 1.0))) : kNone;
}

/// Of the bricks from `from` to `to` once all is at rest [rad].
double mean_final_tilt(const Recording& recording, std::size_t from, std::size_t to) {
  double sum = 0.0;
  for (std::size_t i = from; i <= to; ++i) {
    const auto brick = static_cast<BrickId>(i);
    sum += tilt(recording.layout(), brick, recording.at(brick, std::numeric_limits<double>::infinity()).pose.orientation);
  }
  return sum / static_cast<double>(to - from + 1);
}

std::vector<double> profile_of(const Job& job, const Recording& recording, const Times& times) {
  std::vector<double> out;
  const std::vector<double> places = places_along(recording.layout());
  const std::size_t count = places.size();
  for (std::size_t i = 1; i < count && !job.profile.empty(); ++i) {
    if (job.profile == "profile_interval_ms") {
      out.push_back(1000.0 * (times.contact[i] - times.contact[i - 1]));
    } else if (job.profile == "profile_tilt_speed_m_s") {
      out.push_back(speed_between(places, times.arrival, i - 1, i));
    } else if (job.profile == "profile_final_tilt_deg") {
      out.push_back(mean_final_tilt(recording, i, i) / kDegree);
    } else {
      const auto window = static_cast<std::size_t>(job.window);
      out.push_back(speed_between(places, times.contact, i - std::min(i, window), std::min(count - 1, i + window)));
    }
  }
  return out;
}

/// How many bricks in a row from the first were touched and fell.
std::size_t reached_by(const Times& times) {
  std::size_t reached = 0;
  while (reached < times.arrival.size() && !std::isnan(times.arrival[reached])) ++reached;
  return reached;
}

Outcome measure(const Job& job, const Recording& recording) {
  const Times times = times_of(recording);
  const std::vector<double> places = places_along(recording.layout());
  const std::size_t last = places.size() - 1;
  const auto at_share = [last](double share) { return static_cast<std::size_t>(std::floor(share * static_cast<double>(last) + 0.5)); };
  const std::size_t from = at_share(job.from), to = std::max(at_share(job.to), std::min(last, from + 1));
  const std::size_t reached = reached_by(times);
  const RunSummary summary = summarize(recording);
  Outcome outcome;
  auto& numbers = outcome.numbers;
  numbers["speed_m_s"] = speed_between(places, times.contact, from, to);
  numbers["tilt_speed_m_s"] = speed_between(places, times.arrival, from, to);
  numbers["interval_ms"] = to > from ? 1000.0 * (times.contact[to] - times.contact[from]) / static_cast<double>(to - from) : kNone;
  numbers["interval_sd_ms"] = 1000.0 * deviation_of_intervals(times.contact, from, to);
  numbers["duration_s"] = times.arrival[last] - times.contact[0];
  numbers["fallen"] = static_cast<double>(summary.fallen);
  numbers["failed"] = reached == places.size() ? 0.0 : 1.0;
  numbers["reached"] = static_cast<double>(reached);
  numbers["reached_m"] = reached > 0 ? places[reached - 1] : 0.0;
  numbers["final_tilt_deg"] = mean_final_tilt(recording, from, to) / kDegree;
  numbers["arrival_ms"] = 1000.0 * times.arrival[0];
  numbers["landed_ms"] = 1000.0 * times.landed;
  if (last > 0 && !std::isnan(times.contact[1])) {
    numbers["contact_tilt_deg"] = tilt(recording.layout(), 0, recording.at(0, times.contact[1]).pose.orientation) / kDegree;
  }
  outcome.profile = profile_of(job, recording, times);
  return outcome;
}

Result<Recording> run_once(const Job& job, const std::string& x, const std::function<bool()>& stopped, bool* refused = nullptr) {
  std::vector<std::string> overrides = job.overrides;
  for (std::string& one : overrides) {
    if (const std::size_t at = one.find("{x}"); at != std::string::npos) one.replace(at, 3, x);
  }
  Result<Layout> layout = read_layout(job.scene_text, job.scene, overrides);
  if (!layout) return std::unexpected(layout.error());
  const Result<ModelConfig> model = model_config(*layout);
  if (!model) return std::unexpected(model.error());
  RunConfig config;
  if (job.until > 0.0) config.until = job.until;
  config.recorder.tolerance = layout->brick_count() <= kFewBricks ? kFineTolerance : kPlainTolerance;
  config.watch = [&stopped](const RunProgress&, const Recording&) { return !stopped(); };
  // A model may refuse a layout that it does not follow; that is no prediction, not a mistake.
  if (refused != nullptr && !make_model(*layout, *model)) {
    *refused = true;
    return failure("");
  }
  Result<Recording> recording = simulate(std::move(*layout), *model, config);
  if (recording && recording->end().reason == EndReason::not_finite) return failure(job.scene + ": " + recording->end().words);
  if (recording && recording->end().reason == EndReason::stopped) return failure("");
  return recording;
}

/// Past their tip angle when the run ended, whether they rest by then or still rock.
bool all_fell(const Recording& recording) {
  const Layout& layout = recording.layout();
  for (BrickId brick = 0; brick < layout.brick_count(); ++brick) {
    const double turned = tilt(layout, brick, recording.at(brick, std::numeric_limits<double>::infinity()).pose.orientation);
    if (turned <= tip_angle(extents(layout.kind_of(brick), layout.bricks[static_cast<std::size_t>(brick)].stance))) return false;
  }
  return true;
}

Result<Outcome> seek_least(const Job& job, const std::function<bool()>& stopped) {
  double low = job.least[0], high = job.least[1];
  for (int i = 0; i < kHalvings; ++i) {
    if (stopped()) return failure("");
    const double middle = 0.5 * (low + high);
    const Result<Recording> recording = run_once(job, decimal(middle), stopped);
    if (!recording) return std::unexpected(recording.error());
    (all_fell(*recording) ? high : low) = middle;
  }
  Outcome outcome;
  outcome.numbers["least"] = high == job.least[1] ? kNone : 0.5 * (low + high);
  return outcome;
}

constexpr std::string_view kProbe = R"([contact]
brick_friction = 0.3
floor_friction = 0.3
brick_restitution = 0.4
floor_restitution = 0.2
[[kind]]
name = "plain"
[[kind]]
name = "other"
height_mm = 52
brick_friction = 0.15
brick_restitution = 0
[[push]]
brick = 0
angular_speed_rad_s = 6.0
[[row]]
count = 10
gap_mm = 12
[[curve]]
points_mm = [[195, 0], [250, 5], [300, 20]]
gap_mm = 12
kind = "other"
)";

}  // namespace

std::uint64_t Job::key() const {
  std::string all = scene_text;
  for (const std::string& one : overrides) all += '\n' + one;
  all += '\n' + profile + ' ' + decimal(from) + ' ' + decimal(to) + ' ' + decimal(until) + ' ' + std::to_string(window);
  for (const double bound : least) all += ' ' + decimal(bound);
  Hash hash;
  hash.add(kMeasures);
  for (const char letter : all) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(letter)));
  return hash.value();
}

Result<Outcome> run_job(const Job& job, const std::function<bool()>& stopped) {
  if (!job.least.empty()) return seek_least(job, stopped);
  bool refused = false;
  const Result<Recording> recording = run_once(job, "", stopped, &refused);
  if (refused) return Outcome{.numbers = {{"refused", 1.0}}, .profile = {}};
  if (!recording) return std::unexpected(recording.error());
  return measure(job, *recording);
}

Result<std::uint64_t> fingerprint(const std::string& model) {
  const Job probe{.scene_text = std::string(kProbe), .scene = "the probe", .overrides = {"name=" + model}};
  const Result<Recording> recording = run_once(probe, "", [] { return false; });
  if (!recording) return std::unexpected(recording.error());
  return recording->end().hash;
}

}  // namespace topple::validation

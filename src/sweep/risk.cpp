#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "base/crew.h"
#include "base/hash.h"
#include "layout/text.h"
#include "topple/sweep.h"

namespace topple {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDeviate = 1.959963984540054;  // A normal deviate is nearer to its mean than this in 95 % of all cases.

// A run whose bricks are off their places takes hardly longer than the exact one; but one that never rests must end [s].
constexpr double kLonger = 2.0;
constexpr double kSpare = 5.0;

std::vector<std::string> overrides_with(const Layout& layout, const PlacementError& error, std::uint64_t seed) {
  std::vector<std::string> overrides = layout.overrides;
  overrides.push_back("noise.position_mm=" + number_text(1000.0 * error.position));
  overrides.push_back("noise.heading_deg=" + number_text(error.heading / kPi * 180.0));
  overrides.push_back("noise.seed=" + std::to_string(seed));
  return overrides;
}

// What moved when the time was over has fallen if it is past its tip angle by then.
void add_those_that_fall(const Recording& recording, std::vector<std::uint8_t>& fallen) {
  const Layout& layout = recording.layout();
  for (BrickId brick = 0; brick < layout.brick_count(); ++brick) {
    if (fallen[static_cast<std::size_t>(brick)] != 0) continue;
    const BrickState state = recording.at(brick, std::numeric_limits<double>::infinity());
    const Brick& put = layout.bricks[static_cast<std::size_t>(brick)];
    const double tip = tip_angle(extents(layout.kinds[put.kind], put.stance));
    fallen[static_cast<std::size_t>(brick)] = tilt(layout, brick, state.pose.orientation) > tip ? 1 : 0;
  }
}

std::vector<std::uint8_t> fallen_by_the_end(const Recording& recording) {
  std::vector<std::uint8_t> fallen = fallen_bricks(recording);
  if (recording.end().reason == EndReason::time_limit) add_those_that_fall(recording, fallen);
  return fallen;
}

// A ball does not fall, and which bricks of a structure fall is no matter of one link after the other.
bool is_of_a_line(const Layout& layout, BrickId brick) {
  const Part* const part = layout.part_of(brick);
  return (part == nullptr || part->line) && layout.kind_of(brick).shape == Shape::box;
}

double last_arrival_of(const Recording& recording) {
  const Wave wave = measure_wave(recording);
  return wave.arrival.empty() ? std::numeric_limits<double>::quiet_NaN() : wave.arrival.back();
}

}  // namespace

double Share::value() const {
  return of == 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(count) / static_cast<double>(of);
}

// [Wilson1927]: the shares p from which `count` of `of` is no farther than the deviate z,
// (count + z^2/2 -+ z sqrt(count (of - count) / of + z^2/4)) / (of + z^2).
double Share::low() const {
  if (count == 0) return 0.0;
  const auto k = static_cast<double>(count), n = static_cast<double>(of), z = kDeviate;
  return (k + 0.5 * z * z - z * std::sqrt(k * (n - k) / n + 0.25 * z * z)) / (n + z * z);
}

double Share::high() const { return of == 0 ? 1.0 : 1.0 - Share{of - count, of}.low(); }

RiskStudy::RiskStudy(Recording exact, const PlacementError& error, const RunConfig& config)
    : exact_(std::move(exact)), error_(error), config_(config), from_(first_strikers(exact_)), ought_(fallen_by_the_end(exact_)) {
  if (!std::isfinite(config_.until)) config_.until = kLonger * exact_.duration() + kSpare;
  for (BrickId brick = 0; brick < layout().brick_count(); ++brick) {
    if (!is_of_a_line(layout(), brick)) ought_[static_cast<std::size_t>(brick)] = 0;
  }
}

Result<RiskStudy> RiskStudy::begin(const Layout& layout, const PlacementError& error, const RunConfig& config) {
  Result<Layout> exact = read_layout(layout.text, layout.name, overrides_with(layout, {0.0, 0.0}, 1));
  if (!exact) return std::unexpected(exact.error());
  const Result<ModelConfig> model = model_config(*exact);
  if (!model) return std::unexpected(model.error());
  Result<Recording> recording = simulate(std::move(*exact), *model, config);
  if (!recording) return std::unexpected(recording.error());
  RiskStudy study(std::move(*recording), error, config);
  if (std::find(study.ought_.begin(), study.ought_.end(), 1) == study.ought_.end()) {
    return failure(layout.name + ": no brick of a line falls even when all are exactly in their places (" + study.exact_.end().words +
                   "), so there is nothing to ask about.");
  }
  return study;
}

std::string RiskStudy::key() const {
  Hash hash;
  for (const double number : {error_.position, error_.heading, config_.until}) hash.add(number);
  hash.add(exact_.end().hash);
  return exact_.recipe().version + "-" + exact_.recipe().model + "-" + hash_digits(hash.value());
}

void RiskStudy::add(PlacedRun run) {
  const auto at =
      std::lower_bound(runs_.begin(), runs_.end(), run.seed, [](const PlacedRun& r, std::uint64_t seed) { return r.seed < seed; });
  if (at == runs_.end() || at->seed != run.seed) runs_.insert(at, std::move(run));
}

Result<void> RiskStudy::run(std::int64_t runs, const std::function<void(const PlacedRun&)>& finished, const std::function<bool()>& go_on) {
  std::vector<std::uint64_t> seeds;
  auto known = runs_.begin();
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(runs); ++seed) {
    while (known != runs_.end() && known->seed < seed) ++known;
    if (known == runs_.end() || known->seed != seed) seeds.push_back(seed);
  }
  Crew crew(config_.threads);
  std::vector<std::optional<Result<std::optional<PlacedRun>>>> round;
  for (std::size_t next = 0; next < seeds.size() && go_on(); next += round.size()) {
    round.clear();
    round.resize(std::min(seeds.size() - next, static_cast<std::size_t>(crew.size())));
    crew.each(round.size(), [&](std::size_t i) { round[i] = run_seed(seeds[next + i], go_on); });
    for (auto& result : round) {
      if (!*result) return std::unexpected(result->error());
      if (!result->value()) return {};
      finished(*result->value());
      add(std::move(*result->value()));
    }
  }
  return {};
}

Result<std::optional<PlacedRun>> RiskStudy::run_seed(std::uint64_t seed, const std::function<bool()>& go_on) const {
  PlacedRun run{.seed = seed};
  Result<Layout> placed = read_layout(layout().text, layout().name, overrides_with(layout(), error_, seed));
  if (!placed) {
    // All but overlaps would have been refused before.
    run.built = false;
    return run;
  }
  RunConfig config = config_;
  config.threads = 1;
  if (go_on) config.watch = [&go_on](const RunProgress&, const Recording&) { return go_on(); };
  const Result<Recording> recording = simulate(std::move(*placed), *model_config(layout()), config);
  if (!recording) {
    return failure("The model refuses the layout where bricks are off their places (seed " + std::to_string(seed) + "):\n" +
                   recording.error().message);
  }
  if (recording->end().reason == EndReason::stopped) return std::nullopt;
  if (recording->end().reason == EndReason::not_finite) return failure("Seed " + std::to_string(seed) + ": " + recording->end().words);
  const std::vector<std::uint8_t> fallen = fallen_by_the_end(*recording);
  for (BrickId brick = 0; brick < layout().brick_count(); ++brick) {
    const auto at = static_cast<std::size_t>(brick);
    if (ought_[at] == 0 || fallen[at] != 0) continue;
    if (run.standing.empty() || run.standing.back().last != brick - 1) run.standing.push_back({brick, brick});
    run.standing.back().last = brick;
  }
  run.last_arrival = last_arrival_of(*recording);
  return run;
}

Risk RiskStudy::risk() const {
  Risk risk;
  std::vector<double> arrivals;
  for (const PlacedRun& run : runs_) {
    ++(run.built ? risk.runs : risk.not_built);
    if (run.built && run.standing.empty()) arrivals.push_back(run.last_arrival);
  }
  risk.whole = {static_cast<std::int64_t>(arrivals.size()), risk.runs};
  const auto mean_of = [count = static_cast<double>(arrivals.size())](double sum) { return sum / count; };
  risk.arrival = mean_of(std::accumulate(arrivals.begin(), arrivals.end(), 0.0));
  const auto square = [&risk](double sum, double arrival) { return sum + (arrival - risk.arrival) * (arrival - risk.arrival); };
  risk.arrival_spread = std::sqrt(mean_of(std::accumulate(arrivals.begin(), arrivals.end(), 0.0, square)));
  count_links(risk);
  return risk;
}

// A link is tested where the brick before fell, or where nothing but a push or a ball is before it.
void RiskStudy::count_links(Risk& risk) const {
  std::vector<Share> stops(ought_.size());
  for (std::size_t i = 0; i < layout().parts.size(); ++i) risk.parts.push_back({.part = i});
  for (const PlacedRun& run : runs_) {
    if (!run.built) continue;
    std::vector<std::uint8_t> fell = ought_;
    for (const BrickRange& range : run.standing) std::fill(fell.begin() + range.first, fell.begin() + range.last + 1, 0);
    for (PartRisk& risky : risk.parts) {
      const Part& part = layout().parts[risky.part];
      bool tested = false, stopped = false;
      const auto first = static_cast<std::size_t>(part.first), count = static_cast<std::size_t>(part.count);
      for (std::size_t brick = first; brick < first + count; ++brick) {
        if (ought_[brick] == 0 || waits_for(brick, fell)) continue;
        ++stops[brick].of;
        stops[brick].count += fell[brick] == 0 ? 1 : 0;
        tested = true;
        stopped = stopped || fell[brick] == 0;
      }
      risky.stops.of += tested ? 1 : 0;
      risky.stops.count += stopped ? 1 : 0;
    }
  }
  list_links(risk, stops);
}

// Whether a brick was not struck by the one that ought to, since that did not fall itself.
bool RiskStudy::waits_for(std::size_t brick, std::span<const std::uint8_t> fell) const {
  if (from_[brick] == kNoBrick) return false;
  const auto from = static_cast<std::size_t>(from_[brick]);
  return ought_[from] != 0 && fell[from] == 0;
}

void RiskStudy::list_links(Risk& risk, std::span<const Share> stops) const {
  risk.least_tested = risk.runs;
  for (PartRisk& risky : risk.parts) {
    const Part& part = layout().parts[risky.part];
    for (BrickId brick = part.first; brick < part.first + part.count; ++brick) {
      const auto at = static_cast<std::size_t>(brick);
      if (ought_[at] == 0) continue;
      ++risky.links;
      if (stops[at].count > 0) {
        risk.weak.push_back({from_[at], brick, stops[at]});
      } else {
        risk.least_tested = std::min(risk.least_tested, stops[at].of);
      }
    }
    risk.links += risky.links;
  }
  std::erase_if(risk.parts, [](const PartRisk& part) { return part.links == 0; });
  // Weakest first, and then in the order of the layout; last what no run came to.
  const auto weakness = [](const Share& share) { return share.of > 0 ? share.value() : -1.0; };
  const auto is_weaker = [&weakness](const auto& one, const auto& other) { return weakness(one.stops) > weakness(other.stops); };
  std::stable_sort(risk.weak.begin(), risk.weak.end(), is_weaker);
  std::stable_sort(risk.parts.begin(), risk.parts.end(), is_weaker);
}

}  // namespace topple

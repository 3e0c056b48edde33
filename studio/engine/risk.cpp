/// How likely a run stops whose bricks are put down by hand: one study at a time, run by run, so that several engines can share the runs.
#include <algorithm>
#include <span>
#include <string>

#include "desk.h"

namespace topple {
namespace {

void add_share(std::string& json, const Share& share) {
  json += "{\"count\":" + std::to_string(share.count) + ",\"of\":" + std::to_string(share.of) + ",\"low\":";
  add_number(json, share.low());
  json += ",\"high\":";
  add_number(json, share.high());
  json += "}";
}

std::string describe(const RiskStudy& study) {
  const Risk risk = study.risk();
  std::string json = "{\"runs\":" + std::to_string(risk.runs) + ",\"notBuilt\":" + std::to_string(risk.not_built) + ",\"whole\":";
  add_share(json, risk.whole);
  json += ",\"arrival\":";
  add_number(json, risk.arrival);
  json += ",\"spread\":";
  add_number(json, risk.arrival_spread);
  json += ",\"links\":" + std::to_string(risk.links) + ",\"held\":";
  add_share(json, {0, risk.least_tested});
  json += ",\"exactlyStanding\":" + std::to_string(summarize(study.exact()).standing) + ",\"weak\":[";
  for (std::size_t i = 0; i < risk.weak.size(); ++i) {
    json += std::string(i == 0 ? "" : ",") + "{\"brick\":" + std::to_string(risk.weak[i].brick) + ",\"stops\":";
    add_share(json, risk.weak[i].stops);
    json += "}";
  }
  json += "],\"parts\":[";
  for (std::size_t i = 0; i < risk.parts.size(); ++i) {
    json += i == 0 ? "{\"name\":" : ",{\"name\":";
    add_text(json, study.layout().parts[risk.parts[i].part].name);
    json += ",\"stops\":";
    add_share(json, risk.parts[i].stops);
    json += "}";
  }
  return json + "]}";
}

/// A run in numbers: its seed, whether it was built (0 or 1), when the wave reached its last brick [s]; then the first and the last of each
/// range of bricks that stood.
void add_run(std::vector<std::uint8_t>& bytes, const PlacedRun& run) {
  add_bytes(bytes, static_cast<double>(run.seed));
  add_bytes(bytes, run.built ? 1.0 : 0.0);
  add_bytes(bytes, run.last_arrival);
  for (const BrickRange& range : run.standing) {
    for (const BrickId brick : {range.first, range.last}) add_bytes(bytes, static_cast<double>(brick));
  }
}

PlacedRun run_of(std::span<const double> numbers) {
  PlacedRun run{.seed = static_cast<std::uint64_t>(numbers[0]), .built = numbers[1] != 0.0, .last_arrival = numbers[2]};
  for (std::size_t i = 3; i + 1 < numbers.size(); i += 2) {
    run.standing.push_back({static_cast<BrickId>(numbers[i]), static_cast<BrickId>(numbers[i + 1])});
  }
  return run;
}

}  // namespace
}  // namespace topple

extern "C" {

/// Begins a study of a layout (RiskStudy) with errors of a position [m] and a heading [rad]: its run with every brick exactly in its place.
/// False: the answer says why not.
TOPPLE_EXPORT(topple_risk_begin)
bool topple_risk_begin(const char* text, std::size_t size, const char* name, std::size_t name_size, const char* overrides,
                       std::size_t overrides_size, double position, double heading) {
  topple::Desk& all = topple::desk();
  all.study.reset();
  const std::vector<std::string> settings = topple::lines_of({overrides, overrides_size});
  const topple::Result<topple::Layout> layout = topple::read_layout({text, size}, {name, name_size}, settings);
  if (!layout) return topple::fail(layout.error());
  topple::Result<topple::RiskStudy> study = topple::RiskStudy::begin(*layout, {.position = position, .heading = heading});
  if (!study) return topple::fail(study.error());
  all.study = std::move(*study);
  return true;
}

/// Runs one seed; the bytes are the run's numbers. False: the answer says why not.
TOPPLE_EXPORT(topple_risk_run) bool topple_risk_run(double seed) {
  topple::Desk& all = topple::desk();
  const auto run = all.study->run_seed(static_cast<std::uint64_t>(seed), nullptr);
  if (!run) return topple::fail(run.error());
  all.bytes.clear();
  topple::add_run(all.bytes, **run);
  return true;
}

/// Adds a run to the study, here or elsewhere run, by its numbers.
TOPPLE_EXPORT(topple_risk_add) void topple_risk_add(const double* numbers, std::size_t count) {
  topple::desk().study->add(topple::run_of({numbers, count}));
}

/// The answer becomes what all runs so far came to, as JSON.
TOPPLE_EXPORT(topple_risk_answer) void topple_risk_answer() { topple::desk().answer = topple::describe(*topple::desk().study); }
}

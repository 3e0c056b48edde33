#include "summary.h"

#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "json_value.h"
#include "text.h"
#include "topple/measure.h"

namespace topple::app {
namespace {

using Json = nlohmann::ordered_json;

const std::chrono::steady_clock::time_point kStart = std::chrono::steady_clock::now();

constexpr std::size_t kHitsShown = 10;  // Enough for a small scene; a long run's are exported with `topple export --events`.

double seconds(const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); }

/// The first hits: when, who by whom, and with what.
Json first_hits(const Recording& recording) {
  Json hits = Json::array();
  for (std::int64_t i = 0; i < recording.event_count() && hits.size() < kHitsShown; ++i) {
    const Event event = recording.event(i);
    if (event.kind == EventKind::struck) {
      hits.push_back(Json{{"time_s", event.time},
                          {"brick", event.brick},
                          {"by", brick_json(event.by)},
                          {"force_n", number_json(event.force)},
                          {"impulse_n_s", number_json(event.impulse)}});
    }
  }
  return hits;
}

}  // namespace

Cost cost_so_far() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  Cost cost;
  cost.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - kStart).count();
  cost.cpu = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  cost.peak_memory = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts it in KiB.
  return cost;
}

Json summary_json(const Recording& recording) {
  const RunSummary run = summarize(recording);
  const RunEnd& end = recording.end();
  const Cost cost = cost_so_far();
  Json json;
  json["version"] = recording.recipe().version;
  json["layout"] = recording.layout().name;
  json["title"] = recording.layout().title;
  json["model"] = recording.recipe().model;
  json["time_step_s"] = recording.recipe().time_step;
  json["bricks"] = run.bricks;
  json["fallen"] = run.fallen;
  json["standing"] = run.standing;
  json["front_speed_m_s"] = number_json(run.front_speed);
  json["duration_s"] = run.duration;
  json["steps"] = end.step;
  json["wall_s"] = cost.wall;
  json["cpu_s"] = cost.cpu;
  json["peak_memory_bytes"] = cost.peak_memory;
  json["hash"] = hash_digits(end.hash);
  json["end"] = name_of(end.reason);
  json["end_brick"] = brick_json(end.brick);
  json["end_words"] = end.words;
  json["hits"] = first_hits(recording);
  return json;
}

std::string summary_text(const Recording& recording) {
  const RunSummary run = summarize(recording);
  const RunEnd& end = recording.end();
  const Layout& layout = recording.layout();
  std::string text = (layout.title.empty() ? layout.name : layout.title + " (" + layout.name + ")") + "\n";
  const auto line = [&text](const char* what, const std::string& value) { text += formatted("  %-12s %s\n", what, value.c_str()); };
  line("bricks", grouped(run.bricks) + ": " + grouped(run.fallen) + " fallen, " + grouped(run.standing) + " standing");
  line("front speed", std::isfinite(run.front_speed) ? formatted("%.4g m/s", run.front_speed) : "none, the wave is too short");
  line("duration", formatted("%.4g s", run.duration));
  line("model", recording.recipe().model + formatted(", time step %.4g ms", 1e3 * recording.recipe().time_step));
  line("end", end.words.empty() ? std::string(name_of(end.reason)) : end.words);
  line("hash", hash_digits(end.hash));
  return text;
}

}  // namespace topple::app

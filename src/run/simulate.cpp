// The only loop.
#include <span>
#include <string>
#include <utility>

#include "run/run_end.h"
#include "topple/run.h"

namespace topple {

namespace {

constexpr std::int64_t kStepsBetweenWatches = 4096;

/// What the events tell while they come: how far the wave is, and where it stopped.
struct Story {
  std::int64_t moved = 0;  ///< Bricks pushed or struck.
  std::int64_t arrived = 0;
  BrickId missed = kNoBrick;  ///< Fell flat short of the next brick.

  void take(std::span<const Event> events) {
    for (const Event& event : events) {
      if (event.kind == EventKind::pushed || event.kind == EventKind::struck) ++moved;
      if (event.kind == EventKind::arrived) ++arrived;
      if (event.kind == EventKind::missed) missed = event.brick;
    }
  }
};

}  // namespace

Result<Recording> simulate(Layout layout, const ModelConfig& model_config, const RunConfig& config) {
  const std::string name = model_name(model_config);
  const double time_step = std::visit([](const auto& chosen) { return chosen.time_step; }, model_config);
  Recording recording(std::move(layout), {.version = TOPPLE_VERSION, .model = name, .time_step = time_step});
  auto made = make_model(recording.layout(), model_config);
  if (!made) return std::unexpected(made.error());
  Model& model = **made;
  Recorder recorder(recording, config.recorder);

  Story story;
  RunEnd end;  // Still running.
  while (end.reason == EndReason::running) {
    const Status status = model.step();
    recorder.take(model);
    story.take(model.events());
    const double time = static_cast<double>(model.step_count()) * time_step;
    if (status.progress == Progress::not_finite) {
      end = {.reason = EndReason::not_finite, .brick = status.brick};
      end.words =
          "the numbers of brick " + std::to_string(status.brick) + " are no longer finite at step " + std::to_string(model.step_count());
    } else if (status.progress == Progress::at_rest) {
      recorder.close_tracks();
      end = end_at_rest(recording, {.missed = story.missed, .everyone_arrived = story.moved == story.arrived});
    } else if (time >= config.until) {
      end = {.reason = EndReason::time_limit, .words = "the time limit was reached"};
    } else if (config.watch && model.step_count() % kStepsBetweenWatches == 0) {
      const RunProgress progress{recording.layout().brick_count(), story.arrived, model.step_count(), time};
      if (!config.watch(progress, recording)) end = {.reason = EndReason::stopped, .words = "the run was stopped"};
    }
  }
  end.step = model.step_count();
  end.time = static_cast<double>(end.step) * time_step;
  end.hash = model.hash();
  recorder.finish(std::move(end));
  return recording;
}

}  // namespace topple

// The only loop.
#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "topple/run.h"

namespace topple {

namespace {

constexpr std::int64_t kStepsBetweenWatches = 4096;

std::string brick_words(BrickId brick) { return "brick " + std::to_string(brick); }

bool fell(const Recording& recording, BrickId brick) {
  const Layout& layout = recording.layout();
  // What a ball or a structure does is no wave that could die.
  if (const Part* part = layout.part_of(brick); part != nullptr && !part->line) return true;
  const Brick& put = layout.bricks[static_cast<std::size_t>(brick)];
  const double turned = tilt(layout, brick, recording.at(brick, std::numeric_limits<double>::infinity()).pose.orientation);
  return turned > tip_angle(extents(layout.kinds[put.kind], put.stance));
}

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

/// Whether a brick that the wave has reached (10 degrees) is always past its tip angle, so that nobody need look.
bool all_tip_before_arrival(const Layout& layout) {
  return std::all_of(layout.bricks.begin(), layout.bricks.end(),
                     [&layout](const Brick& brick) { return tip_angle(extents(layout.kinds[brick.kind], brick.stance)) < kArrivalTilt; });
}

/// The last brick that was pushed or struck and rests short of its tip angle.
BrickId last_not_fallen(const Recording& recording) {
  for (std::int64_t i = recording.event_count() - 1; i >= 0; --i) {
    const Event event = recording.event(i);
    const bool moved = event.kind == EventKind::pushed || event.kind == EventKind::struck;
    if (moved && !fell(recording, event.brick)) return event.brick;
  }
  return kNoBrick;
}

RunEnd end_at_rest(const Recording& recording, const Story& story) {
  RunEnd end{.reason = EndReason::at_rest, .words = "everything is at rest"};
  if (story.missed != kNoBrick) {
    end.reason = EndReason::wave_died;
    end.brick = story.missed;
    end.words = "the wave died at " + brick_words(story.missed) + ": it fell flat without reaching " + brick_words(story.missed + 1);
    return end;
  }
  const bool all_fell = story.moved == story.arrived && all_tip_before_arrival(recording.layout());
  const BrickId stopped = all_fell ? kNoBrick : last_not_fallen(recording);
  if (stopped == kNoBrick) return end;
  end.reason = EndReason::wave_died;
  end.brick = stopped;
  end.words = "the wave died at " + brick_words(stopped) + ": it was moved, but not past its tip angle";
  return end;
}

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
      end.words = "the numbers of " + brick_words(status.brick) + " are no longer finite at step " + std::to_string(model.step_count());
    } else if (status.progress == Progress::at_rest) {
      recorder.close_tracks();
      end = end_at_rest(recording, story);
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

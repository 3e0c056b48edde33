// The only loop.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "topple/run.h"

namespace topple {

namespace {

constexpr std::int64_t kStepsBetweenWatches = 4096;

std::string brick_words(BrickId brick) { return "brick " + std::to_string(brick); }

bool fell(const Recording& recording, BrickId brick, double time) {
  const Layout& layout = recording.layout();
  const Brick& put = layout.bricks[static_cast<std::size_t>(brick)];
  const double turned = tilt(layout, brick, recording.at(brick, time).pose.orientation);
  return turned > tip_angle(extents(layout.kinds[put.kind], put.stance));
}

/// What the events tell while they come: how far the wave is, and where it stopped.
struct Story {
  std::int64_t arrived = 0;
  BrickId missed = kNoBrick;    ///< Fell flat short of the next brick.
  std::vector<BrickId> rested;  ///< In the order in which they came to rest.

  void take(std::span<const Event> events) {
    for (const Event& event : events) {
      if (event.kind == EventKind::arrived) ++arrived;
      if (event.kind == EventKind::missed) missed = event.brick;
      if (event.kind == EventKind::rested) rested.push_back(event.brick);
    }
  }

  /// The last brick that was struck or pushed and rests short of its tip angle. The recording knows that once its tracks are closed.
  BrickId not_fallen(const Recording& recording) const {
    const auto short_of_tip = [&](BrickId brick) { return !fell(recording, brick, recording.duration()); };
    const auto last = std::find_if(rested.rbegin(), rested.rend(), short_of_tip);
    return last == rested.rend() ? kNoBrick : *last;
  }
};

RunEnd end_at_rest(const Story& story, const Recording& recording) {
  const BrickId not_fallen = story.not_fallen(recording);
  RunEnd end{.reason = EndReason::at_rest, .words = "everything is at rest"};
  if (story.missed != kNoBrick) {
    end.reason = EndReason::wave_died;
    end.brick = story.missed;
    end.words = "the wave died at " + brick_words(story.missed) + ": it fell flat without reaching " + brick_words(story.missed + 1);
  } else if (not_fallen != kNoBrick) {
    end.reason = EndReason::wave_died;
    end.brick = not_fallen;
    end.words = "the wave died at " + brick_words(not_fallen) + ": it was moved, but not past its tip angle";
  }
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
      recorder.finish({});
      end = end_at_rest(story, recording);
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

// The only loop.
#include <algorithm>
#include <chrono>
#include <span>
#include <string>
#include <utility>

#include "base/crew.h"
#include "run/run_end.h"
#include "topple/profile.h"
#include "topple/run.h"

namespace topple {

namespace {

constexpr std::int64_t kMostSteps = 4096;
constexpr std::chrono::milliseconds kBetweenWatches{50};

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

struct Simulation::State {
  State(Layout layout, Recipe recipe, const RunConfig& the_config)
      : config(the_config),
        crew(config.threads),
        recording(std::move(layout), std::move(recipe)),
        recorder(recording, shared(config.recorder)) {}

  RecorderConfig shared(RecorderConfig recorder_config) {
    recorder_config.crew = &crew;
    recorder_config.profile = config.profile;
    return recorder_config;
  }

  void step();
  void finish();

  RunConfig config;
  Crew crew;
  Recording recording;
  Recorder recorder;
  std::unique_ptr<Model> model;
  bool names_stages = false;  // The model adds its own to the profile.
  Story story;
  RunEnd end;  // Still running.
  RunProgress progress;
};

void Simulation::State::step() {
  Status status;
  {
    const Timed timed(names_stages ? nullptr : config.profile, Stage::model);
    status = model->step();
  }
  recorder.take(*model);
  story.take(model->events());
  progress = {recording.layout().brick_count(), story.arrived, model->step_count(),
              static_cast<double>(model->step_count()) * model->time_step()};
  if (status.progress == Progress::not_finite) {
    end = {.reason = EndReason::not_finite, .brick = status.brick};
    end.words =
        "the numbers of brick " + std::to_string(status.brick) + " are no longer finite at step " + std::to_string(model->step_count());
  } else if (status.progress == Progress::at_rest) {
    recorder.close_tracks();
    end = end_at_rest(recording, {.missed = story.missed, .everyone_arrived = story.moved == story.arrived});
  } else if (progress.time >= config.until) {
    end = {.reason = EndReason::time_limit, .words = "the time limit was reached"};
  }
  if (end.reason != EndReason::running) finish();
}

void Simulation::State::finish() {
  end.step = progress.step;
  end.time = progress.time;
  end.hash = model->hash();
  if (end.reason != EndReason::at_rest) recorder.take_last(*model);
  recorder.finish(end);
}

Simulation::Simulation() = default;
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

Result<Simulation> Simulation::start(Layout layout, const ModelConfig& model_config, const RunConfig& config) {
  const double time_step = std::visit([](const auto& chosen) { return chosen.time_step; }, model_config);
  Recipe recipe{.version = TOPPLE_VERSION, .model = model_name(model_config), .time_step = time_step};
  Simulation simulation;
  simulation.state_ = std::make_unique<State>(std::move(layout), std::move(recipe), config);
  State& state = *simulation.state_;
  ModelConfig shared = model_config;
  if (auto* rigid = std::get_if<RigidConfig>(&shared)) {
    rigid->crew = &state.crew;
    rigid->profile = config.profile;
    if (config.lanes != 0) rigid->lanes = config.lanes;
    state.names_stages = true;
  }
  auto made = make_model(state.recording.layout(), shared);
  if (!made) return std::unexpected(made.error());
  state.model = std::move(*made);
  state.progress.bricks = state.recording.layout().brick_count();
  return simulation;
}

bool Simulation::advance(std::int64_t steps) {
  State& state = *state_;
  for (std::int64_t i = 0; i < steps && state.end.reason == EndReason::running; ++i) state.step();
  return state.end.reason == EndReason::running;
}

void Simulation::stop() {
  State& state = *state_;
  if (state.end.reason != EndReason::running) return;
  state.end = {.reason = EndReason::stopped, .words = "the run was stopped"};
  state.finish();
}

const RunProgress& Simulation::progress() const { return state_->progress; }
const Recording& Simulation::recording() const { return state_->recording; }
Recording Simulation::take() { return std::move(state_->recording); }

Result<Recording> simulate(Layout layout, const ModelConfig& model_config, const RunConfig& config) {
  Result<Simulation> simulation = Simulation::start(std::move(layout), model_config, config);
  if (!simulation) return std::unexpected(simulation.error());
  if (!config.watch) {
    while (simulation->advance(kMostSteps)) {
    }
    return simulation->take();
  }
  // A step takes from a microsecond to a second.
  std::int64_t steps = 1;
  for (auto before = std::chrono::steady_clock::now(); simulation->advance(steps); before = std::chrono::steady_clock::now()) {
    const auto took = std::chrono::steady_clock::now() - before;
    if (took < kBetweenWatches / 2) steps = std::min(2 * steps, kMostSteps);
    if (took > kBetweenWatches) steps = std::max(steps / 2, std::int64_t{1});
    const Timed timed(config.profile, Stage::watch);
    if (!config.watch(simulation->progress(), simulation->recording())) simulation->stop();
  }
  return simulation->take();
}

}  // namespace topple

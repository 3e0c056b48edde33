/// Running: from a layout and a model to a recording. The only loop, and the only place that knows every model.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "topple/recording.h"

namespace topple {

/// Understands the [model] settings of a layout; every unknown key or bad value is named at once.
Result<ModelConfig> model_config(const Layout& layout);

/// The one visit. May refuse a layout, in words. The layout must outlive the model.
Result<std::unique_ptr<Model>> make_model(const Layout& layout, const ModelConfig& config);

/// "pivot".
std::string model_name(const ModelConfig& config);

/// The most numbers that `rigid` can work on side by side here: what RigidConfig::lanes = 0 takes.
int most_lanes();

/// How far a run has come.
struct RunProgress {
  std::int64_t bricks = 0;
  std::int64_t arrived = 0;  ///< Bricks that the wave has reached.
  std::int64_t step = 0;
  double time = 0.0;  ///< Simulated [s].
};

struct RunConfig {
  // affects results
  double until = std::numeric_limits<double>::infinity();  ///< Stops at this simulated time [s].
  RecorderConfig recorder;

  // affects speed only
  int threads = 1;
  int lanes = 0;               ///< RigidConfig::lanes, unless 0.
  Profile* profile = nullptr;  ///< Where the time of the run's stages is added; null: nowhere.

  /// Called some twenty times a second with the recording so far; returning false stops the run cleanly.
  std::function<bool(const RunProgress&, const Recording&)> watch;
};

/// Runs a layout to its end and records it. The recording owns the layout.
Result<Recording> simulate(Layout layout, const ModelConfig& model, const RunConfig& config = {});

/// A run in pieces, for a caller that does other things in between: the page.
class Simulation {
 public:
  static Result<Simulation> start(Layout layout, const ModelConfig& model, const RunConfig& config = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  bool advance(std::int64_t steps);  ///< At most so many steps; false once the run is over.
  void stop();                       ///< Ends it cleanly where it is.
  const RunProgress& progress() const;
  const Recording& recording() const;
  Recording take();  ///< Of a run that is over.

 private:
  Simulation();
  struct State;
  std::unique_ptr<State> state_;
};

/// Whether a recipe still gives the same motion.
struct ReplayVerdict {
  bool same = false;
  std::uint64_t recorded_hash = 0;
  std::uint64_t replayed_hash = 0;
  std::int64_t first_step = -1;    ///< First step that differs, -1 if none.
  BrickId first_brick = kNoBrick;  ///< First brick that differs.
  std::string words;
};
Result<ReplayVerdict> replay(const Recording& recording, const RunConfig& config = {});

/// How the error of one integrator shrinks with its step.
struct ConvergenceSeries {
  Integrator integrator = Integrator::euler;
  std::vector<double> time_steps;  ///< [s]
  std::vector<double> errors;      ///< Of the tilt at `time` [rad].
  double slope = 0.0;              ///< Of log(error) against log(step), least squares.
};
struct Convergence {
  double time = 0.0;  ///< Length of the fall [s].
  std::vector<ConvergenceSeries> series;
};
/// Free fall of the layout's first brick from its tip angle + 1 degree, before any contact, by each integrator of the pivot model.
Convergence free_fall_convergence(const Layout& layout, InertiaRule inertia = InertiaRule::report);

}  // namespace topple

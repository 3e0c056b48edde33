/// Rows for the tests of the model `rigid`, and what a run of one shows.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/trigonometry.h"
#include "model/rigid/rigid_model.h"

namespace topple::test {

/// 48 x 24 x 7.5 mm, 1040 kg/m^3: the brick of the cross-check scene.
inline BrickKind cross_check_kind(const Surface& surface = {}) {
  BrickKind kind;
  kind.mass = 1040.0 * kind.height * kind.width * kind.thickness;
  kind.surface = surface;
  return kind;
}

/// What a layout file says.
inline Layout layout_of(const std::string& text) {
  auto layout = read_layout(text, "test.toml");
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  return *std::move(layout);
}

inline Layout straight_row(int count, double pitch, const Surface& surface = {}) {
  Layout layout;
  layout.kinds = {cross_check_kind(surface)};
  layout.colors = {layout.kinds[0].color};
  for (int i = 0; i < count; ++i) {
    Brick brick;
    brick.foot.x = i * pitch;
    layout.bricks.push_back(brick);
  }
  layout.parts = {{"row 1", 0, count}};
  layout.pushes = {{0, 0.0, AngularSpeedPush{4.0}}};
  return layout;
}

struct RigidRun {
  std::vector<double> arrival;  ///< [s]; not a number if it never came.
  std::vector<Pose> last;
  std::vector<int> struck_by;  ///< The first that struck it.
  double time = 0.0;
  double energy_rise = 0.0;  ///< Largest rise of kinetic + potential - push work [J].
  double released = 0.0;     ///< Push work and potential energy that went [J].
  std::uint64_t hash = 0;
  Progress progress = Progress::running;
};

inline RigidRun run_rigid(const Layout& layout, double time_step, double until) {
  RigidRun run;
  const auto count = layout.bricks.size();
  run.arrival.assign(count, std::nan(""));
  run.struck_by.assign(count, -1);
  for (BrickId i = 0; i < layout.brick_count(); ++i) run.last.push_back(standing_pose(layout, i));
  auto model = rigid::make_rigid_model(layout, {.time_step = time_step, .repeats = false});  // Frames leave out what echoes tell.
  REQUIRE(model.has_value());
  Frame frame;
  double least = 0.0;
  while (run.progress == Progress::running && run.time < until) {
    run.progress = (*model)->step().progress;
    (*model)->read(frame);
    run.time = frame.time;
    for (const Event& event : (*model)->events()) {
      const auto at = static_cast<std::size_t>(event.brick);
      if (event.kind == EventKind::arrived) run.arrival[at] = event.time;
      if (event.kind == EventKind::struck && run.struck_by[at] < 0) run.struck_by[at] = event.by;
    }
    for (const FreeMotion& motion : frame.free) run.last[static_cast<std::size_t>(motion.brick)] = motion.pose;
    const double sum = frame.energy.kinetic + frame.energy.potential - frame.energy.push_work;
    least = std::min(least, sum);
    run.energy_rise = std::max(run.energy_rise, sum - least);
    run.released = frame.energy.push_work - std::min(frame.energy.potential, 0.0);
  }
  run.hash = (*model)->hash();
  return run;
}

/// Between the bricks at 20 % and at 80 % of a row [m/s].
inline double front_speed(const RigidRun& run, double pitch) {
  const std::size_t from = run.arrival.size() / 5, to = run.arrival.size() * 4 / 5;
  return static_cast<double>(to - from) * pitch / (run.arrival[to] - run.arrival[from]);
}

inline double degrees(double radians) { return radians * 180.0 / kPi; }

/// Turned about the origin, then shifted [m].
inline Layout moved(Layout layout, double turn, const Vec3& shift) {
  const SinCos angle = sin_cos(turn);
  for (Brick& brick : layout.bricks) {
    const Vec3 foot = brick.foot;
    brick.foot = shift + Vec3{angle.cos * foot.x - angle.sin * foot.y, angle.sin * foot.x + angle.cos * foot.y, foot.z};
    brick.heading += turn;
  }
  return layout;
}

}  // namespace topple::test

/// Rows of bricks for the tests of `hinge`, and a run that keeps what matters.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "doctest/doctest.h"
#include "model/hinge/hinge_model.h"

namespace topple {

struct RowPlan {
  int count = 100;
  double height = 0.048;      ///< [m]
  double thickness = 0.0075;  ///< [m]
  double gap = 0.015;         ///< [m]
  double friction = 0.2;
  double growth = 1.0;    ///< Each brick, and the gap after it, is so many times the one before.
  double jitter = 0.0;    ///< Gaps differ by up to this fraction, in a fixed irregular way.
  double push = 8.0;      ///< Of the first brick [rad/s].
  double gravity = 9.81;  ///< [m/s^2]
};

inline Layout make_row(const RowPlan& plan) {
  Layout layout;
  layout.gravity = plan.gravity;
  layout.colors.emplace_back();
  double toe = 0.0;
  double scale = 1.0;
  for (int i = 0; i < plan.count; ++i) {
    if (i == 0 || plan.growth != 1.0) {
      BrickKind kind;
      kind.height = plan.height * scale;
      kind.width = 0.5 * kind.height;
      kind.thickness = plan.thickness * scale;
      kind.mass = 1040.0 * kind.height * kind.width * kind.thickness;
      kind.surface.brick_friction = plan.friction;
      layout.kinds.push_back(kind);
    }
    const BrickKind& kind = layout.kinds.back();
    // The fractional parts of i times the golden ratio are spread evenly over 0 to 1 and never repeat.
    const double spread = std::fmod(0.6180339887498949 * i, 1.0);
    if (i > 0) toe += plan.gap * scale / plan.growth * (1.0 + plan.jitter * (2.0 * spread - 1.0)) + kind.thickness;
    Brick brick;
    brick.foot = {toe - 0.5 * kind.thickness, 0.0, 0.0};
    brick.kind = static_cast<std::uint16_t>(layout.kinds.size() - 1);
    layout.bricks.push_back(brick);
    scale *= plan.growth;
  }
  layout.parts.push_back({"row 1", 0, plan.count});
  if (plan.push > 0.0) layout.pushes.push_back({0, 0.0, AngularSpeedPush{plan.push}});
  return layout;
}

struct HingeRun {
  std::vector<double> struck;   ///< When each brick was first struck; infinite if it was not [s].
  std::vector<double> arrived;  ///< [s]
  std::vector<double> rest;     ///< The angle at which each brick went to rest last; not a number if it did not [rad].
  std::vector<Event> events;
  double duration = 0.0;   ///< [s]
  double most_rise = 0.0;  ///< The largest rise of kinetic + potential energy - push work between two steps in order [J].
  double released = 0.0;   ///< The largest potential energy released plus push work [J].
  std::size_t most_moving = 0;
  std::uint64_t hash = 0;
  Progress progress = Progress::running;
};

inline HingeRun run_hinge(const Layout& layout, const HingeConfig& config = {}, double until = 1e9) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  auto model = hinge::make_hinge_model(layout, config);
  REQUIRE_MESSAGE(model.has_value(), (model ? std::string() : model.error().message));
  HingeRun run;
  run.struck.assign(layout.bricks.size(), kInfinity);
  run.arrived.assign(layout.bricks.size(), kInfinity);
  run.rest.assign(layout.bricks.size(), std::numeric_limits<double>::quiet_NaN());
  Frame frame;
  double least = kInfinity;
  while (run.progress == Progress::running && run.duration < until) {
    run.progress = (*model)->step().progress;
    (*model)->read(frame);
    run.duration = frame.time;
    for (const Event& event : (*model)->events()) {
      const auto brick = static_cast<std::size_t>(event.brick);
      if (event.kind == EventKind::struck && run.struck[brick] == kInfinity) run.struck[brick] = event.time;
      if (event.kind == EventKind::arrived) run.arrived[brick] = event.time;
      run.events.push_back(event);
    }
    for (const HingedMotion& motion : frame.hinged) {
      if (motion.phase != Phase::falling) run.rest[static_cast<std::size_t>(motion.brick)] = motion.state.angle;
    }
    const double energy = frame.energy.kinetic + frame.energy.potential - frame.energy.push_work;
    run.most_rise = std::max(run.most_rise, energy - least);
    least = std::min(least, energy);
    run.released = std::max(run.released, frame.energy.push_work - frame.energy.potential);
    run.most_moving = std::max(run.most_moving, frame.hinged.size());
  }
  run.hash = (*model)->hash();
  return run;
}

/// Bricks that rest beyond their tip angle.
inline int count_fallen(const Layout& layout, const HingeRun& run) {
  int fallen = 0;
  for (std::size_t i = 0; i < run.rest.size(); ++i) {
    const BrickKind& kind = layout.kinds[layout.bricks[i].kind];
    fallen += run.rest[i] > std::atan(kind.thickness / kind.height) ? 1 : 0;
  }
  return fallen;
}

}  // namespace topple

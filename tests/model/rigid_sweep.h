/// Rows of any surface, gap, shape and gravity that a person may choose, and what must hold of each.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "rigid_scene.h"

namespace topple::test {

enum class Line { straight, turned, curved };

/// Lengths are in heights, gravity in g, the push in least pushes that topple a brick.
struct SweptRow {
  Surface surface;
  double gap = 0.34;
  double thickness = 0.15625;
  double gravity = 1.0;
  double push = 1.5;
  Line line = Line::straight;
  int count = 25;

  std::string words() const;
  Layout layout() const;
};

/// What a run did.
struct SweptRun {
  Progress progress = Progress::running;
  double time = 0.0;         ///< When it ended, in sqrt(height / gravity).
  double energy_rise = 0.0;  ///< Largest rise of what is left of energy over any two moments, of push work and potential energy released.
  double unaccounted = 0.0;  ///< What its potential energy at the end is off that of where the bricks lie, of that of a standing brick.
  double overlap = 0.0;      ///< Deepest of two bricks, or of a brick and the floor, in thicknesses of the thinner.
};

/// Runs a row until it rests, or for so many sqrt(height / gravity).
SweptRun run_swept(const SweptRow& row, double until);

inline std::string SweptRow::words() const {
  std::ostringstream text;
  text << "friction " << surface.brick_friction << " on bricks and " << surface.floor_friction << " on the floor, restitution "
       << surface.brick_restitution << ", gap " << gap << " h, thickness " << thickness << " h, " << gravity << " g, push " << push
       << (line == Line::straight ? ", straight"
           : line == Line::turned ? ", turned"
                                  : ", curved");
  return text.str();
}

inline Layout SweptRow::layout() const {
  const double height = 0.048;
  Layout layout;
  BrickKind kind;
  kind.height = height;
  kind.width = 0.5 * height;
  kind.thickness = thickness * height;
  kind.mass = 1040.0 * kind.height * kind.width * kind.thickness;
  kind.surface = surface;
  layout.kinds = {kind};
  layout.colors = {kind.color};
  layout.gravity = 9.81 * gravity;
  const double pitch = (gap + thickness) * height;
  Brick brick;
  // Curved: ninety degrees in the row, so that the inner edges of wide, close bricks stay clear of each other.
  const double turn = line == Line::curved ? std::min(0.5 * kPi / count, 0.8 * gap * height / (0.5 * kind.width)) : 0.0;
  if (line == Line::turned) brick.heading = 0.6;
  for (int i = 0; i < count; ++i) {
    layout.bricks.push_back(brick);
    // A turned row has its fourth brick a little askew, so that it leaves the plane.
    if (line == Line::turned && i == 3) layout.bricks.back().heading += 0.03;
    const double middle = brick.heading + 0.5 * turn;
    brick.foot = brick.foot + pitch * Vec3{std::cos(middle), std::sin(middle), 0.0};
    brick.heading += turn;
  }
  layout.parts = {{"row 1", 0, count}};
  // Energy: half of 4/3 m (r w)^2 with r half the diagonal, against m g times what its centre rises until it stands on its edge.
  const double diagonal = std::sqrt(kind.height * kind.height + kind.thickness * kind.thickness);
  const double least = std::sqrt(3.0 * layout.gravity * (diagonal - kind.height)) / diagonal;
  layout.pushes = {{0, 0.0, AngularSpeedPush{push * least}}};
  return layout;
}

/// How deep a brick is in the floor or in one of the others [m].
inline double deepest(const Layout& layout, const std::vector<Pose>& poses, std::size_t one) {
  const Vec3 half = half_extents(layout.kinds[0]);
  const double radius = norm(half);
  const Box box{poses[one], half};
  const Vec3 up = rotate(conjugate(poses[one].orientation), Vec3{0.0, 0.0, 1.0});
  double deep = std::abs(up.x) * half.x + std::abs(up.y) * half.y + std::abs(up.z) * half.z - poses[one].position.z;
  for (std::size_t other = 0; other < poses.size(); ++other) {
    const Vec3 apart = poses[other].position - poses[one].position;
    if (other == one || dot(apart, apart) > 4.0 * radius * radius) continue;
    deep = std::max(deep, -separation(box, {poses[other], half}));
  }
  return deep;
}

inline SweptRun run_swept(const SweptRow& row, double until) {
  const Layout layout = row.layout();
  const double unit = std::sqrt(layout.kinds[0].height / layout.gravity);
  const double thin = std::min(layout.kinds[0].thickness, layout.kinds[0].width);
  SweptRun run;
  auto model = rigid::make_rigid_model(layout, {.repeats = false});  // Frames leave out what echoes tell.
  REQUIRE(model.has_value());
  std::vector<Pose> poses;
  for (BrickId i = 0; i < layout.brick_count(); ++i) poses.push_back(standing_pose(layout, i));
  Frame frame;
  double least = 0.0, lowest = 0.0, rise = 0.0;
  while (run.progress == Progress::running && run.time < until) {
    run.progress = (*model)->step().progress;
    (*model)->read(frame);
    run.time = frame.time / unit;
    for (const FreeMotion& motion : frame.free) poses[static_cast<std::size_t>(motion.brick)] = motion.pose;
    for (const FreeMotion& motion : frame.free) {
      run.overlap = std::max(run.overlap, deepest(layout, poses, static_cast<std::size_t>(motion.brick)) / thin);
    }
    const double sum = frame.energy.kinetic + frame.energy.potential - frame.energy.push_work;
    least = std::min(least, sum);
    lowest = std::min(lowest, frame.energy.potential);
    rise = std::max(rise, sum - least);
  }
  run.energy_rise = rise / (frame.energy.push_work - lowest);
  const BrickKind& kind = layout.kinds[0];
  double lost = frame.energy.potential / (kind.mass * layout.gravity);
  for (std::size_t i = 0; i < poses.size(); ++i) lost -= poses[i].position.z - 0.5 * kind.height;
  run.unaccounted = std::abs(lost) / kind.height;
  return run;
}

}  // namespace topple::test

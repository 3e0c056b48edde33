// Rows against what independent engines agree on and against the geometry of leaning bricks.
#include <array>

#include "rigid_scene.h"

using namespace topple;
using namespace topple::test;

namespace {

// Five engines, each rescaled and refined, agree on 0.946 +- 0.001 m/s for the cross-check row.
constexpr double kPitch = 0.024;
constexpr double kFrontSpeed = 0.946;

}  // namespace

TEST_CASE("rigid: the front of the cross-check row runs at 0.946 m/s when refined") {
  const RigidRun run = run_rigid(straight_row(100, kPitch), 0.0015, 10.0);
  CHECK(std::abs(front_speed(run, kPitch) - kFrontSpeed) < 0.001);
}

TEST_CASE("rigid: at the default step and at 0.7, 0.85 and 1.2 times it the front speed is within a quarter of a percent") {
  const Layout layout = straight_row(100, kPitch);
  // If the front locked in to the step, these four could not all be right.
  for (const double factor : {0.7, 0.85, 1.0, 1.2}) {
    const RigidRun run = run_rigid(layout, factor * rigid::default_time_step(layout), 10.0);
    CAPTURE(factor);
    CHECK(std::abs(front_speed(run, kPitch) / kFrontSpeed - 1.0) < 0.0025);
  }
}

TEST_CASE("rigid: at a gap of 7.5 mm four steps agree within a quarter of a percent") {
  const Layout layout = straight_row(60, 0.015);
  const double refined = front_speed(run_rigid(layout, 0.001, 10.0), 0.015);
  for (const double factor : {0.7, 0.85, 1.0, 1.2}) {
    const RigidRun run = run_rigid(layout, factor * rigid::default_time_step(layout), 10.0);
    CAPTURE(factor);
    CHECK(std::abs(front_speed(run, 0.015) / refined - 1.0) < 0.0025);
  }
}

TEST_CASE("rigid: the first eleven local speeds of the cross-check row are those of the other engines within two percent") {
  const RigidRun run = run_rigid(straight_row(14, kPitch), 0.0, 10.0);
  const std::array<double, 11> expected{.2108, .3514, .5237, .6618, .7618, .8299, .8740, .9021, .9200, .9304, .9370};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CAPTURE(i);
    CHECK(std::abs(kPitch / (run.arrival[i + 1] - run.arrival[i]) / expected[i] - 1.0) < 0.02);
  }
}

TEST_CASE("rigid: bricks far behind the front lean at acos(thickness / pitch)") {
  const Layout layout = straight_row(100, kPitch);
  const RigidRun run = run_rigid(layout, 0.0, 10.0);
  CHECK(run.progress == Progress::at_rest);
  for (BrickId brick = 20; brick <= 80; ++brick) {
    CAPTURE(brick);
    // Face on face: cos(tilt) = thickness / pitch, 71.79 degrees.
    const double leans = degrees(tilt(layout, brick, run.last[static_cast<std::size_t>(brick)].orientation));
    CHECK(std::abs(leans - degrees(std::acos(0.0075 / kPitch))) < 0.05);
  }
}

TEST_CASE("rigid: every brick of a row is struck first by the one before it") {
  const RigidRun run = run_rigid(straight_row(30, kPitch), 0.0, 10.0);
  for (std::size_t i = 1; i < run.struck_by.size(); ++i) CHECK(run.struck_by[i] == static_cast<int>(i) - 1);
}

TEST_CASE("rigid: nothing makes energy in a row") {
  const RigidRun run = run_rigid(straight_row(60, kPitch), 0.0, 10.0);
  // The law of this model: at most 0.1 % of what pushes and gravity put in.
  CHECK(run.energy_rise < 0.001 * run.released);
}

TEST_CASE("rigid: the same layout gives the same hash, another friction by 1e-12 another") {
  const RigidRun first = run_rigid(straight_row(20, kPitch), 0.0, 10.0);
  const RigidRun again = run_rigid(straight_row(20, kPitch), 0.0, 10.0);
  CHECK(first.hash == again.hash);
  const RigidRun other = run_rigid(straight_row(20, kPitch, {.brick_friction = 0.2 + 1e-12}), 0.0, 10.0);
  CHECK(first.hash != other.hash);
}

TEST_CASE("rigid: a row four times as large falls half as fast") {
  const Layout small = straight_row(30, kPitch);
  Layout large = small;
  // Froude: lengths x 4, times x 2 under the same gravity. The default step scales along; powers of two leave the arithmetic as it is.
  BrickKind& kind = large.kinds[0];
  kind.height *= 4.0;
  kind.width *= 4.0;
  kind.thickness *= 4.0;
  for (Brick& brick : large.bricks) brick.foot.x *= 4.0;
  large.pushes[0].how = AngularSpeedPush{2.0};
  const RigidRun one = run_rigid(small, 0.0, 10.0);
  const RigidRun two = run_rigid(large, 0.0, 20.0);
  for (std::size_t i = 0; i < one.arrival.size(); ++i) CHECK(std::abs(0.5 * two.arrival[i] / one.arrival[i] - 1.0) < 1e-6);
}

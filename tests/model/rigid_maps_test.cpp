// What falls through and what does not: turns, bricks that grow, waves that return, meet and cross.
#include <array>
#include <cstdio>

#include "rigid_scene.h"

using namespace topple;
using namespace topple::test;

namespace {

/// Eight bricks straight on, a quarter of a circle with `turning`, eight more; the gap in heights along the line.
Layout quarter_turn(int turning, double gap, const Surface& surface) {
  Layout layout = straight_row(0, 0.0, surface);
  const double pitch = gap * 0.048 + 0.0075;
  Brick brick;
  for (int i = 0; i < turning + 16; ++i) {
    layout.bricks.push_back(brick);
    const double next = brick.heading + (i >= 7 && i < turning + 7 ? 0.5 * kPi / turning : 0.0);
    const double middle = 0.5 * (brick.heading + next);
    brick.foot = brick.foot + pitch * Vec3{std::cos(middle), std::sin(middle), 0.0};
    brick.heading = next;
  }
  layout.parts = {{"turn", 0, layout.brick_count()}};
  layout.pushes = {{0, 0.0, AngularSpeedPush{8.0}}};
  return layout;
}

bool any_overlap(const Layout& layout) {
  const Vec3 half = half_extents(layout.kinds[0]);
  for (BrickId i = 0; i < layout.brick_count(); ++i) {
    for (BrickId j = i + 1; j < layout.brick_count(); ++j) {
      if (separation({standing_pose(layout, i), half}, {standing_pose(layout, j), half}) < 0.0) return true;
    }
  }
  return false;
}

/// Thirteen bricks, each `factor` times the one before, the first 5 mm high; gaps in heights of the brick behind.
Layout growing(double factor, double thickness, double gap, double friction) {
  Layout layout = straight_row(0, 0.0);
  layout.kinds.clear();
  double place = 0.0, height = 0.005;
  for (int i = 0; i < 13; ++i) {
    BrickKind kind = cross_check_kind({.brick_friction = friction});
    kind.height = height;
    kind.width = 0.5 * height;
    kind.thickness = thickness * height;
    kind.mass = 1040.0 * kind.height * kind.width * kind.thickness;
    layout.kinds.push_back(kind);
    Brick brick;
    brick.foot.x = place;
    brick.kind = static_cast<std::uint16_t>(i);
    layout.bricks.push_back(brick);
    place += (0.5 * thickness * (1.0 + factor) + gap) * height;
    height *= factor;
  }
  layout.parts = {{"row", 0, 13}};
  layout.pushes = {{0, 0.0, AngularSpeedPush{12.0}}};  // 8.4 just topple a first brick of an eighth, 10.6 one of a fifth.
  return layout;
}

int count_reached(const RigidRun& run) {
  return static_cast<int>(std::count_if(run.arrival.begin(), run.arrival.end(), [](double arrival) { return !std::isnan(arrival); }));
}

/// How many bricks fall over.
int fallen(const Layout& layout, const RigidRun& run) {
  int count = 0;
  for (BrickId i = 0; i < layout.brick_count(); ++i)
    count += tilt(layout, i, run.last[static_cast<std::size_t>(i)].orientation) > 0.4 ? 1 : 0;
  return count;
}

int fallen(const Layout& layout) { return fallen(layout, run_rigid(layout, 0.0, 10.0)); }

}  // namespace

TEST_CASE("rigid: a turn of 90 degrees with ten bricks falls through at gaps from a tenth to 0.85 heights, with three from a fifth on") {
  for (const double gap : {0.1, 0.2, 0.5, 0.85}) {
    CAPTURE(gap);
    CHECK(fallen(quarter_turn(10, gap, {})) == 26);
    if (gap > 0.1) CHECK(fallen(quarter_turn(3, gap, {})) == 19);
  }
}

TEST_CASE("rigid: a turn of 90 degrees with one brick stops the wave") { CHECK(fallen(quarter_turn(1, 0.34375, {})) < 10); }

// build/release/test_model --no-skip --test-case="*map of turns*"
TEST_CASE("rigid: a map of turns of 90 degrees" * doctest::skip()) {
  constexpr std::array<double, 9> kGaps{0.1, 0.2, 0.34375, 0.5, 0.7, 0.8, 0.85, 0.9, 0.95};
  for (const double floor : {0.2, 0.5, 0.9}) {
    for (const double friction : {0.2, 0.4}) {
      std::printf("friction %.1f on bricks, %.1f on the floor; gaps in heights:", friction, floor);
      for (const double gap : kGaps) std::printf(" %5.2f", gap);
      std::printf("\n");
      for (int turning = 1; turning <= 12; ++turning) {
        std::printf("  %2d bricks for the turn:                                ", turning);
        for (const double gap : kGaps) {
          const Layout layout = quarter_turn(turning, gap, {.brick_friction = friction, .floor_friction = floor});
          const char* words = any_overlap(layout) ? "no" : fallen(layout) == turning + 16 ? "falls" : "stops";
          std::printf(" %5s", words);
        }
        std::printf("\n");
      }
    }
  }
}

TEST_CASE("rigid: thirteen bricks growing by 1.5 from 5 mm all fall, by 1.7 they do not") {
  CHECK(fallen(growing(1.5, 0.125, 0.6, 0.2)) == 13);
  CHECK(fallen(growing(1.7, 0.125, 0.6, 0.2)) < 13);
}

// build/release/test_model --no-skip --test-case="*factor at which*"
TEST_CASE("rigid: the factor at which thirteen growing bricks stop" * doctest::skip()) {
  for (const double thickness : {0.125, 0.15625, 0.2}) {
    for (const double gap : {0.45, 0.6, 0.75}) {
      std::printf("thickness %.3f, gap %.2f:", thickness, gap);
      for (const double friction : {0.05, 0.1, 0.2, 0.3, 0.4}) {
        double low = 1.0, high = 3.0;
        for (int i = 0; i < 10; ++i) {
          const double middle = 0.5 * (low + high);
          (fallen(growing(middle, thickness, gap, friction)) == 13 ? low : high) = middle;
        }
        std::printf("  friction %.2f: %.2f", friction, high);
      }
      std::printf("\n");
    }
  }
}

TEST_CASE("rigid: a wave that returns beside its own row finds it fallen and goes on to the end") {
  // Ten bricks out, half a circle of twelve, ten back, 92 mm beside.
  Layout layout = straight_row(0, 0.0);
  Brick brick;
  for (int i = 0; i < 32; ++i) {
    layout.bricks.push_back(brick);
    const double next = brick.heading + (i >= 9 && i < 21 ? kPi / 12.0 : 0.0);
    const double middle = 0.5 * (brick.heading + next);
    brick.foot = brick.foot + 0.024 * Vec3{std::cos(middle), std::sin(middle), 0.0};
    brick.heading = next;
  }
  layout.parts = {{"loop", 0, 32}};
  const RigidRun run = run_rigid(layout, 0.0, 10.0);
  CHECK(run.progress == Progress::at_rest);
  CHECK(fallen(layout, run) == 32);
  for (std::size_t i = 1; i < run.arrival.size(); ++i) CHECK(run.arrival[i] > run.arrival[i - 1]);
  CHECK(run.energy_rise < 0.001 * run.released);
}

TEST_CASE("rigid: a wave bounces back from a brick too heavy for it, and every brick comes to rest") {
  Layout layout = straight_row(9, 0.024, {.brick_restitution = 0.5});
  BrickKind heavy = layout.kinds[0];
  heavy.thickness = 0.04;
  heavy.mass *= 40.0;
  layout.kinds.push_back(heavy);
  layout.bricks[8].kind = 1;
  layout.bricks[8].foot.x += 0.5 * (0.04 - 0.0075);
  const RigidRun run = run_rigid(layout, 0.0, 20.0);
  CHECK(run.progress == Progress::at_rest);
  CHECK(std::isnan(run.arrival[8]));
  CHECK(count_reached(run) == 8);
  CHECK(run.energy_rise < 0.001 * run.released);
}

// Of a hundred delays there is one or two at which a brick of one wave flies into the gap just ahead of the other and stops it; which ones
// these are hangs on a hair.
TEST_CASE("rigid: two waves that cross both go on, nearly always") {
  // The second row leaves a gap of 36 mm for the first, across which its bricks fall.
  Layout layout = straight_row(16, 0.024);
  for (int i = 0; i < 16; ++i) {
    Brick brick;
    brick.heading = 0.5 * kPi;
    brick.foot = {0.180, (i < 8 ? -0.022 : 0.022) + 0.024 * (i < 8 ? i - 7 : i - 8), 0.0};
    layout.bricks.push_back(brick);
  }
  layout.parts = {{"row 1", 0, 16}, {"row 2", 16, 16}};
  int stopped = 0;
  for (int tenths = 0; tenths <= 10; ++tenths) {
    layout.pushes = {{0, 0.0, AngularSpeedPush{4.0}}, {16, 0.1 * tenths, AngularSpeedPush{4.0}}};
    const RigidRun run = run_rigid(layout, 0.0, 10.0);
    CAPTURE(tenths);
    CHECK(run.progress == Progress::at_rest);
    CHECK(run.energy_rise < 0.001 * run.released);
    CHECK(count_reached(run) >= 24);
    stopped += count_reached(run) < 32 ? 1 : 0;
  }
  CHECK(stopped <= 1);
}

// Turns, splits, several fronts.
#include "rigid_scene.h"

using namespace topple;
using namespace topple::test;

namespace {

int count_fallen(const Layout& layout, const RigidRun& run) {
  int fallen = 0;
  for (BrickId i = 0; i < layout.brick_count(); ++i) {
    if (tilt(layout, i, run.last[static_cast<std::size_t>(i)].orientation) > 0.3) ++fallen;
  }
  return fallen;
}

// Eight bricks straight on, a quarter of a circle with `count`, eight more.
Layout turn_with(int count) {
  Layout layout = straight_row(0, 0.024);
  Brick brick;
  for (int i = 0; i < count + 16; ++i) {
    layout.bricks.push_back(brick);
    const bool turning = i >= 7 && i < count + 7;
    const double next = brick.heading + (turning ? 0.5 * kPi / count : 0.0);
    const double middle = 0.5 * (brick.heading + next);
    brick.foot = brick.foot + 0.024 * Vec3{std::cos(middle), std::sin(middle), 0.0};
    brick.heading = next;
  }
  layout.parts = {{"turn", 0, layout.brick_count()}};
  return layout;
}

}  // namespace

TEST_CASE("rigid: a turn of 90 degrees with ten bricks falls through") {
  const Layout layout = turn_with(10);
  const RigidRun run = run_rigid(layout, 0.0, 10.0);
  CHECK(run.progress == Progress::at_rest);
  CHECK(count_fallen(layout, run) == 26);
  CHECK(run.energy_rise < 0.001 * run.released);
}

TEST_CASE("rigid: a split by half a width starts both branches") {
  Layout layout = straight_row(8, 0.024);
  Brick brick;
  for (const double side : {-0.0135, 0.0135}) {
    for (int i = 8; i < 18; ++i) {
      brick.foot = {0.024 * i, side, 0.0};
      layout.bricks.push_back(brick);
    }
  }
  const RigidRun run = run_rigid(layout, 0.0, 10.0);
  CHECK(run.progress == Progress::at_rest);
  CHECK(count_fallen(layout, run) == 28);
  // Mirror images about the row: both branches arrive together, as far as sweeps of 1e-5 of the speed tell.
  for (std::size_t i = 8; i < 18; ++i) CHECK(run.arrival[i] == doctest::Approx(run.arrival[i + 10]).epsilon(0.002));
}

TEST_CASE("rigid: rows far from each other fall as each does alone") {
  const Layout one = straight_row(10, 0.024);
  Layout two = one;
  for (const Brick& brick : one.bricks) {
    Brick other = brick;
    other.foot.y = 0.5;
    two.bricks.push_back(other);
  }
  two.pushes.push_back({10, 0.0, AngularSpeedPush{4.0}});
  const RigidRun alone = run_rigid(one, 0.0, 10.0);
  const RigidRun both = run_rigid(two, 0.0, 10.0);
  for (std::size_t i = 0; i < 10; ++i) CHECK(both.arrival[i] == alone.arrival[i]);
}

TEST_CASE("rigid: a brick out of reach is never moved") {
  Layout layout = straight_row(5, 0.024);
  layout.bricks[4].foot.x = 0.5;
  const RigidRun run = run_rigid(layout, 0.0, 10.0);
  CHECK(std::isnan(run.arrival[4]));
  CHECK(run.last[4].position.x == 0.5);
}

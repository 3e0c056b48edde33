// A wave that runs: steady over any length, and as fast as the cooperative chain where floor and bricks hold still.
#include "rigid_scene.h"

using namespace topple;
using namespace topple::test;

namespace {

/// The largest relative difference of the speeds of stretches of sixteen bricks, from brick 16 to the last but sixteen, from the first's.
double drift_of_speed(int count) {
  constexpr std::size_t kStretch = 16;
  const RigidRun run = run_rigid(straight_row(count, 0.024), 0.0, 1e9);
  const double first = run.arrival[2 * kStretch] - run.arrival[kStretch];
  double most = 0.0;
  for (std::size_t i = 2 * kStretch; i + 2 * kStretch <= run.arrival.size(); i += kStretch) {
    most = std::max(most, std::abs((run.arrival[i + kStretch] - run.arrival[i]) / first - 1.0));
  }
  return most;
}

}  // namespace

TEST_CASE("rigid: the front is steady from brick 16 to brick 1,000 within 0.1 percent") { CHECK(drift_of_speed(1'000) < 0.001); }

// build/release/test_model --no-skip --test-case="*brick 100*": some ten seconds.
TEST_CASE("rigid: the front is steady from brick 16 to brick 100,000 within 0.1 percent" * doctest::skip()) {
  CHECK(drift_of_speed(100'000) < 0.001);
}

TEST_CASE("rigid: on a floor of friction 2 a row of gap 24 mm runs as fast as the hinged chain within half a percent") {
  // [vanLeeuwen2010]: a gap of half the height and friction 0.2 give 1.3012 sqrt(g h).
  const double pitch = 0.024 + 0.0075;
  const RigidRun run = run_rigid(straight_row(60, pitch, {.brick_friction = 0.2, .floor_friction = 2.0}), 0.0, 10.0);
  const double speed = front_speed(run, pitch) / std::sqrt(9.81 * 0.048);
  CHECK(std::abs(speed / 1.3012 - 1.0) < 0.005);
}

// Many fronts: what each sees of the others, and that threads change nothing.
#include "base/crew.h"
#include "rigid_scene.h"

using namespace topple;
using namespace topple::test;

namespace {

// Rows side by side, each pushed a little harder than the one before.
Layout rows_side_by_side(int rows, int count, double row_pitch) {
  Layout layout = straight_row(0, 0.024);
  layout.parts.clear();
  layout.pushes.clear();
  for (int row = 0; row < rows; ++row) {
    const BrickId first = layout.brick_count();
    for (int i = 0; i < count; ++i) {
      Brick brick;
      brick.foot = {0.024 * i, row_pitch * row, 0.0};
      layout.bricks.push_back(brick);
    }
    layout.parts.push_back({"row", first, count});
    layout.pushes.push_back({first, 0.01 * row, AngularSpeedPush{4.0 + 0.05 * row}});
  }
  return layout;
}

// A row whose two ends fall towards its middle.
Layout towards_each_other(int count) {
  Layout layout = straight_row(count, 0.024);
  for (std::size_t i = static_cast<std::size_t>(count) / 2; i < static_cast<std::size_t>(count); ++i) layout.bricks[i].heading = kPi;
  layout.pushes.push_back({count - 1, 0.0, AngularSpeedPush{4.0}});
  return layout;
}

std::uint64_t hash_with(const Layout& layout, int threads) {
  Crew crew(threads);
  auto model = rigid::make_rigid_model(layout, {.crew = &crew});
  REQUIRE(model.has_value());
  Frame frame;
  for (int step = 0; step < 5000; ++step) {
    if ((*model)->step().progress != Progress::running) break;
    (*model)->read(frame);
  }
  return (*model)->hash();
}

}  // namespace

TEST_CASE("rigid: a field of rows has one hash for one, two and four threads") {
  const Layout layout = rows_side_by_side(9, 8, 0.04);
  const std::uint64_t alone = hash_with(layout, 1);
  CHECK(hash_with(layout, 2) == alone);
  CHECK(hash_with(layout, 4) == alone);
}

TEST_CASE("rigid: two waves that take the same brick in the same step have one hash for one, two and four threads") {
  const Layout layout = towards_each_other(13);
  const std::uint64_t alone = hash_with(layout, 1);
  CHECK(hash_with(layout, 2) == alone);
  CHECK(hash_with(layout, 4) == alone);
}

TEST_CASE("rigid: two waves of one row meet, and every brick is struck once and comes to rest") {
  for (const int count : {12, 13}) {
    const Layout layout = towards_each_other(count);
    const RigidRun run = run_rigid(layout, 0.0, 10.0);
    CHECK(run.progress == Progress::at_rest);
    CHECK(run.energy_rise < 0.001 * run.released);
    // Mirror images until they meet, to what the solver of the meeting leaves.
    for (std::size_t i = 0; i < 4; ++i) CHECK(run.arrival[i] == doctest::Approx(run.arrival[run.arrival.size() - 1 - i]).epsilon(1e-6));
  }
}

TEST_CASE("rigid: rows of a field fall as each does alone") {
  const Layout layout = rows_side_by_side(3, 8, 0.03);
  const RigidRun run = run_rigid(layout, 0.0, 10.0);
  CHECK(run.progress == Progress::at_rest);
  for (std::size_t row = 0; row < 3; ++row) {
    Layout one = straight_row(8, 0.024);
    one.pushes[0] = layout.pushes[row];
    one.pushes[0].brick = 0;
    const RigidRun alone = run_rigid(one, 0.0, 10.0);
    for (std::size_t i = 0; i < 8; ++i) CHECK(run.arrival[8 * row + i] == alone.arrival[i]);
  }
}

TEST_CASE("rigid: behind a brick that stands a little aside the row becomes straight, and no brick leaves its plane") {
  // 0.1 mm is 1.3 % of the thickness: more than rounding, so that the front begins with six degrees of freedom; less than the 5 % at which
  // a row counts as straight again.
  Layout layout = straight_row(60, 0.024);
  layout.bricks[3].foot.y = 1e-4;
  const RigidRun run = run_rigid(layout, 0.0, 10.0);
  const RigidRun straight = run_rigid(straight_row(60, 0.024), 0.0, 10.0);
  CHECK(run.progress == Progress::at_rest);
  for (std::size_t i = 40; i < 60; ++i) {
    CHECK(std::abs(run.last[i].position.y) < 1e-15);
    CHECK(std::abs(run.last[i].orientation.x) + std::abs(run.last[i].orientation.z) < 1e-15);
    CHECK(run.arrival[i] - run.arrival[39] == doctest::Approx(straight.arrival[i] - straight.arrival[39]).epsilon(0.0025));
  }
}

TEST_CASE("rigid: behind a brick that stands turned by a degree a row goes on at its speed, and straight again") {
  Layout layout = straight_row(60, 0.024);
  layout.bricks[3].heading = 0.017;
  const RigidRun run = run_rigid(layout, 0.0, 10.0);
  const RigidRun straight = run_rigid(straight_row(60, 0.024), 0.0, 10.0);
  CHECK(run.progress == Progress::at_rest);
  CHECK(run.arrival[59] - run.arrival[30] == doctest::Approx(straight.arrival[59] - straight.arrival[30]).epsilon(0.0025));
  CHECK(std::abs(run.last[59].position.y) < 1e-15);
}

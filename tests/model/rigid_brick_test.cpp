// One brick against closed forms.
#include "rigid_scene.h"

using namespace topple;
using namespace topple::test;

namespace {

Layout one_brick(double angular_speed, const Surface& surface) {
  Layout layout = straight_row(1, 0.024, surface);
  layout.pushes[0].how = AngularSpeedPush{angular_speed};
  return layout;
}

double final_tilt(const Layout& layout) {
  const RigidRun run = run_rigid(layout, 0.0, 20.0);
  CHECK(run.progress == Progress::at_rest);
  return degrees(tilt(layout, 0, run.last[0].orientation));
}

}  // namespace

TEST_CASE("rigid: the least push that topples a brick is sqrt(2) lambda sqrt(1 - cos(tip angle))") {
  // 2.69481 rad/s for 48 x 7.5 mm: the energy that lifts the centre of mass over the toe. 0.1 % to either side.
  CHECK(final_tilt(one_brick(2.69481 * 0.999, {.floor_friction = 2.0})) < 1.0);
  CHECK(final_tilt(one_brick(2.69481 * 1.001, {.floor_friction = 2.0})) > 89.0);
}

TEST_CASE("rigid: a brick falls over its toe as fast as its energy says") {
  // Without sliding w^2 = w0^2 + (3 g / (2 r)) (cos(tip) - cos(angle - tip)), r half the diagonal: I = 4/3 m r^2 about the toe.
  const Layout layout = one_brick(4.0, {.floor_friction = 5.0});
  auto model = rigid::make_rigid_model(layout, {.time_step = 0.001});
  REQUIRE(model.has_value());
  Frame frame;
  const double r = 0.5 * std::hypot(0.048, 0.0075), tip = std::atan2(0.0075, 0.048);
  int compared = 0;
  for (int i = 0; i < 250; ++i) {
    (*model)->step();
    (*model)->read(frame);
    const double angle = tilt(layout, 0, frame.free[0].pose.orientation);
    // Beyond 48 degrees from the balance the floor would have to pull.
    if (angle < 0.05 || angle > 0.8) continue;
    const double expected = std::sqrt(16.0 + 3.0 * 9.81 / (2.0 * r) * (std::cos(tip) - std::cos(angle - tip)));
    CHECK(frame.free[0].angular_velocity.y == doctest::Approx(expected).epsilon(0.001));
    ++compared;
  }
  CHECK(compared > 20);
}

TEST_CASE("rigid: a brick in free flight follows a parabola and does not spin") {
  Layout layout = straight_row(1, 0.024);
  layout.bricks[0].foot.z = 1.0;
  // A blow at the height of the centre of mass: 1 m/s.
  layout.pushes[0].how = ImpulsePush{layout.kinds[0].mass, 0.024};
  auto model = rigid::make_rigid_model(layout, {.time_step = 0.002});
  REQUIRE(model.has_value());
  Frame frame;
  for (int i = 0; i < 100; ++i) {
    (*model)->step();
    (*model)->read(frame);
    const double t = frame.time;
    // The scheme is exact for a constant force.
    CHECK(frame.free[0].pose.position.x == doctest::Approx(t).epsilon(1e-9));
    CHECK(frame.free[0].pose.position.z == doctest::Approx(1.024 - 0.5 * 9.81 * t * t).epsilon(1e-9));
    CHECK(norm(frame.free[0].angular_velocity) < 1e-9);
  }
}

TEST_CASE("rigid: a brick that lands on its foot bounces to restitution squared times its height") {
  Layout layout = straight_row(1, 0.024, {.floor_restitution = 0.6});
  const double drop = 0.02;
  layout.bricks[0].foot.z = drop;
  layout.pushes[0].how = ImpulsePush{1e-12, 0.024};
  auto model = rigid::make_rigid_model(layout, {.time_step = 0.001});
  REQUIRE(model.has_value());
  Frame frame;
  double lowest = 1.0, highest_after = 0.0;
  for (int i = 0; i < 120; ++i) {
    (*model)->step();
    (*model)->read(frame);
    const double foot = frame.free[0].pose.position.z - 0.024;
    lowest = std::min(lowest, foot);
    if (frame.time > 0.075) highest_after = std::max(highest_after, foot);
  }
  CHECK(lowest > -1e-5);
  // It lands after 63.9 ms and is highest 38.3 ms later; frames a millisecond apart miss the top by at most g dt^2 / 8 = 1.2 um of 7.2 mm.
  CHECK(highest_after == doctest::Approx(0.36 * drop).epsilon(0.001));
}

TEST_CASE("rigid: a brick pushed too softly returns to standing and rests") { CHECK(final_tilt(one_brick(1.0, {})) < 0.1); }

TEST_CASE("rigid: a force and a blow do the work that the energy shows") {
  for (int way = 0; way < 2; ++way) {
    Layout layout = straight_row(1, 0.024);
    if (way == 0) layout.pushes[0].how = ForcePush{0.05, 0.045, 0.05};
    if (way == 1) layout.pushes[0].how = ImpulsePush{0.002, 0.045};
    const RigidRun run = run_rigid(layout, 0.001, 5.0);
    CAPTURE(way);
    CHECK(run.released > 0.0);
    CHECK(run.energy_rise < 0.001 * run.released);
    CHECK(degrees(tilt(layout, 0, run.last[0].orientation)) > 80.0);
  }
}

TEST_CASE("rigid: a step that is far too long is refused in words") {
  const Layout layout = straight_row(3, 0.024);
  const auto model = rigid::make_rigid_model(layout, {.time_step = 1.0});
  REQUIRE_FALSE(model.has_value());
  CHECK(model.error().message.find("time_step_s") != std::string::npos);
}

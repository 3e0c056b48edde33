// One brick against more closed forms: slope, spin, rocking, the onset of sliding; and a field with its line.
#include <array>

#include "rigid_scene.h"

using namespace topple;
using namespace topple::test;

namespace {

constexpr double kGravity = 9.81;

/// Where the brick is after so long, one frame a step.
template <typename Watch>
void watch(const Layout& layout, double time_step, double until, Watch see) {
  auto model = rigid::make_rigid_model(layout, {.time_step = time_step});
  REQUIRE(model.has_value());
  Frame frame;
  while (frame.time < until) {
    (*model)->step();
    (*model)->read(frame);
    if (!frame.free.empty()) see(frame.time, frame.free[0]);
  }
}

/// A brick under a steady force at the height of its centre of mass: what a slope of this tangent does to it, its weight aside.
Layout on_slope(double tangent, double friction) {
  Layout layout = straight_row(1, 0.024, {.floor_friction = friction});
  layout.pushes[0].how = ForcePush{layout.kinds[0].mass * kGravity * tangent, 0.024, 1.0};
  return layout;
}

}  // namespace

TEST_CASE("rigid: on a slope a brick slides where friction is less than thickness over height, else it tips") {
  // d / h = 0.15625. Friction 0.1: it slides from a tangent of 0.1 on, with g (tangent - friction). Friction 0.5: it tips from 0.15625 on.
  Vec3 place;
  watch(on_slope(0.12, 0.1), 0.001, 0.2, [&](double time, const FreeMotion& brick) {
    place = brick.pose.position;
    CHECK(place.x == doctest::Approx(0.5 * kGravity * 0.02 * time * time).epsilon(0.001));
    CHECK(norm(brick.angular_velocity) < 3e-4);  // the solver's 1e-5 sqrt(g h) at half the height
  });
  CHECK(place.x > 0.003);
  watch(on_slope(0.0999, 0.1), 0.001, 0.2, [&](double, const FreeMotion& brick) { CHECK(std::abs(brick.pose.position.x) < 1e-7); });
  double turning = 0.0;
  const auto see = [&](double, const FreeMotion& brick) { turning = brick.angular_velocity.y; };
  watch(on_slope(0.15625 * 1.001, 0.5), 0.001, 0.2, see);
  CHECK(turning > 1e-3);
  watch(on_slope(0.15625 * 0.999, 0.5), 0.001, 0.2, see);
  CHECK(std::abs(turning) < 1e-6);
}

TEST_CASE("rigid: a brick in free flight that is struck off its centre spins at arm x impulse / inertia") {
  Layout layout = straight_row(1, 0.024);
  layout.bricks[0].foot.z = 1.0;
  layout.pushes[0].how = ImpulsePush{0.001, 0.034};
  const BrickKind& kind = layout.kinds[0];
  const double inertia = kind.mass * (kind.height * kind.height + kind.thickness * kind.thickness) / 12.0;
  watch(layout, 0.002, 0.3, [&](double, const FreeMotion& brick) {
    CHECK(brick.angular_velocity.y == doctest::Approx(0.010 * 0.001 / inertia).epsilon(1e-9));
    CHECK(brick.velocity.x == doctest::Approx(0.001 / kind.mass).epsilon(1e-9));
  });
}

TEST_CASE("rigid: a brick that rocks rises as high as its energy says, and returns") {
  // 2/3 r w^2 = g (cos(tip - angle) - cos(tip)) about the toe; r half the diagonal.
  const Layout layout = [] {
    Layout one = straight_row(1, 0.024, {.floor_friction = 2.0});
    one.pushes[0].how = AngularSpeedPush{2.0};
    return one;
  }();
  const double r = 0.5 * std::hypot(0.048, 0.0075), tip = std::atan2(0.0075, 0.048);
  const double highest = tip - std::acos(std::cos(tip) + 2.0 / 3.0 * r * 4.0 / kGravity);
  double most = 0.0, last = 1.0;
  watch(layout, 0.0005, 2.0, [&](double, const FreeMotion& brick) {
    last = tilt(layout, 0, brick.pose.orientation);
    most = std::max(most, last);
  });
  // Half a step from the top it is lower by at most rate^2's share: 30 rad/s^2 x (0.25 ms)^2 / 2 = 1e-6 rad.
  CHECK(most == doctest::Approx(highest).epsilon(0.001));
  CHECK(last < 1e-3);
}

TEST_CASE("rigid: the foot of a falling brick begins to slide where friction is spent") {
  // From rest at the balance F / N = 3 sin(psi) (3 cos(psi) - 2) / (3 cos(psi) - 1)^2, psi from the balance on; backwards below 0.37.
  // The push is 0.05 % above the least one, so it passes the balance almost at rest. Sliding begins with no acceleration, so it shows late:
  // by the time the toe has gone 1e-5 of the height the brick is up to two degrees farther. (With friction 0.1 it slides before the
  // balance, too: F / N is 0.12 where it stands.)
  const std::array<std::pair<double, double>, 2> onsets{{{0.2, 15.52}, {0.3, 24.166}}};
  const double tip = std::atan2(0.0075, 0.048);
  for (const auto& [friction, degrees_on] : onsets) {
    Layout layout = straight_row(1, 0.024, {.floor_friction = friction});
    layout.pushes[0].how = AngularSpeedPush{2.694811 * 1.0005};
    double seen = 0.0;
    watch(layout, 0.0005, 1.0, [&](double, const FreeMotion& brick) {
      const Vec3 toe = brick.pose.position + rotate(brick.pose.orientation, Vec3{0.00375, 0.0, -0.024});
      if (seen == 0.0 && toe.x < 0.00375 - 1e-5 * 0.048) seen = degrees(tilt(layout, 0, brick.pose.orientation) - tip);
    });
    CAPTURE(friction);
    CHECK(seen > degrees_on - 0.1);
    CHECK(seen < degrees_on + 2.5);
  }
}

TEST_CASE("rigid: the line of a field lets every row go") {
  auto layout = read_layout(
      "[[push]]\nbrick = 0\nangular_speed_rad_s = 4\n[[field]]\nrows = 2\ncount = 3\npitch_mm = 24\nrow_pitch_mm = 75\nstarter = "
      "\"line\"\n",
      "test.toml");
  REQUIRE(layout.has_value());
  const RigidRun run = run_rigid(*layout, 0.0, 1.5);
  for (const double arrival : run.arrival) CHECK_FALSE(std::isnan(arrival));
}

// A rolling ball.
#include "rigid_scene.h"

using namespace topple;
using namespace topple::test;

namespace {

struct Watched {
  std::vector<double> time, x;
  FreeMotion last;
};

Watched watch_ball(const Layout& layout, double until) {
  auto model = rigid::make_rigid_model(layout, {});
  REQUIRE(model.has_value());
  Frame frame;
  Watched watched;
  while (frame.time < until) {
    if ((*model)->step().progress != Progress::running) break;
    (*model)->read(frame);
    for (const FreeMotion& motion : frame.free) {
      if (motion.brick != 0) continue;
      watched.time.push_back(frame.time);
      watched.x.push_back(motion.pose.position.x);
      watched.last = motion;
    }
  }
  return watched;
}

}  // namespace

TEST_CASE("rigid: a ball rolls on at its speed, turning as fast as it moves") {
  const Layout layout = layout_of("[[ball]]\nat_mm = [0, 0]\nspeed_m_s = 0.5\nrolling_friction = 0\n");
  const Watched ball = watch_ball(layout, 1.0);
  CHECK(ball.last.velocity.x == doctest::Approx(0.5).epsilon(1e-9));
  CHECK(ball.last.angular_velocity.y == doctest::Approx(0.5 / 0.008).epsilon(1e-9));
  CHECK(ball.x.back() == doctest::Approx(0.5 * ball.time.back()).epsilon(1e-9));
  CHECK(ball.last.pose.position.z == doctest::Approx(0.008).epsilon(1e-9));
}

TEST_CASE("rigid: a ball that is struck at its middle slides until it rolls at five sevenths of its speed") {
  // Friction takes m v' = -mu m g and 2/5 m r^2 w' = mu m g r: v = r w when v = 5/7 of the beginning, whatever the friction.
  Layout layout = layout_of("[contact]\nfloor_friction = 0.3\n[[ball]]\nat_mm = [0, 0]\nrolling_friction = 0\n");
  layout.pushes = {{0, 0.0, ImpulsePush{layout.kinds.back().mass * 0.7, 0.008}}};
  const Watched ball = watch_ball(layout, 1.0);
  CHECK(ball.last.velocity.x == doctest::Approx(0.5).epsilon(1e-3));
  CHECK(ball.last.angular_velocity.y * 0.008 == doctest::Approx(ball.last.velocity.x).epsilon(1e-6));
}

TEST_CASE("rigid: a ball that rolls stops after v^2 / (2 x 5/7 x rolling friction x g)") {
  const Layout layout = layout_of("[[ball]]\nat_mm = [0, 0]\nspeed_m_s = 0.5\nrolling_friction = 0.05\n");
  const Watched ball = watch_ball(layout, 20.0);
  CHECK(ball.x.back() == doctest::Approx(0.25 / (2.0 * 5.0 / 7.0 * 0.05 * 9.81)).epsilon(0.01));
}

TEST_CASE("rigid: a ball that hits a heavy ball head on comes to rest, and the other goes on with the restitution's share") {
  // Newton's cradle of two on a floor without friction: equal masses, e = 0.8: speeds (1 - e) / 2 and (1 + e) / 2 of the first.
  const Layout layout = layout_of(
      "[contact]\nfloor_friction = 0\nbrick_friction = 0\nbrick_restitution = 0.8\n[[ball]]\nat_mm = [0, 0]\nspeed_m_s = 0.4\n"
      "rolling_friction = 0\n[[ball]]\nat_mm = [40, 0]\nrolling_friction = 0\n");
  auto model = rigid::make_rigid_model(layout, {});
  REQUIRE(model.has_value());
  Frame frame;
  while (frame.time < 0.3) {
    (*model)->step();
    (*model)->read(frame);
  }
  REQUIRE(frame.free.size() == 2);
  CHECK(frame.free[0].velocity.x == doctest::Approx(0.04).epsilon(1e-3));
  CHECK(frame.free[1].velocity.x == doctest::Approx(0.36).epsilon(1e-3));
}

TEST_CASE("rigid: a rolling ball starts a row, without making energy") {
  const Layout layout = layout_of(
      "[[ball]]\nat_mm = [-60, 0]\nspeed_m_s = 0.6\ndiameter_mm = 30\nrolling_friction = 0.02\n[[row]]\ncount = 6\ngap_mm = 16.5\n");
  const RigidRun run = run_rigid(layout, 0.0, 10.0);
  CHECK(run.struck_by[1] == 0);
  for (std::size_t i = 1; i < 7; ++i) CHECK_FALSE(std::isnan(run.arrival[i]));
  CHECK(run.energy_rise < 0.001 * run.released);
}

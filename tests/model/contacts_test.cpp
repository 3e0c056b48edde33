// What the models say about the forces at contacts, against the motion that they give.
#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "base/trigonometry.h"
#include "model/hinge/hinge_model.h"
#include "model/rigid/rigid_model.h"
#include "rigid_scene.h"

using namespace topple;
using namespace topple::test;

namespace {

/// Contact force on each brick, all points together [N].
std::map<BrickId, Vec3> pressed(const Model& model) {
  std::map<BrickId, Vec3> sum;
  for (const Contact& contact : model.contacts()) {
    sum[contact.a] = sum[contact.a] + contact.force;
    if (contact.b != kNoBrick) sum[contact.b] = sum[contact.b] - contact.force;
  }
  return sum;
}

std::map<BrickId, Vec3> places(const Model& model) {
  Frame frame;
  model.read(frame);
  std::map<BrickId, Vec3> centres;
  for (const FreeMotion& motion : frame.free) centres[motion.brick] = motion.pose.position;
  return centres;
}

// A leapfrog's places obey m (x(n+1) - 2 x(n) + x(n-1)) / dt^2 = force at n + weight exactly, as long as nothing strikes and steps end
// where drifts do; where they end amid drifts, a part of the next force is in it. Bricks that lean on each other knock again without an
// event: then the count of points that press changes.
int compare_with_motion(const Layout& layout, int steps) {
  auto model = rigid::make_rigid_model(layout, {});
  REQUIRE(model.has_value());
  const double weight = layout.kinds[0].mass * layout.gravity;
  const double dt = (*model)->time_step();
  int compared = 0;
  std::map<BrickId, Vec3> before, now, forces, forces_before;
  int quiet = 0;  // Steps without an impact, up to now.
  std::size_t touching = 0;
  for (int step = 0; step < steps; ++step) {
    (*model)->step();
    const std::map<BrickId, Vec3> next = places(**model);
    std::map<BrickId, Vec3> forces_next = pressed(**model);
    const std::size_t count = (*model)->contacts().size();
    quiet = (*model)->events().empty() && count == touching ? quiet + 1 : 0;
    touching = count;
    for (const auto& [brick, centre] : next) {
      if (quiet < 4 || !before.contains(brick) || !now.contains(brick)) continue;
      const Vec3 acceleration = (1.0 / (dt * dt)) * (centre - 2.0 * now[brick] + before[brick]);
      const Vec3 wanted = layout.kinds[0].mass * acceleration + Vec3{0.0, 0.0, weight};
      const Vec3 off = forces[brick] - wanted;
      const double change = norm(forces_next[brick] - forces[brick]) + norm(forces[brick] - forces_before[brick]);
      INFO("step ", step, " brick ", brick);
      // Where two bricks move or fewer a step is three shorter ones, and the force at its beginning is not quite that of its middle.
      CHECK(norm(off) < (before.size() > 2 ? 1e-6 : 1e-3) * weight + change);
      CHECK(change < 0.5 * weight);
      ++compared;
    }
    before = now;
    now = next;
    forces_before = std::move(forces);
    forces = std::move(forces_next);
  }
  return compared;
}

}  // namespace

TEST_CASE("rigid: the contact forces of a falling row are what its bricks' accelerations need, in a plane and along a curve") {
  CHECK(compare_with_motion(straight_row(6, 0.024), 48) > 20);
  const Layout curve = layout_of(
      "[[push]]\nbrick = 0\nangular_speed_rad_s = 4.0\n[[curve]]\npoints_mm = [[0, 0], [60, 8], [120, 40], [150, 100]]\ngap_mm = 16.5\n");
  CHECK(compare_with_motion(curve, 48) > 20);
}

TEST_CASE("rigid: the floor carries the weight of a stack, and so does each brick what lies on it") {
  Layout layout = straight_row(3, 0.0);
  for (int i = 0; i < 3; ++i) layout.bricks[static_cast<std::size_t>(i)].foot.z = i * 0.048;
  layout.pushes.clear();
  auto model = rigid::make_rigid_model(layout, {.every_brick_moves = true});
  REQUIRE(model.has_value());
  for (int step = 0; step < 50; ++step) (*model)->step();
  const double weight = layout.kinds[0].mass * layout.gravity;
  std::map<std::pair<BrickId, BrickId>, double> carried;
  for (const Contact& contact : (*model)->contacts()) carried[{contact.a, contact.b}] += contact.force.z;
  CHECK(carried[{0, kNoBrick}] == doctest::Approx(3.0 * weight).epsilon(1e-3));
  CHECK(std::fabs(carried[{1, 0}] + carried[{0, 1}]) == doctest::Approx(2.0 * weight).epsilon(1e-3));
  CHECK(std::fabs(carried[{2, 1}] + carried[{1, 2}]) == doctest::Approx(weight).epsilon(1e-3));
}

TEST_CASE("hinge: the contact forces of a row give each of its bricks the angular acceleration that it has") {
  const Layout layout = straight_row(12, 0.024, {.brick_friction = 0.2});
  auto model = hinge::make_hinge_model(layout, {.time_step = 0.004});
  REQUIRE(model.has_value());
  const BrickKind& kind = layout.kinds[0];
  const double inertia = kind.mass * (kind.height * kind.height + kind.thickness * kind.thickness) / 3.0;
  Frame frame;
  int compared = 0;
  while ((*model)->step().progress == Progress::running) {
    (*model)->read(frame);
    const auto contacts = (*model)->contacts();
    for (const HingedMotion& motion : frame.hinged) {
      if (motion.phase != Phase::falling) continue;
      // The last of the train also feels the bricks that rest on it; where that is so, no force of the floor is given for it.
      bool is_known = false;
      const double toe = layout.bricks[static_cast<std::size_t>(motion.brick)].foot.x + 0.5 * kind.thickness;
      const double s = std::sin(motion.state.angle), c = std::cos(motion.state.angle);
      double torque = 0.5 * kind.mass * layout.gravity * (kind.height * s - kind.thickness * c);
      Vec3 force;
      for (const Contact& contact : contacts) {
        const double side = contact.a == motion.brick ? 1.0 : contact.b == motion.brick ? -1.0 : 0.0;
        if (contact.a == motion.brick && contact.b == kNoBrick) is_known = true;
        torque += side * (contact.point.z * contact.force.x - (contact.point.x - toe) * contact.force.z);
        force = force + side * contact.force;
      }
      if (!is_known) continue;
      ++compared;
      INFO("t ", frame.time, " brick ", motion.brick);
      const double weight_torque = 0.5 * kind.mass * layout.gravity * kind.height;
      CHECK(std::fabs(torque - inertia * motion.state.acceleration) < 1e-9 * weight_torque);
      // The centre is half a diagonal from the toe: along = (h s - d c) / 2, up = (h c + d s) / 2.
      const double along = 0.5 * (kind.height * s - kind.thickness * c), up = 0.5 * (kind.height * c + kind.thickness * s);
      const double w2 = motion.state.rate * motion.state.rate;
      CHECK(force.x == doctest::Approx(kind.mass * (up * motion.state.acceleration - along * w2)).epsilon(1e-9));
      CHECK(force.z == doctest::Approx(kind.mass * (-along * motion.state.acceleration - up * w2 + layout.gravity)).epsilon(1e-9));
    }
  }
  CHECK(compared > 100);
}

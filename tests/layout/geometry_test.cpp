#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "base/random.h"
#include "base/trigonometry.h"
#include "topple/layout.h"

namespace topple {
namespace {

constexpr double kThickness = 0.0075, kWidth = 0.024, kHeight = 0.048;

Layout one_brick(Stance stance, double heading, Vec3 foot = {0.3, -0.2, 0.0}) {
  Layout layout;
  layout.kinds.push_back({});
  layout.colors.push_back({});
  layout.bricks.push_back({.foot = foot, .heading = heading, .kind = 0, .color = 0, .stance = stance});
  return layout;
}

/// The eight corners of a brick in the world.
std::array<Vec3, 8> corners(const Pose& pose, const Vec3& half) {
  std::array<Vec3, 8> out;
  for (unsigned n = 0; n < 8; ++n) {
    const Vec3 own{n & 1U ? half.x : -half.x, n & 2U ? half.y : -half.y, n & 4U ? half.z : -half.z};
    out[n] = pose.position + rotate(pose.orientation, own);
  }
  return out;
}

void check_near(const Vec3& a, const Vec3& b) { CHECK(norm(a - b) < 1e-15); }

}  // namespace

TEST_CASE("a standing brick has its thickness along, its width across and its height up") {
  const Extents standing = extents({}, Stance::standing);
  CHECK(standing.along == kThickness);
  CHECK(standing.across == kWidth);
  CHECK(standing.up == kHeight);
  const Extents flat = extents({}, Stance::flat);
  CHECK(flat.along == kHeight);
  CHECK(flat.across == kWidth);
  CHECK(flat.up == kThickness);
  const Extents on_side = extents({}, Stance::on_side);
  CHECK(on_side.along == kThickness);
  CHECK(on_side.across == kHeight);
  CHECK(on_side.up == kWidth);
}

TEST_CASE("the tip angle of the report's brick is that of its diagonal") {
  CHECK(tip_angle({.along = 0.00679, .across = 0.02156, .up = 0.04353}) == doctest::Approx(std::atan(0.679 / 4.353)).epsilon(1e-15));
}

TEST_CASE("whatever its stance and heading, the box of a brick as put down has the extents of the stance and stands on its foot") {
  for (const Stance stance : {Stance::standing, Stance::flat, Stance::on_side}) {
    for (const double heading : {0.0, 0.7, kPi / 2.0, -2.5}) {
      const Layout layout = one_brick(stance, heading, {0.3, -0.2, 0.05});
      const Extents size = extents(layout.kinds[0], stance);
      const Vec3 ahead{std::cos(heading), std::sin(heading), 0.0}, left{-std::sin(heading), std::cos(heading), 0.0};
      Vec3 low{1.0, 1.0, 1.0}, high{-1.0, -1.0, -1.0};
      for (const Vec3& corner : corners(standing_pose(layout, 0), half_extents(layout.kinds[0]))) {
        const Vec3 from = corner - layout.bricks[0].foot;
        low = {std::fmin(low.x, dot(from, ahead)), std::fmin(low.y, dot(from, left)), std::fmin(low.z, from.z)};
        high = {std::fmax(high.x, dot(from, ahead)), std::fmax(high.y, dot(from, left)), std::fmax(high.z, from.z)};
      }
      check_near(low, {-size.along / 2.0, -size.across / 2.0, 0.0});
      check_near(high, {size.along / 2.0, size.across / 2.0, size.up});
    }
  }
}

TEST_CASE("a hinged brick that has not turned stands where it was put down, to the last bit") {
  for (const Stance stance : {Stance::standing, Stance::flat, Stance::on_side}) {
    const Layout layout = one_brick(stance, 0.7);
    const Pose put = standing_pose(layout, 0), turned = hinged_pose(layout, 0, 0.0);
    CHECK(put.position == turned.position);
    CHECK(put.orientation == turned.orientation);
  }
}

TEST_CASE("a brick that turns the way it heads keeps its toe where it is, one that turns back keeps its heel") {
  for (const Stance stance : {Stance::standing, Stance::flat, Stance::on_side}) {
    for (const double angle : {0.1, 1.2, kPi / 2.0, -0.1, -1.2, -kPi / 2.0}) {
      const double heading = 0.7;
      const Layout layout = one_brick(stance, heading);
      const Extents size = extents(layout.kinds[0], stance);
      const Vec3 ahead{std::cos(heading), std::sin(heading), 0.0}, left{-std::sin(heading), std::cos(heading), 0.0};
      const Vec3 edge = layout.bricks[0].foot + std::copysign(size.along / 2.0, angle) * ahead;
      const Pose pose = hinged_pose(layout, 0, angle);
      double lowest = 1.0, nearest_left = 1.0, nearest_right = 1.0;
      for (const Vec3& corner : corners(pose, half_extents(layout.kinds[0]))) {
        lowest = std::fmin(lowest, corner.z);
        nearest_left = std::fmin(nearest_left, norm(corner - (edge + 0.5 * size.across * left)));
        nearest_right = std::fmin(nearest_right, norm(corner - (edge - 0.5 * size.across * left)));
      }
      CHECK(std::abs(lowest) < 1e-15);  // it turns about an edge on the floor: nothing sinks below
      CHECK(nearest_left < 1e-15);
      CHECK(nearest_right < 1e-15);
      CHECK(tilt(layout, 0, pose.orientation) == doctest::Approx(std::abs(angle)).epsilon(1e-14));
      // Turned by a quarter, the face ahead (or behind) is on the floor and the centre is half a height beyond the edge.
      if (std::abs(angle) == kPi / 2.0) {
        const Vec3 centre = edge + std::copysign(size.up / 2.0, angle) * ahead + Vec3{0.0, 0.0, size.along / 2.0};
        check_near(pose.position, centre);
      }
    }
  }
}

TEST_CASE("the tilt of a brick does not depend on its heading nor on a turn about the vertical") {
  for (const Stance stance : {Stance::standing, Stance::flat, Stance::on_side}) {
    const Layout layout = one_brick(stance, 2.0);
    CHECK(tilt(layout, 0, standing_pose(layout, 0).orientation) < 1e-15);
    const SinCos spin = sin_cos(0.4);
    const Quat spun = Quat{spin.cos, 0.0, 0.0, spin.sin} * hinged_pose(layout, 0, 0.9).orientation;
    CHECK(tilt(layout, 0, spun) == doctest::Approx(0.9).epsilon(1e-14));
  }
}

}  // namespace topple

// The same layout in another place, mirrored, turned, larger or under another gravity falls in the same way.
#include "rigid_scene.h"

using namespace topple;
using namespace topple::test;

namespace {

/// About the x axis.
Layout mirrored(Layout layout) {
  for (Brick& brick : layout.bricks) {
    brick.foot.y = -brick.foot.y;
    brick.heading = -brick.heading;
  }
  return layout;
}

/// Lengths times `scale`, gravity times `pull`: Froude's law makes times longer by sqrt(scale / pull).
Layout scaled(Layout layout, double scale, double pull) {
  layout.gravity *= pull;
  for (BrickKind& kind : layout.kinds) {
    kind.height *= scale;
    kind.width *= scale;
    kind.thickness *= scale;
    kind.mass *= scale * scale * scale;
  }
  for (Brick& brick : layout.bricks) brick.foot = scale * brick.foot;
  for (Push& push : layout.pushes) std::get<AngularSpeedPush>(push.how).angular_speed *= std::sqrt(pull / scale);
  return layout;
}

// A quarter of a circle in ten bricks, between two straight pieces.
Layout turn_of_ten(double restitution) {
  Layout layout = straight_row(0, 0.024, {.brick_restitution = restitution, .floor_restitution = restitution});
  Brick brick;
  for (int i = 0; i < 18; ++i) {
    layout.bricks.push_back(brick);
    const double next = brick.heading + (i >= 3 && i < 13 ? 0.05 * kPi : 0.0);
    const double middle = 0.5 * (brick.heading + next);
    brick.foot = brick.foot + 0.024 * Vec3{std::cos(middle), std::sin(middle), 0.0};
    brick.heading = next;
  }
  layout.parts = {{"turn", 0, layout.brick_count()}};
  return layout;
}

Layout split(double restitution) {
  Layout layout = straight_row(6, 0.024, {.brick_restitution = restitution, .floor_restitution = restitution});
  Brick brick;
  for (const double side : {-0.0135, 0.0135}) {
    for (int i = 6; i < 14; ++i) {
      brick.foot = {0.024 * i, side, 0.0};
      layout.bricks.push_back(brick);
    }
  }
  return layout;
}

/// The largest relative difference of arrival times, there times `clock`.
double difference(const RigidRun& here, const RigidRun& there, double clock = 1.0) {
  double most = 0.0;
  for (std::size_t i = 0; i < here.arrival.size(); ++i) {
    REQUIRE(!std::isnan(here.arrival[i]));
    REQUIRE(!std::isnan(there.arrival[i]));
    most = std::max(most, std::abs(clock * there.arrival[i] / here.arrival[i] - 1.0));
  }
  return most;
}

/// Mirrored, turned, a kilometre away, ten times as large under three tenths of the gravity.
void check_all(const Layout& layout, double tolerance) {
  const RigidRun here = run_rigid(layout, 0.0, 1.5);
  CHECK(difference(here, run_rigid(mirrored(layout), 0.0, 1.5)) < tolerance);
  CHECK(difference(here, run_rigid(moved(layout, 0.6, {}), 0.0, 1.5)) < tolerance);
  CHECK(difference(here, run_rigid(moved(layout, 0.0, {1000.0, -1000.0, 0.0}), 0.0, 1.5)) < tolerance);
  CHECK(difference(here, run_rigid(scaled(layout, 10.0, 0.3), 0.0, 10.0), std::sqrt(0.3 / 10.0)) < tolerance);
}

}  // namespace

TEST_CASE("rigid: a straight row falls at the same times within 1e-6 wherever and however it lies, and however large it is") {
  for (const double restitution : {0.0, 0.3}) {
    CAPTURE(restitution);
    check_all(straight_row(15, 0.024, {.brick_restitution = restitution, .floor_restitution = restitution}), 1e-6);
  }
}

// Off a plane the solution of a step's contacts ends at 1e-5 of sqrt(g h), after more rounds here than there, and what differs grows from
// hit to hit.
TEST_CASE("rigid: a curve and a split fall at the same times within a percent wherever and however they lie, and however large they are") {
  for (const double restitution : {0.0, 0.3}) {
    CAPTURE(restitution);
    check_all(turn_of_ten(restitution), 0.01);
    check_all(split(restitution), 0.01);
  }
}

TEST_CASE("rigid: the two branches of a symmetric split arrive together within a percent") {
  for (const double restitution : {0.0, 0.3}) {
    const RigidRun run = run_rigid(split(restitution), 0.0, 1.5);
    for (std::size_t i = 6; i < 14; ++i) CHECK(std::abs(run.arrival[i + 8] / run.arrival[i] - 1.0) < 0.01);
  }
}

TEST_CASE("rigid: bricks of a straight row never turn about the vertical") {
  const Layout layout = moved(straight_row(20, 0.024), 0.6, {});
  const RigidRun run = run_rigid(layout, 0.0, 10.0);
  for (BrickId i = 0; i < layout.brick_count(); ++i) {
    // Where its width points: across the row, whatever its tilt.
    const Vec3 across = rotate(run.last[static_cast<std::size_t>(i)].orientation, Vec3{0.0, 1.0, 0.0});
    const SinCos heading = sin_cos(0.6);
    CHECK(std::abs(across.x * heading.cos + across.y * heading.sin) < 1e-6);
    CHECK(std::abs(across.z) < 1e-6);
  }
}

// The first brick falls in steps of a third where it moves alone: 0.1 percent between them.
TEST_CASE("rigid: a straight row that bounces falls alike in its plane and with six degrees of freedom, within 0.2 percent") {
  for (const double restitution : {0.0, 0.3, 0.6}) {
    CAPTURE(restitution);
    const Layout layout = straight_row(12, 0.024, {.brick_restitution = restitution, .floor_restitution = restitution});
    const RigidRun in_plane = run_rigid(layout, 0.0, 1.5);
    auto model = rigid::make_rigid_model(layout, {.every_brick_moves = true});
    REQUIRE(model.has_value());
    std::vector<double> arrival(layout.bricks.size(), 0.0);
    while (arrival.back() == 0.0 && (*model)->step_count() < 300) {
      (*model)->step();
      for (const Event& event : (*model)->events()) {
        if (event.kind == EventKind::arrived) arrival[static_cast<std::size_t>(event.brick)] = event.time;
      }
    }
    for (std::size_t i = 0; i < arrival.size(); ++i) CHECK(std::abs(arrival[i] / in_plane.arrival[i] - 1.0) < 0.002);
  }
}

// What must hold whatever the layout: symmetry, growth, and a thin sample of the parameters that a person may choose.
#include <array>

#include "rigid_scene.h"

using namespace topple;
using namespace topple::test;

TEST_CASE("rigid: a row that is turned, or a kilometre away, falls at the same times within 1e-6") {
  const Layout row = straight_row(20, 0.024);
  const RigidRun here = run_rigid(row, 0.0, 1.0);
  for (const Layout& other : {moved(row, 0.6, {}), moved(row, kPi / 2.0, {}), moved(row, 0.0, {1000.0, -1000.0, 0.0})}) {
    const RigidRun there = run_rigid(other, 0.0, 1.0);
    for (std::size_t i = 0; i < here.arrival.size(); ++i) CHECK(std::abs(there.arrival[i] / here.arrival[i] - 1.0) < 1e-6);
  }
}

TEST_CASE("rigid: thirteen bricks growing by 1.2 from 5 mm all fall") {
  Layout layout = straight_row(0, 0.024);
  layout.kinds.clear();
  double place = 0.0, height = 0.005;
  for (int i = 0; i < 13; ++i) {
    BrickKind kind = cross_check_kind();
    const double scale = height / 0.048;
    kind.height = height;
    kind.width *= scale;
    kind.thickness *= scale;
    kind.mass *= scale * scale * scale;
    layout.kinds.push_back(kind);
    Brick brick;
    brick.foot.x = place;
    brick.kind = static_cast<std::uint16_t>(i);
    layout.bricks.push_back(brick);
    place += 0.5 * height;  // Foot to foot: half the height, as in the cross-check row.
    height *= 1.2;
  }
  layout.parts = {{"row 1", 0, 13}};
  layout.pushes[0].how = AngularSpeedPush{12.0};
  const RigidRun run = run_rigid(layout, 0.0, 2.0);
  for (const double arrival : run.arrival) CHECK_FALSE(std::isnan(arrival));
}

TEST_CASE("rigid: corners of what a person may choose neither crash nor make energy") {
  struct Corner {
    Surface surface;
    double gap, thickness, gravity, push;  // gap and thickness in heights; gravity in g; push in rad/s at 1 g: enough for the wave to run
  };
  const std::array<Corner, 6> corners{{{{0.0, 0.5, 0.0, 0.0}, 0.34, 0.15625, 1.0, 8.0},
                                       {{0.6, 5.0, 0.0, 0.0}, 0.34, 0.15625, 1.0, 8.0},
                                       {{0.2, 0.1, 0.3, 0.3}, 0.34, 0.15625, 0.1, 8.0},
                                       {{0.2, 0.5, 0.0, 0.0}, 0.85, 0.15625, 10.0, 8.0},
                                       {{0.2, 0.5, 0.0, 0.0}, 0.3, 0.25, 1.0, 12.0},
                                       {{0.2, 0.5, 0.0, 0.0}, 0.3, 0.05, 1.0, 8.0}}};
  for (const Corner& corner : corners) {
    Layout layout = straight_row(8, 0.048 * (corner.gap + corner.thickness), corner.surface);
    layout.kinds[0].thickness = 0.048 * corner.thickness;
    layout.gravity *= corner.gravity;
    layout.pushes[0].how = AngularSpeedPush{corner.push * std::sqrt(corner.gravity)};
    const RigidRun run = run_rigid(layout, 0.0, 1.0 / std::sqrt(corner.gravity));
    CAPTURE(corner.gap);
    CAPTURE(corner.thickness);
    CAPTURE(corner.gravity);
    CHECK(run.progress != Progress::not_finite);
    CHECK(run.energy_rise < 0.001 * run.released);
  }
}

// Structures: they stand with every brick stepped, they topple when struck, and what falls starts the next row. The minute that they stand
// in full is bench/stacks; these are its first moments.
#include "rigid_scene.h"

using namespace topple;
using namespace topple::test;

namespace {

/// The largest way that any brick's middle has gone, as a fraction of its thickness.
double drift_after(const Layout& layout, double time) {
  auto model = rigid::make_rigid_model(layout, {.every_brick_moves = true});
  REQUIRE(model.has_value());
  Frame frame;
  double drift = 0.0;
  while (frame.time < time) {
    CHECK((*model)->step().progress == Progress::running);
    (*model)->read(frame);
    CHECK(frame.free.size() == layout.bricks.size());
    for (const FreeMotion& motion : frame.free) {
      const double moved = norm(motion.pose.position - standing_pose(layout, motion.brick).position);
      drift = std::max(drift, moved / layout.kind_of(motion.brick).thickness);
    }
  }
  return drift;
}

}  // namespace

TEST_CASE("rigid: a tower of thirty crossed layers stands with every brick stepped") {
  CHECK(drift_after(layout_of("[[tower]]\nat_mm = [0, 0]\nlayers = 30\n"), 0.1) < 0.001);
}

TEST_CASE("rigid: a wall and a pyramid stand with every brick stepped") {
  CHECK(drift_after(layout_of("[[wall]]\nat_mm = [0, 0]\ncount = 4\ncourses = 5\n"), 0.1) < 0.001);
  CHECK(drift_after(layout_of("[[pyramid]]\nat_mm = [0, 0]\ncount_along = 3\ncount_across = 3\n"), 0.1) < 0.001);
}

TEST_CASE("rigid: a tower that is struck topples, and its bricks start the next row") {
  // A row of large bricks runs into the tower from behind, a row of dominoes stands ahead.
  const Layout layout = layout_of(
      "[[kind]]\nname = \"domino\"\n[[kind]]\nname = \"ram\"\nheight_mm = 60\nwidth_mm = 30\nthickness_mm = 12\nmass_g = 60\n"
      "[[push]]\nbrick = 0\nangular_speed_rad_s = 6\n[[brick]]\nat_mm = [-50, 0]\nkind = \"ram\"\n"
      "[[tower]]\nat_mm = [0, 0]\nlayers = 4\ncount = 1\npose = \"standing\"\n[[row]]\nfrom_mm = [40, 0]\ncount = 4\ngap_mm = 16.5\n");
  const RigidRun run = run_rigid(layout, 0.0, 2.0);
  CHECK_FALSE(std::isnan(run.arrival[8]));
  CHECK(run.energy_rise < 0.001 * run.released);
}

// The bricks of a plane front and their drifts, against closed forms: no kick and no blow.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "model/rigid/plane_drift.h"
#include "model/rigid/plane_members.h"
#include "model/rigid_scene.h"

namespace topple::rigid {
namespace {

using doctest::Approx;

// A row as a front sees it, of which brick `first` moves.
struct Row {
  Layout layout;
  World world;
  Ledger ledger;
  RowPlane plane;
  PlaneState state;
  PlaneMembers members;
  PlaneDrift drift;

  Row(int count, double pitch, BrickId first)
      : layout(test::straight_row(count, pitch)),
        world(layout),
        plane(plane_of_row(world, first)),
        members(world, ledger, plane, state),
        drift(world, state) {
    ledger.front = 0;
    const int place = members.add(first);
    state.brick(place).moving = true;
    members.list_neighbours(place);
    members.order();
  }

  std::vector<BrickId> bricks() const {
    std::vector<BrickId> ids;
    ids.reserve(state.bricks.size());
    for (const PlaneBrick& brick : state.bricks) ids.push_back(brick.id);
    return ids;
  }
  // Between the faces of the first two.
  double gap() const {
    return state.brick(1).box.place.x - state.brick(0).box.place.x - state.brick(0).box.half_along - state.brick(1).box.half_along;
  }
};

// Half a diagonal of 48 x 24 x 7.5 mm is 27.1 mm; a brick lists what is within 2.5 of it, 67.7 mm: two at a pitch of 24 mm.
TEST_CASE("rigid: a front takes those bricks of a row that one could touch soon, in their order, and pairs them with that one") {
  const Row end(10, 0.024, 0), middle(10, 0.024, 5);
  CHECK(end.bricks() == std::vector<BrickId>{0, 1, 2});
  CHECK(end.state.touches.size() == 2);
  CHECK(middle.bricks() == std::vector<BrickId>{3, 4, 5, 6, 7});
  CHECK(middle.state.touches.size() == 4);
  for (const PlaneTouch& touch : middle.state.touches) CHECK((touch.a == 2 || touch.b == 2));
  CHECK(!middle.members.leave_plane());
}

TEST_CASE("rigid: what is in no pair with a brick that moves is left out") {
  Row row(10, 0.024, 5);
  row.state.brick(row.members.place_of(5)).box.place.x += 3.0 * row.plane.pitch;  // Farther than 1.4 diagonals from bricks 3 and 4.
  row.members.drop_idle();
  row.members.order();
  CHECK(row.bricks() == std::vector<BrickId>{6, 7, 5});
}

// With its velocity throughout it is there after gap / velocity, up to what impacts are located to.
TEST_CASE("rigid: a drift ends when the gap has gone, with all that moved there") {
  Row row(3, 0.024, 0);
  const double gap = row.gap(), velocity = 0.3, start = row.state.brick(0).box.place.x;
  row.state.brick(0).velocity.x = row.state.brick(0).middle.x = velocity;
  row.drift.begin(2.0 * gap / velocity, true);
  CHECK(row.drift.cut() == Approx(gap / velocity).epsilon(1e-6));
  row.drift.go_to(0.25 * gap / velocity);
  CHECK(row.drift.by_now(row.state.brick(0)).box.place.x == Approx(start + 0.25 * gap).epsilon(1e-9));
  CHECK(row.state.brick(0).box.place.x == start);  // Nothing has moved before the end.
  double work = 0.0;
  CHECK(row.drift.end(row.drift.cut(), work));
  CHECK(std::abs(row.gap()) < 1e-6 * gap);
  CHECK(row.state.brick(0).velocity.x == Approx(velocity));
  CHECK(!row.drift.is_under_way());
}

// From rest to a mean of m over the whole it has gone m t^2 / whole; with m x whole = 4 gaps it arrives amid the drift, at velocity m.
TEST_CASE("rigid: a drift from rest keeps one acceleration, and its force does the work of its way") {
  Row row(3, 0.024, 0);
  const double gap = row.gap(), whole = 0.5, mean = 4.0 * gap / whole, force = 7.0;
  row.state.brick(0).middle.x = mean;
  row.state.forces.push_back({.brick = 0, .along = force});
  row.drift.begin(whole, true);
  CHECK(row.drift.cut() == Approx(0.5 * whole).epsilon(1e-6));
  double work = 0.0;
  row.drift.end(row.drift.cut(), work);
  CHECK(row.state.brick(0).velocity.x == Approx(mean).epsilon(1e-6));
  CHECK(work == Approx(force * gap).epsilon(1e-6));
}

TEST_CASE("rigid: a drift whose impacts are not located goes on into the next brick") {
  Row row(3, 0.024, 0);
  const double gap = row.gap();
  row.state.brick(0).velocity.x = row.state.brick(0).middle.x = 1.0;
  row.drift.begin(1.1 * gap, false);
  CHECK(row.drift.cut() == 1.1 * gap);
  double work = 0.0;
  CHECK(row.drift.end(row.drift.cut(), work));
  CHECK(row.gap() == Approx(-0.1 * gap));
}

}  // namespace
}  // namespace topple::rigid

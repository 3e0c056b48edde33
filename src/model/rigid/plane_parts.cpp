// How a plane front takes over bricks from fronts of another kind, and hands its own over.
#include "model/rigid/plane_front.h"

namespace topple::rigid {

// Bricks that moved freely go on in the plane; what they have left it by stays as it is.
void PlaneFront::adopt(std::span<const HandedBrick> bricks) {
  for (const HandedBrick& handed : bricks) {
    const PlanePose apart = in_plane(plane_, world_, handed.brick, handed.pose);
    const int place = members_.add(handed.brick, apart.place);
    PlaneBrick& brick = state_.brick(place);
    brick.upright = apart.upright;
    brick.aside = dot(handed.pose.position - world_.foot(handed.brick), plane_.across);
    brick.velocity = {dot(handed.velocity, plane_.along), handed.velocity.z, dot(handed.angular_velocity, plane_.across)};
    brick.velocity_before = brick.velocity;
    brick.listed_at = brick.box.place;
    brick.moving = true;
    brick.quiet = handed.quiet;
    brick.pushed = handed.pushed;
    brick.landed = handed.landed;
    ++moving_;
    PlaneTouch floor = members_.on_floor(place, world_.tolerances.margin);
    for (int k = 0; k < floor.now.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      floor.memory[at].active = floor.now.points[at].separation < world_.tolerances.touching * brick.thin;
    }
    state_.touches.push_back(floor);
  }
  energy_law_.forget();
  for (const HandedBrick& handed : bricks) members_.list_neighbours(members_.place_of(handed.brick));
  members_.order();
  for (const HandedBrick& handed : bricks) members_.mark_borne_by(members_.place_of(handed.brick));
}

// It joins the other front before the next step, and hands over only what it owns.
void PlaneFront::lose(BrickId brick) {
  if (repeat_.is_on()) return;
  for (PlaneBrick& lost : state_.bricks) {
    if (lost.id != brick || !lost.moving) continue;
    lost.moving = false;
    energy_law_.forget();
    --moving_;
  }
}

void PlaneFront::hand_over(std::vector<HandedBrick>& bricks, std::vector<ActiveForce>& forces) {
  const auto hand = [&](const PlaneBrick& brick) {
    if (!disown(brick.id) || !brick.moving) return;
    // Who takes it over lists it where it is now; left in the cell where this front listed it, it would be looked for in the wrong one.
    world_.neighbours.moved(brick.id, in_world(plane_, brick.listed_at.x, brick.listed_at.z),
                            in_world(plane_, brick.box.place.x, brick.box.place.z));
    const FreeMotion now = motion_of(plane_, world_, brick, Phase::falling);
    bricks.push_back({brick.id, now.pose, now.velocity, now.angular_velocity, brick.quiet, brick.pushed, brick.landed});
  };
  if (repeat_.is_on()) {
    for (const PlaneCycle::Place& place : repeat_.drift().places) hand(drift_.by_now(repeat_.brick_of(place)));
    for (const PlaneBrick& brick : state_.bricks) disown(brick.id);
    for (const PlaneCycle::Drift& drift : cycle_.drifts()) {
      for (const int brick : drift.taken) disown(state_.last_struck + brick);
    }
    repeat_.tell_unseen(unseen_);
    repeat_.end();
  } else {
    for (const PlaneBrick& brick : state_.bricks) hand(drift_.by_now(brick));
  }
  drift_.leave();
  for (const PlaneForce& force : state_.forces) {
    for (const PlaneBrick& brick : state_.bricks) {
      if (brick.id != force.brick) continue;
      const Vec3 local = rotate(conjugate(brick.upright), force.x * plane_.along + Vec3{0.0, 0.0, force.z});
      forces.push_back({force.brick, force.along * plane_.along, local, force.end});
    }
  }
}

// Amid a cycle that is told again: bricks are taken up where they are.
void PlaneFront::break_off() {
  std::vector<HandedBrick> bricks;
  std::vector<ActiveForce> forces;
  now_ += drift_.done();
  hand_over(bricks, forces);
  state_.bricks.clear();
  state_.touches.clear();
  state_.near_pairs.clear();
  even_row_.forget();
  moving_ = state_.cuts = 0;
  state_.since_look = state_.planned_for = 0.0;
  state_.last_struck = kNoBrick;
  adopt(bricks);
}

void PlaneFront::disband() {
  for (const PlaneBrick& brick : state_.bricks) disown(brick.id);
}

}  // namespace topple::rigid

// How a plane front takes over bricks from fronts of another kind, and hands its own over.
#include "model/rigid/plane_front.h"

namespace topple::rigid {

// Bricks that moved freely go on in the plane; what they have left it by stays as it is.
void PlaneFront::adopt(std::span<const HandedBrick> bricks) {
  for (const HandedBrick& handed : bricks) {
    const PlanePose apart = in_plane(plane_, world_, handed.brick, handed.pose);
    const int place = add(handed.brick, apart.place);
    PlaneBrick& brick = bricks_[static_cast<std::size_t>(place)];
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
    PlaneTouch floor = on_floor(place, world_.tolerances.margin);
    for (int k = 0; k < floor.now.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      floor.memory[at].active = floor.now.points[at].separation < world_.tolerances.touching * brick.thin;
    }
    touches_.push_back(floor);
  }
  energy_law_.forget();
  for (const HandedBrick& handed : bricks) list_neighbours(place_of(handed.brick));
  order();
  for (const HandedBrick& handed : bricks) mark_borne_by(place_of(handed.brick));
}

// It joins the other front before the next step, and hands over only what it owns.
void PlaneFront::lose(BrickId brick) {
  if (repeat_.on) return;
  for (PlaneBrick& lost : bricks_) {
    if (lost.id != brick || !lost.moving) continue;
    lost.moving = false;
    energy_law_.forget();
    --moving_;
  }
}

void PlaneFront::hand_over(std::vector<HandedBrick>& bricks, std::vector<ActiveForce>& forces) {
  const auto disown = [this](BrickId brick) {
    std::int32_t& owner = world_.front[static_cast<std::size_t>(brick)];
    const bool owned = owner == number_;
    if (owned) owner = kNoFront;
    return owned;
  };
  const auto hand = [&](const PlaneBrick& brick) {
    if (!disown(brick.id) || !brick.moving) return;
    // Who takes it over lists it where it is now; left in the cell where this front listed it, it would be looked for in the wrong one.
    world_.neighbours.moved(brick.id, in_world(brick.listed_at.x, brick.listed_at.z), in_world(brick.box.place.x, brick.box.place.z));
    bricks.push_back({brick.id, pose_of(brick), brick.velocity.x * plane_.along + Vec3{0.0, 0.0, brick.velocity.z},
                      brick.velocity.turn * plane_.across, brick.quiet, brick.pushed, brick.landed});
  };
  if (repeat_.on) {
    for (const PlaneCycle::Place& place : cycle_.drifts[repeat_.drift].places) hand(at_this_moment(place));
    for (const PlaneBrick& brick : bricks_) disown(brick.id);
    for (std::size_t i = 0; i < cycle_.count; ++i) {
      for (const int brick : cycle_.drifts[i].taken) disown(last_struck_ + brick);
    }
    tell_unseen(unseen_);
    repeat_.on = false;
  } else {
    for (const PlaneBrick& brick : bricks_) hand(at_this_moment(brick));
  }
  drift_ = {};
  for (const Force& force : forces_) {
    for (const PlaneBrick& brick : bricks_) {
      if (brick.id != force.brick) continue;
      const Vec3 local = rotate(conjugate(brick.upright), force.x * plane_.along + Vec3{0.0, 0.0, force.z});
      forces.push_back({force.brick, force.along * plane_.along, local, force.end});
    }
  }
}

void PlaneFront::disband() {
  for (const PlaneBrick& brick : bricks_) {
    std::int32_t& owner = world_.front[static_cast<std::size_t>(brick.id)];
    if (owner == number_) owner = kNoFront;
  }
}

}  // namespace topple::rigid

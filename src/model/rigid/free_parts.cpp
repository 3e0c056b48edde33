// What a front lets go: parts that no longer reach each other, and rows that have become straight.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "model/rigid/free_front.h"
#include "model/rigid/row_plane.h"

namespace topple::rigid {

namespace {

int root_of(std::vector<int>& above, int i) {
  while (above[static_cast<std::size_t>(i)] != i) {
    int& up = above[static_cast<std::size_t>(i)];
    up = above[static_cast<std::size_t>(up)];
    i = up;
  }
  return i;
}

}  // namespace

int FreeFront::find_parts() {
  may_part_ = false;
  if (!ledger_.met.empty()) return 1;
  std::vector<int>& above = above_;
  above.resize(bricks_.bodies.size());
  std::iota(above.begin(), above.end(), 0);
  for (const Touch& touch : bricks_.touches) {
    if (touch.b == kFloor) continue;
    const int a = root_of(above, touch.a), b = root_of(above, touch.b);
    above[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  // Numbered in the order of their first moving body, so that the first part stays; what no moving brick reaches goes with it.
  part_of_.assign(bricks_.bodies.size(), -1);
  int parts = 0;
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (!bricks_.members[i].moving) continue;
    int& part = part_of_[static_cast<std::size_t>(root_of(above, static_cast<int>(i)))];
    if (part < 0) part = parts++;
  }
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    part_of_[i] = std::max(part_of_[static_cast<std::size_t>(root_of(above, static_cast<int>(i)))], 0);
  }
  return parts;
}

void FreeFront::give_part(int part, FreeFront& to) {
  std::vector<int> renamed(bricks_.bodies.size(), 0);
  std::vector<int> place(bricks_.bodies.size(), -1);
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (part_of_[i] != part) continue;
    renamed[i] = -1;
    place[i] = static_cast<int>(to.bricks_.bodies.size());
    const BrickId id = bricks_.bodies[i].id;
    to.bricks_.bodies.push_back(bricks_.bodies[i]);
    to.bricks_.members.push_back(bricks_.members[i]);
    to.moving_ += bricks_.members[i].moving ? 1 : 0;
    moving_ -= bricks_.members[i].moving ? 1 : 0;
    world_.front[static_cast<std::size_t>(id)] = to.number();
    world_.note_place(id, place[i]);
  }
  std::erase_if(bricks_.touches, [&](const Touch& touch) {
    if (place[static_cast<std::size_t>(touch.a)] < 0) return false;
    Touch given = touch;
    given.a = place[static_cast<std::size_t>(touch.a)];
    if (touch.b != kFloor) given.b = place[static_cast<std::size_t>(touch.b)];
    to.bricks_.touches.push_back(given);
    return true;
  });
  std::erase_if(bricks_.forces, [&](const ActiveForce& force) {
    if (world_.front[static_cast<std::size_t>(force.brick)] != to.number()) return false;
    to.bricks_.forces.push_back(force);
    return true;
  });
  to.rested_ = rested_;
  energy_law_.forget();
  to.may_part_ = true;
  members_.keep_those(renamed);
  std::size_t kept = 0;
  for (const int of : part_of_) {
    if (of != part) part_of_[kept++] = of;
  }
  part_of_.resize(kept);
}

// A row as it was put down: upright boxes on the floor that head along one line. Its moving bricks may have left the plane by no more than
// `in_plane` of their thickness, and would not within sqrt(height / gravity).
BrickId FreeFront::row_brick() const {
  if (!ledger_.met.empty() || !bricks_.forces.empty() || moving_ == 0) return kNoBrick;
  BrickId first = kNoBrick;
  RowPlane plane;
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    const Body& body = bricks_.bodies[i];
    if (!bricks_.members[i].moving) continue;
    if (body.round) return kNoBrick;
    if (first == kNoBrick) {
      first = body.id;
      plane = plane_of_row(world_, first);
    }
    if (!put_down_in(plane, world_, body.id)) return kNoBrick;
    const double allowed = world_.tolerances.in_plane * bricks_.members[i].thin;
    const PlanePose pose = in_plane(plane, world_, body.id, {body.position, body.orientation});
    if (std::abs(pose.lateral) + body.radius * pose.swing > allowed) return kNoBrick;
    const double aside = std::abs(dot(body.velocity, plane.across)) +
                         body.radius * (std::abs(dot(body.angular_velocity, plane.along)) + std::abs(body.angular_velocity.z));
    if (world_.tolerances.horizon * bricks_.members[i].time_scale * aside > allowed) return kNoBrick;
    plane.half_width = std::max(plane.half_width, 0.5 * extents(world_.kinds[body.kind], world_.given(body.id).stance).across);
  }
  // What does not move within its reach must lie in the plane too, or miss it.
  std::vector<BrickId> near;
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (!bricks_.members[i].moving) continue;
    world_.neighbours.near(bricks_.bodies[i].position, near);
    for (const BrickId other : near) {
      const std::int32_t owner = world_.front[static_cast<std::size_t>(other)];
      if (moves(other)) continue;
      const InPlane found = locate_in(plane, world_, other, still(world_, ledger_, other));
      if (found.misses) continue;
      if (!found.lies || (owner != kNoFront && owner != number())) return kNoBrick;
    }
  }
  return first;
}

void FreeFront::hand_over(std::vector<HandedBrick>& bricks) {
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    const Body& body = bricks_.bodies[i];
    const Member& member = bricks_.members[i];
    if (!disown(body.id) || !member.moving) continue;
    world_.neighbours.moved(body.id, member.listed_at, body.position);
    bricks.push_back(
        {body.id, {body.position, body.orientation}, body.velocity, body.angular_velocity, member.quiet, member.pushed, member.landed});
  }
}

}  // namespace topple::rigid

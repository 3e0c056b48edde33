#include "model/rigid/free_impulses.h"

#include <algorithm>
#include <cmath>

#include "model/rigid/ball.h"

namespace topple::rigid {

namespace {

// What is left of a point's velocity under its impulse, as a share of what the impulse stops: of a point that begins to touch, and of one
// that has carried a force before. There it is left of the change of the impulse alone, and goes within the next steps.
constexpr double kCompliance = 1e-4;
constexpr double kLoadedCompliance = 3e-3;
// Sticking that changes from nothing to the limit of friction slips by this in the step, as a fraction of sqrt(gravity x height).
constexpr double kCreep = 4e-4;

constexpr int kBends = 3;  // So many times a blow is solved again with the turning that it makes.

Vec3 centripetal(const Body& body, const Vec3& arm) {
  if (body.round) return {};
  return cross(body.angular_velocity, cross(body.angular_velocity, arm)) + cross(body.gyroscopic, arm);
}

// Second derivative of the distance vector of the two material points while no force acts [m/s^2]. The normal turns with the body whose
// face it is, which adds the second term.
Vec3 curvature(const ContactRow& row, const Manifold& manifold, std::span<const Body> bodies) {
  const Body& a = bodies[static_cast<std::size_t>(row.a)];
  Vec3 bend = centripetal(a, row.arm_a);
  if (row.b == kFloor) return bend;
  const Body& b = bodies[static_cast<std::size_t>(row.b)];
  bend = bend - centripetal(b, row.arm_b);
  Vec3 turning = spin_of(b);
  if (manifold.reference == Reference::a) turning = spin_of(a);
  if (manifold.reference == Reference::edges) turning = 0.5 * (spin_of(a) + spin_of(b));
  const Vec3 slip = (a.velocity + cross(spin_of(a), row.arm_a)) - (b.velocity + cross(spin_of(b), row.arm_b));
  const double turned = 2.0 * dot(cross(turning, row.normal), slip);
  return bend + turned * row.normal;
}

// Of one point, or of the nearest active one of its pair where the two are all but equally near: an edge that lies on a face lies on it
// with both its ends, and does not rock from one to the other by less than what counts as touching.
double flush_separation(const Touch& touch, int point, double flush) {
  const double own = touch.now.points[static_cast<std::size_t>(point)].separation;
  double least = own;
  for (int k = 0; k < touch.now.count; ++k) {
    if (touch.memory[static_cast<std::size_t>(k)].active) least = std::min(least, touch.now.points[static_cast<std::size_t>(k)].separation);
  }
  return own - least < flush ? least : own;
}

}  // namespace

// The points that take part; `time` is how long their forces act, for a first guess.
void FreeImpulses::make_rows(ContactState PointMemory::* guess, double time) {
  std::size_t count = 0;  // Rows of the last time are written over: they are long.
  const double creep = kCreep * std::sqrt(world_.gravity * world_.smallest);
  for (std::size_t i = 0; i < bricks_.touches.size(); ++i) {
    const Touch& touch = bricks_.touches[i];
    const Body& a = bricks_.body(touch.a);
    const Body* b = bricks_.second(touch);
    if (a.inverse_mass == 0.0 && (b == nullptr || b->inverse_mass == 0.0)) continue;
    for (int k = 0; k < touch.now.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const PointMemory& memory = touch.memory[at];
      if (!memory.active) continue;
      if (count == rows_.size()) rows_.emplace_back();
      ContactRow& row = rows_[count++];
      row.base = 0.0;
      row.a = touch.a;
      row.b = touch.b;
      row.touch = static_cast<int>(i);
      row.point = k;
      row.normal = touch.now.normal;
      row.arm_a = touch.now.points[at].position - a.position;
      if (b != nullptr) row.arm_b = touch.now.points[at].position - b->position;
      if (count > 1 && rows_[count - 2].touch == row.touch) {
        row.along = rows_[count - 2].along;
        row.across = rows_[count - 2].across;
      } else {
        set_directions(row, a);
      }
      set_couplings(row, a, b, *world_.kernels);
      row.normal_stiffness = row.normal_mass / kCompliance;
      row.tangent_stiffness = row.mass / kCompliance;
      const double carries = world_.stacked ? 0.0 : time * memory.normal_force;
      if (carries > 0.0) {
        row.normal_stiffness = std::max(row.normal_mass / kLoadedCompliance, carries / (kLoadedCompliance * world_.gravity * world_.step));
        if (touch.friction > 0.0) row.tangent_stiffness = std::min(row.tangent_stiffness, touch.friction * carries / creep);
      }
      row.friction = touch.friction;
      row.state = memory.*guess;
      set_steps(row);
      row.impulse = {time * memory.normal_force, time * dot(row.along, memory.friction_force),
                     time * dot(row.across, memory.friction_force)};
    }
  }
  rows_.resize(count);
}

// After a drift for `time` no active point will be closer than touching.
void FreeImpulses::set_bias(double time) {
  const double slow = 0.5 * world_.gravity * world_.step;
  bends_.clear();
  for (ContactRow& row : rows_) {
    const Touch& touch = bricks_.touch(row.touch);
    const double separation = flush_separation(touch, row.point, world_.tolerances.touching * bricks_.thinner(touch));
    // An overlap goes within a step, but never so fast that it would throw the bricks apart.
    const double gap = separation > 0.0 ? separation / time : std::max(separation / world_.step, -slow);
    // What it carried before is there without any slip.
    bends_.push_back((0.5 * time) * curvature(row, touch.now, bricks_.bodies));
    const Vec3& bend = bends_.back();
    row.bias = {gap + dot(row.normal, bend) - row.give_normal * row.impulse[0], dot(row.along, bend) - row.give * row.impulse[1],
                dot(row.across, bend) - row.give * row.impulse[2]};
  }
}

void FreeImpulses::kick(double time) {
  const Vec3 gravity{0.0, 0.0, -world_.gravity};
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (!bricks_.members[i].moving) continue;
    bricks_.bodies[i].velocity = bricks_.bodies[i].velocity + time * gravity;
    if (bricks_.bodies[i].round) slow_ball(i, time);
  }
  for (const ActiveForce& force : bricks_.forces) {
    const int place = bricks_.place_of(force.brick);
    if (place < 0) continue;
    Body& body = bricks_.body(place);
    body.velocity = body.velocity + (time * body.inverse_mass) * force.force;
    body.angular_velocity = body.angular_velocity + time * (body.inverse_inertia * cross(body.axes * force.point, force.force));
  }
}

// A ball that touches the floor loses a little of its rolling.
void FreeImpulses::slow_ball(std::size_t place, double time) {
  Body& ball = bricks_.bodies[place];
  if (ball.position.z - ball.half.x > world_.tolerances.touching * bricks_.members[place].thin) return;
  resist_rolling(ball, world_.kinds[ball.kind].rolling_friction, world_.gravity, time);
}

// Bodies come with the velocities that they would have without contact.
void FreeImpulses::solve_contacts(std::span<const Twist> guess) {
  const double unit = std::sqrt(world_.gravity * world_.smallest), tolerance = world_.tolerances.velocity * unit;
  solver_.solve(bricks_.bodies, rows_, guess, {tolerance, world_.tolerances.sweeps, world_.tolerances.lost * unit, world_.stacked});
}

void FreeImpulses::solve_half_a_kick(double time) {
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) set_twist(bricks_.bodies[i], now_[i]);
  kick(0.5 * time);
  solve_contacts(now_);
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) bricks_.members[i].middle = twist_of(bricks_.bodies[i]);
}

// The forces between blows change little, so the velocity at this moment is that of the middle of the drift less what they did before.
Twist FreeImpulses::after_the_blow(const Member& member, double time) {
  if (!member.moving) return {};
  return {member.middle.velocity - (0.5 * time) * member.gain.velocity, member.middle.spin - (0.5 * time) * member.gain.spin};
}

// A brick that is struck turns at once, and so do the paths of its points bend. Whether that makes a difference; the rows expect it then.
bool FreeImpulses::bends_otherwise(double time) {
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    set_twist(bricks_.bodies[i], after_the_blow(bricks_.members[i], time));
    bricks_.bodies[i].gyroscopic = free_rotation(bricks_.bodies[i]);
  }
  bool otherwise = false;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const Touch& touch = bricks_.touch(rows_[k].touch);
    const Vec3 bend = (0.5 * time) * curvature(rows_[k], touch.now, bricks_.bodies), more = bend - bends_[k];
    otherwise = otherwise || time * std::abs(dot(more, rows_[k].normal)) > world_.tolerances.bends * bricks_.thinner(touch);
    Framed& bias = rows_[k].bias;
    bias = {bias[0] + dot(more, rows_[k].normal), bias[1] + dot(more, rows_[k].along), bias[2] + dot(more, rows_[k].across)};
    bends_[k] = bend;
  }
  return otherwise;
}

void FreeImpulses::plan(double time, bool with_blow) {
  make_rows(&PointMemory::kick, 0.5 * time);
  set_bias(time);
  now_.clear();
  for (const Body& body : bricks_.bodies) now_.push_back(twist_of(body));
  solve_half_a_kick(time);
  for (int i = 0; with_blow && i < kBends && bends_otherwise(time); ++i) solve_half_a_kick(time);
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) set_twist(bricks_.bodies[i], bricks_.members[i].middle);
  remember_impulses(0.5 * time, &PointMemory::kick, with_blow);
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) set_twist(bricks_.bodies[i], now_[i]);
  planned_for_ = time;
}

void FreeImpulses::leap(double time, double next) {
  make_rows(&PointMemory::kick, 0.5 * (time + next));
  set_bias(next);
  guess_.clear();
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    guess_.push_back(bricks_.members[i].middle);
    set_twist(bricks_.bodies[i], bricks_.members[i].middle);
  }
  kick(0.5 * (time + next));
  solve_contacts(guess_);
  remember_impulses(0.5 * (time + next), &PointMemory::kick);
  const double share = time / (time + next);
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    const Twist before = guess_[i], after = twist_of(bricks_.bodies[i]);
    bricks_.members[i].middle = after;
    set_twist(bricks_.bodies[i],
              {before.velocity + share * (after.velocity - before.velocity), before.spin + share * (after.spin - before.spin)});
  }
  planned_for_ = next;
}

// Keeps what the points do, and carry unless a blow was part of it; one that has parted has to come back to touch again.
void FreeImpulses::remember_impulses(double time, ContactState PointMemory::* states, bool with_blow) {
  const double slow = 0.5 * world_.gravity * world_.step;
  for (Touch& touch : bricks_.touches) touch.impulse = 0.0;
  for (const ContactRow& row : rows_) {
    Touch& touch = bricks_.touch(row.touch);
    PointMemory& memory = touch.memory[static_cast<std::size_t>(row.point)];
    touch.impulse += row.impulse[0];
    memory.*states = row.state;
    if (!with_blow && time > 0.1 * world_.step) {
      memory.normal_force = row.impulse[0] / time;
      memory.friction_force = (1.0 / time) * friction_of(row);
    }
    const bool clear =
        touch.now.points[static_cast<std::size_t>(row.point)].separation > world_.tolerances.touching * bricks_.thinner(touch);
    if (clear && !row.state.pressed && -bricks_.closing_speed(touch, row.point) > slow) memory.active = false;
  }
  for (Touch& touch : bricks_.touches) touch.load = time > 0.0 ? touch.impulse / time : 0.0;
}

}  // namespace topple::rigid

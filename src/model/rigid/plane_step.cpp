// One step of a plane front.
//
// Between impacts this is the leapfrog of Størmer and Verlet with one-sided constraints: bricks drift by their velocity in the middle of
// the step, and one solution of all contacts takes it to the middle of the next one, so that no active point will be closer than touching
// at that step's end (the curvature of its path included). Bilaterally that is SHAKE, which moves bricks as RATTLE does [Andersen1983] for
// half the work; it is of second order. Impacts are located inside the step (the drift is cut short where a new point touches), so the
// order holds across them and the front speed does not lock in to the step. After an impact the leapfrog starts anew with half a kick.
#include <algorithm>
#include <cmath>

#include "model/rigid/plane_front.h"

namespace topple::rigid {

namespace {

// What is left of a point's velocity under its impulse, as a share of what the impulse stops. Contacts of which there are more than needed
// then share their load in one way, and seven digits of the linear systems are left for what matters.
constexpr double kCompliance = 1e-4;

Column<3> rate(double x, double z, double arm_x, double arm_z) { return {x, z, x * arm_z - z * arm_x}; }

double response(const PlaneBrick& brick, const Column<3>& j) {
  return (j[0] * j[0] + j[1] * j[1]) / brick.mass + j[2] * j[2] / brick.inertia;
}

double product_of(const Column<3>& j, const PlaneVec& v) { return j[0] * v.x + j[1] * v.z + j[2] * v.turn; }

}  // namespace

void PlaneFront::advance(double begin, std::span<const PushMoment> moments) {
  events_.clear();
  list_those_that_strayed();
  for (PlaneBrick& brick : bricks_) brick.velocity_before = brick.velocity;
  wake_unsupported(begin);
  const double end = begin + world_.step;
  double now = begin;
  int cuts = 0;
  std::size_t next = 0;
  while (true) {
    while (next < moments.size() && moments[next].time <= now) {
      const PushMoment& moment = moments[next++];
      planned_for_ = 0.0;
      if (moment.push != nullptr) {
        begin_push(*moment.push, now);
      } else {
        std::erase_if(forces_, [&](const Force& f) { return f.brick == moment.brick && f.end <= now; });
        const int place = place_of(moment.brick);
        if (place >= 0) bricks_[static_cast<std::size_t>(place)].pushed = false;
      }
    }
    if (now >= end) break;
    const double until = next < moments.size() ? std::min(end, moments[next].time) : end;
    const double taken = part(now, until - now, cuts < world_.tolerances.cuts);
    cuts += taken < until - now ? 1 : 0;
    now = taken < until - now ? now + taken : until;
  }
  retire(end);
}

// One part of the step, of at most `time`; returns how long it was.
double PlaneFront::part(double begin, double time, bool may_cut) {
  if (std::abs(planned_for_ - time) > 1e-9 * world_.step) plan(time);
  try_drift(time);
  const double cut = may_cut ? first_impact(time) : time;
  note_arrivals(begin, cut, time);
  accept_drift(cut, time);
  const double now = begin + cut;
  struck_now_.clear();
  const bool fresh = activate_new_points();
  wake_struck(now);
  const double next = cut < time ? time - cut : world_.step;
  if (fresh || !struck_now_.empty()) {
    take_blow(time, next);
    note_struck(now);
    note_landed(now);
  } else if (cut == time) {
    leap(time);
    wake_struck(now);
  }
  return cut;
}

double PlaneFront::thinner(const PlaneTouch& touch) const {
  const double thin = bricks_[static_cast<std::size_t>(touch.a)].thin;
  return touch.b < 0 ? thin : std::min(thin, bricks_[static_cast<std::size_t>(touch.b)].thin);
}

void PlaneFront::make_rows(PointState PlaneMemory::* guess) {
  rows_.clear();
  unknowns_.clear();
  for (PlaneBrick& brick : bricks_) {
    brick.unknown = brick.moving ? static_cast<int>(unknowns_.size()) : -1;
    if (brick.moving) unknowns_.push_back({brick.mass, brick.inertia, {}, {}});
  }
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    const PlaneTouch& touch = touches_[i];
    const double nx = touch.now.normal_x, nz = touch.now.normal_z;
    for (int k = 0; k < touch.now.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const PlaneMemory& memory = touch.memory[at];
      if (!memory.active) continue;
      const PlanePoint& point = touch.now.points[at];
      PlaneRow row;
      row.touch = static_cast<int>(i);
      row.point = k;
      double normal = 0.0, tangent = 0.0;
      const auto couple = [&](int place, double side, int& unknown, Column<3>& n, Column<3>& t) {
        const PlaneBrick& brick = bricks_[static_cast<std::size_t>(place)];
        unknown = brick.unknown;
        if (!brick.moving) return;
        const double x = point.x - brick.box.place.x, z = point.z - brick.box.place.z;
        n = rate(side * nx, side * nz, x, z);
        t = rate(side * nz, side * -nx, x, z);
        normal += response(brick, n);
        tangent += response(brick, t);
      };
      couple(touch.a, 1.0, row.a, row.normal_a, row.tangent_a);
      if (touch.b >= 0) couple(touch.b, -1.0, row.b, row.normal_b, row.tangent_b);
      if (row.a < 0) {
        row.a = row.b;
        row.b = -1;
        row.normal_a = row.normal_b;
        row.tangent_a = row.tangent_b;
      }
      if (row.a < 0) continue;
      row.normal_stiffness = 1.0 / (kCompliance * normal);
      row.tangent_stiffness = 1.0 / (kCompliance * tangent);
      row.friction = touch.friction;
      row.state = memory.*guess;
      rows_.push_back(row);
    }
  }
}

// After a drift for `time` no active point will be closer than touching.
void PlaneFront::set_bias(double time) {
  for (PlaneRow& row : rows_) {
    const PlaneTouch& touch = touches_[static_cast<std::size_t>(row.touch)];
    const PlanePoint& point = touch.now.points[static_cast<std::size_t>(row.point)];
    // Second derivative of the distance of the two material points while no force acts [m/s^2]; the normal turns with the brick whose
    // face it is, which adds the last term.
    double bend_x = 0.0, bend_z = 0.0, slip_x = 0.0, slip_z = 0.0;
    const auto bend = [&](int place, double side) {
      const PlaneBrick& brick = bricks_[static_cast<std::size_t>(place)];
      const double x = point.x - brick.box.place.x, z = point.z - brick.box.place.z, w = brick.velocity.turn;
      bend_x -= side * w * w * x;
      bend_z -= side * w * w * z;
      slip_x += side * (brick.velocity.x + w * z);
      slip_z += side * (brick.velocity.z - w * x);
      return w;
    };
    const double turn_a = bend(touch.a, 1.0);
    double turning = 0.0;
    if (touch.b >= 0) {
      const double turn_b = bend(touch.b, -1.0);
      turning = touch.now.face_of_a ? turn_a : turn_b;
    }
    const double nx = touch.now.normal_x, nz = touch.now.normal_z;
    const double normal = nx * bend_x + nz * bend_z + 2.0 * turning * (nz * slip_x - nx * slip_z);
    row.bias = point.separation / (point.separation > 0.0 ? time : world_.step) + 0.5 * time * normal;
    row.tangent_bias = 0.5 * time * (nz * bend_x - nx * bend_z);
  }
}

void PlaneFront::kick(std::span<PlaneUnknown> unknowns, double time) const {
  for (PlaneUnknown& unknown : unknowns) unknown.velocity.z -= time * world_.gravity;
  for (const Force& force : forces_) {
    const int place = place_of(force.brick);
    if (place < 0) continue;
    const PlaneBrick& brick = bricks_[static_cast<std::size_t>(place)];
    if (!brick.moving) continue;
    const double z = -force.x * brick.box.sine + force.z * brick.box.cosine;
    PlaneVec& velocity = unknowns[static_cast<std::size_t>(brick.unknown)].velocity;
    velocity.x += time * force.along / brick.mass;
    velocity.turn += time * force.along * z / brick.inertia;
  }
}

// Half a kick from the velocities of this moment, for a drift of `time`.
void PlaneFront::plan(double time) {
  make_rows(&PlaneMemory::kick);
  set_bias(time);
  for (const PlaneBrick& brick : bricks_) {
    if (!brick.moving) continue;
    unknowns_[static_cast<std::size_t>(brick.unknown)].velocity = brick.velocity;
    unknowns_[static_cast<std::size_t>(brick.unknown)].guess = brick.velocity;
  }
  kick(unknowns_, 0.5 * time);
  solver_.solve(unknowns_, rows_);
  for (PlaneBrick& brick : bricks_) {
    if (brick.moving) brick.middle = unknowns_[static_cast<std::size_t>(brick.unknown)].velocity;
  }
  planned_for_ = time;
  remember_impulses(0.5 * time, &PlaneMemory::kick);
}

// A kick from the middle of a drift of `time` to that of the next whole step; the velocity of this moment lies between.
void PlaneFront::leap(double time) {
  const double next = world_.step;
  make_rows(&PlaneMemory::kick);
  set_bias(next);
  for (const PlaneBrick& brick : bricks_) {
    if (!brick.moving) continue;
    unknowns_[static_cast<std::size_t>(brick.unknown)].velocity = brick.middle;
    unknowns_[static_cast<std::size_t>(brick.unknown)].guess = brick.middle;
  }
  kick(unknowns_, 0.5 * (time + next));
  solver_.solve(unknowns_, rows_);
  const double share = time / (time + next);
  for (PlaneBrick& brick : bricks_) {
    if (!brick.moving) continue;
    const PlaneVec& after = unknowns_[static_cast<std::size_t>(brick.unknown)].velocity;
    brick.velocity = brick.middle + share * (after - brick.middle);
    brick.middle = after;
  }
  remember_impulses(0.5 * (time + next), &PlaneMemory::kick);
  planned_for_ = next;
}

// Keeps what the points carry and do; one that parts has to come back to touch again.
void PlaneFront::remember_impulses(double time, PointState PlaneMemory::* states) {
  const double slow = 0.5 * world_.gravity * world_.step;
  for (PlaneTouch& touch : touches_) touch.impulse = 0.0;
  for (const PlaneRow& row : rows_) {
    PlaneTouch& touch = touches_[static_cast<std::size_t>(row.touch)];
    PlaneMemory& memory = touch.memory[static_cast<std::size_t>(row.point)];
    touch.impulse += row.normal;
    memory.*states = row.state;
    if (row.state.pressed) continue;
    double parting = product_of(row.normal_a, unknowns_[static_cast<std::size_t>(row.a)].velocity);
    if (row.b >= 0) parting += product_of(row.normal_b, unknowns_[static_cast<std::size_t>(row.b)].velocity);
    if (parting > slow) memory.active = false;
  }
  for (PlaneTouch& touch : touches_) touch.load = time > 0.0 ? touch.impulse / time : 0.0;
}

PlaneBox PlaneFront::box_at(const PlaneBrick& brick, double time, double whole) const {
  PlaneBox box = brick.box;
  if (!brick.moving) return box;
  // The acceleration of this part is constant: 2 (middle - velocity) / whole.
  box.place = box.place + time * brick.velocity + (time * time / whole) * (brick.middle - brick.velocity);
  set_turn(box);
  return box;
}

void PlaneFront::try_drift(double time) {
  for (PlaneBrick& brick : bricks_) brick.next = box_at(brick, time, time);
  for (PlaneTouch& touch : touches_) {
    const PlaneBrick& a = bricks_[static_cast<std::size_t>(touch.a)];
    touch.next.axis = touch.now.axis;
    if (touch.b < 0) {
      touch_floor(a.next, world_.tolerances.margin * a.thin, touch.next);
      continue;
    }
    const PlaneBrick& b = bricks_[static_cast<std::size_t>(touch.b)];
    touch_boxes(a.next, b.next, world_.tolerances.margin * thinner(touch), touch.next);
  }
}

namespace {

bool was_active(const PlaneTouch& touch, std::uint8_t feature) {
  for (int k = 0; k < touch.now.count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (touch.now.points[at].feature == feature) return touch.memory[at].active;
  }
  return false;
}

// The distance of the nearest point that is not active yet.
double new_distance(const PlaneTouch& touch, const PlaneManifold& manifold) {
  if (manifold.count == 0) return manifold.parted;
  double least = 1e300;
  for (int k = 0; k < manifold.count; ++k) {
    const PlanePoint& point = manifold.points[static_cast<std::size_t>(k)];
    if (!was_active(touch, point.feature)) least = std::min(least, point.separation);
  }
  return least;
}

}  // namespace

// When the first new point touches [s]; `time` if none does before.
double PlaneFront::first_impact(double time) {
  double first = time;
  for (const PlaneTouch& touch : touches_) {
    if (touch.next.count == 0) continue;
    const double near = world_.tolerances.touching * thinner(touch);
    if (new_distance(touch, touch.next) > -near) continue;
    first = std::min(first, impact_of(touch, time));
  }
  return first;
}

double PlaneFront::distance_at(const PlaneTouch& touch, double time, double whole) const {
  PlaneManifold manifold;
  manifold.axis = touch.now.axis;
  const PlaneBox a = box_at(bricks_[static_cast<std::size_t>(touch.a)], time, whole);
  if (touch.b < 0) {
    touch_floor(a, 1e300, manifold);
  } else {
    touch_boxes(a, box_at(bricks_[static_cast<std::size_t>(touch.b)], time, whole), 1e300, manifold);
  }
  return new_distance(touch, manifold);
}

// The moment at which a point of this pair begins to touch, by the secant that keeps both signs (the Illinois rule).
double PlaneFront::impact_of(const PlaneTouch& touch, double time) const {
  const double enough = world_.tolerances.located * thinner(touch);
  double low = 0.0, high = time;
  double at_low = distance_at(touch, 0.0, time), at_high = new_distance(touch, touch.next);
  // It touched from the beginning without taking part: nothing to locate.
  if (at_low <= world_.tolerances.touching * thinner(touch) || at_low > 1e200) return time;
  double middle = time;
  for (int i = 0, side = 0; i < 30; ++i) {
    middle = (low * at_high - high * at_low) / (at_high - at_low);
    const double value = distance_at(touch, middle, time);
    if (std::abs(value) <= enough || !(value < 1e200)) break;
    if (value > 0.0) {
      low = middle;
      at_low = value;
      if (side == 1) at_high *= 0.5;
      side = 1;
    } else {
      high = middle;
      at_high = value;
      if (side == -1) at_low *= 0.5;
      side = -1;
    }
  }
  return middle;
}

// Moves on by `cut` of a drift that was tried for `whole`; a point is the same where its feature is.
void PlaneFront::accept_drift(double cut, double whole) {
  double work = 0.0;
  const auto work_place = [this](const Force& force) {
    const PlaneBrick& brick = bricks_[static_cast<std::size_t>(place_of(force.brick))];
    return brick.box.place.x + force.x * brick.box.cosine + force.z * brick.box.sine;
  };
  for (const Force& force : forces_) work -= force.along * work_place(force);
  for (PlaneBrick& brick : bricks_) {
    if (!brick.moving) continue;
    brick.box = cut < whole ? box_at(brick, cut, whole) : brick.next;
    brick.before_drift = brick.velocity;
    brick.velocity = brick.velocity + (2.0 * cut / whole) * (brick.middle - brick.velocity);
  }
  for (const Force& force : forces_) work += force.along * work_place(force);
  world_.push_work += work;
  for (PlaneTouch& touch : touches_) {
    if (cut < whole) {
      const PlaneBrick& a = bricks_[static_cast<std::size_t>(touch.a)];
      touch.next.axis = touch.now.axis;
      if (touch.b < 0) {
        touch_floor(a.box, world_.tolerances.margin * a.thin, touch.next);
      } else {
        touch_boxes(a.box, bricks_[static_cast<std::size_t>(touch.b)].box, world_.tolerances.margin * thinner(touch), touch.next);
      }
    }
    std::array<PlaneMemory, 2> memory;
    for (int k = 0; k < touch.next.count; ++k) {
      for (int j = 0; j < touch.now.count; ++j) {
        if (touch.now.points[static_cast<std::size_t>(j)].feature != touch.next.points[static_cast<std::size_t>(k)].feature) continue;
        memory[static_cast<std::size_t>(k)] = touch.memory[static_cast<std::size_t>(j)];
      }
      memory[static_cast<std::size_t>(k)].fresh = false;
    }
    touch.memory = memory;
    touch.now = touch.next;
  }
}

// Points that have come to touch take part from now on. Returns whether there are any.
bool PlaneFront::activate_new_points() {
  bool any = false;
  for (PlaneTouch& touch : touches_) {
    const double near = world_.tolerances.touching * thinner(touch);
    for (int k = 0; k < touch.now.count; ++k) {
      PlaneMemory& memory = touch.memory[static_cast<std::size_t>(k)];
      if (memory.active || touch.now.points[static_cast<std::size_t>(k)].separation > near) continue;
      memory = {.active = true, .fresh = true};
      any = true;
    }
  }
  return any;
}

// New points touch: the blow acts together with half a kick for the drift of `next` that follows. A bounce, which needs the blow by itself,
// comes before that. The drift before was planned for `whole`.
void PlaneFront::take_blow(double whole, double next) {
  blow(false);
  // The forces between blows change little, so the velocity at this moment is that of the middle of the drift less what they did before.
  for (PlaneBrick& brick : bricks_) {
    if (brick.moving) brick.acceleration = (2.0 / whole) * (brick.middle - brick.before_drift);
  }
  plan(next);
  for (PlaneTouch& touch : touches_) touch.load = 0.0;
  for (PlaneBrick& brick : bricks_) {
    if (brick.moving) brick.velocity = brick.middle - (0.5 * next) * brick.acceleration;
  }
}

// A blow by itself, `always` or only if something bounces. Restitution is Poisson's [Glocker1995]: every point gives back a share of the
// impulse that it took, and only where a bounce lasts longer than a step; a slower hit keeps the points together.
void PlaneFront::blow(bool always) {
  make_rows(&PlaneMemory::blow);
  for (const PlaneBrick& brick : bricks_) {
    if (!brick.moving) continue;
    unknowns_[static_cast<std::size_t>(brick.unknown)].velocity = brick.velocity;
    unknowns_[static_cast<std::size_t>(brick.unknown)].guess = brick.velocity;
  }
  const double slow = 0.5 * world_.gravity * world_.step;
  bool bounces = false;
  for (PlaneRow& row : rows_) {
    const PlaneTouch& touch = touches_[static_cast<std::size_t>(row.touch)];
    row.bias = std::max(touch.now.points[static_cast<std::size_t>(row.point)].separation, 0.0) / world_.step;
    double closing = -product_of(row.normal_a, unknowns_[static_cast<std::size_t>(row.a)].velocity);
    if (row.b >= 0) closing -= product_of(row.normal_b, unknowns_[static_cast<std::size_t>(row.b)].velocity);
    bounces = bounces || (touch.restitution > 0.0 && touch.restitution * closing > slow);
  }
  if (!bounces && !always) return;
  before_blow_ = unknowns_;
  solver_.solve(unknowns_, rows_);
  if (bounces) give_back();
  for (PlaneBrick& brick : bricks_) {
    if (brick.moving) brick.velocity = unknowns_[static_cast<std::size_t>(brick.unknown)].velocity;
  }
  remember_impulses(0.0, &PlaneMemory::blow);
}

// The second half of a bounce: every point has its share of impulse more, at least.
void PlaneFront::give_back() {
  unknowns_ = before_blow_;
  for (PlaneRow& row : rows_) {
    row.base = (1.0 + touches_[static_cast<std::size_t>(row.touch)].restitution) * row.normal;
    const auto push = [&](int unknown, const Column<3>& j) {
      if (unknown < 0) return;
      PlaneUnknown& body = unknowns_[static_cast<std::size_t>(unknown)];
      body.velocity = body.velocity + row.base * PlaneVec{j[0] / body.mass, j[1] / body.mass, j[2] / body.inertia};
    };
    push(row.a, row.normal_a);
    push(row.b, row.normal_b);
  }
  solver_.solve(unknowns_, rows_);
  for (PlaneRow& row : rows_) row.normal += row.base;
}

bool PlaneFront::is_hit(const PlaneTouch& touch, const PlaneBrick& still) const {
  for (int k = 0; k < touch.now.count; ++k) {
    if (touch.memory[static_cast<std::size_t>(k)].fresh) return true;
  }
  return !touch.bearing && touch.load > world_.tolerances.load * world_.gravity * still.mass;
}

// Bricks that stand or rest and are hit in this moment begin to move, so that the impact acts on them.
void PlaneFront::wake_struck(double now) {
  for (bool again = true; again;) {
    again = false;
    for (const PlaneTouch& touch : touches_) {
      if (touch.b < 0 || touch.now.count == 0) continue;
      const PlaneBrick& a = bricks_[static_cast<std::size_t>(touch.a)];
      const PlaneBrick& b = bricks_[static_cast<std::size_t>(touch.b)];
      if (a.moving == b.moving || !is_hit(touch, a.moving ? b : a)) continue;
      struck_now_.push_back(a.moving ? Struck{b.id, a.id} : Struck{a.id, b.id});
      wake(struck_now_.back().brick, now);
      again = true;
      break;
    }
  }
}

}  // namespace topple::rigid

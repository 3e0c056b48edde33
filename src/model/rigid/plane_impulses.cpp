#include "model/rigid/plane_impulses.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

namespace {

// What is left of a point's velocity under its impulse, as a share of what the impulse stops. Contacts of which there are more than needed
// then share their load in one way, and in 4 ms a brick sinks by a millionth of its thickness under its weight. Tuned on rows of
// gap 7.5 and 16.5 mm: with less, states of friction settle later; with more, fallen bricks creep and rest later.
constexpr double kCompliance = 1e-4;

// So many bricks behind the one that was struck do the same after every strike; those farther back go by what each did before.
constexpr int kLedByHead = 2;

// An impact is located to a part of the thickness, and what the bricks overlap then goes by a tenth a step: the velocity at which it goes
// is energy that nobody gave.
constexpr double kOverlapLeft = 0.9;

constexpr int kBends = 3;  // So many times a blow is solved again with the turning that it makes.

constexpr int kFloorOf = 1 << 20;  // In a pattern: the floor.

double response(const PlaneBrick& brick, const Column<3>& j) {
  return (j[0] * j[0] + j[1] * j[1]) * brick.inverse_mass + j[2] * j[2] * brick.inverse_inertia;
}

}  // namespace

void PlaneImpulses::make_rows(PointState PlaneMemory::* guess) {
  rows_.clear();
  unknowns_.clear();
  // From the head of the wave backwards: what changes its state is mostly at the tail, and then little has to be factorised anew.
  for (std::size_t i = state_.bricks.size(); i-- > 0;) {
    PlaneBrick& brick = state_.bricks[i];
    brick.unknown = brick.moving ? static_cast<int>(unknowns_.size()) : -1;
    if (brick.moving) unknowns_.push_back({brick.mass, brick.inertia, {}, {}});
  }
  for (const int pair : state_.near_pairs) {
    const PlaneTouch& touch = state_.touch(pair);
    const double nx = touch.now.normal_x, nz = touch.now.normal_z;
    for (int k = 0; k < touch.now.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const PlaneMemory& memory = touch.memory[at];
      if (!memory.active) continue;
      const PlanePoint& point = touch.now.points[at];
      PlaneRow& row = rows_.emplace_back();
      row.touch = pair;
      row.point = k;
      double normal = 0.0, tangent = 0.0;
      const auto couple = [&](int place, double side, int& unknown, Column<3>& n, Column<3>& t) {
        const PlaneBrick& brick = state_.brick(place);
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
      if (row.a < 0) {
        rows_.pop_back();
        continue;
      }
      row.normal_stiffness = 1.0 / (kCompliance * normal);
      row.tangent_stiffness = 1.0 / (kCompliance * tangent);
      row.friction = touch.friction;
      row.state = memory.*guess;
    }
  }
}

// After a drift for `time` no active point will be closer than touching; `after_blow` if the bricks turn as they will after the blow that
// is planned.
void PlaneImpulses::set_bias(double time, bool after_blow) {
  const double slow = 0.5 * world_.gravity * world_.step;
  for (PlaneRow& row : rows_) {
    const PlaneTouch& touch = state_.touch(row.touch);
    const PlanePoint& point = touch.now.points[static_cast<std::size_t>(row.point)];
    // Second derivative of the distance of the two material points while no force acts [m/s^2]; the normal turns with the brick whose
    // face it is, which adds the last term.
    double bend_x = 0.0, bend_z = 0.0, slip_x = 0.0, slip_z = 0.0;
    const auto bend = [&](int place, double side) {
      const PlaneBrick& brick = state_.brick(place);
      const PlaneVec velocity = after_blow ? after_the_blow(brick, time) : brick.velocity;
      const double x = point.x - brick.box.place.x, z = point.z - brick.box.place.z, w = velocity.turn;
      bend_x -= side * w * w * x;
      bend_z -= side * w * w * z;
      slip_x += side * (velocity.x + w * z);
      slip_z += side * (velocity.z - w * x);
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
    // An overlap goes within a step, but never so fast that it would throw the bricks apart; the one that an impact left goes slowly.
    const double left = kOverlapLeft * touch.memory[static_cast<std::size_t>(row.point)].overlap;
    const double overlap = std::min(point.separation + left, 0.0);
    const double gap = point.separation > 0.0 ? point.separation / time : std::max(overlap / world_.step, -slow);
    row.bias = gap + 0.5 * time * normal;
    row.tangent_bias = 0.5 * time * (nz * bend_x - nx * bend_z);
  }
}

// The forces between blows change little, so the velocity at this moment is that of the middle of the drift less what they did before.
PlaneVec PlaneImpulses::after_the_blow(const PlaneBrick& brick, double time) {
  return brick.moving ? brick.middle - (0.5 * time) * brick.acceleration : PlaneVec{};
}

// A brick that is struck turns at once, and so do the paths of its points bend. Whether that makes a difference.
bool PlaneImpulses::bends_otherwise(double time) {
  compression_ = rows_;
  set_bias(time, true);
  bool otherwise = false;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const double thin = state_.touch(rows_[k].touch).thin;
    otherwise = otherwise || time * std::abs(rows_[k].bias - compression_[k].bias) > world_.tolerances.bends * thin;
  }
  return otherwise;
}

void PlaneImpulses::kick(double time) {
  for (PlaneUnknown& unknown : unknowns_) unknown.velocity.z -= time * world_.gravity;
  for (const PlaneForce& force : state_.forces) {
    const int place = state_.place_of(force.brick);
    if (place < 0) continue;
    const PlaneBrick& brick = state_.brick(place);
    if (!brick.moving) continue;
    const double z = -force.x * brick.box.sine + force.z * brick.box.cosine;
    PlaneVec& velocity = unknowns_[static_cast<std::size_t>(brick.unknown)].velocity;
    velocity.x += time * force.along / brick.mass;
    velocity.turn += time * force.along * z / brick.inertia;
  }
  for (const PlaneRow& row : rows_) {
    const PlaneMemory& memory = state_.touch(row.touch).memory[static_cast<std::size_t>(row.point)];
    if (memory.leaning == 0.0) continue;
    PlaneUnknown& unknown = unknowns_[static_cast<std::size_t>(row.a)];
    const double normal = time * memory.leaning, tangent = time * memory.leaning_tangent;
    const auto push = [&](std::size_t i) { return normal * row.normal_a[i] + tangent * row.tangent_a[i]; };
    unknown.velocity = unknown.velocity + PlaneVec{push(0) / unknown.mass, push(1) / unknown.mass, push(2) / unknown.inertia};
  }
}

// Velocities before what acts now, and the first guess of those after it.
void PlaneImpulses::begin_with(PlaneVec PlaneBrick::* velocity, std::span<PlaneUnknown> unknowns) const {
  for (const PlaneBrick& brick : state_.bricks) {
    if (!brick.moving) continue;
    PlaneUnknown& unknown = unknowns[static_cast<std::size_t>(brick.unknown)];
    unknown.velocity = unknown.guess = brick.*velocity;
  }
}

void PlaneImpulses::solve_half_a_kick(double time) {
  begin_with(&PlaneBrick::velocity, unknowns_);
  kick(0.5 * time);
  solver_.solve(unknowns_, rows_);
  for (PlaneBrick& brick : state_.bricks) {
    if (brick.moving) brick.middle = unknowns_[static_cast<std::size_t>(brick.unknown)].velocity;
  }
}

void PlaneImpulses::plan(double time, bool with_blow, BrickId struck) {
  make_rows(&PlaneMemory::kick);
  Pattern* const pattern = struck == kNoBrick ? nullptr : &state_.strike;
  const int head = pattern == nullptr ? 0 : state_.place_of(struck);
  if (pattern != nullptr) {
    recall(*pattern, head);
    state_.last_struck = struck;
    state_.since_strike = 0;
  }
  set_bias(time);
  solve_half_a_kick(time);
  for (int i = 0; with_blow && i < kBends && bends_otherwise(time); ++i) solve_half_a_kick(time);
  state_.planned_for = time;
  if (pattern != nullptr) keep(*pattern, head);
  // What the points do while a blow acts is not what they will do in the next kick.
  remember_impulses(0.5 * time, pattern == nullptr ? &PlaneMemory::kick : &PlaneMemory::blow);
}

// Along a row each brick is struck as the one before it was: the states of the contacts, counted from the brick that is struck, are the
// guess for the next time.
void PlaneImpulses::recall(const Pattern& pattern, int head, int most) {
  std::size_t next = 0;
  for (std::size_t i = rows_.size(); i-- > 0;) {
    PlaneRow& row = rows_[i];
    const PlaneTouch& touch = state_.touch(row.touch);
    const int a = head - touch.a, b = touch.b < 0 ? kFloorOf : head - touch.b;
    const std::uint8_t feature = touch.now.points[static_cast<std::size_t>(row.point)].feature;
    if (head - std::max(touch.a, touch.b) > most) break;
    // Both go in the same order.
    const auto comes_before = [a, b](const PatternPoint& point) {
      const int nearer = std::min(point.a, point.b), farther = std::max(point.a, point.b);
      return nearer != std::min(a, b) ? nearer < std::min(a, b) : farther < std::max(a, b);
    };
    while (next < pattern.size() && comes_before(pattern[next])) ++next;
    for (std::size_t k = next; k < pattern.size() && pattern[k].a == a && pattern[k].b == b; ++k) {
      if (pattern[k].feature == feature) row.state = pattern[k].state;
    }
  }
}

void PlaneImpulses::keep(Pattern& pattern, int head, int most) const {
  pattern.clear();
  for (std::size_t i = rows_.size(); i-- > 0;) {
    const PlaneRow& row = rows_[i];
    const PlaneTouch& touch = state_.touch(row.touch);
    if (head - std::max(touch.a, touch.b) > most) break;
    pattern.push_back({head - touch.a, touch.b < 0 ? kFloorOf : head - touch.b,
                       touch.now.points[static_cast<std::size_t>(row.point)].feature, row.state});
  }
}

void PlaneImpulses::leap(double time, double next) {
  make_rows(&PlaneMemory::kick);
  const int head = state_.place_of(state_.last_struck);
  Pattern* const pattern = head >= 0 && state_.since_strike < state_.leaps.size() ? &state_.leaps[state_.since_strike++] : nullptr;
  if (pattern != nullptr) recall(*pattern, head, kLedByHead);
  set_bias(next);
  begin_with(&PlaneBrick::middle, unknowns_);
  kick(0.5 * (time + next));
  solver_.solve(unknowns_, rows_);
  const double share = time / (time + next);
  for (PlaneBrick& brick : state_.bricks) {
    if (!brick.moving) continue;
    const PlaneVec& after = unknowns_[static_cast<std::size_t>(brick.unknown)].velocity;
    brick.velocity = brick.middle + share * (after - brick.middle);
    brick.middle = after;
  }
  if (pattern != nullptr) keep(*pattern, head, kLedByHead);
  remember_impulses(0.5 * (time + next), &PlaneMemory::kick);
  state_.planned_for = next;
}

// Keeps what the points carry and do; one that has parted has to come back to touch again.
void PlaneImpulses::remember_impulses(double time, PointState PlaneMemory::* states) {
  const double slow = 0.5 * world_.gravity * world_.step;
  for (const int pair : state_.near_pairs) state_.touch(pair).impulse = 0.0;
  for (const PlaneRow& row : rows_) {
    PlaneTouch& touch = state_.touch(row.touch);
    PlaneMemory& memory = touch.memory[static_cast<std::size_t>(row.point)];
    touch.impulse += row.normal;
    memory.overlap *= time > 0.0 ? kOverlapLeft : 1.0;
    memory.*states = row.state;
    if (memory.fresh) memory.kick = row.state;
    memory.normal = time > 0.0 ? row.normal / time : 0.0;
    memory.tangent = time > 0.0 ? row.tangent / time : 0.0;
    if (row.state.pressed || touch.now.points[static_cast<std::size_t>(row.point)].separation <= world_.tolerances.touching * touch.thin)
      continue;
    double parting = product_of(row.normal_a, unknowns_[static_cast<std::size_t>(row.a)].velocity);
    if (row.b >= 0) parting += product_of(row.normal_b, unknowns_[static_cast<std::size_t>(row.b)].velocity);
    if (parting > slow) memory.active = false;
  }
  for (const int pair : state_.near_pairs) {
    PlaneTouch& touch = state_.touch(pair);
    touch.load = time > 0.0 ? touch.impulse / time : 0.0;
  }
}

}  // namespace topple::rigid

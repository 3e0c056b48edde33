// One step of a front.
//
// Between impacts this is the leapfrog of Størmer and Verlet with one-sided constraints: bricks drift by their velocity in the middle of
// the step, and one solution of all contacts takes it to the middle of the next one, so that no active point will be closer than touching
// at that step's end (the curvature of its path included). Bilaterally that is SHAKE, which moves bricks as RATTLE does [Andersen1983] for
// half the work; it is of second order. Of a turning brick it is the angular momentum that the drift keeps and the kick changes.
// Impacts are located inside the step (the drift is cut short where a new point touches), so the order holds across them and the front
// speed does not lock in to the step. After an impact the leapfrog starts anew with half a kick.
#include <algorithm>
#include <cmath>

#include "model/rigid/free_front.h"

namespace topple::rigid {

namespace {

// A corner may dip by so many thicknesses amid a drift; but a step has no more drifts than that.
constexpr double kDip = 2.5e-3;
constexpr double kMostStrides = 8.0;

}  // namespace

// Drifts in a step. What holds at both ends of a drift need not hold amid it: a corner that turns dips by an eighth of its acceleration
// times the time squared.
int FreeFront::strides_of_step() const {
  double most = 0.0;
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (!bricks_.members[i].moving) continue;
    const Vec3 spin = spin_of(bricks_.bodies[i]);
    most = std::max(most, dot(spin, spin) * bricks_.bodies[i].radius / bricks_.members[i].thin);
  }
  const double strides = std::sqrt(0.125 * most / kDip) * world_.step;
  return std::max(moving_ <= kFew ? kStridesOfFew : 1, static_cast<int>(std::min(std::ceil(strides), kMostStrides)));
}

void FreeFront::advance(double begin, std::span<const PushMoment> moments) {
  ledger_.events.clear();
  if (rested_) members_.drop_idle();
  may_part_ = may_part_ || rested_;
  rested_ = false;
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    bricks_.members[i].velocity_before = bricks_.bodies[i].velocity;
    bricks_.members[i].spin_before = bricks_.bodies[i].angular_velocity;
  }
  may_part_ = members_.list_those_that_strayed() || may_part_;
  wake_unsupported(begin);
  const double end = begin + world_.step;
  const int strides = strides_of_step();
  stride_ = world_.step / strides;
  double now = begin;
  int cuts = 0, stride = 1;
  std::size_t next = 0;
  while (true) {
    while (next < moments.size() && moments[next].time <= now) apply(moments[next++], now);
    if (now >= end) break;
    const double whole = stride < strides ? begin + stride * stride_ : end;
    const double until = next < moments.size() ? std::min(whole, moments[next].time) : whole;
    const double taken = part(now, until - now, cuts < world_.tolerances.cuts * moving_);
    if (taken < until - now) {
      ++cuts;
      now += taken;
    } else {
      now = until;
      stride += now < whole ? 0 : 1;
    }
  }
  retire(end);
}

void FreeFront::apply(const PushMoment& moment, double now) {
  impulses_.forget_plan();
  energy_law_.forget();
  if (moment.push != nullptr) return begin_push(*moment.push, now);
  std::erase_if(bricks_.forces, [&](const ActiveForce& f) { return f.brick == moment.brick && f.end <= now; });
  const int place = members_.place_of(moment.brick);
  if (place >= 0) bricks_.member(place).pushed = false;
}

// One part of the step, of at most `time`; returns how long it was.
double FreeFront::part(double begin, double time, bool may_cut) {
  if (std::abs(impulses_.planned_for() - time) > 1e-9 * world_.step) impulses_.plan(time, false);
  drift_.begin(time, may_cut);
  const double cut = drift_.cut(), now = begin + cut;
  struck_now_.clear();
  const bool fresh = drift_.end(ledger_.push_work);
  for (const FreeDrift::Arrival& arrival : drift_.arrivals()) tell_arrival(arrival.brick, begin + arrival.time);
  wake_struck(now);
  const double next = cut < time ? time - cut : stride_;
  if (!struck_now_.empty() || (fresh && (cut < time || impulses_.closes_fast()))) {
    // At the end of a step others read the velocities right after it, and forces may act then that did not before.
    if (impulses_.take_blow(next, cut == time && struck_now_.empty())) keep_energy();
    note_struck(now);
    note_landed(now);
  } else if (cut == time) {
    impulses_.leap(time, stride_);
    keep_energy();
    wake_struck(now);
  }
  return cut;
}

// After a kick or a bounce.
void FreeFront::keep_energy() {
  const double kinetic = bricks_.moving_energy();
  double energy = kinetic;
  for (const Body& body : bricks_.bodies) {
    if (body.inverse_mass > 0.0) energy += potential_energy(world_, body.id, body.position.z);
  }
  if (!bricks_.forces.empty()) energy_law_.forget();
  const double taken = energy_law_.excess(energy, bricks_.spare_energy(world_.gravity));
  if (taken <= 0.0) return;
  const double share = std::sqrt(std::max(1.0 - taken / kinetic, 0.0));
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    Member& member = bricks_.members[i];
    if (!member.moving) continue;
    const Twist now = twist_of(bricks_.bodies[i]);
    set_twist(bricks_.bodies[i], {share * now.velocity, share * now.spin});
    member.middle = {share * member.middle.velocity, share * member.middle.spin};
  }
}

bool FreeFront::is_hit(const Touch& touch, std::size_t still) const {
  for (int k = 0; k < touch.now.count; ++k) {
    if (touch.memory[static_cast<std::size_t>(k)].fresh) return true;
  }
  const double weight = world_.gravity * world_.kinds[bricks_.bodies[still].kind].mass;
  return !touch.bearing && touch.load > world_.tolerances.load * weight;
}

// Bricks that stand or rest and are hit in this moment begin to move, so that the impact acts on them.
void FreeFront::wake_struck(double now) {
  for (bool again = true; again;) {
    again = false;
    for (const Touch& touch : bricks_.touches) {
      if (touch.b == kFloor || touch.now.count == 0) continue;
      const bool a_moves = bricks_.member(touch.a).moving;
      const bool b_moves = bricks_.member(touch.b).moving;
      if (a_moves == b_moves) continue;
      const auto still = static_cast<std::size_t>(a_moves ? touch.b : touch.a);
      const auto mover = static_cast<std::size_t>(a_moves ? touch.a : touch.b);
      if (!is_hit(touch, still)) continue;
      struck_now_.push_back({bricks_.bodies[still].id, bricks_.bodies[mover].id});
      wake(bricks_.bodies[still].id, now);
      again = true;
      break;
    }
  }
}

}  // namespace topple::rigid

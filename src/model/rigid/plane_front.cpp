// One step of a plane front.
//
// Between impacts this is the leapfrog of Størmer and Verlet with one-sided constraints: bricks drift by their velocity in the middle of
// the step, and one solution of all contacts takes it to the middle of the next one, so that no active point will be closer than touching
// at that step's end (the curvature of its path included). Bilaterally that is SHAKE, which moves bricks as RATTLE does [Andersen1983] for
// half the work; it is of second order. Impacts are located inside the step (the drift is cut short where a new point touches), so the
// order holds across them and the front speed does not lock in to the step. After an impact the leapfrog starts anew with half a kick.
#include "model/rigid/plane_front.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

namespace {

// Of a step. Since drifts begin anew at each strike, what a step leaves out does not come out even from strike to strike.
constexpr double kDrift = 5.0 / 6.0;

// A brick is borne by another one where the normal of their contact points up by more than this.
constexpr double kLeans = 0.1;

// What rests goes on to lean on what moves, so it may rest after this share of the time that others have to wait.
constexpr double kPatience = 0.5;
constexpr double kRetire = 1.25;

// How far the farthest corner has moved [m].
double displacement(const PlaneBrick& brick, const PlaneVec& from) {
  const PlaneVec moved = brick.box.place - from;
  return std::sqrt(moved.x * moved.x + moved.z * moved.z) + brick.radius * std::abs(moved.turn);
}

}  // namespace

PlaneFront::PlaneFront(World& world, std::int32_t number, BrickId first) : Wave(world, number), plane_(plane_of_row(world, first)) {}

void PlaneFront::advance(double begin, std::span<const PushMoment> moments) {
  ledger_.events.clear();
  rested_now_.clear();
  if (!drift_.is_under_way()) now_ = begin;
  for (const PushMoment& moment : moments) {
    go_on_to(moment.time);
    interrupt();
    apply(moment);
  }
  go_on_to(begin + world_.step);
}

void PlaneFront::apply(const PushMoment& moment) {
  state_.planned_for = 0.0;
  energy_law_.forget();
  if (moment.push != nullptr) return begin_push(*moment.push, moment.time);
  std::erase_if(state_.forces, [&](const PlaneForce& f) { return f.brick == moment.brick && f.end <= moment.time; });
  const int place = members_.place_of(moment.brick);
  if (place >= 0) state_.brick(place).pushed = false;
}

// Drifts until the one that goes on beyond this moment.
void PlaneFront::go_on_to(double moment) {
  while (moving_ > 0) {
    if (repeat_.is_on() && repeat_to(moment)) return;
    if (!drift_.is_under_way()) begin_drift(moment);
    drift_.go_to(moment - now_);
    if (now_ + drift_.cut() > moment + 1e-9 * world_.step) return note_arrivals(drift_.done());
    end_drift();
  }
  now_ = moment;
}

// Drifts end with the step where its energies are small, or the work of a force must be known.
bool PlaneFront::keeps_step() const { return moving_ <= kFew || !state_.forces.empty(); }

double PlaneFront::stride() const { return keeps_step() ? world_.step / (moving_ <= kFew ? kStridesOfFew : 1) : kDrift * world_.step; }

// Elsewhere a drift is equally long wherever it begins, and so after a strike all goes as it went after the strike before.
void PlaneFront::begin_drift(double moment) {
  const double left = moment - now_;
  const double whole = keeps_step() && left > 1e-6 * world_.step ? std::min(stride(), left) : stride();
  if (std::abs(state_.planned_for - whole) > 1e-9 * world_.step) impulses_.plan(whole, false);
  drift_.begin(whole, state_.cuts < world_.tolerances.cuts * moving_);
  if (even_row_.strikes() > 0) cycle_.begin_drift(drift_, state_);
}

void PlaneFront::end_drift() {
  const double whole = drift_.whole(), cut = drift_.cut();
  note_arrivals(cut);
  const PlaneCycle::Marks before = marks_of(ledger_, rested_now_);
  struck_now_.clear();
  const bool fresh = drift_.end(cut, ledger_.push_work);
  now_ += cut;
  state_.since_look += cut;
  state_.cuts += cut < whole ? 1 : 0;
  state_.planned_for = cut < whole ? 0.0 : state_.planned_for;
  wake_struck(now_);
  if (!struck_now_.empty() || (fresh && (cut < whole || impulses_.closes_fast()))) {
    if (impulses_.take_blow(whole, stride(), struck_now_.empty() ? kNoBrick : struck_now_.back().brick)) keep_energy();
    note_struck(now_);
    note_landed(now_);
  } else if (cut == whole) {
    impulses_.leap(whole, stride());
    keep_energy();
    wake_struck(now_);
  }
  if (state_.since_look > 0.999 * kDrift * world_.step) look_around();
  if (even_row_.strikes() > 0) cycle_.end_drift(before, ledger_, rested_now_, plane_);
  if (!struck_now_.empty()) after_strike();
}

// The last thing in the drift that ends with a strike.
void PlaneFront::after_strike() {
  const Struck struck = struck_now_.back();
  members_.count_from(members_.place_of(struck.brick));
  even_row_.count(struck, struck_now_.size() == 1 && state_.forces.empty() && state_.planned_for > 0.0);
  if (even_row_.strikes() > 1 && cycle_.is_whole() && even_row_.is_as_kept()) {
    even_row_.take_kept();
    if (world_.repeats && even_row_.goes_on(cycle_)) {
      cycle_.close();
      repeat_.begin(even_row_.way(), now_);
      echoed_.push_back(struck.brick);
      return;
    }
  } else if (even_row_.strikes() > 0) {
    even_row_.keep();
  }
  cycle_.begin(struck.brick);
}

// Tells what is done again up to a moment; whether that was reached.
bool PlaneFront::repeat_to(double moment) {
  while (repeat_.is_on()) {
    const PlaneCycle::Drift& drift = repeat_.drift();
    drift_.follow(drift.whole, drift.cut);
    drift_.go_to(moment - now_);
    for (const PlaneCycle::Arrival& arrival : repeat_.arrivals_until(drift_.done())) {
      tell_arrival(state_.last_struck + arrival.brick, now_ + arrival.time);
    }
    if (now_ + drift.cut > moment + 1e-9 * world_.step) return true;
    now_ += drift.cut;
    tell_end(drift);
    if (!repeat_.go_on()) repeat_strike();
  }
  return false;
}

void PlaneFront::repeat_strike() {
  state_.last_struck += even_row_.way();
  plane_.zero = stand_along(plane_, world_, state_.last_struck);
  for (std::size_t i = 0; i < state_.bricks.size(); ++i) {
    state_.bricks[i].id += even_row_.way();
    world_.note_place(state_.bricks[i].id, static_cast<int>(i));
  }
  repeat_.strike(now_);
  if (!even_row_.goes_on(cycle_)) end_repeat();
}

// From the last strike on all is computed again; what moved unseen is told.
void PlaneFront::end_repeat() {
  repeat_.tell_unseen(unseen_);
  repeat_.end();
  energy_law_.forget();
  drift_.leave();
  even_row_.rename_kept(state_.last_struck);
  cycle_.begin(state_.last_struck);
}

// Where something happens amid a drift that the drift does not know of.
void PlaneFront::interrupt() {
  if (repeat_.is_on()) return break_off();
  if (!drift_.is_under_way()) return;
  even_row_.forget();
  const double done = drift_.done();
  drift_.end(done, ledger_.push_work);
  now_ += done;
  state_.since_look += done;
  state_.planned_for = 0.0;
}

// Once a step, at the end of a drift: who has come to rest, who is near, who has lost what it leans on.
void PlaneFront::look_around() {
  retire(now_);
  list_those_that_strayed();
  for (PlaneBrick& brick : state_.bricks) brick.velocity_before = brick.velocity;
  state_.since_look = 0.0;
  state_.cuts = 0;
  wake_unsupported(now_);
}

// After a kick or a bounce: what steps make of energy by their inexactness is taken out of all velocities.
void PlaneFront::keep_energy() {
  double kinetic = 0.0, spare = 0.0;
  for (const PlaneBrick& brick : state_.bricks) {
    if (!brick.moving) continue;
    kinetic += kinetic_energy(brick, brick.velocity);
    spare += world_.gravity * brick.mass * brick.radius;
  }
  double energy = kinetic;
  for (const PlaneBrick& brick : state_.bricks) {
    if (brick.moving) energy += potential_energy(world_, brick.id, brick.box.place.z);
  }
  if (!state_.forces.empty()) energy_law_.forget();
  const double taken = energy_law_.excess(energy, EnergyLaw::kSpare * spare);
  if (taken <= 0.0) return;
  const double share = std::sqrt(std::max(1.0 - taken / kinetic, 0.0));
  for (PlaneBrick& brick : state_.bricks) {
    brick.velocity = share * brick.velocity;
    brick.middle = share * brick.middle;
  }
}

void PlaneFront::wake(BrickId brick, double /*time*/) {
  interrupt();
  int place = members_.place_of(brick);
  if (place < 0) place = members_.add(brick);
  if (state_.brick(place).moving) return;
  // One that came to rest in this very step has not rested for anybody else.
  if (std::erase_if(ledger_.rested, [brick](const Ledger::Rest& rest) { return rest.brick == brick; }) == 0) ledger_.woken.push_back(brick);
  std::erase_if(rested_now_, [brick](const PlaneBrick& rested) { return rested.id == brick; });
  PlaneBrick& woken = state_.brick(place);
  woken.moving = true;
  energy_law_.add(potential_energy(world_, brick, woken.box.place.z));
  woken.quiet = 0.0;
  woken.before_drift = {};
  woken.listed_at = woken.box.place;
  ++moving_;
  state_.planned_for = 0.0;
  // It presses by itself again.
  for (PlaneTouch& touch : state_.touches) {
    if (touch.a != place && touch.b != place) continue;
    for (PlaneMemory& memory : touch.memory) {
      if (memory.leaning > 0.0) memory.kick = {};
      memory.leaning = memory.leaning_tangent = 0.0;
    }
  }
  PlaneTouch floor = members_.on_floor(place, world_.tolerances.touching);
  // A brick that has just begun to move stands on what it stood on.
  for (PlaneMemory& memory : floor.memory) memory.active = true;
  state_.touches.push_back(floor);
  members_.list_neighbours(place);
  members_.order();
  members_.mark_borne_by(members_.place_of(brick));
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
    for (const int pair : state_.near_pairs) {
      const PlaneTouch& touch = state_.touch(pair);
      if (touch.b < 0 || touch.now.count == 0) continue;
      const PlaneBrick& a = state_.brick(touch.a);
      const PlaneBrick& b = state_.brick(touch.b);
      if (a.moving == b.moving || !is_hit(touch, a.moving ? b : a)) continue;
      struck_now_.push_back(a.moving ? Struck{b.id, a.id} : Struck{a.id, b.id});
      wake(struck_now_.back().brick, now);
      again = true;
      break;
    }
  }
}

// From where a brick was listed to where it is.
void PlaneFront::move(BrickId brick, const PlaneVec& from, const PlaneVec& to) {
  ledger_.moves.push_back({brick, in_world(plane_, from.x, from.z), in_world(plane_, to.x, to.z)});
  if (even_row_.strikes() > 0) cycle_.add_move(brick, from, to);
}

void PlaneFront::list_those_that_strayed() {
  const std::size_t count = state_.bricks.size(), pairs = state_.touches.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!state_.bricks[i].moving) continue;
    const PlaneVec strayed = state_.bricks[i].box.place - state_.bricks[i].listed_at;
    // Two that come towards each other are listed in time: half a radius is to spare.
    const double allowed = 0.24 * state_.bricks[i].radius;
    if (strayed.x * strayed.x + strayed.z * strayed.z < allowed * allowed) continue;
    move(state_.bricks[i].id, state_.bricks[i].listed_at, state_.bricks[i].box.place);
    members_.list_neighbours(static_cast<int>(i));
  }
  if (state_.touches.size() != pairs || state_.rested) {
    members_.drop_idle();
    members_.order();
  }
  state_.rested = false;
}

void PlaneFront::wake_unsupported(double now) {
  // What leans goes on to press, and that force does work: little beside that of a wave, too much for a brick or two.
  const double support = (moving_ <= kFew ? 0.1 : 1.0) * world_.tolerances.support;
  for (bool again = true; again;) {
    again = false;
    for (const PlaneTouch& touch : state_.touches) {
      if (touch.b < 0 || !touch.bearing) continue;
      const PlaneBrick& a = state_.brick(touch.a);
      const PlaneBrick& b = state_.brick(touch.b);
      if (a.moving == b.moving) continue;
      const PlaneBrick& still = a.moving ? b : a;
      if (displacement(a.moving ? a : b, touch.mark) < support * still.thin) continue;
      wake(still.id, now);
      again = true;
      break;
    }
  }
}

// A brick that has come to rest goes on to press on those that bear it, as long as they move: if its weight went at once, the states of all
// contacts of the wave would change.
void PlaneFront::let_lean(PlaneTouch& touch, bool a_rests) const {
  const PlaneBrick& other = state_.brick(a_rests ? touch.b : touch.a);
  const bool is_borne = (a_rests ? 1.0 : -1.0) * touch.now.normal_z > kLeans;
  for (PlaneMemory& memory : touch.memory) {
    memory.leaning = other.moving && is_borne ? memory.normal : 0.0;
    memory.leaning_tangent = other.moving && is_borne ? memory.tangent : 0.0;
    if (memory.leaning > 0.0) memory.kick = {.pressed = false};
  }
}

void PlaneFront::retire(double time) {
  const Timed timed(world_.profile, Stage::plane_rest);
  const Tolerances& limits = world_.tolerances;
  for (std::size_t i = 0; i < state_.bricks.size(); ++i) {
    PlaneBrick& brick = state_.bricks[i];
    if (!brick.moving) continue;
    // How far its farthest corner would go with this speed and this acceleration [m].
    const double horizon = limits.horizon * brick.time_scale;
    const auto corner = [&brick](const PlaneVec& v) { return std::sqrt(v.x * v.x + v.z * v.z) + brick.radius * std::abs(v.turn); };
    const double gain = corner(brick.velocity - brick.velocity_before) / state_.since_look;
    const double ahead = horizon * (corner(brick.velocity) + 0.5 * horizon * gain);
    brick.quiet = ahead < kRetire * limits.retire * brick.thin && !brick.pushed ? brick.quiet + state_.since_look : 0.0;
    if (brick.quiet < kPatience * limits.patience * brick.time_scale) continue;
    energy_law_.add(-kinetic_energy(brick, brick.velocity) - potential_energy(world_, brick.id, brick.box.place.z));
    state_.rested = true;
    brick.moving = false;
    --moving_;
    move(brick.id, brick.listed_at, brick.box.place);
    ledger_.rested.push_back({brick.id, pose_of(plane_, world_, brick)});
    note_rest(static_cast<int>(i), time);
    brick.velocity = {};
    brick.middle = {};
    rested_now_.push_back(brick);
    for (PlaneTouch& touch : state_.touches) {
      if (touch.b < 0 || (touch.a != static_cast<int>(i) && touch.b != static_cast<int>(i))) continue;
      touch.bearing = touch.impulse > 0.0;
      let_lean(touch, touch.a == static_cast<int>(i));
      touch.mark = state_.brick(touch.a == static_cast<int>(i) ? touch.b : touch.a).box.place;
    }
  }
}

bool PlaneFront::moves(BrickId brick) const {
  const int place = members_.place_of(brick);
  return place >= 0 && state_.brick(place).moving;
}

}  // namespace topple::rigid

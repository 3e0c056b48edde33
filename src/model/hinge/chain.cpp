#include "model/hinge/chain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/trigonometry.h"
#include "model/hinge/root.h"

namespace topple::hinge {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kForever = std::numeric_limits<double>::infinity();

// How high the top front edge of a brick is when it strikes the next [m].
double hit_height(const TrainBrick& brick) {
  const double sine = brick.pitch - brick.thickness_ahead;
  return std::sqrt(1.0 - sine * sine) * brick.height;
}

Event event_at(double time, EventKind kind, BrickId brick, BrickId by) {
  return {time, kind, brick, by, kNone, kNone, {kNone, kNone, kNone}};
}

}  // namespace

void Happenings::clear() {
  events.clear();
  kinks.clear();
  echoes.clear();
  stopped.clear();
  settled = 0.0;
  work = 0.0;
}

Chain::Chain(HingeScene& scene, std::vector<Push> pushes) : scene_(&scene), pushes_(std::move(pushes)) {
  for (std::size_t i = 0; i < pushes_.size(); ++i) {
    changes_.push_back({pushes_[i].at, i, false});
    if (const auto* push = std::get_if<ForcePush>(&pushes_[i].how)) changes_.push_back({pushes_[i].at + push->duration, i, true});
  }
  std::stable_sort(changes_.begin(), changes_.end(), [](const Change& a, const Change& b) { return a.time < b.time; });
}

bool Chain::finite() const { return std::isfinite(state_.angle) && std::isfinite(state_.rate) && std::isfinite(state_.acceleration); }

TrainBrick Chain::make_brick(BrickId id) const {
  const BrickKind& kind = scene_->kind_of(id);
  const double weight = kind.mass * scene_->layout->gravity;
  TrainBrick brick;
  brick.id = id;
  brick.inertia = kind.mass * (kind.height * kind.height + kind.thickness * kind.thickness) / 3.0;
  brick.torque_sin = 0.5 * weight * kind.height;
  brick.torque_cos = -0.5 * weight * kind.thickness;
  brick.height = kind.height;
  brick.thickness = kind.thickness;
  const Link& link = scene_->link_of(id);
  if (link.next != kNoBrick) {
    const Layout& layout = *scene_->layout;
    const BrickKind& ahead = scene_->kind_of(link.next);
    brick.pitch = link.pitch / kind.height;
    brick.thickness_ahead = ahead.thickness / kind.height;
    const auto kind_index = [&layout](BrickId which) { return layout.bricks[static_cast<std::size_t>(which)].kind; };
    brick.friction = surface_pair(layout, kind_index(id), kind_index(link.next)).friction;
    brick.hit_angle = arc_sine(brick.pitch - brick.thickness_ahead);
  }
  return brick;
}

std::size_t Chain::index_of(BrickId id) const {
  std::size_t index = 0;
  while (index < train_.size() && train_.at(index).id != id) ++index;
  return index;
}

// ---- Time ----

void Chain::advance(double until, Happenings& out) {
  while (true) {
    while (next_change_ < changes_.size() && changes_[next_change_].time <= state_.time) apply(changes_[next_change_++], out);
    const double change = next_change_ < changes_.size() ? changes_[next_change_].time : kForever;
    const double horizon = std::min(until, change);
    if (!moving_) {
      state_.time = std::max(state_.time, horizon);
      if (change > until) return;
      continue;
    }
    if (leg_.count == 0) start_leg(out);
    const double end = leg_start_ + leg_.end().time;
    if (!finite() || !std::isfinite(end)) {
      state_.angle = kNone;
      return;
    }
    if (end <= horizon) {
      emit_arrivals(end, out);
      finish_leg(out);
      continue;
    }
    emit_arrivals(horizon, out);
    now_ = horizon;
    if (change > until && acting_ == 0) return;
    state_ = now();
    view_ = train_.place(state_.angle, direction_);
    state_.acceleration = view_.acceleration(state_.rate);
    add_work(out);
    if (change > until) return;
    leg_.count = 0;
  }
}

FrontState Chain::now() const {
  if (leg_.count == 0) return state_;
  FrontState state = leg_.at_time(now_ - leg_start_);
  state.time = now_;
  return state;
}

LegGoal Chain::leg_goal() const { return {goal_angle_, direction_, scene_->slow_step, 0.1 * scene_->rest_tolerance, view_}; }

void Chain::start_leg(Happenings& out) {
  leg_start_ = now_ = state_.time;
  if (repeat_.on && next_is_alike()) {
    leg_.count = Leg::kMostNodes;
    next_arrival_ = 0;
    return;
  }
  end_repeat(out);
  ++repeat_.legs;
  choose_goal();
  FrontState start = state_;
  start.time = 0.0;
  leg_ = make_leg(train_, start, leg_goal());
  if (leg_.turns_over) {
    find_turn_over(state_.angle);
    if (goal_ == Goal::turn_over) leg_ = make_leg(train_, start, leg_goal());
  }
  find_arrivals();
}

double Chain::lean_angle(BrickId id, BrickId next) const {
  const TrainBrick brick = make_brick(id);
  double angle = static_cast<double>(scene_->angle_of(next));
  if (scene_->angle_of(next) == HingeScene::kInTrain) angle = train_.at(std::min(index_of(next), train_.size() - 1)).angle;
  const auto [s, c] = sin_cos(angle);
  const double edge = brick.pitch * c - brick.thickness_ahead;
  if (edge >= 0.0) return angle + arc_sine(std::min(edge, 1.0));
  const double along = brick.pitch - brick.thickness_ahead * c;
  const double up = brick.thickness_ahead * s;
  return along * along + up * up < 1.0 ? arc_tangent(along, up) : 0.5 * kPi;
}

void Chain::choose_goal() {
  if (direction_ < 0.0) {
    goal_ = Goal::upright;
    goal_angle_ = 0.0;
  } else {
    const BrickId next = scene_->link_of(front()).next;
    if (next == kNoBrick) {
      goal_ = Goal::floor;
      goal_angle_ = 0.5 * kPi;
    } else if (scene_->angle_of(next) == 0.0F) {
      goal_ = Goal::hit;
      goal_angle_ = train_.at(0).hit_angle;
    } else {
      goal_ = Goal::lean;
      goal_angle_ = lean_angle(front(), next);
    }
  }
}

void Chain::find_arrivals() {
  arrivals_.clear();
  next_arrival_ = 0;
  if (direction_ < 0.0) return;
  const double start = leg_.nodes[0].angle;
  const double end = leg_.end().angle;
  for (std::size_t k = 0; k < train_.size() && !train_.at(k).arrived; ++k) {
    const double at_end = train_.angle_of(k, end) - kArrivalTilt;
    if (at_end < 0.0) continue;
    const double at_start = train_.angle_of(k, start) - kArrivalTilt;
    double angle = start;
    if (k == 0) {
      angle = kArrivalTilt;
    } else if (at_start < 0.0) {
      angle = root(start, end, at_start, at_end, [&](double x) { return train_.angle_of(k, x) - kArrivalTilt; });
    }
    arrivals_.push_back({leg_.time_of(std::clamp(angle, start, end)), k});
  }
  std::reverse(arrivals_.begin(), arrivals_.end());  // Those further back tilt more, so they come first.
}

void Chain::emit_arrivals(double until, Happenings& out) {
  for (; next_arrival_ < arrivals_.size() && leg_start_ + arrivals_[next_arrival_].time <= until; ++next_arrival_) {
    const Arrival& arrival = arrivals_[next_arrival_];
    out.events.push_back(event_at(leg_start_ + arrival.time, EventKind::arrived, train_.at(arrival.place).id, kNoBrick));
    train_.at(arrival.place).arrived = true;
  }
}

// ---- Events ----

void Chain::finish_leg(Happenings& out) {
  if (repeat_.on) return repeat_hit(out);
  repeat_.kinks = out.kinks.size();
  const bool reached = leg_.reached;
  const bool touches = leg_.touches || !leg_.swept || direction_ < 0.0 || goal_ == Goal::turn_over;
  const bool stuck = leg_.end().time <= 0.0;  // Friction jams it: it would not move whichever way it went.
  state_ = leg_.end();
  state_.time += leg_start_;
  if (leg_.swept) {
    train_.place_at_goal(state_.angle);
    view_ = leg_.goal_view;
  } else {
    view_ = train_.place(state_.angle, direction_);
  }
  add_work(out);
  end_curves(out);
  leg_.count = 0;
  if (!reached) {
    if (direction_ * state_.rate > 0.0) return add_points(out);
    state_.rate = 0.0;
    begin_motion();
    if (!moving_ || stuck) return rest_from_before(false, kNoBrick, out);
    restart(0.0);
    return add_kinks(out);
  }
  if (touches) turn_over(out);
  if (!moving_) return;
  switch (goal_) {
    case Goal::hit:
      return hit(out);
    case Goal::lean:
      return rest_from_before(true, scene_->link_of(front()).next, out);
    case Goal::floor:
      return rest_from_before(true, kNoBrick, out);
    case Goal::upright:
      return stand_up(out);
    case Goal::turn_over:
      return;
  }
}

// The front goes on from where it is, at another rate.
void Chain::restart(double rate) {
  state_.rate = rate;
  view_ = train_.place(state_.angle, direction_);
  state_.acceleration = view_.acceleration(rate);
}

// The whole train strikes the next brick, which stands: simultaneous, perfectly inelastic [vanLeeuwen2010] eq. 30.
void Chain::hit(Happenings& out) {
  const BrickId by = front();
  const BrickId id = scene_->link_of(by).next;
  train_.at(0).on_heel = false;
  const FrontView view = train_.strike(make_brick(id), view_);
  // What the train had about the struck brick stays: the gain of the new lean x what it had about the one that strikes.
  const double momentum = (view.inertia - train_.at(0).inertia) * state_.rate;
  const double rate = view.inertia > 0.0 && momentum > 0.0 ? momentum / view.inertia : 0.0;
  state_.angle = 0.0;

  const TrainBrick& behind = train_.at(1);
  const double arm = hit_height(behind) - behind.friction * behind.thickness_ahead * behind.height;
  repeat_.impulse = rate > 0.0 ? train_.at(0).inertia * rate / arm : kNone;
  add_strike(id, by, repeat_.impulse, out);

  // A hit that lifts it less than a resting brick may still move is the last.
  const double lift = 0.5 * view.inertia * rate * rate;
  const double tolerance = scene_->rest_tolerance * train_.at(0).thickness / train_.at(0).height;
  if (rate == 0.0 || lift < -view.torque * tolerance) {
    train_.drop_front();
    state_.angle = train_.at(0).angle;
    state_.rate = 0.0;
    view_ = train_.place(state_.angle, 1.0);
    return rest_from_before(true, id, out);
  }
  scene_->angle_of(id) = HingeScene::kInTrain;
  state_.rate = rate;
  state_.acceleration = view.acceleration(rate);
  view_ = view;
  add_kinks(out, retire(out));
  look_for_repeat(out);
}

void Chain::add_strike(BrickId id, BrickId by, double impulse, Happenings& out) {
  const TrainBrick& behind = train_.at(1);
  const Brick& brick = scene_->layout->bricks[static_cast<std::size_t>(id)];
  if (brick.heading != scene_->last_heading) {
    scene_->last_heading = brick.heading;
    scene_->last_turn = sin_cos(brick.heading);
  }
  const SinCos heading = scene_->last_turn;
  const double back = 0.5 * scene_->kind_of(id).thickness;
  Event struck = event_at(state_.time, EventKind::struck, id, by);
  struck.impulse = impulse;
  struck.point = brick.foot + Vec3{-back * heading.cos, -back * heading.sin, hit_height(behind)};
  out.events.push_back(struck);
}

// Bricks at the back go to rest once what they can still turn is within the tolerance. Says how many.
std::size_t Chain::retire(Happenings& out) {
  std::size_t count = 0;
  while (train_.size() > 2) {
    const TrainBrick& last = train_.at(train_.size() - 1);
    if (train_.last_travel(state_.angle) * last.height > scene_->rest_tolerance * last.thickness) break;
    const BrickId ahead = train_.at(train_.size() - 2).id;
    out.tell({last.id, state_.time, before_[count++], {last.angle, 0.0, 0.0}});
    repeat_.rested = train_.drop_last(1.0);
    settle(repeat_.rested, ahead, true, out);
  }
  return count;
}

// The front has returned and stands; the bricks behind it go on without it.
void Chain::stand_up(Happenings& out) {
  TrainBrick front = train_.at(0);
  front.angle = 0.0;
  out.tell({front.id, state_.time, before_.back(), {}});
  settle(front, kNoBrick, false, out);
  const double rate = train_.size() > 1 ? train_.at(1).ratio * state_.rate : 0.0;
  train_.drop_front();
  if (train_.empty()) {
    moving_ = false;
    return train_.clear();
  }
  state_.angle = train_.at(0).angle;
  state_.rate = rate;
  if (rate == 0.0) begin_motion();
  restart(rate);
  before_.pop_back();
  add_kinks(out);
  if (!moving_) rest_all(true, front.id, out);
}

void Chain::settle(const TrainBrick& brick, BrickId by, bool landed, Happenings& out) {
  const SinCos turned = sin_cos(brick.angle);
  settle_with(potential(brick, turned.sin, turned.cos), brick, by, landed, out);
}

void Chain::settle_with(double energy, const TrainBrick& brick, BrickId by, bool landed, Happenings& out) {
  if (landed) out.events.push_back(event_at(state_.time, EventKind::landed, brick.id, by));
  out.events.push_back(event_at(state_.time, EventKind::rested, brick.id, kNoBrick));
  out.stopped.push_back({brick.id, brick.angle == 0.0 ? Phase::standing : Phase::resting, {brick.angle, 0.0, 0.0}});
  out.settled += energy;
  scene_->angle_of(brick.id) = static_cast<float>(brick.angle);
}

void Chain::rest_all(bool front_landed, BrickId by, Happenings& out) {
  remember_states();
  rest_from_before(front_landed, by, out);
}

// Where before_ says how all moved until now.
void Chain::rest_from_before(bool front_landed, BrickId by, Happenings& out) {
  state_.rate = 0.0;
  state_.acceleration = 0.0;
  moving_ = false;
  add_kinks(out);
  for (std::size_t k = train_.size(); k-- > 0;) {
    const bool is_front = k == 0;
    if (is_front && front_landed && by == kNoBrick && missed_next(front())) {
      out.events.push_back(event_at(state_.time, EventKind::missed, front(), kNoBrick));
    }
    settle(train_.at(k), is_front ? by : train_.at(k - 1).id, !is_front || front_landed, out);
  }
}

// Whether its part goes on after a brick that falls flat.
bool Chain::missed_next(BrickId id) const {
  for (const Part& part : scene_->layout->parts) {
    if (id >= part.first && id < part.first + part.count) return id + 1 < part.first + part.count;
  }
  return false;
}

void Chain::read(std::vector<HingedMotion>& out) const {
  if (!moving_) return;
  const FrontState front = now();
  std::vector<TrainView> bricks;
  const double acceleration = train_.look(front.angle, direction_, bricks).acceleration(front.rate);
  for (std::size_t k = bricks.size(); k-- > 0;) {
    const TrainView& brick = bricks[k];
    out.push_back({brick.id,
                   Phase::falling,
                   {brick.angle, brick.ratio * front.rate, brick.ratio * acceleration + brick.curvature * front.rate * front.rate}});
  }
}

double Chain::potential(const TrainBrick& brick, double s, double c) const {
  const BrickKind& kind = scene_->kind_of(brick.id);
  return 0.5 * kind.mass * scene_->layout->gravity * (kind.height * (c - 1.0) + kind.thickness * s);
}

double Chain::kinetic() const {
  double energy = 0.0;
  for (std::size_t k = 0; k < train_.size(); ++k) {
    const double rate = train_.at(k).ratio * state_.rate;
    energy += 0.5 * train_.at(k).inertia * rate * rate;
  }
  return energy;
}

Energy Chain::energy() const {
  Energy energy;
  if (!moving_) return energy;
  const FrontState front = now();
  const Train::Works works = train_.works(front.angle);
  energy.kinetic = 0.5 * works.motion * front.rate * front.rate;
  energy.potential = -works.torques;
  if (acting_ != 0 && index_of(forced_) < train_.size()) energy.potential += force_work(train_.angle_of(index_of(forced_), front.angle));
  return energy;
}

}  // namespace topple::hinge

#include "model/hinge/chain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/trigonometry.h"
#include "model/hinge/lean.h"

namespace topple::hinge {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kForever = std::numeric_limits<double>::infinity();

// A lean turns over once its edge is this close to the end of its way; a pure number, far above rounding.
constexpr double kTurnOver = 1e-9;

// Where f(x) = 0 between low and high, f(low) > 0 > f(high) or the other way round, by regula falsi with Illinois' halving.
template <typename Function>
double root(double low, double high, double at_low, double at_high, Function f) {
  double x = high;
  for (int round = 0; round < 50; ++round) {
    x = high - at_high * (high - low) / (at_high - at_low);
    const double at_x = f(x);
    if (std::fabs(at_x) < 1e-13) break;
    if ((at_x > 0.0) != (at_high > 0.0)) {
      low = high;
      at_low = at_high;
    } else {
      at_low *= 0.5;
    }
    high = x;
    at_high = at_x;
  }
  return x;
}

// A point of the upright brick, `ahead` of its foot along its heading and `up` [m].
Vec3 point_of(const HingeScene& scene, BrickId id, double ahead, double up) {
  const Brick& brick = scene.layout->bricks[static_cast<std::size_t>(id)];
  const SinCos heading = sin_cos(brick.heading);
  return brick.foot + Vec3{ahead * heading.cos, ahead * heading.sin, up};
}

Event event_at(double time, EventKind kind, BrickId brick, BrickId by) {
  return {time, kind, brick, by, kNone, kNone, {kNone, kNone, kNone}};
}

}  // namespace

void Happenings::clear() {
  events.clear();
  kinks.clear();
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
    if (leg_.count == 0) start_leg();
    if (!finite() || !std::isfinite(leg_.end().time)) {
      state_.angle = kNone;
      return;
    }
    if (leg_.end().time <= horizon) {
      emit_arrivals(leg_.end().time, out);
      finish_leg(out);
      continue;
    }
    emit_arrivals(horizon, out);
    state_ = leg_.at_time(horizon);
    view_ = train_.place(state_.angle, direction_);
    state_.acceleration = view_.acceleration(state_.rate);
    add_work(out);
    if (change > until) return;
    leg_.count = 0;
  }
}

LegGoal Chain::leg_goal() const { return {goal_angle_, direction_, scene_->slow_step, 0.1 * scene_->rest_tolerance, view_}; }

void Chain::start_leg() {
  choose_goal();
  leg_ = make_leg(train_, state_, leg_goal());
  if (leg_.turns_over) {
    find_turn_over(state_.angle);
    if (goal_ == Goal::turn_over) leg_ = make_leg(train_, state_, leg_goal());
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

// Whether a lean turns over before the goal; if so, that is where the leg ends.
void Chain::find_turn_over(double from) {
  rates_.resize(train_.size());
  train_.edges(goal_angle_, rates_);
  for (std::size_t k = 1; k < train_.size(); ++k) {
    const TrainBrick& brick = train_.at(k);
    if (brick.on_heel == (direction_ > 0.0)) continue;
    // One that goes past it by less than what a resting brick may still move is turned over at the end of the leg.
    const double slack = 0.1 * scene_->rest_tolerance * brick.thickness_ahead;
    if (direction_ * rates_[k] >= -slack) continue;
    std::vector<double>& edges = edges_;
    edges.resize(k + 1);
    const auto edge = [&](double angle) {
      train_.edges(angle, edges);
      return edges[k];
    };
    const double at_from = edge(from);
    if (direction_ * at_from <= 0.0) continue;
    goal_angle_ = root(from, goal_angle_, at_from, edge(goal_angle_), edge);
    goal_ = Goal::turn_over;
    train_.edges(goal_angle_, rates_);
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
    arrivals_.push_back({leg_.time_of(std::clamp(angle, start, end)), train_.at(k).id});
  }
  std::reverse(arrivals_.begin(), arrivals_.end());  // Those further back tilt more, so they come first.
}

void Chain::emit_arrivals(double until, Happenings& out) {
  for (; next_arrival_ < arrivals_.size() && arrivals_[next_arrival_].time <= until; ++next_arrival_) {
    const Arrival& arrival = arrivals_[next_arrival_];
    out.events.push_back(event_at(arrival.time, EventKind::arrived, arrival.brick, kNoBrick));
    train_.at(index_of(arrival.brick)).arrived = true;
  }
}

// ---- Events ----

void Chain::finish_leg(Happenings& out) {
  const bool reached = leg_.reached;
  const bool touches = leg_.touches || !leg_.swept || direction_ < 0.0 || goal_ == Goal::turn_over;
  const bool stuck = leg_.end().time <= leg_.nodes[0].time;  // Friction jams it: it would not move whichever way it went.
  state_ = leg_.end();
  leg_.count = 0;
  if (leg_.swept) {
    train_.place_at_goal(state_.angle);
    view_ = leg_.goal_view;
  } else {
    view_ = train_.place(state_.angle, direction_);
  }
  add_work(out);
  if (!reached) {
    if (direction_ * state_.rate > 0.0) return;
    state_.rate = 0.0;
    begin_motion();
    if (!moving_ || stuck) return rest_all(false, kNoBrick, out);
    return restart(0.0);
  }
  if (touches) turn_over(out);
  if (!moving_) return;
  switch (goal_) {
    case Goal::hit:
      return hit(out);
    case Goal::lean:
      return rest_all(true, scene_->link_of(front()).next, out);
    case Goal::floor:
      return rest_all(true, kNoBrick, out);
    case Goal::upright:
      return stand_up(out);
    case Goal::turn_over:
      return;
  }
}

void Chain::remember_states() {
  before_.clear();
  for (std::size_t k = train_.size(); k-- > 0;) before_.push_back(state_of(train_.at(k)));
}

// The front goes on from where it is, at another rate.
void Chain::restart(double rate) {
  state_.rate = rate;
  view_ = train_.place(state_.angle, direction_);
  state_.acceleration = view_.acceleration(rate);
}

// A jump that is not told makes the motion between two steps, as the Hermite polynomial sees it, wrong by at most about a tenth of
// jump x step. So those are told that would make it a tenth of what a resting brick may still move, or more.
void Chain::add_kinks(Happenings& out) {
  const double step = scene_->time_step;
  for (std::size_t i = 0; i < train_.size(); ++i) {
    const TrainBrick& brick = train_.at(train_.size() - 1 - i);
    const HingedState before = i < before_.size() ? before_[i] : HingedState{};
    const HingedState after = state_of(brick);
    const double jump =
        std::fabs(after.rate - before.rate) * step + 0.5 * std::fabs(after.acceleration - before.acceleration) * step * step;
    if (jump * brick.height > scene_->rest_tolerance * brick.thickness) out.kinks.push_back({brick.id, state_.time, before, after});
  }
}

// The front faces of bricks that come to lie flush with the rear faces ahead stop at their heels: an inelastic hit.
void Chain::turn_over(Happenings& out) {
  rates_.resize(train_.size());
  train_.edges(state_.angle, rates_);
  bool any = false;
  for (std::size_t k = 1; k < train_.size(); ++k) {
    if (train_.at(k).on_heel == (direction_ > 0.0) || direction_ * rates_[k] > kTurnOver) continue;
    if (!any) remember_states();
    any = true;
    train_.at(k).on_heel = direction_ > 0.0;
  }
  if (!any) return;
  for (std::size_t k = 0; k < train_.size(); ++k) rates_[k] = before_[train_.size() - 1 - k].rate;
  const double inertia = train_.place(state_.angle, direction_).inertia;
  const double rate = train_.front_momentum(rates_, direction_) / inertia;
  restart(direction_ * rate > 0.0 ? rate : 0.0);
  add_kinks(out);
  if (state_.rate == 0.0) {
    begin_motion();
    if (!moving_) return rest_all(false, kNoBrick, out);
    restart(0.0);
  }
  if (direction_ > 0.0) retire(out);
}

// The whole train strikes the next brick, which stands: simultaneous, perfectly inelastic [vanLeeuwen2010] eq. 30.
void Chain::hit(Happenings& out) {
  const BrickId by = front();
  const BrickId id = scene_->link_of(by).next;
  remember_states();
  train_.at(0).on_heel = false;
  const FrontView view = train_.strike(make_brick(id), view_);
  // What the train had about the struck brick stays: the gain of the new lean x what it had about the one that strikes.
  const double momentum = (view.inertia - train_.at(0).inertia) * state_.rate;
  const double rate = view.inertia > 0.0 && momentum > 0.0 ? momentum / view.inertia : 0.0;
  state_.angle = 0.0;

  const TrainBrick& behind = train_.at(1);
  const double sine = behind.pitch - behind.thickness_ahead;
  const double up = std::sqrt(1.0 - sine * sine) * behind.height;
  const double arm = up - behind.friction * behind.thickness_ahead * behind.height;
  Event struck = event_at(state_.time, EventKind::struck, id, by);
  struck.impulse = rate > 0.0 ? train_.at(0).inertia * rate / arm : kNone;
  struck.point = point_of(*scene_, id, -0.5 * scene_->kind_of(id).thickness, up);
  out.events.push_back(struck);

  // A hit that lifts it less than a resting brick may still move is the last.
  const double lift = 0.5 * view.inertia * rate * rate;
  const double tolerance = scene_->rest_tolerance * train_.at(0).thickness / train_.at(0).height;
  if (rate == 0.0 || lift < -view.torque * tolerance) {
    train_.drop_front();
    state_.angle = train_.at(0).angle;
    state_.rate = 0.0;
    view_ = train_.place(state_.angle, 1.0);
    return rest_all(true, id, out);
  }
  scene_->angle_of(id) = HingeScene::kInTrain;
  state_.rate = rate;
  state_.acceleration = view.acceleration(rate);
  view_ = view;
  add_kinks(out);
  retire(out);
}

// Bricks at the back go to rest once what they can still turn is within the tolerance.
void Chain::retire(Happenings& out) {
  while (train_.size() > 2) {
    const TrainBrick& last = train_.at(train_.size() - 1);
    if (train_.last_travel(state_.angle) * last.height > scene_->rest_tolerance * last.thickness) return;
    const BrickId ahead = train_.at(train_.size() - 2).id;
    settle(train_.drop_last(1.0), ahead, true, out);
  }
}

// The front has returned and stands; the bricks behind it go on without it.
void Chain::stand_up(Happenings& out) {
  remember_states();
  TrainBrick front = train_.at(0);
  front.angle = 0.0;
  out.kinks.push_back({front.id, state_.time, before_.back(), {}});
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
  if (landed) out.events.push_back(event_at(state_.time, EventKind::landed, brick.id, by));
  out.events.push_back(event_at(state_.time, EventKind::rested, brick.id, kNoBrick));
  out.stopped.push_back({brick.id, brick.angle == 0.0 ? Phase::standing : Phase::resting, {brick.angle, 0.0, 0.0}});
  const SinCos turned = sin_cos(brick.angle);
  out.settled += potential(brick, turned.sin, turned.cos);
  scene_->angle_of(brick.id) = static_cast<float>(brick.angle);
}

void Chain::rest_all(bool front_landed, BrickId by, Happenings& out) {
  remember_states();
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
  for (std::size_t k = train_.size(); k-- > 0;) out.push_back({train_.at(k).id, Phase::falling, state_of(train_.at(k))});
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
  for (std::size_t k = 0; k < train_.size(); ++k) {
    const TrainBrick& brick = train_.at(k);
    energy.potential += potential(brick, brick.sine, brick.cosine);
  }
  energy.kinetic = kinetic();
  return energy;
}

}  // namespace topple::hinge

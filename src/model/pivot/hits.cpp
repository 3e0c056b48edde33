// Pushes and hits of the pivot model: what sets a brick in motion.
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "model/pivot/pivot_model.h"

namespace topple::pivot {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Bricks ahead whose contact angles differ by less are struck at once and share what is handed on [rad].
constexpr double kSameContact = 1e-9;

}  // namespace

void PivotModel::start_pushes() {
  while (next_push_ < pushes_.size() && layout_.pushes[pushes_[next_push_]].at < end_) {
    const std::size_t index = pushes_[next_push_++];
    const Push& p = layout_.pushes[index];
    push(p.brick, index, p.at);
  }
}

void PivotModel::push(BrickId brick, std::size_t index, double time) {
  Moving& moving = wake_or_find(brick, time);
  if (moving.fall.time < time) moving.fall = advance(moving.turning, moving.fall, time, config_.integrator);
  const HingedState before{moving.fall.theta, moving.fall.omega, moving.acceleration};
  moving.first_push = static_cast<std::int32_t>(index);
  const double inertia = moving.body->inertia;
  double force = kNone;
  double impulse = kNone;
  double height = kNone;
  const auto& how = layout_.pushes[index].how;
  if (const auto* speed = std::get_if<AngularSpeedPush>(&how)) {
    moving.fall.omega = speed->angular_speed;
  } else if (const auto* steady = std::get_if<ForcePush>(&how)) {
    force = steady->force;
    height = steady->height;
    moving.turning.push = force * height / inertia;  // [Arnesson2020] (2.1)
    moving.turning.push_until = time + steady->duration;
    moving.report_torque = force * height;
  } else if (const auto* blow = std::get_if<ImpulsePush>(&how)) {
    impulse = blow->impulse;
    height = blow->height;
    moving.fall.omega += impulse * height / inertia;
  }
  push_work_ += 0.5 * inertia * (moving.fall.omega * moving.fall.omega - before.rate * before.rate);
  moving.acceleration = moving.turning.acceleration(moving.fall.turned, time);
  kink(moving, time, before, {moving.fall.theta, moving.fall.omega, moving.acceleration});
  const Vec3& foot = layout_.bricks[static_cast<std::size_t>(brick)].foot;
  const Vec3 point = std::isnan(height) ? Vec3{kNone, kNone, kNone} : foot + Vec3{0.0, 0.0, height};
  events_.push_back({time, EventKind::pushed, brick, kNoBrick, force, impulse, point});
}

void PivotModel::hand_on_hits() {
  hits_.clear();
  find_watched();
  for (const std::int32_t slot : watched_) {
    if (moving_[slot].may_hit) find_hit(moving_[slot]);
  }
  // In the order of their times; a struck brick may itself strike before the step is over.
  while (!hits_.empty()) {
    const auto first = std::min_element(hits_.begin(), hits_.end(), [](const Hit& a, const Hit& b) {
      return a.time < b.time || (a.time == b.time && a.struck < b.struck);
    });
    const Hit hit = *first;
    hits_.erase(first);
    hand_on(hit);
  }
}

void PivotModel::find_hit(Moving& hitter) {
  Hit hit{.time = std::numeric_limits<double>::infinity(), .hitter = hitter.brick};
  hitter.may_hit = false;
  for (const Pair& pair : hitter.ahead) {
    const MovingSet::Still& ahead = moving_.still(pair.ahead());
    if (ahead.struck || ahead.tilt > 0.0F) continue;
    hitter.may_hit = true;
    if (moving_.find(pair.ahead()) != nullptr) continue;
    const double time = time_of_passing(hitter.turning, hitter.fall, end_, pair.contact_angle(), config_.integrator);
    if (time < hit.time) hit = {.time = time, .hitter = hitter.brick, .struck = pair.ahead()};
  }
  if (hit.time <= end_) hits_.push_back(hit);
}

double PivotModel::report_force(const Moving& hitter, double time) const {
  // [Arnesson2020] (2.5): F = I alpha / H, with alpha by (2.3). A force that still acts counts with its arm on a pushed brick, and with
  // the full height on a struck one, as (2.5) is printed, so that along a row it grows by the same amount at each brick.
  const double gravity = hitter.body->inertia * hitter.turning.acceleration(hitter.fall.turned, hitter.turning.push_until);
  const double torque = time < hitter.turning.push_until ? hitter.report_torque : 0.0;
  return (torque + gravity) / hitter.body->size.up;
}

void PivotModel::hand_on(const Hit& hit) {
  Moving& hitter = *moving_.find(hit.hitter);
  hitter.fall = advance(hitter.turning, hitter.fall, hit.time, config_.integrator);
  std::vector<Pair> struck;
  double struck_inertia = 0.0;
  double contact_angle = 0.0;
  for (const Pair& pair : hitter.ahead) {
    if (pair.ahead() == hit.struck) contact_angle = pair.contact_angle();
  }
  for (const Pair& pair : hitter.ahead) {
    const MovingSet::Still& ahead = moving_.still(pair.ahead());
    if (ahead.struck || ahead.tilt > 0.0F || moving_.find(pair.ahead()) != nullptr) continue;
    if (std::fabs(pair.contact_angle() - contact_angle) > kSameContact) continue;
    struck.push_back(pair);
    struck_inertia += moving_.body_of(pair.ahead()).inertia;
  }
  hitter.fall = fall_at(hit.time, contact_angle, hitter.fall.omega);
  const double restitution = surface_pair(layout_, layout_.bricks[static_cast<std::size_t>(hit.hitter)].kind,
                                          layout_.bricks[static_cast<std::size_t>(hit.struck)].kind)
                                 .restitution;
  // For one brick of the same kind this is (1 + e) / 2 of the hitter's angular velocity.
  const double omega = (1.0 + restitution) * hitter.body->inertia / (hitter.body->inertia + struck_inertia) * hitter.fall.omega;
  const double force = report_force(hitter, hit.time) / static_cast<double>(struck.size());
  const HingedState before{contact_angle, hitter.fall.omega, hitter.turning.acceleration(hitter.fall.turned, hit.time)};
  hitter.fall.omega = 0.0;  // From now on gravity alone moves it.
  hitter.turning.push_until = hit.time;
  hitter.acceleration = hitter.turning.acceleration(hitter.fall.turned, hit.time);
  kink(hitter, hit.time, before, {contact_angle, 0.0, hitter.acceleration});
  for (const Pair& pair : struck) strike({hit.time, hit.hitter, pair.ahead()}, pair, omega, force);
}

void PivotModel::strike(const Hit& hit, const Pair& pair, double omega, double force) {
  moving_.still(hit.struck).struck = true;
  const std::int32_t first_push = moving_.find(hit.hitter)->first_push;
  const double arm = pair.contact_height();
  Event event{.time = hit.time, .kind = EventKind::struck, .brick = hit.struck, .by = hit.hitter, .force = kNone, .impulse = kNone};
  const Brick& brick = layout_.bricks[static_cast<std::size_t>(hit.struck)];
  const Vec3 rear = rotate(standing_pose(layout_, hit.struck).orientation, {-0.5, 0.0, 0.0});
  if (config_.hit == HitRule::same) {
    push(hit.struck, static_cast<std::size_t>(first_push), hit.time);
    event.force = events_.back().force;
    event.impulse = events_.back().impulse;
    events_.pop_back();  // It was struck, not pushed.
  } else {
    Moving& moving = wake_or_find(hit.struck, hit.time);
    moving.first_push = first_push;
    if (config_.hit == HitRule::momentum) {
      moving.fall.omega = omega;
      event.impulse = moving.body->inertia * omega / arm;
    } else {
      moving.turning.push = std::fmax(force, 0.0) * arm / moving.body->inertia;
      moving.turning.push_until = hit.time + config_.pulse;
      moving.report_torque = force * moving.body->size.up;
      event.force = force;
      event.impulse = force * config_.pulse;
    }
    moving.acceleration = moving.turning.acceleration(moving.fall.turned, hit.time);
    kink(moving, hit.time, {}, {0.0, moving.fall.omega, moving.acceleration});
  }
  Moving& moving = *moving_.find(hit.struck);
  const double thickness = moving.body->size.along;
  event.point = brick.foot + static_cast<double>(moving.side) * thickness * rear + Vec3{0.0, 0.0, arm};
  events_.push_back(event);
  find_hit(moving);
}

}  // namespace topple::pivot

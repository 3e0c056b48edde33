// How pushes set a chain in motion.
#include <limits>

#include "base/trigonometry.h"
#include "model/hinge/chain.h"

namespace topple::hinge {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void Chain::apply(const Change& change, Happenings& out) {
  end_repeat(out);
  const Push& push = pushes_[change.push];
  if (!change.ends) {
    Event pushed{state_.time, EventKind::pushed, push.brick, kNoBrick, kNone, kNone, {kNone, kNone, kNone}};
    double height = kNone;
    if (const auto* force = std::get_if<ForcePush>(&push.how)) {
      pushed.force = force->force;
      height = force->height;
    } else if (const auto* blow = std::get_if<ImpulsePush>(&push.how)) {
      pushed.impulse = blow->impulse;
      height = blow->height;
    }
    if (height == height) {
      const Brick& brick = scene_->layout->bricks[static_cast<std::size_t>(push.brick)];
      const SinCos heading = sin_cos(brick.heading);
      const double back = 0.5 * scene_->kind_of(push.brick).thickness;
      pushed.point = brick.foot + Vec3{-back * heading.cos, -back * heading.sin, height};
    }
    out.events.push_back(pushed);
  }
  if (train_.empty() && !join_standing(push.brick)) return;
  if (index_of(push.brick) == train_.size()) return;  // It rests; the bricks on which it leans hold it.
  wake(out);
  train_.place(state_.angle, direction_);
  if (std::holds_alternative<ForcePush>(push.how)) {
    apply_force(push, change.ends ? -1.0 : 1.0, out);
  } else {
    apply_blow(push, out);
  }
  begin_motion();
  if (moving_) {
    restart(state_.rate);
    add_kinks(out);
  } else if (train_.size() == 1 && state_.angle == 0.0) {
    if (force_ == 0.0) {
      scene_->angle_of(push.brick) = 0.0F;
      train_.clear();
    }
  } else {
    rest_all(false, kNoBrick, out);
  }
}

// A train that came to rest moves again, or may: its energy is no longer that of resting bricks.
void Chain::wake(Happenings& out) {
  remember_states();
  if (moving_ || (train_.size() == 1 && state_.angle == 0.0)) return;
  for (std::size_t k = 0; k < train_.size(); ++k) {
    const SinCos turned = sin_cos(train_.at(k).angle);
    out.settled -= potential(train_.at(k), turned.sin, turned.cos);
    scene_->angle_of(train_.at(k).id) = HingeScene::kInTrain;
  }
}

bool Chain::join_standing(BrickId id) {
  if (scene_->angle_of(id) != 0.0F) return false;
  train_.add_front(make_brick(id));
  scene_->angle_of(id) = HingeScene::kInTrain;
  state_.angle = 0.0;
  state_.rate = 0.0;
  state_.acceleration = 0.0;
  direction_ = 1.0;
  return true;
}

void Chain::apply_force(const Push& push, double sign, Happenings& out) {
  const ForcePush& force = std::get<ForcePush>(push.how);
  TrainBrick& brick = train_.at(index_of(push.brick));
  add_work(out);
  // F (height cos + thickness sin) beside the weight's torque.
  brick.torque_sin += sign * force.force * brick.thickness;
  brick.torque_cos += sign * force.force * force.height;
  acting_ = sign > 0.0 ? acting_ + 1 : acting_ - 1;
  if (acting_ == 0) {
    const TrainBrick plain = make_brick(brick.id);
    brick.torque_sin = plain.torque_sin;
    brick.torque_cos = plain.torque_cos;
  }
  force_ = acting_ == 0 ? 0.0 : force_ + sign * force.force;
  force_moment_ = acting_ == 0 ? 0.0 : force_moment_ + sign * force.force * force.height;
  worked_to_ = brick.angle;
  forced_ = push.brick;
}

// The work of the forces since the last call.
void Chain::add_work(Happenings& out) {
  if (acting_ == 0) return;
  const std::size_t index = index_of(forced_);
  if (index == train_.size()) return;
  const TrainBrick& brick = train_.at(index);
  out.work += force_work(brick.angle) - force_work(worked_to_);
  worked_to_ = brick.angle;
}

// Of the forces that act, on their brick from upright to an angle [J].
double Chain::force_work(double angle) const {
  const auto [s, c] = sin_cos(angle);
  return force_moment_ * s + force_ * scene_->kind_of(forced_).thickness * (1.0 - c);
}

void Chain::apply_blow(const Push& push, Happenings& out) {
  const TrainBrick& brick = train_.at(index_of(push.brick));
  const double before = kinetic();
  double rate = state_.rate;
  if (const auto* speed = std::get_if<AngularSpeedPush>(&push.how)) {
    if (brick.ratio > 0.0) rate = speed->angular_speed / brick.ratio;
  } else {
    const ImpulsePush& blow = std::get<ImpulsePush>(push.how);
    const auto [s, c] = sin_cos(brick.angle);
    rates_.assign(train_.size(), 0.0);
    rates_[index_of(push.brick)] = blow.impulse * (blow.height * c + brick.thickness * s) / brick.inertia;
    rate += train_.front_momentum(rates_, direction_) / train_.view(state_.angle, direction_).inertia;
  }
  state_.rate = rate;
  out.work += kinetic() - before;
}

// Which way a train goes from here, or whether friction and weight hold it.
void Chain::begin_motion() {
  if (state_.rate != 0.0) {
    direction_ = state_.rate > 0.0 ? 1.0 : -1.0;
    moving_ = true;
    return;
  }
  const FrontView forward = train_.view(state_.angle, 1.0);
  const FrontView backward = train_.view(state_.angle, -1.0);
  const bool falls = forward.torque > 0.0 && forward.inertia > 0.0;
  direction_ = falls ? 1.0 : -1.0;
  moving_ = falls || (state_.angle > 0.0 && backward.torque < 0.0 && backward.inertia > 0.0);
}

}  // namespace topple::hinge

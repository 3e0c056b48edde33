#include "model/rigid/run_units.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/trigonometry.h"

namespace topple::rigid {

namespace {

// Forty bits of the mantissa.
double rounded(double value) {
  constexpr std::uint64_t kLeft = 0xfff;
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(value) + (kLeft + 1) / 2) & ~kLeft);
}

double longest(const BrickKind& kind) { return std::max({kind.height, kind.width, kind.thickness}); }

// The brick that is pushed first, else the first one.
BrickId begins_with(const Layout& layout) {
  const auto first = std::min_element(layout.pushes.begin(), layout.pushes.end(), [](const Push& l, const Push& r) { return l.at < r.at; });
  return first == layout.pushes.end() ? 0 : first->brick;
}

}  // namespace

RunUnits::RunUnits(const Layout& layout) {
  length_ = std::numeric_limits<double>::infinity();
  for (const BrickKind& kind : layout.kinds) {
    if (longest(kind) >= length_) continue;
    length_ = longest(kind);
    mass_ = kind.mass;
  }
  if (layout.kinds.empty()) length_ = 1.0;
  per_length_ = 1.0 / length_;
  time_ = std::sqrt(length_ / layout.gravity);
  impulse_ = mass_ * length_ / time_;
  force_ = mass_ * layout.gravity;
  energy_ = force_ * length_;
  if (layout.bricks.empty()) return;
  const Brick& first = layout.bricks[static_cast<std::size_t>(begins_with(layout))];
  origin_ = {first.foot.x, first.foot.y, 0.0};
  heading_ = first.heading;
  const SinCos turn = sin_cos(heading_);
  along_ = Two{turn.cos, turn.cos};
  across_ = Two{turn.sin, -turn.sin};
  if (!is_left_handed(layout)) return;
  hand_ = -1.0;
  along_[1] = -along_[1];
  across_[1] = -across_[1];
}

// Whether the y axis is to point to the other side: by the first brick off the axis, or else by the first that is turned.
bool RunUnits::is_left_handed(const Layout& layout) const {
  for (const Brick& brick : layout.bricks) {
    const double aside = foot(brick).y;
    if (aside != 0.0) return aside < 0.0;
  }
  for (const Brick& brick : layout.bricks) {
    const double turned = heading(brick);
    if (turned != 0.0 && turned != kBack) return turned < 0.0;
  }
  return false;
}

Brick RunUnits::put_down(const Brick& brick) const {
  Brick put = brick;
  put.foot = foot(brick);
  put.heading = heading(brick);
  return put;
}

BrickKind RunUnits::kind(const BrickKind& kind) const {
  BrickKind out = kind;
  for (double* side : {&out.height, &out.width, &out.thickness}) *side = rounded(*side * per_length_);
  out.mass = rounded(out.mass / mass_);
  return out;
}

Push RunUnits::push(const Push& push) const {
  Push out = push;
  out.at = time(push.at);
  if (auto* spin = std::get_if<AngularSpeedPush>(&out.how)) {
    spin->angular_speed = rounded(spin->angular_speed * time_);
  } else if (auto* steady = std::get_if<ForcePush>(&out.how)) {
    steady->force = rounded(steady->force / force_);
    steady->height = rounded(steady->height * per_length_);
    steady->duration = time(steady->duration);
  } else {
    auto& blow = std::get<ImpulsePush>(out.how);
    blow.impulse = rounded(blow.impulse / impulse_);
    blow.height = rounded(blow.height * per_length_);
  }
  return out;
}

double RunUnits::time(double seconds) const { return rounded(seconds / time_); }

// The mirror image of a wheel that rolls ahead rolls ahead, that of one which turns about its heading or the vertical turns the other way.
void RunUnits::tell(std::span<FreeMotion> motions, const std::vector<Brick>& bricks) const {
  const double per_time = 1.0 / time_, speed = length_ * per_time, hand = hand_;
  const Two ahead = {along_[0], across_[0]}, aside = {across_[1], along_[1]};  // Where the run's axes point.
  const Two far_ahead = length_ * ahead, far_aside = length_ * aside, fast_ahead = speed * ahead, fast_aside = speed * aside;
  const Two roll = (per_time * hand) * ahead, pitch = (per_time * hand) * aside;
  const SinCos half = sin_cos(0.5 * heading_);
  const Two cosine = {half.cos, hand * half.cos}, sine = {hand * half.sin, half.sin};
  for (FreeMotion& motion : motions) {
    const Brick& brick = bricks[static_cast<std::size_t>(motion.brick)];
    const Vec3 moved = motion.pose.position - foot(brick), v = motion.velocity, w = motion.angular_velocity;
    const Two place = Two{brick.foot.x, brick.foot.y} + moved.x * far_ahead + moved.y * far_aside;
    const Two velocity = v.x * fast_ahead + v.y * fast_aside, turning = w.x * roll + w.y * pitch;
    motion.pose.position = {place[0], place[1], brick.foot.z + length_ * moved.z};
    motion.velocity = {velocity[0], velocity[1], speed * v.z};
    motion.angular_velocity = {turning[0], turning[1], per_time * hand * w.z};
    Quat& q = motion.pose.orientation;
    const Two wx = cosine * Two{q.w, q.x} - sine * Two{q.z, q.y}, yz = cosine * Two{q.y, q.z} + sine * Two{q.x, q.w};
    q = {wx[0], wx[1], yz[0], yz[1]};
    // The image of a brick that lies on its right lies on its left: the same box, but those of a layout lie on their right.
    if (hand < 0.0 && brick.stance == Stance::on_side) q = q * Quat{0.0, 1.0, 0.0, 0.0};
  }
}

}  // namespace topple::rigid

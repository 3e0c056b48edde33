/// Where a run is computed, and in which units: those that its layout itself gives.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "base/trigonometry.h"
#include "topple/model.h"

namespace topple::rigid {

/// Physics knows no place, direction, hand or unit. So a run is computed from the foot of the brick that is pushed first (none: brick 0),
/// along its heading, with the first brick of the document that is off this axis on the left (all on it: the first that is turned away
/// from it heads to the left); in lengths of `smallest`, the longest side of the smallest brick, in times of sqrt(smallest / gravity) and
/// in masses of that brick. What is then left of where and how large a layout is, are roundings: they go by rounding what comes in once,
/// to a grid that is far finer than bricks can be put down. So layouts that are alike are one computation, to the bit.
class RunUnits {
 public:
  explicit RunUnits(const Layout& layout);

  // ---- Into the run. What comes in is rounded: places on the floor to 2^-28, headings to 2^-42, all else to twelve digits ----

  Vec3 foot(const Brick& brick) const;
  double heading(const Brick& brick) const;  ///< In (-pi, pi], to the left [rad].
  Brick put_down(const Brick& brick) const;
  BrickKind kind(const BrickKind& kind) const;  ///< Friction and restitution are as given.
  Push push(const Push& push) const;
  double time(double seconds) const;

  // ---- Out of it. Times are not here: they count from steps, which the model does ----

  Vec3 place(const Vec3& of) const { return origin_ + length_ * direction(of); }  ///< [m]
  Vec3 force(const Vec3& of) const { return force_ * direction(of); }             ///< [N]
  double force(double of) const { return force_ * of; }                           ///< [N]
  double impulse(double of) const { return impulse_ * of; }                       ///< [N s]
  double energy(double of) const { return energy_ * of; }                         ///< [J]
  /// Of bricks of the layout. One that has not moved is exactly where it was put down.
  void tell(std::span<FreeMotion> motions, const std::vector<Brick>& bricks) const;

 private:
  // Added to a number and taken off again, these leave a multiple of 2^-28, 2^-40 or 2^-42: the last bit of the sum. A place that is
  // rounded to 4e-9 still lies in a row's plane, and at its pitch (row_plane.h). Headings are far finer, since rows are long.
  static constexpr double kPlaceGrid = 0x1.8p+24, kUpGrid = 0x1.8p+12, kHeadingGrid = 0x1.8p+10;
  static constexpr double on_grid(double value, double grid) { return (value + grid) - grid; }
  static constexpr double kBack = (kPi + kHeadingGrid) - kHeadingGrid;  // The heading that is neither to the left nor to the right.

  bool is_left_handed(const Layout& layout) const;
  using Two = double __attribute__((vector_size(16)));
  Vec3 direction(const Vec3& of) const {
    const Two flat = of.x * Two{along_[0], across_[0]} + of.y * Two{across_[1], along_[1]};
    return {flat[0], flat[1], of.z};
  }

  Vec3 origin_;                                   // [m]
  double heading_ = 0.0;                          // Of the run's x axis [rad].
  Two along_ = {1.0, 1.0}, across_ = {0.0, 0.0};  // Its cosine, its sine; the second of each times the hand, that of the sine times -1 too.
  double hand_ = 1.0;                             // -1: its y axis points to the right.
  double length_ = 1.0, per_length_ = 1.0;        // [m]
  double time_ = 1.0;                             // [s]
  double mass_ = 1.0;                             // [kg]
  double force_ = 1.0, impulse_ = 1.0, energy_ = 1.0;
};

inline Vec3 RunUnits::foot(const Brick& brick) const {
  // Along and to the hand's side, both at once: it is asked for wherever a brick is told of.
  const Two apart = Two{brick.foot.x, brick.foot.y} - Two{origin_.x, origin_.y};
  const Two turned = along_ * apart + across_ * Two{apart[1], apart[0]};
  const Two place = (per_length_ * turned + kPlaceGrid) - kPlaceGrid;
  return {place[0], place[1], on_grid(brick.foot.z * per_length_, kUpGrid)};
}

inline double RunUnits::heading(const Brick& brick) const {
  double turned = hand_ * (brick.heading - heading_);
  if (std::abs(turned) > 3.0) turned -= 2.0 * kPi * std::floor(turned / (2.0 * kPi) + 0.5);
  const double heading = on_grid(turned, kHeadingGrid);
  return heading == -kBack ? kBack : heading;
}

}  // namespace topple::rigid

#include "model/hinge/train.h"

#include <algorithm>
#include <cmath>

#include "base/trigonometry.h"
#include "model/hinge/lean.h"

namespace topple::hinge {

namespace {

Lean lean_of(const TrainBrick& brick, double direction, double sin_ahead, double cos_ahead) {
  return brick.on_heel ? lean_on_heel(brick.pitch, brick.thickness_ahead, sin_ahead, cos_ahead)
                       : lean_on_face(brick.pitch, brick.thickness_ahead, direction * brick.friction, sin_ahead, cos_ahead);
}

// Walks from the front to the back and adds up what each brick is to the front brick: sum of G I R, G T and G I S, where R and S are
// the first and second derivative of its angle by the front's and G is the product of the gains between it and the front. From
// I_k th''_k = T_k + f_k a_k - f_(k-1) b_(k-1) [vanLeeuwen2010] eq. 24, the forces f eliminated from the back to the front.
template <typename Visit>
FrontView walk(std::size_t size, const TrainBrick* front, double front_angle, double direction, double load, Visit visit) {
  auto [s, c] = sin_cos(front_angle);
  FrontView sum{front->inertia, front->torque_sin * s + front->torque_cos * c, 0.0};
  visit(*front, s, c, 1.0, 0.0, 1.0);
  double ratio = 1.0;
  double curvature = 0.0;
  double gain = 1.0;
  for (std::size_t k = 1; k < size; ++k) {
    const TrainBrick& brick = *(front - k);
    const Lean lean = lean_of(brick, direction, s, c);
    s = lean.sin_behind;
    c = lean.cos_behind;
    curvature = lean.curvature * ratio * ratio + lean.ratio * curvature;
    ratio *= lean.ratio;
    gain *= lean.gain;
    sum.inertia += gain * brick.inertia * ratio;
    sum.torque += gain * (brick.torque_sin * s + brick.torque_cos * c);
    sum.coupling += gain * brick.inertia * curvature;
    visit(brick, s, c, ratio, curvature, gain);
  }
  sum.torque += gain * load;
  return sum;
}

constexpr auto kNothing = [](const TrainBrick&, double, double, double, double, double) {};

}  // namespace

void Train::clear() {
  bricks_.clear();
  first_ = 0;
  load_ = 0.0;
}

FrontView Train::view(double front_angle, double direction) const {
  return walk(size(), &bricks_.back(), front_angle, direction, load_, kNothing);
}

FrontView Train::place(double front_angle, double direction) {
  double ahead = front_angle;
  double sin_ahead = 0.0;
  double cos_ahead = 1.0;
  const TrainBrick* front = &bricks_.back();
  return walk(size(), front, front_angle, direction, load_,
              [&](const TrainBrick& brick, double s, double c, double ratio, double curvature, double) {
                auto& placed = const_cast<TrainBrick&>(brick);
                // sin D, from which the angle against the brick ahead is more exact than from the angle itself.
                if (&brick != front) ahead += arc_sine(s * cos_ahead - c * sin_ahead);
                placed.angle = ahead;
                placed.ratio = ratio;
                placed.curvature = curvature;
                sin_ahead = s;
                cos_ahead = c;
              });
}

double Train::angle_of(std::size_t index, double front_angle) const {
  if (index == 0) return front_angle;
  double sine = 0.0;
  double cosine = 1.0;
  walk(index + 1, &bricks_.back(), front_angle, 1.0, 0.0, [&](const TrainBrick&, double s, double c, double, double, double) {
    sine = s;
    cosine = c;
  });
  return arc_tangent(sine, cosine);
}

void Train::edges(double front_angle, std::span<double> out) const {
  double cos_ahead = 1.0;
  std::size_t index = 0;
  walk(out.size(), &bricks_.back(), front_angle, 1.0, 0.0, [&](const TrainBrick& brick, double, double c, double, double, double) {
    out[index++] = brick.pitch * cos_ahead - brick.thickness_ahead;
    cos_ahead = c;
  });
}

double Train::front_momentum(std::span<const double> rates, double direction) const {
  double momentum = 0.0;
  std::size_t index = 0;
  walk(size(), &bricks_.back(), at(0).angle, direction, 0.0,
       [&](const TrainBrick& brick, double, double, double, double, double gain) { momentum += gain * brick.inertia * rates[index++]; });
  return momentum;
}

double Train::last_travel(double front_angle) const {
  // On the edge the ratio falls as the fall goes on, so that its value now bounds it; on the heel it stays under t^2 / (p^2 + t^2).
  double bound = 0.5 * kPi - front_angle;
  auto [s, c] = sin_cos(front_angle);
  for (std::size_t k = 1; k < size(); ++k) {
    const TrainBrick& brick = at(k);
    const double p2 = brick.pitch * brick.pitch;
    const double t2 = brick.thickness_ahead * brick.thickness_ahead;
    const Lean lean = lean_of(brick, 1.0, s, c);
    s = lean.sin_behind;
    c = lean.cos_behind;
    bound *= std::max(lean.ratio, t2 / (p2 + t2));
  }
  return bound;
}

TrainBrick Train::drop_last(double direction) {
  const TrainBrick last = bricks_[first_];
  const TrainBrick& ahead = bricks_[first_ + 1];
  const auto [s, c] = sin_cos(last.angle);
  const auto [sin_ahead, cos_ahead] = sin_cos(ahead.angle);
  load_ = lean_of(last, direction, sin_ahead, cos_ahead).gain * (last.torque_sin * s + last.torque_cos * c + load_);
  ++first_;
  if (first_ >= 256 && 2 * first_ >= bricks_.size()) {
    bricks_.erase(bricks_.begin(), bricks_.begin() + static_cast<std::ptrdiff_t>(first_));
    first_ = 0;
  }
  return last;
}

}  // namespace topple::hinge

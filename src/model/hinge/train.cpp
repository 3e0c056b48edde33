#include "model/hinge/train.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/trigonometry.h"
#include "model/hinge/lean.h"

namespace topple::hinge {

namespace {

template <typename Number>
Lean<Number> lean_of(const TrainBrick& brick, double direction, Number sin_ahead, Number cos_ahead) {
  return brick.on_heel ? lean_on_heel(brick.pitch, brick.thickness_ahead, sin_ahead, cos_ahead)
                       : lean_on_face(brick.pitch, brick.thickness_ahead, direction * brick.friction, sin_ahead, cos_ahead);
}

// On the edge the ratio falls as the fall goes on, so that its value now bounds it; on the heel it stays under t^2 / (p^2 + t^2).
double ratio_bound(const TrainBrick& brick, double ratio) {
  const double p2 = brick.pitch * brick.pitch;
  const double t2 = brick.thickness_ahead * brick.thickness_ahead;
  return std::max(ratio, t2 / (p2 + t2));
}

// arcsin by its series, sum of (2n)! / (4^n n!^2 (2n + 1)) x^(2n+1): the first term left out is below 1e-16 of it. Bricks behind the front
// lean little on each other; for the others there is the general function.
double lean_angle(double sine) {
  const double q = sine * sine;
  if (q > 0.0625) return arc_sine(sine);
  double series = 0.0;
  if (q > 0.004) {
    for (const double term : {0.006447210311889649, 0.0073125258735988454, 0.008390335809616815, 0.009761609529194078, 0.011551800896139705,
                              0.01396484375, 0.017352764423076924}) {
      series = q * (term + series);
    }
  }
  for (const double term : {0.022372159090909092, 0.030381944444444444, 0.044642857142857144, 0.075, 0.16666666666666666}) {
    series = q * (term + series);
  }
  return sine + sine * series;
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
    const auto lean = lean_of(brick, direction, s, c);
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

bool Train::moves_as(const Train& other) const {
  if (size() != other.size() || load_ != other.load_) return false;
  const auto same = [](const TrainBrick& a, const TrainBrick& b) {
    return a.angle == b.angle && a.ratio == b.ratio && a.curvature == b.curvature && a.bound == b.bound && a.on_heel == b.on_heel &&
           a.arrived == b.arrived && a.inertia == b.inertia && a.torque_sin == b.torque_sin && a.torque_cos == b.torque_cos &&
           a.height == b.height && a.thickness == b.thickness && a.pitch == b.pitch && a.thickness_ahead == b.thickness_ahead &&
           a.friction == b.friction && a.hit_angle == b.hit_angle;
  };
  return std::equal(bricks_.begin() + static_cast<std::ptrdiff_t>(first_), bricks_.end(),
                    other.bricks_.begin() + static_cast<std::ptrdiff_t>(other.first_), same);
}

FrontView Train::view(double front_angle, double direction) const {
  return walk(size(), &bricks_.back(), front_angle, direction, load_, kNothing);
}

FrontView Train::place(double front_angle, double direction) {
  double ahead = front_angle;
  double bound = 1.0;
  double ratio_ahead = 1.0;
  double sin_ahead = 0.0;
  double cos_ahead = 1.0;
  const TrainBrick* front = &bricks_.back();
  return walk(size(), front, front_angle, direction, load_,
              [&](const TrainBrick& brick, double s, double c, double ratio, double curvature, double) {
                auto& placed = const_cast<TrainBrick&>(brick);
                // sin D, from which the angle against the brick ahead is more exact than from the angle itself.
                if (&brick != front) {
                  ahead += lean_angle(s * cos_ahead - c * sin_ahead);
                  bound *= ratio_bound(brick, ratio_ahead != 0.0 ? ratio / ratio_ahead : 0.0);
                }
                ratio_ahead = ratio;
                placed.bound = bound;
                placed.angle = ahead;
                placed.sine = s;
                placed.cosine = c;
                placed.ratio = ratio;
                placed.curvature = curvature;
                sin_ahead = s;
                cos_ahead = c;
              });
}

FrontView Train::look(double front_angle, double direction, std::vector<TrainView>& out) const {
  out.clear();
  return walk(size(), &bricks_.back(), front_angle, direction, load_,
              [&](const TrainBrick& brick, double s, double c, double ratio, double curvature, double) {
                const double angle = out.empty() ? front_angle : out.back().angle + lean_angle(s * out.back().cosine - c * out.back().sine);
                out.push_back({brick.id, angle, s, c, ratio, curvature});
              });
}

Train::Works Train::works(double front_angle) const {
  Works works;
  walk(size(), &bricks_.back(), front_angle, 1.0, 0.0, [&](const TrainBrick& brick, double s, double c, double ratio, double, double) {
    works.motion += brick.inertia * ratio * ratio;
    works.torques += brick.torque_sin * (1.0 - c) + brick.torque_cos * s;
  });
  return works;
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

void Train::goal_edges(std::span<double> out) const {
  for (std::size_t k = 1; k < out.size(); ++k) out[k] = at(k).goal_lean;
}

// It turns over where the brick ahead has turned to the arc cosine of t / p, whatever it does itself; from there forward to the front.
// The lean of brick b on brick f is sin b cos f - cos b sin f = p cos f - t, solved for f: with A = p - sin b, B = cos b it is
// A cos f + B sin f = t, and of the two angles the smaller one.
double Train::turn_over_angle(std::size_t index) const {
  double c = at(index).thickness_ahead / at(index).pitch;
  double s = std::sqrt(1.0 - c * c);
  for (std::size_t k = index - 1; k > 0; --k) {
    const TrainBrick& brick = at(k);
    if (brick.on_heel) return std::numeric_limits<double>::quiet_NaN();
    const double a = brick.pitch - s;
    const double b = c;
    const double t = brick.thickness_ahead;
    const double square = a * a + b * b;
    const double root = std::sqrt(square - t * t);
    c = (a * t + b * root) / square;
    s = (b * t - a * root) / square;
  }
  return arc_tangent(s, c);
}

double Train::front_momentum(std::span<const double> rates, double direction) const {
  double momentum = 0.0;
  std::size_t index = 0;
  walk(size(), &bricks_.back(), at(0).angle, direction, 0.0,
       [&](const TrainBrick& brick, double, double, double, double, double gain) { momentum += gain * brick.inertia * rates[index++]; });
  return momentum;
}

FrontView Train::strike(const TrainBrick& standing, const FrontView& old) {
  // The new front is upright, so the old one turns as fast as it (ratio 1), and the others as fast as they did against the old one.
  const auto lean = lean_of(at(0), 1.0, 0.0, 1.0);
  for (std::size_t k = 0; k < size(); ++k) at(k).curvature += at(k).ratio * lean.curvature;
  add_front(standing);
  return {standing.inertia + lean.gain * old.inertia, standing.torque_cos + lean.gain * old.torque,
          lean.gain * (old.coupling + lean.curvature * old.inertia)};
}

double Train::last_travel(double front_angle) const { return bricks_[first_].bound * (0.5 * kPi - front_angle); }

Sweep Train::sweep(const std::array<double, 4>& front_angles, double direction, double slack) {
  // As walk(), on two pairs of angles.
  std::array<Pair, 2> s, c, ratio, curvature, gain, inertia, torque, coupling;
  const TrainBrick* front = &bricks_.back();
  for (std::size_t i = 0; i < 2; ++i) {
    const SinCos low = sin_cos(front_angles[2 * i]);
    const SinCos high = sin_cos(front_angles[2 * i + 1]);
    s[i] = Pair{low.sin, high.sin};
    c[i] = Pair{low.cos, high.cos};
    ratio[i] = gain[i] = Pair{1.0, 1.0};
    curvature[i] = coupling[i] = Pair{0.0, 0.0};
    inertia[i] = Pair{front->inertia, front->inertia};
    torque[i] = front->torque_sin * s[i] + front->torque_cos * c[i];
  }
  Sweep out;
  bricks_.back().way_ratio = {1.0, 1.0};
  double bound = 1.0;
  for (std::size_t k = 1; k < size(); ++k) {
    TrainBrick& brick = bricks_[bricks_.size() - 1 - k];
    std::array<Lean<Pair>, 2> lean;
    for (std::size_t i = 0; i < 2; ++i) {
      lean[i] = lean_of(brick, direction, s[i], c[i]);
      s[i] = lean[i].sin_behind;
      c[i] = lean[i].cos_behind;
      curvature[i] = lean[i].curvature * ratio[i] * ratio[i] + lean[i].ratio * curvature[i];
      ratio[i] *= lean[i].ratio;
      gain[i] *= lean[i].gain;
      inertia[i] += gain[i] * brick.inertia * ratio[i];
      torque[i] += gain[i] * (brick.torque_sin * s[i] + brick.torque_cos * c[i]);
      coupling[i] += gain[i] * brick.inertia * curvature[i];
    }
    if (!brick.on_heel) {
      out.turns_over |= lean[1].sin_lean[1] < -slack * brick.thickness_ahead;
      out.touches |= lean[1].sin_lean[1] < slack * brick.thickness_ahead;
    }
    bound *= ratio_bound(brick, lean[1].ratio[1]);
    brick.goal_lean = lean[1].sin_lean[1];
    brick.goal_ratio = ratio[1][1];
    brick.goal_curvature = curvature[1][1];
    brick.goal_bound = bound;
    brick.way_ratio = {ratio[0][0], ratio[1][0]};
  }
  for (std::size_t j = 0; j < 4; ++j) {
    const std::size_t i = j / 2;
    const std::size_t lane = j % 2;
    out.views[j] = {inertia[i][lane], torque[i][lane] + gain[i][lane] * load_, coupling[i][lane]};
  }
  return out;
}

void Train::place_at_goal(double front_angle) {
  double angle = front_angle;
  for (std::size_t k = 0; k < size(); ++k) {
    TrainBrick& brick = at(k);
    if (k > 0) angle += lean_angle(brick.goal_lean);
    brick.angle = angle;
    brick.ratio = k > 0 ? brick.goal_ratio : 1.0;
    brick.curvature = k > 0 ? brick.goal_curvature : 0.0;
    brick.bound = k > 0 ? brick.goal_bound : 1.0;
  }
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

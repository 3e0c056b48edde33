#include "model/pivot/lean.h"

#include <cmath>
#include <limits>

#include "base/trigonometry.h"

namespace topple::pivot {

namespace {

constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
constexpr double kRightAngle = 0.5 * kPi;

// Directions that agree to this [rad] count as in line: at the far edge of a brick it is a millionth of a thickness.
constexpr double kInLineAngle = 1e-7;

// Two bricks nearer than this fraction of the thickness touch.
constexpr double kTouching = 1e-6;

// A root of a falling function of an angle in [low, high], where value(low) >= 0 > value(high): the side that is still apart.
template <typename Function>
double falling_root(const Function& value, double low, double high) {
  double at_low = value(low);
  double at_high = value(high);
  for (int i = 0; i < 80 && high - low > 1e-12; ++i) {
    // Regula falsi, held away from the ends so that both move; halving when it stalls.
    double middle = low + (high - low) * at_low / (at_low - at_high);
    const double margin = 0.02 * (high - low);
    if (!(middle > low + margin)) middle = low + margin;
    if (!(middle < high - margin)) middle = high - margin;
    if (i % 3 == 2) middle = 0.5 * (low + high);
    const double at_middle = value(middle);
    if (at_middle >= 0.0) {
      low = middle;
      at_low = at_middle;
    } else {
      high = middle;
      at_high = at_middle;
    }
  }
  return low;
}

double direction(const Brick& brick, int side) { return side > 0 ? brick.heading : brick.heading + kPi; }

}  // namespace

Pair::Pair(const Layout& layout, BrickId behind, int behind_side, BrickId ahead, int ahead_side)
    : layout_(&layout), behind_(behind), ahead_(ahead), behind_side_(behind_side), ahead_side_(ahead_side) {
  const Brick& b = layout.bricks[static_cast<std::size_t>(behind)];
  const Brick& a = layout.bricks[static_cast<std::size_t>(ahead)];
  const Extents size = extents(layout.kinds[b.kind], b.stance);
  const Extents other = extents(layout.kinds[a.kind], a.stance);
  const SinCos turned = sin_cos(direction(a, ahead_side) - direction(b, behind_side));
  const SinCos heading = sin_cos(direction(b, behind_side));
  height_ = size.up;
  thickness_ = size.along;
  pitch_ = (a.foot.x - b.foot.x) * heading.cos + (a.foot.y - b.foot.y) * heading.sin;
  const bool same_size = size.up == other.up && size.along == other.along;
  // Beyond this pitch a fallen brick's edge leaves its neighbour's face, and the closed forms no longer hold.
  const bool near = pitch_ * pitch_ + thickness_ * thickness_ <= height_ * height_;
  aligned_ = same_size && turned.cos > 0.0 && std::fabs(turned.sin) < kInLineAngle;
  in_line_ = aligned_ && near;
  find_contact(other.up);
}

void Pair::find_contact(double ahead_height) {
  if (aligned_) {
    const double gap = pitch_ - thickness_;
    contact_angle_ = gap >= 0.0 && gap < height_ ? arc_sine(gap / height_) : kNever;
  } else if (distance(0.0, 0.0) < 0.0) {
    contact_angle_ = kNever;
    return;
  } else {
    // The distance need not fall all the way (the edge swings up to the brick ahead and may pass over a low one), so walk.
    constexpr int kSteps = 90;
    contact_angle_ = kNever;
    for (int i = 1; i <= kSteps; ++i) {
      const double theta = kRightAngle * i / kSteps;
      if (distance(theta, 0.0) >= 0.0) continue;
      contact_angle_ = falling_root([this](double t) { return distance(t, 0.0); }, kRightAngle * (i - 1) / kSteps, theta);
      break;
    }
  }
  // The upper edge touches first, unless the brick ahead is lower than that edge.
  contact_height_ = std::fmin(height_ * sin_cos(contact_angle_).cos, ahead_height);
}

double Pair::distance(double behind, double ahead) const {
  const Box b{hinged_pose(*layout_, behind_, behind_side_ * behind), half_extents(layout_->kind_of(behind_))};
  const Box a{hinged_pose(*layout_, ahead_, ahead_side_ * ahead), half_extents(layout_->kind_of(ahead_))};
  return separation(b, a);
}

Bound Pair::bound_on_rear_edge(const Fall& ahead) const {
  const SinCos& a = ahead.turned;
  // The front face on the lower rear edge ahead: p cos(theta) = T cos(theta - ahead).
  const double x = pitch_ - thickness_ * a.cos;
  const double z = thickness_ * a.sin;
  const double turn = (thickness_ * a.sin * z - x * thickness_ * a.cos) / (x * x + z * z);
  const double theta = arc_tangent(x, z);
  return {.theta = theta, .slope = turn, .turned = sin_cos(theta), .on_rear_edge = true};
}

Bound Pair::bound_out_of_line(double from, double to, const Fall& ahead) const {
  if (to <= from || distance(to, ahead.theta) >= 0.0) return {.theta = std::numeric_limits<double>::infinity()};
  if (distance(from, ahead.theta) < 0.0) return {.theta = from, .turned = sin_cos(from)};
  const double theta = falling_root([&](double t) { return distance(t, ahead.theta); }, from, to);
  return {.theta = theta, .slope = bound_slope(theta, ahead.theta), .turned = sin_cos(theta)};
}

double Pair::bound_slope(double behind, double ahead) const {
  // The distance stays zero: d theta / d ahead = -(dD / d ahead) / (dD / d theta).
  constexpr double kSmall = 1e-6;
  const double by_ahead = distance(behind, ahead + kSmall) - distance(behind, ahead - kSmall);
  const double by_behind = distance(behind + kSmall, ahead) - distance(behind - kSmall, ahead);
  return by_behind < 0.0 ? -by_ahead / by_behind : 0.0;
}

std::optional<double> Pair::fall_back_stop(double behind, double from, double to) const {
  const double touching = kTouching * (in_line_ ? thickness_ / height_ : thickness_);
  const auto apart = [&](double ahead) {
    return (in_line_ ? bound_in_line(fall_at(0.0, ahead, 0.0)).theta - behind : distance(behind, ahead)) - touching;
  };
  if (apart(to) >= 0.0) return std::nullopt;
  if (apart(from) < 0.0) return from;
  // In terms of how far it has fallen back, the distance falls.
  return from - falling_root([&](double back) { return apart(from - back); }, 0.0, from - to);
}

}  // namespace topple::pivot

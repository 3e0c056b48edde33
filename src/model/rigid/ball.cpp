#include "model/rigid/ball.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

namespace {

constexpr std::uint32_t kFeature = 8U << 16;  // A ball has one point; no corner and no face is called so.

// From the box to the ball's middle: the normal out of the box, and how far the middle is from its surface (< 0 inside).
struct Way {
  Vec3 normal;
  double distance = 0.0;
};
Way way_out(const Body& box, const Vec3& middle) {
  const Vec3 local = transposed_times(box.axes, middle - box.position);
  const auto clamped = [](double x, double half) { return std::clamp(x, -half, half); };
  const Vec3 nearest{clamped(local.x, box.half.x), clamped(local.y, box.half.y), clamped(local.z, box.half.z)};
  const Vec3 apart = local - nearest;
  const double distance = norm(apart);
  if (distance > 0.0) return {box.axes * ((1.0 / distance) * apart), distance};
  // The middle itself is inside: out by the nearest face.
  const Vec3 depth{box.half.x - std::abs(local.x), box.half.y - std::abs(local.y), box.half.z - std::abs(local.z)};
  const int axis = depth.x <= depth.y && depth.x <= depth.z ? 0 : depth.y <= depth.z ? 1 : 2;
  const double side = component(local, axis) < 0.0 ? -1.0 : 1.0;
  return {side * column(box.axes, axis), -component(depth, axis)};
}

}  // namespace

void touch_floor_with_ball(const Body& ball, double margin, Manifold& out) {
  out.normal = {0.0, 0.0, 1.0};
  out.reference = Reference::b;
  out.count = 0;
  const double height = ball.position.z - ball.half.x;
  out.parted = height;
  if (height > margin) return;
  out.count = 1;
  out.points[0] = {ball.position - Vec3{0.0, 0.0, ball.half.x}, height, kFeature};
}

void touch_ball(const Body& a, const Body& b, double margin, Manifold& out) {
  out.count = 0;
  out.reference = a.round ? Reference::b : Reference::a;
  Way way;  // From b to a.
  double reach = 0.0;
  if (a.round && b.round) {
    const Vec3 apart = a.position - b.position;
    const double distance = norm(apart);
    way = {distance > 0.0 ? (1.0 / distance) * apart : Vec3{0.0, 0.0, 1.0}, distance};
    reach = a.half.x + b.half.x;
  } else if (a.round) {
    way = way_out(b, a.position);
    reach = a.half.x;
  } else {
    way = way_out(a, b.position);
    way.normal = -way.normal;
    reach = b.half.x;
  }
  const double separation = way.distance - reach;
  out.parted = separation;
  if (separation > margin) return;
  out.normal = way.normal;
  out.count = 1;
  const Vec3 at = a.round ? a.position - a.half.x * way.normal : b.position + b.half.x * way.normal;
  out.points[0] = {at, separation, kFeature};
}

void resist_rolling(Body& ball, double coefficient, double gravity, double time) {
  const double speed = std::sqrt(ball.velocity.x * ball.velocity.x + ball.velocity.y * ball.velocity.y);
  const double loss = 5.0 / 7.0 * coefficient * gravity * time;
  const double share = speed > loss ? 1.0 - loss / speed : 0.0;
  ball.velocity = {share * ball.velocity.x, share * ball.velocity.y, ball.velocity.z};
  ball.angular_velocity = share * ball.angular_velocity;
}

}  // namespace topple::rigid

#include "model/rigid/brick_state.h"

#include <cmath>

#include "base/trigonometry.h"

namespace topple::rigid {

namespace {

// A rotation by the vector `turn` [rad] as a quaternion.
Quat turn_by(const Vec3& turn) {
  const double half_squared = 0.25 * dot(turn, turn);
  double cosine = 0.0;
  double sine_over = 0.0;  // sin(|turn| / 2) / |turn|
  if (half_squared < 0.0625) {
    // Taylor series: the first term left out is below 1e-15.
    const double q = half_squared;
    cosine = 1.0 - q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0 * (1.0 - q / 90.0))));
    sine_over = 0.5 * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0))));
  } else {
    const double angle = 2.0 * std::sqrt(half_squared);
    const SinCos half = sin_cos(0.5 * angle);
    cosine = half.cos;
    sine_over = half.sin / angle;
  }
  return {cosine, sine_over * turn.x, sine_over * turn.y, sine_over * turn.z};
}

}  // namespace

Vec3 free_rotation(const Body& body) {
  // Euler's equation without torque: I dw/dt = -w x I w.
  const Vec3 local = transposed_times(body.axes, body.angular_velocity);
  const Vec3 momentum{body.inertia.x * local.x, body.inertia.y * local.y, body.inertia.z * local.z};
  const Vec3 torque = cross(momentum, local);
  const Vec3 rate{torque.x / body.inertia.x, torque.y / body.inertia.y, torque.z / body.inertia.z};
  return body.axes * rate;
}

void refresh(Body& body) {
  body.axes = rotation(body.orientation);
  if (body.inverse_mass > 0.0) {
    body.inverse_inertia = conjugated(body.axes, {1.0 / body.inertia.x, 1.0 / body.inertia.y, 1.0 / body.inertia.z});
    body.gyroscopic = free_rotation(body);
  }
}

void drift(Body& body, double time) {
  const Vec3 local = transposed_times(body.axes, body.angular_velocity);
  const Vec3 momentum = body.axes * Vec3{body.inertia.x * local.x, body.inertia.y * local.y, body.inertia.z * local.z};
  const Vec3 turn = time * (body.angular_velocity + (0.5 * time) * body.gyroscopic);
  const Quat q = turn_by(turn) * body.orientation;
  const double scale = 1.0 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  body.orientation = {scale * q.w, scale * q.x, scale * q.y, scale * q.z};
  body.position = body.position + time * body.velocity;
  body.axes = rotation(body.orientation);
  body.inverse_inertia = conjugated(body.axes, {1.0 / body.inertia.x, 1.0 / body.inertia.y, 1.0 / body.inertia.z});
  body.angular_velocity = body.inverse_inertia * momentum;
  body.gyroscopic = free_rotation(body);
}

Body make_body(const BrickKind& kind, BrickId id, std::uint16_t kind_index, const Pose& pose) {
  Body body;
  body.position = pose.position;
  body.orientation = pose.orientation;
  body.half = {0.5 * kind.thickness, 0.5 * kind.width, 0.5 * kind.height};
  body.inverse_mass = 1.0 / kind.mass;
  const double t2 = kind.thickness * kind.thickness;
  const double w2 = kind.width * kind.width;
  const double h2 = kind.height * kind.height;
  body.inertia = {kind.mass * (w2 + h2) / 12.0, kind.mass * (t2 + h2) / 12.0, kind.mass * (t2 + w2) / 12.0};
  body.radius = 0.5 * std::sqrt(t2 + w2 + h2);
  if (kind.shape == Shape::ball) {
    body.round = true;
    body.radius = body.half.x;
    const double inertia = 0.4 * kind.mass * body.radius * body.radius;
    body.inertia = {inertia, inertia, inertia};
  }
  body.id = id;
  body.kind = kind_index;
  refresh(body);
  return body;
}

double kinetic_energy(const Body& body) {
  const Vec3 local = transposed_times(body.axes, body.angular_velocity);
  return 0.5 * (dot(body.velocity, body.velocity) / body.inverse_mass + body.inertia.x * local.x * local.x +
                body.inertia.y * local.y * local.y + body.inertia.z * local.z * local.z);
}

}  // namespace topple::rigid

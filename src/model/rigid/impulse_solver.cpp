#include "model/rigid/impulse_solver.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

namespace {

// Any direction at right angles to the normal: along the floor where there is one, so that rows of one heading share it.
Vec3 tangent_of(const Vec3& normal, const Vec3& slip) {
  const Vec3 flat = slip - dot(slip, normal) * normal;
  const double length = norm(flat);
  if (length > 1e-9) return (1.0 / length) * flat;
  const Vec3 other = std::abs(normal.z) < 0.9 ? Vec3{0.0, 0.0, 1.0} : Vec3{1.0, 0.0, 0.0};
  const Vec3 side = cross(normal, other);
  return (1.0 / norm(side)) * cross(side, normal);
}

// Velocity that an impulse gives to its own point: (1/m) p + (I^-1 (r x p)) x r.
Vec3 response(const Body& body, const Vec3& arm, const Vec3& impulse) {
  return body.inverse_mass * impulse + cross(body.inverse_inertia * cross(arm, impulse), arm);
}

void apply(Body& body, const Vec3& arm, const Vec3& impulse) {
  body.velocity = body.velocity + body.inverse_mass * impulse;
  body.angular_velocity = body.angular_velocity + body.inverse_inertia * cross(arm, impulse);
}

}  // namespace

void apply(std::span<Body> bodies, const ContactRow& row, double n, double s, double t) {
  const Vec3 impulse = n * row.normal + s * row.along + t * row.across;
  apply(bodies[static_cast<std::size_t>(row.a)], row.arm_a, impulse);
  if (row.b == kFloor) return;
  Body& b = bodies[static_cast<std::size_t>(row.b)];
  if (b.inverse_mass > 0.0) apply(b, row.arm_b, -impulse);
}

namespace {

void set_frame(ContactRow& row, std::span<const Body> bodies) {
  const Body& a = bodies[static_cast<std::size_t>(row.a)];
  // The heading of a brick's own x axis: what it slides along.
  row.along = tangent_of(row.normal, column(a.axes, 0));
  row.across = cross(row.normal, row.along);
  Vec3 kn = response(a, row.arm_a, row.normal);
  Vec3 ka = response(a, row.arm_a, row.along);
  Vec3 kc = response(a, row.arm_a, row.across);
  if (row.b != kFloor) {
    const Body& b = bodies[static_cast<std::size_t>(row.b)];
    if (b.inverse_mass > 0.0) {
      kn = kn + response(b, row.arm_b, row.normal);
      ka = ka + response(b, row.arm_b, row.along);
      kc = kc + response(b, row.arm_b, row.across);
    }
  }
  row.k_nn = dot(row.normal, kn);
  row.k_na = dot(row.along, kn);
  row.k_nc = dot(row.across, kn);
  row.k_aa = dot(row.along, ka);
  row.k_ac = dot(row.across, ka);
  row.k_cc = dot(row.across, kc);
}

// A ball's point is always the nearest one, however it turns: for the distance it is as if it did not.
Vec3 spin_of(const Body& body) { return body.round ? Vec3{} : body.angular_velocity; }

Vec3 centripetal(const Body& body, const Vec3& arm) {
  if (body.round) return {};
  return cross(body.angular_velocity, cross(body.angular_velocity, arm)) + cross(body.gyroscopic, arm);
}

// Second derivative of the distance vector of the two material points while no force acts [m/s^2]. The normal turns with the body whose
// face it is, which adds the second term.
Vec3 curvature(const ContactRow& row, const Manifold& manifold, std::span<const Body> bodies) {
  const Body& a = bodies[static_cast<std::size_t>(row.a)];
  Vec3 bend = centripetal(a, row.arm_a);
  if (row.b == kFloor) return bend;
  const Body& b = bodies[static_cast<std::size_t>(row.b)];
  bend = bend - centripetal(b, row.arm_b);
  Vec3 turning = spin_of(b);
  if (manifold.reference == Reference::a) turning = spin_of(a);
  if (manifold.reference == Reference::edges) turning = 0.5 * (spin_of(a) + spin_of(b));
  const Vec3 slip = (a.velocity + cross(spin_of(a), row.arm_a)) - (b.velocity + cross(spin_of(b), row.arm_b));
  const double turned = 2.0 * dot(cross(turning, row.normal), slip);
  return bend + turned * row.normal;
}

// One point: normal first, then friction with the limit that follows. Returns the largest change of velocity.
double solve_row(ContactRow& row, std::span<Body> bodies) {
  Body& a = bodies[static_cast<std::size_t>(row.a)];
  Vec3 slip = velocity_at(a, row.arm_a);
  if (row.b != kFloor) slip = slip - velocity_at(bodies[static_cast<std::size_t>(row.b)], row.arm_b);
  const double vn = dot(row.normal, slip) + row.bias;
  double vs = dot(row.along, slip) + row.bias_along;
  double vt = dot(row.across, slip) + row.bias_across;

  const double n = std::max(row.n - vn / row.k_nn, row.floor_impulse);
  const double dn = n - row.n;
  vs += row.k_na * dn;
  vt += row.k_nc * dn;

  // Sticking if that needs no more than Coulomb allows.
  const double limit = row.friction * std::max(row.n0 + n, 0.0);
  const double determinant = row.k_aa * row.k_cc - row.k_ac * row.k_ac;
  double s = row.s - (row.k_cc * vs - row.k_ac * vt) / determinant;
  double t = row.t - (row.k_aa * vt - row.k_ac * vs) / determinant;
  double size = std::sqrt((row.s0 + s) * (row.s0 + s) + (row.t0 + t) * (row.t0 + t));
  if (size > limit) {
    // Sliding: one scalar step for both directions, so that at the fixed point friction is opposite to the slip.
    const double k = std::max(row.k_aa, row.k_cc) + std::abs(row.k_ac);
    s = row.s - vs / k;
    t = row.t - vt / k;
    size = std::sqrt((row.s0 + s) * (row.s0 + s) + (row.t0 + t) * (row.t0 + t));
    if (size > limit) {
      const double scale = limit / size;
      s = scale * (row.s0 + s) - row.s0;
      t = scale * (row.t0 + t) - row.t0;
    }
  }
  const double ds = s - row.s;
  const double dt = t - row.t;
  row.n = n;
  row.s = s;
  row.t = t;
  apply(bodies, row, dn, ds, dt);
  return std::max(row.k_nn * std::abs(dn), std::max(row.k_aa * std::abs(ds), row.k_cc * std::abs(dt)));
}

}  // namespace

void ImpulseSolver::prepare(std::span<const Body> bodies, std::span<const Touch> touches) {
  rows_.clear();
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Touch& touch = touches[i];
    for (int k = 0; k < touch.manifold.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (!touch.memory[at].active) continue;
      ContactRow row;
      row.a = touch.a;
      row.b = touch.b;
      row.touch = static_cast<int>(i);
      row.point = k;
      row.arm_a = touch.manifold.points[at].position - bodies[static_cast<std::size_t>(touch.a)].position;
      if (touch.b != kFloor) row.arm_b = touch.manifold.points[at].position - bodies[static_cast<std::size_t>(touch.b)].position;
      row.normal = touch.manifold.normal;
      row.friction = touch.friction;
      set_frame(row, bodies);
      rows_.push_back(row);
    }
  }
}

void ImpulseSolver::prepare_positions(std::span<const Body> bodies, std::span<const Touch> touches, double time, double full_step) {
  prepare(bodies, touches);
  for (ContactRow& row : rows_) {
    const Touch& touch = touches[static_cast<std::size_t>(row.touch)];
    const double separation = touch.manifold.points[static_cast<std::size_t>(row.point)].separation;
    const Vec3 bend = (0.5 * time) * curvature(row, touch.manifold, bodies);
    row.bias = separation / (separation > 0.0 ? time : full_step) + dot(row.normal, bend);
    row.bias_along = dot(row.along, bend);
    row.bias_across = dot(row.across, bend);
  }
}

void ImpulseSolver::prepare_velocities(std::span<const Body> bodies, std::span<const Touch> touches, double full_step) {
  prepare(bodies, touches);
  for (ContactRow& row : rows_) {
    const Touch& touch = touches[static_cast<std::size_t>(row.touch)];
    const auto at = static_cast<std::size_t>(row.point);
    const PointMemory& memory = touch.memory[at];
    row.bias = std::max(touch.manifold.points[at].separation, 0.0) / full_step;
    row.n0 = memory.normal_impulse;
    row.s0 = dot(row.along, memory.friction_impulse);
    row.t0 = dot(row.across, memory.friction_impulse);
    row.floor_impulse = -row.n0;
  }
}

void ImpulseSolver::guess(std::span<const Touch> touches, double time) {
  for (ContactRow& row : rows_) {
    const PointMemory& memory = touches[static_cast<std::size_t>(row.touch)].memory[static_cast<std::size_t>(row.point)];
    row.n = time * memory.normal_force;
    row.s = time * dot(row.along, memory.friction_force);
    row.t = time * dot(row.across, memory.friction_force);
  }
}

void ImpulseSolver::apply_guess(std::span<Body> bodies) {
  for (const ContactRow& row : rows_) apply(bodies, row, row.n, row.s, row.t);
}

void ImpulseSolver::solve(std::span<Body> bodies, const SolveLimits& limits) {
  constexpr int kSweepsBeforeNewton = 24;
  constexpr double kLeastPenalty = 1.0, kFirstPenalty = 1e4, kMostPenalty = 1e5;
  NewtonSolver::Effort effort{kFirstPenalty, limits.tolerance};
  for (int sweeps = 0; sweeps < limits.sweeps; ++sweeps) {
    double change = 0.0;
    if (sweeps % 2 == 0) {
      for (std::size_t i = 0; i < rows_.size(); ++i) change = std::max(change, solve_row(rows_[i], bodies));
    } else {
      for (std::size_t i = rows_.size(); i-- > 0;) change = std::max(change, solve_row(rows_[i], bodies));
    }
    if (change <= limits.tolerance) break;
    if (!limits.stacked || sweeps < kSweepsBeforeNewton) continue;
    const bool found = newton_.improve(rows_, bodies, effort);
    effort.penalty = found ? std::min(10.0 * effort.penalty, kMostPenalty) : std::max(0.1 * effort.penalty, kLeastPenalty);
  }
}

bool ImpulseSolver::restore(std::span<const Touch> touches) {
  bool any = false;
  for (ContactRow& row : rows_) {
    const double restitution = touches[static_cast<std::size_t>(row.touch)].restitution;
    if (restitution <= 0.0 || row.n <= 0.0) continue;
    row.floor_impulse = (1.0 + restitution) * row.n;
    any = true;
  }
  return any;
}

}  // namespace topple::rigid

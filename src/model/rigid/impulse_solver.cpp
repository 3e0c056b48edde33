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

void apply(std::span<Body> bodies, const ContactRow& row, const Vec3& impulse) {
  apply(bodies[static_cast<std::size_t>(row.a)], row.arm_a, impulse);
  if (row.b != kFloor) apply(bodies[static_cast<std::size_t>(row.b)], row.arm_b, -impulse);
}

void apply(std::span<Body> bodies, const SweepRow& row, double n, double s, double t) {
  const Vec3 impulse = n * row.normal + s * row.along + t * row.across;
  apply(bodies[static_cast<std::size_t>(row.a)], row.arm_a, impulse);
  if (row.b != kFloor) apply(bodies[static_cast<std::size_t>(row.b)], row.arm_b, -impulse);
}

namespace {

void set_frame(SweepRow& row, std::span<const Body> bodies) {
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

// One point: normal first, then friction with the limit that follows. Returns the largest change of velocity.
double solve_row(SweepRow& row, std::span<Body> bodies) {
  Body& a = bodies[static_cast<std::size_t>(row.a)];
  Vec3 slip = velocity_at(a, row.arm_a);
  if (row.b != kFloor) slip = slip - velocity_at(bodies[static_cast<std::size_t>(row.b)], row.arm_b);
  const double vn = dot(row.normal, slip) + row.bias;
  double vs = dot(row.along, slip) + row.bias_along;
  double vt = dot(row.across, slip) + row.bias_across;

  const double n = std::max(row.n - (vn + row.give_normal * row.n) / (row.k_nn + row.give_normal), 0.0);
  const double dn = n - row.n;
  vs += row.k_na * dn + row.give * row.s;
  vt += row.k_nc * dn + row.give * row.t;

  // Sticking if that needs no more than Coulomb allows.
  const double limit = row.friction * (row.base + n);
  const double k_aa = row.k_aa + row.give, k_cc = row.k_cc + row.give;
  const double determinant = k_aa * k_cc - row.k_ac * row.k_ac;
  double s = row.s - (k_cc * vs - row.k_ac * vt) / determinant;
  double t = row.t - (k_aa * vt - row.k_ac * vs) / determinant;
  double size = std::sqrt(s * s + t * t);
  if (size > limit) {
    // Sliding: one scalar step for both directions, so that at the fixed point friction is opposite to the slip.
    const double k = std::max(k_aa, k_cc) + std::abs(row.k_ac);
    s = row.s - vs / k;
    t = row.t - vt / k;
    size = std::sqrt(s * s + t * t);
    if (size > limit) {
      const double scale = limit / size;
      s = scale * s;
      t = scale * t;
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

void ImpulseSolver::begin(std::span<Body> bodies, std::span<const ContactRow> rows) {
  rows_.clear();
  for (const ContactRow& from : rows) {
    SweepRow row;
    row.a = from.a;
    row.b = from.b;
    row.arm_a = from.arm_a;
    row.arm_b = from.arm_b;
    row.normal = from.normal;
    row.friction = from.friction;
    row.base = from.base;
    row.give_normal = 1.0 / from.normal_stiffness;
    row.give = 1.0 / from.tangent_stiffness;
    set_frame(row, bodies);
    row.bias = dot(row.normal, from.bias);
    row.bias_along = dot(row.along, from.bias);
    row.bias_across = dot(row.across, from.bias);
    row.n = from.n;
    row.s = dot(row.along, from.friction_impulse);
    row.t = dot(row.across, from.friction_impulse);
    rows_.push_back(row);
  }
  for (const SweepRow& row : rows_) apply(bodies, row, row.n, row.s, row.t);
}

double ImpulseSolver::solve(std::span<Body> bodies, std::span<ContactRow> rows, const SolveLimits& limits) {
  begin(bodies, rows);
  if (limits.stacked) order_.find(rows, bodies);
  constexpr int kSweepsBeforeNewton = 24;
  constexpr double kLeastPenalty = 1.0, kFirstPenalty = 1e4, kMostPenalty = 1e5;
  NewtonSolver::Effort effort{kFirstPenalty, limits.tolerance};
  double change = 0.0;
  for (int sweeps = 0; sweeps < limits.sweeps; ++sweeps) {
    change = 0.0;
    if (sweeps % 2 == 0) {
      for (std::size_t i = 0; i < rows_.size(); ++i) change = std::max(change, solve_row(rows_[i], bodies));
    } else {
      for (std::size_t i = rows_.size(); i-- > 0;) change = std::max(change, solve_row(rows_[i], bodies));
    }
    if (change <= limits.tolerance) break;
    if (!limits.stacked || sweeps < kSweepsBeforeNewton) continue;
    const bool found = newton_.improve(rows_, bodies, order_, effort);
    effort.penalty = found ? std::min(10.0 * effort.penalty, kMostPenalty) : std::max(0.1 * effort.penalty, kLeastPenalty);
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const SweepRow& from = rows_[k];
    ContactRow& row = rows[k];
    row.n = from.n;
    row.friction_impulse = from.s * from.along + from.t * from.across;
    const double limit = from.friction * (from.base + from.n);
    row.state = {from.n > 0.0, from.s * from.s + from.t * from.t >= 0.999 * limit * limit};
  }
  return change;
}

}  // namespace topple::rigid

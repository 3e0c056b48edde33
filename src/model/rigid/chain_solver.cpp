#include "model/rigid/chain_solver.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

namespace {

constexpr double kWorst = 0.7;  // States that are wrong by this share of the worst near them change together.
constexpr int kNear = 1;        // That many bricks to each side.
// At most so many solutions, and so many more a body: along a wave a few do; a structure settles brick by brick when it is put down.
constexpr int kIterations = 20;
constexpr int kPerBody = 2;

Vec3 linear(const Column<6>& v) { return {v[0], v[1], v[2]}; }
Vec3 angular(const Column<6>& v) { return {v[3], v[4], v[5]}; }

void add_scaled(Column<6>& out, double scale, const Vec3& force, const Vec3& arm) {
  const Vec3 torque = cross(arm, force);
  out[0] += scale * force.x;
  out[1] += scale * force.y;
  out[2] += scale * force.z;
  out[3] += scale * torque.x;
  out[4] += scale * torque.y;
  out[5] += scale * torque.z;
}

// r x, as a matrix, times k: from impulses to torques.
Mat3 turned_by(const Vec3& r, const Mat3& k) { return {r.y * k.r2 - r.z * k.r1, r.z * k.r0 - r.x * k.r2, r.x * k.r1 - r.y * k.r0}; }

// k times (x -> x cross r): from spins to impulses.
Mat3 of_spin(const Mat3& k, const Vec3& r) { return {cross(r, k.r0), cross(r, k.r1), cross(r, k.r2)}; }

void add_part(Block<6>& out, std::size_t row, std::size_t column, double sign, const Mat3& k) {
  double* m = &out.m[6 * row + column];
  m[0] += sign * k.r0.x;
  m[1] += sign * k.r0.y;
  m[2] += sign * k.r0.z;
  m[6] += sign * k.r1.x;
  m[7] += sign * k.r1.y;
  m[8] += sign * k.r1.z;
  m[12] += sign * k.r2.x;
  m[13] += sign * k.r2.y;
  m[14] += sign * k.r2.z;
}

// Adds J^T k J: `k_spin` is k with the arm of the column's brick, `arm` that of the row's.
void couple(Block<6>& out, double sign, const Mat3& k, const Mat3& k_spin, const Vec3& arm) {
  add_part(out, 0, 0, sign, k);
  add_part(out, 0, 3, sign, k_spin);
  add_part(out, 3, 0, sign, turned_by(arm, k));
  add_part(out, 3, 3, sign, turned_by(arm, k_spin));
}

void add_outer(Mat3& out, double scale, const Vec3& column, const Vec3& row) {
  out.r0 = out.r0 + (scale * column.x) * row;
  out.r1 = out.r1 + (scale * column.y) * row;
  out.r2 = out.r2 + (scale * column.z) * row;
}

}  // namespace

void ChainSolver::begin(std::span<const Body> bodies, std::span<const ContactRow> rows, std::span<const Twist> guess) {
  order_.find(rows, bodies);
  matrix_.shape(order_.first());
  const std::size_t count = order_.bodies().size();
  right_.resize(count);
  velocity_.resize(count);
  most_wrong_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Body& body = bodies[static_cast<std::size_t>(order_.bodies()[i])];
    const double mass = 1.0 / body.inverse_mass;
    const Mat3 inertia = conjugated(body.axes, body.inertia);
    Block<6>& block = matrix_.diagonal(i);
    block.m[0] = block.m[7] = block.m[14] = mass;
    add_part(block, 3, 3, 1.0, inertia);
    const Vec3 p = mass * body.velocity, l = inertia * body.angular_velocity;
    right_[i] = {p.x, p.y, p.z, l.x, l.y, l.z};
  }
  assumed_.resize(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& row = rows[k];
    Assumed& as = assumed_[k];
    as = {};
    as.state = row.state;
    if (!as.state.slides) continue;
    // Where it slides now tells which way; if that is too slow to tell, the friction that it had.
    Vec3 slip = row.bias + guess[static_cast<std::size_t>(row.a)].velocity + cross(guess[static_cast<std::size_t>(row.a)].spin, row.arm_a);
    if (row.b != kFloor) {
      const Twist& b = guess[static_cast<std::size_t>(row.b)];
      slip = slip - b.velocity - cross(b.spin, row.arm_b);
    }
    slip = slip - dot(slip, row.normal) * row.normal;
    const double speed = norm(slip), limit = row.friction * (row.base + row.n);
    const bool slow = row.tangent_stiffness * speed <= limit || speed == 0.0;
    const double rubbed = norm(row.friction_impulse);
    if (slow && rubbed == 0.0) {
      as.state.slides = false;
      continue;
    }
    as.way = slow ? (-1.0 / rubbed) * row.friction_impulse : (1.0 / speed) * slip;
    as.drag = slow ? row.tangent_stiffness : limit / speed;
    as.coupled = row.n > 0.0;  // The limit of one that has just begun to touch is not known yet.
    as.limit = limit;
  }
  for (std::size_t k = 0; k < rows.size(); ++k) add(rows[k], assumed_[k], 1.0);
}

// Adds what a row does in its state, `times` over, to the system of equations: its impulse on a is -(k slip + rest).
void ChainSolver::add(const ContactRow& row, const Assumed& as, double times) {
  const bool holds = as.state.pressed || row.base > 0.0;
  if (!holds) return;
  Mat3 k{};
  Vec3 rest{};
  const double across = times * (as.state.slides ? as.drag : row.tangent_stiffness);
  k.r0.x = k.r1.y = k.r2.z = across;
  add_outer(k, -across, row.normal, row.normal);
  Vec3 pull = row.normal;
  if (as.state.slides) {
    add_outer(k, -across, as.way, as.way);
    if (as.coupled) pull = pull - row.friction * as.way;
    rest = (times * (as.coupled ? row.friction * row.base : as.limit)) * as.way;
  }
  if (as.state.pressed) add_outer(k, times * row.normal_stiffness, pull, row.normal);
  rest = rest + k * row.bias;
  const int a = order_.number(row.a), b = order_.number(row.b);
  if (a >= 0) {
    const auto i = static_cast<std::size_t>(a);
    const Mat3 k_a = of_spin(k, row.arm_a);
    couple(matrix_.diagonal(i), 1.0, k, k_a, row.arm_a);
    add_scaled(right_[i], -1.0, rest, row.arm_a);
    if (b >= 0) {
      const auto j = static_cast<std::size_t>(b);
      couple(j > i ? matrix_.lower(j, i) : matrix_.upper(j, i), -1.0, k, k_a, row.arm_b);
    }
  }
  if (b >= 0) {
    const auto j = static_cast<std::size_t>(b);
    const Mat3 k_b = of_spin(k, row.arm_b);
    couple(matrix_.diagonal(j), 1.0, k, k_b, row.arm_b);
    add_scaled(right_[j], 1.0, rest, row.arm_b);
    if (a >= 0) {
      const auto i = static_cast<std::size_t>(a);
      couple(i > j ? matrix_.lower(i, j) : matrix_.upper(i, j), -1.0, k, k_b, row.arm_a);
    }
  }
}

// Velocities that follow; bodies before `from` and all that touches them alone are as they were the last time.
bool ChainSolver::solve_system(std::size_t from) {
  if (!matrix_.factorise(from)) return false;
  matrix_.solve(right_, from, velocity_);
  double sum = 0.0;
  for (const Column<6>& v : velocity_) sum += v[0] + v[1] + v[2] + v[3] + v[4] + v[5];
  return std::isfinite(sum);
}

// The impulse that a point's assumed state gives it at this slip, and the state that it should be in: the one nearest to its impulse less
// its mass times its slip [Alart1991]. A point that hardly slides so keeps its way, and one that should not stick goes over to sliding
// softly.
void ChainSolver::settle_row(const ContactRow& row, const Vec3& slip, double tolerance, Assumed& as) {
  const double closing = -dot(slip, row.normal);
  const bool pressed = as.state.pressed ? closing >= 0.0 : closing > 0.0;
  const double mass = row.normal_mass;
  as.n = pressed ? row.normal_stiffness * closing : 0.0;
  as.wrong = 0.0;
  if (pressed != as.state.pressed) as.wrong = pressed ? closing : -row.normal_stiffness * closing / mass;
  as.turned = false;
  as.should = {pressed, false};
  as.impulse = as.n * row.normal;
  if (!pressed && row.base == 0.0) return;
  const Vec3 across = slip + closing * row.normal;
  const double limit = row.friction * (row.base + as.n);
  Vec3 friction = -row.tangent_stiffness * across;
  if (as.state.slides) friction = -(as.coupled ? limit : as.limit) * as.way - as.drag * (across - dot(across, as.way) * as.way);
  const double speed = norm(across);
  const bool beyond = row.tangent_stiffness * speed > limit;
  const bool back = as.state.slides && dot(across, as.way) < 0.0;
  // What slides goes on sliding, however slowly, until it would slide back.
  as.should.slides = (beyond || (as.state.slides && speed > 0.0)) && !back;
  if (as.should.slides) {
    const Vec3 pull = friction - row.mass * across;
    const double size = norm(pull);
    as.should_limit = as.state.pressed ? limit : row.friction * (row.base + row.normal_mass * std::max(closing, 0.0));
    as.should_way = (-1.0 / size) * pull;
    as.should_drag = std::min(as.should_limit / speed, row.tangent_stiffness);
  }
  if (as.should.slides != as.state.slides) {
    as.wrong = std::max(as.wrong, as.state.slides ? speed : (row.tangent_stiffness * speed - limit) / row.mass);
  } else if (as.should.slides) {
    const Vec3 truly = (-limit / speed) * across;
    as.turned = beyond && norm(truly - friction) > tolerance * row.mass;
  }
  as.impulse = as.impulse + friction;
}

// Impulses that follow from how the points slip, the states that they should be in, and by how much the assumed ones are wrong. Returns
// whether they are right.
bool ChainSolver::settle(std::span<const ContactRow> rows, double tolerance) {
  std::fill(most_wrong_.begin(), most_wrong_.end(), 0.0);
  bool settled = true;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& row = rows[k];
    Assumed& as = assumed_[k];
    const int a = order_.number(row.a), b = order_.number(row.b);
    Vec3 slip = row.bias;
    if (a >= 0) {
      const Column<6>& v = velocity_[static_cast<std::size_t>(a)];
      slip = slip + linear(v) + cross(angular(v), row.arm_a);
    }
    if (b >= 0) {
      const Column<6>& v = velocity_[static_cast<std::size_t>(b)];
      slip = slip - linear(v) - cross(angular(v), row.arm_b);
    }
    settle_row(row, slip, tolerance, as);
    if (as.wrong == 0.0 && !as.turned) continue;
    settled = false;
    if (a >= 0) most_wrong_[static_cast<std::size_t>(a)] = std::max(most_wrong_[static_cast<std::size_t>(a)], as.wrong);
    if (b >= 0) most_wrong_[static_cast<std::size_t>(b)] = std::max(most_wrong_[static_cast<std::size_t>(b)], as.wrong);
  }
  return settled;
}

// Changes the states that are wrong by more than others near them (all at once they would overshoot), and the ways that have turned.
// Returns the first body of which the equations have changed.
std::size_t ChainSolver::change(std::span<const ContactRow> rows) {
  const int count = static_cast<int>(most_wrong_.size());
  std::size_t from = most_wrong_.size();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& row = rows[k];
    Assumed& as = assumed_[k];
    if (as.wrong == 0.0 && !as.turned) continue;
    const int a = order_.number(row.a), b = order_.number(row.b);
    const int low = a < 0 ? b : b < 0 ? a : std::min(a, b), high = std::max(a, b);
    if (as.wrong > 0.0) {
      double most = 0.0;
      for (int i = std::max(low - kNear, 0); i <= std::min(high + kNear, count - 1); ++i) {
        most = std::max(most, most_wrong_[static_cast<std::size_t>(i)]);
      }
      if (as.wrong < kWorst * most) continue;
    }
    add(row, as, -1.0);
    as.coupled = as.state.slides && as.should.slides && as.wrong == 0.0 && dot(as.way, as.should_way) > 0.0;
    as.limit = as.should_limit;
    as.state = as.should;
    as.way = as.should_way;
    as.drag = as.should_drag;
    add(row, as, 1.0);
    from = std::min(from, static_cast<std::size_t>(low));
  }
  return from;
}

bool ChainSolver::solve(std::span<Body> bodies, std::span<ContactRow> rows, std::span<const Twist> guess, double tolerance) {
  begin(bodies, rows, guess);
  std::size_t from = 0;
  bool settled = false;
  double least = 1e300;
  const int most = kIterations + kPerBody * static_cast<int>(order_.bodies().size());
  for (int i = 0; i < most; ++i) {
    if (!solve_system(from)) return false;
    settled = settle(rows, tolerance);
    if (settled) break;
    double score = 0.0;
    for (const double wrong : most_wrong_) score = std::max(score, wrong);
    if (score <= least) {
      least = score;
      best_.resize(rows.size());
      for (std::size_t k = 0; k < rows.size(); ++k) {
        const Assumed& as = assumed_[k];
        best_[k] = as.wrong == 0.0 ? Impulse{as.n, as.impulse - as.n * rows[k].normal} : Impulse{rows[k].n, rows[k].friction_impulse};
      }
    }
    from = change(rows);
  }
  if (!settled) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      rows[k].n = best_[k].n;
      rows[k].friction_impulse = best_[k].friction;
    }
    return false;
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].state = assumed_[k].state;
    rows[k].n = assumed_[k].n;
    rows[k].friction_impulse = assumed_[k].impulse - assumed_[k].n * rows[k].normal;
  }
  for (std::size_t i = 0; i < velocity_.size(); ++i) {
    Body& body = bodies[static_cast<std::size_t>(order_.bodies()[i])];
    body.velocity = linear(velocity_[i]);
    body.angular_velocity = angular(velocity_[i]);
  }
  return true;
}

}  // namespace topple::rigid

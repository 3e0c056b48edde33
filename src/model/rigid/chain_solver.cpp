#include "model/rigid/chain_solver.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

namespace {

constexpr double kWorst = 0.7;  // States that are wrong by this share of the worst of their bodies change together.
// The way that a point slides may be wrong by so many tolerances: it is found anew in the next solution.
constexpr double kTurned = 30.0;

// Adds to block and right-hand side what the impulses k slip + rest of a point, by rows of the slip of one body, do to another.
void add_outer(Block<6>& out, const std::array<Velocity, 3>& of, const std::array<Velocity, 3>& pull) {
  double* m = out.m.data();
  for (std::size_t i = 0; i < 6; ++i, m += 6) {
    for (std::size_t j = 0; j < 6; ++j) m[j] += of[0][i] * pull[0][j] + of[1][i] * pull[1][j] + of[2][i] * pull[2][j];
  }
}

void subtract(Velocity& out, const std::array<Velocity, 3>& of, const Framed& rest) {
  for (std::size_t i = 0; i < 6; ++i) out[i] -= of[0][i] * rest[0] + of[1][i] * rest[1] + of[2][i] * rest[2];
}

}  // namespace

void ChainSolver::begin(std::span<const ContactRow> rows, std::span<const Body> bodies) {
  order_.find(rows, bodies);
  mass_.clear();
  inertia_.clear();
  for (const int number : order_.bodies()) {
    const Body& body = bodies[static_cast<std::size_t>(number)];
    mass_.push_back(1.0 / body.inverse_mass);
    inertia_.push_back(conjugated(body.axes, body.inertia));
  }
  right_.resize(mass_.size());
  velocity_.resize(mass_.size());
  most_wrong_.resize(mass_.size());
}

// Where a point slides now tells which way; if that is too slow to tell, the friction that it had.
void ChainSolver::assume(std::span<const ContactRow> rows, std::span<const Velocity> guess) {
  assumed_.resize(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& row = rows[k];
    Assumed& as = assumed_[k];
    as = {};
    as.a = order_.number(row.a);
    as.b = order_.number(row.b);
    as.state = row.state;
    if (!as.state.slides) continue;
    const Velocity& a = guess[static_cast<std::size_t>(row.a)];
    double along = row.bias[1] + product_of(row.of_a[1], a), across = row.bias[2] + product_of(row.of_a[2], a);
    if (row.b != kFloor) {
      const Velocity& b = guess[static_cast<std::size_t>(row.b)];
      along += product_of(row.of_b[1], b);
      across += product_of(row.of_b[2], b);
    }
    const double speed = std::sqrt(along * along + across * across), limit = row.friction * (row.base + row.impulse[0]);
    const bool slow = row.tangent_stiffness * speed <= limit || speed == 0.0;
    const double rubbed = std::sqrt(row.impulse[1] * row.impulse[1] + row.impulse[2] * row.impulse[2]);
    if (slow && rubbed == 0.0) {
      as.state.slides = false;
      continue;
    }
    as.way_along = slow ? -row.impulse[1] / rubbed : along / speed;
    as.way_across = slow ? -row.impulse[2] / rubbed : across / speed;
    as.drag = slow ? row.tangent_stiffness : limit / speed;
    as.coupled = row.impulse[0] > 0.0;  // The limit of one that has just begun to touch is not known yet.
    as.limit = limit;
  }
}

void ChainSolver::assemble(std::span<const ContactRow> rows, std::span<const Velocity> free) {
  matrix_.shape(order_.first());
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    const double mass = mass_[i];
    const Mat3& inertia = inertia_[i];
    auto& m = matrix_.diagonal(i).m;
    m[0] = m[7] = m[14] = mass;
    m[21] = inertia.r0.x;
    m[22] = m[27] = inertia.r0.y;
    m[23] = m[33] = inertia.r0.z;
    m[28] = inertia.r1.y;
    m[29] = m[34] = inertia.r1.z;
    m[35] = inertia.r2.z;
    const Velocity& v = free[static_cast<std::size_t>(order_.bodies()[i])];
    const Vec3 l = inertia * Vec3{v[3], v[4], v[5]};
    right_[i] = {mass * v[0], mass * v[1], mass * v[2], l.x, l.y, l.z};
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    assumed_[k].law = law_of(rows[k], assumed_[k]);
    add(rows[k], assumed_[k], assumed_[k].law);
  }
}

ChainSolver::Law ChainSolver::law_of(const ContactRow& row, const Assumed& as) {
  Law law;
  if (!as.state.pressed && row.base == 0.0) return law;
  law.nn = as.state.pressed ? row.normal_stiffness : 0.0;
  if (!as.state.slides) {
    law.aa = law.cc = row.tangent_stiffness;
    return law;
  }
  law.aa = as.drag * (1.0 - as.way_along * as.way_along);
  law.ac = -as.drag * as.way_along * as.way_across;
  law.cc = as.drag * (1.0 - as.way_across * as.way_across);
  const double pull = as.coupled ? -row.friction * law.nn : 0.0;
  law.an = pull * as.way_along;
  law.cn = pull * as.way_across;
  const double rest = as.coupled ? row.friction * row.base : as.limit;
  law.rest_along = rest * as.way_along;
  law.rest_across = rest * as.way_across;
  return law;
}

// Adds a law, or the difference of two, to the system of equations.
void ChainSolver::add(const ContactRow& row, const Assumed& as, const Law& law) {
  const auto pull_of = [&law](const std::array<Velocity, 3>& of) {
    std::array<Velocity, 3> pull;
    for (std::size_t j = 0; j < 6; ++j) {
      pull[0][j] = law.nn * of[0][j];
      pull[1][j] = law.an * of[0][j] + law.aa * of[1][j] + law.ac * of[2][j];
      pull[2][j] = law.cn * of[0][j] + law.ac * of[1][j] + law.cc * of[2][j];
    }
    return pull;
  };
  const Framed rest{law.nn * row.bias[0], law.rest_along + law.an * row.bias[0] + law.aa * row.bias[1] + law.ac * row.bias[2],
                    law.rest_across + law.cn * row.bias[0] + law.ac * row.bias[1] + law.cc * row.bias[2]};
  const auto i = static_cast<std::size_t>(as.a), j = static_cast<std::size_t>(as.b);
  if (as.a >= 0) {
    const std::array<Velocity, 3> pull = pull_of(row.of_a);
    add_outer(matrix_.diagonal(i), row.of_a, pull);
    subtract(right_[i], row.of_a, rest);
    if (as.b >= 0) add_outer(j > i ? matrix_.lower(j, i) : matrix_.upper(j, i), row.of_b, pull);
  }
  if (as.b >= 0) {
    const std::array<Velocity, 3> pull = pull_of(row.of_b);
    add_outer(matrix_.diagonal(j), row.of_b, pull);
    subtract(right_[j], row.of_b, rest);
    if (as.a >= 0) add_outer(i > j ? matrix_.lower(i, j) : matrix_.upper(i, j), row.of_a, pull);
  }
}

// Velocities that follow; bodies before `from` and all that touches them alone are as they were the last time.
bool ChainSolver::solve_system(std::size_t from) {
  if (!matrix_.factorise(from)) return false;
  matrix_.solve(right_, from, velocity_);
  double sum = 0.0;
  for (const Velocity& v : velocity_) sum += v[0] + v[1] + v[2] + v[3] + v[4] + v[5];
  return std::isfinite(sum);
}

// The impulse that a point's assumed state gives it at this slip, and the state that it should be in: the one nearest to its impulse less
// its mass times its slip [Alart1991]. A point that hardly slides so keeps its way, and one that should not stick goes over to sliding
// softly.
void ChainSolver::settle_row(const ContactRow& row, const Framed& slip, double tolerance, Assumed& as) {
  const double closing = -slip[0], along = slip[1], across = slip[2];
  const bool pressed = as.state.pressed ? closing >= 0.0 : closing > 0.0;
  const double n = pressed ? row.normal_stiffness * closing : 0.0;
  as.wrong = 0.0;
  if (pressed != as.state.pressed) as.wrong = pressed ? closing : -row.normal_stiffness * closing / row.normal_mass;
  as.turned = false;
  as.should = {pressed, false};
  as.impulse = {n, 0.0, 0.0};
  if (!pressed && row.base == 0.0) return;
  const double limit = row.friction * (row.base + n);
  const double forward = along * as.way_along + across * as.way_across;
  if (as.state.slides) {
    const double rubs = as.coupled ? limit : as.limit;
    as.impulse[1] = -rubs * as.way_along - as.drag * (along - forward * as.way_along);
    as.impulse[2] = -rubs * as.way_across - as.drag * (across - forward * as.way_across);
  } else {
    as.impulse[1] = -row.tangent_stiffness * along;
    as.impulse[2] = -row.tangent_stiffness * across;
  }
  const double speed = std::sqrt(along * along + across * across);
  const bool beyond = row.tangent_stiffness * speed > limit;
  const bool back = as.state.slides && forward < 0.0;
  // What slides goes on sliding, however slowly, until it would slide back.
  as.should.slides = (beyond || (as.state.slides && speed > 0.0)) && !back;
  if (as.should.slides) {
    const double pull_along = as.impulse[1] - row.mass * along, pull_across = as.impulse[2] - row.mass * across;
    const double size = std::sqrt(pull_along * pull_along + pull_across * pull_across);
    as.should_limit = as.state.pressed ? limit : row.friction * (row.base + row.normal_mass * std::max(closing, 0.0));
    as.should_along = -pull_along / size;
    as.should_across = -pull_across / size;
    as.should_drag = std::min(as.should_limit / speed, row.tangent_stiffness);
  }
  if (as.should.slides != as.state.slides) {
    as.wrong = std::max(as.wrong, as.state.slides ? speed : (row.tangent_stiffness * speed - limit) / row.mass);
  } else if (as.should.slides && beyond) {
    const double off_along = -limit / speed * along - as.impulse[1], off_across = -limit / speed * across - as.impulse[2];
    const double allowed = kTurned * tolerance * row.mass;
    as.turned = off_along * off_along + off_across * off_across > allowed * allowed;
  }
}

// Impulses that follow from how the points slip, the states that they should be in, and by how much the assumed ones are wrong. Returns
// whether they are right.
bool ChainSolver::settle(std::span<const ContactRow> rows, double tolerance) {
  std::fill(most_wrong_.begin(), most_wrong_.end(), 0.0);
  bool settled = true;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& row = rows[k];
    Assumed& as = assumed_[k];
    Framed slip = row.bias;
    if (as.a >= 0) {
      const Velocity& v = velocity_[static_cast<std::size_t>(as.a)];
      for (std::size_t i = 0; i < 3; ++i) slip[i] += product_of(row.of_a[i], v);
    }
    if (as.b >= 0) {
      const Velocity& v = velocity_[static_cast<std::size_t>(as.b)];
      for (std::size_t i = 0; i < 3; ++i) slip[i] += product_of(row.of_b[i], v);
    }
    settle_row(row, slip, tolerance, as);
    if (as.wrong == 0.0 && !as.turned) continue;
    settled = false;
    if (as.a >= 0) most_wrong_[static_cast<std::size_t>(as.a)] = std::max(most_wrong_[static_cast<std::size_t>(as.a)], as.wrong);
    if (as.b >= 0) most_wrong_[static_cast<std::size_t>(as.b)] = std::max(most_wrong_[static_cast<std::size_t>(as.b)], as.wrong);
  }
  return settled;
}

void ChainSolver::keep_best(std::span<const ContactRow> rows) {
  double wrong = 0.0;
  for (const double most : most_wrong_) wrong = std::max(wrong, most);
  if (wrong > least_wrong_) return;
  least_wrong_ = wrong;
  best_.resize(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) best_[k] = assumed_[k].wrong == 0.0 ? assumed_[k].impulse : rows[k].impulse;
}

// Changes the states that are wrong by more than others of their bodies (all at once they would overshoot), and the ways that have turned.
// Returns the first body of which the equations have changed.
std::size_t ChainSolver::change(std::span<const ContactRow> rows) {
  std::size_t from = most_wrong_.size();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& row = rows[k];
    Assumed& as = assumed_[k];
    if (as.wrong == 0.0 && !as.turned) continue;
    if (as.wrong > 0.0) {
      const auto most = [this](int number) { return number < 0 ? 0.0 : most_wrong_[static_cast<std::size_t>(number)]; };
      if (as.wrong < kWorst * std::max(most(as.a), most(as.b))) continue;
    }
    as.coupled =
        as.state.slides && as.should.slides && as.wrong == 0.0 && as.way_along * as.should_along + as.way_across * as.should_across > 0.0;
    as.limit = as.should_limit;
    as.state = as.should;
    as.way_along = as.should_along;
    as.way_across = as.should_across;
    as.drag = as.should_drag;
    const Law before = as.law;
    as.law = law_of(row, as);
    add(row, as,
        {as.law.nn - before.nn, as.law.an - before.an, as.law.cn - before.cn, as.law.aa - before.aa, as.law.ac - before.ac,
         as.law.cc - before.cc, as.law.rest_along - before.rest_along, as.law.rest_across - before.rest_across});
    const int low = as.a < 0 ? as.b : as.b < 0 ? as.a : std::min(as.a, as.b);
    from = std::min(from, static_cast<std::size_t>(low));
  }
  return from;
}

bool ChainSolver::solve(std::span<ContactRow> rows, std::span<const Velocity> guess, double tolerance, int most,
                        std::span<Velocity> velocity) {
  assume(rows, guess);
  assemble(rows, velocity);
  least_wrong_ = 1e300;
  best_.clear();
  std::size_t from = 0;
  bool settled = false;
  for (int i = 0; i < most && !settled; ++i) {
    if (!solve_system(from)) return false;
    settled = settle(rows, tolerance);
    if (settled) break;
    keep_best(rows);
    from = change(rows);
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].impulse = settled ? assumed_[k].impulse : best_[k];
    if (settled) rows[k].state = assumed_[k].state;
  }
  if (!settled) return false;
  for (std::size_t i = 0; i < velocity_.size(); ++i) velocity[static_cast<std::size_t>(order_.bodies()[i])] = velocity_[i];
  return true;
}

}  // namespace topple::rigid

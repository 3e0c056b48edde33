#include "model/rigid/chain_solver.h"

#include <algorithm>
#include <cmath>

#include "model/rigid/point_motion.h"

namespace topple::rigid {

namespace {

constexpr double kWorst = 0.8;  // States that are wrong by this share of the worst of their bodies change together.
// The way that a point slides may be wrong by so many tolerances: it is found anew in the next solution.
constexpr double kTurned = 30.0;

double* six_by_six(std::span<Velocity> velocity) { return velocity.empty() ? nullptr : velocity.front().data(); }

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
  ends_.resize(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& row = rows[k];
    Assumed& as = assumed_[k];
    as = {};
    const auto [a, b] = ends_[k] = {order_.number(row.a), order_.number(row.b)};
    if (a >= 0 && b >= 0) as.entry = matrix_.entry(std::max(a, b), std::min(a, b));
    as.state = row.state;
    if (!as.state.slides) continue;
    std::array<double, 3> slip{};
    const auto of = [&guess](int body) { return body == kFloor ? nullptr : guess[static_cast<std::size_t>(body)].data(); };
    slip_of<2>(row, of(row.a), of(row.b), slip.data());
    const auto [normal, along, across] = slip;
    const double speed = std::sqrt(along * along + across * across), limit = row.friction * (row.base + row.impulse[0]);
    const bool slow = row.tangent_stiffness * speed <= limit || speed == 0.0;
    const double rubbed = slow ? std::sqrt(row.impulse[1] * row.impulse[1] + row.impulse[2] * row.impulse[2]) : 0.0;
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
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    const double mass = mass_[i];
    const Mat3& inertia = inertia_[i];
    BrickBlock& m = matrix_.diagonal(static_cast<int>(i));
    m = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& turning = k == 0 ? inertia.r0 : k == 1 ? inertia.r1 : inertia.r2;
      m.low[k][k] = mass;
      m.low[k + 3][3] = turning.x;
      m.high[k + 3][0] = turning.y;
      m.high[k + 3][1] = turning.z;
    }
    const Velocity& v = free[static_cast<std::size_t>(order_.bodies()[i])];
    const Vec3 l = inertia * Vec3{v[3], v[4], v[5]};
    right_[i] = {mass * v[0], mass * v[1], mass * v[2], l.x, l.y, l.z};
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    assumed_[k].law = law_of(rows[k], assumed_[k]);
    add(k, rows[k], assumed_[k].law);
  }
}

PointLaw ChainSolver::law_of(const ContactRow& row, const Assumed& as) {
  PointLaw law;
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
void ChainSolver::add(std::size_t k, const ContactRow& row, const PointLaw& law) {
  const auto [a, b] = ends_[k];
  PointEquations to;
  if (a >= 0) {
    matrix_.touch(a);
    to.own_a = &matrix_.diagonal(a);
    to.right_a = right_[static_cast<std::size_t>(a)].data();
  }
  if (b >= 0) {
    matrix_.touch(b);
    to.own_b = &matrix_.diagonal(b);
    to.right_b = right_[static_cast<std::size_t>(b)].data();
  }
  if (a >= 0 && b >= 0) {
    const std::size_t entry = assumed_[k].entry;
    to.a_by_b = a > b ? &matrix_.lower(entry) : &matrix_.upper(entry);
    to.b_by_a = a > b ? &matrix_.upper(entry) : &matrix_.lower(entry);
  }
  kernels_.add_law(row, law, to);
}

// Velocities that follow.
bool ChainSolver::solve_system() {
  if (!matrix_.solve(kernels_, right_, velocity_)) return false;
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
  // Of an open point it is not known how hard it will be pressed, but that its own mass has to be stopped.
  const bool open = !as.state.pressed;
  as.should_limit = open ? row.friction * (row.base + row.normal_mass * std::max(closing, 0.0)) : limit;
  const bool beyond = (open ? row.mass : row.tangent_stiffness) * speed > as.should_limit;
  const bool back = as.state.slides && forward < 0.0;
  // What slides goes on sliding, however slowly, until it would slide back; and what would have been pulled when it stuck slides.
  as.should.slides = (beyond || ((as.state.slides || (as.pulled && open)) && speed > 0.0)) && !back;
  if (as.should.slides != as.state.slides) {
    as.wrong = std::max(as.wrong, as.state.slides ? speed : (row.tangent_stiffness * speed - limit) / row.mass);
  } else if (as.should.slides && beyond) {
    const double off_along = limit * along + speed * as.impulse[1], off_across = limit * across + speed * as.impulse[2];
    const double allowed = kTurned * tolerance * row.mass * speed;
    as.turned = off_along * off_along + off_across * off_across > allowed * allowed;
  }
  if (!as.should.slides || (as.wrong == 0.0 && !as.turned)) return;
  const double pull_along = as.impulse[1] - row.mass * along, pull_across = as.impulse[2] - row.mass * across;
  const double size = std::sqrt(pull_along * pull_along + pull_across * pull_across);
  as.should_along = -pull_along / size;
  as.should_across = -pull_across / size;
  as.should_drag = std::min(as.should_limit / speed, row.tangent_stiffness);
}

// Impulses that follow from how the points slip, the states that they should be in, and by how much the assumed ones are wrong. Returns
// whether they are right.
bool ChainSolver::settle(std::span<const ContactRow> rows, double tolerance) {
  std::fill(most_wrong_.begin(), most_wrong_.end(), 0.0);
  bool settled = true;
  slips_.resize(rows.size());
  kernels_.slips(rows.data(), ends_.data(), rows.size(), six_by_six(velocity_), slips_.empty() ? nullptr : slips_.front().data());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& row = rows[k];
    Assumed& as = assumed_[k];
    settle_row(row, slips_[k], tolerance, as);
    if (as.wrong == 0.0 && !as.turned) continue;
    settled = false;
    for (const int number : {ends_[k].a, ends_[k].b}) {
      if (number >= 0) most_wrong_[static_cast<std::size_t>(number)] = std::max(most_wrong_[static_cast<std::size_t>(number)], as.wrong);
    }
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
void ChainSolver::change(std::span<const ContactRow> rows) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& row = rows[k];
    Assumed& as = assumed_[k];
    if (as.wrong == 0.0 && !as.turned) continue;
    if (as.wrong > 0.0) {
      const auto most = [this](int number) { return number < 0 ? 0.0 : most_wrong_[static_cast<std::size_t>(number)]; };
      if (as.wrong < kWorst * std::max(most(ends_[k].a), most(ends_[k].b))) continue;
      as.pulled = as.pulled || (as.state.pressed && !as.state.slides && !as.should.pressed);
    }
    as.coupled =
        as.state.slides && as.should.slides && as.wrong == 0.0 && as.way_along * as.should_along + as.way_across * as.should_across > 0.0;
    as.limit = as.should_limit;
    as.state = as.should;
    as.way_along = as.should_along;
    as.way_across = as.should_across;
    as.drag = as.should_drag;
    const PointLaw before = as.law;
    as.law = law_of(row, as);
    add(k, row,
        {as.law.nn - before.nn, as.law.an - before.an, as.law.cn - before.cn, as.law.aa - before.aa, as.law.ac - before.ac,
         as.law.cc - before.cc, as.law.rest_along - before.rest_along, as.law.rest_across - before.rest_across});
  }
}

bool ChainSolver::solve(std::span<ContactRow> rows, std::span<const Velocity> guess, double tolerance, int most,
                        std::span<Velocity> velocity) {
  matrix_.shape(order_);
  assume(rows, guess);
  assemble(rows, velocity);
  least_wrong_ = 1e300;
  best_.clear();
  bool settled = false;
  for (int i = 0; i < most && !settled; ++i) {
    if (!solve_system()) return false;
    settled = settle(rows, tolerance);
    if (settled) break;
    keep_best(rows);
    change(rows);
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

#include "model/rigid/chain_solver.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

namespace {

constexpr double kWorst = 0.8;  // States that are wrong by this share of the worst of their bodies change together.
// The way that a point slides may be wrong by so many tolerances: it is found anew in the next solution.
constexpr double kTurned = 30.0;

// Three rows of six: what an impulse along x, y, z is, by the velocities of a brick.
using WideRows = std::array<Wide, 3>;

// The columns of a brick whose point lies at `arm`, from the three of the point.
WideRows with_arm(const std::array<Vec3, 3>& stiffness, const Vec3& arm) {
  WideRows out;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& k = stiffness[i];
    const Vec3 turning = cross(arm, k);
    out[i] = {Two{k.x, k.y}, Two{k.z, turning.x}, Two{turning.y, turning.z}};
  }
  return out;
}

// Adds the rows of a brick whose point lies at `arm`; or takes them off.
template <bool kAdd>
void put(BrickBlock& block, const WideRows& rows, const Vec3& arm) {
  const Two x{arm.x, arm.x}, y{arm.y, arm.y}, z{arm.z, arm.z};
  for (std::size_t k = 0; k < 3; ++k) {
    const Two about_x = y * rows[2][k] - z * rows[1][k], about_y = z * rows[0][k] - x * rows[2][k],
              about_z = x * rows[1][k] - y * rows[0][k];
    if constexpr (kAdd) {
      block.row[0][k] += rows[0][k];
      block.row[1][k] += rows[1][k];
      block.row[2][k] += rows[2][k];
      block.row[3][k] += about_x;
      block.row[4][k] += about_y;
      block.row[5][k] += about_z;
    } else {
      block.row[0][k] -= rows[0][k];
      block.row[1][k] -= rows[1][k];
      block.row[2][k] -= rows[2][k];
      block.row[3][k] -= about_x;
      block.row[4][k] -= about_y;
      block.row[5][k] -= about_z;
    }
  }
}

void add_impulse(Velocity& right, const Vec3& impulse, const Vec3& arm) {
  const Vec3 turning = cross(arm, impulse);
  right = {right[0] + impulse.x, right[1] + impulse.y, right[2] + impulse.z,
           right[3] + turning.x, right[4] + turning.y, right[5] + turning.z};
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
    if (as.a >= 0 && as.b >= 0) as.entry = matrix_.entry(std::max(as.a, as.b), std::min(as.a, as.b));
    as.state = row.state;
    if (!as.state.slides) continue;
    const auto [normal, along, across] = slip_of(row, guess);
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
    m.row[0] = {Two{mass, 0.0}, Two{}, Two{}};
    m.row[1] = {Two{0.0, mass}, Two{}, Two{}};
    m.row[2] = {Two{}, Two{mass, 0.0}, Two{}};
    m.row[3] = {Two{}, Two{0.0, inertia.r0.x}, Two{inertia.r0.y, inertia.r0.z}};
    m.row[4] = {Two{}, Two{0.0, inertia.r1.x}, Two{inertia.r1.y, inertia.r1.z}};
    m.row[5] = {Two{}, Two{0.0, inertia.r2.x}, Two{inertia.r2.y, inertia.r2.z}};
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
  const Vec3 &n = row.normal, &s = row.along, &t = row.across;
  // By the slip along n, s and t.
  const Vec3 by_n = law.nn * n + law.an * s + law.cn * t, by_s = law.aa * s + law.ac * t, by_t = law.ac * s + law.cc * t;
  const std::array<Vec3, 3> stiffness{by_n.x * n + by_s.x * s + by_t.x * t, by_n.y * n + by_s.y * s + by_t.y * t,
                                      by_n.z * n + by_s.z * s + by_t.z * t};
  const Vec3 rest = row.bias[0] * by_n + row.bias[1] * by_s + row.bias[2] * by_t + law.rest_along * s + law.rest_across * t;
  WideRows of_a, of_b;
  if (as.a >= 0) {
    matrix_.touch(as.a);
    of_a = with_arm(stiffness, row.arm_a);
    put<true>(matrix_.diagonal(as.a), of_a, row.arm_a);
    add_impulse(right_[static_cast<std::size_t>(as.a)], -rest, row.arm_a);
  }
  if (as.b < 0) return;
  matrix_.touch(as.b);
  of_b = with_arm(stiffness, row.arm_b);
  put<true>(matrix_.diagonal(as.b), of_b, row.arm_b);
  add_impulse(right_[static_cast<std::size_t>(as.b)], rest, row.arm_b);
  if (as.a < 0) return;
  put<false>(as.a > as.b ? matrix_.lower(as.entry) : matrix_.upper(as.entry), of_b, row.arm_a);
  put<false>(as.a > as.b ? matrix_.upper(as.entry) : matrix_.lower(as.entry), of_a, row.arm_b);
}

// Velocities that follow.
bool ChainSolver::solve_system() {
  if (!matrix_.solve(right_, velocity_)) return false;
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
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& row = rows[k];
    Assumed& as = assumed_[k];
    const auto of = [this](int number) { return number < 0 ? nullptr : &velocity_[static_cast<std::size_t>(number)]; };
    const Framed slip = slip_of(row, of(as.a), of(as.b));
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
void ChainSolver::change(std::span<const ContactRow> rows) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& row = rows[k];
    Assumed& as = assumed_[k];
    if (as.wrong == 0.0 && !as.turned) continue;
    if (as.wrong > 0.0) {
      const auto most = [this](int number) { return number < 0 ? 0.0 : most_wrong_[static_cast<std::size_t>(number)]; };
      if (as.wrong < kWorst * std::max(most(as.a), most(as.b))) continue;
      as.pulled = as.pulled || (as.state.pressed && !as.state.slides && !as.should.pressed);
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

#include "model/rigid/sweeps.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace topple::rigid {

namespace {

// One point: normal first, then friction with the limit that follows. Returns the largest change of its velocity.
double solve_row(ContactRow& row, std::span<Velocity> velocity) {
  const Framed slip = slip_of(row, velocity);
  const auto [old_n, old_s, old_t] = row.impulse;
  const double n = std::max(old_n - row.step_normal * (slip[0] + row.give_normal * old_n), 0.0);
  const double dn = n - old_n;
  const double vs = slip[1] + row.k_na * dn + row.give * old_s;
  const double vt = slip[2] + row.k_nc * dn + row.give * old_t;

  // Sticking if that needs no more than Coulomb allows.
  const double limit = row.friction * (row.base + n);
  double s = old_s - (row.step_aa * vs - row.step_ac * vt);
  double t = old_t - (row.step_cc * vt - row.step_ac * vs);
  if (s * s + t * t > limit * limit) {
    // Sliding: one scalar step for both directions, so that at the fixed point friction is opposite to the slip.
    s = old_s - row.step_sliding * vs;
    t = old_t - row.step_sliding * vt;
    const double size = std::sqrt(s * s + t * t);
    if (size > limit) {
      const double scale = limit / size;
      s = scale * s;
      t = scale * t;
    }
  }
  const Framed change{dn, s - old_s, t - old_t};
  row.impulse = {n, s, t};
  apply(row, change, velocity);
  return std::max(row.k_nn * std::abs(change[0]), std::max(row.k_aa * std::abs(change[1]), row.k_cc * std::abs(change[2])));
}

// The same where friction is the cone of [Anitescu2006]: the impulse is the point of the cone nearest to the one that would stop the slip,
// and sliding points part. Every such change lowers one convex sum, so none makes energy.
double solve_cone(ContactRow& row, std::span<Velocity> velocity) {
  const Framed slip = slip_of(row, velocity);
  const auto [old_n, old_s, old_t] = row.impulse;
  const double step = 1.0 / (row.k_nn + row.k_aa + row.k_cc + row.give_normal + row.give);
  const double n = old_n - step * (slip[0] + row.give_normal * old_n);
  const double s = old_s - step * (slip[1] + row.give * old_s), t = old_t - step * (slip[2] + row.give * old_t);
  const double size = std::sqrt(s * s + t * t), mu = row.friction;
  Framed found{n, s, t};
  if (size > mu * n) {
    const double along = std::max((n + mu * size) / (1.0 + mu * mu), 0.0), share = size > 0.0 ? mu * along / size : 0.0;
    found = {along, share * s, share * t};
  }
  const Framed change{found[0] - old_n, found[1] - old_s, found[2] - old_t};
  row.impulse = found;
  apply(row, change, velocity);
  return std::max(row.k_nn * std::abs(change[0]), std::max(row.k_aa * std::abs(change[1]), row.k_cc * std::abs(change[2])));
}

}  // namespace

double Sweeps::run_cones(std::span<ContactRow> rows, int most, double tolerance) {
  double change = 1e300;
  for (int i = 0; i < most && change > tolerance; ++i) {
    change = 0.0;
    const auto solve = [&](ContactRow& row) { change = std::max(change, solve_cone(row, velocity)); };
    if (i % 2 == 0) {
      std::for_each(rows.begin(), rows.end(), solve);
    } else {
      std::for_each(rows.rbegin(), rows.rend(), solve);
    }
  }
  return change;
}

void Sweeps::begin(std::span<const ContactRow> rows, std::span<const Velocity> free) {
  velocity.assign(free.begin(), free.end());
  backwards_ = false;
  order_.clear();
  for (const ContactRow& row : rows) apply(row, row.impulse, velocity);
}

// Points of a pair come in the order of what they carry; those that carry as much, in the order of how fast they
// close, then slide.
double Sweeps::first(std::span<ContactRow> rows) {
  double change = 0.0;
  const auto comes_before = [&](int l, int r) {
    const ContactRow &left = rows[static_cast<std::size_t>(l)], &right = rows[static_cast<std::size_t>(r)];
    if (left.impulse[0] != right.impulse[0]) return left.impulse[0] > right.impulse[0];
    const Framed l_slip = slip_of(left, velocity), r_slip = slip_of(right, velocity);
    if (l_slip[0] != r_slip[0]) return l_slip[0] < r_slip[0];
    return l_slip[1] * l_slip[1] + l_slip[2] * l_slip[2] > r_slip[1] * r_slip[1] + r_slip[2] * r_slip[2];
  };
  for (std::size_t begin = 0; begin < rows.size(); begin = order_.size()) {
    for (std::size_t k = begin; k < rows.size() && rows[k].a == rows[begin].a && rows[k].b == rows[begin].b; ++k) {
      order_.push_back(static_cast<int>(k));
      for (std::size_t at = k; at > begin && comes_before(order_[at], order_[at - 1]); --at) std::swap(order_[at], order_[at - 1]);
    }
    for (std::size_t at = begin; at < order_.size(); ++at) {
      change = std::max(change, solve_row(rows[static_cast<std::size_t>(order_[at])], velocity));
    }
  }
  return change;
}

double Sweeps::run(std::span<ContactRow> rows, int most, double tolerance) {
  double change = 1e300;
  for (int i = 0; i < most && change > tolerance; ++i) {
    change = 0.0;
    const auto solve = [&](int k) { change = std::max(change, solve_row(rows[static_cast<std::size_t>(k)], velocity)); };
    if (order_.empty()) {
      change = first(rows);
    } else if (backwards_) {
      std::for_each(order_.rbegin(), order_.rend(), solve);
    } else {
      std::for_each(order_.begin(), order_.end(), solve);
    }
    backwards_ = !backwards_;
  }
  return change;
}

void Sweeps::tell_states(std::span<ContactRow> rows) {
  for (ContactRow& row : rows) {
    const auto [n, s, t] = row.impulse;
    const double limit = row.friction * (row.base + n);
    row.state = {n > 0.0, s * s + t * t >= 0.999 * limit * limit};
  }
}

}  // namespace topple::rigid

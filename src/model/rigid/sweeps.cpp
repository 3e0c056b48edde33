#include "model/rigid/sweeps.h"

namespace topple::rigid {

namespace {

double* six_by_six(std::span<Velocity> velocity) { return velocity.empty() ? nullptr : velocity.front().data(); }

}  // namespace

double Sweeps::run_cones(std::span<ContactRow> rows, int most, double tolerance) {
  double change = 1e300;
  for (int i = 0; i < most && change > tolerance; ++i) {
    change = kernels_.sweep_cones(rows.data(), rows.size(), i % 2 != 0, six_by_six(velocity));
  }
  return change;
}

void Sweeps::begin(std::span<const ContactRow> rows, std::span<const Velocity> free) {
  velocity.assign(free.begin(), free.end());
  backwards_ = false;
  order_.clear();
  kernels_.apply_all(rows.data(), rows.size(), six_by_six(velocity));
}

double Sweeps::run(std::span<ContactRow> rows, int most, double tolerance) {
  double change = 1e300;
  for (int i = 0; i < most && change > tolerance; ++i) {
    if (order_.empty()) {
      order_.resize(rows.size());
      change = kernels_.first_sweep(rows.data(), order_.data(), rows.size(), six_by_six(velocity));
    } else {
      change = kernels_.sweep(rows.data(), order_.data(), rows.size(), backwards_, six_by_six(velocity));
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

/// What a contact point is to the velocities of its bricks and to their equations, in lanes.
#pragma once

#include "model/rigid/brick_lanes.h"
#include "model/rigid/point_law.h"
#include "model/rigid/point_motion.h"

namespace topple::rigid {

template <int L>
struct PointLanes {
  /// Of each row, its slip along its directions: three numbers. Velocities come six by six; ends are their numbers.
  static void slips(const ContactRow* rows, const PointEnds* ends, std::size_t count, const double* velocity, double* slip) {
    static constexpr double kStill[6] = {};
    for (std::size_t k = 0; k < count; ++k) {
      const double* a = ends[k].a < 0 ? kStill : velocity + std::ptrdiff_t{6} * ends[k].a;
      const double* b = ends[k].b < 0 ? nullptr : velocity + std::ptrdiff_t{6} * ends[k].b;
      slip_of<L>(rows[k], a, b, slip + 3 * k);
    }
  }

  /// Adds what a point does in its state, or the change of that, to the equations of its bricks.
  static void add_law(const ContactRow& row, const PointLaw& law, const PointEquations& to) {
    const double *bias = numbers<L>(row.bias), *arm_a = numbers<L>(row.arm_a), *arm_b = numbers<L>(row.arm_b);
    const Three<L> n = Three<L>::load(numbers<L>(row.normal)), s = Three<L>::load(numbers<L>(row.along)),
                   t = Three<L>::load(numbers<L>(row.across));
    // By the slip along n, s and t.
    const Three<L> by_n = law.nn * n + law.an * s + law.cn * t, by_s = law.aa * s + law.ac * t, by_t = law.ac * s + law.cc * t;
    Three<L> stiffness[3];
    for (std::size_t i = 0; i < 3; ++i) stiffness[i] = by_n.at(i) * n + by_s.at(i) * s + by_t.at(i) * t;
    const Three<L> rest = bias[0] * by_n + bias[1] * by_s + bias[2] * by_t + law.rest_along * s + law.rest_across * t;
    Six<L> of_a[3], of_b[3];
    if (to.own_a != nullptr) {
      with_arm(stiffness, arm_a, of_a);
      put<true>(*to.own_a, of_a, arm_a);
      add_impulse(to.right_a, -rest, arm_a);
    }
    if (to.own_b == nullptr) return;
    with_arm(stiffness, arm_b, of_b);
    put<true>(*to.own_b, of_b, arm_b);
    add_impulse(to.right_b, rest, arm_b);
    if (to.own_a == nullptr) return;
    put<false>(*to.a_by_b, of_b, arm_a);
    put<false>(*to.b_by_a, of_a, arm_b);
  }

 private:
  // The columns of a brick whose point lies at `arm`, from the three of the point.
  static void with_arm(const Three<L>* stiffness, const double* arm, Six<L>* out) {
    const Three<L> r = Three<L>::load(arm);
    for (std::size_t i = 0; i < 3; ++i) out[i] = joined(stiffness[i], cross(r, stiffness[i]));
  }

  // Adds the rows of a brick whose point lies at `arm`; or takes them off.
  template <bool kAdd>
  static void put(BrickBlock& block, const Six<L>* rows, const double* arm) {
    const Register<L> x = all<L>(arm[0]), y = all<L>(arm[1]), z = all<L>(arm[2]);
    const Six<L> about[3] = {y * rows[2] - z * rows[1], z * rows[0] - x * rows[2], x * rows[1] - y * rows[0]};
    for (std::size_t i = 0; i < 3; ++i) {
      if constexpr (kAdd) {
        set_row<L>(block, i, row_of<L>(block, i) + rows[i]);
        set_row<L>(block, i + 3, row_of<L>(block, i + 3) + about[i]);
      } else {
        set_row<L>(block, i, row_of<L>(block, i) - rows[i]);
        set_row<L>(block, i + 3, row_of<L>(block, i + 3) - about[i]);
      }
    }
  }

  static void add_impulse(double* right, const Three<L>& impulse, const double* arm) {
    (Six<L>::load(right) + joined(impulse, cross(Three<L>::load(arm), impulse))).store(right);
  }
};

/// What a point's impulses do to one of its bricks.
template <int L>
struct CouplingLanes {
  /// set_couplings() but for what follows from the couplings.
  static void couple(ContactRow& row, const Body& a, const Body* b) {
    couple(row, a, numbers<L>(row.arm_a), 1.0, 0);
    if (b != nullptr) couple(row, *b, numbers<L>(row.arm_b), -1.0, 2);
    row.k_nn = response(row, b != nullptr, 0, 0);
    row.k_na = response(row, b != nullptr, 1, 0);
    row.k_nc = response(row, b != nullptr, 2, 0);
    row.k_aa = response(row, b != nullptr, 1, 1);
    row.k_ac = response(row, b != nullptr, 2, 1);
    row.k_cc = response(row, b != nullptr, 2, 2);
  }

 private:
  static void couple(ContactRow& row, const Body& body, const double* arm, double sign, std::size_t at) {
    const Three<L> r = Three<L>::load(arm);
    const double* directions[3] = {numbers<L>(row.normal), numbers<L>(row.along), numbers<L>(row.across)};
    const double* inertia = numbers<L>(body.inverse_inertia);
    // By columns: the rows' sums are taken side by side, in the order of each alone.
    Three<L> column[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const double of[3] = {inertia[i], inertia[3 + i], inertia[6 + i]};
      column[i] = Three<L>::load(of);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Three<L> push = sign * Three<L>::load(directions[k]);
      const Three<L> twist = cross(r, push);
      const Three<L> turn = twist.at(0) * column[0] + twist.at(1) * column[1] + twist.at(2) * column[2];
      put(joined(push, twist), row.of[k] + at);
      put(joined(body.inverse_mass * push, turn), row.gain[k] + at);
    }
  }

  // In the order of beside().
  static void put(const Six<L>& from, double* to) {
    if constexpr (L == 4) {
      store<L>(to, __builtin_shufflevector(from.low, from.low, 0, 1));
      store<L>(to + 4, __builtin_shufflevector(from.low, from.low, 2, 3));
      store<L>(to + 8, from.high);
    } else {
      for (std::size_t p = 0; p < 3; ++p) {
        for (std::size_t i = 0; i < 2 / L; ++i) store<L>(to + 4 * p + L * i, from.v[2 / L * p + i]);
      }
    }
  }

  // Own slip along one direction per impulse along another one.
  static double response(const ContactRow& row, bool pair, std::size_t to, std::size_t from) {
    const double *of = row.of[to], *gain = row.gain[from];
    const double own = half(of, gain);
    return pair ? own + half(of + 2, gain + 2) : own;
  }
  static double half(const double* of, const double* gain) {
    if constexpr (L == 1) {
      const double even = of[0] * gain[0] + of[4] * gain[4] + of[8] * gain[8], odd = of[1] * gain[1] + of[5] * gain[5] + of[9] * gain[9];
      return even + odd;
    } else {
      const auto part = [](const double* at) { return load_aligned<L, Two>(at); };
      const Two s = part(of) * part(gain) + part(of + 4) * part(gain + 4) + part(of + 8) * part(gain + 8);
      return s[0] + s[1];
    }
  }
};

}  // namespace topple::rigid

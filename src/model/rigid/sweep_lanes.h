/// One sweep over contact points, in lanes.
#pragma once

#include "model/rigid/point_motion.h"

namespace topple::rigid {

template <int L>
struct SweepLanes {
  /// Adds what the rows' impulses give to the velocities, six numbers a body.
  static void apply_all(const ContactRow* rows, std::size_t count, double* velocity) {
    for (std::size_t k = 0; k < count; ++k) apply<L>(rows[k], numbers<L>(rows[k].impulse), velocity);
  }

  /// Solves the rows that `order` names, from the first one on or from the last one. Returns the largest change of a point's velocity
  /// [m/s].
  static double sweep(ContactRow* rows, const int* order, std::size_t count, bool backwards, double* velocity) {
    double change = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      change = larger<L>(change, solve(rows[order[backwards ? count - 1 - k : k]], velocity));
    }
    return change;
  }

  /// The first sweep, which finds the order. Points of a pair come in the order of what they carry; those that carry as much, in the order
  /// of how fast they close, then slide.
  static double first_sweep(ContactRow* rows, int* order, std::size_t count, double* velocity) {
    double change = 0.0;
    for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
      for (; end < count && rows[end].a == rows[begin].a && rows[end].b == rows[begin].b; ++end) {
        order[end] = static_cast<int>(end);
        for (std::size_t at = end; at > begin && comes_before(rows[order[at]], rows[order[at - 1]], velocity); --at) {
          const int other = order[at];
          order[at] = order[at - 1];
          order[at - 1] = other;
        }
      }
      for (std::size_t at = begin; at < end; ++at) change = larger<L>(change, solve(rows[order[at]], velocity));
    }
    return change;
  }

  /// As sweep(), in the order of the rows, where friction is the cone of [Anitescu2006].
  static double sweep_cones(ContactRow* rows, std::size_t count, bool backwards, double* velocity) {
    double change = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      ContactRow& row = rows[backwards ? count - 1 - k : k];
      double* a = velocity + std::ptrdiff_t{6} * row.a;
      if (row.b == kFloor) {
        change = larger<L>(change, solve_cone<false>(row, a, nullptr));
      } else {
        change = larger<L>(change, solve_cone<true>(row, a, velocity + std::ptrdiff_t{6} * row.b));
      }
    }
    return change;
  }

 private:
  static double solve(ContactRow& row, double* velocity) {
    double* a = velocity + std::ptrdiff_t{6} * row.a;
    if (row.b == kFloor) return solve<false>(row, a, nullptr);
    return solve<true>(row, a, velocity + std::ptrdiff_t{6} * row.b);
  }

  static bool comes_before(const ContactRow& left, const ContactRow& right, const double* velocity) {
    const double left_carries = numbers<L>(left.impulse)[0], right_carries = numbers<L>(right.impulse)[0];
    if (left_carries != right_carries) return left_carries > right_carries;
    const double* a = velocity + std::ptrdiff_t{6} * left.a;
    const double* b = left.b == kFloor ? nullptr : velocity + std::ptrdiff_t{6} * left.b;
    double l[3], r[3];
    slip_of<L>(left, a, b, l);
    slip_of<L>(right, a, b, r);
    if (l[0] != r[0]) return l[0] < r[0];
    return l[1] * l[1] + l[2] * l[2] > r[1] * r[1] + r[2] * r[2];
  }

  static double change_of(const ContactRow& row, double n, double s, double t) {
    return larger<L>(row.k_nn * __builtin_fabs(n), larger<L>(row.k_aa * __builtin_fabs(s), row.k_cc * __builtin_fabs(t)));
  }

  struct Impulse {
    double n, s, t;
  };

  // Gives a point another impulse than it had. Returns the largest change of its velocity.
  template <bool kPair>
  static double take(ContactRow& row, PointMotion<L, kPair>& motion, const Impulse& now, double* a, double* b) {
    double* impulse = numbers<L>(row.impulse);
    const double n = now.n - impulse[0], s = now.s - impulse[1], t = now.t - impulse[2];
    impulse[0] = now.n;
    impulse[1] = now.s;
    impulse[2] = now.t;
    motion.push(row.gain, n, s, t);
    motion.store(a, b);
    return change_of(row, n, s, t);
  }

  // One point: normal first, then friction with the limit that follows. Returns the largest change of its velocity.
  template <bool kPair>
  static double solve(ContactRow& row, double* a, double* b) {
    PointMotion<L, kPair> motion(a, b);
    double slip[3];
    slip_of<L, kPair>(row, motion, slip);
    const double* impulse = numbers<L>(row.impulse);
    const double old_n = impulse[0], old_s = impulse[1], old_t = impulse[2];
    const double n = larger<L>(old_n - row.step_normal * (slip[0] + row.give_normal * old_n), 0.0);
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
      const double size = __builtin_sqrt(s * s + t * t);
      if (size > limit) {
        const double scale = limit / size;
        s = scale * s;
        t = scale * t;
      }
    }
    return take(row, motion, {n, s, t}, a, b);
  }

  // The same where friction is the cone: the impulse is the point of the cone nearest to the one that would stop the slip, and sliding
  // points part. Every such change lowers one convex sum, so none makes energy.
  template <bool kPair>
  static double solve_cone(ContactRow& row, double* a, double* b) {
    PointMotion<L, kPair> motion(a, b);
    double slip[3];
    slip_of<L, kPair>(row, motion, slip);
    const double* impulse = numbers<L>(row.impulse);
    const double old_n = impulse[0], old_s = impulse[1], old_t = impulse[2];
    const double step = 1.0 / (row.k_nn + row.k_aa + row.k_cc + row.give_normal + row.give);
    double n = old_n - step * (slip[0] + row.give_normal * old_n);
    double s = old_s - step * (slip[1] + row.give * old_s), t = old_t - step * (slip[2] + row.give * old_t);
    const double size = __builtin_sqrt(s * s + t * t), mu = row.friction;
    if (size > mu * n) {
      const double along = larger<L>((n + mu * size) / (1.0 + mu * mu), 0.0), share = size > 0.0 ? mu * along / size : 0.0;
      n = along;
      s = share * s;
      t = share * t;
    }
    return take(row, motion, {n, s, t}, a, b);
  }
};

}  // namespace topple::rigid

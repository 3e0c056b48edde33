/// What a point feels of its bricks' velocities and what its impulses do to them, in lanes.
#pragma once

#include "model/rigid/contact_row.h"
#include "model/rigid/lanes.h"

namespace topple::rigid {

/// The velocities of both bricks of a point, or of the first one alone, in registers; in the order of beside().
template <int L, bool kPair>
class PointMotion {
 public:
  /// Six numbers each; of the second one if there is one.
  PointMotion(const double* a, const double* b) {
    for (std::size_t p = 0; p < 3; ++p) {
      if constexpr (L == 1) {
        v_[p][0] = a[2 * p];
        v_[p][1] = a[2 * p + 1];
        if constexpr (kPair) v_[p][2] = b[2 * p];
        if constexpr (kPair) v_[p][3] = b[2 * p + 1];
      } else if constexpr (kPair && L == 4) {
        v_[p][0] = __builtin_shufflevector(load<L, Two>(a + 2 * p), load<L, Two>(b + 2 * p), 0, 1, 2, 3);
      } else {
        v_[p][0] = load<L, Two>(a + 2 * p);
        if constexpr (kPair) v_[p][1] = load<L, Two>(b + 2 * p);
      }
    }
  }
  void store(double* a, double* b) const {
    for (std::size_t p = 0; p < 3; ++p) {
      if constexpr (L == 1) {
        a[2 * p] = v_[p][0];
        a[2 * p + 1] = v_[p][1];
        if constexpr (kPair) b[2 * p] = v_[p][2];
        if constexpr (kPair) b[2 * p + 1] = v_[p][3];
      } else if constexpr (kPair && L == 4) {
        rigid::store<L>(a + 2 * p, __builtin_shufflevector(v_[p][0], v_[p][0], 0, 1));
        rigid::store<L>(b + 2 * p, __builtin_shufflevector(v_[p][0], v_[p][0], 2, 3));
      } else {
        rigid::store<L>(a + 2 * p, v_[p][0]);
        if constexpr (kPair) rigid::store<L>(b + 2 * p, v_[p][1]);
      }
    }
  }

  /// The sum of `of` times the velocities: the even numbers of both bricks, then the odd ones, whatever the lanes.
  double rate(const double* of) const {
    Lane s[kRegisters];
    for (std::size_t q = 0; q < kRegisters; ++q) s[q] = part(of, q) * v_[0][q] + part(of + 4, q) * v_[1][q] + part(of + 8, q) * v_[2][q];
    if constexpr (L == 1) {
      if constexpr (kPair) return (s[0] + s[2]) + (s[1] + s[3]);
      return s[0] + s[1];
    } else if constexpr (!kPair) {
      return s[0][0] + s[0][1];
    } else {
      Two both;
      if constexpr (L == 4) {
        both = __builtin_shufflevector(s[0], s[0], 0, 1) + __builtin_shufflevector(s[0], s[0], 2, 3);
      } else {
        both = s[0] + s[1];
      }
      return both[0] + both[1];
    }
  }

  /// What impulses along the point's three directions change.
  void push(const double (&gain)[3][12], double normal, double along, double across) {
    const Lane n = in_all(normal), s = in_all(along), t = in_all(across);
    for (std::size_t p = 0; p < 3; ++p) {
      for (std::size_t q = 0; q < kRegisters; ++q)
        v_[p][q] += n * part(gain[0] + 4 * p, q) + s * part(gain[1] + 4 * p, q) + t * part(gain[2] + 4 * p, q);
    }
  }

 private:
  static constexpr std::size_t kLanes = kPair || L == 1 ? L : 2;
  static constexpr std::size_t kRegisters = (kPair ? 4 : 2) / kLanes;  // A pair of numbers of each brick.
  using Lane = Register<kLanes>;

  static Lane part(const double* of, std::size_t q) { return load_aligned<L, Lane>(of + kLanes * q); }
  static Lane in_all(double value) {
    if constexpr (kLanes == 1) {
      return value;
    } else if constexpr (kLanes == 2) {
      return Two{value, value};
    } else {
      return all<L>(value);
    }
  }

  Lane v_[3][kRegisters];
};

/// Its velocity along its own directions, bias included [m/s].
template <int L, bool kPair>
inline void slip_of(const ContactRow& row, const PointMotion<L, kPair>& motion, double* slip) {
  const double* bias = numbers<L>(row.bias);
  for (std::size_t k = 0; k < 3; ++k) slip[k] = bias[k] + motion.rate(row.of[k]);
}
/// The same by the velocities of its bricks; the second is null for the floor and for a brick that does not move.
template <int L>
inline void slip_of(const ContactRow& row, const double* a, const double* b, double* slip) {
  if (b == nullptr) {
    slip_of<L, false>(row, {a, b}, slip);
  } else {
    slip_of<L, true>(row, {a, b}, slip);
  }
}

/// Adds the impulses of a point, `change` along each of its directions, to the velocities of both bricks, six numbers a body.
template <int L>
inline void apply(const ContactRow& row, const double* change, double* velocity) {
  double* a = velocity + std::ptrdiff_t{6} * row.a;
  if (row.b == kFloor) {
    PointMotion<L, false> motion(a, nullptr);
    motion.push(row.gain, change[0], change[1], change[2]);
    motion.store(a, nullptr);
  } else {
    double* b = velocity + std::ptrdiff_t{6} * row.b;
    PointMotion<L, true> motion(a, b);
    motion.push(row.gain, change[0], change[1], change[2]);
    motion.store(a, b);
  }
}

}  // namespace topple::rigid

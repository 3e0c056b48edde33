/// Numbers side by side, one, two or four in a register; every operation rounds each as it would alone.
///
/// What is here is compiled once for each number of lanes, and for four with instructions that not every processor has. The linker keeps
/// one copy of an inline function, so whatever such a unit may leave behind has its lanes in its name: all below depends on L, arrays are
/// plain ones, and nothing of the standard library is called. A test looks at the symbols of the unit.
#pragma once

#include <cstddef>

namespace topple::rigid {

using Two = double __attribute__((vector_size(16)));
#if defined(__AVX2__)
using Four = double __attribute__((vector_size(32)));
#endif

template <int L>
struct LaneType;
template <>
struct LaneType<1> {
  using Register = double;
};
template <>
struct LaneType<2> {
  using Register = Two;
};
#if defined(__AVX2__)
template <>
struct LaneType<4> {
  using Register = Four;
};
#endif
template <int L>
using Register = typename LaneType<L>::Register;

/// The first number of an array of them, of which nothing is called.
template <int L, typename T>
inline double* numbers(T& array) {
  return reinterpret_cast<double*>(&array);
}
template <int L, typename T>
inline const double* numbers(const T& array) {
  return reinterpret_cast<const double*>(&array);
}

template <int L, typename R = Register<L>>
inline R load(const double* from) {
  R to;
  __builtin_memcpy(&to, from, sizeof to);
  return to;
}
/// From a place that is a multiple of its size.
template <int L, typename R = Register<L>>
inline R load_aligned(const double* from) {
  R to;
  __builtin_memcpy(&to, __builtin_assume_aligned(from, sizeof to), sizeof to);
  return to;
}
template <int L, typename R>
inline void store(double* to, const R& from) {
  __builtin_memcpy(to, &from, sizeof from);
}
template <int L, typename R>
inline void store_aligned(double* to, const R& from) {
  __builtin_memcpy(__builtin_assume_aligned(to, sizeof from), &from, sizeof from);
}

/// One number in every lane.
template <int L>
inline Register<L> all(double value) {
  if constexpr (L == 1) {
    return value;
  } else if constexpr (L == 2) {
    return Two{value, value};
  } else {
    return Register<L>{value, value, value, value};
  }
}

template <int L>
inline double larger(double a, double b) {
  return a < b ? b : a;
}

/// Six numbers of one brick: along x, y, z, about x, y, z. Their sum is that of the even ones and that of the odd ones: so it is the same
/// in any number of lanes.
template <int L>
struct Six {
  static constexpr std::size_t kCount = 6 / L;
  Register<L> v[kCount];

  static Six load(const double* from) {
    Six to;
    for (std::size_t i = 0; i < kCount; ++i) to.v[i] = rigid::load<L>(from + L * i);
    return to;
  }
  void store(double* to) const {
    for (std::size_t i = 0; i < kCount; ++i) rigid::store<L>(to + L * i, v[i]);
  }
  friend Six operator+(const Six& a, const Six& b) {
    Six c;
    for (std::size_t i = 0; i < kCount; ++i) c.v[i] = a.v[i] + b.v[i];
    return c;
  }
  friend Six operator-(const Six& a, const Six& b) {
    Six c;
    for (std::size_t i = 0; i < kCount; ++i) c.v[i] = a.v[i] - b.v[i];
    return c;
  }
  friend Six operator*(const Six& a, const Six& b) {
    Six c;
    for (std::size_t i = 0; i < kCount; ++i) c.v[i] = a.v[i] * b.v[i];
    return c;
  }
  friend Six operator*(const Register<L>& a, const Six& b) {
    Six c;
    for (std::size_t i = 0; i < kCount; ++i) c.v[i] = a * b.v[i];
    return c;
  }
  double sum() const {
    if constexpr (L == 1) {
      return (v[0] + v[2] + v[4]) + (v[1] + v[3] + v[5]);
    } else {
      const Two s = v[0] + v[1] + v[2];
      return s[0] + s[1];
    }
  }
};

/// Three numbers: a vector in space.
template <int L>
struct Three {
  double x, y, z;

  static Three load(const double* from) { return {from[0], from[1], from[2]}; }
  friend Three operator+(const Three& a, const Three& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Three operator-(const Three& a, const Three& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Three operator-(const Three& a) { return {-a.x, -a.y, -a.z}; }
  friend Three operator*(double s, const Three& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend Three cross(const Three& a, const Three& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
  double at(std::size_t i) const { return i == 0 ? x : i == 1 ? y : z; }
  /// Along, then about.
  friend Six<L> joined(const Three& a, const Three& b) {
    if constexpr (L == 1) {
      return {{a.x, a.y, a.z, b.x, b.y, b.z}};
    } else {
      return {{Two{a.x, a.y}, Two{a.z, b.x}, Two{b.y, b.z}}};
    }
  }
};

#if defined(__AVX2__)
template <>
struct Six<4> {
  Four low;
  Two high;

  static Six load(const double* from) { return {rigid::load<4>(from), rigid::load<4, Two>(from + 4)}; }
  void store(double* to) const {
    rigid::store<4>(to, low);
    rigid::store<4>(to + 4, high);
  }
  friend Six operator+(const Six& a, const Six& b) { return {a.low + b.low, a.high + b.high}; }
  friend Six operator-(const Six& a, const Six& b) { return {a.low - b.low, a.high - b.high}; }
  friend Six operator*(const Six& a, const Six& b) { return {a.low * b.low, a.high * b.high}; }
  friend Six operator*(const Four& a, const Six& b) { return {a * b.low, __builtin_shufflevector(a, a, 0, 1) * b.high}; }
  double sum() const {
    const Two s = __builtin_shufflevector(low, low, 0, 1) + __builtin_shufflevector(low, low, 2, 3) + high;
    return s[0] + s[1];
  }
};

// The fourth lane is not used.
template <>
struct Three<4> {
  Four v;

  static Three load(const double* from) { return {Four{from[0], from[1], from[2], from[2]}}; }
  friend Three operator+(const Three& a, const Three& b) { return {a.v + b.v}; }
  friend Three operator-(const Three& a, const Three& b) { return {a.v - b.v}; }
  friend Three operator-(const Three& a) { return {-a.v}; }
  friend Three operator*(double s, const Three& a) { return {Four{s, s, s, s} * a.v}; }
  friend Three cross(const Three& a, const Three& b) {
    return {__builtin_shufflevector(a.v, a.v, 1, 2, 0, 3) * __builtin_shufflevector(b.v, b.v, 2, 0, 1, 3) -
            __builtin_shufflevector(a.v, a.v, 2, 0, 1, 3) * __builtin_shufflevector(b.v, b.v, 1, 2, 0, 3)};
  }
  double at(std::size_t i) const { return v[i]; }
  friend Six<4> joined(const Three& a, const Three& b) {
    const Four turned = __builtin_shufflevector(b.v, b.v, 1, 2, 3, 0);
    return {__builtin_shufflevector(a.v, turned, 0, 1, 2, 7), __builtin_shufflevector(turned, turned, 0, 1)};
  }
};
#endif

}  // namespace topple::rigid

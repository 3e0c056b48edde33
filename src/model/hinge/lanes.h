/// Two numbers side by side. Every operation rounds each as it would alone, so a lane has the bits of the plain calculation.
#pragma once

#include <cmath>

namespace topple::hinge {

using Pair = double __attribute__((vector_size(16)));

inline double square_root(double x) { return std::sqrt(x); }
inline Pair square_root(Pair x) {
#if defined(__SSE2__) && !defined(__clang__)
  return __builtin_ia32_sqrtpd(x);
#else
  return Pair{std::sqrt(x[0]), std::sqrt(x[1])};
#endif
}

}  // namespace topple::hinge

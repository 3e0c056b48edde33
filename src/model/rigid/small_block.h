/// Small square matrices, row by row: what couples two bricks.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace topple::rigid {

template <int N>
struct Block {
  std::array<double, std::size_t{N} * std::size_t{N}> m{};

  double& at(int row, int column) {
    return m[static_cast<std::size_t>(N) * static_cast<std::size_t>(row) + static_cast<std::size_t>(column)];
  }
  double at(int row, int column) const {
    return m[static_cast<std::size_t>(N) * static_cast<std::size_t>(row) + static_cast<std::size_t>(column)];
  }
};

template <int N>
using Column = std::array<double, static_cast<std::size_t>(N)>;

template <int N>
inline Block<N> product(const Block<N>& a, const Block<N>& b) {
  Block<N> c;
  for (int i = 0; i < N; ++i) {
    for (int k = 0; k < N; ++k) {
      const double value = a.at(i, k);
      for (int j = 0; j < N; ++j) c.at(i, j) += value * b.at(k, j);
    }
  }
  return c;
}

template <int N>
inline void subtract_product(Block<N>& c, const Block<N>& a, const Block<N>& b) {
  for (int i = 0; i < N; ++i) {
    for (int k = 0; k < N; ++k) {
      const double value = a.at(i, k);
      for (int j = 0; j < N; ++j) c.at(i, j) -= value * b.at(k, j);
    }
  }
}

template <int N, std::size_t M>
inline std::array<double, M> product(const Block<N>& a, const std::array<double, M>& x) {
  std::array<double, M> y{};
  for (std::size_t i = 0; i < M; ++i) {
    for (std::size_t j = 0; j < M; ++j) y[i] += a.m[M * i + j] * x[j];
  }
  return y;
}

template <int N, std::size_t M>
inline void subtract_product(std::array<double, M>& y, const Block<N>& a, const std::array<double, M>& x) {
  for (std::size_t i = 0; i < M; ++i) {
    for (std::size_t j = 0; j < M; ++j) y[i] -= a.m[M * i + j] * x[j];
  }
}

/// By cofactors. False if the determinant is zero or not a number.
inline bool invert(Block<3>& a) {
  const auto& m = a.m;
  const double c0 = m[4] * m[8] - m[5] * m[7];
  const double c1 = m[5] * m[6] - m[3] * m[8];
  const double c2 = m[3] * m[7] - m[4] * m[6];
  const double determinant = m[0] * c0 + m[1] * c1 + m[2] * c2;
  if (!(std::abs(determinant) > 0.0)) return false;
  const double s = 1.0 / determinant;
  Block<3> out;
  out.m = {s * c0, s * (m[2] * m[7] - m[1] * m[8]), s * (m[1] * m[5] - m[2] * m[4]),
           s * c1, s * (m[0] * m[8] - m[2] * m[6]), s * (m[2] * m[3] - m[0] * m[5]),
           s * c2, s * (m[1] * m[6] - m[0] * m[7]), s * (m[0] * m[4] - m[1] * m[3])};
  a = out;
  return true;
}

/// By Gauss and Jordan with the largest pivot of each column. False if there is none.
template <int N>
inline bool invert(Block<N>& a) {
  Block<N> out;
  for (int i = 0; i < N; ++i) out.at(i, i) = 1.0;
  for (int k = 0; k < N; ++k) {
    int best = k;
    for (int i = k + 1; i < N; ++i) {
      if (std::abs(a.at(i, k)) > std::abs(a.at(best, k))) best = i;
    }
    if (!(std::abs(a.at(best, k)) > 0.0)) return false;
    if (best != k) {
      for (int j = 0; j < N; ++j) {
        std::swap(a.at(k, j), a.at(best, j));
        std::swap(out.at(k, j), out.at(best, j));
      }
    }
    const double scale = 1.0 / a.at(k, k);
    for (int j = 0; j < N; ++j) {
      a.at(k, j) *= scale;
      out.at(k, j) *= scale;
    }
    for (int i = 0; i < N; ++i) {
      if (i == k) continue;
      const double share = a.at(i, k);
      for (int j = 0; j < N; ++j) {
        a.at(i, j) -= share * a.at(k, j);
        out.at(i, j) -= share * out.at(k, j);
      }
    }
  }
  a = out;
  return true;
}

}  // namespace topple::rigid

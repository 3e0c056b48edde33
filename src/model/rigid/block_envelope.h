/// A sparse matrix of small square blocks, factorised without fill-in outside its envelope.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "model/rigid/small_block.h"

namespace topple::rigid {

/// Block row i begins at the first earlier block that couples to i; everything from there to the diagonal is stored, and the same above it.
/// Along a row of bricks that is one block, so factorising costs a fixed amount a brick; a wall costs its width squared a brick.
template <int N>
class BlockEnvelope {
 public:
  /// `first[i]` <= i is where block row i begins.
  void shape(std::span<const int> first) {
    first_.assign(first.begin(), first.end());
    offset_.resize(first.size());
    std::size_t stored = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      offset_[i] = stored - static_cast<std::size_t>(first[i]);
      stored += i - static_cast<std::size_t>(first[i]);
    }
    lower_.resize(stored);
    upper_.resize(stored);
    diagonal_.resize(first.size());
    l_.resize(stored);
    u_.resize(stored);
    inverse_.resize(first.size());
    forward_.resize(first.size());
    clear();
  }
  /// Sets all blocks to zero.
  void clear() {
    std::fill(lower_.begin(), lower_.end(), Block<N>{});
    std::fill(upper_.begin(), upper_.end(), Block<N>{});
    std::fill(diagonal_.begin(), diagonal_.end(), Block<N>{});
  }

  Block<N>& diagonal(std::size_t i) { return diagonal_[i]; }
  Block<N>& lower(std::size_t i, std::size_t j) { return lower_[offset_[i] + j]; }  ///< Block (i, j), j < i.
  Block<N>& upper(std::size_t i, std::size_t j) { return upper_[offset_[j] + i]; }  ///< Block (i, j), i < j.

  /// L U with unit blocks on the diagonal of L; the diagonal of U is kept inverted. Block rows before `from` are as they were the last
  /// time. False if a block has no inverse.
  bool factorise(std::size_t from) {
    for (std::size_t i = from; i < diagonal_.size(); ++i) {
      const auto first = static_cast<std::size_t>(first_[i]);
      Block<N> pivot = diagonal_[i];
      for (std::size_t j = first; j < i; ++j) {
        Block<N>& left = l_[offset_[i] + j];
        Block<N>& above = u_[offset_[i] + j];
        left = lower_[offset_[i] + j];
        above = upper_[offset_[i] + j];
        for (std::size_t k = std::max(first, static_cast<std::size_t>(first_[j])); k < j; ++k) {
          subtract_product(above, l_[offset_[j] + k], u_[offset_[i] + k]);
          subtract_product(left, l_[offset_[i] + k], u_[offset_[j] + k]);
        }
        left = product(left, inverse_[j]);
        subtract_product(pivot, left, above);
      }
      if (!invert(pivot)) return false;
      inverse_[i] = pivot;
    }
    return true;
  }

  /// Solves for a right-hand side of which what comes before `from` is as it was the last time.
  void solve(std::span<const Column<N>> right, std::size_t from, std::span<Column<N>> x) {
    for (std::size_t i = from; i < diagonal_.size(); ++i) {
      forward_[i] = right[i];
      for (auto j = static_cast<std::size_t>(first_[i]); j < i; ++j) subtract_product(forward_[i], l_[offset_[i] + j], forward_[j]);
    }
    std::copy(forward_.begin(), forward_.end(), x.begin());
    for (std::size_t i = diagonal_.size(); i-- > 0;) {
      x[i] = product(inverse_[i], x[i]);
      for (auto j = static_cast<std::size_t>(first_[i]); j < i; ++j) subtract_product(x[j], u_[offset_[i] + j], x[i]);
    }
  }

 private:
  std::vector<int> first_;
  std::vector<std::size_t> offset_;                 // Of block (i, 0), if it were stored.
  std::vector<Block<N>> lower_, upper_, diagonal_;  // The matrix.
  std::vector<Block<N>> l_, u_, inverse_;           // Its factors.
  std::vector<Column<N>> forward_;                  // The right-hand side after the first factor.
};

}  // namespace topple::rigid

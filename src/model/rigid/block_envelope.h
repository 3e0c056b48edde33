/// A sparse matrix of small square blocks, factorised without fill-in outside its envelope.
#pragma once

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
  /// Sets all blocks to zero. `first[i]` <= i is where block row i begins.
  void shape(std::span<const int> first) {
    first_.assign(first.begin(), first.end());
    offset_.resize(first.size());
    std::size_t stored = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      offset_[i] = stored - static_cast<std::size_t>(first[i]);
      stored += i - static_cast<std::size_t>(first[i]);
    }
    lower_.assign(stored, Block<N>{});
    upper_.assign(stored, Block<N>{});
    diagonal_.assign(first.size(), Block<N>{});
  }

  Block<N>& diagonal(std::size_t i) { return diagonal_[i]; }
  Block<N>& lower(std::size_t i, std::size_t j) { return lower_[offset_[i] + j]; }  ///< Block (i, j), j < i.
  Block<N>& upper(std::size_t i, std::size_t j) { return upper_[offset_[j] + i]; }  ///< Block (i, j), i < j.

  /// L U with unit blocks on the diagonal of L; the diagonal of U is kept inverted. False if a block has no inverse.
  bool factorise() {
    for (std::size_t i = 0; i < diagonal_.size(); ++i) {
      for (auto j = static_cast<std::size_t>(first_[i]); j < i; ++j) {
        const auto begin = static_cast<std::size_t>(first_[i] > first_[j] ? first_[i] : first_[j]);
        for (std::size_t k = begin; k < j; ++k) {
          subtract_product(upper(j, i), lower(j, k), upper(k, i));
          subtract_product(lower(i, j), lower(i, k), upper(k, j));
        }
        lower(i, j) = product(lower(i, j), diagonal_[j]);
        subtract_product(diagonal_[i], lower(i, j), upper(j, i));
      }
      if (!invert(diagonal_[i])) return false;
    }
    return true;
  }

  /// Overwrites the right-hand side with the solution.
  void solve(std::span<std::array<double, N>> x) const {
    for (std::size_t i = 0; i < diagonal_.size(); ++i) {
      for (auto j = static_cast<std::size_t>(first_[i]); j < i; ++j) subtract_product(x[i], lower_[offset_[i] + j], x[j]);
    }
    for (std::size_t i = diagonal_.size(); i-- > 0;) {
      x[i] = product(diagonal_[i], x[i]);
      for (auto j = static_cast<std::size_t>(first_[i]); j < i; ++j) subtract_product(x[j], upper_[offset_[i] + j], x[i]);
    }
  }

 private:
  std::vector<int> first_;
  std::vector<std::size_t> offset_;  // Of block (i, 0), if it were stored.
  std::vector<Block<N>> lower_, upper_, diagonal_;
};

}  // namespace topple::rigid

/// A sparse matrix of small square blocks, factorised without fill-in outside its envelope.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "model/rigid/lane_kernels.h"
#include "model/rigid/small_block.h"

namespace topple::rigid {

/// Block row i begins at the first earlier block that couples to i; everything from there to the diagonal is stored, and the same above it.
/// Along a row of bricks that is one block, so factorising costs a fixed amount a brick; a wall costs its width squared a brick.
class BlockEnvelope {
 public:
  explicit BlockEnvelope(const LaneKernels& kernels) : kernels_(kernels) {}
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
    std::fill(lower_.begin(), lower_.end(), PlaneBlock{});
    std::fill(upper_.begin(), upper_.end(), PlaneBlock{});
    std::fill(diagonal_.begin(), diagonal_.end(), PlaneBlock{});
  }

  PlaneBlock& diagonal(std::size_t i) { return diagonal_[i]; }
  /// Blocks and right-hand sides, to be added to.
  PlaneSystem system(std::span<Column<3>> right) {
    return {.offset = offset_.data(),
            .lower = lower_.data(),
            .upper = upper_.data(),
            .diagonal = diagonal_.data(),
            .right = right.empty() ? nullptr : right.front().data()};
  }

  /// L U with unit blocks on the diagonal of L; the diagonal of U is kept inverted. Block rows before `from` are as they were the last
  /// time. False if a block has no inverse.
  bool factorise(std::size_t from) { return kernels_.factorise_plane(factors(), from); }

  /// Solves for a right-hand side of which what comes before `from` is as it was the last time.
  void solve(std::span<const Column<3>> right, std::size_t from, std::span<Column<3>> x) {
    if (!x.empty()) kernels_.solve_plane(factors(), right.front().data(), from, x.front().data());
  }

 private:
  PlaneFactors factors() {
    return {.count = diagonal_.size(),
            .first = first_.data(),
            .offset = offset_.data(),
            .lower = lower_.data(),
            .upper = upper_.data(),
            .diagonal = diagonal_.data(),
            .l = l_.data(),
            .u = u_.data(),
            .inverse = inverse_.data(),
            .forward = forward_.empty() ? nullptr : forward_.front().data()};
  }

  const LaneKernels& kernels_;
  std::vector<int> first_;
  std::vector<std::size_t> offset_;  // Of block (i, 0), if it were stored; block (j, i) above the diagonal is at the same place.
  std::vector<PlaneBlock> lower_, upper_, diagonal_;  // The matrix.
  std::vector<PlaneBlock> l_, u_, inverse_;           // Its factors.
  std::vector<Column<3>> forward_;                    // The right-hand side after the first factor.
};

}  // namespace topple::rigid

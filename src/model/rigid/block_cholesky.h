/// Symmetric positive definite matrices of 6 x 6 blocks, one block row a brick.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace topple::rigid {

/// Columns one after the other: entry (r, c) is at 6 c + r.
using Block6 = std::array<double, 36>;

/// Cholesky's factorization inside an envelope: what lies left of the first block of a row stays zero.
class BlockCholesky {
 public:
  /// `first[i]` is the first block column of block row i, at most i. All entries become zero.
  void shape(std::span<const int> first);
  /// Of the lower triangle: column <= row.
  Block6& at(int row, int column) {
    const auto r = static_cast<std::size_t>(row);
    return blocks_[start_[r] + static_cast<std::size_t>(column - first_[r])];
  }
  /// The matrix becomes its factor. False: it is not positive definite.
  bool factor();
  /// Solves for one right-hand side in place, 6 numbers a block row; after factor().
  void solve(std::span<double> x) const;

 private:
  const Block6& factor_at(int row, int column) const {
    const auto r = static_cast<std::size_t>(row);
    return blocks_[start_[r] + static_cast<std::size_t>(column - first_[r])];
  }
  std::vector<int> first_;
  std::vector<std::size_t> start_;
  std::vector<Block6> blocks_;
};

}  // namespace topple::rigid

/// A sparse matrix with six rows and columns a brick, and its solution.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "model/rigid/body_order.h"
#include "model/rigid/small_block.h"

namespace topple::rigid {

struct LaneKernels;

/// Six by six, row by row: the first four numbers of each row, then the last two of each, so that no load crosses a cache line. Rows and
/// columns: along x, y, z, about x, y, z. Plain arrays, for what lanes.h says.
struct BrickBlock {
  alignas(32) double low[6][4];
  double high[6][2];

  double& at(std::size_t r, std::size_t c) { return c < 4 ? low[r][c] : high[r][c - 4]; }
};

/// The inverse of a block by its four quarters [p q; r s].
struct BlockInverse {
  double p[9];  ///< Of the first quarter.
  double x[9];  ///< That times q.
  double r[9];
  double s[9];  ///< Of s - r p^-1 q.
};

struct BrickRow {
  BrickBlock diagonal = {};
  BlockInverse inverse = {};
  double forward[6] = {};  ///< The right-hand side after the first factor.
  std::size_t begin = 0, end = 0;
  bool changed = true;
};

struct BrickEntry {
  int column = 0;
  bool filled = false;                ///< The left factor is not `lower` itself.
  BrickBlock lower = {}, upper = {};  ///< The matrix.
  BrickBlock left = {}, above = {};   ///< Its factors; of the one above the diagonal is one.
};

/// Symmetric in its pattern, not in its numbers. Bricks are eliminated in the order of their numbers, each with a block for every later one
/// that it touches or comes to be coupled to; along a row of bricks that is one. A brick is factorised anew only if its equations have
/// changed since, or those of one before it that is coupled to it.
class BrickMatrix {
 public:
  /// All entries become zero.
  void shape(const BodyOrder& order);
  /// Where the blocks (i, j) and (j, i) are, j < i, for lower() and upper(); they must be coupled.
  std::size_t entry(int i, int j) const;
  BrickBlock& diagonal(int i) { return rows_[static_cast<std::size_t>(i)].diagonal; }
  BrickBlock& lower(std::size_t entry) { return entries_[entry].lower; }  ///< Block (i, j).
  BrickBlock& upper(std::size_t entry) { return entries_[entry].upper; }  ///< Block (j, i).
  /// Equations of this brick have changed.
  void touch(int i) { rows_[static_cast<std::size_t>(i)].changed = true; }
  /// False if a block has no inverse.
  bool solve(const LaneKernels& kernels, std::span<const Column<6>> right, std::span<Column<6>> x);

 private:
  std::vector<BrickRow> rows_;
  std::vector<BrickEntry> entries_;
  std::vector<int> columns_, parent_, mark_;
};

}  // namespace topple::rigid

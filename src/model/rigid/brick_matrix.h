/// A sparse matrix with six rows and columns a brick, and its solution.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "model/rigid/body_order.h"
#include "model/rigid/small_block.h"

namespace topple::rigid {

/// Six by six, row by row. Rows and columns: along x, y, z, about x, y, z.
struct BrickBlock {
  std::array<Wide, 6> row{};
  double at(std::size_t r, std::size_t c) const { return row[r][c / 2][c % 2]; }
  void set(std::size_t r, std::size_t c, double value) { row[r][c / 2][c % 2] = value; }
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
  bool solve(std::span<const Column<6>> right, std::span<Column<6>> x);

 private:
  /// The inverse of a block by its four quarters [p q; r s].
  struct Inverse {
    Block<3> p;  ///< Of the first quarter.
    Block<3> x;  ///< That times q.
    Block<3> r;
    Block<3> s;  ///< Of s - r p^-1 q.
  };
  struct Row {
    BrickBlock diagonal;
    Inverse inverse;
    Column<6> forward{};  ///< The right-hand side after the first factor.
    std::size_t begin = 0, end = 0;
    bool changed = true;
  };
  struct Entry {
    int column = 0;
    bool filled = false;      ///< The left factor is not `lower` itself.
    BrickBlock lower, upper;  ///< The matrix.
    BrickBlock left, above;   ///< Its factors; of the one above the diagonal is one.
    const BrickBlock& factor() const { return filled ? left : lower; }
  };
  void fill(Entry& entry, std::size_t begin, std::size_t at, BrickBlock& above);
  bool factorise(std::size_t i);
  static bool invert(const BrickBlock& of, Inverse& out);
  static void divide(const Inverse& by, const BrickBlock& block, BrickBlock& out);
  static Column<6> divide(const Inverse& by, const Column<6>& y);

  std::vector<Row> rows_;
  std::vector<Entry> entries_;
  std::vector<int> columns_, parent_, mark_;
};

}  // namespace topple::rigid

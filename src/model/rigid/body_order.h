/// In which order the bodies that move are eliminated from a system of equations.
#pragma once

#include <span>
#include <vector>

#include "model/rigid/contact_row.h"

namespace topple::rigid {

/// The order of Cuthill and McKee, reversed [Cuthill1969]: so the matrix of a row is one block wide, that of a stack as wide as the stack.
/// Along a wave the tail comes first and the head last.
class BodyOrder {
 public:
  void find(std::span<const ContactRow> rows, std::span<const Body> bodies);

  std::span<const int> bodies() const { return order_; }  ///< By number.
  /// Of each number, the least number that a point couples it to, itself at most.
  std::span<const int> first() const { return first_; }
  std::span<const int> near(int body) const;  ///< Bodies that move and share a point with it.
  int number(int body) const { return body == kFloor ? -1 : number_[static_cast<std::size_t>(body)]; }  ///< -1: does not move or touch.

 private:
  struct Pair {
    int a = 0, b = 0;
  };
  int give_numbers();
  void list_pairs(std::span<const ContactRow> rows, std::span<const Body> bodies);

  std::vector<Pair> pairs_;
  std::vector<int> begin_, near_;  // Bodies that share a point with body i are near_[begin_[i]] to near_[begin_[i + 1] - 1].
  std::vector<int> next_;
  std::vector<int> number_, order_, first_;
};

}  // namespace topple::rigid

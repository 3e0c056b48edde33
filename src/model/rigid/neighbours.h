/// Who is near whom: bricks in square cells of the floor.
#pragma once

#include <cstdint>
#include <vector>

#include "model/rigid/run_units.h"

namespace topple::rigid {

/// Cells are as wide as two of the largest bricks can reach, so that whatever can touch a brick is in its own cell or one of the eight
/// around it. A brick is moved to another cell only when it leaves its own, so that those never touched cost nothing.
class Neighbours {
 public:
  Neighbours(const Layout& layout, const RunUnits& units);

  /// Ids of all bricks in the nine cells around a place, ascending; `out` is overwritten.
  void near(const Vec3& place, std::vector<BrickId>& out) const;
  /// A brick's centre went from one place to another.
  void moved(BrickId brick, const Vec3& from, const Vec3& to);

 private:
  std::int64_t cell(double length) const;
  std::size_t bucket(std::int64_t column, std::int64_t row) const;
  bool unlink(BrickId brick, std::size_t bucket);  // Whether it was there.

  double size_ = 1.0;           // Of a cell.
  std::vector<BrickId> first_;  // Per bucket; a list of bricks linked by next_.
  std::vector<BrickId> next_;
};

}  // namespace topple::rigid

/// Whether a plane front runs along an even row, and whether it is again what it was one strike before.
#pragma once

#include <vector>

#include "model/rigid/plane_bricks.h"
#include "model/rigid/plane_cycle.h"
#include "model/rigid/wave.h"

namespace topple::rigid {

/// Strikes are counted while each is like the one before; from the second on, PlaneState is compared with what it was one strike before.
class PlaneEvenRow {
 public:
  PlaneEvenRow(World& world, const Ledger& ledger, const RowPlane& plane, PlaneState& state)
      : world_(world), ledger_(ledger), plane_(plane), state_(state) {}

  /// Counts a strike, at whose moment places along the row are counted from the brick that was struck. A `single` one is all that happens
  /// then, and no force acts.
  void count(const Struck& struck, bool single);
  /// Something happened between two strikes.
  void forget() { strikes_ = 0; }
  int strikes() const { return strikes_; }  ///< So many in turn were of an even row.
  BrickId way() const { return way_; }      ///< From a brick's number to that of the next to be struck: 1 or -1.

  void keep() { kept_ = state_; }
  /// Whether the front is what it was when it was kept, one brick further.
  bool is_as_kept() const;
  /// From now on it is exactly that, but for the names.
  void take_kept();
  /// What is kept is, one brick after the other further, what the front is right after `struck` was struck.
  void rename_kept(BrickId struck);
  /// Whether the row goes on evenly beyond the bricks that the front reaches until the next strike, and nothing else stands there.
  bool goes_on(const PlaneCycle& cycle);

 private:
  bool is_even(const Struck& struck);
  bool is_untouched(BrickId brick) const;
  bool is_put_down_alike(BrickId brick) const;
  bool nothing_else_is_near(int beyond);

  World& world_;
  const Ledger& ledger_;
  const RowPlane& plane_;
  PlaneState& state_;
  PlaneState kept_;  // After the last strike.
  BrickId way_ = 0;
  double pitch_ = 0.0;  // [m]
  BrickId to_ = 0;      // The row is known to go on evenly to this brick.
  int strikes_ = 0;
  std::vector<BrickId> near_;
};

}  // namespace topple::rigid

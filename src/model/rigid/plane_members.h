/// Which bricks a plane front is made of, and which of them it looks for contacts between.
#pragma once

#include <vector>

#include "model/rigid/plane_bricks.h"
#include "model/rigid/row_plane.h"

namespace topple::rigid {

/// Bricks that move, and those that stand or rest within their reach: they are listed before anything can touch them, and left out when
/// nothing that moves is near.
class PlaneMembers {
 public:
  PlaneMembers(World& world, Ledger& ledger, RowPlane& plane, PlaneState& state)
      : world_(world), ledger_(ledger), plane_(plane), state_(state) {}

  int place_of(BrickId brick) const;  ///< -1: it does not belong to the front.
  /// Takes one that stands or rests, where it is. Returns its place.
  int add(BrickId brick);
  /// Takes one that is at `moved`: along the row against where it was put down, up, and turned. Returns its place.
  int add(BrickId brick, const PlaneVec& moved);
  /// How it stands on the floor, with the points within so many thicknesses of it.
  PlaneTouch on_floor(int place, double within) const;
  /// Lists all that a brick could touch before it has moved another quarter of its radius, and takes what is new of it.
  void list_neighbours(int place);
  /// What stands on a brick that begins to move, or leans on it, wakes when it has gone: from here on that is counted.
  void mark_borne_by(int place);
  /// Leaves out pairs of which neither moves, or that have gone out of reach, and then bricks that are in no pair.
  void drop_idle();
  /// Bricks along the row, so that the system of equations is a chain; touches by brick, its floor first.
  void order();
  /// From here on places along the row are against where this brick was put down.
  void count_from(int place);

  bool leave_plane() const { return leave_plane_; }  ///< A brick within reach does not move in the plane, or would leave it.

 private:
  double stand_of(BrickId brick);
  int add_if_near(BrickId other, const Vec3& centre, double radius);
  void list_pair(int a, int b);
  bool in_order() const;
  void order_bricks();

  World& world_;
  Ledger& ledger_;
  RowPlane& plane_;
  PlaneState& state_;
  bool leave_plane_ = false;
  std::vector<PlaneBrick> spare_;
  std::vector<BrickId> near_;
  std::vector<int> renamed_, by_place_;
};

}  // namespace topple::rigid

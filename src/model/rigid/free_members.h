/// Which bricks a front with six degrees of freedom is made of, and which of them it looks for contacts between.
#pragma once

#include <vector>

#include "model/rigid/free_bricks.h"

namespace topple::rigid {

/// Bricks that move, and those that stand or rest within their reach: they are listed before anything can touch them, and left out when
/// nothing that moves is near.
class FreeMembers {
 public:
  FreeMembers(World& world, Ledger& ledger, FreeBricks& bricks) : world_(world), ledger_(ledger), bricks_(bricks) {}

  int place_of(BrickId brick) const;  ///< -1: it does not belong to the front.
  /// Takes one that does not move, where it is in the world. Returns its place.
  int add(BrickId brick);
  /// Lists the floor under a brick, which stands on what it stood on.
  void list_floor(int place);
  /// Lists all that a brick could touch before it has moved another part of its radius, and takes what is new of it.
  void list_neighbours(int place);
  /// Does so for those that have moved so far; whether there were any.
  bool list_those_that_strayed();
  /// What stands on a brick that begins to move, or leans on it, wakes when it has gone: from here on that is counted.
  void mark_borne_by(int place);
  /// Leaves out pairs of which neither moves, or that have gone out of reach, and then bricks that are in no pair.
  void drop_idle();
  /// Leaves out those that another front has taken; whether there were any.
  bool drop_lost();
  /// Leaves out the bodies marked by -1, and writes where the others are then; no touch may name them.
  void keep_those(std::vector<int>& renamed);
  /// By brick, its floor first: along a row the sweeps run with the wave and against it.
  void order_touches();

 private:
  void find_now(Touch& touch) const;

  World& world_;
  Ledger& ledger_;
  FreeBricks& bricks_;
  std::vector<BrickId> near_;
  std::vector<int> renamed_;
};

}  // namespace topple::rigid

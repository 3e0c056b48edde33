/// What a plane front in an even row does from one strike to the next, written down drift by drift.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model/rigid/plane_bricks.h"
#include "model/rigid/plane_drift.h"

namespace topple::rigid {

/// One cycle, from the moment after a strike to that after the next. Bricks are numbered from the one that was struck at its beginning.
class PlaneCycle {
 public:
  /// A brick that moves, as a drift began.
  struct Place {
    int brick = 0;
    bool landed = false;
    double quiet = 0.0;  ///< [s]
    double stand = 0.0;  ///< [m]
    PlaneVec place, velocity, middle, listed_at;
  };
  struct Arrival {
    int brick = 0;
    double time = 0.0;  ///< Since the drift began [s].
  };
  /// A brick goes from cell to cell of the neighbours.
  struct Move {
    int brick = 0;
    PlaneVec from, to;
  };
  struct Happening {
    Event event;  ///< Its bricks and the x of its point count from the struck one, too; its time is the drift's end.
    bool by_floor = false, somewhere = false;
  };
  /// One drift, and all that its end did.
  struct Drift {
    double whole = 0.0, cut = 0.0;  ///< [s]
    std::vector<Place> places;
    std::vector<Arrival> arrivals;  ///< In the order of time once the cycle is closed.
    std::vector<int> taken, left, woken;
    std::vector<PlaneBrick> rested;
    std::vector<Move> moves;
    std::vector<Happening> events;
  };
  /// How much of what a front does in its step is written down already.
  struct Marks {
    std::size_t taken, left, woken, rested, events, still;
  };

  void begin(BrickId struck);
  void begin_drift(const PlaneDrift& drift, const PlaneChain& chain);
  void add_arrival(BrickId brick, double time) { current().arrivals.push_back({brick - first_, time}); }
  void add_move(BrickId brick, const PlaneVec& from, const PlaneVec& to) { current().moves.push_back({brick - first_, from, to}); }
  /// All that a front did since there were so many marks; `rested` are the bricks of Ledger::rested, as they move in the plane.
  void end_drift(const Marks& before, const Ledger& ledger, std::span<const PlaneBrick> rested, const RowPlane& plane);
  void close();

  bool is_whole() const { return whole_; }  ///< Nothing happened in it that is not written down.
  std::span<const Drift> drifts() const { return {drifts_.data(), count_}; }

 private:
  Drift& current() { return drifts_[count_ - 1]; }

  std::vector<Drift> drifts_;
  std::size_t count_ = 0;     // So many of them are this cycle's; the others wait to be used again.
  BrickId first_ = kNoBrick;  // The brick that was struck at its beginning.
  bool whole_ = true;
};

/// How much a front has done in its step by now.
PlaneCycle::Marks marks_of(const Ledger& ledger, std::span<const PlaneBrick> rested);

}  // namespace topple::rigid

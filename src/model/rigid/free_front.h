/// A front whose bricks move freely: six degrees of freedom a brick.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/trigonometry.h"
#include "model/rigid/energy_law.h"
#include "model/rigid/free_bricks.h"
#include "model/rigid/free_drift.h"
#include "model/rigid/free_impulses.h"
#include "model/rigid/free_members.h"
#include "model/rigid/wave.h"

namespace topple::rigid {

/// One step of all that moves in it. It calls what bricks, drifts and impulses do by themselves, wakes and retires bricks, and tells what
/// happened.
class FreeFront final : public Wave {
 public:
  using Wave::Wave;

  void advance(double begin, std::span<const PushMoment> moments) override;
  void wake(BrickId brick, double time) override;
  bool at_rest() const override { return moving_ == 0; }
  void add_to(Hash& hash) const override;
  BrickId not_finite() const override;
  std::size_t motion_count() const override;
  void read(std::span<FreeMotion> out, Energy* energy) const override;
  void read(std::vector<Contact>& out) const override;
  bool must_join() const override { return !ledger_.met.empty(); }
  bool general() const override { return true; }
  void disband() override;

  /// Takes over everything of another front.
  void absorb(FreeFront& other);
  /// Goes on with what another kind of front hands over.
  void adopt(std::span<const HandedBrick> bricks, std::span<const ActiveForce> forces);
  void clear_met() { ledger_.met.clear(); }

  /// Whether something changed that may let a part of it go: a brick came to rest, or a pair went out of reach.
  bool may_part() const { return may_part_; }
  /// How many parts it has that list no brick in common, of those in which something moves. Numbers the parts.
  int find_parts();
  /// Hands one of those parts, from 1 on, to a front that has nothing yet.
  void give_part(int part, FreeFront& to);
  /// A moving brick whose row all its moving bricks belong to, with nothing else in reach of that row's plane; else none.
  BrickId row_brick() const;
  /// Everything that moves, for a plane front to go on with; this one ends.
  void hand_over(std::vector<HandedBrick>& bricks);

 private:
  bool moves(BrickId brick) const override;
  void lose(BrickId brick) override;
  void retire(double time);
  void rouse(BrickId brick);
  void wake_structure(BrickId brick);
  void set_moving(int place);
  void apply(const PushMoment& moment, double now);
  double part(double begin, double time, bool may_cut);
  int strides_of_step() const;
  void keep_energy();
  bool is_hit(const Touch& touch, std::size_t still) const;
  void wake_struck(double now);
  void wake_unsupported(double now);
  void note_struck(double now);
  void note_landed(double now);
  void note_rest(int place, double now);
  void keep_what_stays(Touch& touch) const;
  void begin_push(const Push& push, double now);
  BrickId supporter(int place) const;

  int moving_ = 0;
  bool rested_ = false;  // Some brick came to rest since the lists were made.
  bool may_part_ = false;
  std::vector<int> part_of_, above_;  // Of each body: its part, from 0 on, and while that is looked for another body of the same.
  std::vector<BrickId> roused_;
  std::vector<Struck> struck_now_;  // At the end of the last drift.
  double stride_ = 0.0;             // The step, or a part of it: how long drifts are [s].
  EnergyLaw energy_law_;
  FreeBricks bricks_;
  FreeMembers members_{world_, ledger_, bricks_};
  FreeDrift drift_{world_, bricks_};
  FreeImpulses impulses_{world_, bricks_};
};

}  // namespace topple::rigid

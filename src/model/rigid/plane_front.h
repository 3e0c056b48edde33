/// A front whose bricks all stand across one vertical plane and so move in it: three degrees of freedom a brick.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/rigid/energy_law.h"
#include "model/rigid/plane_cycle.h"
#include "model/rigid/plane_drift.h"
#include "model/rigid/plane_even_row.h"
#include "model/rigid/plane_impulses.h"
#include "model/rigid/plane_members.h"
#include "model/rigid/plane_repeat.h"
#include "model/rigid/row_plane.h"
#include "model/rigid/wave.h"

namespace topple::rigid {

/// One step of all that moves in the plane. It calls what bricks, drifts, impulses and even rows do by themselves, wakes and retires
/// bricks, and tells what happened.
class PlaneFront final : public Wave {
 public:
  PlaneFront(World& world, std::int32_t number, BrickId first);

  void advance(double begin, std::span<const PushMoment> moments) override;
  void wake(BrickId brick, double time) override;
  bool at_rest() const override { return moving_ == 0; }
  void add_to(Hash& hash) const override;
  BrickId not_finite() const override;
  std::size_t motion_count() const override;
  void read(std::span<FreeMotion> out, Energy* energy) const override;
  void tell_unseen(std::vector<UnseenMotion>& out) const override { repeat_.tell_unseen(out); }
  void read(std::vector<Contact>& out) const override;
  bool must_join() const override { return members_.leave_plane() || !ledger_.met.empty(); }
  bool general() const override { return false; }
  void disband() override;

  /// Goes on with what another kind of front hands over; before anything else.
  void adopt(std::span<const HandedBrick> bricks);
  /// Everything that moves, for another kind of front to go on with; this one ends.
  void hand_over(std::vector<HandedBrick>& bricks, std::vector<ActiveForce>& forces);

 private:
  bool moves(BrickId brick) const override;
  void lose(BrickId brick) override;

  // The step, drift by drift.
  void apply(const PushMoment& moment);
  void go_on_to(double moment);
  bool keeps_step() const;
  double stride() const;
  void begin_drift(double moment);
  void end_drift();
  void interrupt();
  void keep_energy();

  // Between drifts: who wakes, who rests, who is near.
  void look_around();
  void list_those_that_strayed();
  void move(BrickId brick, const PlaneVec& from, const PlaneVec& to);
  void wake_struck(double now);
  bool is_hit(const PlaneTouch& touch, const PlaneBrick& still) const;
  void wake_unsupported(double now);
  void retire(double time);
  void let_lean(PlaneTouch& touch, bool a_rests) const;

  // What is not computed again.
  void after_strike();
  bool repeat_to(double moment);
  void repeat_strike();
  void end_repeat();
  void break_off();
  void tell_end(const PlaneCycle::Drift& drift);

  // What happens, as it is told.
  void keep_what_stays(PlaneTouch& touch, int place) const;
  void begin_push(const Push& push, double now);
  void note_arrivals(double until);
  void note_struck(double now);
  void note_landed(double now);
  void note_rest(int place, double now);
  BrickId supporter(int place) const;

  // Places along the row are counted from the brick that was struck last: after each strike of an even row all numbers are the same then.
  RowPlane plane_;
  int moving_ = 0;
  double now_ = 0.0;  // When the drift under way began, or until when all has been done [s].
  PlaneState state_;
  PlaneMembers members_{world_, ledger_, plane_, state_};
  PlaneDrift drift_{world_, state_};
  PlaneImpulses impulses_{world_, state_};
  PlaneEvenRow even_row_{world_, ledger_, plane_, state_};
  PlaneCycle cycle_;  // All since the last strike, where the row is even.
  PlaneRepeat repeat_{world_, plane_, state_, cycle_};
  std::vector<PlaneBrick> rested_now_;  // In this step.
  std::vector<Struck> struck_now_;      // At the end of the last drift.
  EnergyLaw energy_law_;
};

}  // namespace topple::rigid

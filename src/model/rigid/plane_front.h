/// A front whose bricks all stand across one vertical plane and so move in it: three degrees of freedom a brick.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/trigonometry.h"
#include "model/rigid/energy_law.h"
#include "model/rigid/plane_cycle.h"
#include "model/rigid/plane_solver.h"
#include "model/rigid/row_plane.h"
#include "model/rigid/wave.h"

namespace topple::rigid {

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
  void tell_unseen(std::vector<UnseenMotion>& out) const override;
  void read(std::vector<Contact>& out) const override;
  bool must_join() const override { return leaves_plane_ || !met_.empty(); }
  bool general() const override { return false; }
  void disband() override;

  /// Goes on with what another kind of front hands over; before anything else.
  void adopt(std::span<const HandedBrick> bricks);
  /// Everything that moves, for another kind of front to go on with; this one ends.
  void hand_over(std::vector<HandedBrick>& bricks, std::vector<ActiveForce>& forces);

 private:
  bool moves(BrickId brick) const override;
  void lose(BrickId brick) override;
  int place_of(BrickId brick) const;
  int add(BrickId brick, const PlaneVec& moved);
  const Pose& last_pose(BrickId brick) const;
  bool rests(BrickId brick) const;
  InPlane locate(BrickId brick) const;
  double stand_of(BrickId brick);
  void count_from(const PlaneBrick& brick);
  void list_neighbours(int place);
  void list_those_that_strayed();
  void move(BrickId brick, const PlaneVec& from, const PlaneVec& to);
  void drop_idle();
  bool in_order() const;
  void order();
  void order_bricks();
  PlaneTouch on_floor(int place, double within) const;
  void mark_borne_by(int place);
  void wake_unsupported(double now);
  void wake_struck(double now);
  bool is_hit(const PlaneTouch& touch, const PlaneBrick& still) const;
  void retire(double time);

  void apply(const PushMoment& moment);
  void go_on_to(double moment);
  bool keeps_step() const;
  double stride() const;
  void begin_drift(double moment);
  void end_drift();
  void interrupt();
  void look_around();
  // What is not computed again.
  struct Struck {
    BrickId brick, by;
  };
  void after_strike();
  bool is_even(const Struck& struck);
  bool is_as_kept() const;
  void take_kept(BrickId struck);
  void rename_kept(BrickId struck);
  /// In the order of PlaneState::all().
  auto state() {
    return std::tie(bricks_, touches_, near_pairs_, strike_, leaps_, last_struck_, since_strike_, planned_for_, since_look_, cuts_,
                    rested_);
  }
  struct Marks {
    std::size_t taken, left, woken, rested, events, still;
  };
  Marks marks() const;
  void write_down_places();
  void write_down_end(const Marks& before);
  void begin_repeat();
  double struck_at(BrickId brick) const;
  bool is_unseen(BrickId brick) const;
  bool repeat_to(double moment);
  void tell_end(const PlaneCycle::Drift& drift);
  void repeat_strike();
  bool goes_on_to(BrickId brick) const;
  bool next_is_alike();
  void end_repeat();
  void break_off();
  PlaneBrick at_this_moment(const PlaneCycle::Place& place) const;
  PlaneManifold at_this_moment(const PlaneTouch& touch) const;
  PlaneBrick at_this_moment(const PlaneBrick& brick) const;
  void recall(const Pattern& pattern, int head, int most = 1 << 20);
  void keep(Pattern& pattern, int head, int most = 1 << 20) const;
  bool closes_fast() const;
  void plan(double time, bool with_blow, Pattern* pattern = nullptr);
  void solve_half_a_kick(double time);
  static PlaneVec after_the_blow(const PlaneBrick& brick, double time);
  bool bends_otherwise(double time);
  void leap(double time);
  void kick(std::span<PlaneUnknown> unknowns, double time) const;
  void let_lean(PlaneTouch& touch, bool a_rests) const;
  void make_rows(PointState PlaneMemory::* guess);
  void set_bias(double time, bool after_blow = false);
  void remember_impulses(double time, PointState PlaneMemory::* states);
  double find_cut(double whole);
  void try_drift(double time, double whole);
  static double way_to(const PlaneBrick& brick, const PlaneBox& box);
  static double way_between(const PlaneBrick& a, const PlaneBrick& b, double parted);
  void test_next(PlaneTouch& touch, const PlaneBox& a, const PlaneBox& b) const;
  static void accept(PlaneTouch& touch);
  void find_near_pairs();
  double first_impact(double time, double whole) const;
  double impact_of(const PlaneTouch& touch, const PlanePoint& point, double time, double whole) const;
  double distance_at(const PlaneTouch& touch, std::uint8_t feature, double time, double whole) const;
  PlaneBox box_at(const PlaneBrick& brick, double time, double whole) const;
  void accept_drift(double cut, double whole);
  bool activate_new_points();
  void take_blow(double whole, double next);
  void stop_at_once();
  double moving_energy() const;
  double spare_energy() const;
  void keep_energy();
  bool blow(bool always);
  void give_back();
  void bounce_by(double share);

  void keep_what_stays(PlaneTouch& touch, int place) const;
  void begin_push(const Push& push, double now);
  void note_arrivals(double until);
  void note_arrival(BrickId brick, double time);
  void note_struck(double now);
  void note_landed(double now);
  void note_rest(int place, double now);
  BrickId supporter(int place) const;
  Vec3 in_world(double x, double z) const;
  static SinCos half_turn(const PlaneBox& box);
  Pose pose_of(const PlaneBrick& brick) const;

  RowPlane plane_;
  /// Places along the row are counted from the brick that was struck last: after each strike of an even row all numbers are the same then.
  double origin_ = 0.0;      // Where that is along the plane [m].
  double pitch_ = 0.0;       // From brick to brick [m].
  double half_width_ = 0.0;  // Widest of its bricks [m].
  bool leaves_plane_ = false;
  int moving_ = 0;
  /// Bricks are where a drift began; it ends at an impact or after its whole length, mostly in another step than it began.
  struct Drift {
    bool under_way = false;
    double whole = 0.0;  // As it is planned [s]...
    double cut = 0.0;    // ...and up to the first impact.
    double done = 0.0;   // How far the step has come in it.
  };
  double now_ = 0.0;  // When the drift under way began [s].
  Drift drift_;
  double since_look_ = 0.0;             // Time since neighbours and rests were looked at [s],
  int cuts_ = 0;                        // and impacts located in it.
  double planned_for_ = 0.0;            // `middle` is good for a drift of this time [s]; 0: for none.
  bool rested_ = false;                 // Some brick came to rest since the lists were made.
  std::vector<PlaneBrick> rested_now_;  // In this step.
  std::vector<PlaneBrick> bricks_, spare_;
  std::vector<PlaneTouch> touches_;
  std::vector<int> near_pairs_;  // Those that have points, or may have some at the end of the drift that is tried.
  double passing_ = 0.0;         // How far two go that are apart and may have met in it, at most [thicknesses].
  std::vector<PlaneRow> rows_, compression_;
  std::vector<PlaneUnknown> unknowns_, before_blow_;
  struct Force {
    BrickId brick = kNoBrick;
    double along = 0.0;       // [N]
    double x = 0.0, z = 0.0;  // Where it acts, in the brick's own axes [m].
    double end = 0.0;         // [s]
  };
  std::vector<Force> forces_;
  std::vector<Struck> struck_now_;
  Pattern strike_;                 // How the last strike went,
  std::array<Pattern, 16> leaps_;  // and the leaps after it.
  BrickId last_struck_ = kNoBrick;
  std::size_t since_strike_ = 0;
  std::vector<BrickId> near_;
  std::vector<int> renamed_, by_place_;

  PlaneState kept_;          // After the last strike,
  PlaneCycle cycle_;         // and all since then.
  BrickId way_ = 0;          // From a brick's number to that of the next to be struck: 1 or -1.
  double even_pitch_ = 0.0;  // [m]
  BrickId even_to_ = 0;      // The row is known to go on evenly to this brick.
  int even_ = 0;             // So many strikes in turn were of an even row.
  struct Repeat {
    bool on = false;
    std::size_t drift = 0;      // Of the cycle: the one under way.
    std::size_t arrivals = 0;   // Of that drift, told already.
    BrickId like = kNoBrick;    // Whose motion is that of all that are struck after it,
    double like_struck = 0.0;   // and when it was struck [s].
    std::int64_t strikes = 0;   // Since then.
    std::vector<double> times;  // When the last of them were [s].
    PlaneBrick one;             // What all bricks have in common.
  };
  Repeat repeat_;
  EnergyLaw energy_law_;
  PlaneSolver solver_{*world_.kernels};
};

}  // namespace topple::rigid

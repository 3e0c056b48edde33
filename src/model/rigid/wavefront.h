/// The wave front: bricks that move, those that stand or rest within their reach, and one step of them all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/trigonometry.h"
#include "model/rigid/contact_solver.h"
#include "model/rigid/energy_law.h"
#include "model/rigid/touch.h"
#include "model/rigid/wave.h"

namespace topple::rigid {

/// What a moving brick is known by besides its state.
struct Member {
  Vec3 listed_at;                     ///< Where its list of neighbours was made [m].
  Vec3 velocity_before, spin_before;  ///< At the start of the step.
  Vec3 local_up;                      ///< The vertical of its stance in its own axes.
  double thin = 0.0;                  ///< Its thinnest side [m].
  double time_scale = 0.0;            ///< sqrt(longest side / gravity) [s].
  double quiet = 0.0;                 ///< How long it has hardly moved [s].
  double stayed = 0.0;                ///< How long it has been near this place [s].
  Vec3 stays_at;                      ///< That place,
  Quat stays_turned;                  ///< and how it was turned there.
  Twist middle;                       ///< What carries it through the drift that is planned.
  Twist gain;                         ///< Their change in the last drift, per time: its acceleration before the last blow.
  double tilt_cosine = 1.0;
  bool moving = false;
  bool lost = false;    ///< Another front has taken it in the same step.
  bool pushed = false;  ///< A force acts on it.
  bool landed = false;
  bool just_rested = false;  ///< In this step.
};

class Front final : public Wave {
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
  bool must_join() const override { return !met_.empty(); }
  bool general() const override { return true; }
  void disband() override;

  /// Takes over everything of another front.
  void absorb(Front& other);
  /// Goes on with what another kind of front hands over.
  void adopt(std::span<const HandedBrick> bricks, std::span<const ActiveForce> forces);
  void clear_met() { met_.clear(); }

  /// Whether something changed that may let a part of it go: a brick came to rest, or a pair went out of reach.
  bool may_part() const { return may_part_; }
  /// How many parts it has that list no brick in common, of those in which something moves. Numbers the parts.
  int find_parts();
  /// Hands one of those parts, from 1 on, to a front that has nothing yet.
  void give_part(int part, Front& to);
  /// A moving brick whose row all its moving bricks belong to, with nothing else in reach of that row's plane; else none.
  BrickId row_brick() const;
  /// Everything that moves, for a plane front to go on with; this one ends.
  void hand_over(std::vector<HandedBrick>& bricks);

 private:
  bool moves(BrickId brick) const override;
  void lose(BrickId brick) override;
  int place_of(BrickId brick) const;
  void retire(double time);
  int add(BrickId brick);
  void rouse(BrickId brick);
  void wake_structure(BrickId brick);
  void set_moving(int place);
  void mark_borne_by(int place);
  void list_neighbours(int place);
  void list_those_that_strayed();
  void drop_idle();
  void drop_lost();
  void keep_those(std::vector<int>& renamed);
  void order_touches();
  double part(double begin, double time, bool may_cut);
  void make_rows(ContactState PointMemory::* guess, double time);
  void set_bias(double time);
  void kick(double time);
  void slow_ball(std::size_t place, double time);
  void solve_contacts(std::span<const Twist> guess);
  void plan(double time, bool with_blow);
  void solve_half_a_kick(double time);
  static Twist after_the_blow(const Member& member, double time);
  bool bends_otherwise(double time);
  void leap(double time);
  void remember_impulses(double time, ContactState PointMemory::* states, bool with_blow = false);
  Body body_at(std::size_t place, double time, double whole) const;
  void find_next(const std::vector<Body>& bodies, Touch& touch) const;
  void find_now(Touch& touch) const;
  double recall_within(const Touch& touch) const;
  double find_cut(double whole);
  double farthest_passing(double time) const;
  void try_drift(double time, double whole);
  double first_impact(double time, double whole) const;
  double impact_of(const Touch& touch, const TouchPoint& point, double time, double whole) const;
  double distance_at(const Touch& touch, std::uint32_t feature, double time, double whole) const;
  void accept_drift(double begin, double cut, double whole);
  double closing_speed(const Touch& touch, int point) const;
  double thinner(const Touch& touch) const;
  bool activate_new_points();
  bool closes_fast() const;
  void take_blow(double next, bool ends_step);
  void stop_at_once();
  int strides_of_step() const;
  bool blow(bool always);
  double moving_energy() const;
  double spare_energy() const;
  void keep_energy();
  void rein_in(double most);
  void give_back(double before);
  void bounce_by(double share);
  bool is_hit(const Touch& touch, std::size_t still) const;
  void wake_struck(double now);
  void wake_unsupported(double now);
  void note_arrival(std::size_t place, double begin, double time, double slope_before, double slope_after);
  void note_struck(double now);
  void note_landed(double now);
  void note_rest(int place, double now);
  void keep_what_stays(Touch& touch) const;
  void begin_push(const Push& push, double now);
  BrickId supporter(int place) const;

  int moving_ = 0;
  bool rested_ = false;  // Some brick came to rest since the lists were made.
  bool may_part_ = false;
  std::vector<int> part_of_;  // Of each body: its part, from 0 on.
  std::vector<Body> bodies_;
  std::vector<Member> members_;
  std::vector<Touch> touches_;
  std::vector<Body> ahead_;  // The bodies at the end of the part of the step that is tried.
  std::vector<ContactRow> rows_, compression_;
  std::vector<Vec3> bends_;  // Of each row: what the bend of its points' paths adds to their slip [m/s].
  std::vector<Twist> guess_, now_, free_;
  std::vector<ActiveForce> forces_;
  std::vector<BrickId> near_;
  std::vector<BrickId> roused_;
  std::vector<int> renamed_;
  struct Struck {
    BrickId brick, by;
  };
  std::vector<Struck> struck_now_;
  double stride_ = 0.0;       // The step, or a part of it: how long drifts are [s].
  double planned_for_ = 0.0;  // The plan is good for a drift of this time [s]; 0: for none.
  EnergyLaw energy_law_;
  Touch before_;
  ContactSolver solver_{*world_.kernels};
};

}  // namespace topple::rigid

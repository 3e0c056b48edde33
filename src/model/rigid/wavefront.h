/// The wave front: bricks that move, those that stand or rest within their reach, and one step of them all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/trigonometry.h"
#include "model/rigid/impulse_solver.h"
#include "model/rigid/neighbours.h"
#include "model/rigid/touch.h"
#include "topple/model.h"

namespace topple::rigid {

inline constexpr std::int32_t kNoFront = -1;

/// Pure numbers that scale with a brick: lengths are fractions of the thinnest side, times of sqrt(height / gravity).
struct Tolerances {
  double touching = 1e-3;  ///< Closer than this two bricks touch.
  double located = 3e-4;   ///< Impacts are located to this.
  double margin = 1e-2;    ///< A contact lasts while it is closer than this.
  double retire = 5e-3;    ///< A brick rests when it would move by no more than this from now on...
  double horizon = 1.0;    ///< ...within this time...
  double patience = 0.2;   ///< ...and has done so for this long.
  double support = 1e-2;   ///< A resting brick wakes when what it leans on has moved by this.
  double load = 0.02;      ///< A brick that stands or rests wakes under this share of its weight.
  double velocity = 1e-5;  ///< The solver stops when velocities change by less, as a fraction of sqrt(gravity x height).
  int sweeps = 60;
  int cuts = 16;  ///< Impacts located in one step of one front; more are taken at its end.
};

/// What all fronts share: the layout and where each brick is that does not move.
struct World {
  explicit World(const Layout& source);

  const Layout& layout;
  Neighbours neighbours;
  std::vector<Phase> phase;
  std::vector<Pose> pose;             ///< Of each brick that does not move.
  std::vector<std::uint8_t> arrived;  ///< Whether the wave has been there.
  std::vector<std::uint8_t> struck;   ///< Whether anything hit it.
  std::vector<std::int32_t> front;    ///< The front that a brick belongs to, moving or in its way.
  std::vector<std::int32_t> place;    ///< In the list of that front.
  double gravity = 9.81;              ///< [m/s^2]
  double step = 0.0;                  ///< [s]
  double smallest = 0.0;              ///< Longest side of the smallest brick [m].
  Tolerances tolerances;
  double resting_energy = 0.0;  ///< Potential, of bricks that rest [J].
  double push_work = 0.0;       ///< [J]
};

/// A push at work on one brick.
struct ActiveForce {
  BrickId brick = kNoBrick;
  Vec3 force;        ///< World [N].
  Vec3 point;        ///< Where it acts, in the brick's axes [m].
  double end = 0.0;  ///< [s]
};

/// A push that begins, or a force that ends, inside a step.
struct PushMoment {
  double time = 0.0;
  const Push* push = nullptr;  ///< Null: the force of `brick` ends.
  BrickId brick = kNoBrick;
};

/// What a moving brick is known by besides its state.
struct Member {
  Vec3 listed_at;                     ///< Where its list of neighbours was made [m].
  Vec3 velocity_before, spin_before;  ///< At the start of the step.
  Vec3 local_up;                      ///< The vertical of its stance in its own axes.
  double thin = 0.0;                  ///< Its thinnest side [m].
  double time_scale = 0.0;            ///< sqrt(longest side / gravity) [s].
  double quiet = 0.0;                 ///< How long it has hardly moved [s].
  double tilt_cosine = 1.0;
  double tilt_slope = 0.0;      ///< Of the cosine, when the last drift began [1/s].
  double tilt_slope_end = 0.0;  ///< When it ended [1/s].
  bool moving = false;
  bool ghost = false;   ///< Belongs to another front: stands still for this step.
  bool pushed = false;  ///< A force acts on it.
  bool landed = false;
  bool just_rested = false;  ///< In this step.
};

class Front {
 public:
  Front(World& world, std::int32_t number) : world_(world), number_(number) {}

  /// One whole step from `begin` [s]; `moments` in the order of time.
  void advance(double begin, std::span<const PushMoment> moments);
  /// Takes a brick out of its rest.
  void wake(BrickId brick, double time);
  /// Puts the bricks to rest that have become quiet.
  void retire(double time);
  /// Takes over everything of another front.
  void absorb(Front& other);

  bool empty() const { return moving_ == 0; }
  std::span<const Body> bodies() const { return bodies_; }
  std::span<const Member> members() const { return members_; }
  std::span<const Touch> touches() const { return touches_; }
  std::span<const std::int32_t> met() const { return met_; }  ///< Other fronts whose bricks are within reach.
  std::vector<Event>& events() { return events_; }
  std::vector<Contact>& contacts() { return contacts_; }
  void clear_met() { met_.clear(); }

 private:
  int place_of(BrickId brick) const;
  int add(BrickId brick);
  void set_moving(int place);
  void list_neighbours(int place);
  void list_those_that_strayed();
  void drop_idle();
  void order_touches();
  double part(double begin, double time, bool may_cut);
  void kick(double time);
  void solve_contacts();
  void sweep();
  void move(double time);
  void find_touches(bool first);
  double first_impact(double time, int& touch, std::uint32_t& feature) const;
  bool touched_before(std::size_t touch) const;
  double refine(double time, double whole, int touch, std::uint32_t feature) const;
  double closing_speed(const Touch& touch, int point) const;
  double thinner(const Touch& touch) const;
  void positions(double time);
  void velocities(double time, double now);
  bool activate_new_points();
  bool is_hit(const Touch& touch, std::size_t still) const;
  void settle_on_floor(int place);
  void wake_struck(double now);
  void wake_unsupported(double now);
  void remember_forces(double time);
  void release_parting_points();
  void note_arrivals(double begin, double time);
  void note_struck(double now);
  void note_landed(double now);
  void note_rest(int place, double now);
  void begin_push(const Push& push, double now);
  void collect_contacts();
  void take_blow();
  BrickId supporter(int place) const;
  BrickId next_of_part(BrickId brick) const;
  bool has_front(std::int32_t other) const;

  World& world_;
  std::int32_t number_ = 0;
  int moving_ = 0;
  bool rested_ = false;  // Some brick came to rest since the lists were made.
  std::vector<Body> bodies_;
  std::vector<Member> members_;
  std::vector<Touch> touches_;
  std::vector<Body> bodies_before_;
  std::vector<Touch> touches_before_;
  std::vector<ActiveForce> forces_;
  std::vector<Event> events_;
  std::vector<Contact> contacts_;
  std::vector<BrickId> near_;
  std::vector<std::int32_t> met_;
  std::vector<int> renamed_;
  struct Struck {
    BrickId brick, by;
  };
  std::vector<Struck> struck_now_;
  Touch before_;
  double work_ = 0.0;
  ImpulseSolver solver_;
};

}  // namespace topple::rigid

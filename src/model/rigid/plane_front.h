/// A front whose bricks all stand across one vertical plane and so move in it: three degrees of freedom a brick.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/trigonometry.h"
#include "model/rigid/plane_solver.h"
#include "model/rigid/row_plane.h"
#include "model/rigid/wave.h"

namespace topple::rigid {

struct PlaneBrick {
  PlaneBox box;
  PlaneBox next;          ///< At the end of the part of the step that is tried.
  PlaneVec velocity;      ///< At this moment.
  PlaneVec middle;        ///< Mean over the drift that is planned.
  PlaneVec before_drift;  ///< Velocity when the last drift began.
  PlaneVec acceleration;  ///< Before the last blow.
  double mass = 0.0;      ///< [kg]
  double inertia = 0.0;   ///< About the axis across [kg m^2].
  double inverse_mass = 0.0, inverse_inertia = 0.0;
  double radius = 0.0;       ///< Of the circle around it [m].
  double thin = 0.0;         ///< Its thinnest side [m].
  double time_scale = 0.0;   ///< sqrt(longest side / gravity) [s].
  double quiet = 0.0;        ///< How long it has hardly moved [s].
  PlaneVec velocity_before;  ///< At the start of the step.
  PlaneVec listed_at;        ///< Where its list of neighbours was made.
  Quat upright;              ///< Its orientation as put down.
  double lateral = 0.0;      ///< Its place across the plane [m].
  BrickId id = kNoBrick;
  std::uint16_t kind = 0;
  int unknown = -1;  ///< Its place in the system of equations.
  bool moving = false;
  bool pushed = false;
  double path = 0.0;       ///< No corner has gone farther than this, all drifts together [m]...
  double next_path = 0.0;  ///< ...with the one that is tried.
  bool landed = false;
  bool just_rested = false;
};

/// What a point remembers from moment to moment.
struct PlaneMemory {
  bool active = false;
  bool fresh = false;                           ///< Became active at the end of this part of the step.
  PointState kick, blow;                        ///< What it did in the last kick and in the last blow: the guess for the next one.
  double overlap = 0.0;                         ///< What is left of the overlap that its impact found [m].
  double normal = 0.0, tangent = 0.0;           ///< What it carried in the last kick [N].
  double leaning = 0.0, leaning_tangent = 0.0;  ///< What a brick that rests and leans on one that moves goes on to press with [N].
};

struct PlaneTouch {
  int a = 0;
  int b = -1;         ///< -1: the floor.
  double thin = 0.0;  ///< Of the thinner of the two [m].
  double friction = 0.0;
  double restitution = 0.0;
  PlaneManifold now, next;
  double apart_until = 0.0;  ///< It has no points before the paths of both bricks together are as long as this [m].
  std::array<PlaneMemory, 2> memory;
  double impulse = 0.0;  ///< Sum of the normal impulses of the last solution [N s].
  double load = 0.0;     ///< The force that they are [N].
  bool bearing = false;  ///< Of a pair of which one moves: they touched when the one came to rest or the other began to move.
  PlaneVec mark;         ///< Where the moving one was then.
};

class PlaneFront final : public Wave {
 public:
  PlaneFront(World& world, std::int32_t number, BrickId first);

  void advance(double begin, std::span<const PushMoment> moments) override;
  void wake(BrickId brick, double time) override;
  bool at_rest() const override { return moving_ == 0; }
  void add_to(Hash& hash) const override;
  BrickId not_finite() const override;
  std::size_t motion_count() const override;
  void read(std::span<FreeMotion> out, Energy& energy) const override;
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
  int add(BrickId brick, const PlaneVec& place);
  void list_neighbours(int place);
  void list_those_that_strayed();
  void drop_idle();
  bool in_order() const;
  void order();
  void order_bricks();
  void mark_borne_by(int place);
  void wake_unsupported(double now);
  void wake_struck(double now);
  bool is_hit(const PlaneTouch& touch, const PlaneBrick& still) const;
  void retire(double time);

  double part(double begin, double time, bool may_cut);
  struct PatternPoint {
    int a = 0, b = 0;  // Places counted backwards from the brick that was struck.
    std::uint8_t feature = 0;
    PointState state;
  };
  using Pattern = std::vector<PatternPoint>;
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
  void try_drift(double time);
  static double way_to(const PlaneBrick& brick, const PlaneBox& box);
  void test_next(PlaneTouch& touch, const PlaneBox& a, const PlaneBox& b) const;
  static void accept(PlaneTouch& touch);
  void find_near_pairs();
  double first_impact(double time);
  double impact_of(const PlaneTouch& touch, const PlanePoint& point, double time) const;
  double distance_at(const PlaneTouch& touch, std::uint8_t feature, double time, double whole) const;
  PlaneBox box_at(const PlaneBrick& brick, double time, double whole) const;
  void accept_drift(double cut, double whole);
  bool activate_new_points();
  void take_blow(double whole, double next, bool ends_step);
  void stop_at_once();
  bool blow(bool always);
  void give_back();
  void bounce_by(double share);

  void keep_what_stays(PlaneTouch& touch, int place) const;
  void begin_push(const Push& push, double now);
  void note_arrivals(double begin, double time, double whole);
  void note_struck(double now);
  void note_landed(double now);
  void note_rest(int place, double now);
  BrickId supporter(int place) const;
  Vec3 in_world(double x, double z) const;
  static SinCos half_turn(const PlaneBox& box);
  Pose pose_of(const PlaneBrick& brick) const;

  RowPlane plane_;
  double half_width_ = 0.0;  // Widest of its bricks [m].
  bool leaves_plane_ = false;
  int moving_ = 0;
  double stride_ = 0.0;       // The step, or a part of it: how long drifts are [s].
  double planned_for_ = 0.0;  // `middle` is good for a drift of this time [s]; 0: for none.
  bool rested_ = false;       // Some brick came to rest since the lists were made.
  std::vector<PlaneBrick> bricks_, spare_;
  std::vector<PlaneTouch> touches_;
  std::vector<int> near_pairs_;  // Those that have points, or may have some at the end of the drift that is tried.
  std::vector<PlaneRow> rows_, compression_;
  std::vector<PlaneUnknown> unknowns_, before_blow_;
  struct Force {
    BrickId brick = kNoBrick;
    double along = 0.0;       // [N]
    double x = 0.0, z = 0.0;  // Where it acts, in the brick's own axes [m].
    double end = 0.0;         // [s]
  };
  std::vector<Force> forces_;
  struct Struck {
    BrickId brick, by;
  };
  std::vector<Struck> struck_now_;
  Pattern strike_;                 // How the last strike went,
  std::array<Pattern, 16> leaps_;  // and the leaps after it.
  BrickId last_struck_ = kNoBrick;
  std::size_t since_strike_ = 0;
  std::vector<BrickId> near_;
  std::vector<int> renamed_, by_place_;
  PlaneSolver solver_;
};

}  // namespace topple::rigid

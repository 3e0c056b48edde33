/// The train: the bricks that move together behind one front, as the cooperative chain of [vanLeeuwen2010] sees them.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "topple/base.h"

namespace topple::hinge {

/// One brick of a train, and how it leans on the brick ahead of it.
struct TrainBrick {
  BrickId id = kNoBrick;
  bool on_heel = false;     ///< Its front face rests on the rear bottom edge of the brick ahead, not its top edge on that one's rear face.
  bool arrived = false;     ///< Its tilt has passed 10 degrees.
  double inertia = 0.0;     ///< About its toe [kg m^2].
  double torque_sin = 0.0;  ///< Torque about the toe = torque_sin sin(angle) + torque_cos cos(angle) [N m].
  double torque_cos = 0.0;  ///< [N m]
  double height = 0.0;      ///< [m]
  double thickness = 0.0;   ///< [m]
  // How it leans on the brick ahead; without meaning for the front.
  double pitch = 0.0;            ///< Toe to toe, as a fraction of its height.
  double thickness_ahead = 0.0;  ///< As a fraction of its height.
  double friction = 0.0;         ///< Brick on brick.
  double hit_angle = 0.0;        ///< Its tilt when it strikes the next brick; without meaning if there is none [rad].
  // Where it was when the train was placed last.
  double angle = 0.0;      ///< [rad]
  double sine = 0.0;       ///< Of the angle, and
  double cosine = 1.0;     ///< its cosine; not kept where a sweep ended.
  double ratio = 1.0;      ///< d angle / d front angle.
  double curvature = 0.0;  ///< d ratio / d front angle [1/rad].
  double bound = 1.0;      ///< Upper bound of the ratio from there on.
  // The same where the last sweep ended.
  double goal_lean = 0.0;  ///< Sine of its angle against the brick ahead.
  double goal_ratio = 1.0;
  double goal_curvature = 0.0;
  double goal_bound = 1.0;
  std::array<double, 2> way_ratio{};  ///< At the first and third of the sweep's four angles.
};

/// A brick of the train at an angle of the front.
struct TrainView {
  BrickId id = kNoBrick;
  double angle = 0.0;  ///< [rad]
  double sine = 0.0;
  double cosine = 1.0;
  double ratio = 1.0;      ///< d angle / d front angle.
  double curvature = 0.0;  ///< d ratio / d front angle [1/rad].
};

/// What the whole train is to its front brick: inertia x acceleration = torque - coupling x rate^2.
struct FrontView {
  double inertia = 0.0;   ///< [kg m^2]
  double torque = 0.0;    ///< [N m]
  double coupling = 0.0;  ///< [kg m^2/rad]

  double acceleration(double rate) const { return (torque - coupling * rate * rate) / inertia; }
};

/// The train at four angles of its front.
struct Sweep {
  std::array<FrontView, 4> views;
  bool turns_over = false;  ///< At the last of them a lean has passed the end of its edge by more than the slack,
  bool touches = false;     ///< or is about there.
};

class Train {
 public:
  bool empty() const { return bricks_.size() == first_; }
  std::size_t size() const { return bricks_.size() - first_; }
  /// Bricks from the front (0) to the back.
  TrainBrick& at(std::size_t index) { return bricks_[bricks_.size() - 1 - index]; }
  const TrainBrick& at(std::size_t index) const { return bricks_[bricks_.size() - 1 - index]; }

  void clear();
  /// Whether its motion from here on is that of the other, to the last bit. What neither keeps to the next event does not count.
  bool moves_as(const Train& other) const;
  void add_front(const TrainBrick& brick) { bricks_.push_back(brick); }
  void drop_front() { bricks_.pop_back(); }

  /// The train at an angle of its front; `direction` is +1 where it falls, -1 where it returns, which turns the friction round.
  FrontView view(double front_angle, double direction) const;

  /// The same, and writes angle, ratio and curvature of every brick.
  FrontView place(double front_angle, double direction);

  /// The same, and says of every brick, from the front to the back, where it is there; the train stays placed where it was.
  FrontView look(double front_angle, double direction, std::vector<TrainView>& out) const;

  /// At four angles at once, at little more than the cost of one. What the last of them is for each brick is kept.
  Sweep sweep(const std::array<double, 4>& front_angles, double direction, double slack);
  /// Puts the train where the last sweep ended.
  void place_at_goal(double front_angle);

  /// Energy of the train's motion where its front is, over half the square of the front's rate [kg m^2], and the work of its torques
  /// from upright to there [J].
  struct Works {
    double motion = 0.0;
    double torques = 0.0;
  };
  Works works(double front_angle) const;

  /// The angle of brick `index` at an angle of the front [rad].
  double angle_of(std::size_t index, double front_angle) const;

  /// How far each brick is from turning over from its edge to its heel, (pitch cos(angle ahead) - thickness ahead) / height, from the
  /// front (which has none) to brick out.size() - 1: > 0 where it leans on its edge, < 0 on its heel.
  void edges(double front_angle, std::span<double> out) const;
  /// The same where the last sweep ended, for bricks that lean on their edge.
  void goal_edges(std::span<double> out) const;
  /// The front angle at which the lean of brick `index` turns over from its edge, where none before it is on its heel; otherwise not a
  /// number [rad].
  double turn_over_angle(std::size_t index) const;

  /// Momentum that an impact keeps, taken about the front brick [kg m^2/s]: the rates are given, the arms are those of where the
  /// train was placed last.
  double front_momentum(std::span<const double> rates, double direction) const;

  /// A brick that stands is the new front, struck by the old one. The view is that of the old front where the train was placed last.
  FrontView strike(const TrainBrick& standing, const FrontView& old);

  /// Torque with which the resting bricks behind turn the last brick of the train [N m].
  double load() const { return load_; }

  /// Upper bound of what the last brick can still turn while the front goes from here to the floor [rad].
  double last_travel(double front_angle) const;

  /// Takes the last brick out. It leans on the new last one from then on with the weight of all those behind it.
  TrainBrick drop_last(double direction);

 private:
  std::vector<TrainBrick> bricks_;  ///< The front is the last element, so that a new front is appended.
  std::size_t first_ = 0;           ///< Index of the last brick of the train in `bricks_`.
  double load_ = 0.0;               ///< See load().
};

}  // namespace topple::hinge

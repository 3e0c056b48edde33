/// A chain: the wave that runs from one pushed brick along its row.
#pragma once

#include <span>
#include <vector>

#include "model/hinge/leg.h"
#include "model/hinge/links.h"
#include "topple/model.h"

namespace topple::hinge {

/// What all chains share. Nothing of it changes but where bricks came to rest.
struct HingeScene {
  const Layout* layout = nullptr;
  std::vector<Link> links;
  double rest_tolerance = 0.0;  ///< HingeConfig::rest_tolerance.
  double time_step = 0.0;       ///< Of the model [s].
  double slow_step = 0.0;       ///< Time step where a train is slow [s].
  /// Where each brick is: its angle where it rests [rad], 0 while it stands, kInTrain while it moves.
  std::vector<float> angles;

  static constexpr float kInTrain = -1.0F;
  const BrickKind& kind_of(BrickId brick) const { return layout->kind_of(brick); }
  const Link& link_of(BrickId brick) const { return links[static_cast<std::size_t>(brick)]; }
  float& angle_of(BrickId brick) { return angles[static_cast<std::size_t>(brick)]; }
};

/// What happened in a step.
struct Happenings {
  std::vector<Event> events;
  std::vector<Kink> kinks;
  std::vector<HingedMotion> stopped;  ///< Bricks that came to rest.
  double settled = 0.0;               ///< Potential energy that went into bricks at rest [J].
  double work = 0.0;                  ///< Of pushes [J].

  void clear();
};

class Chain {
 public:
  /// `pushes` are those of one brick, by time.
  Chain(HingeScene& scene, std::vector<Push> pushes);

  /// Moves on to a time [s].
  void advance(double until, Happenings& out);

  bool moving() const { return moving_; }
  bool done() const { return !moving_ && next_change_ == changes_.size(); }  ///< Nothing more will happen.
  BrickId front() const { return train_.empty() ? kNoBrick : train_.at(0).id; }
  bool finite() const;

  /// The bricks of the moving train where advance() left them, appended.
  void read(std::vector<HingedMotion>& out) const;
  Energy energy() const;  ///< Of the moving train.
  /// What its bricks press on each other and the floor on them, appended.
  void read(std::vector<Contact>& out) const;

 private:
  struct Change {  // A push begins, or a force ends.
    double time = 0.0;
    std::size_t push = 0;
    bool ends = false;
  };
  enum class Goal : std::uint8_t { hit, lean, floor, turn_over, upright };
  struct Arrival {
    double time = 0.0;
    BrickId brick = kNoBrick;
  };

  TrainBrick make_brick(BrickId id) const;
  std::size_t index_of(BrickId id) const;  // In the train; its size if it is not there.
  HingedState state_of(const TrainBrick& brick) const {
    return {brick.angle, brick.ratio * state_.rate, brick.ratio * state_.acceleration + brick.curvature * state_.rate * state_.rate};
  }

  void apply(const Change& change, Happenings& out);
  void apply_force(const Push& push, double sign, Happenings& out);
  void apply_blow(const Push& push, Happenings& out);
  bool join_standing(BrickId id);
  void wake(Happenings& out);
  void begin_motion();
  void add_work(Happenings& out);

  void start_leg();
  void choose_goal();
  LegGoal leg_goal() const;
  double lean_angle(BrickId id, BrickId next) const;
  void find_turn_over(double from);
  void find_arrivals();
  void emit_arrivals(double until, Happenings& out);

  void finish_leg(Happenings& out);
  void turn_over(Happenings& out);
  void hit(Happenings& out);
  void stand_up(Happenings& out);
  void retire(Happenings& out);
  void settle(const TrainBrick& brick, BrickId by, bool landed, Happenings& out);
  void rest_all(bool front_landed, BrickId by, Happenings& out);
  bool missed_next(BrickId id) const;
  double potential(const TrainBrick& brick, double s, double c) const;  // s, c: sine and cosine of its angle.
  double kinetic() const;
  void restart(double rate);
  void remember_states();
  void add_kinks(Happenings& out);

  HingeScene* scene_;
  std::vector<Push> pushes_;
  std::vector<Change> changes_;
  std::size_t next_change_ = 0;

  Train train_;
  FrontState state_;
  FrontView view_;  // The train at state_, where no leg is under way.
  double direction_ = 1.0;
  bool moving_ = false;
  Leg leg_;
  Goal goal_ = Goal::floor;
  double goal_angle_ = 0.0;
  std::vector<Arrival> arrivals_;  // Of this leg, by time.
  std::size_t next_arrival_ = 0;

  // The forces that act now.
  int acting_ = 0;
  BrickId forced_ = kNoBrick;
  double force_ = 0.0;         // Their sum [N].
  double force_moment_ = 0.0;  // The sum of force x height [N m].
  double worked_to_ = 0.0;     // The angle up to which their work has been counted [rad].

  std::vector<HingedState> before_;  // From the back of the train to the front.
  std::vector<double> rates_;        // Scratch, from the front to the back.
  std::vector<double> edges_;
};

}  // namespace topple::hinge

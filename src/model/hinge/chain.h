/// A chain: the wave that runs from one pushed brick along its row.
#pragma once

#include <bit>
#include <span>
#include <vector>

#include "base/hash.h"
#include "base/trigonometry.h"
#include "model/hinge/leg.h"
#include "model/hinge/links.h"
#include "topple/model.h"

namespace topple::hinge {

/// What all chains share. Nothing of it changes but where bricks came to rest.
struct HingeScene {
  const Layout* layout = nullptr;
  std::vector<Link> links;
  double rest_tolerance = 0.0;  ///< HingeConfig::rest_tolerance.
  bool repeats = true;          ///< HingeConfig::repeats.
  double slow_step = 0.0;       ///< Time step where a train is slow [s].
  /// Where each brick is: its angle where it rests [rad], 0 while it stands, kInTrain while it moves.
  std::vector<float> angles;
  double last_heading = 0.0;  ///< Of the brick that was struck last [rad], with its sine and cosine: a row has one.
  SinCos last_turn{0.0, 1.0};

  static constexpr float kInTrain = -1.0F;
  const BrickKind& kind_of(BrickId brick) const { return layout->kind_of(brick); }
  const Link& link_of(BrickId brick) const { return links[static_cast<std::size_t>(brick)]; }
  float& angle_of(BrickId brick) { return angles[static_cast<std::size_t>(brick)]; }
};

/// What happened in a step.
struct Happenings {
  Hash hash;  ///< Of every kink since the run began.
  std::vector<Event> events;
  std::vector<Kink> kinks;
  std::vector<Echo> echoes;
  std::vector<HingedMotion> stopped;  ///< Bricks that came to rest.
  double settled = 0.0;               ///< Potential energy that went into bricks at rest [J].
  double work = 0.0;                  ///< Of pushes [J].

  void clear();
  void tell(const Kink& kink) {
    kinks.push_back(kink);
    pass(kink.brick, kink.time, kink.after);
  }
  /// Something that an echo will tell.
  void pass(BrickId brick, double time, const HingedState& after) {
    hash.add(mixed(std::bit_cast<std::uint64_t>(time) + static_cast<std::uint64_t>(brick), after.angle, after.rate));
  }
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

  /// The bricks of the moving train at the time to which advance() went, appended.
  void read(std::vector<HingedMotion>& out) const;
  void tell_silent(std::vector<Kink>& out) const;  ///< The kinks of moving bricks of which none has been told, since an echo might do.
  Energy energy() const;                           ///< Of the moving train.
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
    std::size_t place = 0;  // In the train.
  };
  /// A kink of the leg and hit that repeat themselves.
  struct Repeated {
    std::size_t place = 0;  // From the back of the train before the hit; the struck brick comes last.
    double offset = 0.0;    // Since the hit before [s].
    HingedState before, after;
  };
  /// An even row, once the train after a hit is to the last bit the train after the hit before: the next leg and the next hit are then
  /// these again, one brick on. See chain_repeat.cpp.
  struct Repeat {
    bool on = false;
    Train train;            // After the last hit, while it may come to repeat itself.
    double rate = 0.0;      // Of the front after the last hit [rad/s].
    std::size_t legs = 0;   // Since the last hit.
    std::size_t kinks = 0;  // That were told in this step before this leg ended.
    TrainBrick rested;      // The last brick that left the train.
    double settled = 0.0;   // Its potential energy there [J].
    double impulse = 0.0;   // Of the hit [N s].
    std::vector<Repeated> told;
    std::vector<bool> arrived;  // By place from the front, after a hit.
    std::size_t open = 0;       // So many bricks at the back are told by kinks, those ahead of them will be by echoes.
    BrickId like = kNoBrick;    // What they are echoes of.
    double like_start = 0.0;    // [s]
    std::size_t hits = 0;       // That were not computed.
    std::vector<double> times;  // Of the last of them, hit n at n modulo the size; hit 0 is the last that was computed [s].
  };

  FrontState now() const;  // At the time to which advance() went.
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
  double force_work(double angle) const;

  void start_leg(Happenings& out);
  void choose_goal();
  LegGoal leg_goal() const;
  double lean_angle(BrickId id, BrickId next) const;
  void find_turn_over(double from);
  void find_edges();
  double turn_over_angle(std::size_t k, double from);
  void find_arrivals();
  void emit_arrivals(double until, Happenings& out);

  void finish_leg(Happenings& out);
  void turn_over(Happenings& out);
  void hit(Happenings& out);
  void add_strike(BrickId id, BrickId by, double impulse, Happenings& out);
  void stand_up(Happenings& out);
  std::size_t retire(Happenings& out);
  void settle(const TrainBrick& brick, BrickId by, bool landed, Happenings& out);
  void settle_with(double energy, const TrainBrick& brick, BrickId by, bool landed, Happenings& out);
  void rest_all(bool front_landed, BrickId by, Happenings& out);
  void rest_from_before(bool front_landed, BrickId by, Happenings& out);
  bool missed_next(BrickId id) const;
  double potential(const TrainBrick& brick, double s, double c) const;  // s, c: sine and cosine of its angle.
  double kinetic() const;
  void restart(double rate);

  void states(std::vector<HingedState>& out) const;
  void remember_states() { states(before_); }
  void end_curves(Happenings& out);
  bool curves_are_close() const;
  void add_points(Happenings& out) const;
  void add_kinks(Happenings& out, std::size_t skipped = 0);

  void look_for_repeat(Happenings& out);
  void begin_repeat(const Happenings& out);
  bool next_is_alike() const;
  void repeat_hit(Happenings& out);
  void end_repeat(Happenings& out);

  HingeScene* scene_;
  std::vector<Push> pushes_;
  std::vector<Change> changes_;
  std::size_t next_change_ = 0;

  Train train_;
  FrontState state_;
  FrontView view_;  // The train at state_, where no leg is under way.
  double direction_ = 1.0;
  bool moving_ = false;
  Leg leg_;                 // Its times count from its start.
  double leg_start_ = 0.0;  // [s]
  double now_ = 0.0;        // How far the leg has gone [s].
  Goal goal_ = Goal::floor;
  double goal_angle_ = 0.0;
  std::vector<Arrival> arrivals_;  // Of this leg, by time since its start.
  std::size_t next_arrival_ = 0;

  // The forces that act now.
  int acting_ = 0;
  BrickId forced_ = kNoBrick;
  double force_ = 0.0;         // Their sum [N].
  double force_moment_ = 0.0;  // The sum of force x height [N m].
  double worked_to_ = 0.0;     // The angle up to which their work has been counted [rad].

  // From the back of the train to the front: where the leg began, and before what happens now.
  std::vector<HingedState> began_;
  std::vector<HingedState> before_;
  Repeat repeat_;
  std::vector<double> rates_;  // Scratch, from the front to the back.
  std::vector<double> edges_;
};

}  // namespace topple::hinge

/// A front as the model sees it: bricks that move together, whatever the way they are computed in.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/hash.h"
#include "model/rigid/world.h"

namespace topple::rigid {

/// Where a push dies one brick rocks or two, and there is little energy to compare errors with: then steps are shorter. It costs
/// little, with so few.
inline constexpr int kFew = 3, kStridesOfFew = 3;

/// A push that begins, or a force that ends, inside a step.
struct PushMoment {
  double time = 0.0;
  const Push* push = nullptr;  ///< Null: the force of `brick` ends.
  BrickId brick = kNoBrick;
};

/// A push at work on one brick.
struct ActiveForce {
  BrickId brick = kNoBrick;
  Vec3 force;        ///< World [N].
  Vec3 point;        ///< Where it acts, in the brick's axes [m].
  double end = 0.0;  ///< [s]
};

/// A brick that moves, as one kind of front hands it over to another.
struct HandedBrick {
  BrickId brick = kNoBrick;
  Pose pose;
  Vec3 velocity;          ///< [m/s]
  Vec3 angular_velocity;  ///< World axes [rad/s].
  double quiet = 0.0;     ///< How long it has hardly moved [s].
  bool pushed = false;
  bool landed = false;
};

/// A brick that is hit while it stands or rests, and the one that hits it.
struct Struck {
  BrickId brick = kNoBrick, by = kNoBrick;
};

/// One without force, impulse and point.
Event plain_event(EventKind kind, double time, BrickId brick, BrickId by);

/// While fronts are advanced they may run side by side: advance() reads the world and writes to the front's own ledger alone.
class Wave {
 public:
  explicit Wave(World& world, std::int32_t number) : world_(world) { ledger_.front = number; }
  Wave(const Wave&) = delete;
  Wave& operator=(const Wave&) = delete;
  virtual ~Wave() = default;

  /// One whole step from `begin` [s]; `moments` in the order of time. Bricks that have become quiet go to rest at its end.
  virtual void advance(double begin, std::span<const PushMoment> moments) = 0;
  /// Takes a brick out of its rest.
  virtual void wake(BrickId brick, double time) = 0;
  virtual bool at_rest() const = 0;
  virtual void add_to(Hash& hash) const = 0;
  /// A brick whose numbers are not finite, or none.
  virtual BrickId not_finite() const = 0;
  /// How many bricks moved in the last step.
  virtual std::size_t motion_count() const = 0;
  /// Writes those bricks, so many, and adds the energy of what moves, where it is wanted.
  virtual void read(std::span<FreeMotion> out, Energy* energy) const = 0;
  virtual void read(std::vector<Contact>& out) const = 0;
  /// Whether it cannot go on by itself: bricks of another front are within reach, or what it cannot compute.
  virtual bool must_join() const = 0;
  /// Adds what has moved without being among those bricks, as far as it is not to be echoed.
  virtual void tell_unseen(std::vector<UnseenMotion>& /*out*/) const {}
  virtual bool general() const = 0;  ///< Six degrees of freedom a brick: its steps are long.

  std::int32_t number() const { return ledger_.front; }
  std::span<const Event> events() const { return ledger_.events; }
  /// What is to be told of motions that were not among those of their steps; empty afterwards.
  void hand_out(std::vector<Echo>& echoes, std::vector<BrickId>& echoed, std::vector<UnseenMotion>& unseen);
  std::span<const std::int32_t> met() const { return ledger_.met; }  ///< Other fronts whose bricks are within reach.

  // What it did, entered in the world; between steps, and for one front after the other.
  void enter_leavings();
  void enter_takings(bool of_those_that_move);  // May change motion_count().
  void enter_changes() { world_.enter(ledger_); }
  /// All of it, for a front that works alone.
  void enter_all();
  /// A front of which nothing moves: its bricks belong to nobody.
  virtual void disband() = 0;

 protected:
  virtual bool moves(BrickId brick) const = 0;
  /// From now on a brick belongs to nobody; whether it belonged to this front.
  bool disown(BrickId brick);
  void tell_arrival(BrickId brick, double time);
  /// A brick comes to rest, fallen or not, on another one or on none; `landed` if that has been told.
  void tell_rest(BrickId brick, bool fallen, bool landed, BrickId by, double now);
  /// Another front has taken, in the same step, a brick that this one took too.
  virtual void lose(BrickId brick) = 0;

  World& world_;
  Ledger ledger_;
  std::vector<Echo> echoes_;
  std::vector<BrickId> echoed_;
  std::vector<UnseenMotion> unseen_;
};

}  // namespace topple::rigid

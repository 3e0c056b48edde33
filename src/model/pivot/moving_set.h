/// The bricks in motion, and what stays of all others: a brick moves between the two.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "model/pivot/fall.h"
#include "model/pivot/lean.h"
#include "model/pivot/lines.h"
#include "topple/model.h"

namespace topple::pivot {

/// What all bricks of a kind in a stance share.
struct Body {
  Extents size;          ///< [m]
  double mass = 0.0;     ///< [kg]
  double inertia = 0.0;  ///< [kg m^2]
  double settle = 0.0;   ///< sqrt(H / g): the time scale of its fall [s].
  double slack = 0.0;    ///< What it may still turn when it rests [rad].
  Turning turning;
};

/// A brick in motion.
struct Moving {
  BrickId brick = kNoBrick;
  std::int32_t depth = 0;
  std::int8_t side = 1;  ///< +1 about its toe, -1 about its heel.
  Phase phase = Phase::falling;
  bool leaning = false;       ///< Held by a brick ahead.
  bool on_rear_edge = false;  ///< How it leans, see Bound.
  bool follows = false;       ///< Leans, and so do its neighbours: nothing needs it at every step.
  bool may_hit = true;        ///< A brick ahead still stands and was not struck.
  bool held_up = false;       ///< Fell back onto the brick behind it.
  const Body* body = nullptr;
  Turning turning;              ///< With the force that acts on this brick.
  Fall fall;                    ///< Now.
  double acceleration = 0.0;    ///< Now [rad/s^2].
  double report_torque = 0.0;   ///< Of the force that acts on it, with the arm that (2.5) gives it [N m].
  std::int32_t first_push = 0;  ///< The push that began its line.
  std::vector<Kink> kinks;      ///< Its latest, for those that follow it.
  std::vector<Pair> ahead;      ///< One for each brick that it strikes.
  std::optional<Pair> behind;   ///< With the brick behind while that one rests on it.
};

class MovingSet {
 public:
  MovingSet(const Layout& layout, const PivotConfig& config, Lines lines);

  /// From the last of each line to its first: a brick comes after all that it leans on.
  const std::vector<std::int32_t>& order() const { return order_; }
  Moving& operator[](std::int32_t slot) { return pool_[static_cast<std::size_t>(slot)]; }
  const Moving& operator[](std::int32_t slot) const { return pool_[static_cast<std::size_t>(slot)]; }

  /// Null if it does not move.
  Moving* find(BrickId brick) {
    const std::int32_t slot = slot_[static_cast<std::size_t>(brick)];
    return slot < 0 ? nullptr : &pool_[static_cast<std::size_t>(slot)];
  }
  const Moving* find(BrickId brick) const {
    const std::int32_t slot = slot_[static_cast<std::size_t>(brick)];
    return slot < 0 ? nullptr : &pool_[static_cast<std::size_t>(slot)];
  }
  /// The brick behind, if that one moves.
  const Moving* find_behind(BrickId brick) const {
    const BrickId behind = lines_.behind[static_cast<std::size_t>(brick)];
    return behind == kNoBrick ? nullptr : find(behind);
  }
  double tilt(BrickId brick) const {  ///< Of any brick [rad].
    const Moving* moving = find(brick);
    return moving == nullptr ? double{still(brick).tilt} : moving->fall.theta;
  }
  Fall at_rest(BrickId brick) const { return fall_at(0.0, double{still(brick).tilt}, 0.0); }  ///< One that does not move.
  const Lines& lines() const { return lines_; }

  Moving& wake(BrickId brick, double time);
  void rest(std::int32_t slot);  ///< The slot may be used again from now on; sweep() takes it out of the order.
  void sweep();

  const Body& body_of(BrickId brick) const;

  // What stays of each brick, shape [brick_count].
  struct Still {
    float tilt = 0.0F;     ///< At which it rests [rad].
    bool struck = false;   ///< The brick behind has hit it: later contacts are leaning.
    bool arrived = false;  ///< Its tilt has passed 10 degrees.
    bool landed = false;
    bool rested = false;
  };
  Still& still(BrickId brick) { return still_[static_cast<std::size_t>(brick)]; }
  const Still& still(BrickId brick) const { return still_[static_cast<std::size_t>(brick)]; }

 private:
  bool after(std::int32_t a, std::int32_t b) const;

  const Layout& layout_;
  Lines lines_;
  std::vector<Body> bodies_;  ///< [kind * 3 + stance]
  std::vector<Still> still_;
  std::vector<std::int32_t> slot_;  ///< [brick_count], -1 for a brick that does not move.
  std::vector<Moving> pool_;
  std::vector<std::int32_t> free_;
  std::vector<std::int32_t> order_;
};

}  // namespace topple::pivot

/// Even rows: what a plane front does not compute again.
///
/// Some dozens of strikes into an even row a front is, right after a strike, what it was right after the strike before: all that was there
/// before has been forgotten, at a rate that a row's friction and gap set. Once every number is within a hundred-millionth of what it was,
/// it is made exactly that. Then all that follows until the next strike follows again, one brick further, and so on to the row's end: only
/// names and times are new. Drifts begin at the strikes (plane_front.cpp), not at the steps, and places count from the brick that was
/// struck; without that no two strikes would be alike.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/rigid/plane_cycle.h"

namespace topple::rigid {

/// A cycle that is told again, one brick further each time; what is told, and to whom, is the front's. Meanwhile PlaneState is that after
/// the last strike.
class PlaneRepeat {
 public:
  PlaneRepeat(const World& world, const RowPlane& plane, const PlaneState& state, const PlaneCycle& cycle)
      : world_(world), plane_(plane), state_(state), cycle_(cycle) {}

  /// From the strike of this moment on [s], along the row by `way`: 1 or -1.
  void begin(BrickId way, double now);
  void end() { on_ = false; }
  bool is_on() const { return on_; }

  const PlaneCycle::Drift& drift() const { return cycle_.drifts()[drift_]; }  ///< The one under way.
  /// Its arrivals up to so long after it began [s] that have not been told.
  std::span<const PlaneCycle::Arrival> arrivals_until(double time);
  /// Goes on to the next drift; false if that was the last before a strike.
  bool go_on();
  /// The next brick was struck: the front's numbers are one further.
  void strike(double now);

  /// Whether a brick's motion is left to an echo,
  bool is_unseen(BrickId brick) const { return on_ && way_ * (brick - like_) > 0; }
  /// which is this one, since both began to be recorded.
  Echo echo_of(BrickId brick) const;
  PlaneBrick brick_of(const PlaneCycle::Place& place) const;  ///< As the drift under way began.
  /// Adds every brick that has moved unseen, at the beginnings of all drifts since it was struck.
  void tell_unseen(std::vector<UnseenMotion>& out) const;

 private:
  double struck_at(BrickId brick) const { return times_[static_cast<std::size_t>(way_ * (brick - like_)) % times_.size()]; }
  void tell_motion(BrickId id, int strikes, std::vector<UnseenMotion>& out) const;

  const World& world_;
  const RowPlane& plane_;
  const PlaneState& state_;
  const PlaneCycle& cycle_;
  bool on_ = false;
  BrickId way_ = 0;
  std::size_t drift_ = 0;      // Of the cycle: the one under way.
  std::size_t arrivals_ = 0;   // Of that drift, told already.
  BrickId like_ = kNoBrick;    // Whose motion is that of all that are struck after it,
  double like_struck_ = 0.0;   // and when it was struck [s].
  std::int64_t strikes_ = 0;   // Since then.
  std::vector<double> times_;  // When the last of them were [s].
  PlaneBrick one_;             // What all bricks have in common.
};

}  // namespace topple::rigid

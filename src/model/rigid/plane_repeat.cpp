#include "model/rigid/plane_repeat.h"

namespace topple::rigid {

void PlaneRepeat::begin(BrickId way, double now) {
  on_ = true;
  way_ = way;
  drift_ = arrivals_ = 0;
  like_ = state_.last_struck;
  like_struck_ = now;
  strikes_ = 0;
  times_.assign(state_.bricks.size() + 1, now);
  one_ = state_.brick(state_.place_of(like_));
}

std::span<const PlaneCycle::Arrival> PlaneRepeat::arrivals_until(double time) {
  const std::vector<PlaneCycle::Arrival>& all = drift().arrivals;
  const std::size_t begin = arrivals_;
  while (arrivals_ < all.size() && all[arrivals_].time <= time) ++arrivals_;
  return std::span(all).subspan(begin, arrivals_ - begin);
}

bool PlaneRepeat::go_on() {
  arrivals_ = 0;
  return ++drift_ < cycle_.drifts().size();
}

void PlaneRepeat::strike(double now) {
  drift_ = 0;
  times_[static_cast<std::size_t>(++strikes_) % times_.size()] = now;
}

// Both began to be recorded within the step before they were struck.
Echo PlaneRepeat::echo_of(BrickId brick) const { return {brick, like_, struck_at(brick) - world_.step, like_struck_ - world_.step}; }

PlaneBrick PlaneRepeat::brick_of(const PlaneCycle::Place& place) const {
  PlaneBrick brick = one_;
  brick.id = state_.last_struck + place.brick;
  brick.landed = place.landed;
  brick.quiet = place.quiet;
  brick.stand = place.stand;
  brick.box.place = place.place;
  brick.velocity = place.velocity;
  brick.middle = place.middle;
  brick.listed_at = place.listed_at;
  set_turn(brick.box);
  return brick;
}

void PlaneRepeat::tell_unseen(std::vector<UnseenMotion>& out) const {
  if (!on_) return;
  for (const PlaneCycle::Place& now : drift().places) {
    if (is_unseen(state_.last_struck + now.brick)) tell_motion(state_.last_struck + now.brick, -way_ * now.brick, out);
  }
}

// Of a brick that was struck so many strikes before the last: it did what one does now that was struck last, then the one behind that...
void PlaneRepeat::tell_motion(BrickId id, int strikes, std::vector<UnseenMotion>& out) const {
  PlaneBrick brick = one_;
  brick.id = id;
  double time = struck_at(id);
  out.push_back({time, motion_of(plane_, world_, brick, Phase::standing)});
  for (int behind = 0; behind <= strikes; ++behind) {
    const std::size_t drifts = behind < strikes ? cycle_.drifts().size() : drift_ + 1;
    for (std::size_t i = 0; i < drifts; ++i) {
      const PlaneCycle::Drift& drift = cycle_.drifts()[i];
      for (const PlaneCycle::Place& place : drift.places) {
        if (place.brick != -way_ * behind || (behind == 0 && i == 0)) continue;
        brick.stand = place.stand;
        brick.box.place = place.place;
        brick.velocity = place.velocity;
        set_turn(brick.box);
        out.push_back({time, motion_of(plane_, world_, brick, Phase::falling)});
      }
      time += drift.cut;
    }
  }
}

}  // namespace topple::rigid

// Leans that turn over: from the edge of the brick behind to the heel of the brick ahead, and back.
#include <cmath>
#include <limits>

#include "model/hinge/chain.h"
#include "model/hinge/root.h"

namespace topple::hinge {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// A lean turns over once its edge is this close to the end of its way; a pure number, far above rounding.
constexpr double kTurnOver = 1e-9;

}  // namespace

// Whether a lean turns over before the goal; if so, that is where the leg ends.
void Chain::find_turn_over(double from) {
  find_edges();
  for (std::size_t k = 1; k < train_.size(); ++k) {
    const TrainBrick& brick = train_.at(k);
    if (brick.on_heel == (direction_ > 0.0)) continue;
    // One that goes past it by less than what a resting brick may still move is turned over at the end of the leg.
    const double slack = 0.1 * scene_->rest_tolerance * brick.thickness_ahead;
    if (direction_ * rates_[k] >= -slack) continue;
    const double angle = turn_over_angle(k, from);
    if (!(direction_ * (goal_angle_ - angle) > 0.0)) continue;
    goal_angle_ = angle;
    goal_ = Goal::turn_over;
    if (k + 1 < train_.size()) train_.edges(goal_angle_, rates_);
  }
}

// Into rates_, how far each lean is from turning over at the goal, or where the leg has ended there.
void Chain::find_edges() {
  rates_.resize(train_.size());
  if (leg_.swept && direction_ > 0.0) {
    train_.goal_edges(rates_);
  } else {
    train_.edges(goal_angle_, rates_);
  }
}

// The angle of the front at which the lean of brick k turns over; not a number if it has done so at `from` [rad].
double Chain::turn_over_angle(std::size_t k, double from) {
  if (direction_ > 0.0) {
    if (train_.at(k).angle <= train_.at(k - 1).angle) return kNone;
    if (const double angle = train_.turn_over_angle(k); angle == angle) return angle;
  }
  edges_.resize(k + 1);
  const auto edge = [&](double angle) {
    train_.edges(angle, edges_);
    return edges_[k];
  };
  const double at_from = edge(from);
  return direction_ * at_from <= 0.0 ? kNone : root(from, goal_angle_, at_from, edge(goal_angle_), edge);
}

// The front faces of bricks that come to lie flush with the rear faces ahead stop at their heels: an inelastic hit.
void Chain::turn_over(Happenings& out) {
  find_edges();
  bool any = false;
  for (std::size_t k = 1; k < train_.size(); ++k) {
    if (train_.at(k).on_heel == (direction_ > 0.0) || direction_ * rates_[k] > kTurnOver) continue;
    any = true;
    train_.at(k).on_heel = direction_ > 0.0;
  }
  if (!any) return;
  for (std::size_t k = 0; k < train_.size(); ++k) rates_[k] = before_[train_.size() - 1 - k].rate;
  view_ = train_.place(state_.angle, direction_);
  const double rate = train_.front_momentum(rates_, direction_) / view_.inertia;
  state_.rate = direction_ * rate > 0.0 ? rate : 0.0;
  state_.acceleration = view_.acceleration(state_.rate);
  add_kinks(out);
  if (state_.rate == 0.0) {
    begin_motion();
    if (!moving_) return rest_all(false, kNoBrick, out);
    remember_states();
    restart(0.0);
    add_kinks(out);
  }
  remember_states();
  if (direction_ > 0.0 && retire(out) > 0) remember_states();
  began_ = before_;
}

}  // namespace topple::hinge

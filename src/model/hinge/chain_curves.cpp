// What a chain tells of the way of its bricks: from one kink to the next each moves along a quintic.
#include <cmath>

#include "model/hinge/chain.h"

namespace topple::hinge {

namespace {

// How far a corner may be from the quintic between two kinks, as a fraction of the thickness: what Frame::curved promises.
constexpr double kCurve = 1e-4;

// A quintic that has angle, rate and acceleration at both ends of a time T errs by C u^3 (1 - u)^3, u = time / T, as far as what it lacks
// is of the sixth power: at most C / 64. Its slope then errs by 3 C u^2 (1 - u)^2 (1 - 2 u), which at Lobatto's second and fourth point,
// u = 0.1727 and 0.8273 in the angle and about there in time, is 2.57 times as much.
constexpr double kMissOfSlope = 0.39;

// The slope at u of the quintic between two states, `span` apart, for u from 0 to 1 [rad].
double slope(const HingedState& from, const HingedState& to, double span, double u) {
  const double c1 = from.rate * span;
  const double c2 = 0.5 * from.acceleration * span * span;
  const double angle = to.angle - from.angle - c1 - c2;
  const double rate = to.rate * span - c1 - 2.0 * c2;
  const double bend = to.acceleration * span * span - 2.0 * c2;
  const double c3 = 10.0 * angle - 4.0 * rate + 0.5 * bend;
  const double c4 = -15.0 * angle + 7.0 * rate - bend;
  const double c5 = 6.0 * angle - 3.0 * rate + 0.5 * bend;
  return c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)));
}

}  // namespace

void Chain::states(std::vector<HingedState>& out) const {
  const std::size_t size = train_.size();
  out.resize(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = state_of(train_.at(size - 1 - i));
}

// Whether the quintics over the whole leg are close to the ways of all bricks, by their rates at two of the leg's nodes.
bool Chain::curves_are_close() const {
  const double span = leg_.end().time;
  for (std::size_t i = 0; i < train_.size(); ++i) {
    const TrainBrick& brick = train_.at(train_.size() - 1 - i);
    const double limit = kCurve / kMissOfSlope * brick.thickness;
    for (std::size_t n = 0; n < 2; ++n) {
      const FrontState& node = leg_.nodes[2 * n + 1];
      const double miss = slope(began_[i], before_[i], span, node.time / span) - brick.way_ratio[n] * node.rate * span;
      if (std::fabs(miss) * (brick.height + brick.thickness) > limit) return false;
    }
  }
  return true;
}

// A leg has ended: remembers how all move, and tells points on the way if the curves from its beginning to its end miss it.
void Chain::end_curves(Happenings& out) {
  remember_states();
  if (leg_.count != Leg::kMostNodes || curves_are_close()) return;
  std::vector<TrainView> bricks;
  for (std::size_t n = 1; n + 1 < Leg::kMostNodes; ++n) {
    const FrontState& node = leg_.nodes[n];
    train_.look(node.angle, direction_, bricks);
    for (const TrainView& brick : bricks) {
      const HingedState state{brick.angle, brick.ratio * node.rate,
                              brick.ratio * node.acceleration + brick.curvature * node.rate * node.rate};
      out.tell({brick.id, leg_start_ + node.time, state, state});
    }
  }
}

// Where a leg ends on the way: nothing jumps.
void Chain::add_points(Happenings& out) const {
  for (std::size_t i = 0; i < train_.size(); ++i) {
    out.tell({train_.at(train_.size() - 1 - i).id, state_.time, before_[i], before_[i]});
  }
}

// Everything of the train may have jumped from before_, whose first `skipped` bricks have left it. What was not there before stood.
void Chain::add_kinks(Happenings& out, std::size_t skipped) {
  states(began_);
  for (std::size_t i = 0; i < began_.size(); ++i) {
    const BrickId brick = train_.at(began_.size() - 1 - i).id;
    out.tell({brick, state_.time, i + skipped < before_.size() ? before_[i + skipped] : HingedState{}, began_[i]});
  }
}

}  // namespace topple::hinge

// The forces in a train, which its motion says: the chain itself never needs them.
#include "base/trigonometry.h"
#include "model/hinge/chain.h"
#include "model/hinge/lean.h"

namespace topple::hinge {

namespace {

/// Along a brick's heading, and up.
struct InPlane {
  double along = 0.0;
  double up = 0.0;
};
InPlane operator+(const InPlane& a, const InPlane& b) { return {a.along + b.along, a.up + b.up}; }
InPlane operator*(double s, const InPlane& a) { return {s * a.along, s * a.up}; }

struct Passed {
  double torque = 0.0;  ///< On the brick ahead, about its toe [N m].
  InPlane force;        ///< The same force [N],
  InPlane point;        ///< and where it acts, from that toe [m].
};

/// What a brick hands on to the one ahead of it, where `torque` about its own toe must be taken from it [N m]: lever arms of lean.h.
Passed hand_on(const TrainBrick& brick, const SinCos& ahead, double torque, double direction) {
  const double t = brick.thickness_ahead * brick.height;
  if (brick.on_heel) {
    const Lean<double> lean = lean_on_heel(brick.pitch, brick.thickness_ahead, ahead.sin, ahead.cos);
    const double along = brick.pitch - brick.thickness_ahead * ahead.cos;
    const double up = brick.thickness_ahead * ahead.sin;
    const double normal = torque / (square_root(along * along + up * up) * brick.height);
    return {lean.gain * torque, normal * InPlane{lean.cos_behind, -lean.sin_behind}, {-t * ahead.cos, t * ahead.sin}};
  }
  const double mu = direction * brick.friction;
  const Lean<double> lean = lean_on_face(brick.pitch, brick.thickness_ahead, mu, ahead.sin, ahead.cos);
  const double cos_lean = square_root(1.0 - lean.sin_lean * lean.sin_lean);
  const double normal = torque / ((cos_lean + mu * lean.sin_lean) * brick.height);
  const InPlane force = normal * (InPlane{ahead.cos, -ahead.sin} + mu * InPlane{-ahead.sin, -ahead.cos});
  const double height = (cos_lean - brick.pitch * ahead.sin) * brick.height;  // Along the rear face, from the heel.
  return {lean.gain * torque, force, {height * ahead.sin - t * ahead.cos, height * ahead.cos + t * ahead.sin}};
}

/// Mass x (acceleration + gravity) of the centre of a brick that turns about its toe: all that other things press on it [N].
InPlane pressed_in_all(const BrickKind& kind, const HingedState& state, double gravity) {
  const auto [s, c] = sin_cos(state.angle);
  const double w2 = state.rate * state.rate;
  const InPlane arm{0.5 * (kind.height * s - kind.thickness * c), 0.5 * (kind.height * c + kind.thickness * s)};
  return kind.mass * InPlane{arm.up * state.acceleration - arm.along * w2, -arm.along * state.acceleration - arm.up * w2 + gravity};
}

}  // namespace

// From the back to the front: what turns a brick and does not speed it up turns the brick ahead, [vanLeeuwen2010] eq. 24. Nothing is left
// at the front.
void Chain::read(std::vector<Contact>& out) const {
  if (!moving_) return;
  std::vector<HingedMotion> bricks;  // From the back.
  read(bricks);
  const auto state_of = [&bricks](std::size_t k) { return bricks[bricks.size() - 1 - k].state; };
  const Layout& layout = *scene_->layout;
  Passed got{.torque = train_.load(), .force = {}, .point = {}};
  for (std::size_t k = train_.size(); k-- > 0;) {
    const TrainBrick& brick = train_.at(k);
    const HingedState state = state_of(k);
    const SinCos turned = sin_cos(state.angle);
    const Brick& placed = layout.bricks[static_cast<std::size_t>(brick.id)];
    const SinCos heading = sin_cos(placed.heading);
    const Vec3 along{heading.cos, heading.sin, 0.0};
    const auto in_world = [&](const InPlane& v) { return v.along * along + Vec3{0.0, 0.0, v.up}; };
    const Vec3 toe = placed.foot + (0.5 * brick.thickness) * along;
    if (k + 1 < train_.size()) out.push_back({brick.id, train_.at(k + 1).id, toe + in_world(got.point), in_world(got.force)});
    const double left = got.torque + brick.torque_sin * turned.sin + brick.torque_cos * turned.cos - brick.inertia * state.acceleration;
    InPlane floor = pressed_in_all(scene_->kind_of(brick.id), state, layout.gravity) + -1.0 * got.force;
    if (acting_ > 0 && forced_ == brick.id) floor.along -= force_;
    // Which force the bricks at rest put on the last one of the train is not known, only how it turns it.
    const bool floor_is_known = k + 1 < train_.size() || train_.load() == 0.0;
    got = k > 0 ? hand_on(brick, sin_cos(state_of(k - 1).angle), left, direction_) : Passed{};
    floor = floor + got.force;
    if (floor_is_known) out.push_back({brick.id, kNoBrick, toe, in_world(floor)});
  }
}

}  // namespace topple::hinge

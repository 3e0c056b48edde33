#include "export/gltf_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/trigonometry.h"
#include "export/gltf_axes.h"
#include "recording/hermite.h"
#include "recording/track_store.h"

namespace topple {
namespace {

// Of the tolerance; the rest is for what lies between the places that are looked at, and for single numbers.
constexpr double kMargin = 0.7;
constexpr std::array<double, 4> kLookAt = {0.2, 0.4, 0.6, 0.8};
// Halving goes no further, whatever a damaged file has.
constexpr int kMostHalvings = 12;
// Upright, as exactly as the moment is looked for [rad].
constexpr double kUpright = 1e-12;

// A damaged file may last for ever; single numbers tell frames apart up to here.
constexpr double kMostFrame = 0x1p24;
std::int64_t frame_number(double frame) { return static_cast<std::int64_t>(std::clamp(frame, 0.0, kMostFrame)); }

/// Turns the quintics of one hinged track into knots of position and quaternion.
class HingedToFree {
 public:
  HingedToFree(const Layout& layout, BrickId brick, double tolerance) : layout_(layout), brick_(brick) {
    const BrickKind& kind = layout.kind_of(brick);
    const Brick& put = layout.bricks[static_cast<std::size_t>(brick)];
    const SinCos heading = sin_cos(put.heading);
    left_ = {-heading.sin, heading.cos, 0.0};
    toe_ = 0.5 * extents(kind, put.stance).along * Vec3{heading.cos, heading.sin, 0.0};
    foot_ = put.foot;
    put_ = standing_pose(layout, brick).position;
    most_ = kMargin * tolerance * kind.thickness;
    reach_ = norm(half_extents(kind));
  }

  void add(const HingedKnot& first, const HingedKnot& last) {
    first_ = first;
    span_ = double{last.time} - double{first.time};
    curve_ = quintic(first, last, span_);
    add(0.0, 1.0, kMostHalvings);
  }
  /// Where a track has nothing else, and at its end: what came last may be a jump to rest.
  void add(const HingedKnot& knot) { push(free_knot(double{knot.time}, {double{knot.angle}, double{knot.rate}, 0.0}, knot.angle < 0.0F)); }

  std::vector<FreeKnot> take() { return std::move(knots_); }

 private:
  HingedState at(double u) const { return {double{first_.angle} + curve_.at(u), curve_.slope(u) / span_, 0.0}; }
  double time(double u) const { return double{first_.time} + u * span_; }

  void add(double from, double to, int halvings) {
    // Where it passes through upright it turns about its other edge from then on: a corner in its centre's path, which no polynomial has.
    const bool passes = std::min(at(from).angle, at(to).angle) < -kUpright && std::max(at(from).angle, at(to).angle) > kUpright;
    const double middle = passes ? upright(from, to) : 0.5 * (from + to);
    const bool heel = at(middle).angle < 0.0;
    const FreeKnot first = knot_at(from, heel), last = knot_at(to, heel);
    if (halvings > 0 && (passes || !fits(from, first, to, last))) {
      add(from, middle, halvings - 1);
      add(middle, to, halvings - 1);
    } else {
      push(first);
      push(last);
    }
  }

  double upright(double from, double to) const {
    const bool heel = at(from).angle < 0.0;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (from + to);
      ((at(middle).angle < 0.0) == heel ? from : to) = middle;
    }
    return to;
  }

  // Upright it turns about the edge that it turns about beside this moment.
  FreeKnot knot_at(double u, bool heel) const {
    const HingedState state = at(u);
    return free_knot(time(u), state, std::abs(state.angle) <= kUpright ? heel : state.angle < 0.0);
  }

  FreeKnot free_knot(double time, const HingedState& state, bool heel) const {
    const auto single = [](double x) { return static_cast<float>(x); };
    const Pose pose = hinged_pose(layout_, brick_, state.angle);
    const Vec3 offset = pose.position - put_;
    const Vec3 spin = state.rate * left_;
    const Vec3 velocity = cross(spin, pose.position - (heel ? foot_ - toe_ : foot_ + toe_));
    const Quat& q = pose.orientation;
    return {single(time), single(offset.x),   single(offset.y),   single(offset.z),   single(q.w),    single(q.x),    single(q.y),
            single(q.z),  single(velocity.x), single(velocity.y), single(velocity.z), single(spin.x), single(spin.y), single(spin.z)};
  }

  // A corner is no further off than the centre and, by the turn between both orientations, what is farthest from it.
  bool fits(double from, const FreeKnot& first, double to, const FreeKnot& last) const {
    const double span = double{last.time} - double{first.time};
    if (span <= 0.0) return true;
    return std::all_of(kLookAt.begin(), kLookAt.end(), [&](double share) {
      const Pose truth = hinged_pose(layout_, brick_, at(from + share * (to - from)).angle);
      const FreeState found = between(first, last, span, share);
      const Quat turn = found.orientation * conjugate(truth.orientation);
      return norm(put_ + found.offset - truth.position) + 2.0 * reach_ * norm(Vec3{turn.x, turn.y, turn.z}) <= most_;
    });
  }

  // Where one piece ends as the next begins there is one knot.
  void push(const FreeKnot& knot) {
    const auto same = [&](const FreeKnot& k) {
      return k.time == knot.time && k.vx == knot.vx && k.vy == knot.vy && k.vz == knot.vz && k.wx == knot.wx && k.wy == knot.wy;
    };
    if (knots_.empty() || !same(knots_.back())) knots_.push_back(knot);
  }

  const Layout& layout_;
  BrickId brick_;
  Vec3 left_, toe_, foot_, put_;
  double most_ = 0.0;   // [m]
  double reach_ = 0.0;  // From the centre to a corner [m].
  HingedKnot first_;
  double span_ = 0.0;  // [s]
  Quintic curve_;
  std::vector<FreeKnot> knots_;
};

Quat operator*(double s, const Quat& q) { return {s * q.w, s * q.x, s * q.y, s * q.z}; }
double dot(const Quat& a, const Quat& b) { return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z; }

/// Adds keyframes at rising times; of q and -q, which are one orientation, the one nearer to the last.
class KeyWriter {
 public:
  explicit KeyWriter(Keys& out) : out_(out) {
    out.times.clear();
    out.places.clear();
    out.turns.clear();
  }

  void add_straight(float time, const Vec3& place, const Quat& turn) {
    out_.times.push_back(time);
    add_y_up(place, out_.places);
    add_y_up(nearer(turn), out_.turns);
  }

  /// `goes_on`: it came here along a polynomial, rather than resting.
  void add_curved(float time, const Vec3& place, const FreeKnot& knot, bool goes_on) {
    const Quat turn = nearer({knot.qw, knot.qx, knot.qy, knot.qz});
    const Vec3 velocity{knot.vx, knot.vy, knot.vz};
    const Quat rate = 0.5 * (Quat{0.0, knot.wx, knot.wy, knot.wz} * turn);
    if (!out_.times.empty() && time <= out_.times.back()) {
      // A jump: what came in stays.
      out_.places.resize(out_.places.size() - 6);
      out_.turns.resize(out_.turns.size() - 8);
    } else {
      if (!goes_on) rest();
      out_.times.push_back(time);
      add_y_up(goes_on ? velocity : Vec3{}, out_.places);
      add_y_up(goes_on ? rate : kNoTurn, out_.turns);
    }
    add_y_up(place, out_.places);
    add_y_up(turn, out_.turns);
    add_y_up(velocity, out_.places);
    add_y_up(rate, out_.turns);
  }

  /// After the last keyframe it stays there.
  void rest() {
    if (out_.times.empty()) return;
    std::fill(out_.places.end() - 3, out_.places.end(), 0.0F);
    std::fill(out_.turns.end() - 4, out_.turns.end(), 0.0F);
  }

 private:
  static constexpr Quat kNoTurn{0.0, 0.0, 0.0, 0.0};

  Quat nearer(const Quat& turn) {
    last_ = dot(last_, turn) < 0.0 ? -1.0 * turn : turn;
    return last_;
  }

  Keys& out_;
  Quat last_;
};

}  // namespace

std::vector<FreeKnot> free_knots(const Layout& layout, const Track& hinged, double tolerance) {
  HingedToFree out(layout, hinged.brick, tolerance);
  for (std::size_t i = 0; i + 1 < hinged.hinged.size(); ++i) {
    if (hinged.hinged[i + 1].time > hinged.hinged[i].time) out.add(hinged.hinged[i], hinged.hinged[i + 1]);
  }
  if (!hinged.hinged.empty()) out.add(hinged.hinged.back());
  return out.take();
}

void curved_keys(const Layout& layout, std::span<const Track> tracks, Keys& out) {
  KeyWriter writer(out);
  for (const Track& track : tracks) {
    const Vec3 put = standing_pose(layout, track.brick).position;
    for (std::size_t i = 0; i < track.free.size(); ++i) {
      const FreeKnot& knot = track.free[i];
      writer.add_curved(static_cast<float>(track.start + double{knot.time}), put + Vec3{knot.x, knot.y, knot.z}, knot, i > 0);
    }
  }
  writer.rest();
}

void straight_keys(const Layout& layout, std::span<const Track> tracks, double rate, Keys& out) {
  KeyWriter writer(out);
  std::int64_t next = 0;  // The frames before it are written.
  for (const Track& track : tracks) {
    const Vec3 put = standing_pose(layout, track.brick).position;
    const auto last = frame_number(std::ceil(end_of(track) * rate));
    for (next = std::max(next, frame_number(std::floor(track.start * rate))); next <= last; ++next) {
      const double time = static_cast<double>(next) / rate;
      const FreeState state = state_at(track.free, time - track.start);
      writer.add_straight(static_cast<float>(time), put + state.offset, state.orientation);
    }
  }
}

}  // namespace topple

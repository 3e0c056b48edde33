#include "topple/recording.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/trigonometry.h"
#include "recording/hermite.h"
#include "recording/store.h"

namespace topple {
namespace {

// A free brick this close to upright at its end counts as standing [rad].
constexpr double kUprightTilt = 0.0174532925199433;

constexpr double kMostTurn = 1e3;  // [rad]

Vec3 turned(const Vec3& v, double heading) {
  const SinCos turn = sin_cos(heading);
  return {turn.cos * v.x - turn.sin * v.y, turn.sin * v.x + turn.cos * v.y, v.z};
}

// Turning about the toe or heel, an axis that points to the brick's left, moves the centre of mass.
BrickState hinged_state(const Layout& layout, BrickId brick, const HingedState& hinge) {
  const Brick& put = layout.bricks[static_cast<std::size_t>(brick)];
  const double along = extents(layout.kind_of(brick), put.stance).along;
  BrickState state;
  // A damaged file may swing without bounds between two knots; whatever it shows, it is a pose.
  state.pose = hinged_pose(layout, brick, std::clamp(hinge.angle, -kMostTurn, kMostTurn));
  state.hinge = hinge;
  state.angular_velocity = turned({0.0, hinge.rate, 0.0}, put.heading);
  const Vec3 edge = put.foot + turned({hinge.angle >= 0.0 ? 0.5 * along : -0.5 * along, 0.0, 0.0}, put.heading);
  state.velocity = cross(state.angular_velocity, state.pose.position - edge);
  return state;
}

// The tilt's derivatives follow from how fast the upright axis turns towards the floor.
BrickState free_state(const Layout& layout, BrickId brick, const FreeState& free) {
  const Pose put = standing_pose(layout, brick);
  BrickState state;
  state.pose = {put.position + free.offset, free.orientation};
  state.velocity = free.velocity;
  state.angular_velocity = free.angular_velocity;
  state.hinge.angle = tilt(layout, brick, free.orientation);
  const Vec3 upright = rotate(free.orientation, rotate(conjugate(put.orientation), {0.0, 0.0, 1.0}));
  const double level = std::sqrt(upright.x * upright.x + upright.y * upright.y);
  if (level > 1e-9) state.hinge.rate = -cross(free.angular_velocity, upright).z / level;
  return state;
}

Phase phase_after(const HingedKnot& last) {
  if (last.rate != 0.0F || last.acceleration != 0.0F) return Phase::falling;
  return last.angle == 0.0F ? Phase::standing : Phase::resting;
}

bool is_still(const FreeKnot& knot) {
  return knot.vx == 0.0F && knot.vy == 0.0F && knot.vz == 0.0F && knot.wx == 0.0F && knot.wy == 0.0F && knot.wz == 0.0F;
}

Phase phase_after(const Track& last, double angle) {
  if (!last.hinged.empty()) return phase_after(last.hinged.back());
  const FreeKnot& knot = last.free.back();
  if (!is_still(knot)) return Phase::falling;
  return angle < kUprightTilt ? Phase::standing : Phase::resting;
}

BrickState state_in(const Layout& layout, const Track& track, double time) {
  if (!track.hinged.empty()) return hinged_state(layout, track.brick, state_at(track.hinged, time - track.start));
  return free_state(layout, track.brick, state_at(track.free, time - track.start));
}

// Of a free track only its last knot where no more is asked for.
Track track_at(const TrackStore& tracks, std::int32_t piece, double time) {
  const auto last = tracks.last_free_knot(piece);
  if (!last || time < tracks.start_of(piece) + double{last->time}) return tracks.track(static_cast<std::size_t>(piece));
  return {.brick = tracks.brick_of(piece), .start = tracks.start_of(piece), .hinged = {}, .free = {*last}};
}

}  // namespace

Recording::Store::Store(Layout the_layout, Recipe the_recipe)
    : layout(std::move(the_layout)), recipe(std::move(the_recipe)), tracks(layout.bricks.size()) {}

void Recording::Store::add_event(const Event& event) {
  const Vec3 place = event.point - layout.bricks[static_cast<std::size_t>(event.brick)].foot;
  events.add({event.time,
              event.kind,
              event.brick,
              event.by,
              {static_cast<float>(event.force), static_cast<float>(event.impulse), static_cast<float>(place.x), static_cast<float>(place.y),
               static_cast<float>(place.z)}});
}

Event Recording::Store::event(std::size_t index) const {
  const EventStore::Entry entry = events.entry(index);
  const Vec3 place{entry.load.x, entry.load.y, entry.load.z};
  return {entry.time,
          entry.kind,
          entry.brick,
          entry.by,
          double{entry.load.force},
          double{entry.load.impulse},
          layout.bricks[static_cast<std::size_t>(entry.brick)].foot + place};
}

Recording::Recording(Layout layout, Recipe recipe) : store_(std::make_unique<Store>(std::move(layout), std::move(recipe))) {}
Recording::~Recording() = default;
Recording::Recording(Recording&&) noexcept = default;
Recording& Recording::operator=(Recording&&) noexcept = default;

const Layout& Recording::layout() const { return store_->layout; }
const Recipe& Recording::recipe() const { return store_->recipe; }
const RunEnd& Recording::end() const { return store_->end; }
double Recording::duration() const { return store_->time; }
double Recording::tolerance() const { return store_->tolerance; }
std::int64_t Recording::track_count() const { return static_cast<std::int64_t>(store_->tracks.size()); }
Track Recording::track(std::int64_t index) const { return store_->tracks.track(static_cast<std::size_t>(index)); }
std::int64_t Recording::event_count() const { return static_cast<std::int64_t>(store_->events.size()); }
Event Recording::event(std::int64_t index) const { return store_->event(static_cast<std::size_t>(index)); }
std::span<const EnergySample> Recording::energy() const { return store_->energy; }
const HashTrail& Recording::hashes() const { return store_->hashes; }
std::size_t Recording::memory() const { return store_->tracks.bytes() + store_->events.bytes(); }

void Recording::tracks_of(BrickId brick, std::vector<Track>& out) const {
  out.clear();
  const TrackStore& tracks = store_->tracks;
  for (std::int32_t piece = tracks.last_of(brick); piece != TrackStore::kNone; piece = tracks.before(piece)) {
    out.push_back(tracks.track(static_cast<std::size_t>(piece)));
  }
  std::reverse(out.begin(), out.end());
}

double Recording::rest_angle(BrickId brick) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const TrackStore& tracks = store_->tracks;
  const std::int32_t piece = tracks.last_of(brick);
  if (piece == TrackStore::kNone) return kNone;
  if (const auto last = tracks.last_knot(piece)) return phase_after(*last) == Phase::resting ? double{last->angle} : kNone;
  const auto last = tracks.last_free_knot(piece);
  if (!last || !is_still(*last)) return kNone;
  const double angle = tilt(store_->layout, brick, state_at(std::span<const FreeKnot>(&*last, 1), 0.0).orientation);
  return angle < kUprightTilt ? kNone : angle;
}

BrickState Recording::at(BrickId brick, double time) const {
  const TrackStore& tracks = store_->tracks;
  std::int32_t piece = tracks.last_of(brick);
  while (piece != TrackStore::kNone && tracks.start_of(piece) > time) piece = tracks.before(piece);
  if (piece == TrackStore::kNone) {
    BrickState state;
    state.pose = standing_pose(store_->layout, brick);
    return state;
  }
  // After its end a hinged track need not be unpacked.
  if (const auto last = tracks.last_knot(piece); last && time >= tracks.start_of(piece) + double{last->time}) {
    const bool moves = phase_after(*last) == Phase::falling;
    const HingedState end{double{last->angle}, moves ? double{last->rate} : 0.0, moves ? double{last->acceleration} : 0.0};
    BrickState state = hinged_state(store_->layout, brick, end);
    state.phase = phase_after(*last);
    return state;
  }
  const Track track = track_at(tracks, piece, time);
  BrickState state = state_in(store_->layout, track, time);
  state.phase = time < end_of(track) ? Phase::falling : phase_after(track, state.hinge.angle);
  if (state.phase != Phase::falling) {
    state.velocity = state.angular_velocity = {};
    state.hinge.rate = state.hinge.acceleration = 0.0;
  }
  return state;
}

}  // namespace topple

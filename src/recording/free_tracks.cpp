#include "recording/free_tracks.h"

#include <cmath>

namespace topple {

namespace {

std::size_t at(BrickId brick) { return static_cast<std::size_t>(brick); }

// As it was put down; the position of a knot is against that.
FreeKnot put_down(const Pose& put) {
  const auto single = [](double x) { return static_cast<float>(x); };
  const Quat& q = put.orientation;
  return {.qw = single(q.w), .qx = single(q.x), .qy = single(q.y), .qz = single(q.z)};
}

bool is_finite(const FreeMotion& motion) {
  const Vec3& p = motion.pose.position;
  const Quat& q = motion.pose.orientation;
  const Vec3& v = motion.velocity;
  const Vec3& w = motion.angular_velocity;
  return std::isfinite(p.x + p.y + p.z + q.w + q.x + q.y + q.z + v.x + v.y + v.z + w.x + w.y + w.z);
}

}  // namespace

// A track begins where the last one left its brick, or as it was put down, at rest.
FreeFit& FreeTracks::open(BrickId brick, double start, const Layout& layout, double tolerance, const TrackStore& out) {
  place_.resize(layout.bricks.size(), kClosed);
  if (unused_.empty()) {
    unused_.push_back(static_cast<std::int32_t>(fits_.size()));
    fits_.emplace_back();
  }
  const std::int32_t place = unused_.back();
  unused_.pop_back();
  place_[at(brick)] = place;

  const Pose put = standing_pose(layout, brick);
  FreeKnot first = put_down(put);
  const std::int32_t before = out.last_of(brick);
  if (before != TrackStore::kNone) {
    const Track last = out.track(static_cast<std::size_t>(before));
    if (!last.free.empty()) first = last.free.back();
  }
  const BrickKind& kind = layout.kind_of(brick);
  const double diagonal = std::sqrt(kind.height * kind.height + kind.width * kind.width + kind.thickness * kind.thickness);
  FreeFit& fit = fits_[static_cast<std::size_t>(place)];
  fit.open(brick, start, first, put.position, {.length = tolerance * kind.thickness, .reach = 0.5 * diagonal});
  return fit;
}

void FreeTracks::take(const Frame& frame, double time_step, const Layout& layout, double tolerance, TrackStore& out) {
  for (const FreeMotion& motion : frame.free) {
    const bool moves = motion.phase == Phase::falling;
    const std::int32_t place = place_.empty() ? kClosed : place_[at(motion.brick)];
    if ((!moves && place == kClosed) || !is_finite(motion)) continue;
    FreeFit& fit =
        place == kClosed ? open(motion.brick, frame.time - time_step, layout, tolerance, out) : fits_[static_cast<std::size_t>(place)];
    fit.add(frame.time, motion, out);
    if (!moves) close(motion.brick, true, out);
  }
}

void FreeTracks::close(BrickId brick, bool still, TrackStore& out) {
  std::int32_t& place = place_[at(brick)];
  fits_[static_cast<std::size_t>(place)].close(still, out);
  unused_.push_back(place);
  place = kClosed;
}

void FreeTracks::close_all(TrackStore& out) {
  for (const FreeFit& fit : fits_) {
    if (fit.brick() != kNoBrick) close(fit.brick(), false, out);
  }
}

}  // namespace topple

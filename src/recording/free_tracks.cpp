#include "recording/free_tracks.h"

#include <algorithm>
#include <cmath>

namespace topple {

namespace {

// So many bricks of a frame are worth the handing out.
constexpr std::size_t kShare = 64;

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
    if (const auto last = out.last_free_knot(before)) first = *last;
  }
  const BrickKind& kind = layout.kind_of(brick);
  const double diagonal = std::sqrt(kind.height * kind.height + kind.width * kind.width + kind.thickness * kind.thickness);
  FreeFit& fit = fits_[static_cast<std::size_t>(place)];
  fit.open(brick, start, first, put.position, {.length = tolerance * kind.thickness, .reach = 0.5 * diagonal});
  return fit;
}

// Goes on with the tracks of one share of the frame, and notes what is left to do for all in order.
void FreeTracks::fit(const Frame& frame, std::size_t share) {
  std::vector<std::size_t>& left = left_[share];
  left.clear();
  const std::size_t end = std::min(frame.free.size(), (share + 1) * kShare);
  for (std::size_t i = share * kShare; i < end; ++i) {
    const FreeMotion& motion = frame.free[i];
    const bool moves = motion.phase == Phase::falling;
    const std::int32_t place = place_[at(motion.brick)];
    if ((!moves && place == kClosed) || !is_finite(motion)) continue;
    if (place != kClosed) {
      FreeFit& fit = fits_[static_cast<std::size_t>(place)];
      fit.add(frame.time, motion);
      if (!moves) fit.close(true);
      if (!fit.has_finished()) continue;
    }
    left.push_back(i);
  }
}

void FreeTracks::take(const Frame& frame, double time_step, const Layout& layout, double tolerance, TrackStore& out, Crew& crew) {
  if (frame.free.empty()) return;
  place_.resize(layout.bricks.size(), kClosed);
  const std::size_t shares = (frame.free.size() + kShare - 1) / kShare;
  if (left_.size() < shares) left_.resize(shares);
  crew.each(shares, [&](std::size_t share) { fit(frame, share); });
  for (std::size_t share = 0; share < shares; ++share) {
    for (const std::size_t i : left_[share]) {
      const FreeMotion& motion = frame.free[i];
      std::int32_t& place = place_[at(motion.brick)];
      if (place == kClosed) {
        open(motion.brick, frame.time - time_step, layout, tolerance, out).add(frame.time, motion);
      } else {
        fits_[static_cast<std::size_t>(place)].store_finished(out);
        if (motion.phase != Phase::falling) close(place, out);
      }
    }
  }
}

void FreeTracks::take_unseen(const Frame& frame, const Layout& layout, double tolerance, TrackStore& out) {
  place_.resize(frame.unseen.empty() ? place_.size() : layout.bricks.size(), kClosed);
  for (const UnseenMotion& unseen : frame.unseen) {
    const std::int32_t place = place_[at(unseen.motion.brick)];
    if (place == kClosed) {
      open(unseen.motion.brick, unseen.time, layout, tolerance, out);
    } else {
      FreeFit& fit = fits_[static_cast<std::size_t>(place)];
      fit.add(unseen.time, unseen.motion);
      fit.store_finished(out);
    }
  }
}

// Of a track that is closed: what is finished of it is stored, its buffers go to the next.
void FreeTracks::close(std::int32_t& place, TrackStore& out) {
  FreeFit& fit = fits_[static_cast<std::size_t>(place)];
  fit.store_finished(out);
  fit.end();
  unused_.push_back(place);
  place = kClosed;
}

void FreeTracks::close_all(TrackStore& out) {
  for (FreeFit& fit : fits_) {
    if (fit.brick() == kNoBrick) continue;
    fit.close(false);
    close(place_[at(fit.brick())], out);
  }
}

}  // namespace topple

#include "recording/free_tracks.h"

#include <utility>

namespace topple {

namespace {

FreeKnot knot_of(const FreeMotion& motion, double since, const Vec3& put, bool still) {
  const Vec3 offset = motion.pose.position - put;
  const Quat& q = motion.pose.orientation;
  const Vec3 v = still ? Vec3{} : motion.velocity;
  const Vec3 w = still ? Vec3{} : motion.angular_velocity;
  const auto single = [](double x) { return static_cast<float>(x); };
  return {.time = single(since),
          .x = single(offset.x),
          .y = single(offset.y),
          .z = single(offset.z),
          .qw = single(q.w),
          .qx = single(q.x),
          .qy = single(q.y),
          .qz = single(q.z),
          .vx = single(v.x),
          .vy = single(v.y),
          .vz = single(v.z),
          .wx = single(w.x),
          .wy = single(w.y),
          .wz = single(w.z)};
}

}  // namespace

FreeTracks::Open& FreeTracks::open_track(const FreeMotion& motion, double start, const Layout& layout, const TrackStore& out) {
  place_.resize(layout.bricks.size(), -1);
  std::int32_t& place = place_[static_cast<std::size_t>(motion.brick)];
  if (place >= 0) return open_[static_cast<std::size_t>(place)];
  place = static_cast<std::int32_t>(open_.size());
  Open& open = open_.emplace_back(Open{.brick = motion.brick, .start = start, .knots = {}});
  // It begins where its last track left it, or as it was put down.
  const std::int32_t before = out.last_of(motion.brick);
  FreeKnot first;
  if (before != TrackStore::kNone) {
    const Track last = out.track(static_cast<std::size_t>(before));
    if (!last.free.empty()) first = last.free.back();
  } else {
    const FreeMotion put{.brick = motion.brick, .pose = standing_pose(layout, motion.brick)};
    first = knot_of(put, 0.0, put.pose.position, true);
  }
  first.time = 0.0F;
  open.knots.push_back(first);
  return open;
}

void FreeTracks::take(const Frame& frame, double time_step, const Layout& layout, TrackStore& out) {
  for (const FreeMotion& motion : frame.free) {
    const bool moves = motion.phase == Phase::falling;
    const bool known = !place_.empty() && place_[static_cast<std::size_t>(motion.brick)] >= 0;
    if (!moves && !known) continue;
    Open& open = open_track(motion, frame.time - time_step, layout, out);
    open.knots.push_back(knot_of(motion, frame.time - open.start, standing_pose(layout, motion.brick).position, !moves));
    if (!moves) close(static_cast<std::size_t>(place_[static_cast<std::size_t>(motion.brick)]), out);
  }
}

void FreeTracks::close(std::size_t index, TrackStore& out) {
  out.add(open_[index].brick, open_[index].start, std::span<const FreeKnot>(open_[index].knots));
  place_[static_cast<std::size_t>(open_[index].brick)] = -1;
  if (index + 1 != open_.size()) {
    open_[index] = std::move(open_.back());
    place_[static_cast<std::size_t>(open_[index].brick)] = static_cast<std::int32_t>(index);
  }
  open_.pop_back();
}

void FreeTracks::close_all(TrackStore& out) {
  while (!open_.empty()) close(open_.size() - 1, out);
}

}  // namespace topple

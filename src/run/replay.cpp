// Runs a recipe again and compares.
#include <algorithm>
#include <cmath>
#include <string>

#include "topple/run.h"

namespace topple {

namespace {

/// The first step whose hash differs, as sharply as the trails tell; -1 if none does.
std::int64_t first_difference(const HashTrail& a, const HashTrail& b) {
  const HashTrail& coarse = a.stride >= b.stride ? a : b;
  const HashTrail& fine = a.stride >= b.stride ? b : a;
  const auto ratio = static_cast<std::size_t>(coarse.stride / fine.stride);
  for (std::size_t i = 0; i < coarse.values.size(); ++i) {
    const std::size_t j = (i + 1) * ratio - 1;
    if (j >= fine.values.size() || coarse.values[i] != fine.values[j]) return static_cast<std::int64_t>(i + 1) * coarse.stride;
  }
  const auto steps_a = static_cast<std::int64_t>(a.values.size()) * a.stride;
  const auto steps_b = static_cast<std::int64_t>(b.values.size()) * b.stride;
  return steps_a == steps_b ? -1 : std::min(steps_a, steps_b) + 1;
}

bool same_knots(const Track& a, const Track& b) {
  const auto same_hinged = [](const HingedKnot& x, const HingedKnot& y) {
    return x.time == y.time && x.angle == y.angle && x.rate == y.rate && x.acceleration == y.acceleration;
  };
  const auto same_free = [](const FreeKnot& x, const FreeKnot& y) {
    return x.time == y.time && x.x == y.x && x.y == y.y && x.z == y.z && x.qw == y.qw && x.qx == y.qx && x.qy == y.qy && x.qz == y.qz;
  };
  return a.brick == b.brick && a.start == b.start &&
         std::equal(a.hinged.begin(), a.hinged.end(), b.hinged.begin(), b.hinged.end(), same_hinged) &&
         std::equal(a.free.begin(), a.free.end(), b.free.begin(), b.free.end(), same_free);
}

/// The brick whose track differs and began first.
BrickId first_different_brick(const Recording& a, const Recording& b) {
  BrickId brick = kNoBrick;
  double earliest = 0.0;
  const std::int64_t count = std::max(a.track_count(), b.track_count());
  for (std::int64_t i = 0; i < count; ++i) {
    const bool both = i < a.track_count() && i < b.track_count();
    if (both && same_knots(a.track(i), b.track(i))) continue;
    const Track track = i < a.track_count() ? a.track(i) : b.track(i);
    if (brick == kNoBrick || track.start < earliest) {
      brick = track.brick;
      earliest = track.start;
    }
  }
  return brick;
}

}  // namespace

Result<ReplayVerdict> replay(const Recording& recording, const RunConfig& config) {
  const RunEnd& end = recording.end();
  if (end.reason == EndReason::running) {
    return failure("this recording was cut off before its run ended, so that there is no final hash to compare");
  }
  const Layout& layout = recording.layout();
  auto again = read_layout(layout.text, layout.name, layout.overrides);
  if (!again) return std::unexpected(again.error());
  auto chosen = model_config(*again);
  if (!chosen) return std::unexpected(chosen.error());
  RunConfig same = config;
  const bool cut_short = end.reason == EndReason::time_limit || end.reason == EndReason::stopped;
  if (cut_short) same.until = end.time;
  auto replayed = simulate(std::move(*again), *chosen, same);
  if (!replayed) return std::unexpected(replayed.error());

  ReplayVerdict verdict{.recorded_hash = end.hash, .replayed_hash = replayed->end().hash};
  verdict.first_step = first_difference(recording.hashes(), replayed->hashes());
  verdict.same = end.hash == replayed->end().hash && end.step == replayed->end().step && verdict.first_step < 0;
  if (verdict.same) {
    verdict.words = "the same result, step by step";
    return verdict;
  }
  verdict.first_brick = first_different_brick(recording, *replayed);
  const std::int64_t stride = std::max(recording.hashes().stride, replayed->hashes().stride);
  verdict.words = "the result differs";
  if (verdict.first_step >= 0) {
    verdict.words += stride == 1 ? " from step " : ", within the " + std::to_string(stride) + " steps before step ";
    verdict.words += std::to_string(verdict.first_step);
  }
  if (verdict.first_brick != kNoBrick) verdict.words += ", first at brick " + std::to_string(verdict.first_brick);
  return verdict;
}

}  // namespace topple

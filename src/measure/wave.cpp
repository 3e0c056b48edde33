#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "measure/strikes.h"
#include "topple/measure.h"

namespace topple {
namespace {

constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kFewest = 5;  // Fewer bricks have no 20 % and 80 % to speak of.

// From the first to the last: followed backwards, so turned round at the end.
std::vector<BrickId> trunk_of(const Strikes& strikes) {
  std::vector<BrickId> trunk;
  for (BrickId brick = strikes.last; brick >= 0 && trunk.size() < strikes.by.size(); brick = strikes.by[static_cast<std::size_t>(brick)]) {
    trunk.push_back(brick);
  }
  std::reverse(trunk.begin(), trunk.end());
  return trunk;
}

std::vector<double> distances(const Layout& layout, std::span<const BrickId> trunk) {
  std::vector<double> distance(trunk.size(), 0.0);
  for (std::size_t i = 1; i < trunk.size(); ++i) {
    const Vec3& from = layout.bricks[static_cast<std::size_t>(trunk[i - 1])].foot;
    distance[i] = distance[i - 1] + norm(layout.bricks[static_cast<std::size_t>(trunk[i])].foot - from);
  }
  return distance;
}

double speed_between(const Wave& wave, std::size_t from, std::size_t to) {
  const double time = wave.arrival[to] - wave.arrival[from];
  return time > 0.0 ? (wave.distance[to] - wave.distance[from]) / time : kNever;
}

std::size_t at_fraction(std::size_t count, double fraction) {
  return static_cast<std::size_t>(std::floor(fraction * static_cast<double>(count - 1) + 0.5));
}

}  // namespace

Wave measure_wave(const Recording& recording) {
  Wave wave;
  const Strikes strikes = strikes_of(recording);
  wave.bricks = trunk_of(strikes);
  wave.distance = distances(recording.layout(), wave.bricks);
  wave.arrival.reserve(wave.bricks.size());
  for (const BrickId brick : wave.bricks) wave.arrival.push_back(strikes.arrival[static_cast<std::size_t>(brick)]);
  const std::size_t count = wave.bricks.size();
  if (count >= kFewest) wave.front_speed = speed_between(wave, at_fraction(count, 0.2), at_fraction(count, 0.8));
  return wave;
}

double Wave::local_speed(std::size_t index, std::size_t window) const {
  if (bricks.empty() || index >= bricks.size()) return kNever;
  const std::size_t from = index - std::min(index, window);
  const std::size_t to = index + std::min(bricks.size() - 1 - index, window);
  return speed_between(*this, from, to);
}

std::vector<BrickId> first_strikers(const Recording& recording) {
  std::vector<BrickId> by = strikes_of(recording).by;
  for (BrickId& striker : by) striker = std::max(striker, kNoBrick);
  return by;
}

std::vector<std::uint8_t> fallen_bricks(const Recording& recording) {
  const Layout& layout = recording.layout();
  std::vector<std::uint8_t> fallen(layout.bricks.size());
  // Bricks of one kind that stand alike have one tip angle, and mostly follow each other.
  std::uint16_t kind = 0;
  Stance stance = Stance::standing;
  double tip = kNever;
  for (BrickId brick = 0; brick < layout.brick_count(); ++brick) {
    const Brick& put = layout.bricks[static_cast<std::size_t>(brick)];
    if (tip != tip || put.kind != kind || put.stance != stance) {
      kind = put.kind;
      stance = put.stance;
      tip = tip_angle(extents(layout.kind_of(brick), stance));
    }
    fallen[static_cast<std::size_t>(brick)] = std::abs(recording.rest_angle(brick)) > tip ? 1 : 0;
  }
  return fallen;
}

RunSummary summarize(const Recording& recording) {
  RunSummary summary;
  summary.bricks = recording.layout().brick_count();
  summary.duration = recording.duration();
  const std::vector<std::uint8_t> fallen = fallen_bricks(recording);
  summary.fallen = std::count(fallen.begin(), fallen.end(), 1);
  summary.standing = summary.bricks - summary.fallen;
  summary.front_speed = measure_wave(recording).front_speed;
  return summary;
}

}  // namespace topple

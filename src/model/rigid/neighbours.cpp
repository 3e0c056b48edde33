#include "model/rigid/neighbours.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace topple::rigid {

namespace {

double radius_of(const BrickKind& kind) {
  return 0.5 * std::sqrt(kind.thickness * kind.thickness + kind.width * kind.width + kind.height * kind.height);
}

}  // namespace

Neighbours::Neighbours(const Layout& layout, const RunUnits& units) {
  double largest = 0.0;
  for (const BrickKind& kind : layout.kinds) largest = std::max(largest, radius_of(units.kind(kind)));
  // Two radii, and half a radius more: a list of neighbours stays good while its brick moves a little.
  size_ = 2.5 * largest;
  const std::size_t count = layout.bricks.size();
  first_.assign(std::bit_ceil(std::max<std::size_t>(count, 16)), kNoBrick);
  next_.assign(count, kNoBrick);
  for (BrickId brick = layout.brick_count(); brick-- > 0;) {
    const Vec3 foot = units.foot(layout.bricks[static_cast<std::size_t>(brick)]);
    BrickId& head = first_[bucket(cell(foot.x), cell(foot.y))];
    next_[static_cast<std::size_t>(brick)] = head;
    head = brick;
  }
}

std::int64_t Neighbours::cell(double length) const { return static_cast<std::int64_t>(std::floor(length / size_)); }

std::size_t Neighbours::bucket(std::int64_t column, std::int64_t row) const {
  std::uint64_t mixed =
      static_cast<std::uint64_t>(column) * 0x9E3779B97F4A7C15ULL + static_cast<std::uint64_t>(row) * 0xC2B2AE3D27D4EB4FULL;
  mixed ^= mixed >> 29;
  mixed *= 0xBF58476D1CE4E5B9ULL;
  return static_cast<std::size_t>(mixed >> 32) & (first_.size() - 1);
}

void Neighbours::near(const Vec3& place, std::vector<BrickId>& out) const {
  out.clear();
  for (std::int64_t column = cell(place.x) - 1; column <= cell(place.x) + 1; ++column) {
    for (std::int64_t row = cell(place.y) - 1; row <= cell(place.y) + 1; ++row) {
      for (BrickId brick = first_[bucket(column, row)]; brick != kNoBrick; brick = next_[static_cast<std::size_t>(brick)])
        out.push_back(brick);
    }
  }
  // Two cells may share a bucket.
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

void Neighbours::moved(BrickId brick, const Vec3& from, const Vec3& to) {
  const std::size_t old_bucket = bucket(cell(from.x), cell(from.y));
  const std::size_t new_bucket = bucket(cell(to.x), cell(to.y));
  if (old_bucket == new_bucket) return;
  // A place on the edge of a cell may have been rounded to its other side when the brick was put there.
  bool found = unlink(brick, old_bucket);
  for (std::int64_t column = cell(from.x) - 1; column <= cell(from.x) + 1 && !found; ++column) {
    for (std::int64_t row = cell(from.y) - 1; row <= cell(from.y) + 1 && !found; ++row) found = unlink(brick, bucket(column, row));
  }
  if (!found) return;
  next_[static_cast<std::size_t>(brick)] = first_[new_bucket];
  first_[new_bucket] = brick;
}

bool Neighbours::unlink(BrickId brick, std::size_t bucket) {
  for (BrickId* link = &first_[bucket]; *link != kNoBrick; link = &next_[static_cast<std::size_t>(*link)]) {
    if (*link != brick) continue;
    *link = next_[static_cast<std::size_t>(brick)];
    return true;
  }
  return false;
}

}  // namespace topple::rigid

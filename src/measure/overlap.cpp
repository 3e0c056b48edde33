#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>

#include "topple/measure.h"

namespace topple {
namespace {

struct Placed {
  Box box;
  double thickness;
  bool moved;  // Its place is not as it was put down.
};

/// A square of the floor; bricks that touch are in the same or in neighbouring squares.
struct Cell {
  std::int64_t x = 0;
  std::int64_t y = 0;
  friend auto operator<=>(const Cell&, const Cell&) = default;
};
struct Entry {
  Cell cell;
  BrickId brick;
};

std::vector<Placed> place_all(const Recording& recording, double time) {
  const Layout& layout = recording.layout();
  std::vector<Placed> placed;
  placed.reserve(layout.bricks.size());
  for (BrickId brick = 0; brick < layout.brick_count(); ++brick) {
    const BrickKind& kind = layout.kind_of(brick);
    const Pose pose = recording.at(brick, time).pose;
    const Pose put = standing_pose(layout, brick);
    const bool moved = !(pose.position == put.position && pose.orientation == put.orientation);
    placed.push_back({{pose, half_extents(kind), kind.shape}, kind.thickness, moved});
  }
  return placed;
}

Cell cell_of(const Placed& brick, double size) {
  return {static_cast<std::int64_t>(std::floor(brick.box.pose.position.x / size)),
          static_cast<std::int64_t>(std::floor(brick.box.pose.position.y / size))};
}

std::vector<Entry> sort_into_cells(std::span<const Placed> bricks, double size) {
  std::vector<Entry> entries;
  entries.reserve(bricks.size());
  for (std::size_t i = 0; i < bricks.size(); ++i) entries.push_back({cell_of(bricks[i], size), static_cast<BrickId>(i)});
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.cell != b.cell ? a.cell < b.cell : a.brick < b.brick; });
  return entries;
}

// Deepest pair of one brick that moved with any near it; of two that moved the one of lower number asks.
void ask_neighbours(std::span<const Placed> bricks, std::span<const Entry> entries, double size, BrickId brick, Overlap& deepest) {
  const Placed& one = bricks[static_cast<std::size_t>(brick)];
  const Cell centre = cell_of(one, size);
  for (std::int64_t x = centre.x - 1; x <= centre.x + 1; ++x) {
    auto entry = std::lower_bound(entries.begin(), entries.end(), Cell{x, centre.y - 1},
                                  [](const Entry& e, const Cell& cell) { return e.cell < cell; });
    for (; entry != entries.end() && entry->cell <= Cell{x, centre.y + 1}; ++entry) {
      const Placed& other = bricks[static_cast<std::size_t>(entry->brick)];
      if (entry->brick == brick || (other.moved && entry->brick < brick)) continue;
      const double depth = -separation(one.box, other.box) / std::min(one.thickness, other.thickness);
      if (depth > deepest.depth) deepest = {depth, std::min(brick, entry->brick), std::max(brick, entry->brick)};
    }
  }
}

}  // namespace

Overlap deepest_overlap(const Recording& recording, double time) {
  const std::vector<Placed> bricks = place_all(recording, time);
  double size = 0.0;
  for (const Placed& brick : bricks) size = std::max(size, 2.0 * norm(brick.box.half));
  Overlap deepest;
  if (bricks.empty()) return deepest;
  const std::vector<Entry> entries = sort_into_cells(bricks, size);
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    if (bricks[i].moved) ask_neighbours(bricks, entries, size, static_cast<BrickId>(i), deepest);
  }
  return deepest;
}

}  // namespace topple

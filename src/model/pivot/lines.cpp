#include "model/pivot/lines.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/trigonometry.h"
#include "model/pivot/lean.h"

namespace topple::pivot {

namespace {

/// Bricks by square cell of the floor, so that those within reach of one are found without looking at all.
class FloorGrid {
 public:
  FloorGrid(const Layout& layout, double cell) : cell_(cell) {
    entries_.reserve(layout.bricks.size());
    for (BrickId i = 0; i < layout.brick_count(); ++i) {
      const Vec3& foot = layout.bricks[static_cast<std::size_t>(i)].foot;
      entries_.push_back({.row = index(foot.y), .column = index(foot.x), .brick = i});
    }
    if (!std::is_sorted(entries_.begin(), entries_.end())) std::sort(entries_.begin(), entries_.end());
  }

  /// Bricks in the cell of `foot` and the eight around it, in a fixed order.
  void near(const Vec3& foot, std::vector<BrickId>& out) const {
    out.clear();
    const std::int32_t column = index(foot.x);
    for (std::int32_t row = index(foot.y) - 1; row <= index(foot.y) + 1; ++row) {
      auto entry = std::lower_bound(entries_.begin(), entries_.end(), Entry{row, column - 1, 0});
      for (; entry != entries_.end() && entry->row == row && entry->column <= column + 1; ++entry) out.push_back(entry->brick);
    }
  }

 private:
  struct Entry {
    std::int32_t row;
    std::int32_t column;
    BrickId brick;
    friend auto operator<=>(const Entry&, const Entry&) = default;
  };

  std::int32_t index(double x) const { return static_cast<std::int32_t>(std::floor(x / cell_)); }

  double cell_;
  std::vector<Entry> entries_;
};

/// A brick that another can reach, and how far that one has to turn.
struct Reached {
  double contact_angle;
  BrickId brick;
  std::int8_t side;
};

class LineFinder {
 public:
  explicit LineFinder(const Layout& layout) : layout_(layout), grid_(layout, reach(layout)) {
    const std::size_t n = layout.bricks.size();
    lines_ = {.ahead = std::vector<BrickId>(n, kNoBrick),
              .sibling = std::vector<BrickId>(n, kNoBrick),
              .behind = std::vector<BrickId>(n, kNoBrick),
              .depth = std::vector<std::int32_t>(n, -1),
              .side = std::vector<std::int8_t>(n, 0)};
  }

  Result<Lines> find() {
    for (const Push& push : layout_.pushes) {
      if (lines_.side[at(push.brick)] != 0) continue;
      lines_.side[at(push.brick)] = 1;
      queue_.push_back(push.brick);
    }
    // The queue becomes the list of all bricks within reach of a wave.
    for (std::size_t next = 0; next < queue_.size(); ++next) {
      if (auto linked = link(queue_[next]); !linked) return std::unexpected(linked.error());
    }
    if (auto counted = count_depths(); !counted) return std::unexpected(counted.error());
    return std::move(lines_);
  }

 private:
  static std::size_t at(BrickId brick) { return static_cast<std::size_t>(brick); }

  /// Foot to foot, no brick touches one further away than this [m].
  static double reach(const Layout& layout) {
    double height = 0.0;
    double diagonal = 0.0;
    for (const BrickKind& kind : layout.kinds) {
      for (const Stance stance : {Stance::standing, Stance::flat, Stance::on_side}) {
        const Extents size = extents(kind, stance);
        height = std::fmax(height, std::hypot(size.up, size.along));
        diagonal = std::fmax(diagonal, std::hypot(size.along, size.across));
      }
    }
    return height + diagonal;
  }

  Vec3 direction(BrickId brick) const {
    const SinCos heading = sin_cos(layout_.bricks[at(brick)].heading);
    return static_cast<double>(lines_.side[at(brick)]) * Vec3{heading.cos, heading.sin, 0.0};
  }

  /// All bricks ahead that `brick` would touch if it fell alone, nearest contact first.
  void find_reached(BrickId brick) {
    const Brick& self = layout_.bricks[at(brick)];
    const Extents size = extents(layout_.kinds[self.kind], self.stance);
    const Vec3 forward = direction(brick);
    grid_.near(self.foot, near_);
    reached_.clear();
    for (const BrickId other : near_) {
      const Brick& candidate = layout_.bricks[at(other)];
      const Extents other_size = extents(layout_.kinds[candidate.kind], candidate.stance);
      const Vec3 offset = candidate.foot - self.foot;
      const double along = dot(offset, forward);
      const double across = std::fabs(forward.x * offset.y - forward.y * offset.x);
      const double radius = 0.5 * (other_size.along + other_size.across);
      if (other == brick || along <= 0.0 || along > 0.5 * size.along + size.up + radius) continue;
      if (across >= 0.5 * size.across + radius) continue;
      const SinCos heading = sin_cos(candidate.heading);
      const auto side = static_cast<std::int8_t>(forward.x * heading.cos + forward.y * heading.sin >= 0.0 ? 1 : -1);
      if (passes_beside(self, candidate, across)) continue;
      const Pair pair(layout_, brick, lines_.side[at(brick)], other, side);
      if (!std::isnan(pair.contact_angle())) reached_.push_back({pair.contact_angle(), other, side});
    }
    std::sort(reached_.begin(), reached_.end(), [](const Reached& a, const Reached& b) {
      return a.contact_angle < b.contact_angle || (a.contact_angle == b.contact_angle && a.brick < b.brick);
    });
  }

  /// Bricks in line whose widths do not overlap never touch, although the planar closed forms would let them.
  bool passes_beside(const Brick& a, const Brick& b, double across) const {
    const Extents size = extents(layout_.kinds[a.kind], a.stance);
    const Extents other = extents(layout_.kinds[b.kind], b.stance);
    const SinCos turned = sin_cos(b.heading - a.heading);
    const double half = 0.5 * (size.across + std::fabs(turned.cos) * other.across + std::fabs(turned.sin) * other.along);
    return across >= half;
  }

  /// A brick hidden behind another that is struck first is that one's to strike.
  bool hidden(const Reached& far, std::size_t nearer) const {
    for (std::size_t i = 0; i < nearer; ++i) {
      if (reached_[i].brick == kNoBrick) continue;
      const Brick& between = layout_.bricks[at(reached_[i].brick)];
      const Brick& beyond = layout_.bricks[at(far.brick)];
      const SinCos heading = sin_cos(between.heading);
      const Vec3 forward = static_cast<double>(reached_[i].side) * Vec3{heading.cos, heading.sin, 0.0};
      const Vec3 offset = beyond.foot - between.foot;
      const double across = std::fabs(forward.x * offset.y - forward.y * offset.x);
      if (dot(offset, forward) <= 0.0 || passes_beside(between, beyond, across)) continue;
      const Pair pair(layout_, reached_[i].brick, reached_[i].side, far.brick, far.side);
      if (!std::isnan(pair.contact_angle())) return true;
    }
    return false;
  }

  Result<void> link(BrickId brick) {
    find_reached(brick);
    BrickId* tail = &lines_.ahead[at(brick)];
    for (std::size_t i = 0; i < reached_.size(); ++i) {
      if (hidden(reached_[i], i)) {
        reached_[i].brick = kNoBrick;
        continue;
      }
      const BrickId other = reached_[i].brick;
      if (lines_.behind[at(other)] != kNoBrick) return refuse_merge(other, lines_.behind[at(other)], brick);
      lines_.behind[at(other)] = brick;
      *tail = other;
      tail = &lines_.sibling[at(other)];
      if (lines_.side[at(other)] != 0) continue;
      lines_.side[at(other)] = reached_[i].side;
      queue_.push_back(other);
    }
    return {};
  }

  Result<void> refuse_merge(BrickId brick, BrickId one, BrickId other) const {
    return failure(layout_.name + ": model pivot: bricks " + std::to_string(std::min(one, other)) + " and " +
                   std::to_string(std::max(one, other)) + " can both strike brick " + std::to_string(brick) +
                   "; this model follows lines and splits, not merges or crossings (model \"rigid\" does)");
  }

  Result<void> count_depths() {
    std::size_t counted = 0;
    std::vector<BrickId> open;
    for (const BrickId first : queue_) {
      if (lines_.behind[at(first)] != kNoBrick) continue;
      lines_.depth[at(first)] = 0;
      open.push_back(first);
      while (!open.empty()) {
        const BrickId brick = open.back();
        open.pop_back();
        ++counted;
        for (BrickId next = lines_.ahead[at(brick)]; next != kNoBrick; next = lines_.sibling[at(next)]) {
          lines_.depth[at(next)] = lines_.depth[at(brick)] + 1;
          open.push_back(next);
        }
      }
    }
    if (counted == queue_.size()) return {};
    const auto looped = std::find_if(queue_.begin(), queue_.end(), [this](BrickId b) { return lines_.depth[at(b)] < 0; });
    return failure(layout_.name + ": model pivot: the line through brick " + std::to_string(*looped) +
                   " comes back to itself; this model follows lines with an end (model \"rigid\" does not need one)");
  }

  const Layout& layout_;
  FloorGrid grid_;
  Lines lines_;
  std::vector<BrickId> queue_;
  std::vector<BrickId> near_;
  std::vector<Reached> reached_;
};

}  // namespace

Result<Lines> find_lines(const Layout& layout) {
  for (BrickId i = 0; i < layout.brick_count(); ++i) {
    if (layout.kind_of(i).shape == Shape::ball) {
      return failure(layout.name + ": model pivot: brick " + std::to_string(i) +
                     " is a ball; this model knows only bricks that turn about an edge (model \"rigid\" knows all)");
    }
    if (layout.bricks[static_cast<std::size_t>(i)].foot.z != 0.0) {
      return failure(layout.name + ": model pivot: brick " + std::to_string(i) + " stands " +
                     std::to_string(1000.0 * layout.bricks[static_cast<std::size_t>(i)].foot.z) +
                     " mm above the floor; this model knows only bricks on the floor (model \"rigid\" knows all)");
    }
  }
  return LineFinder(layout).find();
}

}  // namespace topple::pivot

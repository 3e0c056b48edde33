#include "layout/overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/trigonometry.h"
#include "layout/text.h"

namespace topple {
namespace {

constexpr double kTolerance = 1e-3;  // of the thinner brick's thickness: places written to a hundredth of a millimetre may touch
constexpr int kLevels = 64;

/// Bricks of one kind in one stance.
struct Form {
  Extents size;
  double radius = 0.0;     // of the circle around it, seen from above [m]
  double thickness = 0.0;  // [m]
  int level = 0;           // its diameter is at most 2^(level - 32) m
};

/// A brick in a cell of its level's grid. Sorted by cell: along x, then y, then z.
struct Entry {
  std::uint64_t cell = 0;
  BrickId brick = 0;
};

/// Bricks whose plan has about one size, in cells at least as wide as they are: what overlaps stands in neighbouring cells.
struct Grid {
  double width = 0.0;  // of a cell [m]
  std::vector<Entry> entries;
};

constexpr int kCellBits = 21;
constexpr std::uint64_t kRow = std::uint64_t{1} << kCellBits, kStorey = std::uint64_t{1} << (2 * kCellBits);

class OverlapSearch {
 public:
  OverlapSearch(const Layout& layout, std::size_t most) : layout_(layout), most_(most) {
    for (const BrickKind& kind : layout.kinds) {
      for (const Stance stance : {Stance::standing, Stance::flat, Stance::on_side}) forms_.push_back(form_of(kind, stance));
    }
    find_low_and_storey();
    fill_grids();
  }

  std::vector<OverlappingPair> run() {
    for (int level = 0; level < kLevels && !full(); ++level) {
      if (grids_[static_cast<std::size_t>(level)].entries.empty()) continue;
      search_level(grids_[static_cast<std::size_t>(level)]);
      for (int coarser = level + 1; coarser < kLevels && !full(); ++coarser) {
        const Grid& wide = grids_[static_cast<std::size_t>(coarser)];
        if (!wide.entries.empty()) search_coarser(grids_[static_cast<std::size_t>(level)], wide);
      }
    }
    std::sort(found_.begin(), found_.end(), [](const OverlappingPair& a, const OverlappingPair& b) {
      return std::pair(a.first, a.second) < std::pair(b.first, b.second);
    });
    return std::move(found_);
  }

 private:
  static Form form_of(const BrickKind& kind, Stance stance) {
    const Extents size = extents(kind, stance);
    const double diameter = std::sqrt(size.along * size.along + size.across * size.across);
    int exponent = 0;
    std::frexp(diameter, &exponent);  // diameter < 2^exponent
    return {size, 0.5 * diameter, kind.thickness, std::clamp(exponent + 32, 0, kLevels - 1)};
  }

  const Brick& brick(BrickId id) const { return layout_.bricks[static_cast<std::size_t>(id)]; }
  const Form& form(const Brick& brick) const { return forms_[std::size_t{brick.kind} * 3 + static_cast<std::size_t>(brick.stance)]; }
  bool full() const { return found_.size() >= most_; }

  void find_low_and_storey() {
    Vec3 high = low_ = layout_.bricks.empty() ? Vec3{} : layout_.bricks[0].foot;
    for (const Brick& brick : layout_.bricks) {
      const Vec3& foot = brick.foot;
      low_ = {std::fmin(low_.x, foot.x), std::fmin(low_.y, foot.y), std::fmin(low_.z, foot.z)};
      high = {std::fmax(high.x, foot.x), std::fmax(high.y, foot.y), std::fmax(high.z, foot.z)};
      storey_ = std::fmax(storey_, form(brick).size.up);
    }
    const double span = std::fmax(high.x - low_.x, high.y - low_.y);
    constexpr double kMostCells = 1 << (kCellBits - 1);
    least_width_ = span / kMostCells;
    storey_ = std::fmax(storey_, (high.z - low_.z) / kMostCells);
  }

  /// The cell of a foot; one more on each side stays free, so that neighbours never wrap.
  std::uint64_t cell_of(const Vec3& foot, double width) const {
    const auto index = [](double distance, double size) { return static_cast<std::uint64_t>(distance / size) + 1; };
    return index(foot.x - low_.x, width) + kRow * index(foot.y - low_.y, width) + kStorey * index(foot.z - low_.z, storey_);
  }

  void fill_grids() {
    std::array<std::size_t, kLevels> sizes{};
    for (const Brick& brick : layout_.bricks) ++sizes[static_cast<std::size_t>(form(brick).level)];
    for (int level = 0; level < kLevels; ++level) {
      Grid& grid = grids_[static_cast<std::size_t>(level)];
      grid.width = std::fmax(std::ldexp(1.0, level - 32), least_width_);
      grid.entries.reserve(sizes[static_cast<std::size_t>(level)]);
    }
    for (BrickId id = 0; id < layout_.brick_count(); ++id) {
      Grid& grid = grids_[static_cast<std::size_t>(form(brick(id)).level)];
      grid.entries.push_back({cell_of(brick(id).foot, grid.width), id});
    }
    const auto order = [](const Entry& a, const Entry& b) { return std::pair(a.cell, a.brick) < std::pair(b.cell, b.brick); };
    for (Grid& grid : grids_) {
      if (!std::is_sorted(grid.entries.begin(), grid.entries.end(), order)) std::sort(grid.entries.begin(), grid.entries.end(), order);
    }
  }

  /// Every pair inside one grid once: a brick with those behind it in its own cell, the next one, and the rows that come later.
  void search_level(const Grid& grid) {
    constexpr std::array<std::uint64_t, 4> kLater{kRow, kStorey - kRow, kStorey, kStorey + kRow};
    std::array<std::size_t, 4> cursors{};
    const std::vector<Entry>& entries = grid.entries;
    for (std::size_t i = 0; i < entries.size() && !full(); ++i) {
      const std::uint64_t cell = entries[i].cell;
      for (std::size_t j = i + 1; j < entries.size() && entries[j].cell <= cell + 1 && !full(); ++j)
        test(entries[i].brick, entries[j].brick);
      for (std::size_t row = 0; row < kLater.size(); ++row) {
        const std::uint64_t middle = cell + kLater[row];
        std::size_t& cursor = cursors[row];  // cells ascend, so it never has to go back
        while (cursor < entries.size() && entries[cursor].cell < middle - 1) ++cursor;
        for (std::size_t j = cursor; j < entries.size() && entries[j].cell <= middle + 1 && !full(); ++j)
          test(entries[i].brick, entries[j].brick);
      }
    }
  }

  void search_coarser(const Grid& fine, const Grid& wide) {
    const auto before = [](const Entry& entry, std::uint64_t cell) { return entry.cell < cell; };
    for (const Entry& entry : fine.entries) {
      const std::uint64_t cell = cell_of(brick(entry.brick).foot, wide.width);
      for (const std::uint64_t storey : {cell - kStorey, cell, cell + kStorey}) {
        for (const std::uint64_t middle : {storey - kRow, storey, storey + kRow}) {
          auto other = std::lower_bound(wide.entries.begin(), wide.entries.end(), middle - 1, before);
          for (; other != wide.entries.end() && other->cell <= middle + 1 && !full(); ++other) test(entry.brick, other->brick);
        }
      }
      if (full()) return;
    }
  }

  /// True when a cheap look already shows the two apart: heights, circles, and for equal headings the rectangles.
  bool clearly_apart(const Brick& a, const Form& fa, const Brick& b, const Form& fb) {
    const Vec3 d = b.foot - a.foot;
    if (d.z >= fa.size.up || -d.z >= fb.size.up) return true;
    const double reach = fa.radius + fb.radius;
    if (d.x * d.x + d.y * d.y >= reach * reach) return true;
    if (a.heading != b.heading) return false;
    if (a.heading != heading_) {
      heading_ = a.heading;
      turn_ = sin_cos(heading_);
    }
    return std::abs(d.x * turn_.cos + d.y * turn_.sin) >= 0.5 * (fa.size.along + fb.size.along) ||
           std::abs(d.y * turn_.cos - d.x * turn_.sin) >= 0.5 * (fa.size.across + fb.size.across);
  }

  void test(BrickId first, BrickId second) {
    const Brick &a = brick(first), &b = brick(second);
    const Form &fa = form(a), &fb = form(b);
    if (clearly_apart(a, fa, b, fb)) return;
    const BrickKind &ka = layout_.kind_of(first), &kb = layout_.kind_of(second);
    const double depth = -separation({standing_pose(layout_, first), half_extents(ka), ka.shape},
                                     {standing_pose(layout_, second), half_extents(kb), kb.shape});
    if (depth > kTolerance * std::fmin(fa.thickness, fb.thickness))
      found_.push_back({std::min(first, second), std::max(first, second), depth});
  }

  const Layout& layout_;
  const std::size_t most_;
  std::vector<Form> forms_;  // three a kind, in the order of Stance
  std::array<Grid, kLevels> grids_;
  Vec3 low_;
  double least_width_ = 0.0;  // [m]; finer cells than this would not fit the bits
  double storey_ = 0.0;       // height of a cell, at least that of the tallest brick [m]
  std::vector<OverlappingPair> found_;
  double heading_ = 0.0;
  SinCos turn_{};
};

}  // namespace

std::vector<OverlappingPair> find_overlaps(const Layout& layout, std::size_t most) { return OverlapSearch(layout, most).run(); }

void report_overlaps(const Layout& layout, const std::vector<PartPlan>& plans, Problems& problems) {
  constexpr std::size_t kMost = 1000;
  const std::vector<OverlappingPair> overlaps = find_overlaps(layout, kMost);
  const std::vector<BrickId> firsts = first_bricks(plans);
  for (const OverlappingPair& overlap : overlaps) {
    const auto after = std::upper_bound(firsts.begin(), firsts.end(), overlap.second);
    const PartPlan& plan = plans[static_cast<std::size_t>(after - firsts.begin()) - 1];
    problems.add(plan.place, plan.path,
                 "brick " + std::to_string(overlap.first) + " (" + layout.part_of(overlap.first)->name + ") and brick " +
                     std::to_string(overlap.second) + " (" + layout.part_of(overlap.second)->name + ") overlap by " +
                     number_text(std::round(overlap.depth * 1e6) / 1e3) + " mm; bricks may touch, not overlap");
  }
  if (overlaps.size() == kMost) problems.stop_counting();
}

}  // namespace topple

#include "layout/supports.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "layout/text.h"

namespace topple {
namespace {

constexpr double kTouching = 1e-2;  // of the thickness: no farther above what it stands on

Box box_of(const Layout& layout, BrickId id) {
  const BrickKind& kind = layout.kind_of(id);
  return {standing_pose(layout, id), half_extents(kind), kind.shape};
}

double up_of(const Layout& layout, BrickId id) {
  return extents(layout.kind_of(id), layout.bricks[static_cast<std::size_t>(id)].stance).up;
}

/// A brick by the height of its top and the column of the floor that it stands in.
struct Top {
  std::int64_t column = 0, row = 0;
  BrickId brick = 0;
};
bool before(const Top& a, const Top& b) { return std::tie(a.column, a.row, a.brick) < std::tie(b.column, b.row, b.brick); }

class SupportSearch {
 public:
  explicit SupportSearch(const Layout& layout) : layout_(layout) {
    for (const BrickKind& kind : layout.kinds) size_ = std::fmax(size_, 2.0 * norm(half_extents(kind)));
    tops_.reserve(layout.bricks.size());
    for (BrickId id = 0; id < layout.brick_count(); ++id) tops_.push_back(top_of(id));
    std::sort(tops_.begin(), tops_.end(), before);
  }

  bool supported(BrickId id) const {
    const Top at = top_of(id);
    for (std::int64_t column = at.column - 1; column <= at.column + 1; ++column) {
      auto other = std::lower_bound(tops_.begin(), tops_.end(), Top{column, at.row - 1, 0}, before);
      for (; other != tops_.end() && other->column == column && other->row <= at.row + 1; ++other) {
        if (other->brick != id && carries(other->brick, id)) return true;
      }
    }
    return false;
  }

 private:
  Top top_of(BrickId id) const {
    const Vec3& foot = layout_.bricks[static_cast<std::size_t>(id)].foot;
    return {static_cast<std::int64_t>(std::floor(foot.x / size_)), static_cast<std::int64_t>(std::floor(foot.y / size_)), id};
  }

  bool carries(BrickId below, BrickId above) const {
    const double tolerance = kTouching * std::fmin(layout_.kind_of(below).thickness, layout_.kind_of(above).thickness);
    const double top = layout_.bricks[static_cast<std::size_t>(below)].foot.z + up_of(layout_, below);
    if (std::abs(layout_.bricks[static_cast<std::size_t>(above)].foot.z - top) > tolerance) return false;
    Box lowered = box_of(layout_, above);
    lowered.pose.position.z -= 2.0 * tolerance;
    return separation(lowered, box_of(layout_, below)) < 0.0;
  }

  const Layout& layout_;
  double size_ = 0.0;  // of a column [m]; what touches is in the same or in neighbouring ones
  std::vector<Top> tops_;
};

}  // namespace

std::vector<BrickId> find_unsupported(const Layout& layout, std::size_t most) {
  std::vector<BrickId> found;
  const auto raised = [&](const Brick& brick) { return brick.foot.z > kTouching * layout.kinds[brick.kind].thickness; };
  if (std::none_of(layout.bricks.begin(), layout.bricks.end(), raised)) return found;
  const SupportSearch search(layout);
  for (BrickId id = 0; id < layout.brick_count() && found.size() < most; ++id) {
    if (raised(layout.bricks[static_cast<std::size_t>(id)]) && !search.supported(id)) found.push_back(id);
  }
  return found;
}

void report_unsupported(const Layout& layout, const std::vector<PartPlan>& plans, Problems& problems) {
  constexpr std::size_t kMost = 1000;
  const std::vector<BrickId> found = find_unsupported(layout, kMost);
  const std::vector<BrickId> firsts = first_bricks(plans);
  for (const BrickId brick : found) {
    const auto after = std::upper_bound(firsts.begin(), firsts.end(), brick);
    const PartPlan& plan = plans[static_cast<std::size_t>(after - firsts.begin()) - 1];
    problems.add(plan.place, plan.path,
                 "brick " + std::to_string(brick) + " (" + layout.part_of(brick)->name + ") is " +
                     number_text(std::round(layout.bricks[static_cast<std::size_t>(brick)].foot.z * 1e6) / 1e3) +
                     " mm above the floor with no brick under it");
  }
  if (found.size() == kMost) problems.stop_counting();
}

}  // namespace topple

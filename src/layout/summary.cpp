// What was built, in numbers.
#include <cmath>
#include <limits>

#include "base/trigonometry.h"
#include "layout/text.h"
#include "topple/layout.h"

namespace topple {
LayoutSummary summarize(const Layout& layout) {
  LayoutSummary summary;
  summary.bricks = layout.brick_count();
  constexpr double kFar = std::numeric_limits<double>::max();
  if (!layout.bricks.empty()) {
    summary.low = {kFar, kFar, kFar};
    summary.high = {-kFar, -kFar, -kFar};
  }
  std::vector<std::int64_t> kinds(layout.kinds.size()), colors(layout.colors.size());
  for (const Brick& brick : layout.bricks) {
    const Extents size = extents(layout.kinds[brick.kind], brick.stance);
    const SinCos turn = sin_cos(brick.heading);
    const double x = 0.5 * (std::abs(turn.cos) * size.along + std::abs(turn.sin) * size.across);
    const double y = 0.5 * (std::abs(turn.sin) * size.along + std::abs(turn.cos) * size.across);
    const Vec3 low = brick.foot - Vec3{x, y, 0.0}, high = brick.foot + Vec3{x, y, size.up};
    summary.low = {std::fmin(summary.low.x, low.x), std::fmin(summary.low.y, low.y), std::fmin(summary.low.z, low.z)};
    summary.high = {std::fmax(summary.high.x, high.x), std::fmax(summary.high.y, high.y), std::fmax(summary.high.z, high.z)};
    ++kinds[brick.kind];
    ++colors[brick.color];
  }
  for (const Part& part : layout.parts) {
    if (!part.line) continue;
    for (BrickId i = part.first + 1; i < part.first + part.count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      summary.length += norm(layout.bricks[n].foot - layout.bricks[n - 1].foot);
    }
  }
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i] > 0) summary.kinds.push_back({layout.kinds[i].name, kinds[i]});
  }
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (colors[i] > 0) summary.colors.push_back({color_text(layout.colors[i]), colors[i]});
  }
  return summary;
}

}  // namespace topple

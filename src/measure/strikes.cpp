#include "measure/strikes.h"

#include <cstddef>
#include <limits>

namespace topple {

Strikes strikes_of(const Recording& recording) {
  constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
  const auto bricks = static_cast<std::size_t>(recording.layout().brick_count());
  Strikes strikes{std::vector<BrickId>(bricks, Strikes::kUnknown), std::vector<double>(bricks, kNever), kNoBrick};
  for (std::int64_t i = 0; i < recording.event_count(); ++i) {
    const Event event = recording.event(i);
    BrickId& by = strikes.by[static_cast<std::size_t>(event.brick)];
    if (event.kind == EventKind::pushed && by == Strikes::kUnknown) by = kNoBrick;
    if (event.kind == EventKind::struck && by == Strikes::kUnknown) by = event.by;
    if (event.kind == EventKind::arrived) {
      if (by == Strikes::kUnknown) by = kNoBrick;
      strikes.last = event.brick;
      strikes.arrival[static_cast<std::size_t>(event.brick)] = event.time;
    }
  }
  return strikes;
}

}  // namespace topple

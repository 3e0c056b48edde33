// The time sheet: when the wave came to each part of the layout, how fast it went through, and who brought it.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "measure/strikes.h"
#include "topple/measure.h"

namespace topple {
namespace {

bool holds(const Part& part, BrickId brick) { return brick >= part.first && brick - part.first < part.count; }

/// From the first to the last brick that was reached, along the part [m].
double way_through(const Layout& layout, const PartTimes& times) {
  const auto [low, high] = std::minmax(times.first, times.last);
  double way = 0.0;
  for (auto i = static_cast<std::size_t>(low); i < static_cast<std::size_t>(high); ++i) {
    way += norm(layout.bricks[i + 1].foot - layout.bricks[i].foot);
  }
  return way;
}

/// The beginning of the wave inside a part: its first brick, or who struck that, as long as they are of this part.
BrickId beginning(const Part& part, BrickId first, const Strikes& strikes) {
  BrickId brick = first;
  for (BrickId steps = 0; steps < part.count; ++steps) {
    const BrickId by = strikes.by[static_cast<std::size_t>(brick)];
    if (!holds(part, by)) break;
    brick = by;
  }
  return brick;
}

PartTimes times_of(const Layout& layout, std::size_t index, const Strikes& strikes, const std::vector<std::uint8_t>& fallen) {
  const Part& part = layout.parts[index];
  PartTimes times{.part = index};
  for (BrickId brick = part.first; brick < part.first + part.count; ++brick) {
    const auto i = static_cast<std::size_t>(brick);
    times.fallen += fallen[i];
    const double arrival = strikes.arrival[i];
    if (std::isnan(arrival)) continue;
    ++times.reached;
    if (times.first == kNoBrick || arrival < times.first_arrival) {
      times.first = brick;
      times.first_arrival = arrival;
    }
    if (times.last == kNoBrick || arrival > times.last_arrival) {
      times.last = brick;
      times.last_arrival = arrival;
    }
  }
  const double duration = times.last_arrival - times.first_arrival;
  if (duration > 0.0) {
    times.brick_rate = static_cast<double>(times.reached - 1) / duration;
    if (part.line) times.speed = way_through(layout, times) / duration;
  }
  return times;
}

/// When each pushed brick is pushed first [s].
std::map<BrickId, double> push_times(const Layout& layout) {
  std::map<BrickId, double> times;
  for (const Push& push : layout.pushes) {
    const auto [there, fresh] = times.try_emplace(push.brick, push.at);
    if (!fresh) there->second = std::min(there->second, push.at);
  }
  return times;
}

/// A ball rolls from one part to the next, so that what it strikes does not start together; nor does what nobody knows a reason for.
bool starts_many(const Layout& layout, const PartTimes& times) {
  return !std::isnan(times.pushed_at) || (times.from != kNoBrick && layout.kind_of(times.from).shape == Shape::box);
}

/// Gives parts that start together one number and puts them one after the other, in the order of each group's first arrival.
void group(const Layout& layout, std::vector<PartTimes>& sheet) {
  std::stable_sort(sheet.begin(), sheet.end(), [](const PartTimes& a, const PartTimes& b) {
    if (a.reached == 0 || b.reached == 0) return a.reached > b.reached;
    return a.first_arrival < b.first_arrival;
  });
  // What parts that start together have in common: the brick that strikes them, or the moment of their pushes.
  std::map<std::pair<BrickId, double>, std::int64_t> known;
  std::int64_t starts = 0;
  auto times = sheet.begin();
  for (; times != sheet.end() && times->reached > 0; ++times) {
    times->start = starts;
    if (starts_many(layout, *times)) {
      const double moment = std::isnan(times->pushed_at) ? 0.0 : times->pushed_at;
      times->start = known.try_emplace({times->from, moment}, starts).first->second;
    }
    if (times->start == starts) ++starts;
  }
  std::stable_sort(sheet.begin(), times, [](const PartTimes& a, const PartTimes& b) { return a.start < b.start; });
}

}  // namespace

std::vector<PartTimes> measure_parts(const Recording& recording) {
  const Layout& layout = recording.layout();
  const Strikes strikes = strikes_of(recording);
  const std::vector<std::uint8_t> fallen = fallen_bricks(recording);
  const std::map<BrickId, double> pushes = push_times(layout);
  std::vector<PartTimes> sheet;
  sheet.reserve(layout.parts.size());
  for (std::size_t i = 0; i < layout.parts.size(); ++i) {
    PartTimes times = times_of(layout, i, strikes, fallen);
    if (times.first != kNoBrick) {
      const BrickId begun = beginning(layout.parts[i], times.first, strikes);
      times.from = std::max(strikes.by[static_cast<std::size_t>(begun)], kNoBrick);
      if (holds(layout.parts[i], times.from)) times.from = kNoBrick;
      if (const auto push = pushes.find(begun); times.from == kNoBrick && push != pushes.end()) times.pushed_at = push->second;
    }
    sheet.push_back(times);
  }
  group(layout, sheet);
  return sheet;
}

}  // namespace topple

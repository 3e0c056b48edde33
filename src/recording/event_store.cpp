#include "recording/event_store.h"

#include <bit>
#include <cmath>
#include <limits>

namespace topple {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint32_t kBrickMask = (1U << 28) - 1;

bool carries(const EventStore::Load& load) {
  return !(std::isnan(load.force) && std::isnan(load.impulse) && std::isnan(load.x) && std::isnan(load.y) && std::isnan(load.z));
}

}  // namespace

void EventStore::add(const Entry& entry) {
  const std::size_t place = events_.size() % 64;
  if (place == 0) groups_.push_back({0, loads_.size()});
  if (carries(entry.load)) {
    groups_.back().loaded |= std::uint64_t{1} << place;
    loads_.push_back(entry.load);
  }
  events_.push_back(
      {entry.time, static_cast<std::uint32_t>(entry.brick) & kBrickMask, static_cast<std::uint32_t>(entry.kind) & 15U, entry.by});
}

EventStore::Entry EventStore::entry(std::size_t index) const {
  const Compact& event = events_[index];
  const Group& group = groups_[index / 64];
  const std::uint64_t bit = std::uint64_t{1} << (index % 64);
  Entry entry{
      event.time, static_cast<EventKind>(event.kind), static_cast<BrickId>(event.brick), event.by, {kNone, kNone, kNone, kNone, kNone}};
  if ((group.loaded & bit) != 0) entry.load = loads_[group.before + static_cast<std::size_t>(std::popcount(group.loaded & (bit - 1)))];
  return entry;
}

}  // namespace topple

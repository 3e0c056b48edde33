#include "model/rigid/wave.h"

#include <algorithm>
#include <limits>

namespace topple::rigid {

Event plain_event(EventKind kind, double time, BrickId brick, BrickId by) {
  constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
  return {.time = time,
          .kind = kind,
          .brick = brick,
          .by = by,
          .force = kNotANumber,
          .impulse = kNotANumber,
          .point = {kNotANumber, kNotANumber, kNotANumber}};
}

bool Wave::disown(BrickId brick) {
  std::int32_t& owner = world_.front[static_cast<std::size_t>(brick)];
  const bool owned = owner == number();
  if (owned) owner = kNoFront;
  return owned;
}

void Wave::tell_arrival(BrickId brick, double time) {
  world_.arrived[static_cast<std::size_t>(brick)] = 1;
  ledger_.events.push_back(plain_event(EventKind::arrived, time, brick, kNoBrick));
}

void Wave::tell_rest(BrickId brick, bool fallen, bool landed, BrickId by, double now) {
  if (fallen && !landed) ledger_.events.push_back(plain_event(EventKind::landed, now, brick, by));
  const BrickId next = next_of_part(world_.layout, brick);
  if (fallen && by == kNoBrick && next != kNoBrick && world_.phase[static_cast<std::size_t>(next)] == Phase::standing && !moves(next)) {
    ledger_.events.push_back(plain_event(EventKind::missed, now, brick, next));
  }
  ledger_.events.push_back(plain_event(EventKind::rested, now, brick, by));
}

void Wave::enter_leavings() {
  for (const BrickId brick : ledger_.left) disown(brick);
  ledger_.left.clear();
}

void Wave::hand_out(std::vector<Echo>& echoes, std::vector<BrickId>& echoed, std::vector<UnseenMotion>& unseen) {
  echoes.insert(echoes.end(), echoes_.begin(), echoes_.end());
  echoed.insert(echoed.end(), echoed_.begin(), echoed_.end());
  unseen.insert(unseen.end(), unseen_.begin(), unseen_.end());
  echoes_.clear();
  echoed_.clear();
  unseen_.clear();
}

// Those that move first: of two fronts that took one brick in one step, that one has it which set it in motion.
void Wave::enter_takings(bool of_those_that_move) {
  if (ledger_.taken.empty()) return;
  std::erase_if(ledger_.taken, [&](BrickId brick) {
    if (of_those_that_move && !moves(brick)) return false;
    std::int32_t& owner = world_.front[static_cast<std::size_t>(brick)];
    if (owner == kNoFront) {
      owner = number();
    } else if (owner != number()) {
      ledger_.meet(owner);
      lose(brick);
    }
    return true;
  });
}

void Wave::enter_all() {
  enter_leavings();
  enter_takings(true);
  enter_takings(false);
  enter_changes();
}

}  // namespace topple::rigid

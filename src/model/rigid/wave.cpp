#include "model/rigid/wave.h"

#include <algorithm>

namespace topple::rigid {

void Wave::meet(std::int32_t other) {
  if (other != number_ && std::find(met_.begin(), met_.end(), other) == met_.end()) met_.push_back(other);
}

void Wave::enter_leavings() {
  for (const BrickId brick : ledger_.left) {
    std::int32_t& owner = world_.front[static_cast<std::size_t>(brick)];
    if (owner == number_) owner = kNoFront;
  }
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
      owner = number_;
    } else if (owner != number_) {
      meet(owner);
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

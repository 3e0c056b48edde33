/// The events of a recording. Most say only who and when, so what few carry (force, impulse, place) is kept apart.
#pragma once

#include "recording/blocks.h"
#include "topple/recording.h"

namespace topple {

class EventStore {
 public:
  /// What an event may carry; a number that it does not have is not a number.
  struct Load {
    float force, impulse, x, y, z;  ///< The place is against the brick's foot.
  };
  struct Entry {
    double time = 0.0;
    EventKind kind = EventKind::pushed;
    BrickId brick = kNoBrick;
    BrickId by = kNoBrick;
    Load load;
  };

  void add(const Entry& entry);
  Entry entry(std::size_t index) const;
  std::size_t size() const { return events_.size(); }
  std::size_t bytes() const { return events_.bytes() + groups_.bytes() + loads_.bytes(); }

 private:
  struct Compact {
    double time;
    std::uint32_t brick : 28;
    std::uint32_t kind : 4;
    BrickId by;
  };
  /// Which of 64 events carry something, and how many did before them.
  struct Group {
    std::uint64_t loaded;
    std::uint64_t before;
  };
  Blocks<Compact> events_;
  Blocks<Group> groups_;
  Blocks<Load> loads_;
};

}  // namespace topple

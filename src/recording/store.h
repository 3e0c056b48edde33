/// What a Recording holds.
#pragma once

#include "recording/event_store.h"
#include "recording/track_store.h"
#include "topple/recording.h"

namespace topple {

struct Recording::Store {
  Store(Layout the_layout, Recipe the_recipe);

  void add_event(const Event& event);
  Event event(std::size_t index) const;

  Layout layout;
  Recipe recipe;
  RunEnd end;
  double tolerance = RecorderConfig{}.tolerance;
  double time = 0.0;  ///< Of the last thing recorded [s].
  TrackStore tracks;
  EventStore events;
  std::vector<EnergySample> energy;
  HashTrail hashes;
};

}  // namespace topple

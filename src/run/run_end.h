/// How a run that came to rest ended, and why.
#pragma once

#include "topple/recording.h"

namespace topple {

/// What the events of the whole run told.
struct WaveStory {
  BrickId missed = kNoBrick;      ///< The last brick that fell flat without reaching the next.
  bool everyone_arrived = false;  ///< Every brick that was pushed or struck has passed 10 degrees.
};

/// At rest, or where the wave died and what that brick did: it fell short, it came back, it slid away.
RunEnd end_at_rest(const Recording& recording, const WaveStory& story);

}  // namespace topple

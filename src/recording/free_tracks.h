/// The open tracks of bricks that move freely.
#pragma once

#include <cstdint>
#include <vector>

#include "recording/free_fit.h"
#include "topple/layout.h"

namespace topple {

class FreeTracks {
 public:
  /// Takes the free bricks of a frame; one that is not falling any more ends its track there, at rest.
  /// `tolerance`: how far a corner may be off, as a fraction of the thickness.
  void take(const Frame& frame, double time_step, const Layout& layout, double tolerance, TrackStore& out);
  void close_all(TrackStore& out);

 private:
  static constexpr std::int32_t kClosed = -1;

  FreeFit& open(BrickId brick, double start, const Layout& layout, double tolerance, const TrackStore& out);
  void close(BrickId brick, bool still, TrackStore& out);

  std::vector<FreeFit> fits_;         ///< Those that are closed leave their buffers to the next.
  std::vector<std::int32_t> unused_;  ///< Places in fits_.
  std::vector<std::int32_t> place_;   ///< Of each brick in fits_, or kClosed; empty until the first free brick moves.
};

}  // namespace topple

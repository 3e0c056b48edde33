/// The open tracks of bricks that move freely: every step is a knot, so that no corner is off by more than single precision.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "recording/track_store.h"
#include "topple/layout.h"

namespace topple {

class FreeTracks {
 public:
  /// Takes the free bricks of a frame; one that is not falling any more ends its track there, at rest.
  void take(const Frame& frame, double time_step, const Layout& layout, TrackStore& out);
  void close_all(TrackStore& out);

 private:
  struct Open {
    BrickId brick = kNoBrick;
    double start = 0.0;  ///< [s]
    std::vector<FreeKnot> knots;
  };

  Open& open_track(const FreeMotion& motion, double start, const Layout& layout, const TrackStore& out);
  void close(std::size_t index, TrackStore& out);

  std::vector<Open> open_;           ///< In no order.
  std::vector<std::int32_t> place_;  ///< Of each brick in open_, -1 if it has no open track.
};

}  // namespace topple

/// The open tracks of bricks that move freely.
#pragma once

#include <cstdint>
#include <vector>

#include "base/crew.h"
#include "recording/free_fit.h"
#include "topple/layout.h"

namespace topple {

class FreeTracks {
 public:
  /// Takes the free bricks of a frame; one that is not falling any more ends its track there, at rest.
  /// `tolerance`: how far a corner may be off, as a fraction of the thickness.
  /// The tracks are shared out among the crew; what is stored, and in which order, does not depend on it.
  void take(const Frame& frame, double time_step, const Layout& layout, double tolerance, TrackStore& out, Crew& crew);
  /// Takes what moved in the steps before a frame without being in their frames.
  void take_unseen(const Frame& frame, const Layout& layout, double tolerance, TrackStore& out);
  void close_all(TrackStore& out);

 private:
  static constexpr std::int32_t kClosed = -1;

  FreeFit& open(BrickId brick, double start, const Layout& layout, double tolerance, const TrackStore& out);
  void fit(const Frame& frame, std::size_t share);
  void close(std::int32_t& place, TrackStore& out);

  std::vector<FreeFit> fits_;         ///< Those that are closed leave their buffers to the next.
  std::vector<std::int32_t> unused_;  ///< Places in fits_.
  std::vector<std::int32_t> place_;   ///< Of each brick in fits_, or kClosed; empty until the first free brick moves.
  /// Of each share of a frame, the places in it of bricks whose track begins, or has something to store.
  std::vector<std::vector<std::size_t>> left_;
};

}  // namespace topple

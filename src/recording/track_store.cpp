#include "recording/track_store.h"

namespace topple {
void TrackStore::link(Piece piece) {
  std::int32_t& last = last_[static_cast<std::size_t>(piece.brick)];
  piece.previous = last;
  last = static_cast<std::int32_t>(pieces_.size());
  pieces_.push_back(piece);
}

void TrackStore::add(BrickId brick, double start, std::span<const HingedKnot> knots) {
  if (knots.empty()) return;
  link({start, hinged_.append(knots), brick, static_cast<std::int32_t>(knots.size()), kNone, knots.back().time});
}

void TrackStore::add(BrickId brick, double start, std::span<const FreeKnot> knots) {
  if (knots.empty()) return;
  link({start, free_.append(knots), brick, -static_cast<std::int32_t>(knots.size()), kNone, knots.back().time});
}

Track TrackStore::track(std::size_t index) const {
  const Piece& piece = pieces_[index];
  Track track{piece.brick, piece.start, {}, {}};
  if (piece.count < 0) {
    track.free = {static_cast<const FreeKnot*>(piece.knots), static_cast<std::size_t>(-piece.count)};
  } else {
    track.hinged = {static_cast<const HingedKnot*>(piece.knots), static_cast<std::size_t>(piece.count)};
  }
  return track;
}

double TrackStore::end_of(std::size_t index) const { return pieces_[index].start + double{pieces_[index].duration}; }

std::size_t TrackStore::bytes() const { return pieces_.bytes() + hinged_.bytes() + free_.bytes() + last_.capacity() * sizeof(last_[0]); }

}  // namespace topple

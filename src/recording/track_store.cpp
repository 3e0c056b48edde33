#include "recording/track_store.h"

#include <algorithm>

#include "recording/knot_code.h"

namespace topple {

void TrackStore::add_piece(const Piece& piece) {
  std::int32_t& last = last_[static_cast<std::size_t>(piece.of())];
  pieces_.push_back({piece.start, piece.code, piece.brick, last});
  last = static_cast<std::int32_t>(pieces_.size()) - 1;
}

void TrackStore::add_echo(BrickId brick, BrickId like, double start, double like_start) {
  echoed_.clear();
  for (std::int32_t piece = last_of(like); piece != kNone && start_of(piece) >= like_start; piece = before(piece)) echoed_.push_back(piece);
  for (std::size_t i = echoed_.size(); i-- > 0;) add_same(brick, start + (start_of(echoed_[i]) - like_start), echoed_[i]);
}

void TrackStore::add_same(BrickId brick, double start, std::int32_t piece) {
  const bool lasts = pieces_[static_cast<std::size_t>(piece)].brick < 0;
  add_piece({start, code_of(piece), lasts ? ~brick : brick, kNone});
}

void TrackStore::add(BrickId brick, double start, std::span<const HingedKnot> knots) {
  if (knots.empty()) return;
  code_.clear();
  encode(knots, code_);
  add_piece({start, codes_.append(code_), brick, kNone});
}

void TrackStore::add(BrickId brick, double start, std::span<const FreeKnot> knots) {
  if (knots.empty()) return;
  code_.clear();
  encode(knots, code_);
  add_free_code(brick, start, code_);
}

void TrackStore::add_free_code(BrickId brick, double start, std::span<const std::uint8_t> code) {
  const bool lasts = models_.contains(brick);
  add_piece({start, (lasts ? codes_ : free_codes_).append(code), lasts ? ~brick : brick, kNone});
}

void TrackStore::let_go(std::size_t pieces) {
  for (; let_go_ < std::min(pieces, pieces_.size()); ++let_go_) {
    if (pieces_[let_go_].brick < 0) continue;
    const auto last = last_free_knot(static_cast<std::int32_t>(let_go_));
    if (!last) continue;
    code_.clear();
    encode(std::span(&*last, 1), code_);
    pieces_[let_go_].code = free_ends_.append(code_);
  }
  std::size_t next = let_go_;
  while (next < pieces_.size() && (pieces_[next].brick < 0 || !last_free_knot(static_cast<std::int32_t>(next)))) ++next;
  free_codes_.drop_before(next < pieces_.size() ? pieces_[next].code : nullptr);
}

std::optional<HingedKnot> TrackStore::last_knot(std::int32_t index) const {
  return last_hinged_knot(pieces_[static_cast<std::size_t>(index)].code);
}

std::optional<FreeKnot> TrackStore::last_free_knot(std::int32_t index) const {
  return topple::last_free_knot(pieces_[static_cast<std::size_t>(index)].code);
}

Track TrackStore::track(std::size_t index) const {
  Track track;
  read(index, track);
  return track;
}

void TrackStore::read(std::size_t index, Track& out) const {
  const Piece& piece = pieces_[index];
  out.brick = piece.of();
  out.start = piece.start;
  out.hinged.clear();
  out.free.clear();
  decode(piece.code, out.hinged, out.free);
}

TrackStore::Count TrackStore::read(std::int32_t index, std::vector<HingedKnot>& hinged, std::vector<FreeKnot>& free) const {
  const Count before{hinged.size(), free.size()};
  decode(pieces_[static_cast<std::size_t>(index)].code, hinged, free);
  return {hinged.size() - before.hinged, free.size() - before.free};
}

std::size_t TrackStore::bytes() const {
  return pieces_.bytes() + codes_.bytes() + free_codes_.bytes() + free_ends_.bytes() + last_.capacity() * sizeof(last_[0]);
}

double end_of(const Track& track) {
  if (!track.hinged.empty()) return track.start + double{track.hinged.back().time};
  return track.free.empty() ? track.start : track.start + double{track.free.back().time};
}

}  // namespace topple

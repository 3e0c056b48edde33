/// The tracks of a recording, piece by piece, and the way from a brick to its pieces.
#pragma once

#include "recording/blocks.h"
#include "topple/recording.h"

namespace topple {

class TrackStore {
 public:
  explicit TrackStore(std::size_t bricks) : last_(bricks, kNone) {}

  void add(BrickId brick, double start, std::span<const HingedKnot> knots);
  void add(BrickId brick, double start, std::span<const FreeKnot> knots);

  std::size_t size() const { return pieces_.size(); }
  Track track(std::size_t index) const;
  double end_of(std::size_t index) const;  ///< Time of its last knot [s].

  /// The last piece of a brick, and the piece of the same brick before this one; kNone if there is none.
  static constexpr std::int32_t kNone = -1;
  std::int32_t last_of(BrickId brick) const { return last_[static_cast<std::size_t>(brick)]; }
  std::int32_t before(std::int32_t piece) const { return pieces_[static_cast<std::size_t>(piece)].previous; }

  std::size_t bytes() const;

 private:
  struct Piece {
    double start;
    const void* knots;
    BrickId brick;
    std::int32_t count;  // Less than 0: so many free knots.
    std::int32_t previous;
    float duration;
  };
  void link(Piece piece);

  Blocks<Piece> pieces_;
  Runs<HingedKnot> hinged_;
  Runs<FreeKnot> free_;
  std::vector<std::int32_t> last_;
};

}  // namespace topple

/// The tracks of a recording, piece by piece, and the way from a brick to its pieces.
#pragma once

#include <optional>
#include <unordered_set>

#include "recording/blocks.h"
#include "topple/recording.h"

namespace topple {

class TrackStore {
 public:
  explicit TrackStore(std::size_t bricks) : last_(bricks, kNone) {}

  void add(BrickId brick, double start, std::span<const HingedKnot> knots);
  void add(BrickId brick, double start, std::span<const FreeKnot> knots);
  /// The brick moves as `like` did from `like_start` on, and begins at `start`: the same codes are kept for both.
  void add_echo(BrickId brick, BrickId like, double start, double like_start);
  void will_be_echoed(BrickId brick) { models_.insert(brick); }    ///< To be said before its pieces come.
  void add_same(BrickId brick, double start, std::int32_t piece);  ///< With the knots of another piece, kept once.

  void add_free_code(BrickId brick, double start, std::span<const std::uint8_t> code);  ///< Of encode().
  /// Keeps of the free ones among the first `pieces` their last knots alone: from then on each is a track of one knot.
  void let_go(std::size_t pieces);

  std::size_t size() const { return pieces_.size(); }
  Track track(std::size_t index) const;
  void read(std::size_t index, Track& out) const;  ///< The same into buffers that are there already.
  /// Appends its knots to one of the two, and says how many.
  struct Count {
    std::size_t hinged = 0;
    std::size_t free = 0;
  };
  Count read(std::int32_t index, std::vector<HingedKnot>& hinged, std::vector<FreeKnot>& free) const;
  std::optional<HingedKnot> last_knot(std::int32_t index) const;     ///< Of a hinged piece.
  std::optional<FreeKnot> last_free_knot(std::int32_t index) const;  ///< Of a free piece.
  BrickId brick_of(std::int32_t index) const { return pieces_[static_cast<std::size_t>(index)].of(); }
  /// The same for pieces that share their knots.
  const std::uint8_t* code_of(std::int32_t index) const { return pieces_[static_cast<std::size_t>(index)].code; }
  /// Whether its knots are those of a free piece that others echo, or may.
  bool is_echoed(std::int32_t index) const { return pieces_[static_cast<std::size_t>(index)].brick < 0; }
  double start_of(std::int32_t index) const { return pieces_[static_cast<std::size_t>(index)].start; }

  /// The last piece of a brick, and the piece of the same brick before this one; kNone if there is none.
  static constexpr std::int32_t kNone = -1;
  std::int32_t last_of(BrickId brick) const { return last_[static_cast<std::size_t>(brick)]; }
  std::int32_t before(std::int32_t piece) const { return pieces_[static_cast<std::size_t>(piece)].previous; }

  std::size_t bytes() const;

 private:
  struct Piece {
    double start;
    const std::uint8_t* code;
    BrickId brick;  // ~brick where others echo the code, which is never let go.
    std::int32_t previous;

    BrickId of() const { return brick < 0 ? ~brick : brick; }
  };
  void add_piece(const Piece& piece);

  Blocks<Piece> pieces_;
  Runs<std::uint8_t> codes_;       // Of hinged pieces, and of free ones that others echo.
  Runs<std::uint8_t> free_codes_;  // Of free ones, in the order of the pieces,
  Runs<std::uint8_t> free_ends_;   // and of those that were let go.
  std::size_t let_go_ = 0;         // So many pieces have been looked at.
  std::vector<std::int32_t> last_;
  std::vector<std::uint8_t> code_;      // Of the piece that is being added.
  std::vector<std::int32_t> echoed_;    // Scratch.
  std::unordered_set<BrickId> models_;  // Bricks that others echo.
};

/// The moment of a track's last knot [s].
double end_of(const Track& track);

}  // namespace topple

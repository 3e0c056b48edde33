/// Reads the pieces of docs/format.md into a Recording; nothing in them is believed before it is checked.
#pragma once

#include <optional>

#include "recording/source.h"
#include "recording/store.h"

namespace topple {

class RecordingReader {
 public:
  RecordingReader(std::span<const std::uint8_t> bytes, std::string_view name) : bytes_(bytes), name_(name) {}

  Result<Recording> read();

 private:
  struct Piece {
    std::string_view type;
    std::span<const std::uint8_t> payload;
    std::size_t offset = 0;  ///< Of its header in the file.
    format::Source source() const { return {payload, offset + format::kHeader}; }
  };
  using Done = Result<void>;

  Done read_pieces();
  Result<std::optional<Piece>> next_piece();
  bool is_cut(std::size_t offset) const;
  bool is_whole_piece(std::size_t offset) const;
  Done take(const Piece& piece);
  Done take_recipe(const Piece& piece);
  Done take_scene(const Piece& piece);
  Done take_bricks(const Piece& piece);
  Done take_hinged(const Piece& piece);
  Done take_free(const Piece& piece);
  Done take_events(const Piece& piece);
  Done take_energy(const Piece& piece);
  Done take_hashes(const Piece& piece);
  Done take_end(const Piece& piece);
  Done build_layout();
  Done check_bricks(const Piece& piece) const;
  Done check_start(BrickId brick, double start, double last_time, std::size_t offset);
  template <typename Tracks>
  Done check_head(const Tracks& tracks, std::size_t track, std::size_t offset) const;

  std::unexpected<Error> wrong(std::size_t offset, std::string_view what) const;
  std::unexpected<Error> misfit(const Piece& piece) const;

  std::span<const std::uint8_t> bytes_;
  std::string name_;
  std::size_t at_ = 0;

  std::optional<Layout> from_recipe_;
  Recipe recipe_;
  bool has_scene_ = false;
  double tolerance_ = 0.0;
  double gravity_ = 0.0;
  std::uint32_t kind_count_ = 0;
  std::vector<Piece> brick_pieces_;
  std::size_t brick_count_ = 0;
  std::optional<Recording> recording_;
  bool ended_ = false;
};

}  // namespace topple

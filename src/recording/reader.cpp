#include "recording/reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "recording/crc32.h"

namespace topple {
namespace {

using format::Source;

constexpr std::array kKnown = {format::kRecipe, format::kScene,  format::kBricks, format::kHinged, format::kFree,
                               format::kEvents, format::kEnergy, format::kHashes, format::kEnd};

bool known(std::string_view type) { return std::find(kKnown.begin(), kKnown.end(), type) != kKnown.end(); }

// A type that a later version may have added.
bool may_be_type(std::string_view type) {
  return std::all_of(type.begin(), type.end(), [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; });
}

std::string_view chars(std::span<const std::uint8_t> bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

std::string shown(std::string_view raw) {
  std::string text;
  for (const char c : raw) text += c >= ' ' && c <= '~' ? c : '?';
  return text;
}

}  // namespace

std::unexpected<Error> RecordingReader::wrong(std::size_t offset, std::string_view what) const {
  return failure(name_ + ": byte " + std::to_string(offset) + ": " + std::string(what));
}

std::unexpected<Error> RecordingReader::misfit(const Piece& piece) const {
  return wrong(piece.offset, "the counts in piece " + shown(piece.type) + " do not fit its length of " +
                                 std::to_string(piece.payload.size()) + " bytes; the file is damaged");
}

Result<Recording> RecordingReader::read() {
  if (bytes_.size() < format::kMagic.size()) {
    return failure(name_ + ": not a recording of Topple: it has " + std::to_string(bytes_.size()) +
                   " bytes, a recording begins with the 8 bytes " + std::string(format::kMagic));
  }
  const std::string_view magic = chars(bytes_.first(format::kMagic.size()));
  if (magic != format::kMagic) {
    if (magic.starts_with("TOPPLE")) {
      return wrong(6, "a recording of version \"" + shown(magic.substr(6)) + "\"; this program reads version 01");
    }
    return wrong(
        0, "not a recording of Topple: it begins with \"" + shown(magic) + "\", a recording with \"" + std::string(format::kMagic) + "\"");
  }
  at_ = format::kMagic.size();
  if (auto done = read_pieces(); !done) return std::unexpected(done.error());
  if (!recording_) {
    if (!from_recipe_ || !has_scene_) return wrong(bytes_.size(), "the file is cut off before its recipe and scene are whole");
    if (auto done = build_layout(); !done) return std::unexpected(done.error());
  }
  if (!ended_)
    recording_->store_->end = {EndReason::running, kNoBrick, 0, recording_->store_->time, 0, "the file was cut off before the run's end"};
  return std::move(*recording_);
}

RecordingReader::Done RecordingReader::read_pieces() {
  while (true) {
    auto piece = next_piece();
    if (!piece) return std::unexpected(piece.error());
    if (!*piece) return {};
    if (ended_) return wrong((*piece)->offset, "something follows the end of the recording");
    if (auto done = take(**piece); !done) return done;
  }
}

// The next whole piece; none at the end, or where the file was cut.
Result<std::optional<RecordingReader::Piece>> RecordingReader::next_piece() {
  const std::size_t left = bytes_.size() - at_;
  if (left < format::kHeader) return std::nullopt;
  Source header(bytes_.subspan(at_, format::kHeader), at_);
  const std::string_view type = chars(bytes_.subspan(at_, 4));
  header.get<std::uint32_t>();
  const auto check = header.get<std::uint32_t>();
  const auto length = header.get<std::uint64_t>();
  if (!may_be_type(type))
    return wrong(at_, "a piece should begin here, but \"" + shown(type) + "\" is no type of piece; the file is damaged");
  if (length > left - format::kHeader) {
    if (is_cut(at_)) return std::nullopt;
    return wrong(at_ + 8, "piece " + shown(type) + " claims " + std::to_string(length) +
                              " bytes, but others begin before their end; the file is damaged");
  }
  const Piece piece{type, bytes_.subspan(at_ + format::kHeader, static_cast<std::size_t>(length)), at_};
  const std::uint32_t found = crc32(piece.payload);
  if (found != check) return wrong(at_, "the check of piece " + shown(type) + " does not agree with its bytes; the file is damaged");
  at_ = std::min(bytes_.size(), at_ + format::kHeader + format::round_up(piece.payload.size()));
  return piece;
}

// Whether a piece that goes beyond the file's end was cut off there, rather than its length damaged: then no other follows.
bool RecordingReader::is_cut(std::size_t offset) const {
  for (std::size_t at = offset + format::kHeader; at + format::kHeader <= bytes_.size(); at += 8) {
    if (is_whole_piece(at)) return false;
  }
  return true;
}

bool RecordingReader::is_whole_piece(std::size_t offset) const {
  if (!known(chars(bytes_.subspan(offset, 4)))) return false;
  Source header(bytes_.subspan(offset + 4, format::kHeader - 4), offset + 4);
  const auto check = header.get<std::uint32_t>();
  const auto length = header.get<std::uint64_t>();
  const auto rest = bytes_.subspan(offset + format::kHeader);
  return length <= rest.size() && crc32(rest.first(static_cast<std::size_t>(length))) == check;
}

RecordingReader::Done RecordingReader::take(const Piece& piece) {
  if (!known(piece.type)) return {};
  if (piece.type == format::kRecipe) return take_recipe(piece);
  if (!from_recipe_) return wrong(piece.offset, "piece " + shown(piece.type) + " comes before the recipe");
  if (piece.type == format::kScene) return take_scene(piece);
  if (!has_scene_) return wrong(piece.offset, "piece " + shown(piece.type) + " comes before the scene");
  if (piece.type == format::kBricks) return take_bricks(piece);
  if (!recording_) {
    if (auto done = build_layout(); !done) return done;
    if (brick_count_ != recording_->store_->layout.bricks.size()) {
      return wrong(piece.offset, "the recipe makes " + std::to_string(recording_->store_->layout.bricks.size()) + " bricks, the file has " +
                                     std::to_string(brick_count_));
    }
  }
  if (piece.type == format::kHinged) return take_hinged(piece);
  if (piece.type == format::kFree) return take_free(piece);
  if (piece.type == format::kEvents) return take_events(piece);
  if (piece.type == format::kEnergy) return take_energy(piece);
  if (piece.type == format::kHashes) return take_hashes(piece);
  return take_end(piece);
}

RecordingReader::Done RecordingReader::take_recipe(const Piece& piece) {
  if (from_recipe_) return wrong(piece.offset, "a second recipe");
  Source source = piece.source();
  Layout layout;
  recipe_.version = source.text();
  recipe_.model = source.text();
  layout.name = source.text();
  layout.text = source.text();
  recipe_.time_step = source.get<double>();
  const auto overrides = source.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < overrides && source.ok(); ++i) layout.overrides.push_back(source.text());
  if (!source.ok() || !source.at_end()) return misfit(piece);
  if (!(recipe_.time_step > 0.0 && recipe_.time_step < 1e6)) {
    return wrong(piece.offset, "a time step must be more than 0 and finite, it is " + std::to_string(recipe_.time_step) + " s");
  }
  from_recipe_ = std::move(layout);
  return {};
}

RecordingReader::Done RecordingReader::take_scene(const Piece& piece) {
  if (has_scene_) return wrong(piece.offset, "a second scene");
  Source source = piece.source();
  source.text();
  gravity_ = source.get<double>();
  tolerance_ = source.get<double>();
  kind_count_ = source.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < kind_count_ && source.ok(); ++i) {
    source.text();
    for (int k = 0; k < 8; ++k) source.get<double>();
    for (int k = 0; k < 3; ++k) source.get<std::uint8_t>();
  }
  const auto colors = source.get<std::uint32_t>();
  for (std::uint64_t i = 0; i < std::uint64_t{colors} * 3 && source.ok(); ++i) source.get<std::uint8_t>();
  const auto parts = source.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < parts && source.ok(); ++i) {
    source.text();
    source.get<std::uint64_t>();
  }
  const auto pushes = source.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < pushes && source.ok(); ++i) {
    source.get<std::uint32_t>();
    source.get<double>();
    source.get<std::uint8_t>();
    for (int k = 0; k < 3; ++k) source.get<double>();
  }
  if (!source.ok() || !source.at_end()) return misfit(piece);
  if (!(tolerance_ > 0.0 && tolerance_ < 1.0))
    return wrong(piece.offset, "the tolerance must be between 0 and 1, it is " + std::to_string(tolerance_));
  has_scene_ = true;
  return {};
}

RecordingReader::Done RecordingReader::take_bricks(const Piece& piece) {
  if (recording_) return wrong(piece.offset, "bricks after the first track");
  Source source = piece.source();
  const auto first = source.get<std::uint32_t>();
  const std::size_t count = source.get<std::uint32_t>();
  for (int i = 0; i < 4; ++i) source.column<double>(count);
  source.column<std::uint16_t>(count);
  source.column<std::uint16_t>(count);
  source.column<std::uint8_t>(count);
  if (!source.ok() || !source.at_end()) return misfit(piece);
  if (first != brick_count_) {
    return wrong(piece.offset, "bricks from " + std::to_string(first) + " on, after " + std::to_string(brick_count_) + " bricks");
  }
  brick_count_ += count;
  brick_pieces_.push_back(piece);
  return {};
}

RecordingReader::Done RecordingReader::build_layout() {
  Result<Layout> layout = read_layout(from_recipe_->text, from_recipe_->name, from_recipe_->overrides);
  if (!layout) return wrong(format::kMagic.size(), "the recipe cannot be read again: " + layout.error().message);
  if (layout->gravity != gravity_ || layout->kinds.size() != kind_count_) {
    return wrong(format::kMagic.size(), "the scene is not the one that the recipe makes");
  }
  recording_.emplace(std::move(*layout), recipe_);
  from_recipe_->text.clear();
  recording_->store_->tolerance = tolerance_;
  for (const Piece& piece : brick_pieces_) {
    if (auto done = check_bricks(piece); !done) return done;
  }
  return {};
}

RecordingReader::Done RecordingReader::check_bricks(const Piece& piece) const {
  const std::vector<Brick>& bricks = recording_->store_->layout.bricks;
  Source source = piece.source();
  const std::size_t first = source.get<std::uint32_t>();
  const std::size_t count = source.get<std::uint32_t>();
  if (first + count > bricks.size()) {
    return wrong(piece.offset,
                 "the recipe makes " + std::to_string(bricks.size()) + " bricks, the file has at least " + std::to_string(first + count));
  }
  const auto x = source.column<double>(count), y = source.column<double>(count), z = source.column<double>(count);
  const auto heading = source.column<double>(count);
  const auto kind = source.column<std::uint16_t>(count), color = source.column<std::uint16_t>(count);
  const auto stance = source.column<std::uint8_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Brick& brick = bricks[first + i];
    const bool same = brick.foot == Vec3{x[i], y[i], z[i]} && brick.heading == heading[i] && brick.kind == kind[i] &&
                      brick.color == color[i] && static_cast<std::uint8_t>(brick.stance) == stance[i];
    if (!same) return wrong(piece.offset, "brick " + std::to_string(first + i) + " is not where the recipe puts it");
  }
  return {};
}

Result<Recording> read_recording(std::span<const std::uint8_t> bytes, std::string_view name) { return RecordingReader(bytes, name).read(); }

}  // namespace topple

/// What the writer and the reader of docs/format.md share.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace topple::format {

static_assert(std::endian::native == std::endian::little, "the recording's file is written and read in place");

inline constexpr std::string_view kMagic = "TOPPLE01";
inline constexpr std::size_t kHeader = 16;  ///< Type, check and length of a piece.
inline constexpr std::uint32_t kNoBrickCode = 0xFFFFFFFFU;
inline constexpr std::size_t kBricksInPiece = 65536;
/// Instead of a number of knots: this + i says that the knots are those of track i of the same piece.
inline constexpr std::uint32_t kKnotsOfTrack = 0x80000000U;

inline constexpr std::string_view kRecipe = "RCPE", kScene = "SCEN", kShapes = "SHAP", kBricks = "BRIK", kHinged = "HING", kFree = "FREE",
                                  kEvents = "EVNT", kEnergy = "ENRG", kHashes = "HASH", kEnd = "END_";

constexpr std::size_t round_up(std::size_t size) { return (size + 7) / 8 * 8; }

/// Builds pieces one after the other.
class Sink {
 public:
  explicit Sink(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  template <typename T>
  void put(T value) {
    static_assert(std::is_arithmetic_v<T>);
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  /// Room for so many bytes at the end; valid until the next call.
  std::uint8_t* room(std::size_t size) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + size);
    return bytes_.data() + at;
  }
  void text(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
  }
  /// Every array of a payload begins at a multiple of 8.
  void align() { bytes_.resize(payload_ + round_up(bytes_.size() - payload_)); }

  void begin(std::string_view type);
  void end();

 private:
  std::vector<std::uint8_t>& bytes_;
  std::size_t payload_ = 0;
};

}  // namespace topple::format

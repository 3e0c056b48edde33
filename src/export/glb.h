/// The container of a binary glTF 2.0 file (.glb): lists of JSON objects, and the numbers that they point into.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "topple/base.h"

namespace topple {

/// Numbers with a point are single, as those in the buffer are: a bound then has the bits of what it bounds.
using GltfJson = nlohmann::basic_json<std::map, std::vector, std::string, bool, std::int64_t, std::uint64_t, float>;

/// A JSON list kept as text: of a million bricks a tree of objects would take gigabytes.
class GltfList {
 public:
  int add(const GltfJson& item);  ///< Its place in the list.
  int size() const { return size_; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  int size_ = 0;
};

class Glb {
 public:
  static constexpr std::uint64_t kMost = 0xFFFFFFFF;  ///< Lengths in the file are 32 bits wide [bytes].
  explicit Glb(std::uint64_t most = kMost) : most_(most) {}

  /// What accessors point into, a bufferView each.
  enum class View : std::uint8_t { corners, vertices, motion };

  // What the file lists, to be filled in any order.
  GltfList nodes, meshes, materials, channels, samplers;

  // Each adds an accessor and gives its index.
  int add_corners(std::span<const std::uint16_t> corners);                         ///< Of triangles.
  int add_vertices(std::span<const float> numbers, bool bounds);                   ///< Three numbers each.
  int add_times(std::span<const float> times);                                     ///< In their order.
  int add_keys(const char* type, int components, std::span<const float> numbers);  ///< The same accessor for the same numbers.

  bool is_full() const;  ///< More would be in vain.

  struct Frame {
    std::string animation;  ///< Its name.
    int root = 0;           ///< The node that all others are below.
    GltfJson extras;
  };
  /// More than fits is an error.
  Result<void> write(const Frame& frame, const std::filesystem::path& path) const;

 private:
  static constexpr std::size_t kViews = 3;

  int add_accessor(View view, std::span<const std::uint8_t> bytes, GltfJson accessor);
  std::vector<std::uint8_t>& bytes_of(View view) { return views_[static_cast<std::size_t>(view)]; }
  std::uint64_t buffer_size() const;
  std::string json(const Frame& frame) const;

  struct Known {
    std::size_t begin;  // In its view [bytes].
    std::size_t size;   // [bytes]
    int accessor;
  };
  std::uint64_t most_;
  std::array<std::vector<std::uint8_t>, kViews> views_;
  GltfList accessors_;
  std::unordered_multimap<std::uint64_t, Known> known_;  // By the hash of their bytes.
};

}  // namespace topple

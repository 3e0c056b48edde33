/// One table of a layout file while it is read: values are taken by key, and whatever is wrong with them goes to the problems.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "layout/problems.h"
#include "topple/layout.h"

namespace topple {

/// The numbers that a key may have.
struct Range {
  double low = 0.0;
  double high = 0.0;
  bool above_low = false;  ///< `low` itself is not allowed.
};

/// "a number from 0.1 to 20000".
std::string range_text(const Range& range);

/// The value for a message: -5, "text", "a list of 3".
std::string value_text(const Node& node);

/// "#rrggbb" with hexadecimal digits; empty for anything else.
std::optional<Color> color_of(std::string_view text);

class Section {
 public:
  static constexpr std::size_t kWhole = static_cast<std::size_t>(-1);

  /// `node` must be a table. Keys that are not among `known` are problems at once.
  Section(const Node& node, std::string path, std::span<const std::string_view> known, Problems& problems);

  const Node* find(std::string_view key) const;
  bool has(std::string_view key) const { return find(key) != nullptr; }
  const std::string& path() const { return path_; }
  const Place& place() const { return place_; }
  std::string path_of(std::string_view key) const;
  Place place_of(std::string_view key) const;  ///< Of the value of a key; of the table where there is none.

  // Each is empty where the key is missing or its value is a problem.
  std::optional<double> number(std::string_view key, const Range& range);
  std::optional<std::int64_t> whole(std::string_view key, std::int64_t low, std::int64_t high);
  std::optional<std::string> text(std::string_view key, std::size_t most);
  /// One of a few words; its place among them.
  std::optional<std::size_t> word(std::string_view key, std::span<const std::string_view> words);
  std::optional<Color> color(std::string_view key);
  std::optional<Vec3> point(std::string_view key, std::size_t most_numbers);
  std::optional<Stance> stance(std::string_view key);
  std::optional<std::vector<Vec3>> points(std::string_view key);
  /// The entries of a list of at most so many; empty where the key is missing, too.
  std::span<const Node> list(std::string_view key, std::size_t most, std::string_view what);
  /// A problem of one entry of a list; where the entry is text, of its letter at this place.
  void problem_at(std::string_view key, std::size_t entry, std::string_view what, std::size_t letter = kWhole);
  /// A problem of one member of a table.
  void problem_in(std::string_view key, const KeyedNode& member, std::string_view what);

  void problem(std::string_view key, std::string_view what);
  void missing(std::string_view what);  ///< A problem of the table as a whole.
  bool good() const { return good_; }   ///< No value has been a problem so far (unknown keys aside).

 private:
  std::optional<Vec3> point_of(const Node& node, const std::string& path, std::size_t most_numbers);
  void fault(const Place& place, std::string_view path, std::string_view what);

  const Table* table_ = nullptr;
  Place place_;
  std::string path_;
  Problems* problems_;
  bool good_ = true;
};

}  // namespace topple

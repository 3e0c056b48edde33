/// A TOML document as a plain tree that remembers where each value stands. What reads it knows nothing of the TOML library.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "topple/base.h"

namespace topple {

/// Where a value was written. A value that an override replaced keeps the line of the old one, which orders the parts.
struct Place {
  std::uint32_t line = 0;  ///< From 1; 0: nowhere in the file.
  std::uint32_t column = 0;
  std::int32_t override_index = -1;  ///< Which of the overrides it came from; -1: the file.
};

struct Node;
struct KeyedNode;
using Array = std::vector<Node>;
using Table = std::vector<KeyedNode>;
/// A value of a type that no key has: a date or a time.
struct Moment {};

struct Node {
  std::variant<bool, std::int64_t, double, std::string, Array, Table, Moment> value;
  Place place;
};

struct KeyedNode {
  std::string key;
  Place place;  ///< Of the key.
  Node node;
};

Node* find_member(Table& table, std::string_view key);
const Node* find_member(const Table& table, std::string_view key);

/// The whole document as a table. On failure one line: where it stops being TOML, and why.
Result<Node> parse_document(std::string_view text, std::string_view name);

/// One TOML value: what stands right of the "=" of an override. Text that is no TOML value is taken as it is.
Node parse_value(std::string_view text, const Place& place);

}  // namespace topple

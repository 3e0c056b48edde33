/// Text from people: whether it can be read at all, and how it is shown in messages.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace topple {

struct Color;

/// Text for a message: control characters escaped, cut after `limit` characters.
std::string printable(std::string_view text, std::size_t limit = 60);

/// A number as it was written: the shortest digits that give the same bits.
std::string number_text(double number);

/// 10000000 as "10,000,000".
std::string count_text(long long count);

/// "#rrggbb".
std::string color_text(const Color& color);

/// What stops text from being handed to the TOML reader, with its place.
struct Unreadable {
  std::size_t line = 1;
  std::size_t column = 1;
  std::string why;
};
/// Bad UTF-8; more bytes or values than a layout may have; brackets or dotted keys nested too deep.
std::optional<Unreadable> unreadable(std::string_view text);

/// The word of `known` that takes the fewest changed, missing, added or swapped letters; empty where there is none.
std::string_view nearest_key(std::string_view word, std::span<const std::string_view> known);

}  // namespace topple

#include "layout/section.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "layout/text.h"

namespace topple {
namespace {

// A line of 24 km is sane, a tower of 100 m too.
constexpr Range kGround{-1e8, 1e8};  // [mm]
constexpr Range kAbove{0.0, 1e5};    // [mm]

std::optional<double> number_of(const Node& node) {
  if (const auto* number = std::get_if<double>(&node.value)) return *number;
  if (const auto* whole = std::get_if<std::int64_t>(&node.value)) return static_cast<double>(*whole);
  return std::nullopt;
}

bool inside(double number, const Range& range) {
  return (range.above_low ? number > range.low : number >= range.low) && number <= range.high;
}

std::string must_be(std::string_view what, const Node& node) { return "must be " + std::string(what) + ", is " + value_text(node); }

int hexadecimal_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

std::optional<Color> color_of(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  std::uint8_t bytes[3] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const int high = hexadecimal_digit(text[1 + 2 * i]), low = hexadecimal_digit(text[2 + 2 * i]);
    if (high < 0 || low < 0) return std::nullopt;
    bytes[i] = static_cast<std::uint8_t>(high * 16 + low);
  }
  return Color{bytes[0], bytes[1], bytes[2]};
}

std::string range_text(const Range& range) {
  // Allowed numbers that a person can read: 100,000,000.
  const auto limit = [](double number) {
    return number == std::floor(number) ? count_text(static_cast<long long>(number)) : number_text(number);
  };
  return "a number " + (range.above_low ? "above " + limit(range.low) + " and up to " : "from " + limit(range.low) + " to ") +
         limit(range.high);
}

std::string value_text(const Node& node) {
  if (const auto* truth = std::get_if<bool>(&node.value)) return *truth ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&node.value)) return std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&node.value)) return number_text(*number);
  if (const auto* text = std::get_if<std::string>(&node.value)) return "\"" + printable(*text) + "\"";
  if (const auto* array = std::get_if<Array>(&node.value)) return "a list of " + std::to_string(array->size());
  if (std::holds_alternative<Table>(node.value)) return "a table";
  return "a date or time";
}

Section::Section(const Node& node, std::string path, std::span<const std::string_view> known, Problems& problems)
    : table_(std::get_if<Table>(&node.value)), place_(node.place), path_(std::move(path)), problems_(&problems) {
  for (const KeyedNode& member : *table_) {
    if (std::find(known.begin(), known.end(), member.key) != known.end()) continue;
    problems.add(member.place, path_of(member.key), "unknown key; the nearest known one is " + std::string(nearest_key(member.key, known)));
  }
}

const Node* Section::find(std::string_view key) const { return find_member(*table_, key); }

std::string Section::path_of(std::string_view key) const { return path_.empty() ? std::string(key) : path_ + "." + std::string(key); }

Place Section::place_of(std::string_view key) const {
  const Node* node = find(key);
  return node ? node->place : place_;
}

void Section::fault(const Place& place, std::string_view path, std::string_view what) {
  good_ = false;
  problems_->add(place, path, what);
}

void Section::problem(std::string_view key, std::string_view what) { fault(place_of(key), path_of(key), what); }

void Section::missing(std::string_view what) { fault(place_, path_, what); }

std::optional<double> Section::number(std::string_view key, const Range& range) {
  const Node* node = find(key);
  if (!node) return std::nullopt;
  const std::optional<double> number = number_of(*node);
  if (number && inside(*number, range)) return number;
  problem(key, must_be(range_text(range), *node));
  return std::nullopt;
}

std::optional<std::int64_t> Section::whole(std::string_view key, std::int64_t low, std::int64_t high) {
  const Node* node = find(key);
  if (!node) return std::nullopt;
  if (const auto* whole = std::get_if<std::int64_t>(&node->value); whole && *whole >= low && *whole <= high) return *whole;
  // 1e6 is a whole number to a person.
  constexpr double kExact = 9007199254740992.0;  // 2^53
  if (const auto* number = std::get_if<double>(&node->value); number && std::abs(*number) <= kExact && *number == std::floor(*number)) {
    const auto whole = static_cast<std::int64_t>(*number);
    if (whole >= low && whole <= high) return whole;
  }
  problem(key, must_be("a whole number from " + count_text(low) + " to " + count_text(high), *node));
  return std::nullopt;
}

std::optional<std::string> Section::text(std::string_view key, std::size_t most) {
  const Node* node = find(key);
  if (!node) return std::nullopt;
  const auto* text = std::get_if<std::string>(&node->value);
  if (text && text->size() <= most) return *text;
  problem(key, text ? "must have at most " + std::to_string(most) + " bytes, has " + std::to_string(text->size()) : must_be("text", *node));
  return std::nullopt;
}

std::optional<Color> Section::color(std::string_view key) {
  const Node* node = find(key);
  if (!node) return std::nullopt;
  const auto* text = std::get_if<std::string>(&node->value);
  if (const auto color = text ? color_of(*text) : std::nullopt) return color;
  problem(key, must_be("a colour written \"#rrggbb\" with hexadecimal digits", *node));
  return std::nullopt;
}

std::optional<std::size_t> Section::word(std::string_view key, std::span<const std::string_view> words) {
  const Node* node = find(key);
  if (!node) return std::nullopt;
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (const auto* text = std::get_if<std::string>(&node->value); text && *text == words[i]) return i;
    list += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + ('"' + std::string(words[i]) + '"');
  }
  problem(key, must_be(list, *node));
  return std::nullopt;
}

std::optional<Stance> Section::stance(std::string_view key) {
  constexpr std::array<std::string_view, 3> kStances{"standing", "flat", "on_side"};
  const auto which = word(key, kStances);
  return which ? std::optional(static_cast<Stance>(*which)) : std::nullopt;
}

std::optional<Vec3> Section::point_of(const Node& node, const std::string& path, std::size_t most_numbers) {
  const auto* array = std::get_if<Array>(&node.value);
  const std::string what = most_numbers == 2 ? "two numbers [x, y]" : "two or three numbers [x, y] or [x, y, z]";
  if (!array || array->size() < 2 || array->size() > most_numbers) {
    fault(node.place, path, must_be(what, node));
    return std::nullopt;
  }
  double mm[3] = {0.0, 0.0, 0.0};
  bool good = true;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const Node& entry = (*array)[i];
    const Range& range = i == 2 ? kAbove : kGround;
    const std::optional<double> number = number_of(entry);
    if (number && inside(*number, range)) {
      mm[i] = *number;
    } else {
      fault(entry.place, path + "." + std::to_string(i), must_be(range_text(range), entry));
      good = false;
    }
  }
  if (!good) return std::nullopt;
  return Vec3{mm[0] / 1000.0, mm[1] / 1000.0, mm[2] / 1000.0};
}

std::optional<Vec3> Section::point(std::string_view key, std::size_t most_numbers) {
  const Node* node = find(key);
  if (!node) return std::nullopt;
  return point_of(*node, path_of(key), most_numbers);
}

std::optional<std::vector<Vec3>> Section::points(std::string_view key) {
  const Node* node = find(key);
  if (!node) return std::nullopt;
  const auto* array = std::get_if<Array>(&node->value);
  if (!array || array->size() < 2) {
    problem(key, must_be("a list of at least two points [x, y]", *node));
    return std::nullopt;
  }
  std::vector<Vec3> points;
  points.reserve(array->size());
  for (std::size_t i = 0; i < array->size(); ++i) {
    if (const auto point = point_of((*array)[i], path_of(key) + "." + std::to_string(i), 2)) points.push_back(*point);
  }
  if (points.size() != array->size()) return std::nullopt;
  return points;
}

std::span<const Node> Section::list(std::string_view key, std::size_t most, std::string_view what) {
  const Node* node = find(key);
  if (!node) return {};
  const auto* array = std::get_if<Array>(&node->value);
  if (array && array->size() <= most) return *array;
  problem(key, must_be("a list of at most " + count_text(static_cast<long long>(most)) + " " + std::string(what), *node));
  return {};
}

void Section::problem_at(std::string_view key, std::size_t entry, std::string_view what, std::size_t letter) {
  const Node* node = find(key);
  const auto* array = node ? std::get_if<Array>(&node->value) : nullptr;
  Place place = array && entry < array->size() ? (*array)[entry].place : place_of(key);
  if (letter != kWhole) place.column += 1 + static_cast<std::uint32_t>(letter);  // after the quote
  fault(place, path_of(key) + "." + std::to_string(entry), what);
}

void Section::problem_in(std::string_view key, const KeyedNode& member, std::string_view what) {
  fault(member.place, path_of(key) + "." + printable(member.key), what);
}

}  // namespace topple

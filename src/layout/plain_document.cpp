#include "layout/plain_document.h"

#include <algorithm>
#include <array>

namespace topple {
namespace {

constexpr std::size_t kMostKeys = 64;  // Of a table: each is looked for among all.
constexpr int kMostDepth = 32;
constexpr std::size_t kMostDigits = 15;  // Any number of so many has its double.

enum Class : std::uint8_t { kNone = 0, kKey = 1, kDigit = 2, kPrinted = 4 };

constexpr std::array<std::uint8_t, 256> kClasses = [] {
  std::array<std::uint8_t, 256> classes{};
  for (std::size_t c = 0x20; c < 0x7F; ++c) classes[c] = kPrinted;
  classes['\t'] = kPrinted;
  for (std::size_t c = '0'; c <= '9'; ++c) classes[c] |= kKey | kDigit;
  for (std::size_t c = 'a'; c <= 'z'; ++c) classes[c] |= kKey;
  for (std::size_t c = 'A'; c <= 'Z'; ++c) classes[c] |= kKey;
  classes['_'] |= kKey;
  classes['-'] |= kKey;
  return classes;
}();

constexpr std::array<double, kMostDigits + 1> kPowers{1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

/// Reads line after line. Whatever is not plain makes it false at once.
class PlainReader {
 public:
  explicit PlainReader(std::string_view text) : next_(text.data()), end_(next_ + text.size()), line_begin_(next_) {}

  bool read(Table& root) {
    Table* table = &root;
    while (next_ != end_) {
      skip_space();
      if (at('[')) {
        table = header(root);
        if (table == nullptr || !end_of_line()) return false;
      } else if (at_class(kKey)) {
        if (!member(*table) || !end_of_line()) return false;
      } else if (!end_of_line()) {
        return false;
      }
    }
    return true;
  }

 private:
  bool at(char c) const { return next_ != end_ && *next_ == c; }
  bool at_class(Class wanted) const { return next_ != end_ && (kClasses[static_cast<unsigned char>(*next_)] & wanted) != 0; }
  bool take(char c) {
    if (!at(c)) return false;
    ++next_;
    return true;
  }
  void skip_space() {
    while (at(' ') || at('\t')) ++next_;
  }
  Place place() const { return {line_, static_cast<std::uint32_t>(next_ - line_begin_) + 1, -1}; }

  /// Where it ends, a comment before it.
  bool end_of_line() {
    skip_space();
    if (take('#')) {
      while (at_class(kPrinted)) ++next_;
    }
    return next_ == end_ || new_line();
  }
  bool new_line() {
    if (!take('\n')) return false;
    ++line_;
    line_begin_ = next_;
    return true;
  }

  std::string_view key() {
    const char* first = next_;
    while (at_class(kKey)) ++next_;
    return {first, next_};
  }

  /// Room for one more, which is not there yet: in the order of the keys.
  static KeyedNode* add(Table& table, std::string_view key, const Place& place) {
    if (table.size() == kMostKeys) return nullptr;
    const auto before = [](const KeyedNode& member, std::string_view name) { return member.key < name; };
    const auto where = std::lower_bound(table.begin(), table.end(), key, before);
    if (where != table.end() && where->key == key) return nullptr;
    return &*table.insert(where, {std::string(key), place, {Moment{}, place}});
  }

  /// "[key]" or "[[key]]": the table that it begins.
  Table* header(Table& root) {
    const Place begin = place();
    ++next_;
    const bool of_list = take('[');
    const Place key_place = place();
    const std::string_view name = key();
    if (name.empty() || !take(']') || (of_list && !take(']'))) return nullptr;
    Node* node = of_list ? find_member(root, name) : nullptr;
    if (node == nullptr) {
      KeyedNode* added = add(root, name, key_place);
      if (added == nullptr) return nullptr;
      node = &added->node;
      node->place = begin;
      if (!of_list) return &node->value.emplace<Table>();
      node->value.emplace<Array>();
      lists_.push_back(node->place);
    }
    auto* list = std::get_if<Array>(&node->value);
    // A list that was written as a value is none of tables.
    if (list == nullptr || std::none_of(lists_.begin(), lists_.end(), [&](const Place& of) { return of == node->place; })) return nullptr;
    list->push_back({Table{}, begin});
    return &std::get<Table>(list->back().value);
  }

  bool member(Table& table) {
    const Place begin = place();
    KeyedNode* added = add(table, key(), begin);
    if (added == nullptr) return false;
    skip_space();
    if (!take('=')) return false;
    skip_space();
    return value(added->node, 0);
  }

  bool value(Node& node, int depth) {
    node.place = place();
    if (at('[')) return list(node.value.emplace<Array>(), depth + 1);
    if (at('"')) return text(node);
    if (at('t')) return word("true") && (node.value.emplace<bool>(true), true);
    if (at('f')) return word("false") && (node.value.emplace<bool>(false), true);
    return number(node);
  }

  bool word(std::string_view wanted) {
    if (static_cast<std::size_t>(end_ - next_) < wanted.size() || std::string_view(next_, wanted.size()) != wanted) return false;
    next_ += wanted.size();
    return ends_value();
  }
  bool ends_value() const { return next_ == end_ || std::string_view(" \t\n,]#").find(*next_) != std::string_view::npos; }

  bool text(Node& node) {
    ++next_;
    const char* first = next_;
    while (at_class(kPrinted) && *next_ != '"' && *next_ != '\\') ++next_;
    const char* last = next_;
    if (!take('"') || !ends_value()) return false;
    node.value.emplace<std::string>(first, last);
    return true;
  }

  bool number(Node& node) {
    const bool minus = at('-');
    if (minus || at('+')) ++next_;
    const char* first = next_;
    std::int64_t digits = 0;
    while (at_class(kDigit)) digits = 10 * (digits % kDigitsThatFit) + (*next_++ - '0');
    const auto before = static_cast<std::size_t>(next_ - first);
    if (before == 0 || before > kMostDigits || (*first == '0' && before > 1)) return false;
    if (!take('.')) {
      node.value.emplace<std::int64_t>(minus ? -digits : digits);
      return ends_value();
    }
    const char* point = next_;
    while (at_class(kDigit)) digits = 10 * (digits % kDigitsThatFit) + (*next_++ - '0');
    const auto behind = static_cast<std::size_t>(next_ - point);
    if (behind == 0 || before + behind > kMostDigits) return false;
    // Both are exact, and so is the nearest double of their quotient.
    const double size = static_cast<double>(digits) / kPowers[behind];
    node.value.emplace<double>(minus ? -size : size);
    return ends_value();
  }
  static constexpr std::int64_t kDigitsThatFit = 100'000'000'000'000'000;  // More of them are refused when they are counted.

  /// "[", values with commas between them, "]"; over as many lines as it takes.
  bool list(Array& list, int depth) {
    if (depth > kMostDepth) return false;
    ++next_;
    skip_lines();
    if (take(']')) return ends_value();
    list.reserve(2);
    while (true) {
      if (!value(list.emplace_back(), depth)) return false;
      skip_lines();
      if (take(']')) return ends_value();
      if (!take(',')) return false;
      skip_lines();
    }
  }
  void skip_lines() {
    do skip_space();
    while (new_line());
  }

  const char* next_;
  const char* end_;
  const char* line_begin_;
  std::uint32_t line_ = 1;
  std::vector<Place> lists_;  // Of tables, where each begins.
};

}  // namespace

std::optional<Node> parse_plain(std::string_view text) {
  Node root{Table{}, {1, 1, -1}};
  if (!PlainReader(text).read(std::get<Table>(root.value))) return std::nullopt;
  return root;
}

}  // namespace topple

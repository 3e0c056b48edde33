#include "layout/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "topple/layout.h"

namespace topple {
namespace {

/// How many bytes the UTF-8 character at the start of `text` has; 0 where there is none.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t bytes = lead >= 0xC2 && lead < 0xE0 ? 2 : lead >= 0xE0 && lead < 0xF0 ? 3 : lead >= 0xF0 && lead < 0xF5 ? 4 : 0;
  if (bytes == 0 || text.size() < bytes) return 0;
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return 0;
  }
  // Overlong forms, surrogates and what lies beyond U+10FFFF.
  const unsigned second = byte(1);
  if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F)) return 0;
  if ((lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F)) return 0;
  return bytes;
}

std::string hexadecimal(unsigned byte) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  return {kDigits[(byte >> 4U) & 15U], kDigits[byte & 15U]};
}

/// Reads over a document character by character, knowing no more of TOML than comments, strings and brackets.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  std::optional<Unreadable> scan() {
    constexpr std::size_t kMaxBytes = std::size_t{64} << 20U;
    if (text_.size() > kMaxBytes)
      return stop("the file has " + count_text(static_cast<long long>(text_.size())) + " bytes, at most " + count_text(kMaxBytes) +
                  " are read");
    while (at_ < text_.size()) {
      if (quote_.empty() && skip_ == 0 && is_plain(text_[at_])) {
        ++at_;
        ++column_;
        continue;
      }
      const std::size_t bytes = character_bytes(text_.substr(at_));
      if (bytes == 0) {
        return stop("not UTF-8: byte " + std::to_string(at_) + " (counted from 0) is 0x" +
                    hexadecimal(static_cast<unsigned char>(text_[at_])));
      }
      see(text_[at_]);
      if (depth_ > kMaxDepth) return stop("nested more than " + std::to_string(kMaxDepth) + " brackets deep");
      if (dots_ > kMaxDepth) return stop("a key with more than " + std::to_string(kMaxDepth) + " dots");
      if (values_ > kMaxValues) return stop("more than " + count_text(kMaxValues) + " values");
      if (text_[at_] == '\n') {
        ++line_;
        column_ = 0;
      }
      at_ += bytes;
      ++column_;
    }
    return std::nullopt;
  }

 private:
  // The TOML reader and every tree recurse this deep; a layout needs 4.
  static constexpr int kMaxDepth = 32;
  // A value takes about 150 bytes while the document is read.
  static constexpr int kMaxValues = 8'000'000;

  /// Outside of strings and comments these mean nothing to it.
  static bool is_plain(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '-' || c == ' ';
  }

  std::optional<Unreadable> stop(std::string why) const { return Unreadable{line_, column_, std::move(why)}; }

  void see(char c) {
    if (c == '\n') {
      dots_ = 0;
      if (quote_.size() < 3) quote_ = {};  // a comment ends, and a string that somebody forgot to close
    }
    if (skip_ > 0) {
      --skip_;
    } else if (!quote_.empty()) {
      see_quoted(c);
    } else if (c == '#' || c == '"' || c == '\'') {
      const std::string_view three = text_.substr(at_, 3);
      quote_ = c != '#' && three == std::string(3, c) ? three : text_.substr(at_, 1);
      skip_ = quote_.size() - 1;
    } else {
      see_bare(c);
    }
  }

  void see_quoted(char c) {
    if (c == '\\' && quote_[0] == '"') {
      skip_ = 1;
    } else if (quote_[0] != '#' && text_.substr(at_, quote_.size()) == quote_) {
      skip_ = quote_.size() - 1;
      quote_ = {};
    }
  }

  void see_bare(char c) {
    if (c == '.') ++dots_;
    if (c == '[' || c == '{') ++depth_;
    if ((c == ']' || c == '}') && depth_ > 0) --depth_;
    if (c == ',' || c == '=' || c == '[') ++values_;
    if (std::string_view("=,[]{}").find(c) != std::string_view::npos) dots_ = 0;
  }

  std::string_view text_;
  std::size_t at_ = 0, line_ = 1, column_ = 1;
  std::string_view quote_;  // what ends the string that we are in; "#" for a comment
  std::size_t skip_ = 0;
  int depth_ = 0, dots_ = 0, values_ = 0;
};

}  // namespace

std::string printable(std::string_view text, std::size_t limit) {
  std::string out;
  for (std::size_t n = 0; !text.empty(); ++n) {
    if (n == limit) return out + "...";
    const std::size_t bytes = character_bytes(text);
    const auto byte = static_cast<unsigned char>(text[0]);
    if (text[0] == '\n') {
      out += "\\n";
    } else if (bytes == 0 || byte < 0x20 || byte == 0x7F || (byte == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0)) {
      for (const char c : text.substr(0, std::max<std::size_t>(bytes, 1))) out += "\\x" + hexadecimal(static_cast<unsigned char>(c));
    } else {
      out += text.substr(0, bytes);
    }
    text.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return out;
}

std::string number_text(double number) {
  std::array<char, 32> digits;
  const double size = std::abs(number);
  const bool plain = number == 0.0 || (size >= 1e-5 && size < 1e15);
  const auto format = plain ? std::chars_format::fixed : std::chars_format::scientific;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number, format);
  return {digits.data(), end.ptr};
}

std::string count_text(long long count) {
  std::string digits = std::to_string(count);
  const std::size_t first = count < 0 ? 1 : 0;
  for (std::size_t i = digits.size(); i > first + 3;) digits.insert(i -= 3, ",");
  return digits;
}

std::string color_text(const Color& color) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "#";
  for (const unsigned byte : {color.red, color.green, color.blue}) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

std::optional<Unreadable> unreadable(std::string_view text) { return Scanner(text).scan(); }

std::string_view nearest_key(std::string_view word, std::span<const std::string_view> known) {
  word = word.substr(0, 64);
  std::string_view nearest;
  std::size_t least = std::string_view::npos;
  for (const std::string_view key : known) {
    // Optimal string alignment [Damerau1964]: rows of changes from the first i letters of word to the first j of key.
    std::vector<std::size_t> before, last, row(key.size() + 1);
    for (std::size_t j = 0; j <= key.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= word.size(); ++i) {
      before = std::move(last);
      last = std::move(row);
      row.assign(key.size() + 1, i);
      for (std::size_t j = 1; j <= key.size(); ++j) {
        const std::size_t changed = last[j - 1] + (word[i - 1] == key[j - 1] ? 0U : 1U);
        row[j] = std::min({changed, last[j] + 1, row[j - 1] + 1});
        if (i > 1 && j > 1 && word[i - 1] == key[j - 2] && word[i - 2] == key[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    if (row[key.size()] < least) {
      least = row[key.size()];
      nearest = key;
    }
  }
  return nearest;
}

}  // namespace topple

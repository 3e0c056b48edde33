#include "text.h"

#include <array>
#include <cstdarg>
#include <cstdio>

namespace topple::app {

std::string formatted(const char* format, ...) {
  std::va_list first;
  va_start(first, format);
  std::va_list second;
  va_copy(second, first);
  const int length = std::vsnprintf(nullptr, 0, format, first);
  va_end(first);
  std::string text(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, second);
  va_end(second);
  return text;
}

std::string grouped(std::int64_t number) {
  std::string digits = std::to_string(number);
  const std::size_t first = number < 0 ? 1 : 0;
  for (std::size_t place = digits.size(); place > first + 3;) {
    place -= 3;
    digits.insert(place, ",");
  }
  return digits;
}

std::string byte_size(std::uint64_t bytes) {
  constexpr std::array<const char*, 5> kUnits = {"B", "kB", "MB", "GB", "TB"};
  double size = static_cast<double>(bytes);
  std::size_t unit = 0;
  while (size >= 999.5 && unit + 1 < kUnits.size()) {
    size /= 1000.0;
    ++unit;
  }
  return formatted(unit > 0 && size < 9.95 ? "%.1f %s" : "%.0f %s", size, kUnits[unit]);
}

std::string count_of(std::int64_t number, const std::string& noun) { return grouped(number) + " " + noun + (number == 1 ? "" : "s"); }

std::string listed(const std::vector<std::string>& words, const char* last) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    list += (i == 0 ? "" : i + 1 < words.size() ? ", " : std::string(" ") + last + " ") + words[i];
  }
  return list;
}

int complain(const std::string& message, int exit_code) {
  const bool ended = !message.empty() && message.back() == '\n';
  std::fprintf(stderr, ended ? "%s" : "%s\n", message.c_str());
  return exit_code;
}

int complain(const Error& error, int exit_code) { return complain(error.message, exit_code); }

}  // namespace topple::app

#include "desk.h"

#include <algorithm>
#include <cstdio>

namespace topple {

Desk& desk() {
  static Desk only;
  return only;
}

void add_text(std::string& json, std::string_view text) {
  json += '"';
  for (const char c : text) {
    char escape[8];
    if (c == '"' || c == '\\') {
      json += '\\';
      json += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      std::snprintf(escape, sizeof(escape), "\\u%04x", static_cast<unsigned>(c));
      json += escape;
    } else {
      json += c;
    }
  }
  json += '"';
}

void add_number(std::string& json, double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.17g", value);
  json += std::string_view(text).find('n') == std::string_view::npos ? text : "null";  // nan and inf are no JSON
}

bool fail(const Error& error) {
  desk().answer = error.message;
  return false;
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (end > 0) lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

}  // namespace topple

/// Included before everything in the page's engine. There, the C++ library has no files; toml++ compiles a function that opens one, which
/// nobody calls: a stream that is never open is enough for it.
#pragma once

#include <iosfwd>
#include <istream>

namespace std {
template <>
class basic_ifstream<char> : public istream {
 public:
  template <typename... Ignored>
  explicit basic_ifstream(const Ignored&...) : istream(nullptr) {}
  template <typename... Ignored>
  void open(const Ignored&...) {}
  bool is_open() const { return false; }
  void close() {}
};
}  // namespace std

/// Everything that is wrong with a layout, collected so that a person reads it all at once.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "layout/document.h"

namespace topple {

class Problems {
 public:
  Problems(std::string_view name, std::span<const std::string> overrides) : name_(name), overrides_(overrides) {}

  /// `key` is the dotted path in the file; `what` says what is wrong, the value and the allowed range.
  void add(const Place& place, std::string_view key, std::string_view what);

  std::size_t count() const { return count_; }

  /// There are more problems than were looked for.
  void stop_counting() { counted_all_ = false; }

  /// "name:line:column", or "--set key".
  std::string where(const Place& place) const;

  /// A line each in the order of the file, at most 50 of them.
  Error error() const;

 private:
  struct Problem {
    Place place;
    std::string line;
  };
  std::string_view override_key(const Place& place) const;

  std::string_view name_;
  std::span<const std::string> overrides_;
  std::vector<Problem> problems_;
  std::size_t count_ = 0;
  bool counted_all_ = true;
};

}  // namespace topple

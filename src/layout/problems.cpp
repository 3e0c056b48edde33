#include "layout/problems.h"

#include <algorithm>
#include <tuple>

#include "layout/text.h"

namespace topple {
namespace {

constexpr std::size_t kListed = 50;
constexpr std::size_t kKept = 1000;  // a file of a million mistakes must not fill the memory with messages

}  // namespace

std::string_view Problems::override_key(const Place& place) const {
  const std::string_view whole = overrides_[static_cast<std::size_t>(place.override_index)];
  return whole.substr(0, whole.find('='));
}

std::string Problems::where(const Place& place) const {
  if (place.override_index >= 0) return "--set " + printable(override_key(place));
  if (place.line == 0) return std::string(name_);
  return std::string(name_) + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

void Problems::add(const Place& place, std::string_view key, std::string_view what) {
  ++count_;
  if (problems_.size() == kKept) return;
  std::string line = where(place) + ": ";
  const bool said = place.override_index >= 0 && (key == override_key(place) || key == "model." + std::string(override_key(place)));
  if (!key.empty() && !said) line += printable(key) + ": ";
  problems_.push_back({place, line + std::string(what)});
}

Error Problems::error() const {
  std::vector<const Problem*> sorted;
  sorted.reserve(problems_.size());
  for (const Problem& problem : problems_) sorted.push_back(&problem);
  const auto order = [](const Problem* problem) {
    const Place& at = problem->place;
    const bool in_file = at.override_index < 0;
    return std::tuple(at.override_index, in_file ? at.line : 0U, in_file ? at.column : 0U, problem);  // else as they were found
  };
  std::sort(sorted.begin(), sorted.end(), [&](const Problem* a, const Problem* b) { return order(a) < order(b); });
  Error error;
  for (std::size_t i = 0; i < std::min(sorted.size(), kListed); ++i) error.message += (i == 0 ? "" : "\n") + sorted[i]->line;
  if (count_ > kListed)
    error.message +=
        (counted_all_ ? "\nand " : "\nand at least ") + count_text(static_cast<long long>(count_ - kListed)) + " more problems";
  return error;
}

}  // namespace topple

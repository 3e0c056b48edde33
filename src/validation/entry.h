/// A table of a source's file: every key must be asked for, and what is wrong is said with its place.
#pragma once

#include <toml++/toml.h>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace topple::validation {

class Entry {
 public:
  Entry(const toml::table& table, std::string where, std::string& problems)
      : table_(&table), where_(std::move(where)), problems_(&problems) {}

  bool has(std::string_view key) const { return table_->contains(key); }
  std::string text(std::string_view key, bool needed = false);
  std::optional<double> number(std::string_view key);
  double number(std::string_view key, double fallback) { return number(key).value_or(fallback); }
  bool flag(std::string_view key, bool fallback);
  std::vector<double> numbers(std::string_view key);
  /// A number becomes the text that gives the same number.
  std::vector<std::string> texts(std::string_view key);
  /// The tables of a list, or the one table, under a key.
  std::vector<Entry> entries(std::string_view key);
  /// A key that nobody asked for is a mistake.
  void finish() const;
  void wrong(std::string_view key, std::string_view what) const;

 private:
  const toml::node* find(std::string_view key, bool needed = false);

  const toml::table* table_;
  std::string where_;
  std::string* problems_;
  std::set<std::string, std::less<>> asked_;
};

}  // namespace topple::validation

#include "validation/entry.h"

#include "export/gnuplot.h"

namespace topple::validation {

const toml::node* Entry::find(std::string_view key, bool needed) {
  asked_.emplace(key);
  const toml::node* node = table_->get(key);
  if (node == nullptr && needed) wrong(key, "must be there");
  return node;
}

void Entry::wrong(std::string_view key, std::string_view what) const {
  const toml::node* node = table_->get(key);
  const toml::source_region& at = node != nullptr ? node->source() : table_->source();
  *problems_ +=
      (problems_->empty() ? "" : "\n") + where_ + ":" + std::to_string(at.begin.line) + ": " + std::string(key) + ": " + std::string(what);
}

std::string Entry::text(std::string_view key, bool needed) {
  const toml::node* node = find(key, needed);
  if (node == nullptr) return {};
  if (const auto value = node->value_exact<std::string>()) return *value;
  wrong(key, "must be a text");
  return {};
}

std::optional<double> Entry::number(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  if (const auto value = node->value<double>(); value && node->is_number()) return value;
  wrong(key, "must be a number");
  return {};
}

bool Entry::flag(std::string_view key, bool fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback;
  if (const auto value = node->value_exact<bool>()) return *value;
  wrong(key, "must be true or false");
  return fallback;
}

std::vector<double> Entry::numbers(std::string_view key) {
  std::vector<double> out;
  const toml::node* node = find(key);
  if (node == nullptr) return out;
  const toml::array* list = node->as_array();
  if (list == nullptr) {
    wrong(key, "must be a list of numbers");
    return out;
  }
  for (const toml::node& one : *list) {
    const auto value = one.value<double>();
    if (!value || !one.is_number()) {
      wrong(key, "must be a list of numbers");
      return out;
    }
    out.push_back(*value);
  }
  return out;
}

std::vector<std::string> Entry::texts(std::string_view key) {
  std::vector<std::string> out;
  const toml::node* node = find(key);
  if (node == nullptr) return out;
  const toml::array* list = node->as_array();
  if (list == nullptr) {
    wrong(key, "must be a list");
    return out;
  }
  for (const toml::node& one : *list) {
    if (one.is_string()) {
      out.push_back(*one.value<std::string>());
    } else if (one.is_number()) {
      out.push_back(decimal(*one.value<double>()));
    } else {
      wrong(key, "must be a list of texts or numbers");
    }
  }
  return out;
}

std::vector<Entry> Entry::entries(std::string_view key) {
  std::vector<Entry> out;
  const toml::node* node = find(key);
  if (node == nullptr) return out;
  if (const toml::table* table = node->as_table()) {
    out.emplace_back(*table, where_, *problems_);
    return out;
  }
  const toml::array* list = node->as_array();
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
    if (const toml::table* table = (*list)[i].as_table()) out.emplace_back(*table, where_, *problems_);
  }
  if (list == nullptr || out.size() != list->size()) wrong(key, "must be a table or a list of tables");
  return out;
}

void Entry::finish() const {
  for (const auto& [key, node] : *table_) {
    if (!asked_.contains(key.str())) wrong(key.str(), "there is no such key");
  }
}

}  // namespace topple::validation

// The only file that sees toml++, which is slow to compile.
#include "layout/document.h"

#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include "layout/text.h"

namespace topple {
namespace {

Place place_of(const toml::source_position& at) { return {static_cast<std::uint32_t>(at.line), static_cast<std::uint32_t>(at.column), -1}; }

Node tree_of(const toml::node& from);

Table table_of(const toml::table& from) {
  Table table;
  table.reserve(from.size());
  for (auto&& [key, value] : from) {
    table.push_back({std::string(key.str()), place_of(key.source().begin), tree_of(value)});
  }
  return table;
}

Array array_of(const toml::array& from) {
  Array array;
  array.reserve(from.size());
  for (const toml::node& value : from) array.push_back(tree_of(value));
  return array;
}

/// As deep as the document, which check_text() has bounded.
Node tree_of(const toml::node& from) {
  Node node{Moment{}, place_of(from.source().begin)};
  if (const auto* table = from.as_table()) {
    node.value = table_of(*table);
  } else if (const auto* array = from.as_array()) {
    node.value = array_of(*array);
  } else if (const auto* text = from.as_string()) {
    node.value = text->get();
  } else if (const auto* whole = from.as_integer()) {
    node.value = whole->get();
  } else if (const auto* number = from.as_floating_point()) {
    node.value = number->get();
  } else if (const auto* truth = from.as_boolean()) {
    node.value = truth->get();
  }
  return node;
}

void move_to(Node& node, const Place& place) {
  node.place = place;
  if (auto* array = std::get_if<Array>(&node.value)) {
    for (Node& inner : *array) move_to(inner, place);
  } else if (auto* table = std::get_if<Table>(&node.value)) {
    for (Member& member : *table) {
      member.place = place;
      move_to(member.node, place);
    }
  }
}

}  // namespace

const Node* find_member(const Table& table, std::string_view key) {
  for (const Member& member : table) {
    if (member.key == key) return &member.node;
  }
  return nullptr;
}

Node* find_member(Table& table, std::string_view key) { return const_cast<Node*>(find_member(std::as_const(table), key)); }

Result<Node> parse_document(std::string_view text, std::string_view name) {
  const toml::parse_result parsed = toml::parse(text);
  if (parsed) return Node{table_of(parsed.table()), {1, 1, -1}};
  const toml::parse_error& error = parsed.error();
  const toml::source_position at = error.source().begin;
  std::string_view why = error.description();
  constexpr std::string_view kEmpty = "Error ";  // "Error while parsing string: ..."
  if (why.starts_with(kEmpty)) why.remove_prefix(kEmpty.size());
  return failure(std::string(name) + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) +
                 ": not TOML: " + printable(why, 300));
}

Node parse_value(std::string_view text, const Place& place) {
  const std::string line = "value = " + std::string(text);
  if (text.find_first_of("\r\n") == std::string_view::npos && !unreadable(line)) {
    const toml::parse_result parsed = toml::parse(line);
    if (parsed && parsed.table().size() == 1) {
      Node node = tree_of(parsed.table().begin()->second);
      move_to(node, place);
      return node;
    }
  }
  return {std::string(text), place};
}

}  // namespace topple

#include "layout/overrides.h"

#include <algorithm>
#include <charconv>

#include "layout/text.h"

namespace topple {
namespace {

std::vector<std::string_view> split(std::string_view path) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t dot = path.find('.');
    parts.push_back(path.substr(0, dot));
    if (dot == std::string_view::npos) return parts;
    path.remove_prefix(dot + 1);
  }
}

bool is_index(std::string_view part) {
  return !part.empty() && part.size() <= 9 && std::all_of(part.begin(), part.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// The entry of a list that `part` names; null after a problem.
Node* entry_of(Array& array, std::string_view part, std::string_view list, const Place& place, Problems& problems) {
  const std::string entries = array.empty() ? "it has no entries" : "its entries are 0 to " + std::to_string(array.size() - 1);
  std::size_t index = array.size();
  if (is_index(part)) std::from_chars(part.data(), part.data() + part.size(), index);
  if (index < array.size()) return &array[index];
  problems.add(place, list, "there is no entry \"" + printable(part) + "\" in this list; " + entries);
  return nullptr;
}

/// The node at the end of the path, made where there is none; null after a problem.
Node* reach(Node& root, std::span<const std::string_view> path, const Place& place, Problems& problems) {
  Node* node = &root;
  std::string walked;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (auto* array = std::get_if<Array>(&node->value)) {
      node = entry_of(*array, path[i], walked, place, problems);
      if (!node) return nullptr;
    } else if (auto* table = std::get_if<Table>(&node->value)) {
      Node* member = find_member(*table, path[i]);
      if (!member) {
        if (i + 1 < path.size() && is_index(path[i + 1])) {
          problems.add(place, "", "the layout has no [[" + printable(path[i]) + "]]");
          return nullptr;
        }
        table->push_back({std::string(path[i]), place, Node{Table{}, place}});
        member = &table->back().node;
      }
      node = member;
    } else {
      problems.add(place, "", printable(walked) + " is a single value, it has nothing inside");
      return nullptr;
    }
    if (i > 0) walked += ".";
    walked += path[i];
  }
  return node;
}

void apply(Node& root, std::string_view text, const Place& place, Problems& problems) {
  const std::size_t equals = text.find('=');
  const std::string_view key = text.substr(0, equals);
  std::vector<std::string_view> path = split(key);
  const bool gap = std::any_of(path.begin(), path.end(), [](std::string_view part) { return part.empty(); });
  constexpr std::size_t kMaxParts = 8;
  if (equals == std::string_view::npos || gap || path.size() > kMaxParts) {
    problems.add(place, "", "must be key=value, the key words joined by dots, such as row.0.count=50");
    return;
  }
  if (const auto bad = unreadable(text)) {
    problems.add(place, "", bad->why);
    return;
  }
  if (path.size() == 1 && key != "title" && key != "gravity_m_s2") path.insert(path.begin(), "model");
  Node* node = reach(root, path, place, problems);
  if (!node) return;
  const Place old = node->place;
  *node = parse_value(text.substr(equals + 1), place);
  node->place = {old.line, old.column, place.override_index};
}

/// The table of [model]; null where there is none.
Table* model_of(Node& root) {
  auto* top = std::get_if<Table>(&root.value);
  Node* model = top == nullptr ? nullptr : find_member(*top, "model");
  return model == nullptr ? nullptr : std::get_if<Table>(&model->value);
}

/// What [model] names; empty where it names nothing.
std::string named_model(Node& root) {
  const Table* model = model_of(root);
  const Node* name = model == nullptr ? nullptr : find_member(*model, "name");
  const auto* text = name == nullptr ? nullptr : std::get_if<std::string>(&name->value);
  return text == nullptr ? std::string() : *text;
}

}  // namespace

void apply_overrides(Node& root, std::span<const std::string> overrides, Problems& problems) {
  const std::string named = named_model(root);
  for (std::size_t i = 0; i < overrides.size(); ++i) {
    apply(root, overrides[i], {.line = 0, .column = 0, .override_index = static_cast<std::int32_t>(i)}, problems);
  }
  // The settings beside the name are for the model that the file names: another one neither knows them nor wants their time step.
  if (named.empty() || named_model(root) == named) return;
  if (Table* model = model_of(root)) std::erase_if(*model, [](const KeyedNode& member) { return member.node.place.override_index < 0; });
}

}  // namespace topple

#include "layout/kinds.h"

#include <algorithm>

#include "layout/keys.h"
#include "layout/text.h"

namespace topple {
namespace {

/// Without mass and density a kind is as dense as the default brick: 983.8 kg/m^3 [kg].
double default_mass(const BrickKind& kind) {
  const BrickKind usual;
  const double density = usual.mass / (usual.height * usual.width * usual.thickness);
  const bool default_size = kind.height == usual.height && kind.width == usual.width && kind.thickness == usual.thickness;
  return default_size ? usual.mass : density * (kind.height * kind.width * kind.thickness);
}

BrickKind read_kind(Section& section, const Surface& surface, bool first) {
  BrickKind kind;
  const auto name = section.text("name", 200);
  if (name && name->empty()) section.problem("name", "must not be empty");
  if (!section.has("name") && !first) section.missing("name must be there; only the first kind may go without");
  kind.name = name.value_or(kind.name);
  const auto size = [&](std::string_view key, double otherwise) {
    const auto mm = section.number(key, kSize);
    return mm ? *mm / 1000.0 : otherwise;
  };
  kind.height = size("height_mm", kind.height);
  kind.width = size("width_mm", kind.width);
  kind.thickness = size("thickness_mm", kind.thickness);
  const double least = std::min({kind.height, kind.width, kind.thickness}), most = std::max({kind.height, kind.width, kind.thickness});
  constexpr double kLeastShare = 1e-3;  // slimmer bricks would make the search for overlaps slow
  if (section.good() && least < kLeastShare * most) {
    section.missing("its longest side must be at most 1,000 times its shortest, is " + count_text(static_cast<long long>(most / least)) +
                    " times");
  }
  kind.mass = read_mass(section, kind.height * kind.width * kind.thickness, default_mass(kind));
  kind.surface = read_surface(section, surface);
  kind.color = section.color("color").value_or(kind.color);
  return kind;
}

}  // namespace

Surface read_surface(Section& section, const Surface& otherwise) {
  return {.brick_friction = section.number("brick_friction", kFriction).value_or(otherwise.brick_friction),
          .floor_friction = section.number("floor_friction", kFriction).value_or(otherwise.floor_friction),
          .brick_restitution = section.number("brick_restitution", kRestitution).value_or(otherwise.brick_restitution),
          .floor_restitution = section.number("floor_restitution", kRestitution).value_or(otherwise.floor_restitution)};
}

double read_mass(Section& section, double volume, double otherwise) {
  const auto grams = section.number("mass_g", kMass);
  const auto density = section.number("density_kg_m3", kDensity);
  if (section.has("mass_g") && section.has("density_kg_m3")) section.missing("mass_g and density_kg_m3 are both there; at most one may be");
  if (grams) return *grams / 1000.0;
  return density ? *density * volume : otherwise;
}

std::optional<Section> section_of(const Section& top, std::string_view key, std::span<const std::string_view> known, Problems& problems) {
  const Node* node = top.find(key);
  if (!node) return std::nullopt;
  if (std::holds_alternative<Table>(node->value)) return Section(*node, top.path_of(key), known, problems);
  problems.add(node->place, top.path_of(key), "must be a table, [" + std::string(key) + "]; is " + value_text(*node));
  return std::nullopt;
}

std::vector<Section> sections_of(const Section& top, std::string_view key, std::span<const std::string_view> known, Problems& problems) {
  std::vector<Section> sections;
  const Node* node = top.find(key);
  if (!node) return sections;
  const auto* array = std::get_if<Array>(&node->value);
  const std::string must = "must be a table in a list, [[" + std::string(key) + "]]; is ";
  if (!array) {
    problems.add(node->place, top.path_of(key), must + value_text(*node));
    return sections;
  }
  sections.reserve(array->size());
  for (std::size_t i = 0; i < array->size(); ++i) {
    const Node& entry = (*array)[i];
    const std::string path = top.path_of(key) + "." + std::to_string(i);
    if (std::holds_alternative<Table>(entry.value)) {
      sections.emplace_back(entry, path, known, problems);
    } else {
      problems.add(entry.place, path, must + value_text(entry));
    }
  }
  return sections;
}

Surface read_contact(const Section& top, Problems& problems) {
  auto section = section_of(top, "contact", keys::kContact, problems);
  return section ? read_surface(*section, {}) : Surface{};
}

std::vector<BrickKind> read_kinds(const Section& top, const Surface& surface, Problems& problems) {
  std::vector<BrickKind> kinds;
  std::vector<std::string_view> names;
  for (Section& section : sections_of(top, "kind", keys::kKind, problems)) {
    if (kinds.size() == kMaxKinds) {
      section.missing("one kind more than the " + count_text(static_cast<long long>(kMaxKinds)) + " that a layout may have");
      break;
    }
    kinds.push_back(read_kind(section, surface, kinds.empty()));
    const std::string& name = kinds.back().name;
    const auto same = [&](const BrickKind& kind) { return &kind != &kinds.back() && kind.name == name; };
    if (section.good() && std::any_of(kinds.begin(), kinds.end(), same))
      section.problem("name", "two kinds are called \"" + printable(name) + "\"");
  }
  if (kinds.empty()) {
    kinds.emplace_back();
    kinds.back().surface = surface;
  }
  return kinds;
}

}  // namespace topple

// What two kinds do to each other.
#include "layout/surfaces.h"

#include <algorithm>
#include <cmath>

#include "layout/keys.h"
#include "layout/kinds.h"
#include "layout/text.h"

namespace topple {
namespace {

double mean(double one, double other) { return one == other ? one : std::sqrt(one * other); }

bool joins(const SurfacePair& pair, std::uint16_t one, std::uint16_t other) {
  return (pair.one == one && pair.other == other) || (pair.one == other && pair.other == one);
}

/// Index of the kind that `key` names; empty after a problem.
std::optional<std::uint16_t> kind_named(Section& section, std::string_view key, std::span<const BrickKind> kinds) {
  if (!section.has(key)) section.missing(std::string(key) + " must be there: the name of a kind");
  const auto name = section.text(key, 1000);
  return name ? find_kind(section, key, *name, kinds) : std::nullopt;
}

}  // namespace

std::optional<std::uint16_t> find_kind(Section& section, std::string_view key, const std::string& name, std::span<const BrickKind> kinds) {
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const BrickKind& kind) { return kind.name == name; });
  if (found != kinds.end()) return static_cast<std::uint16_t>(found - kinds.begin());
  std::vector<std::string_view> names;
  for (const BrickKind& kind : kinds) names.push_back(kind.name);
  section.problem(key, "there is no kind \"" + printable(name) + "\"; the nearest is \"" + printable(nearest_key(name, names)) + "\"");
  return std::nullopt;
}

std::vector<SurfacePair> read_pairs(const Section& top, Layout& layout, Problems& problems) {
  std::vector<SurfacePair> pairs;
  for (Section& section : sections_of(top, "pair", keys::kPair, problems)) {
    const auto one = kind_named(section, "kind", layout.kinds), other = kind_named(section, "with", layout.kinds);
    const auto friction = section.number("friction", kFriction);
    const auto restitution = section.number("restitution", kRestitution);
    if (!section.has("friction") && !section.has("restitution")) section.missing("friction or restitution must be there, or both");
    if (!one || !other || !section.good()) continue;
    if (std::any_of(pairs.begin(), pairs.end(), [&](const SurfacePair& pair) { return joins(pair, *one, *other); })) {
      section.problem("with", "this pair has been given before");
      continue;
    }
    const SurfacePair ruled = surface_pair(layout, *one, *other);
    pairs.push_back({*one, *other, friction.value_or(ruled.friction), restitution.value_or(ruled.restitution)});
  }
  return pairs;
}

SurfacePair surface_pair(const Layout& layout, std::uint16_t one, std::uint16_t other) {
  for (const SurfacePair& pair : layout.pairs) {
    if (joins(pair, one, other)) return pair;
  }
  const Surface &mine = layout.kinds[one].surface, &its = layout.kinds[other].surface;
  return {one, other, mean(mine.brick_friction, its.brick_friction), mean(mine.brick_restitution, its.brick_restitution)};
}

}  // namespace topple

/// What bricks share: [contact] and [[kind]]. And how tables are found in the file.
#pragma once

#include <optional>
#include <vector>

#include "layout/section.h"
#include "topple/layout.h"

namespace topple {

inline constexpr Range kSize{0.1, 20000.0};           // [mm]
inline constexpr Range kMass{0.0, 1e9, true};         // [g]
inline constexpr Range kDensity{0.0, 30000.0, true};  // [kg/m^3]
inline constexpr Range kFriction{0.0, 10.0};
inline constexpr Range kRestitution{0.0, 1.0};
inline constexpr std::size_t kMaxKinds = 1000;

/// The table at `key`; empty where there is none or after a problem.
std::optional<Section> section_of(const Section& top, std::string_view key, std::span<const std::string_view> known, Problems& problems);

/// The tables of a list, [[key]]; what is not one is a problem.
std::vector<Section> sections_of(const Section& top, std::string_view key, std::span<const std::string_view> known, Problems& problems);

/// The four keys of a surface, each from `otherwise` where it is not there.
Surface read_surface(Section& section, const Surface& otherwise);

/// From mass_g or density_kg_m3, of which at most one may be there [kg]; `otherwise` where neither is.
double read_mass(Section& section, double volume, double otherwise);

Surface read_contact(const Section& top, Problems& problems);

/// At least one kind: without any [[kind]] the default brick.
std::vector<BrickKind> read_kinds(const Section& top, const Surface& surface, Problems& problems);

}  // namespace topple

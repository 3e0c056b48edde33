/// What bricks share: [contact] and [[kind]]. And how tables are found in the file.
#pragma once

#include <optional>
#include <vector>

#include "layout/section.h"
#include "topple/layout.h"

namespace topple {

/// The table at `key`; empty where there is none or after a problem.
std::optional<Section> section_of(const Section& top, std::string_view key, std::span<const std::string_view> known, Problems& problems);

/// The tables of a list, [[key]]; what is not one is a problem.
std::vector<Section> sections_of(const Section& top, std::string_view key, std::span<const std::string_view> known, Problems& problems);

Surface read_contact(const Section& top, Problems& problems);

/// At least one kind: without any [[kind]] the default brick.
std::vector<BrickKind> read_kinds(const Section& top, const Surface& surface, Problems& problems);

}  // namespace topple

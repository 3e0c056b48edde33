/// [[pair]]: what two kinds do to each other when the rule is not good enough.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "layout/section.h"
#include "topple/layout.h"

namespace topple {

/// Index of the kind of this name; a problem of `key` where there is none.
std::optional<std::uint16_t> find_kind(Section& section, std::string_view key, const std::string& name, std::span<const BrickKind> kinds);

/// The layout must have its kinds, and no pairs yet.
std::vector<SurfacePair> read_pairs(const Section& top, Layout& layout, Problems& problems);

}  // namespace topple

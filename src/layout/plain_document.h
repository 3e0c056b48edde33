/// The reader of plain documents: the part of TOML in which nearly all layouts are written, read some eight times as fast as the whole.
#pragma once

#include <optional>
#include <string_view>

#include "layout/document.h"

namespace topple {

/// The same tree as parse_document(), if the text is plain throughout: ASCII; tables and lists of tables with one bare key; bare keys;
/// strings without escapes, whole numbers, decimal numbers of up to 15 digits, true, false, and lists of these. Nothing for any other
/// text, right or wrong.
std::optional<Node> parse_plain(std::string_view text);

}  // namespace topple

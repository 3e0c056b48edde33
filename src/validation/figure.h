/// The figure of a source: published points with error bars, our predictions as bands, lines or points.
#pragma once

#include <filesystem>

#include "validation/judge.h"

namespace topple::validation {

Result<void> draw_figure(const Judged& judged, const std::filesystem::path& path);

}  // namespace topple::validation

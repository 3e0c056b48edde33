/// The page: every source with its figure, what was published, what we predict, the verdict.
#pragma once

#include <filesystem>
#include <span>

#include "validation/judge.h"

namespace topple::validation {

Result<void> write_page(std::span<const Judged> all, std::span<const SourceReport> reports, const std::filesystem::path& folder);

}  // namespace topple::validation

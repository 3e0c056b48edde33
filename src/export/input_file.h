/// Files of people, whole.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "topple/base.h"

namespace topple {

/// The bytes of a file, or of a pipe, and of more than `most` one more, so that who reads them can say so. `what` is what it should be: "a
/// layout file".
Result<std::string> read_bytes(const std::filesystem::path& path, std::size_t most, const std::string& what);

}  // namespace topple

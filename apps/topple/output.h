/// Files that a verb makes.
#pragma once

#include <filesystem>
#include <string>

namespace topple::app {

/// Why no file can be made at `path`; empty where nothing is known against it. Asked before long work is done for the file.
std::string no_place_for(const std::filesystem::path& path);

/// Standard output, to its last byte: false where it could not be written, after saying why.
bool output_is_whole();

}  // namespace topple::app

/// What a person is told whose command line cannot be understood.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace topple::app {

/// The option library's errors in plain words, and where to look; ends with a new line.
std::string misuse_words(const CLI::App* program, const CLI::Error& error);

}  // namespace topple::app

/// What a person is told whose command line cannot be understood.
#pragma once

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string>

namespace topple::app {

/// The option library's errors in plain words, and where to look; ends with a new line.
std::string misuse_words(const CLI::App* program, const CLI::Error& error);

// Checks of a value, which say the value and what is allowed.
CLI::Validator whole_number(int least, int most);
CLI::Validator number(double least, double most);
CLI::Validator one_of(std::initializer_list<const char*> words);

}  // namespace topple::app

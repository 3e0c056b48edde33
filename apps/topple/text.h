/// Text for people: numbers as they are read, messages where they belong.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "topple/base.h"

namespace topple::app {

/// As printf.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

/// "1,234,567".
std::string grouped(std::int64_t number);

/// "1.4 kB", "12 MB".
std::string byte_size(std::uint64_t bytes);

/// "1 brick", "3 bricks".
std::string count_of(std::int64_t number, const std::string& noun);

/// "a, b or c", with `last` between the last two.
std::string listed(const std::vector<std::string>& words, const char* last);

/// Prints an error to standard error as it is and gives back the exit code.
int complain(const Error& error, int exit_code);
int complain(const std::string& message, int exit_code);

}  // namespace topple::app

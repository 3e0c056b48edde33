/// The options of a verb, as the verb declares them. Only options.cpp, misuse.cpp and main.cpp see the library that reads the command line:
/// its templates take longer to compile than all else in a verb.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace topple::app {

/// Why a value cannot be taken, naming it; empty: it can.
using Check = std::function<std::string(const std::string& value)>;

Check whole_number(std::int64_t least, std::int64_t most);
Check number(double least, double most);
Check one_of(std::initializer_list<const char*> words);

/// What is said of an option when it is added.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(option) {}
  Option& required();
  Option& type_name(const std::string& name);  ///< What stands for its value in the help; empty: nothing.
  Option& check(const Check& check);           ///< Of every value.
  Option& delimiter(char between);             ///< One word may hold several values.
  Option& one_word();                          ///< Of a list: what follows a value is no further value of the same option.

 private:
  CLI::Option& option_;
};

/// `names` are "-o,--out" or, for a word that is no option, "LAYOUT".
class Options {
 public:
  explicit Options(CLI::App& app) : app_(app) {}
  Option add_option(const std::string& names, std::string& value, const std::string& help);
  Option add_option(const std::string& names, std::filesystem::path& value, const std::string& help);
  Option add_option(const std::string& names, int& value, const std::string& help);
  Option add_option(const std::string& names, std::int64_t& value, const std::string& help);
  Option add_option(const std::string& names, double& value, const std::string& help);
  Option add_option(const std::string& names, std::vector<std::string>& values, const std::string& help);
  void add_flag(const std::string& names, bool& value, const std::string& help);
  void footer(const std::string& words);  ///< The end of the help, in place of the usual one.

 private:
  CLI::App& app_;
};

}  // namespace topple::app

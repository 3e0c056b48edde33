#include "options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

#include "text.h"

namespace topple::app {
namespace {

// Whether all of a text is one number of this range.
template <typename Number>
bool is_within(const std::string& text, Number least, Number most) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, value);
  return problem == std::errc() && stop == end && value >= least && value <= most;
}

}  // namespace

Check whole_number(std::int64_t least, std::int64_t most) {
  return [=](const std::string& text) {
    return is_within(text, least, most)
               ? std::string()
               : "'" + text + "' is not a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  };
}

Check number(double least, double most) {
  return [=](const std::string& text) {
    return is_within(text, least, most) ? std::string() : formatted("'%s' is not a number from %g to %g", text.c_str(), least, most);
  };
}

Check one_of(std::initializer_list<const char*> words) {
  return [all = std::vector<std::string>(words.begin(), words.end())](const std::string& text) {
    const bool known = std::find(all.begin(), all.end(), text) != all.end();
    return known ? std::string() : "'" + text + "' is not " + listed(all, "or");
  };
}

Option& Option::required() {
  option_.required();
  return *this;
}

Option& Option::type_name(const std::string& name) {
  option_.type_name(name);
  return *this;
}

Option& Option::check(const Check& check) {
  option_.check(CLI::Validator([check](const std::string& value) { return check(value); }, ""));
  return *this;
}

Option& Option::delimiter(char between) {
  option_.delimiter(between);
  return *this;
}

Option& Option::one_word() {
  option_.allow_extra_args(false);
  return *this;
}

Option Options::add_option(const std::string& names, std::string& value, const std::string& help) {
  return Option(*app_.add_option(names, value, help));
}

Option Options::add_option(const std::string& names, std::filesystem::path& value, const std::string& help) {
  return Option(*app_.add_option(names, value, help));
}

Option Options::add_option(const std::string& names, int& value, const std::string& help) {
  return Option(*app_.add_option(names, value, help));
}

Option Options::add_option(const std::string& names, std::int64_t& value, const std::string& help) {
  return Option(*app_.add_option(names, value, help));
}

Option Options::add_option(const std::string& names, double& value, const std::string& help) {
  return Option(*app_.add_option(names, value, help));
}

Option Options::add_option(const std::string& names, std::vector<std::string>& values, const std::string& help) {
  return Option(*app_.add_option(names, values, help));
}

void Options::add_flag(const std::string& names, bool& value, const std::string& help) { app_.add_flag(names, value, help); }

void Options::footer(const std::string& words) { app_.footer(words); }

}  // namespace topple::app

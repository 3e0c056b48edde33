#include "misuse.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

#include "text.h"

namespace topple::app {
namespace {

/// "a, b or c".
std::string listed(const std::vector<std::string>& words, const char* last) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    list += (i == 0 ? "" : i + 1 < words.size() ? ", " : std::string(" ") + last + " ") + words[i];
  }
  return list;
}

std::string names_of_verbs(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* verb : program.get_subcommands([](const CLI::App*) { return true; })) names.push_back(verb->get_name());
  return listed(names, "and");
}

std::string unknown_word(const std::string& command, const std::string& word) {
  return "'" + word + (word.starts_with('-') ? "' is no option of " : "' is one word too many for ") + command + ".";
}

/// The library counts: "--until: At Most 1 required but received 2", "--out: 1 required FILE missing".
std::string miscount(const std::string& words) {
  const std::string option = words.substr(0, words.find(':'));
  if (words.find("At Most 1 required") != std::string::npos) return option + " is given more than once.";
  if (words.ends_with(" missing")) return option + " needs a value.";
  return words;
}

// Whether all of a text is one number of this range.
template <typename Number>
bool is_within(const std::string& text, Number least, Number most) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, value);
  return problem == std::errc() && stop == end && value >= least && value <= most;
}

}  // namespace

std::string misuse_words(const CLI::App* program, const CLI::Error& error) {
  const std::vector<CLI::App*> chosen = program->get_subcommands();
  const std::string command = chosen.empty() ? "topple" : "topple " + chosen.front()->get_name();
  const std::vector<std::string> unknown = (chosen.empty() ? program : chosen.front())->remaining();
  std::string words = error.what();
  if (chosen.empty()) {
    words = (unknown.empty() ? "A command is missing" : "'" + unknown.front() + "' is no command of topple") + "; there are " +
            names_of_verbs(*program) + ".";
  } else if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !unknown.empty()) {
    words = unknown_word(command, unknown.front());
  } else if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    words = miscount(words);
  }
  return words + "\n`" + command + " --help` says more.\n";
}

CLI::Validator whole_number(int least, int most) {
  const auto check = [=](const std::string& text) {
    return is_within(text, least, most) ? std::string() : formatted("'%s' is not a whole number from %d to %d", text.c_str(), least, most);
  };
  return {check, ""};
}

CLI::Validator number(double least, double most) {
  const auto check = [=](const std::string& text) {
    return is_within(text, least, most) ? std::string() : formatted("'%s' is not a number from %g to %g", text.c_str(), least, most);
  };
  return {check, ""};
}

CLI::Validator one_of(std::initializer_list<const char*> words) {
  const std::vector<std::string> all(words.begin(), words.end());
  const auto check = [all](const std::string& text) {
    const bool known = std::find(all.begin(), all.end(), text) != all.end();
    return known ? std::string() : "'" + text + "' is not " + listed(all, "or");
  };
  return {check, ""};
}

}  // namespace topple::app

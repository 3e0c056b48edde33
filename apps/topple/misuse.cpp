#include "misuse.h"

#include <vector>

#include "text.h"

namespace topple::app {
namespace {

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

}  // namespace topple::app

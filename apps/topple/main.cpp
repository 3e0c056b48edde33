/// The program `topple`: finds the verb and lets it do its work.
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "interrupt.h"
#include "misuse.h"
#include "output.h"
#include "topple/run.h"
#include "verb.h"

namespace topple::app {
namespace {

std::vector<std::unique_ptr<Verb>> all_verbs() {
  std::vector<std::unique_ptr<Verb>> verbs;
  verbs.push_back(layout_verb());
  verbs.push_back(picture_verb());
  verbs.push_back(plan_verb());
  verbs.push_back(run_verb());
  verbs.push_back(times_verb());
  verbs.push_back(risk_verb());
  verbs.push_back(show_verb());
  verbs.push_back(studio_verb());
  verbs.push_back(render_verb());
  verbs.push_back(plot_verb());
  verbs.push_back(export_verb());
  verbs.push_back(replay_verb());
  verbs.push_back(convergence_verb());
  verbs.push_back(validate_verb());
  return verbs;
}

/// Every way of misusing the command line is the same bad input; help and version are no misuse.
int exit_code_of(const CLI::App& program, const CLI::ParseError& error) {
  const int code = program.exit(error);
  return code == 0 ? kDone : kBadInput;
}

int run_program(int argc, char** argv) {
  CLI::App program("Topple plans, predicts and shows domino runs.", "topple");
  // With the lanes, which a report of a slow run is not whole without: they hang on the processor and not on the version.
  program.set_version_flag("--version", "topple " TOPPLE_VERSION ", up to " + std::to_string(most_lanes()) + " lanes on this processor",
                           "Print the version, and how many lanes --lanes can ask for");
  program.set_help_flag("-h,--help", "Print this help");
  program.require_subcommand(1);
  program.failure_message(misuse_words);
  program.footer(
      "Exit codes: 0 done (also when a wave dies), 2 bad input, 130 interrupted, 1 anything else.\n\n"
      "Example:\n  topple run scenes/report_row.toml");

  std::vector<std::unique_ptr<Verb>> verbs = all_verbs();
  std::vector<std::pair<CLI::App*, Verb*>> choices;
  for (const std::unique_ptr<Verb>& verb : verbs) {
    CLI::App* options = program.add_subcommand(verb->name(), verb->purpose());
    options->set_help_flag("-h,--help", "Print this help");
    options->footer(std::string("Example:\n  ") + verb->example());
    Options declared(*options);
    verb->declare(declared);
    choices.emplace_back(options, verb.get());
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return exit_code_of(program, error);
  }
  for (const auto& [options, verb] : choices) {
    if (options->parsed()) {
      return verb->run();
    }
  }
  return kBadInput;
}

}  // namespace
}  // namespace topple::app

int main(int argc, char** argv) {
  topple::app::watch_for_interrupt();
  try {
    const int code = topple::app::run_program(argc, argv);
    return topple::app::output_is_whole() || code != topple::app::kDone ? code : topple::app::kFailed;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "topple cannot go on: %s\n", error.what());
    return topple::app::kFailed;
  }
}

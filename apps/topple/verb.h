/// The verbs of the command line: each is one file and knows its own options.
#pragma once

#include <memory>
#include <vector>

#include "options.h"

namespace topple::app {

enum ExitCode : int {
  kDone = 0,           ///< Also when a wave dies.
  kFailed = 1,         ///< Anything that is nobody's bad input: a full disk, a missing program, a replay that differs.
  kBadInput = 2,       ///< A file, an option or a value that cannot be used.
  kInterrupted = 130,  ///< Ctrl-C while running.
};

class Verb {
 public:
  virtual ~Verb() = default;
  virtual const char* name() const = 0;
  virtual const char* purpose() const = 0;     ///< One line for the list of verbs.
  virtual const char* example() const = 0;     ///< A shell line that works in the project's folder.
  virtual void declare(Options& options) = 0;  ///< Adds its options.
  virtual int run() = 0;                       ///< After parsing; gives the exit code.
};

std::unique_ptr<Verb> layout_verb();
std::unique_ptr<Verb> picture_verb();
std::unique_ptr<Verb> plan_verb();
std::unique_ptr<Verb> run_verb();
std::unique_ptr<Verb> times_verb();
std::unique_ptr<Verb> risk_verb();
std::unique_ptr<Verb> replay_verb();
std::unique_ptr<Verb> plot_verb();
std::unique_ptr<Verb> export_verb();
std::unique_ptr<Verb> show_verb();
std::unique_ptr<Verb> studio_verb();
std::unique_ptr<Verb> render_verb();
std::unique_ptr<Verb> convergence_verb();
std::unique_ptr<Verb> validate_verb();

}  // namespace topple::app

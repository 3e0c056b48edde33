/// What a verb works on: a recording from its file, or one made on the spot by running a layout.
#pragma once

#include <expected>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "options.h"
#include "topple/run.h"

namespace topple::app {

/// The options with which a layout is run, the same for every verb.
struct RunOptions {
  std::filesystem::path file;
  std::string model;                                       ///< Short for the setting model.name; empty: as the layout says.
  std::vector<std::string> settings;                       ///< "key=value", over what the layout says.
  double until = std::numeric_limits<double>::infinity();  ///< [s]
  int threads = 1;
  int lanes = 0;               ///< 0: as many as the processor has.
  Profile* profile = nullptr;  ///< Where the time goes; null where nobody asks.
};

/// Adds the file (called `what` in the help) and the options above.
void declare(Options& app, RunOptions& options, const std::string& what);

/// The settings as the layout reader takes them, --model among them.
std::vector<std::string> overrides_of(const RunOptions& options);

/// What else is to be done while a layout runs; returning false stops it.
using Watch = std::function<bool(const Recording&)>;

/// Runs a layout with a progress bar. On failure the error has been printed and the exit code is given.
std::expected<Recording, int> run_layout(const RunOptions& options, const Watch& watch = {});

/// Reads a recording, or runs a layout: which of the two a file is its first bytes say.
/// A run that Ctrl-C cut short is given up: that is what there is no use in plotting.
std::expected<Recording, int> open_recording(const RunOptions& options);

/// Whether a file is a recording; then it has been said that `verb` takes a layout.
bool refused_as_recording(const std::filesystem::path& file, const std::string& verb);

bool is_recording(const std::filesystem::path& file);

}  // namespace topple::app

#include "source.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

#include "interrupt.h"
#include "progress.h"
#include "text.h"
#include "topple/export.h"
#include "verb.h"

namespace topple::app {
namespace {

constexpr std::string_view kMagic = "TOPPLE01";
constexpr int kMostThreads = 1024;

/// "key=value" with a key, else a sentence for the option library.
std::string check_setting(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  return equals == std::string::npos || equals == 0 ? "'" + setting + "' is not of the form key=value" : std::string();
}

std::string check_duration(const std::string& text) {
  double value = 0.0;
  const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(begin, end, value);
  return problem == std::errc() && stop == end && std::isfinite(value) && value > 0.0 ? std::string()
                                                                                      : "'" + text + "' is not a time above 0 s";
}

/// Options that steer a run say nothing about one that was run already.
std::string useless_option(const RunOptions& options) {
  if (!options.model.empty()) {
    return "--model";
  }
  if (!options.settings.empty()) {
    return "--set";
  }
  return std::isfinite(options.until) ? "--until" : "";
}

}  // namespace

void declare(Options& app, RunOptions& options, const std::string& what) {
  app.add_option(what, options.file,
                 what == "LAYOUT" ? "A layout file (.toml)" : "A recording (.topple), or a layout file (.toml), which is run first")
      .required()
      .type_name("");
  app.add_option("--model", options.model,
                 "The model (pivot, hinge or rigid), over what the layout says; settings that the layout has for another one do not hold")
      .type_name("NAME")
      .check(one_of({"pivot", "hinge", "rigid"}));
  app.add_option("--set", options.settings,
                 "A setting over what the layout says, as often as needed: a dotted key of the file, or one of [model]")
      .type_name("KEY=VALUE")
      .one_word()
      .check(check_setting);
  app.add_option("--until", options.until, "Stop at this simulated time [s]").type_name("S").check(check_duration);
  app.add_option("--threads", options.threads, "Threads, 1 to 1024 (default 1); the result does not depend on it")
      .type_name("N")
      .check(whole_number(1, kMostThreads));
  app.add_option(
         "--lanes", options.lanes,
         "Numbers that rigid works on side by side (1, 2 or 4); without it as many as the processor has; the result does not depend "
         "on it")
      .type_name("N")
      .check(one_of({"1", "2", "4"}));
}

std::vector<std::string> overrides_of(const RunOptions& options) {
  std::vector<std::string> overrides;
  if (!options.model.empty()) {
    overrides.push_back("model.name=" + options.model);
  }
  overrides.insert(overrides.end(), options.settings.begin(), options.settings.end());
  return overrides;
}

std::expected<Recording, int> run_layout(const RunOptions& options, const Watch& watch) {
  Result<Layout> layout = load_layout(options.file, overrides_of(options));
  if (!layout) {
    return std::unexpected(complain(layout.error(), kBadInput));
  }
  const Result<ModelConfig> model = model_config(*layout);
  if (!model) {
    return std::unexpected(complain(model.error(), kBadInput));
  }
  Progress bar;
  RunConfig config;
  config.until = options.until;
  config.threads = options.threads;
  config.lanes = options.lanes;
  config.profile = options.profile;
  config.watch = [&](const RunProgress& progress, const Recording& recording) {
    bar.show(progress);
    return !interrupted() && (!watch || watch(recording));
  };
  Result<Recording> recording = simulate(std::move(*layout), *model, config);
  bar.clear();
  if (!recording) {
    return std::unexpected(complain(recording.error(), kBadInput));
  }
  return std::move(*recording);
}

bool is_recording(const std::filesystem::path& file) {
  if (file.extension() == ".topple") {
    return true;
  }
  std::array<char, kMagic.size()> start{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), start.size());
  return stream && std::string_view(start.data(), start.size()) == kMagic;
}

bool refused_as_recording(const std::filesystem::path& file, const std::string& verb) {
  if (!is_recording(file)) return false;
  complain(file.string() + " is a recording; " + verb + " takes a layout. `topple replay` runs a recording's recipe again.", kBadInput);
  return true;
}

std::expected<Recording, int> open_recording(const RunOptions& options) {
  if (!is_recording(options.file)) {
    std::expected<Recording, int> recording = run_layout(options);
    if (recording && interrupted()) {
      return std::unexpected(complain("Interrupted: the run is not whole, nothing was made of it.", kInterrupted));
    }
    return recording;
  }
  const std::string useless = useless_option(options);
  if (!useless.empty()) {
    return std::unexpected(
        complain(useless + " is for running a layout; " + options.file.string() + " is a recording, which was run already.", kBadInput));
  }
  Result<Recording> recording = load_recording(options.file);
  if (!recording) {
    return std::unexpected(complain(recording.error(), kBadInput));
  }
  if (recording->end().reason == EndReason::running) {
    complain(
        formatted("%s was cut off before its run ended; what is there goes up to %.4g s.", options.file.c_str(), recording->duration()),
        kDone);
  }
  return std::move(*recording);
}

}  // namespace topple::app

/// `topple replay`: whether a recording's recipe still gives the same motion.
#include <cstdio>

#include "interrupt.h"
#include "progress.h"
#include "source.h"
#include "summary.h"
#include "text.h"
#include "verb.h"

namespace topple::app {
namespace {

class ReplayVerb final : public Verb {
 public:
  const char* name() const override { return "replay"; }
  const char* purpose() const override { return "Run a recording's recipe again and compare the hashes, step by step"; }
  const char* example() const override { return "topple run scenes/report_row.toml --out row.topple && topple replay row.topple"; }

  void declare(Options& app) override { app::declare(app, options_, "FILE"); }

  int run() override {
    const std::expected<Recording, int> recording = open_recording(options_);
    if (!recording) {
      return recording.error();
    }
    Progress bar;
    RunConfig config;
    config.threads = options_.threads;
    config.lanes = options_.lanes;
    config.watch = [&bar](const RunProgress& progress, const Recording&) {
      bar.show(progress);
      return !interrupted();
    };
    const Result<ReplayVerdict> verdict = replay(*recording, config);
    bar.clear();
    if (interrupted()) {
      return complain("Interrupted: nothing is known of the replay.", kInterrupted);
    }
    if (!verdict) {
      return complain(verdict.error(), kBadInput);
    }
    std::printf("%s\n  %-12s %s\n  %-12s %s\n", verdict->words.c_str(), "recorded", hash_digits(verdict->recorded_hash).c_str(), "replayed",
                hash_digits(verdict->replayed_hash).c_str());
    return verdict->same ? kDone : kFailed;
  }

 private:
  RunOptions options_;
};

}  // namespace

std::unique_ptr<Verb> replay_verb() { return std::make_unique<ReplayVerb>(); }

}  // namespace topple::app

/// `topple run`: from a layout to a summary and, if wanted, a recording on disk that grows with the run.
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "interrupt.h"
#include "output.h"
#include "source.h"
#include "summary.h"
#include "text.h"
#include "topple/export.h"
#include "topple/profile.h"
#include "verb.h"

namespace topple::app {
namespace {

/// The recording's file, written while the run goes on: what is on disk stays there if the program is killed.
class GrowingFile {
 public:
  explicit GrowingFile(std::filesystem::path path) : path_(std::move(path)) {}

  /// Writes what was finished, a few times a second, and lets the memory of it go; false once writing failed.
  bool grow(const Recording& recording) {
    const auto now = std::chrono::steady_clock::now();
    if (path_.empty() || now < next_) {
      return true;
    }
    next_ = now + std::chrono::milliseconds(250);
    if (!open(recording) || !keep(file_->append())) return false;
    file_->let_go();
    return true;
  }

  bool finish(const Recording& recording) {
    return path_.empty() || (!error_ && open(recording) && keep(file_->append()) && keep(file_->finish()));
  }

  const std::optional<Error>& error() const { return error_; }

  /// Of a file that could not be finished: its whole pieces can still be read.
  std::string what_is_left() const { return file_ ? "\nWhat was recorded before is in " + path_.string() + ".part, and can be read." : ""; }

 private:
  bool open(const Recording& recording) {
    if (!file_) {
      Result<RecordingFile> file = RecordingFile::create(recording, path_);
      if (!file) {
        error_ = file.error();
        return false;
      }
      file_.emplace(std::move(*file));
    }
    return true;
  }

  bool keep(const Result<void>& result) {
    if (!result) {
      error_ = result.error();
    }
    return result.has_value();
  }

  std::filesystem::path path_;
  std::chrono::steady_clock::time_point next_;
  std::optional<RecordingFile> file_;
  std::optional<Error> error_;
};

class RunVerb final : public Verb {
 public:
  const char* name() const override { return "run"; }
  const char* purpose() const override { return "Run a layout and print what happened"; }
  const char* example() const override { return "topple run scenes/report_row.toml --set time_step_s=0.00025 --out row.topple"; }

  void declare(Options& app) override {
    app::declare(app, options_, "LAYOUT");
    app.add_option("-o,--out", out_, "Write the recording to this file while the run goes on").type_name("FILE.topple");
    app.add_flag("--profile", with_profile_, "Print where the time went, stage by stage of a step");
    app.add_flag("--json", json_, "Print one JSON object and nothing else to standard output");
  }

  int run() override {
    if (refused_as_recording(options_.file, "run")) return kBadInput;
    if (!out_.empty() && out_.extension() != ".topple") {
      return complain("--out " + out_.string() + ": a recording's name ends in .topple; `topple export` makes other files of it.",
                      kBadInput);
    }
    if (const std::string why = out_.empty() ? "" : no_place_for(out_); !why.empty()) return complain(why, kFailed);
    if (with_profile_) {
      options_.profile = &profile_;
    }
    GrowingFile file(out_);
    const std::expected<Recording, int> recording = run_layout(options_, [&file](const Recording& so_far) { return file.grow(so_far); });
    if (!recording) {
      return recording.error();
    }
    const bool whole = file.finish(*recording);
    if (!whole) complain(file.error()->message + file.what_is_left(), kFailed);
    print(*recording, whole);
    if (!whole) return kFailed;
    if (interrupted()) {
      return kInterrupted;
    }
    return recording->end().reason == EndReason::not_finite ? kFailed : kDone;
  }

 private:
  void print(const Recording& recording, bool recorded) const {
    if (json_) {
      nlohmann::ordered_json json = summary_json(recording);
      json["recording"] = out_.empty() || !recorded ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(out_.string());
      if (with_profile_) {
        json["lanes"] = profile_.lanes() > 0 ? nlohmann::ordered_json(profile_.lanes()) : nlohmann::ordered_json(nullptr);
        json["profile"] = profile_json();
      }
      std::printf("%s\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
      return;
    }
    std::fputs(summary_text(recording).c_str(), stdout);
    const Cost cost = cost_so_far();
    std::printf("  %-12s %.2f s, %.2f s of processor time, %s of memory\n", "cost", cost.wall, cost.cpu,
                byte_size(cost.peak_memory).c_str());
    if (!out_.empty() && recorded) {
      std::error_code unknown;
      const std::uintmax_t size = std::filesystem::file_size(out_, unknown);
      std::printf("  %-12s %s, %s\n", "recording", out_.string().c_str(), byte_size(unknown ? 0 : size).c_str());
    }
    if (with_profile_) {
      if (profile_.lanes() > 0) std::printf("  %-12s %d\n", "lanes", profile_.lanes());
      print_profile();
    }
  }

  nlohmann::ordered_json profile_json() const {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const Profile::Row& row : profile_.rows()) {
      rows.push_back({{"stage", row.stage}, {"depth", row.depth}, {"calls", row.calls}, {"time_s", row.time}});
    }
    return rows;
  }

  void print_profile() const {
    std::printf("\n  %-32s %12s %10s %7s\n", "stage", "calls", "time", "share");
    const double whole = profile_.time();
    for (const Profile::Row& row : profile_.rows()) {
      const std::string stage = std::string(static_cast<std::size_t>(2 * row.depth), ' ') + std::string(row.stage);
      std::printf("  %-32s %12s %8.2f s %5.1f %%\n", stage.c_str(), grouped(row.calls).c_str(), row.time, 100.0 * row.time / whole);
    }
  }

  RunOptions options_;
  bool with_profile_ = false;
  Profile profile_;
  std::filesystem::path out_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> run_verb() { return std::make_unique<RunVerb>(); }

}  // namespace topple::app

/// `topple validate`: published measurements against the models, verdicts, and whether what we claim holds.
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "interrupt.h"
#include "json_value.h"
#include "text.h"
#include "topple/validation.h"
#include "verb.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Where finished runs are kept: $XDG_CACHE_HOME/topple, or ~/.cache/topple.
fs::path usual_kept_file() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache == '/')
    return fs::path(cache) / "topple/validation.jsonl";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/') return fs::path(home) / ".cache/topple/validation.jsonl";
  return "validation.jsonl";
}

/// The folder of the sources: in the working directory, in the tree the program was built in, or installed.
fs::path usual_sources() {
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown).parent_path();
  for (const fs::path& place :
       {fs::path("validation"), program / "../../validation", program / "../../../../validation", program / "../share/topple/validation"}) {
    if (fs::is_directory(place, unknown)) return place.lexically_normal();
  }
  return "validation";
}

/// Runs done, on standard error: a bar on a terminal, a line every few seconds elsewhere.
class Counter {
 public:
  void show(std::size_t done, std::size_t all) {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return;
    const bool terminal = isatty(STDERR_FILENO) != 0;
    next_ = now + std::chrono::milliseconds(terminal ? 100 : 5000);
    const double took = std::chrono::duration<double>(now - start_).count();
    if (took < 1.0) return;
    const std::string words = formatted("%zu of %zu runs, %.0f s", done, all, took);
    std::fprintf(stderr, terminal ? "\r%s\033[K" : "%s\n", words.c_str());
    drawn_ = terminal;
  }
  void clear() const {
    if (drawn_) std::fprintf(stderr, "\r\033[K");
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point next_ = start_;
  bool drawn_ = false;
};

Json json_of(const SourceReport& report) {
  Json json{
      {"name", report.name}, {"title", report.title}, {"kind", report.kind}, {"comparisons", Json::array()}, {"claims", Json::array()}};
  for (const Comparison& one : report.comparisons) {
    json["comparisons"].push_back({{"name", one.name},
                                   {"model", one.model},
                                   {"reading", one.reading},
                                   {"verdict", words_of(one.verdict)},
                                   {"worst_at_defaults", number_json(one.worst_default)},
                                   {"worst_at_best", number_json(one.worst_best)},
                                   {"best", one.best},
                                   {"point_fits", one.point_fits},
                                   {"words", one.words}});
  }
  for (const ClaimCheck& one : report.claims) {
    json["claims"].push_back({{"name", one.name}, {"holds", one.holds}, {"found", one.found}, {"why", one.why}});
  }
  return json;
}

class ValidateVerb final : public Verb {
 public:
  const char* name() const override { return "validate"; }
  const char* purpose() const override { return "Compare the models with published measurements"; }
  const char* example() const override { return "topple validate --quick"; }

  void declare(Options& app) override {
    app.add_option("NAME", config_.names, "Only these sources (folders of validation/)").type_name("");
    app.add_flag("--quick", config_.quick, "Only what takes seconds; the rest is left out");
    app.add_flag("--json", json_, "Print one JSON object and nothing else to standard output");
    app.add_option("--html", page_, "Write the page and its figures into this folder").type_name("DIR");
    app.add_option("--threads", config_.threads, "Runs at the same time, 1 to 256 (default 1)").type_name("N").check(whole_number(1, 256));
    app.add_flag("--fresh", config_.fresh, "Run everything again, whatever is kept");
    app.add_option("--kept", kept_, "Where finished runs are kept (default: in ~/.cache/topple)").type_name("FILE");
    app.add_option("--sources", sources_, "The folder of the sources (default: validation)").type_name("DIR");
    app.footer(
        "Exit codes: 0 every claim holds, 1 one does not, 2 bad input, 130 interrupted (finished runs are kept).\n\nExample:\n  topple "
        "validate --quick");
  }

  int run() override {
    config_.cases = sources_.empty() ? usual_sources() : sources_;
    config_.kept = kept_.empty() ? usual_kept_file() : kept_;
    Result<Validation> validation = Validation::open(config_);
    if (!validation) return complain(validation.error(), kBadInput);
    Counter counter;
    const Result<bool> ran = validation->run([&counter](std::size_t done, std::size_t all) {
      counter.show(done, all);
      return !interrupted();
    });
    counter.clear();
    if (!ran) return complain(ran.error(), kFailed);
    const std::string& not_kept = validation->not_kept();
    if (!not_kept.empty()) complain(not_kept, kDone);
    if (!*ran)
      return complain(not_kept.empty() ? "Interrupted; what was run is kept in " + config_.kept.string() + "." : "Interrupted.",
                      kInterrupted);
    if (!page_.empty()) {
      if (const Result<void> written = validation->write_page(page_); !written) return complain(written.error(), kFailed);
      std::fprintf(stderr, "Wrote %s\n", (page_ / "index.html").string().c_str());
    }
    return print(validation->reports());
  }

 private:
  int print(std::span<const SourceReport> reports) const {
    std::size_t holding = 0, failing = 0;
    Json sources = Json::array();
    for (const SourceReport& report : reports) {
      for (const ClaimCheck& claim : report.claims) ++(claim.holds ? holding : failing);
      json_ ? sources.push_back(json_of(report)) : print(report);
    }
    if (json_) {
      const Json json{{"version", TOPPLE_VERSION},
                      {"quick", config_.quick},
                      {"claims_holding", holding},
                      {"claims_failing", failing},
                      {"sources", sources}};
      std::printf("%s\n", json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    } else {
      std::printf("%zu claims hold, %zu do not\n", holding, failing);
    }
    return failing == 0 ? kDone : kFailed;
  }

  static void print(const SourceReport& report) {
    std::printf("%s  (%s)\n", report.title.c_str(), report.name.c_str());
    for (const Comparison& one : report.comparisons) {
      const std::string name = one.name + (one.reading.empty() ? "" : ", " + one.reading);
      std::printf("  %-38s %s\n", name.c_str(), one.words.c_str());
    }
    for (const ClaimCheck& claim : report.claims) {
      std::printf("  %-6s %s: %s\n", claim.holds ? "holds" : "FAILS", claim.name.c_str(), claim.found.c_str());
    }
    std::printf("\n");
  }

  ValidationConfig config_;
  bool json_ = false;
  fs::path page_, kept_, sources_;
};

}  // namespace

std::unique_ptr<Verb> validate_verb() { return std::make_unique<ValidateVerb>(); }

}  // namespace topple::app

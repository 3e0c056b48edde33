/// `topple show`: the page with this recording, served to the browsers of this machine until Ctrl-C.
#include <spawn.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

#include "interrupt.h"
#include "native_run.h"
#include "page_server.h"
#include "recording_bytes.h"
#include "source.h"
#include "summary.h"
#include "text.h"
#include "verb.h"

namespace topple::app {
namespace {

bool has_desktop() {
  const auto set = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  return set("DISPLAY") || set("WAYLAND_DISPLAY");
}

/// Asks the desktop to open the address; whatever comes of it, the address has been printed.
void open_browser(const std::string& address) {
  std::signal(SIGCHLD, SIG_IGN);  // Nobody waits for the browser.
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&files, stream, "/dev/null", stream == STDIN_FILENO ? 0 : 1, 0);
  }
  std::string program = "xdg-open";
  std::string argument = address;
  char* arguments[] = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  posix_spawnp(&child, program.c_str(), &files, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&files);
}

class ShowVerb final : public Verb {
 public:
  const char* name() const override { return "show"; }
  const char* purpose() const override { return "Show a recording in the browser, from this machine to this machine only"; }
  const char* example() const override { return "topple show scenes/report_row.toml --port 8100 --no-browser"; }

  void declare(Options& app) override {
    app::declare(app, options_, "RECORDING");
    app.add_option("--port", port_, "The port, 1 to 65535 (default 8017, or the next one that is free)")
        .type_name("N")
        .check(whole_number(1, 65535));
    app.add_flag("--no-browser", no_browser_, "Only print the address");
  }

  int run() override {
    const Result<std::filesystem::path> page = find_page();
    if (!page) {
      return complain(page.error(), kFailed);
    }
    Result<Site> site = read_page(*page);
    if (!site) {
      return complain(site.error(), kFailed);
    }
    std::expected<std::string, int> summary = add_recording(*site);
    if (!summary) {
      return summary.error();
    }
    const NativeRuns runs(options_.threads, options_.lanes);
    runs.offer(*site);
    Result<PageServer> server = PageServer::listen(std::move(*site), port_);
    if (!server) {
      return complain(server.error(), kFailed);
    }
    runs.serve(*server);
    std::printf("%s\nOpen %s (Ctrl-C ends it)\n", summary->c_str(), server->address().c_str());
    std::fflush(stdout);
    if (!no_browser_ && has_desktop()) {
      open_browser(server->address());
    }
    return server->serve_until(interrupted) ? kDone : complain("The server stopped: this machine's network gave up.", kFailed);
  }

 private:
  /// Puts the recording and its summary beside the page's files and gives the summary for people.
  std::expected<std::string, int> add_recording(Site& site) const {
    const std::expected<Recording, int> recording = open_recording(options_);
    if (!recording) {
      return std::unexpected(recording.error());
    }
    constexpr auto kReplaceBadText = nlohmann::json::error_handler_t::replace;
    site["/recording.topple"] = {"application/octet-stream", recording_bytes(*recording), "no-store"};
    site["/summary.json"] = {"application/json", summary_json(*recording).dump(2, ' ', false, kReplaceBadText), "no-store"};
    return summary_text(*recording);
  }

  RunOptions options_;
  int port_ = 0;
  bool no_browser_ = false;
};

}  // namespace

std::unique_ptr<Verb> show_verb() { return std::make_unique<ShowVerb>(); }

}  // namespace topple::app

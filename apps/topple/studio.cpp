/// `topple studio`: the page to draw in, served to this machine, or written as plain files for any server.
#include <cstdio>
#include <fstream>

#include "interrupt.h"
#include "native_run.h"
#include "page_server.h"
#include "text.h"
#include "topple/export.h"
#include "verb.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;

class StudioVerb final : public Verb {
 public:
  const char* name() const override { return "studio"; }
  const char* purpose() const override { return "Draw layouts in the browser; or write the page as plain files for any server"; }
  const char* example() const override { return "topple studio --export site"; }

  void declare(Options& app) override {
    app.add_option("--export", folder_, "Write the page's files into this folder instead of serving them").type_name("DIR");
    app.add_option("--port", port_, "The port, 1 to 65535 (default 8017, or the next one that is free)")
        .type_name("N")
        .check(whole_number(1, 65535));
  }

  int run() override {
    const Result<fs::path> page = find_page();
    if (!page) return complain(page.error(), kFailed);
    Result<Site> site = read_page(*page);
    if (!site) return complain(site.error(), kFailed);
    return folder_.empty() ? serve(std::move(*site)) : write(*site);
  }

 private:
  int serve(Site site) const {
    const NativeRuns runs(1);
    runs.offer(site);
    Result<PageServer> server = PageServer::listen(std::move(site), port_);
    if (!server) return complain(server.error(), kFailed);
    runs.serve(*server);
    std::printf("Open %s (Ctrl-C ends it)\n", server->address().c_str());
    std::fflush(stdout);
    return server->serve_until(interrupted) ? kDone : complain("The server stopped: this machine's network gave up.", kFailed);
  }

  int write(const Site& site) const {
    std::error_code problem;
    if (fs::exists(folder_, problem) && !fs::is_directory(folder_, problem)) {
      return complain("--export " + folder_.string() + ": is a file; name a folder.", kBadInput);
    }
    if (fs::exists(folder_, problem) && !fs::is_empty(folder_, problem) && !fs::is_regular_file(folder_ / "index.html", problem)) {
      return complain(
          "--export " + folder_.string() + ": the folder holds other things; name one that is new, empty, or an export of before.",
          kBadInput);
    }
    std::uintmax_t bytes = 0;
    std::size_t files = 0;
    fs::create_directories(folder_, problem);
    if (problem) return complain("--export " + folder_.string() + ": cannot be made: " + problem.message(), kFailed);
    // Empty, so that a server has an answer where the page asks; what somebody has put there stays.
    for (const char* place : {"recording.topple", "summary.json"}) {
      if (!fs::exists(folder_ / place, problem)) std::ofstream(folder_ / place, std::ios::binary);
    }
    for (const auto& [address, content] : site) {
      if (address == "/") continue;  // index.html again
      const fs::path file = folder_ / address.substr(1);
      fs::create_directories(file.parent_path(), problem);
      if (const Result<void> written = save_bytes(content.bytes, file); !written) return complain(written.error(), kFailed);
      bytes += content.bytes.size();
      ++files;
    }
    std::printf("%s: %zu files, %s. Any web server can serve them; a recording in the place of the empty recording.topple is played.\n",
                folder_.string().c_str(), files, byte_size(bytes).c_str());
    return kDone;
  }

  fs::path folder_;
  int port_ = 0;
};

}  // namespace

std::unique_ptr<Verb> studio_verb() { return std::make_unique<StudioVerb>(); }

}  // namespace topple::app

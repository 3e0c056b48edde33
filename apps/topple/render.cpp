/// `topple render`: a film without a window. The page draws it, frame by frame, in a browser that nobody sees, and hands the file over.
#include <unistd.h>

#include <atomic>
#include <charconv>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "film_browser.h"
#include "interrupt.h"
#include "output.h"
#include "page_server.h"
#include "recording_bytes.h"
#include "source.h"
#include "text.h"
#include "topple/export.h"
#include "verb.h"

namespace topple::app {
namespace {

constexpr int kLeastSide = 16;
constexpr int kMostSide = 7680;

struct Pair {
  int first = 0;
  int second = 0;
};

/// Two whole numbers with a letter between them.
std::optional<Pair> read_pair(const std::string& text, char between) {
  Pair pair;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, pair.first);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != between) return std::nullopt;
  const auto second = std::from_chars(first.ptr + 1, end, pair.second);
  if (second.ec != std::errc() || second.ptr != end) return std::nullopt;
  return pair;
}

/// "1280x720", else a sentence for the option library.
std::string check_size(const std::string& text) {
  const std::optional<Pair> size = read_pair(text, 'x');
  const auto in_range = [](int side) { return side >= kLeastSide && side <= kMostSide; };
  const bool good = size && in_range(size->first) && in_range(size->second);
  return good ? "" : "'" + text + "' is not WIDTHxHEIGHT with sides from 16 to 7680 pixels";
}

/// What the page has handed over so far; written by the server's thread.
struct Delivery {
  std::atomic<bool> over = false;
  std::atomic<bool> good = false;
  std::atomic<int> done = 0, of = 0;
  std::string body;  ///< The film, or why there is none; read once it is over.

  void take(const std::string& what, std::string bytes) {
    if (what == "progress") {
      if (const auto pair = read_pair(bytes, '/')) {
        done = pair->first;
        of = pair->second;
      }
      return;
    }
    if (over) return;
    body = std::move(bytes);
    good = what == "film";
    over = true;
  }
};

class RenderVerb final : public Verb {
 public:
  const char* name() const override { return "render"; }
  const char* purpose() const override { return "Make a film, without a window"; }
  const char* example() const override {
    return "topple render scenes/s_curve.toml -o s_curve.mp4 --camera front --size 1280x720 --fps 30";
  }

  void declare(Options& app) override {
    app::declare(app, options_, "RECORDING");
    app.add_option("-o,--out", out_, "The film: a name that ends in .mp4 or .webm").type_name("FILE").required();
    app.add_option("--camera", camera_, "still, orbit, front, eye or top (default still)")
        .type_name("NAME")
        .check(one_of({"still", "orbit", "front", "eye", "top"}));
    app.add_option("--size", size_, "Width and height in pixels (default 1280x720)").type_name("WxH").check(check_size);
    app.add_option("--fps", fps_, "Frames a second, 1 to 240 (default 30)").type_name("N").check(whole_number(1, 240));
    app.add_option("--speed", speed_, "Seconds of the run in a second of the film, 0.001 to 1000 (default 1)")
        .type_name("X")
        .check(number(0.001, 1000.0));
    app.add_option("--samples", samples_, "Pictures averaged into a frame, 1 to 256; more give soft shadows and depth of field (default 1)")
        .type_name("N")
        .check(whole_number(1, 256));
    app.add_flag("--no-sound", silent_, "Without the clicks of the hits");
    app.add_flag("--forces", forces_, "With what presses on what as arrows at the contacts (hinge and rigid)");
    app.add_flag("--dark", dark_, "On the dark table");
  }

  int run() override {
    const std::string format = out_.extension() == ".mp4" ? "mp4" : out_.extension() == ".webm" ? "webm" : "";
    if (format.empty()) return complain("--out " + out_.string() + ": a film's name ends in .mp4 or .webm.", kBadInput);
    if (const std::string why = no_place_for(out_); !why.empty()) return complain(why, kFailed);
    const Result<std::filesystem::path> page = find_page();
    if (!page) return complain(page.error(), kFailed);
    Result<Site> site = read_page(*page);
    if (!site) return complain(site.error(), kFailed);
    const std::expected<Recording, int> recording = open_recording(options_);
    if (!recording) return recording.error();
    (*site)["/recording.topple"] = {"application/octet-stream", recording_bytes(*recording), "no-store"};
    return film(std::move(*site), order_for(format));
  }

 private:
  nlohmann::json order_for(const std::string& format) const {
    const Pair size = read_pair(size_, 'x').value_or(Pair{});
    return {{"format", format}, {"camera", camera_}, {"width", size.first}, {"height", size.second}, {"fps", fps_},
            {"speed", speed_},  {"from", 0},         {"sound", !silent_},   {"samples", samples_},   {"theme", dark_ ? "dark" : "light"},
            {"forces", forces_}};
  }

  int film(Site site, nlohmann::json order) {
    const std::string token = make_token();
    order["token"] = token;
    site["/render.json"] = {"application/json", order.dump(), "no-store"};
    Delivery delivery;
    Result<PageServer> server = PageServer::listen(std::move(site), 0);
    if (!server) return complain(server.error(), kFailed);
    server->receive(token, [&](const std::string& what, std::string bytes) { delivery.take(what, std::move(bytes)); });
    Result<FilmBrowser> browser = FilmBrowser::start(server->address() + "?render=" + token);
    if (!browser) return complain(browser.error(), kFailed);
    std::atomic<bool> enough = false;
    std::thread watcher([&] { watch(delivery, *browser, enough); });
    static std::atomic<bool>* stop = nullptr;
    stop = &enough;
    const bool served = server->serve_until([] { return stop->load(); });
    enough = true;
    watcher.join();
    if (!served) return complain("The server stopped: this machine's network gave up.", kFailed);
    return keep(delivery, *browser);
  }

  static void watch(const Delivery& delivery, FilmBrowser& browser, std::atomic<bool>& enough) {
    const bool seen = isatty(STDERR_FILENO) != 0;
    int told = -1;
    while (!enough && !delivery.over && !interrupted() && browser.running()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      const int done = delivery.done;
      if (seen && done != told) std::fprintf(stderr, "\r%d of %d frames ", done, delivery.of.load());
      told = done;
    }
    if (seen && told > 0) std::fprintf(stderr, "\r%40s\r", "");
    enough = true;
  }

  int keep(const Delivery& delivery, const FilmBrowser& browser) const {
    if (interrupted()) return complain("Interrupted: no film was made.", kInterrupted);
    if (!delivery.over) return complain("Chromium ended before the film was made. It said:\n" + browser.last_words(), kFailed);
    if (!delivery.good) return complain("No film was made. " + delivery.body, kFailed);
    if (const Result<void> written = save_bytes(delivery.body, out_); !written) return complain(written.error(), kFailed);
    std::printf("%s: %d frames, %s\n", out_.string().c_str(), delivery.of.load(), byte_size(delivery.body.size()).c_str());
    return kDone;
  }

  RunOptions options_;
  std::filesystem::path out_;
  std::string camera_ = "still";
  std::string size_ = "1280x720";
  int fps_ = 30;
  double speed_ = 1.0;
  int samples_ = 1;
  bool silent_ = false;
  bool forces_ = false;
  bool dark_ = false;
};

}  // namespace

std::unique_ptr<Verb> render_verb() { return std::make_unique<RenderVerb>(); }

}  // namespace topple::app

#include "native_run.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "text.h"
#include "topple/run.h"

namespace topple::app {
namespace {

constexpr std::size_t kMostText = std::size_t{256} << 20U;  // [bytes] of a layout
constexpr std::chrono::milliseconds kLook{100};             // a closed page is noticed after so long
constexpr std::chrono::milliseconds kStretch{10};
constexpr int kLooksWaited = 50;  // for a run whose page has stopped it, until this is noticed and another one may begin

void append(const std::vector<std::uint8_t>& piece, std::string& bytes) { bytes.append(piece.begin(), piece.end()); }

/// Holds the one place there is for a run, until it is destroyed.
class Place {
 public:
  explicit Place(std::shared_ptr<std::atomic<bool>> taken) : taken_(std::move(taken)) {}
  ~Place() { *taken_ = false; }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

 private:
  std::shared_ptr<std::atomic<bool>> taken_;
};

/// A run under way and what of its recording has not been sent yet.
class NativeRun {
 public:
  explicit NativeRun(Simulation simulation, std::unique_ptr<Place> place)
      : place_(std::move(place)), simulation_(std::move(simulation)), writer_(simulation_.recording()) {}

  bool next(std::string& bytes) {
    if (over_) return false;
    if (!begun_) {
      begun_ = true;
      append(writer_.begin(), bytes);
      return true;
    }
    over_ = !advance();
    if (over_) {
      append(writer_.end(), bytes);
      place_.reset();  // Before the page can know that the run is over, and order the next one.
    } else {
      for (auto piece = writer_.more(); !piece.empty(); piece = writer_.more()) append(piece, bytes);
    }
    return true;
  }

 private:
  /// Goes on for a moment; false once the run is over.
  bool advance() {
    const auto began = std::chrono::steady_clock::now();
    for (auto now = began; now - began < kLook;) {
      if (!simulation_.advance(steps_)) return false;
      const auto then = std::chrono::steady_clock::now();
      if (then - now < kStretch) steps_ *= 2;
      if (then - now > 2 * kStretch && steps_ > 1) steps_ /= 2;
      now = then;
    }
    return true;
  }

  std::unique_ptr<Place> place_;
  Simulation simulation_;
  RecordingWriter writer_;
  std::int64_t steps_ = 1;
  bool begun_ = false;
  bool over_ = false;
};

/// Takes the one place there is, soon if not at once. @returns Whether it was to be had.
bool take_place(std::atomic<bool>& taken) {
  for (int look = 0; taken.exchange(true); ++look) {
    if (look == kLooksWaited) return false;
    std::this_thread::sleep_for(kLook);
  }
  return true;
}

std::expected<NextBytes, Refusal> begin(const std::string& text, int threads, int lanes, const std::shared_ptr<std::atomic<bool>>& taken) {
  constexpr int kBusy = 503, kBadLayout = 422;
  if (!take_place(*taken)) return std::unexpected(Refusal{kBusy, "This program is running another layout; one at a time."});
  auto place = std::make_unique<Place>(taken);
  Result<Layout> layout = read_layout(text, "layout.toml");
  if (!layout) return std::unexpected(Refusal{kBadLayout, layout.error().message});
  const Result<ModelConfig> model = model_config(*layout);
  if (!model) return std::unexpected(Refusal{kBadLayout, model.error().message});
  RunConfig config;
  config.threads = threads;
  config.lanes = lanes;
  Result<Simulation> simulation = Simulation::start(std::move(*layout), *model, config);
  if (!simulation) return std::unexpected(Refusal{kBadLayout, simulation.error().message});
  auto run = std::make_shared<NativeRun>(std::move(*simulation), std::move(place));
  return [run](std::string& bytes) { return run->next(bytes); };
}

}  // namespace

void NativeRuns::offer(Site& site) const {
  const char* recording = site.contains("/recording.topple") ? "yes" : "no";
  for (const char* address : {"/", "/index.html"}) {
    const auto page = site.find(address);
    if (page == site.end()) continue;
    std::string& html = page->second.bytes;
    const std::string head = "<head>";
    const std::size_t at = html.find(head);
    if (at == std::string::npos) continue;
    html.insert(at + head.size(),
                formatted("\n    <meta name=\"topple-native\" content=\"%s/run\" data-bricks=\"%d\" data-recording=\"%s\" />",
                          token_.c_str(), kNativeBricks, recording));
    page->second.cache = "no-store";
  }
}

void NativeRuns::serve(PageServer& server) const {
  auto taken = std::make_shared<std::atomic<bool>>(false);
  server.stream(token_, kMostText,
                [threads = threads_, lanes = lanes_, taken](const std::string& text) { return begin(text, threads, lanes, taken); });
}

}  // namespace topple::app

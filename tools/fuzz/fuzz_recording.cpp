// Any bytes are either a recording that can be asked everything and written again as it was, or an error in words with its place. The
// checks of the pieces are made to agree first, so that what is behind them is reached. `fuzz_recording --seeds FOLDER` writes what to
// begin from.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "recording/crc32.h"
#include "recording/format.h"
#include "topple/recording.h"

namespace {

using Bytes = std::vector<std::uint8_t>;

void require(bool claim, const char* what) {
  if (claim) return;
  std::fprintf(stderr, "broken: %s\n", what);
  std::abort();
}

bool finite(const topple::Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void repair_checks(Bytes& bytes) {
  for (std::size_t at = 8; at + topple::format::kHeader <= bytes.size();) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + at + 8, sizeof length);
    const std::size_t payload = at + topple::format::kHeader;
    if (length > bytes.size() - payload) return;
    const std::uint32_t check = topple::crc32(std::span(bytes).subspan(payload, length));
    std::memcpy(bytes.data() + at + 4, &check, sizeof check);
    at = payload + topple::format::round_up(length);
  }
}

Bytes written(const topple::Recording& recording) {
  topple::RecordingWriter writer(recording);
  Bytes bytes = writer.begin();
  const Bytes end = writer.end();
  bytes.insert(bytes.end(), end.begin(), end.end());
  return bytes;
}

void ask_bricks(const topple::Recording& recording) {
  std::vector<topple::Track> tracks;
  const topple::BrickId bricks = std::min<topple::BrickId>(recording.layout().brick_count(), 100);
  for (topple::BrickId brick = 0; brick < bricks; ++brick) {
    recording.tracks_of(brick, tracks);
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      require(tracks[i].brick == brick, "a brick's tracks are its own");
      require(tracks[i].hinged.empty() != tracks[i].free.empty(), "a track is hinged or free");
      require(i == 0 || tracks[i].start >= tracks[i - 1].start, "a brick's tracks are in the order of time");
      for (const double later : {-0.001, 0.0, 0.0007, 0.013, 1.0, 1e9}) {
        const topple::BrickState state = recording.at(brick, tracks[i].start + later);
        require(finite(state.pose.position), "a brick is always somewhere");
        require(std::isfinite(state.pose.orientation.w), "a brick is always turned some way");
      }
    }
  }
}

void check_recording(const topple::Recording& recording) {
  ask_bricks(recording);
  const topple::BrickId bricks = recording.layout().brick_count();
  for (std::int64_t i = 0; i < recording.event_count(); ++i) {
    const topple::Event event = recording.event(i);
    require(event.brick >= 0 && event.brick < bricks && event.by >= topple::kNoBrick && event.by < bricks, "an event has its bricks");
    require(event.time <= recording.duration(), "nothing happens after the end");
  }
  const Bytes once = written(recording);
  const auto again = topple::read_recording(once, "again.topple");
  require(again.has_value(), "what was written can be read");
  require(written(*again) == once, "what was read is written as it was");
}

/// Two bricks, the second hit by the first, in ten steps.
class TwoBricks : public topple::Model {
 public:
  topple::Status step() override { return {++steps_ < 10 ? topple::Progress::running : topple::Progress::at_rest, topple::kNoBrick}; }
  std::int64_t step_count() const override { return steps_; }
  double time_step() const override { return 0.0005; }
  void read(topple::Frame& out) const override {
    const double time = time_step() * static_cast<double>(steps_);
    out.time = time;
    out.energy = {0.1, -0.1, 0.2};
    out.hinged.assign(1, {0, topple::Phase::falling, {4.0 * time, 4.0, 0.0}});
    if (steps_ > 5) out.hinged.push_back({1, topple::Phase::falling, {2.0 * (time - 0.0024), 2.0, 0.0}});
    out.kinks.clear();
    if (steps_ == 5) out.kinks.assign(1, {1, 0.0024, {}, {0.0, 2.0, 0.0}});
  }
  std::span<const topple::Event> events() const override { return {events_.data(), steps_ == 5 ? events_.size() : 0}; }
  std::span<const topple::Contact> contacts() const override { return {}; }
  std::uint64_t hash() const override { return 0x123456789ABCDEFULL * static_cast<std::uint64_t>(steps_); }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<topple::Event> events_ = {{0.0024, topple::EventKind::struck, 1, 0, 5.0, kNone, {0.02, 0.0, 0.04}},
                                        {0.0024, topple::EventKind::arrived, 0, topple::kNoBrick, kNone, kNone, {kNone, kNone, kNone}}};
  std::int64_t steps_ = 0;
};

topple::Recording two_bricks() {
  auto layout = topple::read_layout("[[row]]\ncount = 2\npitch_mm = 24\n", "two.toml");
  require(layout.has_value(), "the seed's layout can be read");
  topple::Recording recording(std::move(*layout), {"0.1.0", "pivot", 0.0005});
  topple::Recorder recorder(recording, {});
  TwoBricks model;
  bool running = true;
  while (running) {
    running = model.step().progress == topple::Progress::running;
    recorder.take(model);
  }
  recorder.finish({topple::EndReason::at_rest, topple::kNoBrick, 10, 0.005, model.hash(), "at rest"});
  return recording;
}

// The same with a free track of brick 1, later than its hinged one, before the end.
Bytes with_free_track(Bytes bytes) {
  Bytes piece;
  topple::format::Sink sink(piece);
  sink.begin(topple::format::kFree);
  sink.put(std::uint32_t{1});
  sink.put(std::uint32_t{2});
  sink.put(1.0);
  sink.put(std::uint32_t{1});
  sink.align();
  sink.put(std::uint32_t{2});
  for (int column = 0; column < 14; ++column) {
    sink.align();
    sink.put(column == 4 ? 1.0F : 0.0F);
    sink.put(column == 4 ? 1.0F : 0.01F);
  }
  sink.end();
  const std::string_view energy = topple::format::kEnergy;
  const auto place = std::search(bytes.begin(), bytes.end(), energy.begin(), energy.end());
  bytes.insert(place, piece.begin(), piece.end());
  return bytes;
}

void write_seed(const std::filesystem::path& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  if (*count != 3 || std::string_view((*words)[1]) != "--seeds") return 0;
  const std::filesystem::path folder = (*words)[2];
  const Bytes plain = written(two_bricks());
  require(topple::read_recording(plain, "seed").has_value(), "the seed can be read");
  const Bytes free = with_free_track(plain);
  require(topple::read_recording(free, "seed").has_value(), "the seed with a free track can be read");
  write_seed(folder / "plain.topple", plain);
  write_seed(folder / "free.topple", free);
  write_seed(folder / "cut.topple", {plain.begin(), plain.begin() + static_cast<std::ptrdiff_t>(plain.size() * 2 / 3)});
  std::exit(0);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  Bytes input(bytes, bytes + count);
  repair_checks(input);
  const auto recording = topple::read_recording(input, "fuzz.topple");
  if (recording) {
    check_recording(*recording);
  } else {
    require(recording.error().message.starts_with("fuzz.topple: "), "an error begins with the file's name");
  }
  return 0;
}

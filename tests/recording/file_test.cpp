#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "recording/crc32.h"
#include "recording/format.h"
#include "recording/scripted_model.h"

using namespace topple;
using namespace topple::scripted;

namespace {

constexpr std::string_view kScene = "title = \"three\"\n[[row]]\ncount = 3\npitch_mm = 24\n";

// A script that also reports two events.
class EventfulScript : public HingedScript {
 public:
  using HingedScript::HingedScript;
  std::span<const Event> events() const override {
    if (step_count() == 30) return {kEvents, 2};
    return {};
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  static constexpr Event kEvents[2] = {{0.0149, EventKind::struck, 1, 0, 5.07034, 0.0021, {0.0203, 0.0, 0.0426}},
                                       {0.015, EventKind::arrived, 0, kNoBrick, kNone, kNone, {kNone, kNone, kNone}}};
};

Recording three_bricks() {
  EventfulScript script(wave(3), 0.0005);
  auto layout = read_layout(kScene, "three.toml");
  REQUIRE(layout.has_value());
  return record(std::move(*layout), script);
}

std::vector<std::uint8_t> bytes_of(const Recording& recording) {
  RecordingWriter writer(recording);
  std::vector<std::uint8_t> bytes = writer.begin();
  for (auto more = writer.more(); !more.empty(); more = writer.more()) bytes.insert(bytes.end(), more.begin(), more.end());
  const auto end = writer.end();
  bytes.insert(bytes.end(), end.begin(), end.end());
  return bytes;
}

struct Piece {
  std::string type;
  std::size_t at;
  std::size_t length;
};
std::vector<Piece> pieces_of(const std::vector<std::uint8_t>& bytes) {
  std::vector<Piece> pieces;
  for (std::size_t at = 8; at + 16 <= bytes.size();) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + at + 8, 8);
    pieces.push_back({{bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.begin() + static_cast<std::ptrdiff_t>(at + 4)}, at, length});
    at += 16 + (length + 7) / 8 * 8;
  }
  return pieces;
}
const Piece& piece(const std::vector<Piece>& pieces, std::string_view type) {
  for (const Piece& p : pieces) {
    if (p.type == type) return p;
  }
  FAIL("no piece " << type);
  return pieces[0];
}

// Changes a number in the payload of a piece and makes its check agree again.
template <typename T>
std::vector<std::uint8_t> forged(std::vector<std::uint8_t> bytes, std::string_view type, std::size_t offset, T value) {
  const Piece p = piece(pieces_of(bytes), type);
  std::memcpy(bytes.data() + p.at + 16 + offset, &value, sizeof value);
  const std::uint32_t check = crc32(std::span(bytes).subspan(p.at + 16, p.length));
  std::memcpy(bytes.data() + p.at + 4, &check, sizeof check);
  return bytes;
}

std::string error_of(const std::vector<std::uint8_t>& bytes) {
  const auto read = read_recording(bytes, "run.topple");
  REQUIRE_FALSE(read.has_value());
  MESSAGE(read.error().message);
  CHECK(read.error().message.starts_with("run.topple: "));
  return read.error().message;
}

}  // namespace

TEST_CASE("the check of a piece is that of zlib and PNG") {
  // The check value of the catalogue of CRC algorithms for "123456789".
  const std::string_view digits = "123456789";
  CHECK(crc32({reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size()}) == 0xCBF43926U);
}

TEST_CASE("a recording that is written and read again is the same") {
  const Recording before = three_bricks();
  const auto bytes = bytes_of(before);
  const auto after = read_recording(bytes, "run.topple");
  REQUIRE_MESSAGE(after.has_value(), after.error().message);
  CHECK(after->layout().bricks.size() == 3);
  CHECK(after->layout().text == kScene);
  CHECK(after->recipe().model == "scripted");
  CHECK(after->recipe().time_step == 0.0005);
  CHECK(after->duration() == before.duration());
  CHECK(after->tolerance() == before.tolerance());
  CHECK(after->end().reason == EndReason::at_rest);
  CHECK(after->end().hash == before.end().hash);
  CHECK(after->end().words == "at rest");
  CHECK(after->hashes().values == before.hashes().values);
  REQUIRE(after->energy().size() == before.energy().size());
  CHECK(after->energy().back().energy.kinetic == before.energy().back().energy.kinetic);
  REQUIRE(after->track_count() == before.track_count());
  for (std::int64_t i = 0; i < before.track_count(); ++i) {
    const Track a = before.track(i);
    const Track b = after->track(i);
    CHECK(a.brick == b.brick);
    CHECK(a.start == b.start);
    REQUIRE(a.hinged.size() == b.hinged.size());
    CHECK(std::memcmp(a.hinged.data(), b.hinged.data(), a.hinged.size() * sizeof(HingedKnot)) == 0);
  }
  CHECK(bytes_of(*after) == bytes);
}

TEST_CASE("an event keeps its force to four decimals, its place and what it does not have") {
  const auto read = read_recording(bytes_of(three_bricks()), "run.topple");
  REQUIRE(read.has_value());
  REQUIRE(read->event_count() == 2);
  const Event struck = read->event(0);
  CHECK(struck.time == 0.0149);
  CHECK(struck.kind == EventKind::struck);
  CHECK(struck.brick == 1);
  CHECK(struck.by == 0);
  CHECK(struck.force == doctest::Approx(5.07034).epsilon(1e-6));
  CHECK(struck.impulse == doctest::Approx(0.0021));
  CHECK(norm(struck.point - Vec3{0.0203, 0.0, 0.0426}) < 1e-8);
  const Event arrived = read->event(1);
  CHECK(arrived.kind == EventKind::arrived);
  CHECK(arrived.by == kNoBrick);
  CHECK(std::isnan(arrived.force));
  CHECK(std::isnan(arrived.point.x));
}

TEST_CASE("every payload and every piece begins at a multiple of 8") {
  const auto bytes = bytes_of(three_bricks());
  CHECK(bytes.size() % 8 == 0);
  std::string order;
  for (const Piece& p : pieces_of(bytes)) {
    CHECK(p.at % 8 == 0);
    order += p.type + " ";
  }
  CHECK(order == "RCPE SCEN BRIK HING EVNT ENRG HASH END_ ");
}

TEST_CASE("a file that grows with its run holds what the finished one holds") {
  Recording recording(*read_layout(kScene, "three.toml"), Recipe{"0.1.0", "scripted", 0.0005});
  HingedScript script(wave(3), 0.0005);
  Recorder recorder(recording, {});
  RecordingWriter writer(recording);
  auto bytes = writer.begin();
  while (script.step().progress == Progress::running) {
    recorder.take(script);
    const auto more = writer.more();
    bytes.insert(bytes.end(), more.begin(), more.end());
  }
  recorder.finish({EndReason::at_rest, kNoBrick, script.step_count(), script.time(), 1, "at rest"});
  const Recording moved = std::move(recording);
  const auto end = writer.end();
  bytes.insert(bytes.end(), end.begin(), end.end());
  const auto read = read_recording(bytes, "run.topple");
  REQUIRE(read.has_value());
  CHECK(read->track_count() == moved.track_count());
  CHECK(read->at(1, 0.07).hinge.angle == moved.at(1, 0.07).hinge.angle);
}

TEST_CASE("a file cut anywhere behind its scene gives its whole pieces, and says that it was cut") {
  const auto bytes = bytes_of(three_bricks());
  const auto pieces = pieces_of(bytes);
  const std::size_t scene_end = piece(pieces, "BRIK").at;
  for (std::size_t size = scene_end; size < bytes.size(); ++size) {
    const auto read = read_recording(std::span(bytes).first(size), "run.topple");
    const bool padding = size >= pieces.back().at + 16 + pieces.back().length;
    REQUIRE_MESSAGE(read.has_value(), "cut at " << size << ": " << read.error().message);
    CHECK(read->end().reason == (padding ? EndReason::at_rest : EndReason::running));
    CHECK((read->track_count() > 0) == (size >= piece(pieces, "HING").at + 16 + piece(pieces, "HING").length));
  }
  for (std::size_t size = 0; size < scene_end; ++size) {
    // The zero bytes after the scene do not matter.
    if (size >= piece(pieces, "SCEN").at + 16 + piece(pieces, "SCEN").length) continue;
    CHECK_FALSE(read_recording(std::span(bytes).first(size), "run.topple").has_value());
  }
}

TEST_CASE("a changed byte in any payload or check is found") {
  const auto bytes = bytes_of(three_bricks());
  for (const Piece& p : pieces_of(bytes)) {
    for (std::size_t at = p.at + 4; at < p.at + 16 + p.length; ++at) {
      if (at >= p.at + 8 && at < p.at + 16) continue;
      auto changed = bytes;
      changed[at] ^= 0x10;
      CHECK_FALSE(read_recording(changed, "run.topple").has_value());
    }
  }
}

TEST_CASE("a changed length is an error unless the rest of the file is gone with it") {
  const auto bytes = bytes_of(three_bricks());
  for (const Piece& p : pieces_of(bytes)) {
    for (std::size_t at = p.at + 8; at < p.at + 16; ++at) {
      auto changed = bytes;
      changed[at] ^= 0x10;
      const auto read = read_recording(changed, "run.topple");
      if (p.type == "END_") {
        if (read.has_value()) CHECK(read->end().reason == EndReason::running);
      } else {
        CHECK_FALSE(read.has_value());
      }
    }
  }
}

TEST_CASE("a foreign file is told from a recording of another version") {
  const std::string png = "\x89PNG\r\n\x1a\nand so on";
  CHECK(error_of({png.begin(), png.end()}).find("not a recording of Topple") != std::string::npos);
  CHECK(error_of({}).find("0 bytes") != std::string::npos);
  auto bytes = bytes_of(three_bricks());
  bytes[7] = '2';
  CHECK(error_of(bytes).find("version \"02\"") != std::string::npos);
}

TEST_CASE("counts that do not fit are errors, not allocations") {
  const auto bytes = bytes_of(three_bricks());
  constexpr std::uint32_t kHuge = 0xFFFFFFFF;
  for (const std::string_view type : {"HING", "EVNT", "ENRG"}) {
    CHECK(error_of(forged(bytes, type, 0, kHuge)).find(type) != std::string::npos);
    CHECK(error_of(forged(bytes, type, 0, std::uint32_t{1000})).find("counts") != std::string::npos);
  }
  CHECK_FALSE(read_recording(forged(bytes, "HING", 4, kHuge), "run.topple").has_value());
  CHECK_FALSE(read_recording(forged(bytes, "BRIK", 4, kHuge), "run.topple").has_value());
  CHECK_FALSE(read_recording(forged(bytes, "HASH", 8, std::uint64_t{1} << 61), "run.topple").has_value());
  CHECK_FALSE(read_recording(forged(bytes, "HASH", 0, std::uint64_t{0}), "run.topple").has_value());
  CHECK_FALSE(read_recording(forged(bytes, "RCPE", 0, kHuge), "run.topple").has_value());
}

TEST_CASE("bricks, times and knots that cannot be are errors") {
  const auto bytes = bytes_of(three_bricks());
  const double none = std::numeric_limits<double>::quiet_NaN();
  CHECK(error_of(forged(bytes, "BRIK", 8, 0.5)).find("brick 0 is not where the recipe puts it") != std::string::npos);
  CHECK_FALSE(read_recording(forged(bytes, "HING", 8, none), "run.topple").has_value());
  CHECK_FALSE(read_recording(forged(bytes, "HING", 8, -1.0), "run.topple").has_value());
  CHECK_FALSE(read_recording(forged(bytes, "HING", 8 + 3 * 8, std::uint32_t{3}), "run.topple").has_value());
  CHECK_FALSE(read_recording(forged(bytes, "EVNT", 8, none), "run.topple").has_value());
  CHECK_FALSE(read_recording(forged(bytes, "END_", 0, std::uint32_t{9}), "run.topple").has_value());
  CHECK_FALSE(read_recording(forged(bytes, "SCEN", 9, none), "run.topple").has_value());
}

TEST_CASE("tracks with the knots of another are read as it, kept once, and refer to one before them in their piece") {
  auto bytes = bytes_of(three_bricks());
  const std::vector<Piece> all = pieces_of(bytes);
  const Piece hinged = piece(all, "HING");
  Recording whole = *read_recording(bytes, "run.topple");
  REQUIRE(whole.track_count() == 3);
  // Two more tracks of bricks 0 and 1, later, with the knots of others: `first` and `second` say of which.
  const auto with = [&](std::uint32_t first, std::uint32_t second) {
    const auto old = std::span(bytes).subspan(hinged.at + 16, hinged.length);
    std::vector<std::uint8_t> made;
    format::Sink sink(made);
    const auto copy = [&](std::size_t at, std::size_t size) {
      sink.align();
      std::memcpy(sink.room(size), old.data() + at, size);
    };
    sink.begin("HING");
    sink.put(std::uint32_t{5});
    sink.put(static_cast<std::uint32_t>((old.size() - 64) / 16));
    copy(8, 24);
    sink.put(50.0);
    sink.put(60.0);
    copy(32, 12);
    sink.put(std::uint32_t{0});
    sink.put(std::uint32_t{1});
    copy(48, 12);
    sink.put(first);
    sink.put(second);
    copy(64, old.size() - 64);
    sink.end();
    auto file = bytes;
    const auto at = file.begin() + static_cast<std::ptrdiff_t>(hinged.at);
    file.erase(at, at + static_cast<std::ptrdiff_t>(16 + format::round_up(hinged.length)));
    file.insert(file.begin() + static_cast<std::ptrdiff_t>(hinged.at), made.begin(), made.end());
    return file;
  };
  constexpr std::uint32_t kSame = 0x80000000;
  const auto read = read_recording(with(kSame + 1, kSame), "run.topple");
  REQUIRE_MESSAGE(read.has_value(), (read ? std::string() : read.error().message));
  REQUIRE(read->track_count() == 5);
  for (const auto& [echo, owner] : {std::pair{3, 1}, std::pair{4, 0}}) {
    const Track one = read->track(echo);
    const Track other = whole.track(owner);
    CHECK(one.start == (echo == 3 ? 50.0 : 60.0));
    CHECK(one.brick == echo - 3);
    REQUIRE(one.hinged.size() == other.hinged.size());
    for (std::size_t k = 0; k < one.hinged.size(); ++k) CHECK(one.hinged[k].angle == other.hinged[k].angle);
  }
  CHECK(read->memory() == whole.memory());
  CHECK(bytes_of(*read) == with(kSame + 1, kSame));  // Written again as it was.
  CHECK(error_of(with(kSame + 4, kSame)).find("knots of none before it") != std::string::npos);
  CHECK(error_of(with(kSame + 1, kSame + 3)).find("knots of none before it") != std::string::npos);
  CHECK(error_of(with(kSame + 1, 0xFFFFFFFF)).find("knots of none before it") != std::string::npos);
}

TEST_CASE("tracks of a brick that are not in the order of time are an error, however short") {
  auto bytes = bytes_of(three_bricks());
  // In place of all hinged tracks two of brick 0, of one knot each.
  for (auto all = pieces_of(bytes); true; all = pieces_of(bytes)) {
    const auto hinged = std::find_if(all.begin(), all.end(), [](const Piece& p) { return p.type == "HING"; });
    if (hinged == all.end()) break;
    const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(hinged->at);
    bytes.erase(at, at + static_cast<std::ptrdiff_t>(16 + (hinged->length + 7) / 8 * 8));
  }
  const auto with = [&bytes](double first, double second) {
    std::vector<std::uint8_t> piece(16 + 72, 0);
    const auto put = [&piece](std::size_t at, auto value) { std::memcpy(piece.data() + at, &value, sizeof value); };
    std::memcpy(piece.data(), "HING", 4);
    put(8, std::uint64_t{72});
    put(16, std::uint32_t{2});
    put(20, std::uint32_t{2});
    put(24, first);
    put(32, second);
    put(48, std::uint32_t{1});
    put(52, std::uint32_t{1});
    put(4, crc32(std::span(piece).subspan(16)));
    auto file = bytes;
    file.insert(file.begin() + static_cast<std::ptrdiff_t>(pieces_of(file).back().at), piece.begin(), piece.end());
    return file;
  };
  CHECK(read_recording(with(0.0, 1e-7), "run.topple").has_value());
  CHECK(error_of(with(1e-7, 0.0)).find("begins before its last one begins") != std::string::npos);
}

TEST_CASE("a piece of an unknown type is skipped") {
  auto bytes = bytes_of(three_bricks());
  const Piece end = pieces_of(bytes).back();
  std::vector<std::uint8_t> extra(24, 0);
  std::memcpy(extra.data(), "FUTR", 4);
  extra[8] = 8;
  const std::uint32_t check = crc32(std::span(extra).subspan(16, 8));
  std::memcpy(extra.data() + 4, &check, 4);
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(end.at), extra.begin(), extra.end());
  const auto read = read_recording(bytes, "run.topple");
  REQUIRE(read.has_value());
  CHECK(read->end().reason == EndReason::at_rest);
}

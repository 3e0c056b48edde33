#include <algorithm>
#include <array>
#include <unordered_map>

#include "recording/crc32.h"
#include "recording/format.h"
#include "recording/store.h"

namespace topple {

namespace format {

void Sink::begin(std::string_view type) {
  bytes_.insert(bytes_.end(), type.begin(), type.end());
  bytes_.resize(bytes_.size() + kHeader - type.size());
  payload_ = bytes_.size();
}

void Sink::end() {
  const std::uint64_t length = bytes_.size() - payload_;
  const std::uint32_t check = crc32(std::span(bytes_).subspan(payload_));
  std::memcpy(bytes_.data() + payload_ - 12, &check, sizeof check);
  std::memcpy(bytes_.data() + payload_ - 8, &length, sizeof length);
  align();
}

}  // namespace format

namespace {

using format::Sink;

// So much in one call of more(), or a long run's end would double the memory it took.
constexpr std::int64_t kTracksAtOnce = 8192;
constexpr std::int64_t kEventsAtOnce = 32768;

std::uint32_t code_of(BrickId brick) { return brick == kNoBrick ? format::kNoBrickCode : static_cast<std::uint32_t>(brick); }

// One array: `value` of every item, from a multiple of 8 on.
template <typename Items, typename Value>
void column(Sink& sink, const Items& items, Value value) {
  using Number = decltype(value(*items.begin()));
  sink.align();
  std::uint8_t* next = sink.room(items.size() * sizeof(Number));
  for (const auto& item : items) {
    const Number number = value(item);
    std::memcpy(next, &number, sizeof number);
    next += sizeof number;
  }
}

void write_recipe(Sink& sink, const Layout& layout, const Recipe& recipe) {
  sink.begin(format::kRecipe);
  sink.text(recipe.version);
  sink.text(recipe.model);
  sink.text(layout.name);
  sink.text(layout.text);
  sink.put(recipe.time_step);
  sink.put(static_cast<std::uint32_t>(layout.overrides.size()));
  for (const std::string& entry : layout.overrides) sink.text(entry);
  sink.end();
}

void write_color(Sink& sink, const Color& color) {
  sink.put(color.red);
  sink.put(color.green);
  sink.put(color.blue);
}

void write_kind(Sink& sink, const BrickKind& kind) {
  sink.text(kind.name);
  const Surface& s = kind.surface;
  for (const double value :
       {kind.height, kind.width, kind.thickness, kind.mass, s.brick_friction, s.floor_friction, s.brick_restitution, s.floor_restitution}) {
    sink.put(value);
  }
  write_color(sink, kind.color);
}

struct PushNumbers {
  std::uint8_t way;
  double value, height, duration;
};
PushNumbers numbers_of(const AngularSpeedPush& push) { return {0, push.angular_speed, 0.0, 0.0}; }
PushNumbers numbers_of(const ForcePush& push) { return {1, push.force, push.height, push.duration}; }
PushNumbers numbers_of(const ImpulsePush& push) { return {2, push.impulse, push.height, 0.0}; }

void write_push(Sink& sink, const Push& push) {
  const PushNumbers numbers = std::visit([](const auto& how) { return numbers_of(how); }, push.how);
  sink.put(code_of(push.brick));
  sink.put(push.at);
  sink.put(numbers.way);
  sink.put(numbers.value);
  sink.put(numbers.height);
  sink.put(numbers.duration);
}

void write_scene(Sink& sink, const Layout& layout, double tolerance) {
  sink.begin(format::kScene);
  sink.text(layout.title);
  sink.put(layout.gravity);
  sink.put(tolerance);
  sink.put(static_cast<std::uint32_t>(layout.kinds.size()));
  for (const BrickKind& kind : layout.kinds) write_kind(sink, kind);
  sink.put(static_cast<std::uint32_t>(layout.colors.size()));
  for (const Color& color : layout.colors) write_color(sink, color);
  sink.put(static_cast<std::uint32_t>(layout.parts.size()));
  for (const Part& part : layout.parts) {
    sink.text(part.name);
    sink.put(static_cast<std::uint32_t>(part.first));
    sink.put(static_cast<std::uint32_t>(part.count));
  }
  sink.put(static_cast<std::uint32_t>(layout.pushes.size()));
  for (const Push& push : layout.pushes) write_push(sink, push);
  sink.end();
}

// Only where there are other shapes than boxes: a reader that does not know the piece loses nothing else.
void write_shapes(Sink& sink, const Layout& layout) {
  if (std::all_of(layout.kinds.begin(), layout.kinds.end(), [](const BrickKind& kind) { return kind.shape == Shape::box; })) return;
  sink.begin(format::kShapes);
  sink.put(static_cast<std::uint32_t>(layout.kinds.size()));
  column(sink, layout.kinds, [](const BrickKind& kind) { return static_cast<std::uint8_t>(kind.shape); });
  sink.end();
}

void write_bricks(Sink& sink, std::size_t first, std::span<const Brick> bricks) {
  sink.begin(format::kBricks);
  sink.put(static_cast<std::uint32_t>(first));
  sink.put(static_cast<std::uint32_t>(bricks.size()));
  column(sink, bricks, [](const Brick& b) { return b.foot.x; });
  column(sink, bricks, [](const Brick& b) { return b.foot.y; });
  column(sink, bricks, [](const Brick& b) { return b.foot.z; });
  column(sink, bricks, [](const Brick& b) { return b.heading; });
  column(sink, bricks, [](const Brick& b) { return b.kind; });
  column(sink, bricks, [](const Brick& b) { return b.color; });
  column(sink, bricks, [](const Brick& b) { return static_cast<std::uint8_t>(b.stance); });
  sink.end();
}

/// Tracks of one sort, one after the other.
template <typename Knot>
struct Tracks {
  struct Head {
    double start;
    BrickId brick;
    std::uint32_t knots;  // How many, or whose.
  };
  std::vector<Head> heads;
  std::vector<Knot> knots;
};

template <typename Knot>
void write_track_heads(Sink& sink, const Tracks<Knot>& tracks) {
  using Head = typename Tracks<Knot>::Head;
  sink.put(static_cast<std::uint32_t>(tracks.heads.size()));
  sink.put(static_cast<std::uint32_t>(tracks.knots.size()));
  column(sink, tracks.heads, [](const Head& head) { return head.start; });
  column(sink, tracks.heads, [](const Head& head) { return static_cast<std::uint32_t>(head.brick); });
  column(sink, tracks.heads, [](const Head& head) { return head.knots; });
}

void write_hinged(Sink& sink, const Tracks<HingedKnot>& tracks) {
  sink.begin(format::kHinged);
  write_track_heads(sink, tracks);
  for (const auto number : {&HingedKnot::time, &HingedKnot::angle, &HingedKnot::rate, &HingedKnot::acceleration}) {
    column(sink, tracks.knots, [number](const HingedKnot& knot) { return knot.*number; });
  }
  sink.end();
}

void write_free(Sink& sink, const Tracks<FreeKnot>& tracks) {
  sink.begin(format::kFree);
  write_track_heads(sink, tracks);
  for (const auto number : {&FreeKnot::time, &FreeKnot::x, &FreeKnot::y, &FreeKnot::z, &FreeKnot::qw, &FreeKnot::qx, &FreeKnot::qy,
                            &FreeKnot::qz, &FreeKnot::vx, &FreeKnot::vy, &FreeKnot::vz, &FreeKnot::wx, &FreeKnot::wy, &FreeKnot::wz}) {
    column(sink, tracks.knots, [number](const FreeKnot& knot) { return knot.*number; });
  }
  sink.end();
}

void write_events(Sink& sink, std::span<const EventStore::Entry> events) {
  using Entry = EventStore::Entry;
  sink.begin(format::kEvents);
  sink.put(static_cast<std::uint32_t>(events.size()));
  sink.put(std::uint32_t{0});
  column(sink, events, [](const Entry& e) { return e.time; });
  column(sink, events, [](const Entry& e) { return code_of(e.brick); });
  column(sink, events, [](const Entry& e) { return code_of(e.by); });
  column(sink, events, [](const Entry& e) { return static_cast<std::uint8_t>(e.kind); });
  column(sink, events, [](const Entry& e) { return e.load.force; });
  column(sink, events, [](const Entry& e) { return e.load.impulse; });
  column(sink, events, [](const Entry& e) { return e.load.x; });
  column(sink, events, [](const Entry& e) { return e.load.y; });
  column(sink, events, [](const Entry& e) { return e.load.z; });
  sink.end();
}

void write_energy(Sink& sink, std::span<const EnergySample> samples) {
  sink.begin(format::kEnergy);
  sink.put(static_cast<std::uint32_t>(samples.size()));
  sink.put(std::uint32_t{0});
  column(sink, samples, [](const EnergySample& s) { return s.time; });
  column(sink, samples, [](const EnergySample& s) { return s.energy.kinetic; });
  column(sink, samples, [](const EnergySample& s) { return s.energy.potential; });
  column(sink, samples, [](const EnergySample& s) { return s.energy.push_work; });
  sink.end();
}

void write_hashes(Sink& sink, const HashTrail& trail) {
  sink.begin(format::kHashes);
  sink.put(static_cast<std::uint64_t>(trail.stride));
  sink.put(static_cast<std::uint64_t>(trail.values.size()));
  for (const std::uint64_t value : trail.values) sink.put(value);
  sink.end();
}

void write_end(Sink& sink, const RunEnd& end) {
  sink.begin(format::kEnd);
  sink.put(static_cast<std::uint32_t>(end.reason));
  sink.put(code_of(end.brick));
  sink.put(static_cast<std::uint64_t>(end.step));
  sink.put(end.time);
  sink.put(end.hash);
  sink.text(end.words);
  sink.end();
}

/// The last few tracks of a piece that had knots of their own: bricks side by side echo a few at a time.
class Recent {
 public:
  /// The track of these knots, or -1.
  std::int64_t track_of(const std::uint8_t* code) const {
    for (const Known& known : known_) {
      if (known.code == code) return known.track;
    }
    return -1;
  }
  void add(const std::uint8_t* code, std::size_t track) { known_[next_++ % known_.size()] = {code, static_cast<std::int64_t>(track)}; }

 private:
  struct Known {
    const std::uint8_t* code = nullptr;
    std::int64_t track = -1;
  };
  std::array<Known, 8> known_;
  std::size_t next_ = 0;
};

}  // namespace

RecordingWriter::RecordingWriter(const Recording& recording) : store_(recording.store_.get()) {}

std::vector<std::uint8_t> RecordingWriter::begin() {
  const Layout& layout = store_->layout;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(layout.bricks.size() * 38 + layout.text.size() + 4096);
  Sink sink(bytes);
  std::memcpy(sink.room(format::kMagic.size()), format::kMagic.data(), format::kMagic.size());
  write_recipe(sink, layout, store_->recipe);
  write_scene(sink, layout, store_->tolerance);
  write_shapes(sink, layout);
  const std::span<const Brick> bricks = layout.bricks;
  for (std::size_t first = 0; first < bricks.size(); first += format::kBricksInPiece) {
    write_bricks(sink, first, bricks.subspan(first, std::min(format::kBricksInPiece, bricks.size() - first)));
  }
  return bytes;
}

std::vector<std::uint8_t> RecordingWriter::more() {
  std::vector<std::uint8_t> bytes;
  Sink sink(bytes);
  Tracks<HingedKnot> hinged;
  Tracks<FreeKnot> free;
  Recent recent;
  std::unordered_map<const std::uint8_t*, std::uint32_t> echoed;  // Free tracks that others echo, by their code.
  const TrackStore& store = store_->tracks;
  const auto tracks = static_cast<std::int64_t>(store.size());
  for (const std::int64_t last = std::min(tracks, tracks_ + kTracksAtOnce); tracks_ < last; ++tracks_) {
    const auto index = static_cast<std::int32_t>(tracks_);
    const double start = store.start_of(index);
    const BrickId brick = store.brick_of(index);
    if (const std::int64_t same = recent.track_of(store.code_of(index)); same >= 0) {
      hinged.heads.push_back({start, brick, format::kKnotsOfTrack + static_cast<std::uint32_t>(same)});
      continue;
    }
    if (store.is_echoed(index)) {
      const auto [known, is_new] = echoed.try_emplace(store.code_of(index), static_cast<std::uint32_t>(free.heads.size()));
      if (!is_new) {
        free.heads.push_back({start, brick, format::kKnotsOfTrack + known->second});
        continue;
      }
    }
    const TrackStore::Count count = store.read(index, hinged.knots, free.knots);
    if (count.hinged > 0) {
      recent.add(store.code_of(index), hinged.heads.size());
      hinged.heads.push_back({start, brick, static_cast<std::uint32_t>(count.hinged)});
    }
    if (count.free > 0) free.heads.push_back({start, brick, static_cast<std::uint32_t>(count.free)});
  }
  if (!hinged.heads.empty()) write_hinged(sink, hinged);
  if (!free.heads.empty()) write_free(sink, free);

  std::vector<EventStore::Entry> events;
  const auto all = static_cast<std::int64_t>(store_->events.size());
  for (const std::int64_t last = std::min(all, events_ + kEventsAtOnce); events_ < last; ++events_) {
    events.push_back(store_->events.entry(static_cast<std::size_t>(events_)));
  }
  if (!events.empty()) write_events(sink, events);
  return bytes;
}

void RecordingWriter::let_go() { store_->tracks.let_go(static_cast<std::size_t>(tracks_)); }

std::vector<std::uint8_t> RecordingWriter::end() {
  std::vector<std::uint8_t> bytes;
  for (std::vector<std::uint8_t> rest = more(); !rest.empty(); rest = more()) bytes.insert(bytes.end(), rest.begin(), rest.end());
  Sink sink(bytes);
  write_energy(sink, store_->energy);
  write_hashes(sink, store_->hashes);
  write_end(sink, store_->end);
  return bytes;
}

}  // namespace topple

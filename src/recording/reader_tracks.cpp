#include <algorithm>
#include <array>
#include <cmath>

#include "recording/reader.h"

namespace topple {
namespace {

using format::Column;
using format::Source;

constexpr double kLastTime = 1e12;  // [s]; later moments are no times.

bool is_time(double time) { return time >= 0.0 && time < kLastTime; }

/// The arrays of a HING or FREE piece, each knot with N numbers.
template <std::size_t N>
struct Tracks {
  std::size_t count = 0;
  Column<double> start;
  Column<std::uint32_t> brick;
  Column<std::uint32_t> knots;
  std::array<Column<float>, N> numbers;
  std::vector<std::size_t> first;  // Of the knots of each track.

  bool shared(std::size_t track) const { return knots[track] >= format::kKnotsOfTrack; }
  std::size_t owner(std::size_t track) const { return shared(track) ? knots[track] - format::kKnotsOfTrack : track; }
};

template <std::size_t N>
bool read_tracks(Source& source, Tracks<N>& tracks) {
  tracks.count = source.get<std::uint32_t>();
  const std::size_t knots = source.get<std::uint32_t>();
  tracks.start = source.column<double>(tracks.count);
  tracks.brick = source.column<std::uint32_t>(tracks.count);
  tracks.knots = source.column<std::uint32_t>(tracks.count);
  for (auto& column : tracks.numbers) column = source.column<float>(knots);
  if (!source.ok() || !source.at_end()) return false;
  std::uint64_t sum = 0;
  tracks.first.reserve(tracks.count);
  for (std::size_t i = 0; i < tracks.count; ++i) {
    tracks.first.push_back(sum);
    if (!tracks.shared(i)) sum += tracks.knots[i];
  }
  return sum == knots;
}

// Whether the times of one track grow from 0 or more and all numbers are finite.
template <std::size_t N>
bool sound(const Tracks<N>& tracks, std::size_t first, std::size_t count) {
  float last = 0.0F;
  for (std::size_t i = first; i < first + count; ++i) {
    for (const auto& column : tracks.numbers) {
      if (!std::isfinite(column[i])) return false;
    }
    if (tracks.numbers[0][i] < last) return false;
    last = tracks.numbers[0][i];
  }
  return true;
}

}  // namespace

// Whether a track is one of a brick that is there, with knots that are a motion or with those of a track before it.
template <typename Tracks>
RecordingReader::Done RecordingReader::check_head(const Tracks& tracks, std::size_t track, std::size_t offset) const {
  const std::uint32_t brick = tracks.brick[track];
  if (brick >= brick_count_) return wrong(offset, "a track of brick " + std::to_string(brick) + ", which is none");
  if (tracks.shared(track)) {
    if (tracks.owner(track) < track && !tracks.shared(tracks.owner(track))) return {};
    return wrong(offset, "a track of brick " + std::to_string(brick) + " with the knots of none before it");
  }
  if (tracks.knots[track] == 0) return wrong(offset, "a track without knots");
  if (!sound(tracks, tracks.first[track], tracks.knots[track]))
    return wrong(offset, "the knots of brick " + std::to_string(brick) + " are no motion");
  return {};
}

// A track begins where the last one of its brick ended or later.
RecordingReader::Done RecordingReader::check_start(BrickId brick, double start, double last_time, std::size_t offset) {
  TrackStore& tracks = recording_->store_->tracks;
  const auto words = [&](std::string_view what) {
    return wrong(offset, "a track of brick " + std::to_string(brick) + " " + std::string(what));
  };
  if (!is_time(start) || !is_time(start + last_time)) return words("has a time that is none");
  const std::int32_t before = tracks.last_of(brick);
  if (before != TrackStore::kNone) {
    // The end is a rounded number, the start is not.
    if (tracks.start_of(before) > start) return words("begins before its last one begins");
    if (end_of(tracks.track(static_cast<std::size_t>(before))) > start + 1e-6) return words("begins before its last one ends");
  }
  double& time = recording_->store_->time;
  time = std::max(time, start + last_time);
  return {};
}

RecordingReader::Done RecordingReader::take_hinged(const Piece& piece) {
  Source source = piece.source();
  Tracks<4> tracks;
  if (!read_tracks(source, tracks)) return misfit(piece);
  TrackStore& store = recording_->store_->tracks;
  const auto before = static_cast<std::int32_t>(store.size());
  std::vector<HingedKnot> knots;
  for (std::size_t t = 0; t < tracks.count; ++t) {
    if (auto done = check_head(tracks, t, piece.offset); !done) return done;
    const auto brick = static_cast<BrickId>(tracks.brick[t]);
    if (tracks.shared(t)) {
      const std::int32_t owner = before + static_cast<std::int32_t>(tracks.owner(t));
      if (auto done = check_start(brick, tracks.start[t], double{store.last_knot(owner)->time}, piece.offset); !done) return done;
      store.add_same(brick, tracks.start[t], owner);
      continue;
    }
    knots.clear();
    const auto& [time, angle, rate, acceleration] = tracks.numbers;
    const std::size_t first = tracks.first[t];
    for (std::size_t i = first; i < first + tracks.knots[t]; ++i) knots.push_back({time[i], angle[i], rate[i], acceleration[i]});
    if (auto done = check_start(brick, tracks.start[t], double{knots.back().time}, piece.offset); !done) return done;
    store.add(brick, tracks.start[t], knots);
  }
  return {};
}

RecordingReader::Done RecordingReader::take_free(const Piece& piece) {
  Source source = piece.source();
  Tracks<14> tracks;
  if (!read_tracks(source, tracks)) return misfit(piece);
  TrackStore& store = recording_->store_->tracks;
  const auto before = static_cast<std::int32_t>(store.size());
  std::vector<FreeKnot> knots;
  for (std::size_t t = 0; t < tracks.count; ++t) {
    if (auto done = check_head(tracks, t, piece.offset); !done) return done;
    const auto brick = static_cast<BrickId>(tracks.brick[t]);
    if (tracks.shared(t)) {
      const std::int32_t owner = before + static_cast<std::int32_t>(tracks.owner(t));
      if (auto done = check_start(brick, tracks.start[t], double{store.last_free_knot(owner)->time}, piece.offset); !done) return done;
      store.add_same(brick, tracks.start[t], owner);
      continue;
    }
    const std::size_t first = tracks.first[t];
    const std::size_t count = tracks.knots[t];
    knots.clear();
    const auto& n = tracks.numbers;
    for (std::size_t i = first; i < first + count; ++i) {
      knots.push_back({n[0][i], n[1][i], n[2][i], n[3][i], n[4][i], n[5][i], n[6][i], n[7][i], n[8][i], n[9][i], n[10][i], n[11][i],
                       n[12][i], n[13][i]});
    }
    if (auto done = check_start(brick, tracks.start[t], double{knots.back().time}, piece.offset); !done) return done;
    store.add(brick, tracks.start[t], knots);
  }
  return {};
}

RecordingReader::Done RecordingReader::take_events(const Piece& piece) {
  Source source = piece.source();
  const std::size_t count = source.get<std::uint32_t>();
  source.get<std::uint32_t>();
  const auto time = source.column<double>(count);
  const auto brick = source.column<std::uint32_t>(count), by = source.column<std::uint32_t>(count);
  const auto kind = source.column<std::uint8_t>(count);
  const auto force = source.column<float>(count), impulse = source.column<float>(count);
  const auto x = source.column<float>(count), y = source.column<float>(count), z = source.column<float>(count);
  if (!source.ok() || !source.at_end()) return misfit(piece);
  for (std::size_t i = 0; i < count; ++i) {
    const bool sound = is_time(time[i]) && brick[i] < brick_count_ && (by[i] < brick_count_ || by[i] == format::kNoBrickCode) &&
                       kind[i] <= static_cast<std::uint8_t>(EventKind::rested);
    if (!sound) return wrong(piece.offset, "event " + std::to_string(i) + " of this piece has a time, brick or kind that is none");
    const BrickId striker = by[i] == format::kNoBrickCode ? kNoBrick : static_cast<BrickId>(by[i]);
    recording_->store_->events.add(
        {time[i], static_cast<EventKind>(kind[i]), static_cast<BrickId>(brick[i]), striker, {force[i], impulse[i], x[i], y[i], z[i]}});
    recording_->store_->time = std::max(recording_->store_->time, time[i]);
  }
  return {};
}

RecordingReader::Done RecordingReader::take_energy(const Piece& piece) {
  Source source = piece.source();
  const std::size_t count = source.get<std::uint32_t>();
  source.get<std::uint32_t>();
  const auto time = source.column<double>(count), kinetic = source.column<double>(count), potential = source.column<double>(count);
  const auto push_work = source.column<double>(count);
  if (!source.ok() || !source.at_end()) return misfit(piece);
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_time(time[i])) return wrong(piece.offset, "energy sample " + std::to_string(i) + " has a time that is none");
    recording_->store_->energy.push_back({time[i], {kinetic[i], potential[i], push_work[i]}});
  }
  return {};
}

RecordingReader::Done RecordingReader::take_hashes(const Piece& piece) {
  Source source = piece.source();
  const auto stride = source.get<std::uint64_t>();
  const auto count = source.get<std::uint64_t>();
  const auto values = source.column<std::uint64_t>(static_cast<std::size_t>(count));
  if (!source.ok() || !source.at_end()) return misfit(piece);
  if (stride == 0 || stride > (std::uint64_t{1} << 60)) return wrong(piece.offset, "a stride of " + std::to_string(stride) + " steps");
  HashTrail& trail = recording_->store_->hashes;
  if (!trail.values.empty()) return wrong(piece.offset, "a second trail of hashes");
  trail.stride = static_cast<std::int64_t>(stride);
  for (std::size_t i = 0; i < values.size(); ++i) trail.values.push_back(values[i]);
  return {};
}

RecordingReader::Done RecordingReader::take_end(const Piece& piece) {
  Source source = piece.source();
  RunEnd end;
  const auto reason = source.get<std::uint32_t>();
  const auto brick = source.get<std::uint32_t>();
  const auto steps = source.get<std::uint64_t>();
  end.time = source.get<double>();
  end.hash = source.get<std::uint64_t>();
  end.words = source.text();
  if (!source.ok() || !source.at_end()) return misfit(piece);
  if (reason > static_cast<std::uint32_t>(EndReason::stopped))
    return wrong(piece.offset, "the run ended for reason " + std::to_string(reason) + ", which is none");
  if (brick != format::kNoBrickCode && brick >= brick_count_)
    return wrong(piece.offset, "the run ended at brick " + std::to_string(brick) + ", which is none");
  if (steps >> 62 != 0 || !is_time(end.time)) return wrong(piece.offset, "the run ended at a time that is none");
  end.reason = static_cast<EndReason>(reason);
  end.brick = brick == format::kNoBrickCode ? kNoBrick : static_cast<BrickId>(brick);
  end.step = static_cast<std::int64_t>(steps);
  recording_->store_->time = std::max(recording_->store_->time, end.time);
  recording_->store_->end = std::move(end);
  ended_ = true;
  return {};
}

}  // namespace topple

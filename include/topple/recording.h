/// A recording: for each brick a track from waking to rest, the events, the hashes, and the recipe to run it again.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "topple/model.h"

namespace topple {

/// Enough to run again: the layout's text and overrides are inside the Layout.
struct Recipe {
  std::string version;  ///< Of Topple, "0.1.0".
  std::string model;    ///< "pivot".
  double time_step = 0.0;
};

enum class EndReason : std::uint8_t { running, at_rest, time_limit, wave_died, not_finite, stopped };
/// "at_rest": the word for it in tables and for programs.
constexpr std::string_view name_of(EndReason reason) {
  return std::array<std::string_view, 6>{
      "running", "at_rest", "time_limit", "wave_died", "not_finite", "stopped"}[static_cast<std::size_t>(reason)];
}
struct RunEnd {
  EndReason reason = EndReason::running;  ///< `running` in a recording that was cut off.
  BrickId brick = kNoBrick;               ///< Where the wave died, or whose numbers are not finite.
  std::int64_t step = 0;
  double time = 0.0;       ///< [s]
  std::uint64_t hash = 0;  ///< Of the model after the last step.
  std::string words;       ///< The same as a sentence for people.
};

/// A brick at a moment.
struct BrickState {
  Phase phase = Phase::standing;
  Pose pose;
  Vec3 velocity;          ///< [m/s]
  Vec3 angular_velocity;  ///< [rad/s]
  HingedState hinge;      ///< Of a hinged brick; for a free one the tilt and its derivatives.
};

/// A knot of a hinged track; between two knots the angle is the quintic Hermite polynomial of angle, rate and acceleration.
struct HingedKnot {
  float time = 0.0F;          ///< Since the start of its track [s].
  float angle = 0.0F;         ///< [rad]
  float rate = 0.0F;          ///< [rad/s]
  float acceleration = 0.0F;  ///< [rad/s^2]
};
/// A knot of a free track; between two knots position and quaternion are cubic Hermite polynomials.
struct FreeKnot {
  float time = 0.0F;                                 ///< Since the start of its track [s].
  float x = 0.0F, y = 0.0F, z = 0.0F;                ///< Centre of mass against the brick as put down [m].
  float qw = 1.0F, qx = 0.0F, qy = 0.0F, qz = 0.0F;  ///< Orientation.
  float vx = 0.0F, vy = 0.0F, vz = 0.0F;             ///< [m/s]
  float wx = 0.0F, wy = 0.0F, wz = 0.0F;             ///< In world axes [rad/s].
};

/// One piece of a brick's motion; a brick that is woken again, or moves for long, has several.
struct Track {
  BrickId brick = kNoBrick;
  double start = 0.0;              ///< [s]
  std::vector<HingedKnot> hinged;  ///< One of the two is empty.
  std::vector<FreeKnot> free;
};

struct EnergySample {
  double time = 0.0;  ///< [s]
  Energy energy;
};

/// The hash after every `stride`-th step: `values[i]` belongs to step (i + 1) * stride.
struct HashTrail {
  std::int64_t stride = 1;
  std::vector<std::uint64_t> values;
};

/// All that happened in a run; readable while it grows.
class Recording {
 public:
  explicit Recording(Layout layout, Recipe recipe);
  ~Recording();
  Recording(Recording&&) noexcept;
  Recording& operator=(Recording&&) noexcept;

  const Layout& layout() const;
  const Recipe& recipe() const;
  const RunEnd& end() const;
  double duration() const;   ///< Time of the last thing recorded [s].
  double tolerance() const;  ///< How far a corner may be from where the model had it, as a fraction of the thickness.

  std::int64_t track_count() const;
  Track track(std::int64_t index) const;                         ///< In the order in which they were finished.
  void tracks_of(BrickId brick, std::vector<Track>& out) const;  ///< Of one brick, in the order of time.
  BrickState at(BrickId brick, double time) const;  ///< Any brick at any time: before its tracks it stands, after them it rests.
  /// Its tilt where it rests after all, as HingedState has it; not a number if it never moved, stands again or moves to the end [rad].
  double rest_angle(BrickId brick) const;
  std::int64_t event_count() const;
  Event event(std::int64_t index) const;         ///< In the order of time.
  std::span<const EnergySample> energy() const;  ///< Thinned evenly to at most 16,384 samples.
  const HashTrail& hashes() const;
  std::size_t memory() const;  ///< Held by tracks and events [bytes].

 private:
  friend class Recorder;
  friend class RecordingReader;
  friend class RecordingWriter;
  struct Store;
  std::unique_ptr<Store> store_;
};

struct RecorderConfig {
  // affects results (of the recording, never of the run)
  double tolerance = 0.002;  ///< How far a corner may be from where the model had it, as a fraction of the thickness.
  // affects speed only
  Crew* crew = nullptr;        ///< Null: the calling thread alone. A run sets it.
  Profile* profile = nullptr;  ///< Null: nobody asks. A run sets it.
};

/// Turns the frames of a model into the tracks of a recording.
class Recorder {
 public:
  Recorder(Recording& recording, const RecorderConfig& config);
  ~Recorder();
  void take(const Model& model);       ///< After every step.
  void take_last(const Model& model);  ///< Before finish(), where a run ends while bricks move.
  void close_tracks();                 ///< Ends every track; finish() does it too.
  void finish(RunEnd end);             ///< Says how the run ended.

 private:
  struct Open;
  Recording& recording_;
  std::unique_ptr<Open> open_;
};

/// Encodes a recording as the pieces of docs/format.md, those finished since the last call each time, so that a file can grow with its run.
/// It stays valid when the recording is moved (a run ends by moving its recording to the caller), not when it is destroyed.
class RecordingWriter {
 public:
  explicit RecordingWriter(const Recording& recording);
  std::vector<std::uint8_t> begin();  ///< Magic, recipe, scene, bricks.
  std::vector<std::uint8_t> more();   ///< Of what was finished since a few megabytes; call it until it gives nothing.
  std::vector<std::uint8_t> end();    ///< The rest, energy, hashes, how it ended.
  /// Of the free tracks that it has given out the recording keeps from now on where they end, a knot each, and no more: enough for a
  /// summary, and the memory of a long run does not grow with its motion.
  void let_go();

 private:
  Recording::Store* store_;
  std::int64_t tracks_ = 0;
  std::int64_t events_ = 0;
};

/// Reads the bytes of a `.topple` file. A file that was cut off after whole pieces gives what it holds, its end being `running`;
/// anything damaged or foreign is an error that says what and at which byte.
Result<Recording> read_recording(std::span<const std::uint8_t> bytes, std::string_view name);

}  // namespace topple

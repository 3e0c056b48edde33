#include <doctest/doctest.h>

#include <cstring>

#include "recording/knot_code.h"
#include "recording/scripted_model.h"

using namespace topple;
using namespace topple::scripted;

namespace {

constexpr double kStep = 0.001;

/// A brick that is thrown, spins about an axis that stays, and is hit now and then: parts of even acceleration.
struct Flight {
  struct Part {
    double start = 0.0;  ///< [s]
    Vec3 velocity, acceleration;
    double spin = 0.0, spin_up = 0.0;  ///< [rad/s], [rad/s^2]
  };
  BrickId brick = 0;
  Vec3 axis{0.0, 1.0, 0.0};
  std::vector<Part> parts;
  double end = 0.0;  ///< It rests from here [s].

  FreeMotion at(const Layout& layout, double time) const {
    const Pose put = standing_pose(layout, brick);
    FreeMotion motion{.brick = brick, .phase = time < end ? Phase::falling : Phase::resting, .pose = put};
    double angle = 0.0;
    for (std::size_t i = 0; i < parts.size() && parts[i].start <= time; ++i) {
      const Part& part = parts[i];
      const double until = i + 1 < parts.size() ? parts[i + 1].start : end;
      const double s = std::min(time, until) - part.start;
      motion.pose.position = motion.pose.position + s * part.velocity + 0.5 * s * s * part.acceleration;
      angle += s * part.spin + 0.5 * s * s * part.spin_up;
      motion.velocity = part.velocity + s * part.acceleration;
      motion.angular_velocity = (part.spin + s * part.spin_up) * axis;
    }
    const double sine = std::sin(0.5 * angle);
    motion.pose.orientation = Quat{std::cos(0.5 * angle), sine * axis.x, sine * axis.y, sine * axis.z} * put.orientation;
    if (time >= end) motion.velocity = motion.angular_velocity = {};
    return motion;
  }
};

class FreeScript : public Model {
 public:
  FreeScript(const Layout& layout, std::vector<Flight> flights) : layout_(layout), flights_(std::move(flights)) {}

  Status step() override {
    ++steps_;
    const bool moves = std::any_of(flights_.begin(), flights_.end(), [this](const Flight& flight) { return flight.end > time(); });
    return {moves ? Progress::running : Progress::at_rest, kNoBrick};
  }
  std::int64_t step_count() const override { return steps_; }
  double time_step() const override { return kStep; }
  void read(Frame& out) const override {
    out = {};
    out.time = time();
    for (const Flight& flight : flights_) {
      if (flight.parts[0].start < time() && flight.end > time() - kStep) out.free.push_back(flight.at(layout_, time()));
    }
  }
  std::span<const Event> events() const override { return {}; }
  std::span<const Contact> contacts() const override { return {}; }
  std::uint64_t hash() const override { return 0; }
  double time() const { return static_cast<double>(steps_) * kStep; }
  const std::vector<Flight>& flights() const { return flights_; }

 private:
  const Layout& layout_;
  std::vector<Flight> flights_;
  std::int64_t steps_ = 0;
};

const Vec3 kGravity{0.0, 0.0, -9.81};

/// Falls as in a row, is hit, spins away, about a tilted axis.
std::vector<Flight> flights() {
  std::vector<Flight> all;
  for (BrickId i = 0; i < 8; ++i) {
    const double start = 0.010 + 0.025 * i;
    const Vec3 axis = i % 2 == 0 ? Vec3{0.0, 1.0, 0.0} : Vec3{0.36, 0.48, 0.8};
    Flight flight{.brick = i, .axis = axis};
    flight.parts.push_back({start, {0.1, 0.02 * i, 0.3}, kGravity, 4.0, 30.0});
    flight.parts.push_back({start + 0.040, {0.3, -0.1, 0.5}, kGravity, -9.0, 5.0});
    flight.parts.push_back({start + 0.090, {-0.1, 0.1, 0.1}, {-2.0, 0.0, -1.0}, 20.0 + 5.0 * i, -40.0});
    flight.end = start + 0.150;
    all.push_back(flight);
  }
  return all;
}

double worst_corner(const Recording& recording, const Flight& flight, double from, double to, double stride) {
  const Layout& layout = recording.layout();
  const BrickKind& kind = layout.kind_of(flight.brick);
  double worst = 0.0;
  for (double time = from; time < to; time += stride) {
    const Pose truth = flight.at(layout, time).pose;
    worst = std::max(worst, corner_distance(half_extents(kind), recording.at(flight.brick, time).pose, truth) / kind.thickness);
  }
  return worst;
}

std::size_t knot_count(const Recording& recording, BrickId brick) {
  std::vector<Track> tracks;
  recording.tracks_of(brick, tracks);
  std::size_t count = 0;
  for (const Track& track : tracks) count += track.free.size();
  return count;
}

}  // namespace

TEST_CASE("every corner of a brick that flies, spins and is hit is within 0.2 % of the thickness at every step") {
  const Layout layout = row(8);
  FreeScript script(layout, flights());
  const Recording recording = record(layout, script);
  double worst = 0.0;
  for (const Flight& flight : script.flights()) {
    worst = std::max(worst, worst_corner(recording, flight, std::ceil(flight.parts[0].start / kStep) * kStep, flight.end, kStep));
    // 150 steps: a tenth of them or fewer become knots.
    CHECK(knot_count(recording, flight.brick) < 32);
  }
  CHECK(worst <= 0.002);
  CHECK(worst > 0.0005);  // The tolerance is used, or there are too many knots.
}

TEST_CASE("between two steps a free brick is where its motion was, as long as nothing hits it") {
  const Layout layout = row(8);
  FreeScript script(layout, flights());
  const Recording recording = record(layout, script);
  for (const Flight& flight : script.flights()) {
    for (std::size_t i = 0; i + 1 < flight.parts.size(); ++i) {
      CHECK(worst_corner(recording, flight, flight.parts[i].start + 2.0 * kStep, flight.parts[i + 1].start - 2.0 * kStep, 0.00037) <=
            0.002);
    }
  }
}

TEST_CASE("a brick that spins through many turns keeps its way round") {
  const Layout layout = row(1);
  Flight flight{.brick = 0, .axis = {0.6, 0.0, 0.8}};
  flight.parts.push_back({0.0, {0.4, 0.1, 3.0}, kGravity, 60.0, 0.0});
  flight.end = 0.6;
  FreeScript script(layout, {flight});
  const Recording recording = record(layout, script);
  CHECK(worst_corner(recording, flight, kStep, flight.end - kStep, 0.00037) <= 0.002);
  CHECK(recording.at(0, 0.3).angular_velocity.x == doctest::Approx(36.0).epsilon(0.01));
  CHECK(recording.at(0, 0.3).velocity.z == doctest::Approx(3.0 - 9.81 * 0.3).epsilon(0.01));
}

TEST_CASE("a tighter tolerance is kept by a free brick too") {
  const Layout layout = row(8);
  FreeScript script(layout, flights());
  const Recording recording = record(layout, script, {.tolerance = 2e-4});
  for (const Flight& flight : script.flights()) {
    CHECK(worst_corner(recording, flight, std::ceil(flight.parts[0].start / kStep) * kStep, flight.end, kStep) <= 2e-4);
  }
}

TEST_CASE("a long flight is cut into pieces that follow each other without a gap") {
  const Layout layout = row(1);
  Flight flight{.brick = 0, .axis = {0.0, 0.0, 1.0}};
  flight.parts.push_back({0.0, {0.1, 0.0, 0.0}, {}, 3.0, 0.1});
  flight.end = 8.0;
  FreeScript script(layout, {flight});
  const Recording recording = record(layout, script);
  CHECK(recording.track_count() >= 2);
  CHECK(worst_corner(recording, flight, kStep, flight.end, 0.0137) <= 0.002);
}

TEST_CASE("a free brick that is woken again goes on from where it rested, and rests after it") {
  const Layout layout = row(1);
  Flight first{.brick = 0, .parts = {{0.010, {0.2, 0.0, 0.0}, {}, 2.0, 0.0}}, .end = 0.050};
  FreeScript script(layout, {first});
  const Recording once = record(layout, script);
  REQUIRE(once.track_count() == 1);
  CHECK(once.at(0, 0.2).phase == Phase::resting);
  CHECK(norm(once.at(0, 0.2).velocity) == 0.0);
  CHECK(once.at(0, 0.005).phase == Phase::standing);
  CHECK(once.at(0, 0.030).phase == Phase::falling);
  // 0.2 m/s for 40 ms.
  CHECK(once.at(0, 0.2).pose.position.x == doctest::Approx(0.008).epsilon(1e-4));
}

TEST_CASE("a brick that was put down askew has knots in whole steps like any other, and begins where it stood") {
  Layout layout = row(1);
  layout.bricks[0].heading = 0.7;
  Flight flight{.brick = 0, .parts = {{0.010, {0.2, 0.0, 0.0}, {}, 2.0, 0.0}}, .end = 0.050};
  FreeScript script(layout, {flight});
  const Recording recording = record(layout, script);
  const Track track = recording.track(0);
  for (const FreeKnot& knot : track.free) {
    for (const float part : {knot.qw, knot.qx, knot.qy, knot.qz}) CHECK(double{part} == rounded(double{part}, FreeSteps::kTurn));
  }
  // Half a step of the quaternion turns it by a step or less: a corner, 27 mm away, moves by 13 nm, four millionths of the thickness at
  // most.
  const Pose put = standing_pose(layout, 0);
  CHECK(corner_distance(half_extents(layout.kind_of(0)), recording.at(0, track.start).pose, put) < 4e-6 * layout.kind_of(0).thickness);
}

TEST_CASE("a recording of free bricks that is written and read again is the same") {
  Layout layout = row(8);
  layout.name = "row.toml";
  layout.text = "[[row]]\ncount = 8\npitch_mm = 24\n";
  FreeScript script(layout, flights());
  const Recording before = record(layout, script);
  RecordingWriter writer(before);
  std::vector<std::uint8_t> bytes = writer.begin();
  const auto append = [&bytes](const std::vector<std::uint8_t>& piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); };
  for (auto piece = writer.more(); !piece.empty(); piece = writer.more()) append(piece);
  append(writer.end());
  const auto after = read_recording(bytes, "run.topple");
  REQUIRE_MESSAGE(after.has_value(), after.error().message);
  REQUIRE(after->track_count() == before.track_count());
  for (std::int64_t i = 0; i < before.track_count(); ++i) {
    const Track a = before.track(i);
    const Track b = after->track(i);
    CHECK(a.start == b.start);
    REQUIRE(a.free.size() == b.free.size());
    CHECK(std::memcmp(a.free.data(), b.free.data(), a.free.size() * sizeof(FreeKnot)) == 0);
  }
}

TEST_CASE("a recording whose tracks are let go when they are written makes the same file, remembers where all end, and stays small") {
  // Enough bricks for several blocks of codes.
  constexpr BrickId kBricks = 2000;
  Layout layout = row(kBricks);
  const std::vector<Flight> eight = flights();
  std::vector<Flight> all;
  for (BrickId i = 0; i < kBricks; ++i) {
    Flight flight = eight[static_cast<std::size_t>(i % 8)];
    flight.brick = i;
    const BrickId eighth = i / 8;
    const double later = 0.01 * eighth;
    for (auto& part : flight.parts) part.start += later;
    flight.end += later;
    all.push_back(flight);
  }
  const auto run = [&](bool let_go, std::vector<std::uint8_t>& bytes) {
    FreeScript script(layout, all);
    Recording recording(layout, Recipe{"0.1.0", "scripted", kStep});
    Recorder recorder(recording, {});
    RecordingWriter writer(recording);
    bytes = writer.begin();
    const auto append = [&bytes](const std::vector<std::uint8_t>& piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); };
    for (int step = 1; script.step().progress == Progress::running; ++step) {
      recorder.take(script);
      if (step % 700 != 0) continue;
      for (auto piece = writer.more(); !piece.empty(); piece = writer.more()) append(piece);
      if (let_go) writer.let_go();
    }
    recorder.finish({EndReason::at_rest, kNoBrick, script.step_count(), script.time(), 0, "at rest"});
    append(writer.end());
    if (let_go) writer.let_go();
    return recording;
  };
  std::vector<std::uint8_t> kept_bytes, let_go_bytes;
  const Recording kept = run(false, kept_bytes);
  const Recording let_go = run(true, let_go_bytes);
  CHECK(kept_bytes == let_go_bytes);
  REQUIRE(let_go.track_count() == kept.track_count());
  for (BrickId brick = 0; brick < kBricks; ++brick) {
    const BrickState a = kept.at(brick, 1e6);
    const BrickState b = let_go.at(brick, 1e6);
    CHECK(a.phase == b.phase);
    CHECK(a.pose.position == b.pose.position);
    CHECK(a.pose.orientation.w == b.pose.orientation.w);
    CHECK(std::isnan(kept.rest_angle(brick)) == std::isnan(let_go.rest_angle(brick)));
  }
  CHECK(let_go.track(0).free.size() == 1);
  CHECK(kept.memory() - let_go.memory() > kept.memory() / 2);
}

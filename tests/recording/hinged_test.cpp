#include <doctest/doctest.h>

#include "recording/scripted_model.h"

using namespace topple;
using namespace topple::scripted;

namespace {

// Largest corner distance at random times between `from` and `to`, as a fraction of the thickness.
double worst_corner(const Recording& recording, const Motion& motion, double from, double to, int samples) {
  const Layout& layout = recording.layout();
  const BrickKind& kind = layout.kind_of(motion.brick);
  std::mt19937_64 random(static_cast<std::uint64_t>(motion.brick) + 1);
  std::uniform_real_distribution<double> when(from, to);
  double worst = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double time = when(random);
    const Pose truth = hinged_pose(layout, motion.brick, motion.at(time).angle);
    worst = std::max(worst, corner_distance(half_extents(kind), recording.at(motion.brick, time).pose, truth) / kind.thickness);
  }
  return worst;
}

}  // namespace

TEST_CASE("every corner of a wave is within 0.2 % of the thickness at any time") {
  HingedScript script(wave(60), 0.0005);
  const Recording recording = record(row(60), script);
  double worst = 0.0;
  for (const Motion& motion : script.motions()) {
    worst = std::max(worst, worst_corner(recording, motion, motion.parts[0].start, motion.end, 4000));
  }
  CHECK(worst <= 0.002);
  CHECK(worst > 0.0005);  // The tolerance is used, or there are too many knots.
}

TEST_CASE("a tighter tolerance is kept too, down to what a float of time can carry") {
  HingedScript script(wave(10), 0.0005);
  const Recording recording = record(row(10), script, {.tolerance = 2e-5});
  for (const Motion& motion : script.motions()) {
    CHECK(worst_corner(recording, motion, motion.parts[0].start, motion.end, 2000) <= 2e-5);
  }
  CHECK(recording.tolerance() == 2e-5);
}

TEST_CASE("a brick stands before its track and rests after it") {
  HingedScript script(wave(3), 0.0005);
  const Recording recording = record(row(3), script);
  const Motion& motion = script.motions()[1];
  const BrickState standing = recording.at(1, motion.parts[0].start - 1e-6);
  CHECK(standing.phase == Phase::standing);
  CHECK(standing.hinge.angle == 0.0);
  CHECK(standing.pose.position.z == doctest::Approx(0.024));
  CHECK(recording.at(1, motion.parts[0].start + 1e-4).phase == Phase::falling);
  const BrickState resting = recording.at(1, motion.end + 0.5);
  CHECK(resting.phase == Phase::resting);
  CHECK(resting.hinge.angle == doctest::Approx(motion.at(motion.end).angle).epsilon(1e-6));
  CHECK(norm(resting.velocity) == 0.0);
}

TEST_CASE("a hit is a jump of the rate at its very time, not smeared over a step") {
  HingedScript script(wave(3), 0.0005);
  const Recording recording = record(row(3), script);
  const Motion& motion = script.motions()[1];
  const double hit = motion.parts[1].start;
  // The last formula before the hit, the first after it; a knot's time is a float, so a microsecond on either side.
  CHECK(recording.at(1, hit - 1e-6).hinge.rate == doctest::Approx(motion.parts[0].at(hit).rate).epsilon(1e-3));
  CHECK(std::abs(recording.at(1, hit + 1e-6).hinge.rate) < 1e-3);
}

TEST_CASE("rates and accelerations follow the model closely enough for a plot") {
  HingedScript script(wave(3), 0.0005);
  const Recording recording = record(row(3), script);
  const Motion& motion = script.motions()[2];
  double rate_miss = 0.0;
  for (double time = motion.parts[0].start + 1e-4; time < motion.end; time += 1e-4) {
    rate_miss = std::max(rate_miss, std::abs(recording.at(2, time).hinge.rate - motion.at(time).rate));
  }
  MESSAGE("largest miss of the rate: " << rate_miss << " rad/s of about 4");
  CHECK(rate_miss < 0.2);
}

TEST_CASE("the velocity of a brick is the derivative of its position") {
  HingedScript script(wave(2), 0.0005);
  Layout layout = row(2);
  layout.bricks[1].heading = 0.7;
  const Recording recording = record(std::move(layout), script);
  const double time = script.motions()[1].parts[0].start + 0.0123;
  const double h = 1e-5;
  const BrickState state = recording.at(1, time);
  const Vec3 slope = (0.5 / h) * (recording.at(1, time + h).pose.position - recording.at(1, time - h).pose.position);
  CHECK(norm(state.velocity - slope) < 1e-5 * norm(slope) + 1e-7);
  CHECK(norm(state.angular_velocity) == doctest::Approx(std::abs(state.hinge.rate)));
}

TEST_CASE("a brick that is woken again has a track for each motion and rests between them") {
  Motion first{0, {{0.01, 0.0, 2.0, -50.0, 0.0, 0.0, 10.0}}, 0.05};
  Motion second{0, {{0.5003, first.at(0.05).angle, 3.0, 10.0, 0.0, 0.0, 10.0}}, 0.56};
  HingedScript script({first, second}, 0.0005);
  const Recording recording = record(row(1), script);
  std::vector<Track> tracks;
  recording.tracks_of(0, tracks);
  REQUIRE(tracks.size() == 2);
  CHECK(tracks[0].start == 0.01);
  CHECK(tracks[1].start == 0.5003);
  CHECK(recording.at(0, 0.1).phase == Phase::resting);
  CHECK(recording.at(0, 0.1).hinge.angle == doctest::Approx(first.at(0.05).angle).epsilon(1e-6));
  CHECK(worst_corner(recording, first, 0.01, 0.05, 2000) <= 0.002);
  CHECK(worst_corner(recording, second, 0.5003, 0.56, 2000) <= 0.002);
}

TEST_CASE("a brick that rests for a moment goes on in the same track") {
  Motion motion{0, {{0.01, 0.0, 2.0, -50.0, 0.0, 0.0, 10.0}}, 0.05};
  Motion later{0, {{0.1503, motion.at(0.05).angle, 3.0, 10.0, 0.0, 0.0, 10.0}}, 0.21};
  HingedScript script({motion, later}, 0.0005);
  const Recording recording = record(row(1), script);
  CHECK(recording.track_count() == 1);
  CHECK(worst_corner(recording, motion, 0.01, 0.1503, 4000) <= 0.002);
  CHECK(worst_corner(recording, later, 0.1503, 0.21, 2000) <= 0.002);
}

TEST_CASE("a brick that is woken again and again to move less than the tolerance has one track") {
  // The tolerance is 0.002 * 7.5 mm over 48.6 mm: 0.31 mrad.
  std::vector<Motion> motions = {{0, {{0.01, 0.0, 2.0, -50.0, 0.0, 0.0, 10.0}}, 0.05}};
  for (int i = 1; i < 4; ++i) motions.push_back({0, {{0.5 * i, motions.back().at(1e9).angle, 0.01, 0.0, 0.0, 0.0, 10.0}}, 0.5 * i + 0.005});
  HingedScript script(motions, 0.0005);
  const Recording recording = record(row(1), script);
  CHECK(recording.track_count() == 1);
  for (const Motion& motion : motions) CHECK(worst_corner(recording, motion, motion.parts[0].start, motion.end + 0.2, 500) <= 0.002);
}

TEST_CASE("a brick that is woken again and again to move further and further is followed") {
  std::vector<Motion> motions = {{0, {{0.01, 0.0, 2.0, -50.0, 0.0, 0.0, 10.0}}, 0.05}};
  for (int i = 1; i < 30; ++i)
    motions.push_back({0, {{0.5 * i, motions.back().at(1e9).angle, 0.02, 0.0, 0.0, 0.0, 10.0}}, 0.5 * i + 0.005});
  HingedScript script(motions, 0.0005);
  const Recording recording = record(row(1), script);
  for (const Motion& motion : motions) CHECK(worst_corner(recording, motion, motion.parts[0].start, motion.end + 0.2, 500) <= 0.002);
}

TEST_CASE("a brick that falls back stands again") {
  // Up 0.05 rad and back to 0 in 0.1 s: a parabola.
  Motion motion{0, {{0.01, 0.0, 2.0, -40.0, 0.0, 0.0, 10.0}}, 0.11};
  HingedScript script({motion}, 0.0005);
  const Recording recording = record(row(1), script);
  CHECK(recording.at(0, 0.06).hinge.angle == doctest::Approx(0.05).epsilon(1e-3));
  const BrickState state = recording.at(0, 1.0);
  CHECK((state.phase == Phase::standing || std::abs(state.hinge.angle) < 1e-12));
  CHECK(std::abs(state.hinge.angle) < 1e-12);
}

TEST_CASE("a long slow motion is cut into pieces that follow each other without a gap") {
  Motion motion{0, {{0.01, 0.0, 0.05, 0.0, 0.0, 0.0, 10.0}}, 20.01};
  for (int i = 1; i < 200; ++i) then(motion, 0.01 + 0.1 * i, {0.0, i % 2 == 0 ? 0.05 : 0.02, 0.0, 0.0, 0.0, 0.0, 10.0});
  HingedScript script({motion}, 0.0005);
  const Recording recording = record(row(1), script);
  std::vector<Track> tracks;
  recording.tracks_of(0, tracks);
  REQUIRE(tracks.size() > 2);
  for (std::size_t i = 1; i < tracks.size(); ++i) {
    CHECK(tracks[i].start == tracks[i - 1].start + double{tracks[i - 1].hinged.back().time});
    CHECK(tracks[i].hinged.front().angle == tracks[i - 1].hinged.back().angle);
  }
  CHECK(worst_corner(recording, motion, 0.01, 20.01, 20000) <= 0.002);
}

TEST_CASE("a run that is stopped keeps what moves as falling") {
  HingedScript script(wave(3), 0.0005);
  Recording recording(row(3), Recipe{"0.1.0", "scripted", 0.0005});
  Recorder recorder(recording, {});
  for (int i = 0; i < 60; ++i) {
    (void)script.step();
    recorder.take(script);
  }
  recorder.finish({EndReason::stopped, kNoBrick, 60, 0.03, 0, "stopped"});
  CHECK(recording.at(0, 0.03).phase == Phase::falling);
  CHECK(recording.duration() == doctest::Approx(0.03));
  CHECK(recording.end().reason == EndReason::stopped);
  CHECK(worst_corner(recording, script.motions()[0], 0.0101, 0.03, 1000) <= 0.002);
}

TEST_CASE("energy and hashes thin themselves evenly") {
  Motion motion{0, {{0.0, 0.0, 1e-5, 0.0, 0.0, 0.0, 10.0}}, 100000.0};
  HingedScript script({motion}, 1.0);
  const Recording recording = record(row(1), script);
  CHECK(recording.energy().size() <= 16384);
  CHECK(recording.energy().size() > 8192);
  // 100,000 steps: strides double at 16,385, 32,770, 65,540: every 8th step is left.
  for (std::size_t i = 0; i < recording.energy().size(); ++i) {
    REQUIRE(recording.energy()[i].time == doctest::Approx(8.0 * static_cast<double>(i + 1)));
    REQUIRE(recording.energy()[i].energy.kinetic == recording.energy()[i].time);
  }
  CHECK(recording.hashes().stride == 2);
  for (std::size_t i = 0; i < recording.hashes().values.size(); ++i) REQUIRE(recording.hashes().values[i] == (i + 1) * 2 * 7919);
}

TEST_CASE("a long wave costs few bytes a brick") {
  constexpr BrickId kBricks = 2000;
  HingedScript script(wave(kBricks), 0.0005);
  const Recording recording = record(row(kBricks), script);
  std::int64_t knots = 0;
  for (std::int64_t i = 0; i < recording.track_count(); ++i) knots += static_cast<std::int64_t>(recording.track(i).hinged.size());
  MESSAGE("of each brick " << static_cast<double>(knots) / kBricks << " knots, " << static_cast<double>(recording.memory()) / kBricks
                           << " bytes");
  // Twelve hits that matter are 24 knots of 16 bytes and the two ends; a piece and its index take 36 bytes more.
  CHECK(static_cast<double>(recording.memory()) / kBricks < 26 * 16 + 36 + 25);
}

TEST_CASE("an acceleration that a model does not know after a jump costs no knots") {
  // After a jump at 30 ms the model says an acceleration of 0, and has 80 rad/s^2 from its next step on.
  class Forgetful : public HingedScript {
   public:
    using HingedScript::HingedScript;
    void read(Frame& out) const override {
      HingedScript::read(out);
      for (Kink& kink : out.kinks) {
        if (kink.time > 0.02) kink.after.acceleration = 0.0;
      }
    }
  };
  Motion motion{0, {{0.01, 0.0, 4.0, 20.0, 0.0, 0.0, 10.0}}, 0.0603};
  then(motion, 0.0301, {0.0, 0.0, 1.0, 80.0, 0.0, 0.0, 10.0});
  Forgetful script({motion}, 0.0005);
  const Recording recording = record(row(1), script);
  const Track track = recording.track(0);
  CHECK(track.hinged.size() == 5);  // Beginning, before and after the jump, before and after the end.
  CHECK(worst_corner(recording, motion, 0.01, 0.0603, 4000) <= 0.002);
}

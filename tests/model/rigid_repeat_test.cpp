// What rigid does not compute again in an even row.
#include <algorithm>
#include <cmath>

#include "doctest/doctest.h"
#include "rigid_scene.h"
#include "topple/measure.h"
#include "topple/run.h"

using namespace topple;
using namespace topple::test;

namespace {

Recording recorded(const Layout& layout, bool repeats, double until = 1e9) {
  auto recording = simulate(layout, RigidConfig{.repeats = repeats}, {.until = until});
  REQUIRE(recording.has_value());
  return *std::move(recording);
}

// The same hash and the same events to the last bit, and motions that agree within what a recording keeps.
void check_same(const Recording& a, const Recording& b) {
  CHECK(a.end().hash == b.end().hash);
  CHECK(a.end().words == b.end().words);
  REQUIRE(a.event_count() == b.event_count());
  std::size_t different = 0;
  for (std::int64_t i = 0; i < a.event_count(); ++i) {
    const Event left = a.event(i), right = b.event(i);
    const bool same = left.time == right.time && left.kind == right.kind && left.brick == right.brick && left.by == right.by &&
                      (left.impulse == right.impulse || std::isnan(left.impulse));
    different += same ? 0 : 1;
  }
  CHECK(different == 0);
  const double thickness = a.layout().kinds[0].thickness;
  double worst = 0.0, energy = 0.0;
  for (int i = 0; i <= 200; ++i) {
    const double time = i * a.duration() / 200.0;
    for (BrickId brick = 0; brick < a.layout().brick_count(); brick += 7) {
      const Pose left = a.at(brick, time).pose, right = b.at(brick, time).pose;
      worst = std::max(worst, norm(left.position - right.position) / thickness);
    }
  }
  REQUIRE(a.energy().size() == b.energy().size());
  for (std::size_t i = 0; i < a.energy().size(); ++i) {
    const Energy &left = a.energy()[i].energy, &right = b.energy()[i].energy;
    energy = std::max(energy, std::abs(left.kinetic - right.kinetic) + std::abs(left.potential - right.potential));
  }
  CHECK(worst < 0.02);  // A blow is smoothed over the step in which it is, and steps are others for an echo.
  CHECK(energy < 1e-12);
}

}  // namespace

TEST_CASE("rigid: an even row that is not computed again has the bits of one that is, whichever way it runs") {
  for (const double heading : {0.0, 2.0, 3.141592653589793}) {
    for (const double pitch : {0.015, 0.024}) {
      CAPTURE(heading);
      CAPTURE(pitch);
      Layout layout = straight_row(130, pitch);
      for (Brick& brick : layout.bricks) {
        brick.foot = {std::cos(heading) * brick.foot.x, std::sin(heading) * brick.foot.x, 0.0};
        brick.heading = heading;
      }
      check_same(recorded(layout, true), recorded(layout, false));
    }
  }
}

TEST_CASE("rigid: an even row goes over into another, or into a heap of bricks, as if all had been computed") {
  Layout layout = straight_row(220, 0.024);
  for (std::size_t i = 100; i < layout.bricks.size(); ++i) layout.bricks[i].foot.x += 0.004;
  check_same(recorded(layout, true), recorded(layout, false));
  layout.bricks[100].heading = 0.2;
  check_same(recorded(layout, true), recorded(layout, false));
  layout.bricks[100].heading = 0.0;
  layout.bricks.push_back({.foot = {150 * 0.024, 0.03, 0.0}});
  layout.parts.push_back({"aside", 220, 1});
  check_same(recorded(layout, true), recorded(layout, false));
}

TEST_CASE("rigid: a run stopped amid an even row keeps what moves") {
  const Layout layout = straight_row(200, 0.024);
  const Recording stopped = recorded(layout, true, 3.0), computed = recorded(layout, false, 3.0);
  check_same(stopped, computed);
  int falling = 0, different = 0;
  for (BrickId brick = 0; brick < 200; ++brick) {
    const Phase phase = stopped.at(brick, 3.0).phase;
    different += phase == computed.at(brick, 3.0).phase ? 0 : 1;
    falling += phase == Phase::falling ? 1 : 0;
  }
  CHECK(falling > 8);
  CHECK(different <= 1);  // One that comes to rest in the last step.
}

TEST_CASE("rigid: a wave that meets another one amid an even row goes on as if all had been computed") {
  Layout layout = straight_row(260, 0.024);
  for (std::size_t i = 130; i < layout.bricks.size(); ++i) layout.bricks[i].heading = 3.141592653589793;
  layout.pushes.push_back({259, 0.0, AngularSpeedPush{4.0}});
  check_same(recorded(layout, true), recorded(layout, false));
}

TEST_CASE("rigid: a brick of the wave that is pushed amid an even row falls on") {
  Layout layout = straight_row(160, 0.024);
  layout.pushes.push_back({100, 2.62, AngularSpeedPush{8.0}});
  const Recording a = recorded(layout, true), b = recorded(layout, false);
  CHECK(a.end().words == b.end().words);
  const Wave left = measure_wave(a), right = measure_wave(b);
  CHECK(summarize(a).fallen == 160);
  CHECK(left.arrival.back() == doctest::Approx(right.arrival.back()).epsilon(1e-4));
}

TEST_CASE("rigid: echoes are written and read as they are, whether or not the memory of tracks is given back meanwhile") {
  const Layout layout = layout_of("[[push]]\nbrick = 0\nangular_speed_rad_s = 4.0\n[[row]]\ncount = 150\ngap_mm = 16.5\n");
  const auto run = [&](bool let_go, std::vector<std::uint8_t>& bytes) {
    Recording recording(layout, Recipe{"0.1.0", "rigid", rigid::default_time_step(layout)});
    auto model = rigid::make_rigid_model(layout, {});
    REQUIRE(model.has_value());
    Recorder recorder(recording, {});
    RecordingWriter writer(recording);
    bytes = writer.begin();
    const auto append = [&bytes](const std::vector<std::uint8_t>& more) { bytes.insert(bytes.end(), more.begin(), more.end()); };
    for (int step = 0; (*model)->step().progress == Progress::running; ++step) {
      recorder.take(**model);
      if (step % 8 == 0) append(writer.more());
      if (let_go) writer.let_go();
    }
    recorder.finish({.time = static_cast<double>((*model)->step_count()) * (*model)->time_step()});
    append(writer.end());
    return recording;
  };
  std::vector<std::uint8_t> kept_bytes, let_go_bytes;
  const Recording kept = run(false, kept_bytes);
  run(true, let_go_bytes);
  CHECK(kept_bytes == let_go_bytes);
  const auto read = read_recording(let_go_bytes, "row.topple");
  REQUIRE_MESSAGE(read.has_value(), (read ? std::string() : read.error().message));
  REQUIRE(read->track_count() == kept.track_count());
  double worst = 0.0;
  for (BrickId brick = 0; brick < 150; ++brick) {
    for (const double time : {1.0, 2.0, 2.5, 3.0, 100.0}) {
      worst = std::max(worst, norm(read->at(brick, time).pose.position - kept.at(brick, time).pose.position));
    }
  }
  CHECK(worst == 0.0);
}

TEST_CASE("rigid: the motion of an even row is kept once") {
  const Layout layout = straight_row(1200, 0.024);
  CHECK(recorded(layout, false).memory() > recorded(layout, true).memory() + std::size_t{200} * 1100);
}

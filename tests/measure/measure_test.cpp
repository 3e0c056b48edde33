#include "topple/measure.h"

#include <doctest/doctest.h>

#include <cmath>

#include "measure/teller.h"

using namespace topple;
using namespace topple::scripted;

namespace {

// Brick i of a row is struck by the one before and passes 10 degrees at 0.5 + i * period.
std::vector<Event> wave_events(BrickId count, double period) {
  std::vector<Event> events = {event(0.0, EventKind::pushed, 0), event(0.5, EventKind::arrived, 0)};
  for (BrickId i = 1; i < count; ++i) {
    events.push_back(event(0.49 + period * i, EventKind::struck, i, i - 1));
    events.push_back(event(0.5 + period * i, EventKind::arrived, i));
  }
  return events;
}

}  // namespace

TEST_CASE("an even wave has the front speed of its pitch over its period") {
  const Wave wave = measure_wave(told(row(101), wave_events(101, 0.03)));
  REQUIRE(wave.bricks.size() == 101);
  CHECK(wave.bricks.front() == 0);
  CHECK(wave.bricks.back() == 100);
  CHECK(wave.distance[50] == doctest::Approx(50 * 0.024));
  CHECK(wave.arrival[50] == doctest::Approx(0.5 + 50 * 0.03));
  // 24 mm in 30 ms.
  CHECK(wave.front_speed == doctest::Approx(0.8));
  CHECK(wave.local_speed(0) == doctest::Approx(0.8));
  CHECK(wave.local_speed(40, 5) == doctest::Approx(0.8));
  CHECK(wave.local_speed(100) == doctest::Approx(0.8));
  CHECK(std::isnan(wave.local_speed(101)));
}

TEST_CASE("the front speed is taken between the bricks at 20 and at 80 percent") {
  // The first 20 and the last 20 of 101 bricks are ten times slower; bricks 20 to 80 take 30 ms each.
  std::vector<Event> events = {event(0.0, EventKind::arrived, 0)};
  double time = 0.0;
  for (BrickId i = 1; i < 101; ++i) {
    time += i <= 20 || i > 80 ? 0.3 : 0.03;
    events.push_back(event(time, EventKind::struck, i, i - 1));
    events.push_back(event(time, EventKind::arrived, i));
  }
  const Wave wave = measure_wave(told(row(101), events));
  CHECK(wave.front_speed == doctest::Approx(0.8));
  CHECK(wave.local_speed(10) == doctest::Approx(0.08));
}

TEST_CASE("the trunk of a split goes back from the last brick that was reached") {
  // 0 -> 1 -> {2, 3}; 3 -> 4 is the longer branch.
  const Wave wave =
      measure_wave(told(row(5), {event(0.0, EventKind::pushed, 0), event(0.1, EventKind::arrived, 0), event(0.2, EventKind::struck, 1, 0),
                                 event(0.2, EventKind::arrived, 1), event(0.3, EventKind::struck, 2, 1),
                                 event(0.3, EventKind::struck, 3, 1), event(0.4, EventKind::arrived, 2), event(0.4, EventKind::arrived, 3),
                                 event(0.5, EventKind::struck, 4, 3), event(0.6, EventKind::arrived, 4)}));
  CHECK(wave.bricks == std::vector<BrickId>{0, 1, 3, 4});
  // Feet at 0, 24, 72 and 96 mm.
  CHECK(wave.distance[3] == doctest::Approx(0.096));
}

TEST_CASE("a wave that returns to its pushed brick ends there") {
  auto events = wave_events(6, 0.03);
  events.push_back(event(5.0, EventKind::struck, 0, 5));
  CHECK(measure_wave(told(row(6), events)).bricks.size() == 6);
}

TEST_CASE("a run without a wave has no speed and no trunk") {
  const Wave none = measure_wave(told(row(3), {}));
  CHECK(none.bricks.empty());
  CHECK(std::isnan(none.front_speed));
  CHECK(std::isnan(none.local_speed(0)));
  // Four bricks are too few for 20 % and 80 %.
  CHECK(std::isnan(measure_wave(told(row(4), wave_events(4, 0.03))).front_speed));
  CHECK(measure_wave(told(row(5), wave_events(5, 0.03))).front_speed == doctest::Approx(0.8));
}

TEST_CASE("a brick that rests past its tip angle has fallen, any other stands") {
  // The tip angle is atan(7.5 / 48) = 0.155 rad. Brick 0 rests at 0.2, brick 1 at 0.15, brick 2 never moves, brick 3 still moves.
  std::vector<Motion> motions = {{0, {{0.01, 0.0, 4.0, 0.0, 0.0, 0.0, 10.0}}, 0.06},
                                 {1, {{0.01, 0.0, 3.0, 0.0, 0.0, 0.0, 10.0}}, 0.06},
                                 {3, {{0.01, 0.0, 10.0, 0.0, 0.0, 0.0, 10.0}}, 1e9}};
  HingedScript script(motions, 0.0005);
  Recording recording(row(4), {"0.1.0", "scripted", 0.0005});
  Recorder recorder(recording, {});
  for (int i = 0; i < 200; ++i) {
    (void)script.step();
    recorder.take(script);
  }
  recorder.finish({EndReason::time_limit, kNoBrick, 200, 0.1, 0, "time limit"});
  const RunSummary summary = summarize(recording);
  CHECK(summary.bricks == 4);
  CHECK(summary.fallen == 1);
  CHECK(summary.standing == 3);
  CHECK(summary.duration == doctest::Approx(0.1));
}

TEST_CASE("the deepest overlap is as deep as one brick was turned into the next") {
  // Brick 1 of three turns by 0.5 rad towards brick 2, 16.5 mm from it. Its upper front corner, 48 mm above its toe, goes 48 sin 0.5 =
  // 23.0 mm to the right, so 6.5 mm into brick 2 along x; the least way out is along x or along the leaning brick's own normal, on which
  // brick 2's rear face reaches from its foot: 16.5 cos 0.5 = 14.5 mm ahead of the leaning face. So 6.5 mm or less, and more than 0.
  Motion motion{1, {{0.01, 0.0, 10.0, 0.0, 0.0, 0.0, 10.0}}, 0.06};
  HingedScript script({motion}, 0.0005);
  const Recording recording = record(row(3), script);
  const Overlap none = deepest_overlap(recording, 0.0);
  CHECK(none.depth == 0.0);
  CHECK(none.a == kNoBrick);
  const Overlap deep = deepest_overlap(recording, 0.1);
  CHECK(deep.a == 1);
  CHECK(deep.b == 2);
  const Layout& layout = recording.layout();
  const Vec3 half = half_extents(layout.kinds[0]);
  const double direct = -separation({hinged_pose(layout, 1, 0.5), half}, {standing_pose(layout, 2), half}) / 0.0075;
  CHECK(deep.depth == doctest::Approx(direct).epsilon(1e-4));
  CHECK(deep.depth == doctest::Approx((0.048 * std::sin(0.5) - 0.0165) / 0.0075).epsilon(1e-3));
  // Just before it touches there is none: asin(16.5 / 48) = 0.351 rad at 45.1 ms.
  CHECK(deepest_overlap(recording, 0.0450).depth == 0.0);
  CHECK(deepest_overlap(recording, 0.0453).depth > 0.0);
}

TEST_CASE("the deepest overlap finds one pair among many bricks") {
  Motion motion{137, {{0.01, 0.0, 10.0, 0.0, 0.0, 0.0, 10.0}}, 0.06};
  HingedScript script({motion}, 0.0005);
  const Recording recording = record(row(300), script);
  const Overlap deep = deepest_overlap(recording, 0.1);
  CHECK(deep.a == 137);
  CHECK(deep.b == 138);
}

#include <doctest/doctest.h>

#include <cmath>

#include "measure/teller.h"
#include "topple/measure.h"

using namespace topple;
using namespace topple::scripted;

namespace {

/// A row of three bricks that splits into two of two, a row that is pushed with the first, one that nothing reaches, a tower and a ball.
Layout branching() {
  auto layout = read_draft(
      "[[push]]\nangular_speed_rad_s = 4\n[[push]]\nbrick = 7\nangular_speed_rad_s = 4\n"
      "[[row]]\ncount = 3\npitch_mm = 24\n"
      "[[row]]\nfrom_mm = [72, 12]\ncount = 2\npitch_mm = 30\n"
      "[[row]]\nfrom_mm = [72, -12]\ncount = 2\npitch_mm = 40\n"
      "[[row]]\nfrom_mm = [0, 500]\ncount = 2\npitch_mm = 24\n"
      "[[row]]\nfrom_mm = [0, 900]\ncount = 2\npitch_mm = 24\n"
      "[[tower]]\nat_mm = [200, 0]\nlayers = 2\n"
      "[[ball]]\nat_mm = [400, 0]\n",
      "branching.toml");
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  return std::move(*layout);
}

void arrive(std::vector<Event>& events, double time, BrickId brick, BrickId by) {
  events.push_back(event(time - 0.01, by == kNoBrick ? EventKind::pushed : EventKind::struck, brick, by));
  events.push_back(event(time, EventKind::arrived, brick));
}

}  // namespace

TEST_CASE("the time sheet has the parts as the wave comes, each with who brought it, how long it took and how fast") {
  std::vector<Event> events;
  arrive(events, 0.10, 0, kNoBrick);
  arrive(events, 0.12, 7, kNoBrick);
  arrive(events, 0.14, 8, 7);
  arrive(events, 0.20, 1, 0);
  arrive(events, 0.40, 2, 1);
  arrive(events, 0.50, 5, 2);
  arrive(events, 0.52, 3, 2);
  arrive(events, 0.60, 6, 5);
  arrive(events, 0.77, 4, 3);
  const std::vector<PartTimes> sheet = measure_parts(told(branching(), events));
  std::vector<std::size_t> order;
  for (const PartTimes& times : sheet) order.push_back(times.part);
  // Rows 1 and 4 are pushed at one moment, rows 3 and 2 struck by brick 2, the rest is not reached.
  CHECK(order == std::vector<std::size_t>{0, 3, 2, 1, 4, 5, 6});
  CHECK(sheet[0].start == sheet[1].start);
  CHECK(sheet[2].start == sheet[3].start);
  CHECK(sheet[1].start < sheet[2].start);
  CHECK(sheet[4].start == -1);

  CHECK(sheet[0].pushed_at == 0.0);
  CHECK(sheet[0].from == kNoBrick);
  CHECK(sheet[0].reached == 3);
  CHECK(sheet[0].first_arrival == doctest::Approx(0.10));
  CHECK(sheet[0].last_arrival == doctest::Approx(0.40));
  // Two more bricks, 48 mm, in 0.3 s.
  CHECK(sheet[0].brick_rate == doctest::Approx(2.0 / 0.3));
  CHECK(sheet[0].speed == doctest::Approx(0.048 / 0.3));
  CHECK(sheet[3].from == 2);
  CHECK(std::isnan(sheet[3].pushed_at));
  CHECK(sheet[3].speed == doctest::Approx(0.030 / 0.25));
  CHECK(sheet[4].reached == 0);
  CHECK(std::isnan(sheet[4].first_arrival));
}

TEST_CASE("a wave that enters a line from its end is as fast, and a structure has no way along it") {
  Layout layout = branching();
  std::vector<Event> events;
  arrive(events, 0.1, 2, kNoBrick);
  arrive(events, 0.2, 1, 2);
  arrive(events, 0.3, 0, 1);
  const BrickId tower = layout.parts[5].first;
  arrive(events, 0.4, tower, 0);
  arrive(events, 0.6, tower + 1, tower);
  const std::vector<PartTimes> sheet = measure_parts(told(std::move(layout), events));
  REQUIRE(sheet[1].part == 5);
  CHECK(sheet[0].speed == doctest::Approx(0.048 / 0.2));
  CHECK(std::isnan(sheet[0].pushed_at));  // The push of the layout is on brick 0, which did not begin it.
  CHECK(sheet[1].from == 0);
  CHECK(sheet[1].brick_rate == doctest::Approx(5.0));
  CHECK(std::isnan(sheet[1].speed));
}

TEST_CASE("who brought the wave is of another part, also where a brick that did not pass ten degrees began it") {
  // Brick 3 is struck from row 1 and stays up, but its neighbour, struck by it, falls.
  std::vector<Event> events;
  arrive(events, 0.1, 0, kNoBrick);
  events.push_back(event(0.2, EventKind::struck, 3, 0));
  arrive(events, 0.4, 4, 3);
  const std::vector<PartTimes> sheet = measure_parts(told(branching(), events));
  REQUIRE(sheet[1].part == 1);
  CHECK(sheet[1].reached == 1);
  CHECK(sheet[1].from == 0);
  CHECK(std::isnan(sheet[1].brick_rate));
}

TEST_CASE("what a ball strikes on its way does not start together") {
  Layout layout = branching();
  const BrickId ball = layout.parts[6].first;
  std::vector<Event> events;
  arrive(events, 0.1, 3, ball);
  arrive(events, 5.0, 5, ball);
  const std::vector<PartTimes> sheet = measure_parts(told(std::move(layout), events));
  CHECK(sheet[0].from == ball);
  CHECK(sheet[1].from == ball);
  CHECK(sheet[0].start != sheet[1].start);
}

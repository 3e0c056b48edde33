// What geometry says against a layout before anything runs.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "topple/layout.h"

namespace topple {
namespace {

std::vector<Doubt> doubts_of(const std::string& text) {
  const auto layout = read_draft(text, "drawn.toml");
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  return find_doubts(*layout);
}

const std::string kPush = "[[push]]\nangular_speed_rad_s = 4\n";

TEST_CASE("a_row_in_reach_has_no_doubts") { CHECK(doubts_of(kPush + "[[row]]\ncount = 20\ngap_mm = 16.5\n").empty()); }

TEST_CASE("overlapping_bricks_are_read_as_a_draft_and_doubted") {
  const std::string text = kPush + "[[row]]\ncount = 2\ngap_mm = 16.5\n[[brick]]\nat_mm = [24, 0]\n";
  CHECK_FALSE(read_layout(text, "drawn.toml").has_value());
  const auto doubts = doubts_of(text);
  REQUIRE(!doubts.empty());
  CHECK(doubts[0].kind == Doubt::Kind::overlap);
  CHECK(doubts[0].brick == 2);
  CHECK(doubts[0].other == 1);
}

TEST_CASE("a_gap_wider_than_the_brick_is_beyond_reach_once") {
  // Two rows of three; 60 mm between them is more than the 48 mm that a brick reaches.
  const auto doubts = doubts_of(kPush + "[[row]]\ncount = 3\ngap_mm = 10\n[[row]]\nfrom_mm = [102.5, 0]\ncount = 3\ngap_mm = 10\n");
  REQUIRE(doubts.size() == 1);
  CHECK(doubts[0].kind == Doubt::Kind::beyond_reach);
  CHECK(doubts[0].brick == 3);
  CHECK(doubts[0].other == 2);
  CHECK(doubts[0].amount == doctest::Approx(0.060));
}

TEST_CASE("a_sharp_turn_says_who_misses_whom") {
  // Brick 1 heads along +x, brick 2 stands 24 mm ahead and 30 mm to the left: it begins 30 - 12 mm off the middle line, 6 mm past the
  // 12 mm that brick 1 sweeps.
  const auto doubts = doubts_of(kPush + "[[row]]\ncount = 2\ngap_mm = 16.5\n[[brick]]\nat_mm = [48, 30]\n");
  REQUIRE(doubts.size() == 1);
  CHECK(doubts[0].kind == Doubt::Kind::miss);
  CHECK(doubts[0].amount == doctest::Approx(0.006));
}

/// By how much `b` lies beside the band that `a` sweeps as it falls, from the corners of its foot [m].
double miss_of(const Brick& a, const Brick& b) {
  double least = 1.0, most = -1.0;
  for (const double along : {-0.00375, 0.00375}) {
    for (const double across : {-0.012, 0.012}) {
      const double x = b.foot.x - a.foot.x + along * std::cos(b.heading) - across * std::sin(b.heading);
      const double y = b.foot.y - a.foot.y + along * std::sin(b.heading) + across * std::cos(b.heading);
      const double aside = y * std::cos(a.heading) - x * std::sin(a.heading);
      least = std::min(least, aside);
      most = std::max(most, aside);
    }
  }
  return std::max({0.0, least - 0.012, -0.012 - most});
}

TEST_CASE("a_tight_turn_is_told_with_its_bricks_its_angle_and_the_miss") {
  // A right angle within 60 mm, by bricks 47.5 mm apart: the one before the corner falls past the one after it.
  const std::string text = kPush + "[[curve]]\npoints_mm = [[0, 0], [100, 0], [150, 10], [160, 60], [160, 160]]\ngap_mm = 40\n";
  const auto doubts = doubts_of(text);
  REQUIRE(!doubts.empty());
  CHECK(doubts[0].kind == Doubt::Kind::miss);
  const auto layout = read_draft(text, "drawn.toml");
  const Brick &a = layout->bricks[static_cast<std::size_t>(doubts[0].other)],
              &b = layout->bricks[static_cast<std::size_t>(doubts[0].brick)];
  CHECK(doubts[0].brick == doubts[0].other + 1);
  const double miss = miss_of(a, b);
  CHECK(doubts[0].amount == doctest::Approx(miss).epsilon(1e-9));
  // All of its bricks turn the same way, so that the turn is the whole curve's.
  double turn = 0.0;
  for (std::size_t i = 1; i < layout->bricks.size(); ++i) turn += layout->bricks[i].heading - layout->bricks[i - 1].heading;
  const int degrees = static_cast<int>(std::lround(turn * 180.0 / 3.14159265358979));
  const std::string tenths = std::to_string(std::lround(miss * 1e4));
  CHECK(doubts[0].words == "Turn of " + std::to_string(layout->bricks.size()) + " bricks in " + std::to_string(degrees) + "°: brick " +
                               std::to_string(doubts[0].other) + " misses " + std::to_string(doubts[0].brick) + " by " +
                               tenths.substr(0, tenths.size() - 1) + "." + tenths.back() + " mm.");
}

TEST_CASE("a_brick_in_the_middle_of_a_part_may_be_reached_from_beside_it") {
  // Three bricks 60 mm apart that head to +y, the first pushed; a row from the left falls on the second. Nothing falls on the third.
  const auto doubts = doubts_of(
      "[[push]]\nangular_speed_rad_s = 4\n[[push]]\nbrick = 3\nangular_speed_rad_s = 4\n[[row]]\nheading_deg = 90\ncount = 3\ngap_mm = 60\n"
      "[[row]]\nfrom_mm = [-72, 67.5]\ncount = 3\ngap_mm = 16.5\n");
  REQUIRE(doubts.size() == 1);
  CHECK(doubts[0].kind == Doubt::Kind::beyond_reach);
  CHECK(doubts[0].brick == 2);
  CHECK(doubts[0].other == 1);
}

TEST_CASE("a_brick_far_from_all_has_no_neighbour") {
  const auto doubts = doubts_of(kPush + "[[row]]\ncount = 2\ngap_mm = 16.5\n[[brick]]\nat_mm = [900, 900]\n");
  REQUIRE(doubts.size() == 1);
  CHECK(doubts[0].kind == Doubt::Kind::no_neighbour);
  CHECK(doubts[0].brick == 2);
}

}  // namespace
}  // namespace topple

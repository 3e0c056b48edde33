// What geometry says against a layout before anything runs.
#include <doctest/doctest.h>

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

TEST_CASE("a_brick_far_from_all_has_no_neighbour") {
  const auto doubts = doubts_of(kPush + "[[row]]\ncount = 2\ngap_mm = 16.5\n[[brick]]\nat_mm = [900, 900]\n");
  REQUIRE(doubts.size() == 1);
  CHECK(doubts[0].kind == Doubt::Kind::no_neighbour);
  CHECK(doubts[0].brick == 2);
}

}  // namespace
}  // namespace topple

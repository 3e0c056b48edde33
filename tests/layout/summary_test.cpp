#include <doctest/doctest.h>

#include "topple/layout.h"

namespace topple {

TEST_CASE("a summary counts bricks by kind and colour and measures length and box") {
  const auto layout = read_layout(
      "title = \"two\"\n[[kind]]\nname = \"a\"\n[[kind]]\nname = \"big\"\nheight_mm = 96\nwidth_mm = 48\nthickness_mm = 15\ncolor = "
      "\"#00ff0a\"\n"
      "[[kind]]\nname = \"unused\"\n"
      "[[row]]\ncount = 11\npitch_mm = 20\n[[row]]\nkind = \"big\"\nfrom_mm = [0, 1000]\nheading_deg = 90\ncount = 3\npitch_mm = 100\n",
      "test.toml");
  REQUIRE(layout.has_value());
  CHECK(layout->title == "two");
  const LayoutSummary summary = summarize(*layout);
  CHECK(summary.bricks == 14);
  CHECK(summary.length == doctest::Approx(0.2 + 0.2).epsilon(1e-14));
  CHECK(summary.low.x == doctest::Approx(-0.024));  // the big bricks, 48 across, look along y
  CHECK(summary.low.y == doctest::Approx(-0.012));
  CHECK(summary.low.z == 0.0);
  CHECK(summary.high.x == doctest::Approx(0.20375));
  CHECK(summary.high.y == doctest::Approx(1.2075));
  CHECK(summary.high.z == doctest::Approx(0.096));
  REQUIRE(summary.kinds.size() == 2);
  CHECK(summary.kinds[0].name == "a");
  CHECK(summary.kinds[0].bricks == 11);
  CHECK(summary.kinds[1].name == "big");
  CHECK(summary.kinds[1].bricks == 3);
  REQUIRE(summary.colors.size() == 2);
  CHECK(summary.colors[0].name == "#c0392b");
  CHECK(summary.colors[1].name == "#00ff0a");
  CHECK(summary.colors[1].bricks == 3);
}

}  // namespace topple

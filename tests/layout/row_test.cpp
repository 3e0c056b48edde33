#include <doctest/doctest.h>

#include <string>

#include "base/trigonometry.h"
#include "topple/layout.h"

namespace topple {
namespace {

Layout read(std::string_view text, std::vector<std::string> overrides = {}) {
  const auto layout = read_layout(text, "test.toml", overrides);
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  return *layout;
}

}  // namespace

TEST_CASE("a row stands at equal pitch along its heading") {
  const Layout layout = read("[[row]]\nfrom_mm = [10, 20]\nheading_deg = 30\ncount = 5\npitch_mm = 24\n");
  REQUIRE(layout.brick_count() == 5);
  for (int i = 0; i < 5; ++i) {
    const Brick& brick = layout.bricks[static_cast<std::size_t>(i)];
    CHECK(norm(brick.foot - Vec3{0.01 + 0.024 * i * 0.8660254037844386, 0.02 + 0.012 * i, 0.0}) < 1e-16);
    CHECK(brick.heading == doctest::Approx(kPi / 6.0).epsilon(1e-15));
    CHECK(brick.stance == Stance::standing);
  }
  REQUIRE(layout.parts.size() == 1);
  CHECK(layout.parts[0].name == "row 1");
  CHECK(layout.parts[0].first == 0);
  CHECK(layout.parts[0].count == 5);
}

TEST_CASE("without any kind a row is made of real toppling dominoes") {
  const Layout layout = read("[[row]]\ncount = 2\ngap_mm = 16.5\n");
  REQUIRE(layout.kinds.size() == 1);
  CHECK(layout.kinds[0].height == 0.048);
  CHECK(layout.kinds[0].width == 0.024);
  CHECK(layout.kinds[0].thickness == 0.0075);
  CHECK(layout.kinds[0].mass == 0.0085);
  CHECK(layout.bricks[1].foot.x == 0.0165 + 0.0075);  // gap is face to face, pitch foot to foot
}

TEST_CASE("a million bricks on, a row along x has not left its line") {
  const Layout layout = read("[[row]]\ncount = 1000000\npitch_mm = 24\n");
  CHECK(layout.bricks.back().foot == Vec3{999999 * 0.024, 0.0, 0.0});
  CHECK(layout.bricks.capacity() == 1000000);
}

TEST_CASE("quarter turns are exact") {
  const Vec3 ends[] = {{0.024, 0.0, 0.0}, {0.0, 0.024, 0.0}, {-0.024, 0.0, 0.0}, {0.0, -0.024, 0.0}};
  for (int turn = -8; turn <= 8; ++turn) {
    const Layout layout = read("[[row]]\ncount = 2\npitch_mm = 24\n", {"row.0.heading_deg=" + std::to_string(90 * turn)});
    CHECK(layout.bricks[1].foot == ends[(turn + 8) % 4]);
    CHECK(layout.bricks[1].heading == turn * (kPi / 2.0));
  }
}

TEST_CASE("a length is filled with as many bricks as fit foot to foot") {
  CHECK(read("[[row]]\nlength_mm = 2400\npitch_mm = 24\n").brick_count() == 101);
  CHECK(read("[[row]]\nlength_mm = 2399\npitch_mm = 24\n").brick_count() == 100);
  CHECK(read("[[row]]\nlength_mm = 0\npitch_mm = 24\n").brick_count() == 1);
  // 0.3 / 0.1 is a little less than 3 in binary numbers; a person means 3.
  CHECK(read("[[kind]]\nthickness_mm = 0.1\n[[row]]\nlength_mm = 0.3\npitch_mm = 0.1\n").brick_count() == 4);
}

TEST_CASE("a gap is measured between the faces that look along the row, whatever the pose") {
  CHECK(read("[[row]]\ncount = 2\ngap_mm = 10\npose = \"flat\"\n").bricks[1].foot.x == 0.010 + 0.048);
  CHECK(read("[[row]]\ncount = 2\ngap_mm = 10\npose = \"on_side\"\n").bricks[1].foot.x == 0.010 + 0.0075);
}

TEST_CASE("parts come in the order of the file") {
  const Layout layout = read(
      "[[brick]]\nat_mm = [0, 100]\n[[row]]\ncount = 3\ngap_mm = 10\n[[brick]]\nat_mm = [0, 100, 48]\nheading_deg = 90\npose = \"flat\"\n"
      "[[row]]\nfrom_mm = [0, 300]\ncount = 2\ngap_mm = 10\n");
  REQUIRE(layout.parts.size() == 4);
  CHECK(layout.parts[0].name == "brick 1");
  CHECK(layout.parts[1].name == "row 1");
  CHECK(layout.parts[2].name == "brick 2");
  CHECK(layout.parts[3].name == "row 2");
  CHECK(layout.parts[3].first == 5);
  CHECK(layout.bricks[4].foot == Vec3{0.0, 0.1, 0.048});
  CHECK(layout.bricks[4].heading == kPi / 2.0);
  CHECK(layout.bricks[4].stance == Stance::flat);
}

}  // namespace topple

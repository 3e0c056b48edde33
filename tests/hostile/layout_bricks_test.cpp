#include <doctest/doctest.h>

#include <string>

#include "topple/layout.h"

namespace topple {
namespace {

std::string wrong(std::string_view text) {
  const auto layout = read_layout(text, "t.toml");
  return layout ? "nothing is wrong" : layout.error().message;
}

}  // namespace

TEST_CASE("a push on a brick that is not there, or above its top, is refused") {
  CHECK(wrong("[[push]]\nbrick = 3\nangular_speed_rad_s = 4\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:9: push.0.brick: there is no brick 3; the bricks are 0 to 2");
  CHECK(wrong("[[push]]\nbrick = -1\nangular_speed_rad_s = 4\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:9: push.0.brick: must be a whole number from 0 to 2,147,483,647, is -1");
  CHECK(wrong("[[push]]\nbrick = 99999999999\nangular_speed_rad_s = 4\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:9: push.0.brick: must be a whole number from 0 to 2,147,483,647, is 99999999999");
  CHECK(wrong("[[push]]\nforce_n = 3\nduration_ms = 1\nheight_mm = 50\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:4:13: push.0.height_mm: must be a number from 0 to 48, the height of brick 0; is 50");
}

TEST_CASE("fifty million bricks by a slip of the finger are refused before they are made") {
  CHECK(wrong("[[row]]\ncount = 50000000\npitch_mm = 24\n") ==
        "t.toml:2:9: row.0.count: must be a whole number from 1 to 10,000,000, is 50000000");
  CHECK(wrong("[[row]]\ncount = 9223372036854775807\npitch_mm = 24\n") ==
        "t.toml:2:9: row.0.count: must be a whole number from 1 to 10,000,000, is 9223372036854775807");
  CHECK(wrong("[[row]]\ncount = 5e300\npitch_mm = 24\n") ==
        "t.toml:2:9: row.0.count: must be a whole number from 1 to 10,000,000, is 5e+300");
  CHECK(wrong("[[row]]\nlength_mm = 1e8\npitch_mm = 8\n") ==
        "t.toml:2:13: row.0.length_mm: would take 12,500,001 bricks; at most 10,000,000 are allowed");
  CHECK(wrong("[[row]]\ncount = 6000000\npitch_mm = 8\n[[row]]\nfrom_mm = [0, 100]\ncount = 6000000\npitch_mm = 8\n") ==
        "t.toml:4:1: row.1: up to here the layout has 12,000,000 bricks; at most 10,000,000 are allowed");
  CHECK(wrong("[[kind]]\nheight_mm = 0.1\nwidth_mm = 0.1\nthickness_mm = 0.1\n[[curve]]\npoints_mm = [[0, 0], [1e8, 1e8]]\ngap_mm = 0\n") ==
        "t.toml:6:13: curve.0.points_mm: would take 1,414,213,563 bricks; at most 10,000,000 are allowed");
}

TEST_CASE("bricks outside a sane range are refused") {
  CHECK(wrong("[[row]]\nfrom_mm = [1e9, 0]\ncount = 1\ngap_mm = 1\n") ==
        "t.toml:2:12: row.0.from_mm.0: must be a number from -100,000,000 to 100,000,000, is 1000000000");
  CHECK(wrong("[[brick]]\nat_mm = [0, 0, -1]\n") == "t.toml:2:16: brick.0.at_mm.2: must be a number from 0 to 100,000, is -1");
  CHECK(wrong("[[brick]]\nat_mm = [0, 0, 1e6]\n") == "t.toml:2:16: brick.0.at_mm.2: must be a number from 0 to 100,000, is 1000000");
  CHECK(wrong("[[brick]]\nat_mm = [0, -2e8]\nheading_deg = 1e9\n") ==
        "t.toml:2:13: brick.0.at_mm.1: must be a number from -100,000,000 to 100,000,000, is -200000000\n"
        "t.toml:3:15: brick.0.heading_deg: must be a number from -3,600 to 3,600, is 1000000000");
}

TEST_CASE("a place must have as many numbers as it has axes") {
  CHECK(wrong("[[row]]\nfrom_mm = [0]\ncount = 1\ngap_mm = 1\n") ==
        "t.toml:2:11: row.0.from_mm: must be two or three numbers [x, y] or [x, y, z], is a list of 1");
  CHECK(wrong("[[brick]]\nat_mm = [0, 0, 0, 0]\n") ==
        "t.toml:2:9: brick.0.at_mm: must be two or three numbers [x, y] or [x, y, z], is a list of 4");
  CHECK(wrong("[[curve]]\npoints_mm = [[0, 0], [0, 1, 2]]\ngap_mm = 1\n") ==
        "t.toml:2:22: curve.0.points_mm.1: must be two numbers [x, y], is a list of 3");
  CHECK(wrong("[[brick]]\nat_mm = [0, \"1\"]\n") ==
        "t.toml:2:13: brick.0.at_mm.1: must be a number from -100,000,000 to 100,000,000, is \"1\"");
}

TEST_CASE("a curve needs two points, each in another place than the one before") {
  CHECK(wrong("[[curve]]\npoints_mm = []\ngap_mm = 1\n") ==
        "t.toml:2:13: curve.0.points_mm: must be a list of at least two points [x, y], is a list of 0");
  CHECK(wrong("[[curve]]\npoints_mm = [[0, 0]]\ngap_mm = 1\n") ==
        "t.toml:2:13: curve.0.points_mm: must be a list of at least two points [x, y], is a list of 1");
  CHECK(wrong("[[curve]]\npoints_mm = [[0, 0], [100, 0], [100, 0], [200, 0]]\ngap_mm = 1\n") ==
        "t.toml:2:13: curve.0.points_mm: points 1 and 2 are in one place");
}

TEST_CASE("bricks that overlap are refused, both named") {
  CHECK(wrong("[[row]]\ncount = 3\npitch_mm = 5\n") ==
        "t.toml:3:12: row.0.pitch_mm: must be at least the brick's 7.5 along its heading, or the bricks overlap; is 5");
  CHECK(wrong("[[brick]]\nat_mm = [0, 0]\n[[brick]]\nat_mm = [1, 0]\n") ==
        "t.toml:3:1: brick.1: brick 0 (brick 1) and brick 1 (brick 2) overlap by 6.5 mm; bricks may touch, not overlap");
  CHECK(wrong("[[row]]\ncount = 100\npitch_mm = 24\n[[row]]\nfrom_mm = [504, -240]\nheading_deg = 90\ncount = 21\npitch_mm = 24\n") ==
        "t.toml:4:1: row.1: brick 21 (row 1) and brick 110 (row 2) overlap by 15.75 mm; bricks may touch, not overlap");
  CHECK(wrong("[[row]]\ncount = 3\ngap_mm = 10\n[[brick]]\nat_mm = [30, 0, 47]\n") ==
        "t.toml:4:1: brick.0: brick 2 (row 1) and brick 3 (brick 1) overlap by 1 mm; bricks may touch, not overlap");
}

TEST_CASE("all problems come at once, in the order of the file") {
  CHECK(wrong("titel = \"x\"\ngravity_m_s2 = -1\n[[push]]\nbrick = 7\nangular_speed_rad_s = 1\n[[row]]\ncount = 3\npitch_mm = 24\ncolor = "
              "3\n[[brick]]\nat_mm = [1]\n") ==
        "t.toml:1:1: titel: unknown key; the nearest known one is title\n"
        "t.toml:2:16: gravity_m_s2: must be a number above 0 and up to 1,000, is -1\n"
        "t.toml:9:9: row.0.color: must be a colour written \"#rrggbb\" with hexadecimal digits, is 3\n"
        "t.toml:11:9: brick.0.at_mm: must be two or three numbers [x, y] or [x, y, z], is a list of 1");
  CHECK(
      wrong(
          "titel = \"x\"\n[[row]]\ncount = 3\npitch_mm = 24\n[[brick]]\nat_mm = [1, 0]\n[[push]]\nbrick = 7\nangular_speed_rad_s = 1\n") ==
      "t.toml:1:1: titel: unknown key; the nearest known one is title\n"
      "t.toml:5:1: brick.0: brick 0 (row 1) and brick 3 (brick 1) overlap by 6.5 mm; bricks may touch, not overlap\n"
      "t.toml:8:9: push.0.brick: there is no brick 7; the bricks are 0 to 3");
}

}  // namespace topple

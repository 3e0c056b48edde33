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

TEST_CASE("a wall that cannot be laid is refused in words") {
  CHECK(wrong("[[wall]]\n") ==
        "t.toml:1:1: wall.0: at_mm must be there: the middle of its foot, [x, y] or [x, y, height of its foot]\n"
        "t.toml:1:1: wall.0: count must be there: the bricks of its lowest course\n"
        "t.toml:1:1: wall.0: courses must be there: how many bricks it is high");
  CHECK(wrong("[[wall]]\nat_mm = [0, 0]\ncount = 0\ncourses = 20000\ngap_mm = 30\nends = \"round\"\npose = \"lying\"\nlayers = 3\n") ==
        "t.toml:3:9: wall.0.count: must be a whole number from 1 to 10,000,000, is 0\n"
        "t.toml:4:11: wall.0.courses: must be a whole number from 1 to 10,000, is 20000\n"
        "t.toml:5:10: wall.0.gap_mm: must be a number from 0 to 24, is 30\n"
        "t.toml:6:8: wall.0.ends: must be \"half\", \"toothed\" or \"stepped\", is \"round\"\n"
        "t.toml:7:8: wall.0.pose: must be \"standing\", \"flat\" or \"on_side\", is \"lying\"\n"
        "t.toml:8:1: wall.0.layers: unknown key; the nearest known one is at_mm");
  CHECK(wrong("[[wall]]\nat_mm = [0, 0]\ncount = 5\ncourses = 6\nends = \"stepped\"\n") ==
        "t.toml:4:11: wall.0.courses: must be a whole number from 1 to 5, the bricks of the lowest course; is 6");
  CHECK(wrong("[[wall]]\nat_mm = [0, 0]\ncount = 1\ncourses = 6\nends = \"toothed\"\n") ==
        "t.toml:3:9: wall.0.count: must be at least 2 where the ends are \"toothed\"; is 1");
  CHECK(wrong("[[wall]]\nat_mm = [0, 0]\ncount = 10000000\ncourses = 10000\n") ==
        "t.toml:1:1: wall.0: would take 100,000,005,000 bricks; at most 10,000,000 are allowed");
  CHECK(wrong("[[kind]]\nheight_mm = 0.15\nwidth_mm = 1\nthickness_mm = 1\n[[wall]]\nat_mm = [0, 0]\ncount = 2\ncourses = 2\n") ==
        "t.toml:5:1: wall.0: half a brick would be 0.075 mm across, too small for a kind; ends may be \"toothed\" or \"stepped\"");
}

TEST_CASE("towers and pyramids that cannot be built are refused in words") {
  CHECK(wrong("[[tower]]\nat_mm = [0, 0]\nlayers = 3\ncount = 3\n") ==
        "t.toml:4:9: tower.0.count: must be a whole number from 1 to 2, as many as lie side by side on the layer below; is 3");
  CHECK(wrong("[[tower]]\nat_mm = [0]\n") ==
        "t.toml:1:1: tower.0: layers must be there: how many bricks it is high\n"
        "t.toml:2:9: tower.0.at_mm: must be two or three numbers [x, y] or [x, y, z], is a list of 1");
  CHECK(wrong("[[pyramid]]\nat_mm = [0, 0]\ncount_along = 4\ncount_across = 3\nlayers = 4\ngap_mm = 12.5\n") ==
        "t.toml:5:10: pyramid.0.layers: must be a whole number from 1 to 3, is 4\n"
        "t.toml:6:10: pyramid.0.gap_mm: must be a number from 0 to 12, is 12.5");
  CHECK(wrong("[[pyramid]]\nat_mm = [0, 0]\ncount_along = 10000\ncount_across = 10000\n") ==
        "t.toml:1:1: pyramid.0: would take 333,383,335,000 bricks; at most 10,000,000 are allowed");
}

TEST_CASE("a field that cannot be started is refused in words") {
  CHECK(wrong("[[field]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:1:1: field.0: rows must be there: how many there are side by side\n"
        "t.toml:1:1: field.0: row_pitch_mm must be there: from one row to the next");
  CHECK(wrong("[[field]]\nrows = 2\nrow_pitch_mm = 23\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:3:16: field.0.row_pitch_mm: must be at least the brick's 24 across its heading, or the rows overlap; is 23");
  CHECK(wrong("[[field]]\nrows = 2\nrow_pitch_mm = 50\ncount = 3\npitch_mm = 48\nstarter = \"line\"\npose = \"flat\"\n") ==
        "t.toml:3:16: field.0.row_pitch_mm: must be at least 120 where the starter is a line, so that it can turn into every row; is 50\n"
        "t.toml:7:8: field.0.pose: must be \"standing\" where the starter is a line");
  CHECK(wrong("[[field]]\nrows = 2\nrow_pitch_mm = 50\ncount = 3\npitch_mm = 24\nstarter = \"pushes\"\n") ==
        "t.toml:1:1: field.0: angular_speed_rad_s must be there: how each row's first brick is pushed");
  CHECK(wrong("[[field]]\nrows = 2\nrow_pitch_mm = 50\ncount = 3\npitch_mm = 24\nangular_speed_rad_s = 1\n") ==
        "t.toml:6:23: field.0.angular_speed_rad_s: goes with the starter \"pushes\" alone");
  CHECK(wrong("[[field]]\nrows = 10000\nrow_pitch_mm = 50\ncount = 10000\npitch_mm = 24\n") ==
        "t.toml:1:1: field.0: would take more than the 10,000,000 bricks that are allowed");
}

TEST_CASE("a picture that cannot be read is refused in words") {
  const std::string field = "[[field]]\nrow_pitch_mm = 32\npitch_mm = 16\n";
  CHECK(wrong(field + "picture = [\"ab\", \"ba\"]\n") ==
        "t.toml:1:1: field.0: palette must be there: a table of a colour for each letter of the picture, { a = \"#rrggbb\" }");
  CHECK(wrong(field + "palette = { a = \"#000000\" }\n") ==
        "t.toml:1:1: field.0: rows must be there: how many there are side by side\n"
        "t.toml:1:1: field.0: exactly one of count and length_mm must be there\n"
        "t.toml:4:11: field.0.palette: goes with a picture alone");
  CHECK(wrong(field + "palette = 3\npicture = \"ab\"\n") ==
        "t.toml:4:11: field.0.palette: must be a table of a colour for each letter of the picture, { a = \"#rrggbb\" }, is 3\n"
        "t.toml:5:11: field.0.picture: must be a list of at most 10,000,000 lines, is \"ab\"");
  CHECK(wrong(field + "palette = { ab = \"#000000\", \"\" = \"#000000\", \"\u00e9\" = \"#000000\", c = \"red\", d = 1 }\npicture = [\"c\", "
                      "5, \"\"]\n") ==
        "t.toml:4:13: field.0.palette.ab: must be a single letter, digit or sign of ASCII\n"
        "t.toml:4:29: field.0.palette.: must be a single letter, digit or sign of ASCII\n"
        "t.toml:4:45: field.0.palette.\u00e9: must be a single letter, digit or sign of ASCII\n"
        "t.toml:4:62: field.0.palette.c: must be a colour written \"#rrggbb\" with hexadecimal digits, is \"red\"\n"
        "t.toml:4:73: field.0.palette.d: must be a colour written \"#rrggbb\" with hexadecimal digits, is 1\n"
        "t.toml:5:17: field.0.picture.1: must be text, a letter for each brick of a row; is 5\n"
        "t.toml:5:20: field.0.picture.2: must be text, a letter for each brick of a row; is \"\"");
  const std::string palette = field + "palette = { a = \"#000000\", b = \"#ffffff\" }\n";
  CHECK(wrong(palette + "picture = []\n") == "t.toml:5:11: field.0.picture: must have a line for each row; is a list of 0");
  // The column is that of the letter itself.
  CHECK(wrong(palette + "picture = [\n  \"aab\",\n  \"acb\",\n  \"ab\u00e9\",\n  \"ab\",\n  \"aba\"\n]\n") ==
        "t.toml:7:5: field.0.picture.1: the palette has no \"c\"\n"
        "t.toml:8:6: field.0.picture.2: the palette has no \"\u00e9\"\n"
        "t.toml:9:3: field.0.picture.3: must have the 3 letters of the first line, has 2");
  CHECK(wrong(palette + "picture = [\"aab\", \"aba\"]\nrows = 3\ncount = 4\n") ==
        "t.toml:6:8: field.0.rows: must be the 2 lines of the picture, is 3\n"
        "t.toml:7:9: field.0.count: must be the 3 letters of each of the picture's lines, is 4");
  CHECK(wrong(palette + "picture = [\"aab\"]\nlength_mm = 16\n") ==
        "t.toml:6:13: field.0.length_mm: gives rows of 2 bricks, not the 3 letters of each of the picture's lines");
}

TEST_CASE("a picture of more bricks than are allowed is refused at once") {
  std::string lines;
  for (int i = 0; i < 1001; ++i) lines += "\"" + std::string(10'000, 'a') + "\",\n";
  CHECK(wrong("[[field]]\nrow_pitch_mm = 32\npitch_mm = 16\npalette = { a = \"#000000\" }\npicture = [\n" + lines + "]\n") ==
        "t.toml:1:1: field.0: would take more than the 10,000,000 bricks that are allowed");
}

TEST_CASE("a ball that cannot be is refused in words") {
  CHECK(wrong("[[ball]]\n") == "t.toml:1:1: ball.0: at_mm must be there: its lowest point, [x, y] or [x, y, height]");
  CHECK(wrong("[[ball]]\nat_mm = [0, 0]\nspeed_m_s = 1000\ndiameter_mm = 0\nmass_g = -1\nbrick_friction = 11\n") ==
        "t.toml:3:13: ball.0.speed_m_s: must be a number from 0 to 100, is 1000\n"
        "t.toml:4:15: ball.0.diameter_mm: must be a number from 0.1 to 20,000, is 0\n"
        "t.toml:5:10: ball.0.mass_g: must be a number above 0 and up to 1,000,000,000, is -1\n"
        "t.toml:6:18: ball.0.brick_friction: must be a number from 0 to 10, is 11");
  CHECK(wrong("[[ball]]\nat_mm = [0, 0]\nmass_g = 1\ndensity_kg_m3 = 1\nname = \"domino\"\nat_s = 1\n") ==
        "t.toml:1:1: ball.0: mass_g and density_kg_m3 are both there; at most one may be\n"
        "t.toml:5:8: ball.0.name: two kinds are called \"domino\"\n"
        "t.toml:6:8: ball.0.at_s: goes with speed_m_s alone: when the ball begins to roll");
  CHECK(wrong("[[ball]]\nat_mm = [0, 0]\n[[push]]\nbrick = 0\nangular_speed_rad_s = 1\n") ==
        "t.toml:4:9: push.0.brick: brick 0 is a ball and has no toe to turn about; push it with force_n or impulse_n_s");
  CHECK(wrong("[[ball]]\nat_mm = [0, 0, 5]\n") == "t.toml:1:1: ball.0: brick 0 (ball 1) is 5 mm above the floor with no brick under it");
}

TEST_CASE("a pair of surfaces that is not there, or given twice, is refused") {
  CHECK(wrong("[[pair]]\nkind = \"domino\"\nwith = \"dominno\"\n[[row]]\ncount = 1\ngap_mm = 1\n") ==
        "t.toml:1:1: pair.0: friction or restitution must be there, or both\n"
        "t.toml:3:8: pair.0.with: there is no kind \"dominno\"; the nearest is \"domino\"");
  CHECK(wrong("[[pair]]\nfriction = -1\nrestitution = 2\n[[row]]\ncount = 1\ngap_mm = 1\n") ==
        "t.toml:1:1: pair.0: kind must be there: the name of a kind\n"
        "t.toml:1:1: pair.0: with must be there: the name of a kind\n"
        "t.toml:2:12: pair.0.friction: must be a number from 0 to 10, is -1\n"
        "t.toml:3:15: pair.0.restitution: must be a number from 0 to 1, is 2");
  const std::string twice = "[[pair]]\nkind = \"domino\"\nwith = \"domino\"\nfriction = 1\n";
  CHECK(wrong(twice + twice + "[[row]]\ncount = 1\ngap_mm = 1\n") == "t.toml:7:8: pair.1.with: this pair has been given before");
}

}  // namespace topple

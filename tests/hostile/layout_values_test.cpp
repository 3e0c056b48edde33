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

TEST_CASE("an unknown key is named with the nearest known one") {
  CHECK(wrong("colour = 1\n[[row]]\ncount = 3\npitch_mm = 24\n") == "t.toml:1:1: colour: unknown key; the nearest known one is tower");
  CHECK(wrong("[[row]]\ncuont = 3\ncount = 3\npitch_mm = 24\n") == "t.toml:2:1: row.0.cuont: unknown key; the nearest known one is count");
  CHECK(wrong("[rows]\n") ==
        "t.toml:1:1: the layout is empty; it needs at least one [[row]], [[curve]] or [[brick]]\n"
        "t.toml:1:2: rows: unknown key; the nearest known one is row");
  CHECK(wrong("[contact]\nfriction = 1\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:1: contact.friction: unknown key; the nearest known one is brick_friction");
  CHECK(wrong("[[kind]]\nheigth_mm = 48\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:1: kind.0.heigth_mm: unknown key; the nearest known one is height_mm");
  CHECK(wrong("[[push]]\nangular_speed = 4\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:1:1: push.0: exactly one of angular_speed_rad_s, force_n and impulse_n_s must be there\n"
        "t.toml:2:1: push.0.angular_speed: unknown key; the nearest known one is angular_speed_rad_s");
  CHECK(wrong("[[curve]]\npoints_mm = [[0, 0], [100, 0]]\ngap = 5\ngap_mm = 5\n") ==
        "t.toml:3:1: curve.0.gap: unknown key; the nearest known one is gap_mm");
  CHECK(wrong("[[brick]]\nat_mm = [0, 0]\nstance = \"flat\"\n") ==
        "t.toml:3:1: brick.0.stance: unknown key; the nearest known one is at_mm");
  CHECK(wrong("[noise]\nsede = 1\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:1: noise.sede: unknown key; the nearest known one is seed");
}

TEST_CASE("a value of the wrong type is refused") {
  CHECK(wrong("gravity_m_s2 = \"9.81\"\ntitle = 3\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:1:16: gravity_m_s2: must be a number above 0 and up to 1,000, is \"9.81\"\n"
        "t.toml:2:9: title: must be text, is 3");
  CHECK(wrong("[[row]]\ncount = \"3\"\npitch_mm = true\n") ==
        "t.toml:2:9: row.0.count: must be a whole number from 1 to 10,000,000, is \"3\"\n"
        "t.toml:3:12: row.0.pitch_mm: must be a number above 0 and up to 40,000, is true");
  CHECK(wrong("[[row]]\ncount = 2.5\npitch_mm = [1]\n") ==
        "t.toml:2:9: row.0.count: must be a whole number from 1 to 10,000,000, is 2.5\n"
        "t.toml:3:12: row.0.pitch_mm: must be a number above 0 and up to 40,000, is a list of 1");
  CHECK(wrong("[[row]]\ncount = 1979-05-27\npitch_mm = {a = 1}\n") ==
        "t.toml:2:9: row.0.count: must be a whole number from 1 to 10,000,000, is a date or time\n"
        "t.toml:3:12: row.0.pitch_mm: must be a number above 0 and up to 40,000, is a table");
  CHECK(wrong("[row]\ncount = 1\n") == "t.toml:1:1: row: must be a table in a list, [[row]]; is a table");
  CHECK(wrong("row = 3\n") == "t.toml:1:7: row: must be a table in a list, [[row]]; is 3");
  CHECK(wrong("row = [1, 2]\n") ==
        "t.toml:1:8: row.0: must be a table in a list, [[row]]; is 1\n"
        "t.toml:1:11: row.1: must be a table in a list, [[row]]; is 2");
  CHECK(wrong("noise = 3\nmodel = 4\ncontact = 5\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:1:9: noise: must be a table, [noise]; is 3\n"
        "t.toml:2:9: model: must be a table, [model]; is 4\n"
        "t.toml:3:11: contact: must be a table, [contact]; is 5");
  CHECK(wrong("[model]\na = [1]\nb = {c = 1}\nd = 1979-05-27\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:5: model.a: must be a number, text, true or false; is a list of 1\n"
        "t.toml:3:5: model.b: must be a number, text, true or false; is a table\n"
        "t.toml:4:5: model.d: must be a number, text, true or false; is a date or time");
  CHECK(wrong("[[row]]\nfrom_mm = 5\ncount = 1\ngap_mm = 1\n") ==
        "t.toml:2:11: row.0.from_mm: must be two or three numbers [x, y] or [x, y, z], is 5");
}

TEST_CASE("sizes, masses and the rest have their ranges") {
  CHECK(wrong("[[kind]]\nheight_mm = 0\nwidth_mm = -24\nthickness_mm = 0.05\nmass_g = 0\ncolor = \"red\"\nbrick_friction = "
              "-1\nfloor_friction = 11\nbrick_restitution = 1.5\nfloor_restitution = -0.5\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:13: kind.0.height_mm: must be a number from 0.1 to 20,000, is 0\n"
        "t.toml:3:12: kind.0.width_mm: must be a number from 0.1 to 20,000, is -24\n"
        "t.toml:4:16: kind.0.thickness_mm: must be a number from 0.1 to 20,000, is 0.05\n"
        "t.toml:5:10: kind.0.mass_g: must be a number above 0 and up to 1,000,000,000, is 0\n"
        "t.toml:6:9: kind.0.color: must be a colour written \"#rrggbb\" with hexadecimal digits, is \"red\"\n"
        "t.toml:7:18: kind.0.brick_friction: must be a number from 0 to 10, is -1\n"
        "t.toml:8:18: kind.0.floor_friction: must be a number from 0 to 10, is 11\n"
        "t.toml:9:21: kind.0.brick_restitution: must be a number from 0 to 1, is 1.5\n"
        "t.toml:10:21: kind.0.floor_restitution: must be a number from 0 to 1, is -0.5");
  CHECK(wrong("[[kind]]\nheight_mm = 20001\ndensity_kg_m3 = -1\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:13: kind.0.height_mm: must be a number from 0.1 to 20,000, is 20001\n"
        "t.toml:3:17: kind.0.density_kg_m3: must be a number above 0 and up to 30,000, is -1");
  CHECK(wrong("[[kind]]\nthickness_mm = 0.1\nheight_mm = 1000\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:1:1: kind.0: its longest side must be at most 1,000 times its shortest, is 10,000 times");
  CHECK(wrong("gravity_m_s2 = 0\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:1:16: gravity_m_s2: must be a number above 0 and up to 1,000, is 0");
  CHECK(wrong("[[row]]\ncount = 0\ngap_mm = -1\n") ==
        "t.toml:2:9: row.0.count: must be a whole number from 1 to 10,000,000, is 0\n"
        "t.toml:3:10: row.0.gap_mm: must be a number from 0 to 20,000, is -1");
  CHECK(wrong("[[row]]\nlength_mm = -1\npitch_mm = 0\n") ==
        "t.toml:2:13: row.0.length_mm: must be a number from 0 to 100,000,000, is -1\n"
        "t.toml:3:12: row.0.pitch_mm: must be a number above 0 and up to 40,000, is 0");
  CHECK(wrong("[noise]\nseed = -1\nposition_mm = -1\nheading_deg = 181\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:8: noise.seed: must be a whole number from 0 to 9,223,372,036,854,775,807, is -1\n"
        "t.toml:3:15: noise.position_mm: must be a number from 0 to 1,000, is -1\n"
        "t.toml:4:15: noise.heading_deg: must be a number from 0 to 180, is 181");
  CHECK(wrong("[[brick]]\nat_mm = [0, 0]\ncolor = \"#12345g\"\npose = \"upright\"\n") ==
        "t.toml:3:9: brick.0.color: must be a colour written \"#rrggbb\" with hexadecimal digits, is \"#12345g\"\n"
        "t.toml:4:8: brick.0.pose: must be \"standing\", \"flat\" or \"on_side\", is \"upright\"");
}

TEST_CASE("what is not a number or not finite is refused") {
  CHECK(wrong("gravity_m_s2 = nan\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:1:16: gravity_m_s2: must be a number above 0 and up to 1,000, is nan");
  CHECK(wrong("[[row]]\nfrom_mm = [nan, -inf]\nheading_deg = inf\ncount = 3\npitch_mm = nan\n") ==
        "t.toml:2:12: row.0.from_mm.0: must be a number from -100,000,000 to 100,000,000, is nan\n"
        "t.toml:2:17: row.0.from_mm.1: must be a number from -100,000,000 to 100,000,000, is -inf\n"
        "t.toml:3:15: row.0.heading_deg: must be a number from -3,600 to 3,600, is inf\n"
        "t.toml:5:12: row.0.pitch_mm: must be a number above 0 and up to 40,000, is nan");
  CHECK(wrong("[[kind]]\nheight_mm = nan\nmass_g = inf\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:13: kind.0.height_mm: must be a number from 0.1 to 20,000, is nan\n"
        "t.toml:3:10: kind.0.mass_g: must be a number above 0 and up to 1,000,000,000, is inf");
  CHECK(wrong("[[push]]\nat_s = nan\nangular_speed_rad_s = inf\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:8: push.0.at_s: must be a number from 0 to 1,000,000, is nan\n"
        "t.toml:3:23: push.0.angular_speed_rad_s: must be a number from 0 to 10,000, is inf");
  CHECK(wrong("[[row]]\ncount = nan\ngap_mm = inf\n") ==
        "t.toml:2:9: row.0.count: must be a whole number from 1 to 10,000,000, is nan\n"
        "t.toml:3:10: row.0.gap_mm: must be a number from 0 to 20,000, is inf");
  CHECK(wrong("[noise]\nposition_mm = nan\nheading_deg = inf\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:15: noise.position_mm: must be a number from 0 to 1,000, is nan\n"
        "t.toml:3:15: noise.heading_deg: must be a number from 0 to 180, is inf");
  CHECK(wrong("[[curve]]\npoints_mm = [[0, 0], [nan, 1]]\ngap_mm = 5\n") ==
        "t.toml:2:23: curve.0.points_mm.1.0: must be a number from -100,000,000 to 100,000,000, is nan");
}

TEST_CASE("of keys that exclude each other exactly one must be there") {
  CHECK(wrong("[[row]]\n") ==
        "t.toml:1:1: row.0: exactly one of count and length_mm must be there\n"
        "t.toml:1:1: row.0: exactly one of pitch_mm and gap_mm must be there");
  CHECK(wrong("[[row]]\ncount = 3\npitch_mm = 24\ngap_mm = 3\nlength_mm = 3\n") ==
        "t.toml:1:1: row.0: count and length_mm are both there; exactly one must be\n"
        "t.toml:1:1: row.0: pitch_mm and gap_mm are both there; exactly one must be");
  CHECK(wrong("[[kind]]\nmass_g = 1\ndensity_kg_m3 = 3\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:1:1: kind.0: mass_g and density_kg_m3 are both there; at most one may be");
  CHECK(wrong("[[curve]]\ngap_mm = 1\n") ==
        "t.toml:1:1: curve.0: points_mm must be there: the points [x, y] that the curve passes through");
  CHECK(wrong("[[brick]]\n") == "t.toml:1:1: brick.0: at_mm must be there: where the brick stands, [x, y] or [x, y, height of its foot]");
  CHECK(wrong("[[push]]\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:1:1: push.0: exactly one of angular_speed_rad_s, force_n and impulse_n_s must be there");
  CHECK(wrong("[[push]]\nangular_speed_rad_s = 1\nforce_n = 3\nduration_ms = 1\nheight_mm = 40\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:1:1: push.0: exactly one of angular_speed_rad_s, force_n and impulse_n_s must be there");
  CHECK(wrong("[[push]]\nforce_n = 3\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:1:1: push.0: height_mm must be there: how far above the brick's foot it is pushed\n"
        "t.toml:1:1: push.0: duration_ms must be there: how long the force acts");
  CHECK(wrong("[[push]]\nangular_speed_rad_s = 1\nheight_mm = 40\nduration_ms = 1\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:3:13: push.0.height_mm: goes with force_n or impulse_n_s, not with angular_speed_rad_s\n"
        "t.toml:4:15: push.0.duration_ms: goes with force_n alone");
  CHECK(wrong("[[push]]\nimpulse_n_s = 1\nheight_mm = 40\nduration_ms = 1\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:4:15: push.0.duration_ms: goes with force_n alone");
}

TEST_CASE("kinds must have names of their own, and parts must name one that is there") {
  CHECK(wrong("[[kind]]\nname = \"a\"\n[[kind]]\nname = \"a\"\n[[kind]]\n[[kind]]\nname = \"\"\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:4:8: kind.1.name: two kinds are called \"a\"\n"
        "t.toml:5:1: kind.2: name must be there; only the first kind may go without\n"
        "t.toml:7:8: kind.3.name: must not be empty");
  CHECK(wrong("[[kind]]\nname = \"small\"\n[[row]]\nkind = \"smal\"\ncount = 1\ngap_mm = 1\n") ==
        "t.toml:4:8: row.0.kind: there is no kind \"smal\"; the nearest is \"small\"");
}

TEST_CASE("integers that do not fit are refused") {
  CHECK(wrong("[[row]]\ncount = 9223372036854775808\npitch_mm = 24\n") ==
        "t.toml:2:28: not TOML: while parsing decimal integer: '9223372036854775808' is not representable in 64 bits");
  CHECK(wrong("[noise]\nseed = 99999999999999999999\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:2:28: not TOML: while parsing decimal integer: '99999999999999999999' is not representable in 64 bits");
  CHECK(wrong("gravity_m_s2 = 1e400\n") ==
        "t.toml:1:21: not TOML: while parsing floating-point: '1e400' could not be interpreted as a value");
}

}  // namespace topple

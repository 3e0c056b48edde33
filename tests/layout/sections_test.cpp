#include <doctest/doctest.h>

#include <map>
#include <string>

#include "topple/layout.h"

namespace topple {
namespace {

Layout read(std::string text, std::vector<std::string> overrides = {}) {
  const auto layout = read_layout(text, "test.toml", overrides);
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  return *layout;
}

constexpr const char* kRow = "[[row]]\ncount = 3\npitch_mm = 24\n";

std::map<std::string, Setting> settings(const Layout& layout) {
  std::map<std::string, Setting> by_key;
  for (const Setting& setting : layout.model) by_key[setting.key] = setting;
  return by_key;
}

}  // namespace

TEST_CASE("the contact of a layout is that of every kind which does not say otherwise") {
  const Layout layout = read(std::string("[contact]\nbrick_friction = 0.3\nfloor_restitution = 0.1\n[[kind]]\nname = \"a\"\n[[kind]]\nname "
                                         "= \"b\"\nbrick_friction = 0.4\n") +
                             kRow);
  CHECK(layout.kinds[0].surface.brick_friction == 0.3);
  CHECK(layout.kinds[0].surface.floor_friction == 0.5);
  CHECK(layout.kinds[0].surface.brick_restitution == 0.0);
  CHECK(layout.kinds[0].surface.floor_restitution == 0.1);
  CHECK(layout.kinds[1].surface.brick_friction == 0.4);
  CHECK(layout.kinds[1].surface.floor_restitution == 0.1);
  CHECK(read(std::string("[contact]\nfloor_friction = 0.25\n") + kRow).kinds[0].surface.floor_friction == 0.25);
}

TEST_CASE("the mass of a kind is given, or follows from its density, or from that of a real domino") {
  CHECK(read(std::string("[[kind]]\nmass_g = 44.6\n") + kRow).kinds[0].mass == 0.0446);
  // 1040 kg/m^3 times 48 x 24 x 7.5 mm
  CHECK(read(std::string("[[kind]]\ndensity_kg_m3 = 1040\n") + kRow).kinds[0].mass == doctest::Approx(1040 * 8.64e-6).epsilon(1e-15));
  CHECK(read(std::string("[[kind]]\n") + kRow).kinds[0].mass == 0.0085);
  CHECK(read(std::string("[[kind]]\nheight_mm = 96\n") + kRow).kinds[0].mass == doctest::Approx(0.017).epsilon(1e-15));
}

TEST_CASE("the three ways to push") {
  const Layout layout = read(
      std::string(kRow) +
      "[[push]]\nbrick = 0\nangular_speed_rad_s = 4\n[[push]]\nbrick = 1\nat_s = 0.5\nforce_n = 0.5\nheight_mm = 48\nduration_ms = 10\n"
      "[[push]]\nbrick = 2\nimpulse_n_s = 0.001\nheight_mm = 24\n");
  REQUIRE(layout.pushes.size() == 3);
  CHECK(std::get<AngularSpeedPush>(layout.pushes[0].how).angular_speed == 4.0);
  CHECK(layout.pushes[0].at == 0.0);
  CHECK(layout.pushes[1].brick == 1);
  CHECK(layout.pushes[1].at == 0.5);
  const auto force = std::get<ForcePush>(layout.pushes[1].how);
  CHECK(force.force == 0.5);
  CHECK(force.height == 0.048);
  CHECK(force.duration == 0.01);
  const auto impulse = std::get<ImpulsePush>(layout.pushes[2].how);
  CHECK(impulse.impulse == 0.001);
  CHECK(impulse.height == 0.024);
  CHECK(read(kRow).pushes.empty());
}

TEST_CASE("a part is of the kind it names, in the colour of its kind unless it has its own") {
  const Layout layout = read(
      "[[kind]]\nname = \"a\"\ncolor = \"#010203\"\n[[kind]]\nname = \"b\"\ncolor = \"#040506\"\n"
      "[[brick]]\nat_mm = [0, 0]\n[[brick]]\nat_mm = [100, 0]\nkind = \"b\"\n[[brick]]\nat_mm = [200, 0]\nkind = \"b\"\ncolor = "
      "\"#AABBCC\"\n");
  const auto color = [&](std::size_t i) { return layout.colors[layout.bricks[i].color]; };
  CHECK(layout.bricks[0].kind == 0);
  CHECK(layout.bricks[1].kind == 1);
  CHECK(color(0) == Color{1, 2, 3});
  CHECK(color(1) == Color{4, 5, 6});
  CHECK(color(2) == Color{0xAA, 0xBB, 0xCC});
}

TEST_CASE("the settings of the model are passed on as they are, with the place they come from") {
  const auto by_key = settings(read(std::string(kRow) + "[model]\nname = \"pivot\"\ntime_step_s = 0.001\nsteps = 3\nexact = true\n",
                                    {"hit=report", "time_step_s=1e-4", "model.pulse_ms=5"}));
  CHECK(by_key.size() == 6);
  CHECK(std::get<std::string>(by_key.at("name").value) == "pivot");
  CHECK(by_key.at("name").where == "test.toml:5:8");
  CHECK(std::get<double>(by_key.at("steps").value) == 3.0);
  CHECK(std::get<bool>(by_key.at("exact").value));
  CHECK(std::get<std::string>(by_key.at("hit").value) == "report");
  CHECK(by_key.at("hit").where == "--set hit");
  CHECK(std::get<double>(by_key.at("time_step_s").value) == 1e-4);
  CHECK(by_key.at("time_step_s").where == "--set time_step_s");
  CHECK(by_key.at("pulse_ms").where == "--set model.pulse_ms");
}

TEST_CASE("an override changes any value of the file, and adds what is not there") {
  const Layout layout = read(kRow, {"row.0.count=50", "contact.brick_friction=0.3", "title=Ten, or so", "gravity_m_s2=1.62", "noise.seed=3",
                                    "row.0.color=\"#102030\""});
  CHECK(layout.brick_count() == 50);
  CHECK(layout.kinds[0].surface.brick_friction == 0.3);
  CHECK(layout.title == "Ten, or so");
  CHECK(layout.gravity == 1.62);
  CHECK(layout.colors[0] == Color{0x10, 0x20, 0x30});
  CHECK(layout.overrides.size() == 6);
  CHECK(read(kRow, {"row.0.count=50", "row.0.count=7"}).brick_count() == 7);  // the last one holds
  CHECK(read("[[curve]]\npoints_mm = [[0, 0], [9, 0]]\ngap_mm = 1\n", {"curve.0.points_mm.1.0=85"}).brick_count() == 11);
  CHECK(read("[[curve]]\npoints_mm = [[0, 0], [9, 0]]\ngap_mm = 1\n", {"curve.0.points_mm=[[0,0],[0,85]]"}).brick_count() == 11);
}

TEST_CASE("a layout read again from what it was read from is the same layout") {
  const Layout layout = read(kRow, {"row.0.count=50", "noise.position_mm=0.1"});
  const auto again = read_layout(layout.text, layout.name, layout.overrides);
  REQUIRE(again.has_value());
  REQUIRE(again->brick_count() == 50);
  for (std::size_t i = 0; i < 50; ++i) CHECK(again->bricks[i].foot == layout.bricks[i].foot);
}

TEST_CASE("a file with Windows line ends and a byte order mark reads like any other") {
  CHECK(read("\xEF\xBB\xBFtitle = \"x\"\r\n[[row]]\r\ncount = 3\r\npitch_mm = 24\r\n").brick_count() == 3);
}

TEST_CASE("a line of 24 km and 500,000 dominoes at an inch and more is a layout") {
  CHECK(read("[[row]]\nlength_mm = 24e6\npitch_mm = 48\n").brick_count() == 500001);
}

TEST_CASE("a brush gives bricks of a part colours of their own, the last stroke on top, and moves none of them") {
  const std::string plain = "[[row]]\nfrom_mm = [0, 100]\ncount = 6\npitch_mm = 24\ncolor = \"#101010\"\n";
  const Layout layout = read(std::string(kRow) + plain + "paint = [[1, 4, \"#202020\"], [2, 2, \"#303030\"], [5, 90, \"#404040\"]]\n");
  const auto red = [&](std::size_t brick) { return layout.colors[layout.bricks[brick].color].red; };
  const int expected[] = {0x10, 0x20, 0x30, 0x20, 0x20, 0x40};  // the second part's: the first three bricks are another row's
  for (std::size_t i = 0; i < 6; ++i) CHECK(red(3 + i) == expected[i]);
  CHECK(layout.bricks.size() == 9);
  CHECK(red(0) == red(2));
}

TEST_CASE("a stroke of the brush that is none is told with its place") {
  const auto words = [](const std::string& stroke) {
    const auto layout = read_layout(std::string(kRow) + "paint = [[0, 1, \"#202020\"], " + stroke + "]\n", "test.toml");
    REQUIRE(!layout.has_value());
    return layout.error().message;
  };
  for (const char* bad : {"[1, 2]", "[2, 1, \"#202020\"]", "[-1, 1, \"#202020\"]", "[0, 1, \"blue\"]", "[0.5, 1, \"#202020\"]", "7"}) {
    CHECK(words(bad).starts_with("test.toml:4:29: row.0.paint.1: must be [first brick, last brick, \"#rrggbb\"]"));
  }
  CHECK(read_layout(std::string(kRow) + "paint = 3\n", "test.toml")
            .error()
            .message.starts_with("test.toml:4:9: row.0.paint: must be a list"));
}

}  // namespace topple

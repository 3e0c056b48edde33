#include <doctest/doctest.h>

#include <string>

#include "topple/layout.h"

namespace topple {
namespace {

constexpr std::string_view kFile = "[[row]]\ncount = 3\npitch_mm = 24\n[[row]]\nfrom_mm = [0, 100]\ncount = 3\npitch_mm = 24\n";

std::string wrong(std::vector<std::string> overrides) {
  const auto layout = read_layout(kFile, "t.toml", overrides);
  return layout ? "nothing is wrong" : layout.error().message;
}

}  // namespace

TEST_CASE("an override that is not key=value is refused") {
  const std::string why = ": must be key=value, the key words joined by dots, such as row.0.count=50";
  CHECK(wrong({"pitch"}) == "--set pitch" + why);
  CHECK(wrong({""}) == "--set " + why);
  CHECK(wrong({"=5"}) == "--set " + why);
  CHECK(wrong({"row..count=5"}) == "--set row..count" + why);
  CHECK(wrong({"row.0.count.=5"}) == "--set row.0.count." + why);
  CHECK(wrong({"a.a.a.a.a.a.a.a.a=5"}) == "--set a.a.a.a.a.a.a.a.a" + why);
}

TEST_CASE("an override of what is not there is refused") {
  CHECK(wrong({"row.2.count=5"}) == "--set row.2.count: row: there is no entry \"2\" in this list; its entries are 0 to 1");
  CHECK(wrong({"row.count=5"}) == "--set row.count: row: there is no entry \"count\" in this list; its entries are 0 to 1");
  CHECK(wrong({"row.99999999999999999999.count=5"}) ==
        "--set row.99999999999999999999.count: row: there is no entry \"99999999999999999999\" in this list; its entries are 0 to 1");
  CHECK(wrong({"curve.0.gap_mm=5"}) == "--set curve.0.gap_mm: the layout has no [[curve]]");
  CHECK(wrong({"row.0.count.x=5"}) == "--set row.0.count.x: row.0.count is a single value, it has nothing inside");
  CHECK(wrong({"row.0.cuont=5"}) == "--set row.0.cuont: unknown key; the nearest known one is count");
  CHECK(wrong({"contcat.brick_friction=0.3"}) == "--set contcat.brick_friction: contcat: unknown key; the nearest known one is contact");
}

TEST_CASE("a bad value is located at its override, and later ones do not hide earlier ones") {
  CHECK(wrong({"row.0.count=-5", "gravity_m_s2=no", "row.1.gap_mm=1"}) ==
        "t.toml:4:1: row.1: pitch_mm and gap_mm are both there; exactly one must be\n"
        "--set row.0.count: must be a whole number from 1 to 10,000,000, is -5\n"
        "--set gravity_m_s2: must be a number above 0 and up to 1,000, is \"no\"");
  CHECK(wrong({"row.0={cuont=3,count=3,gap_mm=1}"}) == "--set row.0: row.0.cuont: unknown key; the nearest known one is count");
  CHECK(wrong({"row.1.from_mm=[0,nan]"}) ==
        "--set row.1.from_mm: row.1.from_mm.1: must be a number from -100,000,000 to 100,000,000, is nan");
  CHECK(wrong({"pulse_ms=[1]"}) == "--set pulse_ms: must be a number, text, true or false; is a list of 1");
}

TEST_CASE("an override cannot smuggle anything in besides its value") {
  CHECK(wrong({"title=1\ncount=3"}) == "nothing is wrong");  // a text of two lines, not two keys
  const auto layout = read_layout(kFile, "t.toml", std::vector<std::string>{"title=1\ncount=3"});
  REQUIRE(layout.has_value());
  CHECK(layout->title == "1\ncount=3");
  CHECK(wrong({"title=\xff"}) == "--set title: not UTF-8: byte 6 (counted from 0) is 0xff");
  CHECK(wrong({"x\xff=1"}) == "--set x\\xff: not UTF-8: byte 1 (counted from 0) is 0xff");
  CHECK(wrong({"title=" + std::string(50, '[')}) == "--set title: nested more than 32 brackets deep");
}

TEST_CASE("settings of [model] are for the model that the file names, those of --set for the one that is chosen") {
  const auto settings = [](std::string_view model, const std::vector<std::string>& overrides) {
    const auto layout = read_layout(std::string(kFile) + std::string(model), "t.toml", overrides);
    REQUIRE(layout.has_value());
    std::string words;
    for (const Setting& setting : layout->model) words += setting.key + " ";
    return words;
  };
  constexpr std::string_view kPivot = "[model]\nname = \"pivot\"\ntime_step_s = 0.001\nhit = \"same\"\n";
  CHECK(settings(kPivot, {}) == "hit name time_step_s ");
  CHECK(settings(kPivot, {"model.name=pivot"}) == "hit name time_step_s ");
  CHECK(settings(kPivot, {"model.name=rigid"}) == "name ");
  CHECK(settings(kPivot, {"time_step_s=0.002", "model.name=rigid"}) == "name time_step_s ");
  CHECK(settings(kPivot, {"model.name=rigid", "model.name=pivot"}) == "hit name time_step_s ");
  CHECK(settings("[model]\ntime_step_s = 0.001\n", {"model.name=hinge"}) == "time_step_s name ");  // It names none.
}

}  // namespace topple

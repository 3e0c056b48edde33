#include "topple/profile.h"

#include <doctest/doctest.h>

#include "base/crew.h"
#include "topple/run.h"

namespace topple {

TEST_CASE("a profile has the stages that were called, in order, with their calls and times") {
  Profile profile;
  CHECK(profile.rows().empty());
  profile.add(Stage::read, std::chrono::milliseconds(30));
  profile.add(Stage::advance, std::chrono::milliseconds(50));
  profile.add(Stage::advance, std::chrono::milliseconds(20));
  profile.add(Stage::plane_fronts, std::chrono::milliseconds(60));
  const auto rows = profile.rows();
  REQUIRE(rows.size() == 3);
  CHECK(rows[0].stage == "advance fronts");
  CHECK(rows[0].calls == 2);
  CHECK(rows[0].time == doctest::Approx(0.07));
  CHECK(rows[1].stage == "in a plane");
  CHECK(rows[1].depth == 1);
  CHECK(rows[2].stage == "read the frame");
  // What is inside another stage is part of its time.
  CHECK(profile.time() == doctest::Approx(0.1));
}

TEST_CASE("threads add to one profile, and nobody adds to none") {
  Profile profile;
  Crew crew(4);
  crew.each(1000, [&](std::size_t) { const Timed timed(&profile, Stage::plane_rest); });
  crew.each(1000, [&](std::size_t) { const Timed timed(nullptr, Stage::plane_rest); });
  REQUIRE(profile.rows().size() == 1);
  CHECK(profile.rows()[0].calls == 1000);
}

TEST_CASE("a run adds its stages: as many steps as it took, and the same motion as without a profile") {
  const auto layout =
      read_layout("[[row]]\ncount = 4\npitch_mm = 24\n[[push]]\nangular_speed_rad_s = 4.0\n[model]\nname = \"rigid\"\n", "row");
  REQUIRE(layout.has_value());
  const auto model = model_config(*layout);
  REQUIRE(model.has_value());
  Profile profile;
  const auto with = simulate(*layout, *model, {.profile = &profile});
  const auto without = simulate(*layout, *model);
  REQUIRE(with.has_value());
  REQUIRE(without.has_value());
  CHECK(with->end().hash == without->end().hash);
  bool advanced = false;
  for (const Profile::Row& row : profile.rows()) {
    if (row.stage != "advance fronts") continue;
    advanced = true;
    CHECK(row.calls == with->end().step);
  }
  CHECK(advanced);
}

TEST_CASE("a profile names the lanes that a run of rigid chose, and none for a model without them") {
  const auto lanes_of = [](const char* model, int asked) {
    const auto layout = read_layout("[[row]]\ncount = 2\npitch_mm = 24\n[model]\nname = \"" + std::string(model) + "\"\n", "row.toml");
    Profile profile;
    REQUIRE(simulate(*layout, model_config(*layout).value(), {.lanes = asked, .profile = &profile}).has_value());
    return profile.lanes();
  };
  CHECK(lanes_of("rigid", 0) == most_lanes());
  CHECK(lanes_of("rigid", 1) == 1);
  CHECK(lanes_of("rigid", 2) == 2);
  CHECK(lanes_of("hinge", 0) == 0);
}

}  // namespace topple

// Walls, towers, pyramids, fields, balls, and what stands on what.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/trigonometry.h"
#include "topple/layout.h"

namespace topple {
namespace {

Layout read(std::string_view text) {
  const auto layout = read_layout(text, "test.toml");
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  return *layout;
}

std::string problems_of(std::string_view text) {
  const auto layout = read_layout(text, "test.toml");
  return layout ? "" : layout.error().message;
}

void check_foot(const Brick& brick, const Vec3& mm) { CHECK(norm(1000.0 * brick.foot - mm) < 1e-9); }

}  // namespace

TEST_CASE("a wall is laid in running bond, with half bricks at the ends of every second course") {
  const Layout layout = read("[[wall]]\nat_mm = [100, 50]\ncount = 3\ncourses = 2\n");
  REQUIRE(layout.brick_count() == 7);
  // On their long narrow faces: 48 mm across, 24 mm up, 7.5 mm the way the wall falls.
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(layout.bricks[i].stance == Stance::on_side);
    check_foot(layout.bricks[i], {100.0, 50.0 + 48.0 * (static_cast<double>(i) - 1.0), 0.0});
  }
  // 144 mm across in both courses: 24 + 48 + 48 + 24.
  check_foot(layout.bricks[3], {100.0, 50.0 - 60.0, 24.0});
  check_foot(layout.bricks[4], {100.0, 50.0 - 24.0, 24.0});
  check_foot(layout.bricks[5], {100.0, 50.0 + 24.0, 24.0});
  check_foot(layout.bricks[6], {100.0, 50.0 + 60.0, 24.0});
  CHECK(layout.kind_of(3).name == "domino half");
  CHECK(layout.kind_of(3).height == doctest::Approx(0.024).epsilon(1e-12));
  CHECK(layout.kind_of(3).mass == doctest::Approx(0.00425).epsilon(1e-12));
  CHECK(layout.kind_of(4).name == "domino");
  REQUIRE(layout.parts.size() == 1);
  CHECK(layout.parts[0].name == "wall 1");
  CHECK_FALSE(layout.parts[0].line);
  CHECK(summarize(layout).length == 0.0);
}

TEST_CASE("a wall of ten courses of twenty bricks has 205 bricks, toothed 195, stepped 155") {
  const auto bricks = [](const std::string& ends) {
    return read("[[wall]]\nat_mm = [0, 0]\ncount = 20\ncourses = 10\nends = \"" + ends + "\"\n").brick_count();
  };
  CHECK(bricks("half") == 205);
  CHECK(bricks("toothed") == 195);
  CHECK(bricks("stepped") == 155);
}

TEST_CASE("a wall keeps its gap along the courses, half bricks too, and heads where it is told") {
  const Layout layout = read("[[wall]]\nat_mm = [0, 0]\nheading_deg = 90\ncount = 2\ncourses = 2\ngap_mm = 2\n");
  REQUIRE(layout.brick_count() == 5);
  // To the left of +y is -x. Lower course: 48 | 2 | 48, 98 in all. Upper: 23 | 2 | 48 | 2 | 23.
  check_foot(layout.bricks[0], {25.0, 0.0, 0.0});
  check_foot(layout.bricks[1], {-25.0, 0.0, 0.0});
  check_foot(layout.bricks[2], {37.5, 0.0, 24.0});
  check_foot(layout.bricks[3], {0.0, 0.0, 24.0});
  check_foot(layout.bricks[4], {-37.5, 0.0, 24.0});
  CHECK(layout.bricks[0].heading == kPi / 2.0);
}

TEST_CASE("two walls of one kind share the kind of their half bricks") {
  CHECK(read("[[wall]]\nat_mm = [0, 0]\ncount = 3\ncourses = 2\n[[wall]]\nat_mm = [100, 0]\ncount = 4\ncourses = 5\n").kinds.size() == 2);
}

TEST_CASE("a tower lays two flat bricks across two, flush with their ends") {
  const Layout layout = read("[[tower]]\nat_mm = [0, 0]\nlayers = 30\n");
  REQUIRE(layout.brick_count() == 60);
  check_foot(layout.bricks[0], {0.0, -12.0, 0.0});
  check_foot(layout.bricks[1], {0.0, 12.0, 0.0});
  check_foot(layout.bricks[2], {12.0, 0.0, 7.5});
  check_foot(layout.bricks[3], {-12.0, 0.0, 7.5});
  check_foot(layout.bricks[59], {-12.0, 0.0, 217.5});
  CHECK(layout.bricks[0].stance == Stance::flat);
  CHECK(layout.bricks[2].heading == kPi / 2.0);
  // On their sides they leave a room inside: 48 mm less 7.5 from middle to middle.
  const Layout open = read("[[tower]]\nat_mm = [0, 0, 0]\nlayers = 2\npose = \"on_side\"\n");
  check_foot(open.bricks[0], {-20.25, 0.0, 0.0});
  check_foot(open.bricks[1], {20.25, 0.0, 0.0});
  check_foot(open.bricks[2], {0.0, -20.25, 24.0});
}

TEST_CASE("every brick of a pyramid lies on the middle of four") {
  const Layout layout = read("[[pyramid]]\nat_mm = [0, 0]\ncount_along = 3\ncount_across = 2\n");
  REQUIRE(layout.brick_count() == 8);
  check_foot(layout.bricks[0], {-48.0, -12.0, 0.0});
  check_foot(layout.bricks[5], {48.0, 12.0, 0.0});
  check_foot(layout.bricks[6], {-24.0, 0.0, 7.5});
  check_foot(layout.bricks[7], {24.0, 0.0, 7.5});
  CHECK(read("[[pyramid]]\nat_mm = [0, 0]\ncount_along = 8\ncount_across = 8\n").brick_count() == 204);  // 64 + 49 + ... + 1
  CHECK(read("[[pyramid]]\nat_mm = [0, 0]\ncount_along = 8\ncount_across = 8\nlayers = 2\n").brick_count() == 113);
}

TEST_CASE("a field is rows side by side, to the left of their heading, each a part") {
  const Layout layout = read("[[field]]\nfrom_mm = [10, 0]\nrows = 3\ncount = 4\npitch_mm = 24\nrow_pitch_mm = 30\n");
  REQUIRE(layout.brick_count() == 12);
  check_foot(layout.bricks[0], {10.0, 0.0, 0.0});
  check_foot(layout.bricks[5], {34.0, 30.0, 0.0});
  check_foot(layout.bricks[11], {82.0, 60.0, 0.0});
  REQUIRE(layout.parts.size() == 3);
  CHECK(layout.parts[2].name == "field 1 row 3");
  CHECK(layout.parts[2].first == 8);
  CHECK(layout.pushes.empty());
}

TEST_CASE("a field can be pushed row by row, after the pushes of the file") {
  const Layout layout = read(
      "[[push]]\nbrick = 1\nangular_speed_rad_s = 1\n"
      "[[field]]\nrows = 3\nlength_mm = 72\npitch_mm = 24\nrow_pitch_mm = 30\nstarter = \"pushes\"\nangular_speed_rad_s = 4\n");
  REQUIRE(layout.pushes.size() == 4);
  CHECK(layout.pushes[0].brick == 1);
  CHECK(layout.pushes[3].brick == 8);
  CHECK(std::get<AngularSpeedPush>(layout.pushes[3].how).angular_speed == 4.0);
}

TEST_CASE("the line that starts a field splits into every row") {
  const Layout layout = read("[[field]]\nrows = 4\ncount = 10\npitch_mm = 24\nrow_pitch_mm = 75\nstarter = \"line\"\n");
  // 5 bricks turn on an arc of 3 widths: ceil(72 mm x pi/2 / 24 mm); the line takes three from row to row.
  REQUIRE(layout.parts.size() == 5);
  CHECK(layout.parts[0].name == "field 1 line");
  CHECK(layout.parts[0].count == 11);
  for (std::size_t row = 1; row < 5; ++row) {
    CHECK(layout.parts[row].count == 16);
    const Brick& turning = layout.bricks[static_cast<std::size_t>(layout.parts[row].first)];
    const Brick& last = layout.bricks[static_cast<std::size_t>(layout.parts[row].first) + 15];
    // The brick that is struck stands 9/16 of a width beside the line and heads along it; the last heads with the row.
    check_foot(turning, {13.5, 75.0 * static_cast<double>(row - 1) + 25.0, 0.0});
    CHECK(turning.heading == kPi / 2.0);
    CHECK(last.heading == 0.0);
    const double radius = 5.0 * 24.0 / (kPi / 2.0);
    check_foot(last, {13.5 + radius + 240.0, 75.0 * static_cast<double>(row - 1) + 25.0 + radius, 0.0});
  }
  check_foot(layout.bricks[0], {0.0, 0.0, 0.0});
  check_foot(layout.bricks[1], {-13.5, 25.0, 0.0});
  check_foot(layout.bricks[3], {0.0, 75.0, 0.0});
  check_foot(layout.bricks[10], {-13.5, 250.0, 0.0});
}

TEST_CASE("a started field stands without overlaps at any pitch, width and heading") {
  for (const char* kind : {"", "[[kind]]\nwidth_mm = 12\n", "[[kind]]\nheight_mm = 40\nwidth_mm = 20\nthickness_mm = 8\n"}) {
    for (const char* pitch : {"gap_mm = 2", "gap_mm = 16.5", "gap_mm = 30"}) {
      for (const char* row_pitch : {"96", "110", "150"}) {
        const std::string text = std::string(kind) + "[[field]]\nrows = 4\ncount = 5\nheading_deg = 33\nstarter = \"line\"\n" + pitch +
                                 "\nrow_pitch_mm = " + row_pitch + "\n";
        CHECK_MESSAGE(problems_of(text) == "", text);
      }
    }
  }
}

TEST_CASE("a ball rolls: a blow at seven fifths of its radius gives it its speed") {
  const Layout layout =
      read("[[ball]]\nat_mm = [-100, 0]\nspeed_m_s = 0.5\nmass_g = 20\ndiameter_mm = 25\nat_s = 0.3\n[[row]]\ncount = 2\ngap_mm = 9\n");
  CHECK(layout.kind_of(0).shape == Shape::ball);
  CHECK(layout.kind_of(0).name == "ball 1");
  CHECK(layout.kind_of(0).mass == 0.02);
  CHECK(layout.kind_of(0).height == 0.025);
  CHECK(layout.kind_of(1).shape == Shape::box);
  REQUIRE(layout.pushes.size() == 1);
  CHECK(layout.pushes[0].brick == 0);
  CHECK(layout.pushes[0].at == 0.3);
  CHECK(std::get<ImpulsePush>(layout.pushes[0].how).impulse == doctest::Approx(0.01).epsilon(1e-15));
  CHECK(std::get<ImpulsePush>(layout.pushes[0].how).height == doctest::Approx(0.0175).epsilon(1e-15));
  // A glass marble of 16 mm: 2500 kg/m^3 x pi/6 d^3 = 5.36 g.
  const Layout marble = read("[[ball]]\nat_mm = [0, 0]\n");
  CHECK(marble.kinds.back().mass == doctest::Approx(0.005361651).epsilon(1e-6));
  CHECK(marble.pushes.empty());
}

TEST_CASE("a ball may touch a brick where a box of its size would not fit") {
  // Beside an edge at 45 degrees: 8 mm from its middle is 5.66 mm along x and y.
  const std::string brick = "[[brick]]\nat_mm = [0, 0]\n[[ball]]\n";
  CHECK(problems_of(brick + "at_mm = [9.5, 17.7]\n") == "");
  CHECK(problems_of(brick + "at_mm = [9.3, 17.5]\n").find("overlap by") != std::string::npos);
  CHECK(problems_of(brick + "at_mm = [11.75, 0]\n") == "");
  CHECK(problems_of(brick + "at_mm = [11.7, 0]\n").find("overlap by 0.05 mm") != std::string::npos);
}

TEST_CASE("two kinds touch with the geometric mean of their values, or as their pair says") {
  const std::string kinds =
      "[[kind]]\nname = \"wood\"\nbrick_friction = 0.1\nbrick_restitution = 0.2\n[[kind]]\nname = \"glass\"\nbrick_friction = 0.4\n"
      "brick_restitution = 0.8\n[[row]]\ncount = 1\ngap_mm = 1\n";
  const Layout ruled = read(kinds);
  CHECK(surface_pair(ruled, 0, 0).friction == 0.1);
  CHECK(surface_pair(ruled, 0, 1).friction == doctest::Approx(0.2).epsilon(1e-15));
  CHECK(surface_pair(ruled, 1, 0).restitution == doctest::Approx(0.4).epsilon(1e-15));
  const Layout given = read(
      kinds + "[[pair]]\nkind = \"glass\"\nwith = \"wood\"\nfriction = 0.7\n[[pair]]\nkind = \"wood\"\nwith = \"wood\"\nrestitution = 1\n");
  CHECK(surface_pair(given, 0, 1).friction == 0.7);
  CHECK(surface_pair(given, 1, 0).friction == 0.7);
  CHECK(surface_pair(given, 1, 0).restitution == doctest::Approx(0.4).epsilon(1e-15));
  CHECK(surface_pair(given, 0, 0).restitution == 1.0);
  CHECK(surface_pair(given, 0, 0).friction == 0.1);
  CHECK(surface_pair(given, 1, 1).friction == 0.4);
}

TEST_CASE("a brick at a height must stand on another") {
  CHECK(problems_of("[[brick]]\nat_mm = [0, 0]\n[[brick]]\nat_mm = [0, 0, 48]\n") == "");
  CHECK(problems_of("[[brick]]\nat_mm = [0, 0]\n[[brick]]\nat_mm = [0, 0, 50]\n") ==
        "test.toml:3:1: brick.1: brick 1 (brick 2) is 50 mm above the floor with no brick under it");
  CHECK(problems_of("[[brick]]\nat_mm = [0, 0]\n[[brick]]\nat_mm = [8, 0, 48]\n") ==
        "test.toml:3:1: brick.1: brick 1 (brick 2) is 48 mm above the floor with no brick under it");
  CHECK(problems_of("[[brick]]\nat_mm = [0, 0]\n[[brick]]\nat_mm = [7, 0, 48]\n") == "");
}

TEST_CASE("structures of many bricks neither overlap nor hang") {
  CHECK(problems_of("[[wall]]\nat_mm = [0, 0]\nheading_deg = 17\ncount = 20\ncourses = 30\n[[tower]]\nat_mm = [500, 0]\nheading_deg = "
                    "5\nlayers = 60\n"
                    "[[pyramid]]\nat_mm = [0, 900]\nheading_deg = -40\ncount_along = 10\ncount_across = 20\npose = \"standing\"\n") == "");
}

}  // namespace topple

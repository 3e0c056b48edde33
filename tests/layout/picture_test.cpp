// Fields that carry their picture: which brick has which colour.
#include <doctest/doctest.h>

#include <string>

#include "topple/layout.h"

namespace topple {
namespace {

constexpr Color kRed{192, 57, 43}, kWhite{255, 255, 255}, kBlue{0, 0, 255};

Layout read(std::string_view text, const std::vector<std::string>& overrides = {}) {
  const auto layout = read_layout(text, "test.toml", overrides);
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  return *layout;
}

Color color_of(const Layout& layout, std::size_t brick) { return layout.colors[layout.bricks[brick].color]; }

/// An L: a long stroke down, a short one to the right at its foot.
const std::string kEll =
    "[[field]]\nrow_pitch_mm = 32\npitch_mm = 16\npalette = { r = \"#c0392b\", \".\" = \"#ffffff\" }\n"
    "picture = [\n  \"r...\",\n  \"r...\",\n  \"rr..\",\n]\n";

}  // namespace

TEST_CASE("a picture stands upright before one who looks down with the rows falling to the right") {
  const Layout layout = read(kEll);
  REQUIRE(layout.brick_count() == 12);
  for (std::size_t i = 0; i < layout.bricks.size(); ++i) {
    const Vec3 mm = 1000.0 * layout.bricks[i].foot;
    // Seen from above, x to the right and y up: the stroke down is at the left, its foot below.
    const bool down = mm.x < 8.0, foot = mm.y < 16.0 && mm.x < 24.0;
    CHECK(color_of(layout, i) == (down || foot ? kRed : kWhite));
  }
  CHECK(layout.parts.size() == 3);
  CHECK(summarize(layout).colors.size() == 2);
}

TEST_CASE("a picture says how many rows and bricks there are, and agrees with a file that says so too") {
  CHECK(read(kEll + "rows = 3\ncount = 4\n").brick_count() == 12);
  CHECK(read(kEll + "rows = 3\nlength_mm = 50\n").brick_count() == 12);
}

TEST_CASE("behind a starting line the picture is the same, and line and turns have the field's own colour") {
  const Layout layout = read(kEll + "starter = \"line\"\ncolor = \"#0000ff\"\n", {"field.0.row_pitch_mm=76"});
  REQUIRE(layout.parts.size() == 4);
  const auto first_of = [&](std::size_t row) {
    return static_cast<std::size_t>(layout.parts[1 + row].first + layout.parts[1 + row].count) - 4;
  };
  for (std::size_t i = 0; i < layout.bricks.size(); ++i) {
    bool in_picture = false;
    for (std::size_t row = 0; row < 3; ++row) in_picture = in_picture || (i >= first_of(row) && i < first_of(row) + 4);
    CHECK((color_of(layout, i) == kBlue) == !in_picture);
  }
  // The last line of the picture is the first row.
  const std::string rows[] = {"rr..", "r...", "r..."};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t i = 0; i < 4; ++i) CHECK(color_of(layout, first_of(row) + i) == (rows[row][i] == 'r' ? kRed : kWhite));
  }
}

TEST_CASE("a brush paints over a picture") {
  const Layout layout = read(kEll + "paint = [[1, 2, \"#0000ff\"]]\n");
  CHECK(color_of(layout, 0) == kRed);
  CHECK(color_of(layout, 1) == kBlue);
  CHECK(color_of(layout, 2) == kBlue);
  CHECK(color_of(layout, 3) == kWhite);
}

TEST_CASE("an override changes a picture's colour") {
  const Layout layout = read(kEll, {"field.0.palette.r=\"#0000ff\""});
  CHECK(color_of(layout, 0) == kBlue);
}

}  // namespace topple

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "export/plan/labels.h"
#include "export/plan/pages.h"
#include "export/plan/sheet.h"
#include "topple/export.h"

using namespace topple;
using namespace topple::plan;

namespace {

/// A file that goes with its test.
class Made {
 public:
  explicit Made(const std::string& ending) {
    path = std::filesystem::temp_directory_path() / ("topple_plan_" + std::to_string(::getpid()) + ending);
  }
  ~Made() { std::filesystem::remove(path); }
  std::string bytes() const {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  std::filesystem::path path;
};

Layout layout_of(const std::string& text) {
  auto layout = read_draft(text, "test.toml");
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  return std::move(*layout);
}

Layout line(int count, const std::string& more = "") {
  return layout_of("[[row]]\ncount = " + std::to_string(count) + "\npitch_mm = 24\ncolor = \"#123456\"\n" + more);
}

PlanSheets drawn(const Layout& layout, const PlanConfig& config, const Made& made) {
  const Result<PlanSheets> sheets = draw_plan(layout, config, made.path);
  REQUIRE_MESSAGE(sheets.has_value(), sheets.error().message);
  return *sheets;
}

std::string refusal(const Layout& layout, const PlanConfig& config, const std::string& name = "/nowhere/plan.pdf") {
  const Result<PlanSheets> sheets = draw_plan(layout, config, name);
  REQUIRE_FALSE(sheets.has_value());
  return sheets.error().message;
}

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

/// The first four corners of what has the ink #123456 in an SVG, after the swatch in the table of colours [mm].
std::vector<Point> corners(const std::string& svg) {
  constexpr std::string_view kInk = "fill:rgb(7.058824%,20.392157%,33.72549%)";
  const std::size_t last = svg.rfind(kInk);
  REQUIRE(last != std::string::npos);
  REQUIRE(svg.find(kInk) != last);
  std::istringstream words(svg.substr(svg.find(" d=\"", last) + 4, 1000));
  std::vector<Point> found(4);
  std::string letter;
  for (Point& point : found) words >> letter >> point.x >> point.y;
  return found;
}

}  // namespace

TEST_CASE("a brick on the sheet is as wide as it is, divided by the scale") {
  for (const double scale : {1.0, 2.5, 10.0}) {
    const Made made(".svg");
    const PlanSheets sheets = drawn(line(2), {.scale = scale}, made);
    CHECK(sheets.scale == scale);
    CHECK(sheets.paper.empty());
    const std::vector<Point> found = corners(made.bytes());
    // 7.5 mm by 24 mm; cairo keeps places in 1/256 of a point, 0.0014 mm.
    CHECK(std::abs(found[1].x - found[0].x) == doctest::Approx(7.5 / scale).epsilon(0.003));
    CHECK(std::abs(found[2].y - found[1].y) == doctest::Approx(24.0 / scale).epsilon(0.003));
  }
}

TEST_CASE("the drawing's points are millimetres of paper") {
  const Made made(".pdf");
  const PlanSheets sheets = drawn(line(2), {.paper = "A4"}, made);
  CHECK(sheets.paper == "A4");
  CHECK(sheets.scale == 1.0);
  // 297 mm = 841.89 pt.
  CHECK(count_of(made.bytes(), "/MediaBox [ 0 0 841.889764 595.275591 ]") == 1);
}

TEST_CASE("paper is the smallest on which bricks are told apart, and the scale the largest usual one that fits it") {
  // Bricks of 7.5 mm are 0.75 mm at 1:10. A line of 1 m fits A4 then, one of 3 m no longer A4 and A3, one of 30 m not even A0.
  const auto choice = [](double width, double height) { return choose({0.0, 0.0, width, height}, 0.0075, {}, false); };
  CHECK(choice(1.0, 0.5).paper == "A4");
  CHECK(choice(1.0, 0.5).scale == 5.0);
  CHECK(choice(3.0, 0.5).paper == "A3");
  CHECK(choice(3.0, 0.5).scale == 10.0);
  CHECK(choice(30.0, 10.0).paper == "A0");
  CHECK(choice(30.0, 10.0).scale == 50.0);
  for (const double width : {0.1, 0.7, 2.0, 9.0, 100.0}) {
    const Choice chosen = choice(width, 0.4);
    CHECK_FALSE(chosen.several);
    CHECK(1000.0 * width / chosen.scale < chosen.sheet.window().width);
  }
}

TEST_CASE("what is wished for is kept: the paper, the scale, both") {
  const Bounds bounds{0.0, 0.0, 1.0, 0.5};
  CHECK(choose(bounds, 0.0075, {.paper = "A0"}, false).scale == 1.0);
  CHECK(choose(bounds, 0.0075, {.paper = "letter"}, false).scale == 5.0);
  CHECK(choose(bounds, 0.0075, {.scale = 2.0}, false).paper == "A2");
  const Choice tiled = choose(bounds, 0.0075, {.scale = 1.0, .paper = "A4"}, false);
  CHECK(tiled.several);
  CHECK(tiled.overview == 5.0);
}

TEST_CASE("sheets of one plan overlap, and together they hold the whole layout") {
  const Cut made = cut({1000.0, 300.0}, "A4");
  // A4 with margins of 10 mm, 10 mm for the foot and 10 mm of overlap: cells of 267 by 170 mm, or 180 by 257.
  CHECK(made.cell_width == doctest::Approx(267.0));
  CHECK(made.cell_height == doctest::Approx(170.0));
  CHECK(made.columns == 4);
  CHECK(made.rows == 2);
  CHECK(made.clip.width == doctest::Approx(made.cell_width + kOverlap));
  CHECK(made.origin.x < 0.0);
  CHECK(made.origin.x + made.columns * made.cell_width > 1000.0);
}

TEST_CASE("a plan over several sheets leaves out those without bricks and has one more that shows them all") {
  // An L: two rows of 1 m. Its box takes several sheets that have no brick.
  const Layout layout = line(42, "[[row]]\nfrom_mm = [0, 24]\nheading_deg = 90\ncount = 42\npitch_mm = 24\n");
  const Made made(".pdf");
  const PlanSheets sheets = drawn(layout, {.scale = 1.0, .paper = "A4"}, made);
  const Cut whole = cut({987.75 + 8.25, 1032.0}, "A4");
  CHECK(sheets.sheets >= 4 + 4);
  CHECK(sheets.sheets < whole.columns * whole.rows);
  CHECK(count_of(made.bytes(), "/MediaBox") == static_cast<std::size_t>(sheets.sheets) + 1);
}

TEST_CASE("every brick is on a sheet") {
  const Layout layout = line(30, "[[curve]]\npoints_mm = [[720, 0], [1200, 120], [1500, 520]]\ngap_mm = 16.5\n");
  const LayoutSummary summary = summarize(layout);
  const Bounds bounds{summary.low.x, summary.low.y, summary.high.x - summary.low.x, summary.high.y - summary.low.y};
  const Pages pages(layout, bounds, 1.0, "A4");
  std::vector<std::string> named;
  for (std::size_t page = 0; page < pages.count(); ++page) {
    const auto& parts = pages.parts_of(page);
    named.insert(named.end(), parts.begin(), parts.end());
  }
  CHECK(std::find(named.begin(), named.end(), "row 1") != named.end());
  CHECK(std::find(named.begin(), named.end(), "curve 1") != named.end());
}

TEST_CASE("the same layout gives the same bytes, as PDF and as SVG") {
  const Layout layout = line(30, "[[push]]\nangular_speed_rad_s = 4\n");
  for (const char* ending : {".pdf", ".svg"}) {
    const Made made(ending);
    drawn(layout, {}, made);
    const std::string first = made.bytes();
    drawn(layout, {}, made);
    CHECK(made.bytes() == first);
    CHECK(first.find("CreationDate") == std::string::npos);
  }
}

TEST_CASE("rows are lines where a brick would be thinner than 0.3 mm") {
  const Made made(".pdf");
  CHECK(drawn(line(100), {.scale = 20.0}, made).bricks);
  CHECK_FALSE(drawn(line(100), {.scale = 50.0}, made).bricks);
}

TEST_CASE("an even row of a thousand bricks takes no more room as a line than one of ten") {
  const Made made(".svg");
  drawn(line(1000), {.scale = 200.0}, made);
  // One stretch from the first brick to the last.
  CHECK(count_of(made.bytes(), "stroke:rgb(7.058824%,20.392157%,33.72549%)") == 1);
}

TEST_CASE("words find room beside each other") {
  Room room({0.0, 0.0, 100.0, 50.0});
  CHECK(room.is_free({10.0, 10.0, 20.0, 3.0}));
  room.take({10.0, 10.0, 20.0, 3.0});
  CHECK_FALSE(room.is_free({29.0, 12.0, 20.0, 3.0}));
  CHECK(room.is_free({31.0, 10.0, 20.0, 3.0}));
  CHECK_FALSE(room.is_free({90.0, 10.0, 20.0, 3.0}));  // Beyond the window.
  room.take_line({0.0, 40.0}, {100.0, 20.0}, 1.0);
  CHECK_FALSE(room.is_free({49.0, 29.0, 2.0, 2.0}));
  CHECK(room.is_free({49.0, 34.0, 2.0, 2.0}));
  // Words are nobody's; bricks are their part's.
  room.take({50.0, 5.0, 5.0, 5.0}, 7);
  CHECK_FALSE(room.has_others({10.0, 10.0, 20.0, 3.0}, 7));
  CHECK_FALSE(room.has_others({52.0, 6.0, 10.0, 1.0}, 7));
  CHECK(room.has_others({52.0, 6.0, 10.0, 1.0}, 8));
}

TEST_CASE("the rows of a field go by one name") {
  const Layout layout = layout_of(
      "[[field]]\nrows = 3\nrow_pitch_mm = 75\ncount = 12\npitch_mm = 24\nstarter = \"line\"\n"
      "[[row]]\nfrom_mm = [0, 900]\ncount = 2\npitch_mm = 24\n");
  const std::vector<PartGroup> groups = part_groups(layout);
  REQUIRE(groups.size() == 2);
  CHECK(groups[0].name == "field 1");
  CHECK(groups[0].count == 4);
  CHECK(groups[0].bricks + 2 == layout.brick_count());
  CHECK(groups[1].name == "row 1");
}

TEST_CASE("what cannot be drawn is refused in words") {
  const Layout layout = line(10);
  CHECK(refusal(layout, {.scale = 0.5}) == "The scale 1:0.5 is not between 1:1 and 1:100000.");
  CHECK(refusal(layout, {.scale = std::numeric_limits<double>::quiet_NaN()}).find("is not between") != std::string::npos);
  CHECK(refusal(layout, {.paper = "A5"}) == "The paper 'A5' is not A4, A3, A2, A1, A0 or letter.");
  CHECK(refusal(layout, {}, "plan.png") == "plan.png: the name must end in .pdf or .svg.");
  CHECK(refusal({}, {}).find("has no bricks to draw") != std::string::npos);
  CHECK(refusal(layout, {.scale = 1.0, .paper = "A4"}, "plan.svg").find("An SVG is one drawing") == 0);
  const std::string many = refusal(line(10000), {.scale = 1.0, .paper = "A4"});
  // 240 m in cells of 267 mm.
  CHECK(many == "At 1:1 the plan takes 899 sheets of A4; at most 500 are drawn. One sheet of it holds all at 1:2000.");
}

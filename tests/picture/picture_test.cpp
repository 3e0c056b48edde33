// Images as bricks: sizes, means, nearest colours, stock, and the text that a layout file takes.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "picture/light.h"
#include "picture/mean.h"
#include "topple/picture.h"

namespace topple {
namespace {

constexpr Color kBlack{0, 0, 0}, kWhite{255, 255, 255}, kRed{255, 0, 0}, kGrey{128, 128, 128};

/// An image of one line for each text: '#' black, '.' white, 'r' red, ' ' nothing at all.
Image image_of(const std::vector<std::string>& lines) {
  Image image{std::ssize(lines[0]), std::ssize(lines), {}};
  for (const std::string& line : lines) {
    for (const char c : line) {
      const auto part = [&](char full) { return static_cast<std::uint8_t>(c == full || c == '.' ? 255 : 0); };
      image.pixels.insert(image.pixels.end(), {part('r'), part('.'), part('.'), static_cast<std::uint8_t>(c == ' ' ? 0 : 255)});
    }
  }
  return image;
}

/// Grey levels from black to white along one line.
Image ramp(int levels) {
  Image image{levels, 1, {}};
  for (int i = 0; i < levels; ++i) {
    const auto grey = static_cast<std::uint8_t>(i * 255 / (levels - 1));
    image.pixels.insert(image.pixels.end(), {grey, grey, grey, 255});
  }
  return image;
}

Picture made(const Image& image, PictureSize size, std::vector<StockColor> colors, bool dither = false) {
  const auto picture = make_picture(image, {size, std::move(colors), dither});
  REQUIRE_MESSAGE(picture.has_value(), picture.error().message);
  return *picture;
}

std::string why_not(const Image& image, PictureSize size, std::vector<StockColor> colors) {
  const auto picture = make_picture(image, {size, std::move(colors)});
  return picture ? "a picture" : picture.error().message;
}

}  // namespace

TEST_CASE("a field shows an image in its true proportions") {
  const Image image{600, 400, {}};
  // Rows of 16 mm by 32 mm a brick: twice as many bricks a row as an image of squares would take, 1.5 * 2 = 3 for each row.
  CHECK(fit_picture(image, 0.016, 0.032, {10, 0}, 0).count == 30);
  CHECK(fit_picture(image, 0.016, 0.032, {0, 30}, 0).rows == 10);
  const PictureSize about = fit_picture(image, 0.016, 0.032, {}, 300);
  CHECK(about.rows == 10);
  CHECK(about.count == 30);
  CHECK(fit_picture(image, 0.016, 0.032, {7, 9}, 0).count == 9);
  CHECK(fit_picture({1, 100000, {}}, 0.016, 0.032, {}, 10).count == 1);
}

TEST_CASE("a cell has the mean light of its part of the image, and pixels across an edge are shared") {
  // Three pixels on two cells: the middle one is half in each.
  const std::vector<Light> cells = mean_light(image_of({"#.."}), {1, 2});
  CHECK(cells[0].green == doctest::Approx(1.0 / 3.0).epsilon(1e-12));
  CHECK(cells[1].green == doctest::Approx(1.0).epsilon(1e-12));
  const std::vector<Light> more = mean_light(image_of({"#."}), {3, 4});
  for (std::size_t i = 0; i < more.size(); ++i) CHECK(more[i].red == doctest::Approx(i % 4 < 2 ? 0.0 : 1.0).epsilon(1e-12));
  // What is not there is white.
  CHECK(mean_light(image_of({"  "}), {1, 1})[0].blue == doctest::Approx(1.0).epsilon(1e-12));
}

TEST_CASE("light is that of sRGB, and seen as OKLab has it") {
  // ((188 / 255 + 0.055) / 1.055)^2.4
  CHECK(light_of({188, 0, 10}).red == doctest::Approx(0.502886458033).epsilon(1e-10));
  CHECK(light_of({188, 0, 10}).blue == doctest::Approx(10.0 / 255.0 / 12.92).epsilon(1e-12));
  // [Ottosson2020] gives the matrices to ten digits; red by numpy with them: 0.62795536, 0.22486306, 0.1258463.
  const Seen red = seen(light_of(kRed)), white = seen(light_of(kWhite));
  CHECK(red.lightness == doctest::Approx(0.62795536).epsilon(1e-7));
  CHECK(red.green_red == doctest::Approx(0.22486306).epsilon(1e-7));
  CHECK(red.blue_yellow == doctest::Approx(0.1258463).epsilon(1e-6));
  CHECK(white.lightness == doctest::Approx(1.0).epsilon(1e-7));
  CHECK(seen(Light{}).lightness == 0.0);
}

TEST_CASE("a picture stands as the image does, its text too, and a layout takes it") {
  const Picture picture = made(image_of({"#...", "#...", "##r."}), {3, 4}, {{kBlack}, {kWhite}, {kRed}});
  CHECK(picture.used == std::vector<std::int64_t>{4, 7, 1});
  const std::string text = picture_text(picture);
  CHECK(text ==
        "palette = { a = \"#000000\", b = \"#ffffff\", c = \"#ff0000\" }\n"
        "picture = [\n  \"abbb\",\n  \"abbb\",\n  \"aacb\",\n]\n");
  const auto layout = read_layout("[[field]]\npitch_mm = 16\nrow_pitch_mm = 32\n" + text, "test.toml");
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  // The last line of the image is the first row.
  CHECK(layout->colors[layout->bricks[2].color] == kRed);
}

TEST_CASE("usual colours have letters of their own, and what no brick has is not in the palette") {
  std::vector<StockColor> colors;
  for (const NamedColor& usual : usual_colors()) colors.push_back({usual.color});
  colors.push_back({kWhite});
  const std::string text = picture_text(made(image_of({"."}), {1, 2}, colors));
  CHECK(text == "palette = { a = \"#ffffff\" }\npicture = [\n  \"aa\",\n]\n");
  CHECK(picture_text(made(image_of({"#"}), {1, 2}, {colors[11]})).starts_with("palette = { \"#\" = \"#23262b\" }\npicture = [\n  \"##\""));
}

TEST_CASE("where black is short the darkest bricks have it, and none is left over") {
  const Picture picture = made(ramp(100), {1, 100}, {{kBlack, 30}, {kWhite}});
  CHECK(picture.used[0] == 30);
  for (std::size_t i = 0; i < 100; ++i) CHECK(picture.cells[i] == (i < 30 ? 0 : 1));
}

TEST_CASE("two short colours push each other on to a third, at the least loss in all") {
  const Picture picture = made(ramp(90), {1, 90}, {{kBlack, 30}, {kGrey, 30}, {kWhite, 30}});
  for (std::size_t i = 0; i < 90; ++i) CHECK(picture.cells[i] == i / 30);
}

TEST_CASE("where all bricks want one colour alike, its whole stock is used and no more") {
  const Image image = image_of({std::string(50, '#'), std::string(50, '#')});
  const Picture picture = made(image, {2, 50}, {{kBlack, 40}, {kGrey}, {kWhite}});
  CHECK(picture.used == std::vector<std::int64_t>{40, 60, 0});
}

TEST_CASE("dithering mixes colours to about the mean light, and keeps to the stock") {
  // Half of the light: without dithering all bricks are the same.
  Image grey{1, 1, {188, 188, 188, 255}};
  CHECK(made(grey, {40, 50}, {{kBlack}, {kWhite}}).used[0] == 0);
  const Picture mixed = made(grey, {40, 50}, {{kBlack}, {kWhite}}, true);
  CHECK(mixed.used[0] > 500);  // A quarter of the error is let go, so that it is not quite half.
  CHECK(mixed.used[0] < 1100);
  const Picture kept = made(grey, {40, 50}, {{kBlack, 200}, {kWhite}}, true);
  CHECK(kept.used[0] <= 200);
  CHECK(kept.used[0] >= 150);
  // Spread over the whole, not used up in the first rows.
  CHECK(std::count(kept.cells.begin() + 1000, kept.cells.end(), 0) > 50);
}

TEST_CASE("a picture that cannot be made is refused in words") {
  const Image dot = image_of({"#"});
  CHECK(why_not(dot, {10, 10}, {{kBlack, 50}, {kWhite, 49}}) ==
        "The picture takes 100 bricks, and of these colours there are 99 bricks: 1 is missing.");
  CHECK(why_not(dot, {10, 200}, {{kBlack, 0}}) ==
        "The picture takes 2,000 bricks, and of these colours there are 0 bricks: 2000 are missing.");
  CHECK(why_not(dot, {10, 10}, {}) == "There are 0 colours; 1 to 62 are allowed.");
  CHECK(why_not(dot, {10, 10}, std::vector<StockColor>(63)) == "There are 63 colours; 1 to 62 are allowed.");
  CHECK(why_not(dot, {0, 10}, {{kBlack}}) == "0 rows of 10 bricks cannot be a picture: 1 to 10,000,000 in all are allowed.");
  CHECK(why_not(dot, {4'000'000'000, 4'000'000'000}, {{kBlack}}) ==
        "4000000000 rows of 4,000,000,000 bricks cannot be a picture: 1 to 10,000,000 in all are allowed.");
  CHECK(why_not({}, {1, 1}, {{kBlack}}) == "The image has no pixels.");
  CHECK(why_not({2, 2, {1, 2, 3}}, {1, 1}, {{kBlack}}) == "The image has no pixels.");
}

}  // namespace topple

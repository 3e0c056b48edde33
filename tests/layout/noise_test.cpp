#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "base/hash.h"
#include "topple/layout.h"

namespace topple {
namespace {

constexpr std::string_view kNoisy = "[[row]]\ncount = 100000\npitch_mm = 40\n[noise]\nseed = 7\nposition_mm = 0.5\nheading_deg = 1.0\n";

Layout read(std::string_view text, std::vector<std::string> overrides = {}) {
  const auto layout = read_layout(text, "test.toml", overrides);
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  return *layout;
}

std::uint64_t hash_of(const Layout& layout) {
  Hash hash;
  for (const Brick& brick : layout.bricks) {
    for (const double number : {brick.foot.x, brick.foot.y, brick.foot.z, brick.heading}) hash.add(number);
  }
  return hash.value();
}

struct Spread {
  double mean = 0.0, deviation = 0.0;
};
template <typename Of>
Spread spread(const Layout& layout, Of of) {
  double sum = 0.0, squares = 0.0;
  for (BrickId i = 0; i < layout.brick_count(); ++i) {
    const double x = of(layout.bricks[static_cast<std::size_t>(i)], i);
    sum += x;
    squares += x * x;
  }
  const double n = layout.brick_count();
  return {sum / n, std::sqrt(squares / n - (sum / n) * (sum / n))};
}

}  // namespace

TEST_CASE("noise has the standard deviations that were asked for and no drift") {
  const Layout layout = read(kNoisy);
  // Of 1e5 draws, a mean scatters by 1 / sqrt(1e5) = 0.0032 of a standard deviation and a standard deviation by 0.0022 of itself; four
  // times that.
  const Spread x = spread(layout, [](const Brick& brick, BrickId i) { return brick.foot.x - 0.04 * i; });
  const Spread y = spread(layout, [](const Brick& brick, BrickId) { return brick.foot.y; });
  const Spread turn = spread(layout, [](const Brick& brick, BrickId) { return brick.heading; });
  const double degree = 0.017453292519943295;
  CHECK(std::abs(x.mean) < 0.0005 * 0.013);
  CHECK(std::abs(y.mean) < 0.0005 * 0.013);
  CHECK(std::abs(turn.mean) < degree * 0.013);
  CHECK(x.deviation == doctest::Approx(0.0005).epsilon(0.009));
  CHECK(y.deviation == doctest::Approx(0.0005).epsilon(0.009));
  CHECK(turn.deviation == doctest::Approx(degree).epsilon(0.009));
}

TEST_CASE("noise is the same on every machine and another for another seed") {
  const Layout layout = read(kNoisy);
  CHECK(hash_of(layout) == hash_of(read(kNoisy)));
  CHECK(hash_of(layout) != hash_of(read(kNoisy, {"noise.seed=8"})));
  CHECK(hash_of(layout) == 18373666665724735795ULL);  // golden
}

TEST_CASE("switching the noise of headings off leaves the places as they were") {
  const Layout both = read(kNoisy), places = read(kNoisy, {"noise.heading_deg=0"});
  for (std::size_t i = 0; i < 100; ++i) {
    CHECK(both.bricks[i].foot == places.bricks[i].foot);
    CHECK(places.bricks[i].heading == 0.0);
  }
}

TEST_CASE("bricks of a curve stand in the same places on every machine") {
  CHECK(hash_of(read("[[curve]]\npoints_mm = [[0, 0], [1000, 200], [1050, 900], [300, 1000], [0, 3000]]\ngap_mm = 16.5\n")) ==
        548402728528129496ULL);                                                                                // golden
  CHECK(hash_of(read("[[row]]\nheading_deg = 17\ncount = 1000\ngap_mm = 16.5\n")) == 4146545700142083972ULL);  // golden
}

}  // namespace topple

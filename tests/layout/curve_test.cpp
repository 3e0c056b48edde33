#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "layout/spline.h"
#include "topple/layout.h"

namespace topple {
namespace {

Layout read(std::string_view text) {
  const auto layout = read_layout(text, "test.toml");
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  return *layout;
}

/// Arc length of y = -a x^2 from 0 to x, odd in x.
double parabola_length(double a, double x) {
  const double slope = 2.0 * a * x;
  return 0.5 * x * std::sqrt(1.0 + slope * slope) + std::asinh(slope) / (4.0 * a);
}

const std::vector<Vec3> kWild{{0.0, 0.0, 0.0}, {1.0, 0.2, 0.0}, {1.05, 0.9, 0.0}, {0.3, 1.0, 0.0}, {0.31, 0.95, 0.0}, {3.0, -2.0, 0.0}};

}  // namespace

TEST_CASE("a curve through two points is the straight line between them") {
  const Layout layout = read("[[curve]]\npoints_mm = [[100, 0], [400, 400]]\npitch_mm = 25\n");
  REQUIRE(layout.brick_count() == 21);  // 500 mm, one brick at each end
  for (int i = 0; i < 21; ++i) {
    const Brick& brick = layout.bricks[static_cast<std::size_t>(i)];
    CHECK(norm(brick.foot - Vec3{0.1 + 0.015 * i, 0.020 * i, 0.0}) < 1e-15);
    CHECK(brick.heading == doctest::Approx(std::atan2(4.0, 3.0)).epsilon(1e-14));
  }
}

TEST_CASE("a curve through three points, evenly spaced, is their parabola, and its bricks stand at equal arc length along it") {
  // Through (0, 0), (0.4, 0.2), (0.8, 0): y = 0.2 - 1.25 (x - 0.4)^2.
  const Layout layout = read("[[curve]]\npoints_mm = [[0, 0], [400, 200], [800, 0]]\ngap_mm = 16.5\n");
  const double a = 1.25, start = parabola_length(a, -0.4), whole = 2.0 * parabola_length(a, 0.4);
  REQUIRE(layout.brick_count() == static_cast<BrickId>(whole / 0.024) + 1);
  for (int i = 0; i < layout.brick_count(); ++i) {
    const Brick& brick = layout.bricks[static_cast<std::size_t>(i)];
    const double x = brick.foot.x - 0.4;
    CHECK(brick.foot.y == doctest::Approx(0.2 - a * x * x).epsilon(1e-12));
    CHECK(parabola_length(a, x) - start == doctest::Approx(0.024 * i).epsilon(1e-10));
    CHECK(brick.heading == doctest::Approx(std::atan(-2.0 * a * x)).epsilon(1e-10));
  }
}

TEST_CASE("a curve passes through its points, and its length is that of what it walks") {
  Spline spline(kWild);
  std::vector<double> nearest(kWild.size(), 1.0);
  constexpr int kSteps = 200'000;
  double walked = 0.0;
  Vec3 last = spline.at(0.0).point;
  for (int i = 0; i <= kSteps; ++i) {
    const Spline::At at = spline.at(spline.length() * i / kSteps);
    CHECK_MESSAGE(std::abs(norm(at.tangent) - 1.0) < 1e-15, i);
    walked += norm(at.point - last);
    last = at.point;
    for (std::size_t p = 0; p < kWild.size(); ++p) nearest[p] = std::fmin(nearest[p], norm(at.point - kWild[p]));
  }
  // Steps of 30 um: a chord falls short of its arc by step^2 / (24 radius^2), 4e-8 of it at the sharpest bend of 30 mm.
  CHECK(walked == doctest::Approx(spline.length()).epsilon(1e-7));
  for (const double distance : nearest) CHECK(distance < 0.5 * spline.length() / kSteps + 1e-12);
}

TEST_CASE("steps along a curve are equal to a millionth, and the tangent is the way they go") {
  Spline spline(kWild);
  constexpr int kSteps = 400'000;  // a chord falls short of its arc by (step / radius)^2 / 24: at the sharpest bend 7e-8 of it
  const double step = spline.length() / kSteps;
  Spline::At last = spline.at(0.0);
  double worst_step = 0.0, worst_turn = 0.0;
  for (int i = 1; i <= kSteps; ++i) {
    const Spline::At at = spline.at(step * i);
    const Vec3 walk = at.point - last.point;
    worst_step = std::fmax(worst_step, std::abs(norm(walk) / step - 1.0));
    worst_turn = std::fmax(worst_turn,
                           norm((1.0 / norm(walk)) * walk - (0.5 / norm(0.5 * (at.tangent + last.tangent))) * (at.tangent + last.tangent)));
    last = at;
  }
  CHECK(worst_step < 2e-7);
  CHECK(worst_turn < 1e-4);
}

TEST_CASE("a curve can be walked in any order") {
  Spline forth(kWild), back(kWild);
  for (int i = 0; i <= 100; ++i) {
    const double there = forth.length() * i / 100, here = forth.length() * (100 - i) / 100;
    const Spline::At a = forth.at(there);
    back.at(here);
    const Spline::At b = back.at(there);
    CHECK(a.point == b.point);
    CHECK(a.tangent == b.tangent);
  }
}

TEST_CASE("a colour runs from the first brick of a part to its last") {
  const Layout layout = read("[[row]]\ncount = 3\ngap_mm = 10\ncolor = \"#ff0000\"\ncolor_to = \"#0000ff\"\n");
  const auto color = [&](std::size_t i) { return layout.colors[layout.bricks[i].color]; };
  CHECK(color(0) == Color{255, 0, 0});
  CHECK(color(1) == Color{128, 0, 128});
  CHECK(color(2) == Color{0, 0, 255});
  const Layout many = read(
      "[[row]]\ncount = 1000\ngap_mm = 10\ncolor = \"#ff0000\"\ncolor_to = \"#0000ff\"\n[[row]]\nfrom_mm=[0,100]\ncount = 1\ngap_mm = "
      "0\ncolor = \"#FF0000\"\n");
  CHECK(many.colors.size() == 256);
  CHECK(many.colors[many.bricks[999].color] == Color{0, 0, 255});
  CHECK(many.bricks[1000].color == many.bricks[0].color);
}

}  // namespace topple

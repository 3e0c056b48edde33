#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "base/random.h"
#include "base/trigonometry.h"
#include "topple/layout.h"

namespace topple {
namespace {

Vec3 random_direction(Random& random) {
  const Vec3 v{random.normal(), random.normal(), random.normal()};
  return (1.0 / norm(v)) * v;
}

Quat random_turn(Random& random) {
  const Quat q{random.normal(), random.normal(), random.normal(), random.normal()};
  const double s = 1.0 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w * s, q.x * s, q.y * s, q.z * s};
}

Quat about(const Vec3& axis, double angle) {
  const SinCos half = sin_cos(angle / 2.0);
  return {half.cos, half.sin * axis.x, half.sin * axis.y, half.sin * axis.z};
}

Box random_box(Random& random, double spread) {
  return {{spread * Vec3{random.normal(), random.normal(), random.normal()}, random_turn(random)},
          {0.002 + 0.03 * random.uniform(), 0.002 + 0.03 * random.uniform(), 0.002 + 0.03 * random.uniform()}};
}

/// The gap of the two projections on a unit direction, from the definition.
double gap_along(const Box& a, const Box& b, const Vec3& direction) {
  double reach = 0.0;
  for (const Box* box : {&a, &b}) {
    const Vec3 own = rotate(conjugate(box->pose.orientation), direction);
    reach += box->half.x * std::abs(own.x) + box->half.y * std::abs(own.y) + box->half.z * std::abs(own.z);
  }
  return std::abs(dot(direction, b.pose.position - a.pose.position)) - reach;
}

/// The greatest gap over directions, found by throwing directions and then walking uphill with ever smaller steps: knows nothing of axes.
double gap_by_search(const Box& a, const Box& b, Random& random) {
  Vec3 best_direction{1.0, 0.0, 0.0};
  double best = gap_along(a, b, best_direction);
  const auto attempt = [&](const Vec3& direction) {
    const double gap = gap_along(a, b, direction);
    if (gap > best) {
      best = gap;
      best_direction = direction;
    }
  };
  for (int i = 0; i < 4000; ++i) attempt(random_direction(random));
  for (double step = 0.1; step > 1e-9; step *= 0.8) {
    for (int i = 0; i < 100; ++i) {
      const Vec3 moved = best_direction + step * random_direction(random);
      attempt((1.0 / norm(moved)) * moved);
    }
  }
  return best;
}

/// The fifteen axes once more, plainly: every axis made in the world, normalised, and both boxes projected on it, with more digits.
/// Edges whose cross product vanishes even then are left out.
long double reference_gap(const Box& a, const Box& b) {
  using Axis = std::array<long double, 3>;
  const auto axes_of = [](const Quat& q) {
    const long double w = q.w, x = q.x, y = q.y, z = q.z, n = w * w + x * x + y * y + z * z;
    return std::array<Axis, 3>{{{(w * w + x * x - y * y - z * z) / n, 2 * (x * y + w * z) / n, 2 * (x * z - w * y) / n},
                                {2 * (x * y - w * z) / n, (w * w - x * x + y * y - z * z) / n, 2 * (y * z + w * x) / n},
                                {2 * (x * z + w * y) / n, 2 * (y * z - w * x) / n, (w * w - x * x - y * y + z * z) / n}}};
  };
  const auto dot3 = [](const Axis& u, const Axis& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; };
  const std::array<Axis, 3> of_a = axes_of(a.pose.orientation), of_b = axes_of(b.pose.orientation);
  const Axis half_a{a.half.x, a.half.y, a.half.z}, half_b{b.half.x, b.half.y, b.half.z};
  const Vec3 between = b.pose.position - a.pose.position;
  long double best = -1.0L;
  const auto look_along = [&](const Axis& axis) {
    const long double length = std::sqrt(dot3(axis, axis));
    if (length < 1e-16L) return;
    long double reach = 0.0L;
    for (std::size_t i = 0; i < 3; ++i) reach += half_a[i] * std::abs(dot3(axis, of_a[i])) + half_b[i] * std::abs(dot3(axis, of_b[i]));
    best = std::fmax(best, (std::abs(dot3(axis, {between.x, between.y, between.z})) - reach) / length);
  };
  for (const Axis& u : of_a) {
    look_along(u);
    for (const Axis& v : of_b) look_along({u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]});
  }
  for (const Axis& v : of_b) look_along(v);
  return best;
}

}  // namespace

TEST_CASE("boxes side by side are as far apart as their faces") {
  const Box a{{{0.0, 0.0, 0.0}, {}}, {0.5, 1.0, 2.0}};
  CHECK(separation(a, {{{2.0, 0.0, 0.0}, {}}, {0.5, 1.0, 2.0}}) == 1.0);
  CHECK(separation(a, {{{0.75, 0.5, 0.5}, {}}, {0.5, 1.0, 2.0}}) == -0.25);
  CHECK(separation(a, {{{0.0, 0.0, 4.0}, {}}, {0.5, 1.0, 2.0}}) == 0.0);
}

TEST_CASE("two cubes that cross edge over edge are separated along the cross product of the edges") {
  // Each cube (half 1) shows an edge: the lower one is turned 45 deg about x, the upper one 45 deg about y; both edges lie sqrt(2) from
  // their centre on the z axis, so with the centres 3 apart the gap is 3 - 2 sqrt(2).
  const Box a{{{0.0, 0.0, 0.0}, about({1.0, 0.0, 0.0}, kPi / 4.0)}, {1.0, 1.0, 1.0}};
  const Box b{{{0.0, 0.0, 3.0}, about({0.0, 1.0, 0.0}, kPi / 4.0)}, {1.0, 1.0, 1.0}};
  CHECK(separation(a, b) == doctest::Approx(3.0 - 2.0 * std::sqrt(2.0)).epsilon(1e-14));
}

TEST_CASE("for boxes that overlap the separation is the best of all directions, found by search") {
  Random random(7);
  int overlapping = 0;
  for (int i = 0; i < 400; ++i) {
    const Box a = random_box(random, 0.02), b = random_box(random, 0.02);
    const double fast = separation(a, b);
    if (fast >= 0.0) continue;
    ++overlapping;
    const double searched = gap_by_search(a, b, random);
    CHECK(searched <= fast + 1e-15);            // no direction is better than the fifteen
    if (i < 60) CHECK(searched > fast - 2e-3);  // and the search, which may stop in a side valley, comes near
  }
  CHECK(overlapping > 100);
}

TEST_CASE("boxes that are apart in some direction are reported apart, and never further than they are") {
  Random random(8);
  int apart = 0;
  for (int i = 0; i < 200; ++i) {
    const Box a = random_box(random, 0.03), b = random_box(random, 0.03);
    const double fast = separation(a, b);
    const double searched = gap_by_search(a, b, random);
    CHECK((fast > 0.0) == (searched > 0.0));
    if (fast <= 0.0) continue;
    ++apart;
    CHECK(fast <= searched + 1e-4 * searched);  // the search ends near the true gap
  }
  CHECK(apart > 50);
}

TEST_CASE("the separation does not depend on which box comes first") {
  Random random(9);
  for (int i = 0; i < 1000; ++i) {
    const Box a = random_box(random, 0.03), b = random_box(random, 0.03);
    CHECK(separation(a, b) == doctest::Approx(separation(b, a)).epsilon(1e-12));
  }
}

TEST_CASE("far from the origin the separation loses only the digits that the places have lost") {
  Random random(10);
  const Vec3 far{24000.0, -24000.0, 0.0};
  for (int i = 0; i < 1000; ++i) {
    Box a = random_box(random, 0.02), b = random_box(random, 0.02);
    // Places that are exact in both frames: multiples of 2^-30 m survive the move to 24 km unchanged.
    const auto snap = [](double x) { return std::round(x * 0x1p30) * 0x1p-30; };
    for (Box* box : {&a, &b}) {
      Vec3& at = box->pose.position;
      at = {snap(at.x), snap(at.y), snap(at.z)};
    }
    const double here = separation(a, b);
    a.pose.position = a.pose.position + far;
    b.pose.position = b.pose.position + far;
    CHECK(separation(a, b) == here);
  }
}

TEST_CASE("edges that are almost parallel neither spoil the separation nor make it jump") {
  // A box into a box, turned by ever smaller angles about ever other axes: the depth changes by no more than a corner moves.
  // (Boxes that are apart keep the sign alone: which of several lower bounds of the gap is found may change.)
  Random random(11);
  const Box a{{{0.0, 0.0, 0.0}, {}}, {0.00375, 0.012, 0.024}};
  const Vec3 half = a.half;
  for (double angle = 1e-3; angle > 1e-18; angle *= 0.1) {
    for (int i = 0; i < 200; ++i) {
      const Vec3 at{0.0073 + 0.001 * random.normal(), 0.01 * random.normal(), 0.02 * random.normal()};
      const double straight = separation(a, {{at, {}}, half});
      const double turned = separation(a, {{at, about(random_direction(random), angle)}, half});
      if (straight < 0.0) CHECK(std::abs(turned - straight) <= angle * norm(half) + 1e-16);
      if (straight > 0.0) CHECK(turned > -angle * norm(half) - 1e-16);
    }
  }
}

TEST_CASE("turned a little, the depth of two boxes is right to the last digits") {
  Random random(12);
  const Vec3 half{0.01, 0.01, 0.01};
  // Axes of one may lie along other axes of the other: cubes look the same.
  const std::array<Quat, 3> quarters{Quat{}, about({0.0, 0.0, 1.0}, kPi / 2.0), about({0.0, 1.0, 0.0}, kPi / 2.0)};
  double worst = 0.0;
  int looked = 0;
  for (double angle = 1.0; angle > 1e-4; angle *= 0.5) {
    for (int i = 0; i < 4000; ++i) {
      // Edge to edge, about as deep along several axes: where which axis wins depends on the turn.
      const double deep = angle * 0.01 * random.uniform();
      const Vec3 at{0.02 - deep, 0.02 - deep * random.uniform(), 0.02 * (random.uniform() - 0.5)};
      const Quat base = random_turn(random);
      const Box a{{{0.0, 0.0, 0.0}, base}, half};
      const Box b{{rotate(base, at), base * about(random_direction(random), angle) * quarters[static_cast<std::size_t>(i % 3)]}, half};
      const double fast = separation(a, b);
      if (fast >= 0.0) continue;
      ++looked;
      worst = std::fmax(worst, std::abs(static_cast<double>(fast - reference_gap(a, b))));
    }
  }
  CHECK(looked > 10000);
  // Places of 5 cm carry 7e-18 m a digit, the turns 1e-16, which moves a corner by 3e-18 m; the reference loses 5e-20 / angle of a brick's
  // size.
  CHECK(worst < 1e-16);
}

}  // namespace topple

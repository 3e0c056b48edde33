/// Layouts for the tests of the models, made in code so that a test shows what it depends on.
#pragma once

#include <cmath>
#include <numbers>

#include "topple/layout.h"

namespace topple::test {

/// The report's brick, [Arnesson2020] section 2.1.1; it prints no mass.
inline BrickKind report_kind(double mass) {
  return {.name = "report", .height = 0.04353, .width = 0.02156, .thickness = 0.00679, .mass = mass};
}

/// `count` bricks from the origin along +x, face to face `gap` apart [m].
inline Layout row(const BrickKind& kind, int count, double gap) {
  Layout layout;
  layout.name = "row";
  layout.kinds = {kind};
  layout.colors = {kind.color};
  layout.parts = {{.name = "row 1", .first = 0, .count = count}};
  const double pitch = gap + kind.thickness;
  for (int i = 0; i < count; ++i) layout.bricks.push_back({.foot = {pitch * i, 0.0, 0.0}});
  return layout;
}

/// Two arcs, the second turning back: bricks at equal arc length, each facing along the curve.
inline Layout s_curve(const BrickKind& kind, int count, double gap, double radius) {
  Layout layout = row(kind, count, gap);
  const double pitch = gap + kind.thickness;
  Vec3 foot;
  double heading = 0.0;
  for (int i = 0; i < count; ++i) {
    layout.bricks[static_cast<std::size_t>(i)] = {.foot = foot, .heading = heading};
    const double turn = (i < count / 2 ? 1.0 : -1.0) * pitch / radius;
    const double chord = 2.0 * radius * std::sin(0.5 * pitch / radius);
    foot = foot + chord * Vec3{std::cos(heading + 0.5 * turn), std::sin(heading + 0.5 * turn), 0.0};
    heading += turn;
  }
  return layout;
}

}  // namespace topple::test

// One brick: the report's figures 5.1 and 5.2, the integrators, the floor.
#include <doctest/doctest.h>

#include <cmath>

#include "model/pivot/fall.h"
#include "model/pivot/lean.h"
#include "model/rows.h"
#include "topple/run.h"

namespace topple {
namespace {

using test::report_kind;
using test::row;

constexpr double kRightAngle = 0.5 * std::numbers::pi;

Layout one_brick(double mass, double force, double duration) {
  Layout layout = row(report_kind(mass), 1, 0.02);
  layout.gravity = 9.82;
  layout.pushes = {{.brick = 0, .at = 0.0, .how = ForcePush{force, 0.04353, duration}}};
  return layout;
}

TEST_CASE("the_angle_of_a_sine_and_a_cosine_is_that_of_the_c_library") {
  for (int i = 0; i <= 15707; ++i) {
    const double angle = 1e-4 * i;
    REQUIRE(pivot::angle_of({std::sin(angle), std::cos(angle)}) == doctest::Approx(angle).epsilon(1e-15));
  }
}

TEST_CASE("half_a_newton_topples_the_brick") {
  // Figure 5.1. For 10 ms at the top: I = 0.0045 (0.04353^2 + 0.00679^2) / 12 = 7.28e-7 kg m^2, so omega reaches about 0.5 x 0.04353
  // x 0.01 / 7.28e-7 = 300 rad/s, far more than the barrier asks for.
  const auto recording = simulate(one_brick(0.0045, 0.5, 0.010), PivotConfig{});
  REQUIRE(recording);
  CHECK(recording->end().reason == EndReason::at_rest);
  CHECK(std::fabs(recording->at(0, 10.0).hinge.angle - kRightAngle) < 1e-6);
}

TEST_CASE("five_thousandths_of_a_newton_lift_the_brick_and_it_returns_to_standing") {
  // Figure 5.2. Gravity holds it with m g T / 2 = 1.500e-4 N m, the force lifts with 0.005 x 0.04353 = 2.177e-4 N m: alpha = 92.9 rad/s^2
  // at first, so after 10 ms theta = alpha t^2 / 2 = 0.27 deg and omega = 0.93 rad/s; then gravity alone, -206 rad/s^2, stops it after
  // another 0.12 deg: 0.39 deg in all, of a tip angle of 8.9 deg.
  const auto recording = simulate(one_brick(0.0045, 0.005, 0.010), PivotConfig{});
  REQUIRE(recording);
  double highest = 0.0;
  for (double t = 0.0; t < 0.2; t += 1e-4) highest = std::fmax(highest, recording->at(0, t).hinge.angle);
  CHECK(highest * 180.0 / std::numbers::pi == doctest::Approx(0.40).epsilon(0.08));
  CHECK(recording->at(0, 10.0).hinge.angle == 0.0);
  CHECK(recording->end().reason == EndReason::wave_died);
  CHECK(recording->end().brick == 0);
}

TEST_CASE("explicit_euler_follows_the_printed_recurrence") {
  const BrickKind kind = report_kind(0.0085);
  const pivot::Turning body = pivot::turning(extents(kind, Stance::standing), kind.mass, 9.81, InertiaRule::report);
  const pivot::Fall from = pivot::fall_at(1.0, 0.3, 2.0);
  const pivot::Fall to = pivot::advance(body, from, 1.0005, Integrator::euler);
  // (2.3), (2.4), (3.1), (3.2), with the C library's sine and cosine.
  const double d = 0.5 * kind.thickness * std::cos(0.3) - 0.5 * kind.height * std::sin(0.3);
  const double inertia = kind.mass * (kind.height * kind.height + kind.thickness * kind.thickness) / 12.0;
  CHECK(to.omega == doctest::Approx(2.0 - 0.0005 * kind.mass * 9.81 * d / inertia).epsilon(1e-12));
  CHECK(to.theta == doctest::Approx(0.3 + 0.0005 * 2.0).epsilon(1e-14));
}

TEST_CASE("the_moment_of_inertia_about_the_toe_is_four_times_the_printed_one") {
  const Extents size{.along = 0.00679, .across = 0.02156, .up = 0.04353};
  CHECK(pivot::moment_of_inertia(size, 1.0, InertiaRule::pivot) ==
        doctest::Approx(4.0 * pivot::moment_of_inertia(size, 1.0, InertiaRule::report)).epsilon(1e-14));
}

TEST_CASE("euler_has_order_one_and_runge_kutta_order_four") {
  const Convergence convergence = free_fall_convergence(row(report_kind(0.0085), 1, 0.02));
  REQUIRE(convergence.series.size() == 3);
  CHECK(std::fabs(convergence.series[0].slope - 1.0) < 0.05);
  CHECK(std::fabs(convergence.series[1].slope - 1.0) < 0.05);
  CHECK(std::fabs(convergence.series[2].slope - 4.0) < 0.2);
}

TEST_CASE("runge_kutta_keeps_the_energy_of_a_free_fall") {
  const BrickKind kind = report_kind(0.0085);
  const pivot::Turning body = pivot::turning(extents(kind, Stance::standing), kind.mass, 9.81, InertiaRule::pivot);
  // omega^2 / 2 + sine cos(theta) + cosine sin(theta) is conserved.
  const auto energy = [&](const pivot::Fall& f) {
    return 0.5 * f.omega * f.omega + body.sine * std::cos(f.theta) + body.cosine * std::sin(f.theta);
  };
  pivot::Fall fall = pivot::fall_at(0.0, 0.2, 0.0);
  const double before = energy(fall);
  for (int i = 1; fall.theta < kRightAngle; ++i) fall = pivot::advance(body, fall, 0.0005 * i, Integrator::rk4);
  // Fifth-order errors of 400 steps of 0.5 ms against a time scale of 35 ms: (0.5 / 35)^4 = 4e-8 relative.
  CHECK(std::fabs(energy(fall) - before) < 4e-8 * before);
}

TEST_CASE("a_push_can_come_late_and_as_angular_speed_or_impulse") {
  for (const auto& how : {decltype(Push::how){AngularSpeedPush{8.0}}, decltype(Push::how){ImpulsePush{0.0015, 0.04}}}) {
    Layout layout = row(report_kind(0.0085), 1, 0.02);
    layout.pushes = {{.brick = 0, .at = 0.25, .how = how}};
    const auto recording = simulate(std::move(layout), PivotConfig{});
    REQUIRE(recording);
    CHECK(recording->at(0, 0.2499).hinge.angle == 0.0);
    CHECK(recording->at(0, 0.26).hinge.angle > 0.05);
    CHECK(recording->event(0).time == 0.25);
    CHECK(std::fabs(recording->at(0, 10.0).hinge.angle - kRightAngle) < 1e-6);
  }
}

}  // namespace
}  // namespace topple

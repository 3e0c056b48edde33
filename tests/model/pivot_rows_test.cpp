// Many bricks: hits, leaning, where a wave dies, and that none ever overlap.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "model/rows.h"
#include "topple/measure.h"
#include "topple/run.h"

namespace topple {
namespace {

using test::report_kind;
using test::row;
using test::s_curve;

constexpr double kDegree = std::numbers::pi / 180.0;

std::vector<Event> events_of(const Recording& recording, EventKind kind) {
  std::vector<Event> found;
  for (std::int64_t i = 0; i < recording.event_count(); ++i) {
    if (recording.event(i).kind == kind) found.push_back(recording.event(i));
  }
  return found;
}

double deepest_of_all(const Recording& recording, double step) {
  double deepest = 0.0;
  for (double t = 0.0; t <= recording.duration(); t += step) deepest = std::fmax(deepest, deepest_overlap(recording, t).depth);
  return deepest;
}

TEST_CASE("five_newtons_hand_on_5_0703_newtons_at_two_centimetres") {
  // Figure 5.3, with the inferred 44.6 g, g = 9.82 and a pulse longer than 5.6 ms. theta_c = asin(2 / 4.353) = 27.35 deg,
  // d = 3.395 cos - 21.765 sin = -6.985 mm, F2 = 5 + 0.0446 x 9.82 x 0.006985 / 0.04353 = 5.0703 N.
  Layout layout = row(report_kind(0.0446), 2, 0.02);
  layout.gravity = 9.82;
  layout.pushes = {{.brick = 0, .at = 0.0, .how = ForcePush{5.0, 0.04353, 0.010}}};
  const auto recording = simulate(std::move(layout), PivotConfig{.hit = HitRule::report, .pulse = 0.010});
  REQUIRE(recording);
  const std::vector<Event> hits = events_of(*recording, EventKind::struck);
  REQUIRE(hits.size() == 1);
  CHECK(std::round(hits[0].force * 1e4) == 50703.0);
  CHECK(hits[0].point.z == doctest::Approx(0.04353 * std::cos(std::asin(2.0 / 4.353))).epsilon(1e-6));
  CHECK(hits[0].time < 0.0060);
  CHECK(hits[0].time > 0.0055);
}

TEST_CASE("the_forces_of_report_hits_grow_by_the_same_amount_along_500_bricks") {
  Layout layout = row(report_kind(0.0446), 500, 0.02);
  layout.gravity = 9.82;
  layout.pushes = {{.brick = 0, .at = 0.0, .how = ForcePush{5.0, 0.04353, 0.010}}};
  const auto recording = simulate(std::move(layout), PivotConfig{.hit = HitRule::report, .pulse = 0.010});
  REQUIRE(recording);
  const std::vector<Event> hits = events_of(*recording, EventKind::struck);
  REQUIRE(hits.size() == 499);
  const double theta = std::asin(0.02 / 0.04353);
  const double d = 0.5 * 0.00679 * std::cos(theta) - 0.5 * 0.04353 * std::sin(theta);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const double closed_sum = 5.0 - static_cast<double>(i + 1) * 0.0446 * 9.82 * d / 0.04353;
    REQUIRE(hits[i].force == doctest::Approx(closed_sum).epsilon(1e-6));  // A recording keeps single precision.
  }
}

TEST_CASE("a_short_report_pulse_fails_to_lift_the_next_brick") {
  Layout layout = row(report_kind(0.0446), 10, 0.02);
  layout.gravity = 9.82;
  layout.pushes = {{.brick = 0, .at = 0.0, .how = ForcePush{5.0, 0.04353, 0.002}}};
  // The force is over before the hit, so only gravity's 0.0703 N go over, whose torque at r = H cos(theta_c) is 2.7e-3 N m against the
  // 1.49e-3 N m that hold the next brick: for 2 ms that lifts it by 0.02 deg and no more.
  const auto recording = simulate(std::move(layout), PivotConfig{.hit = HitRule::report, .pulse = 0.002});
  REQUIRE(recording);
  CHECK(events_of(*recording, EventKind::struck)[0].force == doctest::Approx(0.0703).epsilon(1e-3));
  CHECK(recording->end().reason == EndReason::wave_died);
  CHECK(recording->end().brick == 1);
}

TEST_CASE("the_last_falls_flat_and_the_others_lean_as_geometry_says") {
  Layout layout = row(report_kind(0.0085), 60, 0.02);
  layout.pushes = {{.brick = 0, .at = 0.0, .how = AngularSpeedPush{6.0}}};
  const auto recording = simulate(std::move(layout), PivotConfig{});
  REQUIRE(recording);
  const RunSummary summary = summarize(*recording);
  CHECK(summary.fallen == 60);
  CHECK(summary.standing == 0);
  CHECK(recording->end().reason == EndReason::at_rest);
  const double pitch = 0.02679;
  const auto angle = [&](BrickId brick) { return recording->at(brick, 1e6).hinge.angle; };
  // It rests within 5e-4 T / H = 8e-5 rad of where the one ahead lets it be, and a knot may be 0.2 % T off: 3.1e-4 rad.
  CHECK(angle(59) == doctest::Approx(90.0 * kDegree).epsilon(1e-6));
  CHECK(std::fabs(angle(58) - std::atan(pitch / 0.00679)) < 4e-4);
  CHECK(std::fabs(angle(20) - std::acos(0.00679 / pitch)) < 4e-4);
}

TEST_CASE("momentum_hits_settle_when_plastic_and_speed_up_when_elastic") {
  const auto local_speeds = [](double restitution) {
    BrickKind kind = report_kind(0.0085);
    kind.surface.brick_restitution = restitution;
    Layout layout = row(kind, 80, 0.02);
    layout.pushes = {{.brick = 0, .at = 0.0, .how = AngularSpeedPush{6.0}}};
    const auto recording = simulate(std::move(layout), PivotConfig{});
    REQUIRE(recording);
    const Wave wave = measure_wave(*recording);
    REQUIRE(wave.bricks.size() == 80);
    return std::vector{wave.local_speed(20), wave.local_speed(40), wave.local_speed(70)};
  };
  const std::vector plastic = local_speeds(0.0);
  CHECK(plastic[2] == doctest::Approx(plastic[1]).epsilon(0.02));
  const std::vector elastic = local_speeds(1.0);
  CHECK(elastic[1] > 1.2 * elastic[0]);
  CHECK(elastic[2] > 1.2 * elastic[1]);
}

TEST_CASE("the_same_push_again_topples_every_brick") {
  Layout layout = row(report_kind(0.0085), 30, 0.02);
  layout.pushes = {{.brick = 0, .at = 0.0, .how = ImpulsePush{0.0015, 0.04}}};
  const auto recording = simulate(std::move(layout), PivotConfig{.hit = HitRule::same});
  REQUIRE(recording);
  CHECK(summarize(*recording).fallen == 30);
  for (const Event& hit : events_of(*recording, EventKind::struck)) REQUIRE(hit.impulse == doctest::Approx(0.0015));
}

TEST_CASE("a_gap_of_the_height_or_more_is_missed") {
  Layout layout = row(report_kind(0.0085), 3, 0.0436);
  layout.pushes = {{.brick = 0, .at = 0.0, .how = AngularSpeedPush{8.0}}};
  const auto recording = simulate(std::move(layout), PivotConfig{});
  REQUIRE(recording);
  CHECK(events_of(*recording, EventKind::missed).size() == 1);
  CHECK(recording->end().reason == EndReason::wave_died);
  CHECK(recording->end().brick == 0);
  CHECK(recording->at(0, 1e6).hinge.angle == doctest::Approx(90.0 * kDegree).epsilon(1e-6));
  CHECK(summarize(*recording).standing == 2);
}

TEST_CASE("a_struck_brick_that_falls_back_stops_on_its_leaner") {
  // Heavy bricks struck by a light one with e = 0: the first is lifted a little and falls back onto the light one, which leans on it.
  Layout layout = row(report_kind(0.0085), 4, 0.03);
  BrickKind heavy = report_kind(0.085);
  heavy.name = "heavy";
  layout.kinds.push_back(heavy);
  for (std::size_t i = 1; i < 4; ++i) layout.bricks[i].kind = 1;
  layout.pushes = {{.brick = 0, .at = 0.0, .how = AngularSpeedPush{8.0}}};
  const auto recording = simulate(std::move(layout), PivotConfig{});
  REQUIRE(recording);
  CHECK(recording->end().reason == EndReason::wave_died);
  CHECK(recording->end().brick == 1);
  CHECK(recording->at(0, 1e6).hinge.angle > 0.5);
  CHECK(recording->at(1, 1e6).hinge.angle < 8.8 * kDegree);
  CHECK(deepest_of_all(*recording, 0.001) < 0.01);
}

TEST_CASE("no_two_bricks_of_a_row_of_500_overlap_at_any_time") {
  for (const auto& [gap, restitution] : {std::pair{0.02, 0.0}, std::pair{0.02, 0.5}, std::pair{0.016, 0.9}, std::pair{0.035, 0.0}}) {
    BrickKind kind = report_kind(0.0085);
    kind.surface.brick_restitution = restitution;
    Layout layout = row(kind, 500, gap);
    layout.pushes = {{.brick = 0, .at = 0.0, .how = AngularSpeedPush{8.0}}};
    const auto recording = simulate(std::move(layout), PivotConfig{});
    REQUIRE(recording);
    CAPTURE(gap);
    CAPTURE(restitution);
    CHECK(summarize(*recording).fallen == 500);
    CHECK(deepest_of_all(*recording, 0.0073) < 0.01);
  }
}

TEST_CASE("no_two_bricks_of_an_s_curve_of_200_overlap_at_any_time") {
  // In a curve the inner corner touches before the row's 27.35 deg, and e = 0 no longer carries the wave.
  BrickKind kind = report_kind(0.0085);
  kind.surface.brick_restitution = 0.5;
  Layout layout = s_curve(kind, 200, 0.02, 0.5);
  layout.pushes = {{.brick = 0, .at = 0.0, .how = AngularSpeedPush{8.0}}};
  const auto recording = simulate(std::move(layout), PivotConfig{});
  REQUIRE(recording);
  CHECK(summarize(*recording).fallen == 200);
  CHECK(deepest_of_all(*recording, 0.0073) < 0.01);
}

TEST_CASE("a_split_starts_both_branches") {
  Layout layout = row(report_kind(0.0085), 5, 0.02);
  const double pitch = 0.02679;
  for (int i = 0; i < 10; ++i) {
    for (const double side : {-1.0, 1.0}) layout.bricks.push_back({.foot = {pitch * (5 + i), side * 0.0115, 0.0}});
  }
  layout.kinds[0].surface.brick_restitution = 1.0;
  layout.pushes = {{.brick = 0, .at = 0.0, .how = AngularSpeedPush{10.0}}};
  const auto recording = simulate(std::move(layout), PivotConfig{});
  REQUIRE(recording);
  CHECK(summarize(*recording).fallen == 25);
}

TEST_CASE("merges_and_raised_bricks_are_refused_in_words") {
  Layout merge = row(report_kind(0.0085), 1, 0.02);
  merge.bricks = {{.foot = {0.0, 0.0115, 0.0}}, {.foot = {0.0, -0.0115, 0.0}}, {.foot = {0.027, 0.0, 0.0}}};
  merge.pushes = {{.brick = 0, .at = 0.0, .how = AngularSpeedPush{8.0}}, {.brick = 1, .at = 0.0, .how = AngularSpeedPush{8.0}}};
  auto refused = simulate(std::move(merge), PivotConfig{});
  REQUIRE(!refused);
  CHECK(refused.error().message.find("bricks 0 and 1 can both strike brick 2") != std::string::npos);

  Layout raised = row(report_kind(0.0085), 2, 0.02);
  raised.bricks[1].foot.z = 0.01;
  raised.pushes = {{.brick = 0, .at = 0.0, .how = AngularSpeedPush{8.0}}};
  refused = simulate(std::move(raised), PivotConfig{});
  REQUIRE(!refused);
  CHECK(refused.error().message.find("brick 1 stands 10.000000 mm above the floor") != std::string::npos);
}

TEST_CASE("a_row_does_not_care_where_it_stands_or_which_way_it_heads") {
  const auto duration = [](double heading, double shift) {
    Layout layout = row(report_kind(0.0085), 40, 0.02);
    for (Brick& brick : layout.bricks) {
      const double x = brick.foot.x;
      brick.foot = {shift + x * std::cos(heading), -shift + x * std::sin(heading), 0.0};
      brick.heading = heading;
    }
    layout.pushes = {{.brick = 0, .at = 0.0, .how = AngularSpeedPush{8.0}}};
    const auto recording = simulate(std::move(layout), PivotConfig{});
    REQUIRE(recording);
    return measure_wave(*recording).arrival.back();
  };
  CHECK(duration(0.0, 0.0) == doctest::Approx(duration(0.7, 0.0)).epsilon(1e-6));
  CHECK(duration(0.0, 0.0) == doctest::Approx(duration(-2.0, 1000.0)).epsilon(1e-6));
}

}  // namespace
}  // namespace topple

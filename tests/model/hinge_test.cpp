#include <algorithm>
#include <cmath>

#include "model/hinge_row.h"
#include "topple/run.h"

using namespace topple;

namespace {

constexpr double kDegree = 0.017453292519943295;

int count(const HingeRun& run, EventKind kind) {
  return static_cast<int>(std::count_if(run.events.begin(), run.events.end(), [&](const Event& e) { return e.kind == kind; }));
}

std::string refusal(const Layout& layout, const HingeConfig& config = {}) {
  auto model = hinge::make_hinge_model(layout, config);
  return model ? std::string() : model.error().message;
}

}  // namespace

TEST_CASE("a_brick_pushed_too_softly_returns_to_standing_and_one_pushed_a_little_more_falls") {
  // sqrt(2) lambda sqrt(1 - cos phi) with lambda^2 = 3 g / (2 sqrt(h^2 + d^2)) and tan phi = d / h: 2.694811 rad/s.
  const Layout soft = make_row({.count = 1, .push = 2.694811 * 0.9999});
  const HingeRun back = run_hinge(soft);
  CHECK(back.rest[0] == 0.0);
  CHECK(back.progress == Progress::at_rest);
  CHECK(count(back, EventKind::landed) == 0);
  const Layout hard = make_row({.count = 1, .push = 2.694811 * 1.0001});
  const HingeRun over = run_hinge(hard);
  CHECK(over.rest[0] == doctest::Approx(90.0 * kDegree));
  CHECK(count(over, EventKind::landed) == 1);
}

TEST_CASE("a_single_brick_takes_the_time_that_the_integral_of_its_energy_gives") {
  // From upright at 8 rad/s to flat: t = integral over theta of 1 / sqrt(w0^2 - 2 lambda^2 (cos(theta - phi) - cos phi) ... ), by Simpson's
  // rule with 200,000 intervals, which errs by less than 1e-12.
  const double h = 0.048;
  const double d = 0.0075;
  const double phi = std::atan(d / h);
  const double lambda2 = 3.0 * 9.81 / (2.0 * std::sqrt(h * h + d * d));
  const int n = 200000;
  double time = 0.0;
  for (int i = 0; i <= n; ++i) {
    const double theta = 0.5 * 3.14159265358979323846 * i / n;
    // rate^2 = w0^2 + 2 lambda^2 (cos phi - cos(theta - phi)): the height of the centre of mass goes with cos(theta - phi).
    const double weight = i == 0 || i == n ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    time += weight / std::sqrt(64.0 + 2.0 * lambda2 * (std::cos(phi) - std::cos(theta - phi)));
  }
  time *= 0.5 * 3.14159265358979323846 / n / 3.0;
  const HingeRun run = run_hinge(make_row({.count = 1}));
  const auto landed = std::find_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == EventKind::landed; });
  REQUIRE(landed != run.events.end());
  CHECK(std::fabs(landed->time / time - 1.0) < 1e-6);
}

TEST_CASE("behind_the_front_every_brick_comes_to_lean_at_the_arc_cosine_of_thickness_over_pitch") {
  // Flush with the brick ahead: cos(theta) = d / p [vanLeeuwen2010]. It may stop short by 0.002 of the thickness at its corner:
  // 0.002 x 7.5 / 48 rad = 0.018 deg.
  const HingeRun run = run_hinge(make_row({.count = 200, .gap = 0.0165}));
  for (std::size_t i = 0; i < 190; ++i) {
    CAPTURE(i);
    CHECK(std::fabs(run.rest[i] - std::acos(7.5 / 24.0)) < 0.018 * kDegree);
  }
  // The last one lies flat, and the one before it on its upper edge: tan(theta) = p / d.
  CHECK(run.rest[199] == doctest::Approx(90.0 * kDegree));
  CHECK(run.rest[198] == doctest::Approx(std::atan(24.0 / 7.5)));
  CHECK(count(run, EventKind::struck) == 199);
  CHECK(count(run, EventKind::arrived) == 200);
  CHECK(count(run, EventKind::landed) == 200);
  CHECK(count(run, EventKind::rested) == 200);
}

TEST_CASE("the_speed_does_not_depend_on_the_step_and_hardly_on_the_rest_tolerance") {
  const Layout layout = make_row({.count = 120, .gap = 0.0165});
  const HingeRun run = run_hinge(layout);
  for (const double step : {0.0005, 0.001, 0.002, 0.008, 0.03}) {
    const HingeRun other = run_hinge(layout, {.time_step = step});
    CAPTURE(step);
    // Events are located inside the step and no leg ends at a step, so only rounding differs.
    for (std::size_t i = 1; i < 120; ++i) CHECK(std::fabs(other.struck[i] - run.struck[i]) < 1e-12);
  }
  // A brick at rest still presses on with its weight, so the wave errs by the second order of what the brick may still move.
  double last = 1.0;
  const HingeRun exact = run_hinge(layout, {.rest_tolerance = 1e-8});
  const double speed = exact.struck[110] - exact.struck[60];
  for (const double tolerance : {0.1, 0.01, 0.002}) {
    const HingeRun other = run_hinge(layout, {.rest_tolerance = tolerance});
    const double error = std::fabs((other.struck[110] - other.struck[60]) / speed - 1.0);
    MESSAGE("rest tolerance " << tolerance << ": at most " << other.most_moving << " bricks move, speed off by " << error);
    CHECK(error < last);
    CHECK(error < 0.01 * tolerance);
    last = error;
  }
}

TEST_CASE("energy_never_rises_by_more_than_the_bound_on_resting_bricks") {
  // The weight of a resting brick goes on pushing through the way that it no longer makes, tolerance x thickness at its corner, half of
  // that at its centre of mass; those behind it add a geometric series. So the sum may seem to rise by about tolerance x m g d, here a
  // thousandth of what one falling brick releases.
  for (const RowPlan& plan : {RowPlan{.count = 60, .gap = 0.0165}, RowPlan{.count = 60, .gap = 0.0075, .friction = 0.0, .jitter = 0.5},
                              RowPlan{.count = 60, .gap = 0.03, .friction = 0.5, .jitter = 0.1},
                              RowPlan{.count = 25, .gap = 0.012, .growth = 1.1}, RowPlan{.count = 40, .gap = 0.0075, .push = 3.7}}) {
    const Layout layout = make_row(plan);
    const HingeRun run = run_hinge(layout, {.time_step = 0.0005});
    CAPTURE(plan.gap);
    const BrickKind& largest = layout.kinds.back();
    CHECK(run.most_rise < 0.002 * largest.mass * layout.gravity * largest.thickness);
    CHECK(run.released > 0.0);
  }
}

TEST_CASE("a_row_of_growing_dominoes_falls_to_its_last_brick") {
  // Thirteen bricks, each 1.5 times the one before, the first 5 mm high: the last is 649 mm. [vanLeeuwen2013] finds that bricks of a tenth
  // of their height in thickness can grow by up to about twice.
  const RowPlan plan{.count = 13, .height = 0.005, .thickness = 0.0005, .gap = 0.0025, .friction = 0.1, .growth = 1.5, .push = 60.0};
  const Layout layout = make_row(plan);
  const HingeRun run = run_hinge(layout);
  CHECK(count_fallen(layout, run) == 13);
  CHECK(run.rest[12] == doctest::Approx(90.0 * kDegree));
}

TEST_CASE("growing_dominoes_stop_at_a_factor_that_friction_lowers") {
  double last = 10.0;
  for (const double friction : {0.0, 0.2, 0.4}) {
    double go = 1.0;
    double stop = 4.0;
    while (stop - go > 0.01) {
      const double factor = 0.5 * (go + stop);
      const Layout layout =
          make_row({.count = 10, .height = 0.005, .thickness = 0.0008, .gap = 0.002, .friction = friction, .growth = factor, .push = 20.0});
      (count_fallen(layout, run_hinge(layout)) == 10 ? go : stop) = factor;
    }
    MESSAGE("friction " << friction << ": growing by " << go << " falls, by " << stop << " stops");
    CHECK(go < last);
    CHECK(go > 1.2);
    last = go;
  }
}

TEST_CASE("a_row_of_a_hundred_thousand_is_steady_to_its_end") {
  const HingeRun run = run_hinge(make_row({.count = 100000, .gap = 0.0165}));
  const double early = run.struck[1100] - run.struck[100];
  for (const std::size_t i : {std::size_t{10000}, std::size_t{50000}, std::size_t{99000}}) {
    // Times near 2000 s carry 4e-13 s of rounding each.
    CHECK(std::fabs((run.struck[i] - run.struck[i - 1000]) / early - 1.0) < 1e-10);
  }
  CHECK(count(run, EventKind::arrived) == 100000);
}

TEST_CASE("a_wave_that_falls_short_comes_back_and_every_brick_stands_or_leans") {
  // At 0.1 h one needs 5.337 rad/s; with 5.2 some bricks lift and fall back.
  const Layout layout = make_row({.count = 30, .gap = 0.0048, .friction = 0.0, .push = 5.2});
  const HingeRun run = run_hinge(layout);
  CHECK(run.progress == Progress::at_rest);
  CHECK(count(run, EventKind::struck) >= 1);
  CHECK(count(run, EventKind::struck) < 29);
  CHECK(count_fallen(layout, run) == 0);
  CHECK(run.rest[0] == 0.0);
}

TEST_CASE("friction_takes_energy_on_the_way_back_too") {
  // No brick goes to rest before it stands again, so nothing but rounding and the reading between two nodes may raise the sum;
  // friction that pulled the wrong way would.
  const HingeRun run = run_hinge(make_row({.count = 10, .gap = 0.0048, .friction = 0.4, .push = 5.2}), {.time_step = 0.0005});
  CHECK(count(run, EventKind::struck) >= 2);
  CHECK(run.rest[0] < 0.1);
  CHECK(run.most_rise < 1e-4 * run.released);
}

TEST_CASE("a_gap_beyond_reach_is_missed") {
  Layout layout = make_row({.count = 10, .gap = 0.0165});
  for (std::size_t i = 5; i < 10; ++i) layout.bricks[i].foot.x += 0.040;  // The gap after brick 4 is 56.5 mm, its height 48.
  const HingeRun run = run_hinge(layout);
  REQUIRE(count(run, EventKind::missed) == 1);
  const auto missed = std::find_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == EventKind::missed; });
  CHECK(missed->brick == 4);
  CHECK(run.rest[4] == doctest::Approx(90.0 * kDegree));
  CHECK(std::isnan(run.rest[5]));
  CHECK(count_fallen(layout, run) == 5);
}

TEST_CASE("friction_that_locks_stops_the_wave_and_not_the_run") {
  for (const double friction : {2.0, 3.0, 5.0, 20.0}) {
    CAPTURE(friction);
    const HingeRun run = run_hinge(make_row({.count = 30, .gap = 0.0144, .friction = friction, .push = 4.0}), {}, 60.0);
    CHECK(run.progress == Progress::at_rest);
  }
}

TEST_CASE("a_mirrored_shifted_and_turned_row_falls_alike") {
  const RowPlan plan{.count = 60, .gap = 0.0165, .jitter = 0.2};
  const HingeRun run = run_hinge(make_row(plan));
  Layout layout = make_row(plan);
  const double angle = 0.7;
  for (Brick& brick : layout.bricks) {
    const double x = -brick.foot.x;  // Mirrored: it runs towards -x.
    brick.foot.x = 1000.0 + x * std::cos(angle);
    brick.foot.y = -1000.0 + x * std::sin(angle);
    brick.heading = angle + 3.14159265358979323846;
  }
  const HingeRun other = run_hinge(layout);
  // At 1 km a coordinate is rounded to 1e-13 m, 1e-11 of a gap; the wave passes that on as it is.
  for (std::size_t i = 1; i < 60; ++i) CHECK(std::fabs(other.struck[i] / run.struck[i] - 1.0) < 1e-9);
}

TEST_CASE("a_row_of_any_scale_takes_the_froude_scaled_time") {
  const HingeRun run = run_hinge(make_row({.count = 60, .gap = 0.0165}));
  // A hundred times as large: ten times as long, the push a tenth.
  const HingeRun large = run_hinge(make_row({.count = 60, .height = 4.8, .thickness = 0.75, .gap = 1.65, .push = 0.8}));
  for (std::size_t i = 1; i < 60; ++i) CHECK(std::fabs(large.struck[i] / run.struck[i] - 10.0) < 1e-8);
}

TEST_CASE("the_hash_changes_with_one_friction_in_the_twelfth_digit_and_with_nothing_else") {
  const RowPlan plan{.count = 40, .gap = 0.0165};
  const std::uint64_t hash = run_hinge(make_row(plan)).hash;
  CHECK(hash == run_hinge(make_row(plan)).hash);
  Layout layout = make_row(plan);
  BrickKind kind = layout.kinds[0];
  kind.surface.brick_friction += 1e-12;
  layout.kinds.push_back(kind);
  layout.bricks[20].kind = 1;
  CHECK(hash != run_hinge(layout).hash);
}

TEST_CASE("a_force_an_impulse_and_a_speed_that_give_the_same_momentum_start_the_same_wave") {
  Layout layout = make_row({.count = 30, .gap = 0.0165, .push = 4.0});
  const double speed_time = run_hinge(layout).struck[29];
  // J y = I w, I = m (h^2 + d^2) / 3; y is the height of the push.
  const BrickKind& kind = layout.kinds[0];
  const double inertia = kind.mass * (kind.height * kind.height + kind.thickness * kind.thickness) / 3.0;
  const double impulse = inertia * 4.0 / 0.04;
  layout.pushes[0].how = ImpulsePush{impulse, 0.04};
  CHECK(run_hinge(layout).struck[29] == doctest::Approx(speed_time).epsilon(1e-12));
  // A force for a very short time is nearly that: it lifts the brick by 4 rad/s x 10 us / 2 meanwhile.
  layout.pushes[0].how = ForcePush{impulse / 1e-5, 0.04, 1e-5};
  CHECK(run_hinge(layout).struck[29] == doctest::Approx(speed_time).epsilon(1e-3));
}

TEST_CASE("a_force_too_weak_to_lift_the_brick_moves_nothing") {
  // It lifts if F y > m g d / 2.
  Layout layout = make_row({.count = 3});
  const BrickKind& kind = layout.kinds[0];
  layout.pushes[0].how = ForcePush{0.99 * kind.mass * 9.81 * 0.5 * kind.thickness / 0.04, 0.04, 0.5};
  const HingeRun run = run_hinge(layout);
  CHECK(run.progress == Progress::at_rest);
  CHECK(std::isnan(run.rest[0]));
  CHECK(count(run, EventKind::pushed) == 1);
  layout.pushes[0].how = ForcePush{1.3 * kind.mass * 9.81 * 0.5 * kind.thickness / 0.04, 0.04, 0.5};
  CHECK(count_fallen(layout, run_hinge(layout)) == 3);
}

TEST_CASE("a_closed_circle_ends_where_it_began") {
  Layout layout = make_row({.count = 1});
  const int n = 150;
  const double radius = 0.024 * n / (2.0 * 3.14159265358979323846);
  layout.bricks.clear();
  for (int i = 0; i < n; ++i) {
    const double turn = 2.0 * 3.14159265358979323846 * i / n;
    Brick brick;
    brick.foot = {radius * std::sin(turn), radius * (1.0 - std::cos(turn)), 0.0};
    brick.heading = turn;
    layout.bricks.push_back(brick);
  }
  layout.parts[0].count = n;
  const HingeRun run = run_hinge(layout);
  CHECK(count_fallen(layout, run) == n);
  CHECK(count(run, EventKind::missed) == 0);
  // The last one leans on the first as all lean.
  CHECK(std::fabs(run.rest[n - 1] - run.rest[50]) < 0.05 * kDegree);
}

TEST_CASE("hundreds_of_rows_fall_side_by_side_each_as_if_alone") {
  const RowPlan plan{.count = 40, .gap = 0.0165};
  const HingeRun alone = run_hinge(make_row(plan));
  Layout field = make_row(plan);
  for (int row = 1; row < 100; ++row) {
    Layout next = make_row(plan);
    for (Brick& brick : next.bricks) {
      brick.foot.y = 0.03 * row;
      field.bricks.push_back(brick);
    }
    field.parts.push_back({"row", 40 * row, 40});
    field.pushes.push_back({40 * row, 0.01 * row, AngularSpeedPush{8.0}});
  }
  const HingeRun run = run_hinge(field);
  for (const int row : {1, 50, 99}) {
    for (std::size_t i = 1; i < 40; ++i) {
      CHECK(run.struck[40 * static_cast<std::size_t>(row) + i] == doctest::Approx(alone.struck[i] + 0.01 * row).epsilon(1e-9));
    }
  }
}

TEST_CASE("what_a_chain_of_hinges_cannot_do_is_refused_in_words_that_name_rigid") {
  const auto refused = [](const Layout& layout, const char* reason) {
    const std::string words = refusal(layout);
    CAPTURE(words);
    CHECK(words.find(reason) != std::string::npos);
    CHECK(words.find("rigid") != std::string::npos);
  };
  const Layout row = make_row({.count = 5, .gap = 0.0165});
  CHECK(refusal(row).empty());
  Layout layout = row;
  layout.bricks[2].heading = 6.0 * kDegree;
  refused(layout, "brick 2 ahead of brick 1 is turned by 6 deg");
  layout = row;
  layout.bricks[2].foot.y = 0.007;
  refused(layout, "to one side");
  layout = row;
  layout.bricks[2].stance = Stance::flat;
  refused(layout, "brick 2 does not stand");
  layout = row;
  layout.bricks[2].foot.z = 0.01;
  refused(layout, "brick 2 stands 10 mm above the floor");
  layout = row;
  layout.pushes.push_back({3, 0.0, AngularSpeedPush{4.0}});
  refused(layout, "bricks 0 and 3 run in one row");
  layout = row;
  layout.pushes[0].how = AngularSpeedPush{-1.0};
  refused(layout, "backwards");
  refused(make_row({.count = 5, .gap = 0.042}), "slips under it");
  layout = row;
  layout.kinds.push_back(layout.kinds[0]);
  layout.kinds[1].height = 0.03;
  layout.bricks[3].kind = 1;
  refused(layout, "hit above its top");
  // A split: a brick with two bricks half before it.
  layout = row;
  layout.bricks[4].foot = layout.bricks[3].foot;
  layout.bricks[3].foot.y = 0.006;
  layout.bricks[4].foot.y = -0.019;
  refused(layout, "splits, merges or crossings");
  // A merge: brick 4 stands beside brick 0, and both reach brick 1.
  layout = row;
  layout.bricks[4].foot = {layout.bricks[0].foot.x, 0.025, 0.0};
  layout.bricks[1].foot.y = 0.004;
  layout.bricks[4].foot.y = 0.0265;
  refused(layout, "brick 1 ahead of brick 4 stands");
}

TEST_CASE("a_run_in_which_all_fall_ends_at_rest_and_one_that_falls_short_says_where") {
  auto all = simulate(make_row({.count = 20, .gap = 0.0165}), HingeConfig{});
  REQUIRE(all.has_value());
  CHECK(all->end().reason == EndReason::at_rest);
  auto none = simulate(make_row({.count = 20, .gap = 0.0165, .push = 1.0}), HingeConfig{});
  REQUIRE(none.has_value());
  CHECK(none->end().reason == EndReason::wave_died);
  CHECK(none->end().brick == 0);
}

TEST_CASE("a_thin_brick_pushed_too_softly_returns_however_little_too_softly") {
  // The least push of a brick of 48 x 4.8 mm is 1.740035 rad/s. It stops and turns round within a few degrees, far inside one leg.
  for (const double push : {0.5, 1.0, 1.5, 1.6, 1.65, 1.7, 1.735, 1.745, 1.8}) {
    CAPTURE(push);
    const Layout layout = make_row({.count = 1, .thickness = 0.0048, .push = push});
    CHECK(count_fallen(layout, run_hinge(layout)) == (push > 1.740035 ? 1 : 0));
  }
}

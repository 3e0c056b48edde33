// What hinge tells of the way of its bricks, and what it does not compute again in an even row.
#include <algorithm>
#include <cmath>

#include "doctest/doctest.h"
#include "hinge_row.h"
#include "topple/run.h"

using namespace topple;

namespace {

Recording recorded(const Layout& layout, const HingeConfig& config, double until = 1e9) {
  auto recording = simulate(layout, config, {.until = until});
  REQUIRE(recording.has_value());
  return *std::move(recording);
}

// Largest way between a corner as the recording has it and as the model has it, at every step of another run with short steps, as a
// fraction of the thickness.
double worst_corner(const Layout& layout, const HingeConfig& config, double until = 1e9) {
  const Recording recording = recorded(layout, config, until);
  HingeConfig fine = config;
  fine.time_step = 0.0011;
  auto model = hinge::make_hinge_model(layout, fine);
  REQUIRE(model.has_value());
  Frame frame;
  double worst = 0.0;
  Progress progress = Progress::running;
  while (progress == Progress::running && frame.time < recording.duration() - 2.0 * fine.time_step) {
    progress = (*model)->step().progress;
    (*model)->read(frame);
    for (const HingedMotion& motion : frame.hinged) {
      if (motion.phase != Phase::falling) continue;
      const BrickKind& kind = layout.kind_of(motion.brick);
      const double angle = recording.at(motion.brick, frame.time).hinge.angle;
      const double corner = std::sqrt(kind.height * kind.height + kind.thickness * kind.thickness);
      worst = std::max(worst, std::fabs(angle - motion.state.angle) * corner / kind.thickness);
    }
  }
  return worst;
}

void check_same(const Recording& a, const Recording& b) {
  CHECK(a.end().hash == b.end().hash);
  REQUIRE(a.event_count() == b.event_count());
  for (std::int64_t i = 0; i < a.event_count(); ++i) {
    const Event one = a.event(i);
    const Event other = b.event(i);
    const bool same = one.time == other.time && one.kind == other.kind && one.brick == other.brick && one.by == other.by &&
                      (one.impulse == other.impulse || one.impulse != one.impulse);
    CHECK_MESSAGE(same, i);
  }
  std::vector<Track> first, second;
  for (BrickId brick = 0; brick < a.layout().brick_count(); ++brick) {
    a.tracks_of(brick, first);
    b.tracks_of(brick, second);
    REQUIRE(first.size() == second.size());
    for (std::size_t t = 0; t < first.size(); ++t) {
      CHECK(std::fabs(first[t].start - second[t].start) < 1e-11);
      REQUIRE(first[t].hinged.size() == second[t].hinged.size());
      for (std::size_t k = 0; k < first[t].hinged.size(); ++k) {
        // A time within a track is a multiple of 2.4e-7 s, and the sum behind it may round to either side.
        CHECK(std::fabs(double{first[t].hinged[k].time} - double{second[t].hinged[k].time}) < 3e-7);
        CHECK(first[t].hinged[k].angle == second[t].hinged[k].angle);
        CHECK(first[t].hinged[k].rate == second[t].hinged[k].rate);
        CHECK(first[t].hinged[k].acceleration == second[t].hinged[k].acceleration);
      }
    }
  }
}

}  // namespace

TEST_CASE("a_recording_of_any_row_has_every_corner_within_the_tolerance_at_any_time") {
  for (const RowPlan& plan :
       {RowPlan{.count = 90, .gap = 0.0165}, RowPlan{.count = 60, .gap = 0.0165, .jitter = 0.5}, RowPlan{.count = 40, .gap = 0.0024},
        RowPlan{.count = 30, .gap = 0.036, .friction = 0.5}, RowPlan{.count = 20, .gap = 0.012, .growth = 1.1},
        RowPlan{.count = 30, .gap = 0.0165, .friction = 2.0}, RowPlan{.count = 30, .gap = 0.0072, .friction = 0.0, .push = 3.7}}) {
    CAPTURE(plan.gap);
    CAPTURE(plan.friction);
    const double worst = worst_corner(make_row(plan), {});
    MESSAGE("gap " << plan.gap << ", friction " << plan.friction << ": " << worst);
    CHECK(worst <= 0.002);
  }
}

TEST_CASE("an_even_row_that_is_not_computed_again_has_the_bits_of_one_that_is") {
  for (const double gap : {0.0048, 0.0165, 0.03}) {
    CAPTURE(gap);
    const Layout layout = make_row({.count = 260, .gap = gap});
    check_same(recorded(layout, {}), recorded(layout, {.repeats = false}));
  }
}

TEST_CASE("an_even_row_goes_over_into_another_as_if_all_had_been_computed") {
  // 150 bricks, a longer gap, 150 more, the last of them of another kind.
  Layout layout = make_row({.count = 300, .gap = 0.0165});
  for (std::size_t i = 150; i < layout.bricks.size(); ++i) layout.bricks[i].foot.x += 0.004;
  layout.kinds.push_back(layout.kinds[0]);
  layout.kinds[1].mass *= 2.0;
  layout.bricks.back().kind = 1;
  check_same(recorded(layout, {}), recorded(layout, {.repeats = false}));
}

TEST_CASE("a_run_stopped_amid_an_even_row_keeps_what_moves") {
  const Layout layout = make_row({.count = 300, .gap = 0.0165});
  const Recording stopped = recorded(layout, {}, 4.0);
  check_same(stopped, recorded(layout, {.repeats = false}, 4.0));
  CHECK(stopped.at(150, 4.0).phase == Phase::falling);
  CHECK(worst_corner(layout, {}, 4.0) <= 0.002);
}

TEST_CASE("a_push_amid_an_even_row_is_felt_as_if_all_had_been_computed") {
  Layout layout = make_row({.count = 300, .gap = 0.0165});
  layout.pushes.push_back({0, 4.0, AngularSpeedPush{1.0}});
  check_same(recorded(layout, {}), recorded(layout, {.repeats = false}));
}

TEST_CASE("the_motion_of_an_even_row_is_kept_once") {
  const Layout layout = make_row({.count = 3000, .gap = 0.0165});
  // A track takes 100 to 300 bytes.
  CHECK(recorded(layout, {.repeats = false}).memory() > recorded(layout, {}).memory() + std::size_t{100} * 2900);
}

// The fast way of a train's front, one collocation step in angle, against the plain one, Runge and Kutta's in time.
#include <cmath>

#include "base/trigonometry.h"
#include "doctest/doctest.h"
#include "model/hinge/leg.h"

using namespace topple;
using namespace topple::hinge;

namespace {

// Bricks of 48 x 7.5 mm, 16.5 mm apart, friction 0.2, the front upright.
Train make_train(int bricks) {
  Train train;
  for (int i = 0; i < bricks; ++i) {
    TrainBrick brick;
    brick.id = i;
    brick.height = 0.048;
    brick.thickness = 0.0075;
    brick.inertia = 0.0085 * (0.048 * 0.048 + 0.0075 * 0.0075) / 3.0;
    brick.torque_sin = 0.5 * 0.0085 * 9.81 * 0.048;
    brick.torque_cos = -0.5 * 0.0085 * 9.81 * 0.0075;
    brick.pitch = 0.024 / 0.048;
    brick.thickness_ahead = 0.0075 / 0.048;
    brick.friction = 0.2;
    train.add_front(brick);
  }
  return train;
}

FrontState run_slowly(const Train& train, double rate, LegGoal goal) {
  FrontState state{.rate = rate};
  for (int i = 0; i < 100000; ++i) {
    const Leg leg = make_slow_leg(train, state, goal);
    state = leg.end();
    if (leg.reached || state.rate == 0.0) break;
  }
  return state;
}

}  // namespace

TEST_CASE("one_step_in_angle_agrees_with_many_in_time") {
  for (const int bricks : {1, 2, 5, 20}) {
    Train train = make_train(bricks);
    for (const double rate : {5.0, 8.0, 20.0}) {
      CAPTURE(bricks);
      CAPTURE(rate);
      const LegGoal goal{.angle = arc_sine(16.5 / 48.0), .slow_step = 1e-4, .slack = 2e-4, .start = train.view(0.0, 1.0)};
      FrontState fast{.rate = rate};
      int legs = 0;
      for (bool reached = false; !reached; ++legs) {
        LegGoal rest = goal;
        rest.start = train.view(fast.angle, 1.0);
        const Leg leg = make_leg(train, fast, rest);
        reached = leg.reached;
        fast = leg.end();
      }
      const FrontState slow = run_slowly(train, rate, goal);
      CHECK(legs <= 8);
      // The eighth order of one step over the whole gap leaves 3e-7 of the time where the rate changes most.
      CHECK(std::fabs(fast.time / slow.time - 1.0) < 1e-6);
      CHECK(std::fabs(fast.rate / slow.rate - 1.0) < 1e-6);
    }
  }
}

TEST_CASE("the_plain_step_is_of_the_fourth_order_and_exact_to_1e_9_at_its_default") {
  const Train train = make_train(4);
  LegGoal goal{.angle = arc_sine(16.5 / 48.0), .slow_step = 1e-5};
  const double exact = run_slowly(train, 4.0, goal).time;
  goal.slow_step = 0.02 / 17.403662;  // A fiftieth of the time in which a tilt from balance grows e times: 1.15 ms.
  const double coarse = std::fabs(run_slowly(train, 4.0, goal).time - exact);
  goal.slow_step *= 0.5;
  const double fine = std::fabs(run_slowly(train, 4.0, goal).time - exact);
  CHECK(coarse < 1e-9);
  CHECK(std::log2(coarse / fine) > 3.7);
}

TEST_CASE("the_four_lanes_of_a_sweep_have_the_bits_of_the_plain_walk") {
  Train train = make_train(30);
  train.at(7).on_heel = true;
  const std::array<double, 4> angles = {0.01, 0.1, 0.2, 0.33};
  const Sweep sweep = train.sweep(angles, 1.0, 1e-4);
  for (std::size_t i = 0; i < 4; ++i) {
    const FrontView view = train.view(angles[i], 1.0);
    CHECK(sweep.views[i].inertia == view.inertia);
    CHECK(sweep.views[i].torque == view.torque);
    CHECK(sweep.views[i].coupling == view.coupling);
  }
}

TEST_CASE("a_new_front_sees_the_train_as_a_walk_through_it_does") {
  Train train = make_train(12);
  const double hit = arc_sine(16.5 / 48.0);
  const FrontView old = train.place(hit, 1.0);
  const TrainBrick standing = make_train(1).at(0);
  const FrontView view = train.strike(standing, old);
  const FrontView walked = train.view(0.0, 1.0);
  CHECK(view.inertia == doctest::Approx(walked.inertia).epsilon(1e-12));
  CHECK(view.torque == doctest::Approx(walked.torque).epsilon(1e-12));
  CHECK(view.coupling == doctest::Approx(walked.coupling).epsilon(1e-12));
}

TEST_CASE("where_a_lean_turns_over_its_edge_is_at_the_end_of_its_way") {
  Train train = make_train(6);
  for (std::size_t k = 1; k < 6; ++k) train.at(k).pitch *= 1.0 + 0.03 * static_cast<double>(k % 3);
  std::vector<double> edges(6);
  for (std::size_t k = 1; k < 6; ++k) {
    train.edges(train.turn_over_angle(k), edges);
    CHECK(std::fabs(edges[k]) < 1e-15);
  }
}

TEST_CASE("the_work_of_the_torques_is_their_integral_over_the_way") {
  // Simpson's rule over 400 parts; the torque on the front is that of all bricks through their ratios.
  const Train train = make_train(5);
  const double end = arc_sine(16.5 / 48.0);
  std::vector<TrainView> bricks;
  const auto torque = [&](double angle) {
    train.look(angle, 1.0, bricks);
    double sum = 0.0;
    for (std::size_t k = 0; k < 5; ++k) {
      const TrainBrick& brick = train.at(k);
      sum += bricks[k].ratio * (brick.torque_sin * bricks[k].sine + brick.torque_cos * bricks[k].cosine);
    }
    return sum;
  };
  double integral = 0.0;
  for (int i = 0; i <= 400; ++i) integral += (i % 400 == 0 ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * torque(end * i / 400.0) * end / 1200.0;
  CHECK(train.works(end).torques - train.works(0.0).torques == doctest::Approx(integral).epsilon(1e-9));
}

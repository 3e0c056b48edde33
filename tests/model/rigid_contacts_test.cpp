// The solver of all contacts of a moment, by itself: what it finds obeys the laws of contact, step by step and all at once.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "model/rigid/contact_solver.h"

namespace topple::rigid {
namespace {

constexpr double kTolerance = 1e-6;  // [m/s]

BrickKind domino() {
  BrickKind kind;
  kind.height = 0.048;
  kind.width = 0.024;
  kind.thickness = 0.0075;
  kind.mass = 0.008;
  return kind;
}

void add_row(std::vector<ContactRow>& rows, std::span<const Body> bodies, int a, int b, const Vec3& point, const Vec3& normal,
             double friction) {
  ContactRow row;
  row.a = a;
  row.b = b;
  row.touch = static_cast<int>(rows.size());
  row.normal = normal;
  row.arm_a = point - bodies[static_cast<std::size_t>(a)].position;
  const Body* other = b == kFloor ? nullptr : &bodies[static_cast<std::size_t>(b)];
  if (other != nullptr) row.arm_b = point - other->position;
  set_directions(row, bodies[static_cast<std::size_t>(a)]);
  set_couplings(row, bodies[static_cast<std::size_t>(a)], other, *lane_kernels(0));
  row.normal_stiffness = row.normal_mass / 1e-4;
  row.tangent_stiffness = row.mass / 1e-4;
  row.friction = friction;
  set_steps(row);
  rows.push_back(row);
}

struct Scene {
  std::vector<Body> bodies;
  std::vector<ContactRow> rows;
};

// Five dominoes that stand in a row, face to face where `side` is zero, each on four corners; the first is hit.
Scene five_dominoes(double side) {
  Scene scene;
  const BrickKind kind = domino();
  for (int i = 0; i < 5; ++i) {
    scene.bodies.push_back(make_body(kind, i, 0, {{0.0075 * i, 0.0, 0.024}, {}}));
    refresh(scene.bodies.back());
  }
  for (int i = 0; i < 5; ++i) {
    const double x = 0.0075 * i;
    for (const double along : {-0.00375, 0.00375}) {
      for (const double across : {-0.012, 0.012})
        add_row(scene.rows, scene.bodies, i, kFloor, {x + along, across, 0.0}, {0.0, 0.0, 1.0}, 0.5);
    }
    if (i == 4) continue;
    const double y = side * 0.002 * (i % 2 == 0 ? 1.0 : -1.0);
    add_row(scene.rows, scene.bodies, i, i + 1, {x + 0.00375, -0.012 + y, 0.048}, {-1.0, 0.0, 0.0}, 0.2);
    add_row(scene.rows, scene.bodies, i, i + 1, {x + 0.00375, 0.012 + y, 0.048}, {-1.0, 0.0, 0.0}, 0.2);
  }
  scene.bodies[0].velocity = {0.4, 0.05 * side, -0.04};
  scene.bodies[0].angular_velocity = {0.0, 12.0, 3.0 * side};
  return scene;
}

Vec3 slip_of(const Scene& scene, const ContactRow& row) {
  const Vec3 slip = velocity_at(scene.bodies[static_cast<std::size_t>(row.a)], row.arm_a);
  return row.b == kFloor ? slip : slip - velocity_at(scene.bodies[static_cast<std::size_t>(row.b)], row.arm_b);
}

double energy(const Scene& scene) {
  double sum = 0.0;
  for (const Body& body : scene.bodies) sum += kinetic_energy(body);
  return sum;
}

void solve(Scene& scene) {
  std::vector<Twist> guess;
  guess.reserve(scene.bodies.size());
  for (const Body& body : scene.bodies) guess.push_back({body.velocity, body.angular_velocity});
  ContactSolver solver(*lane_kernels(0));
  solver.solve(scene.bodies, scene.rows, guess, {kTolerance, 60, 0.02, false});
}

void sweep(Scene& scene, int most) {
  std::vector<Velocity> free;
  for (const Body& body : scene.bodies) {
    const Vec3 &v = body.velocity, &w = body.angular_velocity;
    free.push_back({v.x, v.y, v.z, w.x, w.y, w.z});
  }
  Sweeps sweeps(*lane_kernels(0));
  sweeps.begin(scene.rows, free);
  sweeps.run(scene.rows, most, kTolerance);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Velocity& v = sweeps.velocity[i];
    scene.bodies[i].velocity = {v[0], v[1], v[2]};
    scene.bodies[i].angular_velocity = {v[3], v[4], v[5]};
  }
}

void check_laws(const Scene& scene, double allowed) {
  for (const ContactRow& row : scene.rows) {
    const Vec3 slip = slip_of(scene, row);
    const double parting = dot(slip, row.normal);
    const Vec3 across = slip - parting * row.normal;
    CHECK(row.impulse[0] >= 0.0);
    CHECK(parting > -allowed);
    if (row.impulse[0] > 1e-5) CHECK(parting < allowed);
    const double limit = row.friction * row.impulse[0], rubs = norm(friction_of(row));
    CHECK(rubs <= limit * (1.0 + 1e-9) + 1e-9 + 1e-3 * limit);
    if (rubs < 0.99 * limit) CHECK(norm(across) < allowed);
    if (norm(across) > 10.0 * allowed && limit > 1e-6) CHECK(dot(friction_of(row), across) < -0.9 * rubs * norm(across));
  }
}

}  // namespace

TEST_CASE("rigid: a blow along five dominoes obeys Signorini's and Coulomb's laws") {
  for (const double side : {0.0, 1.0}) {
    Scene scene = five_dominoes(side);
    const double before = energy(scene);
    solve(scene);
    check_laws(scene, 1e-3);
    CHECK(energy(scene) < before);
    CHECK(scene.bodies[4].velocity.x > 0.01);
  }
}

TEST_CASE("rigid: sweeps alone come near what Newton's method finds, and make no energy") {
  for (const double side : {0.0, 1.0}) {
    Scene exact = five_dominoes(side), swept = five_dominoes(side);
    const double before = energy(swept);
    solve(exact);
    sweep(swept, 12);
    CHECK(energy(swept) < before);
    for (std::size_t i = 0; i < exact.bodies.size(); ++i) {
      CHECK(norm(swept.bodies[i].velocity - exact.bodies[i].velocity) < 0.02);
      CHECK(0.024 * norm(swept.bodies[i].angular_velocity - exact.bodies[i].angular_velocity) < 0.02);
    }
  }
}

TEST_CASE("rigid: the mirror image of a blow has the mirror image of its solution, after a few sweeps and in the end") {
  for (const bool few_sweeps : {true, false}) {
    Scene one = five_dominoes(1.0), other = five_dominoes(-1.0);
    for (Scene* scene : {&one, &other}) {
      if (few_sweeps)
        sweep(*scene, 4);
      else
        solve(*scene);
    }
    for (std::size_t i = 0; i < one.bodies.size(); ++i) {
      const Vec3 v = one.bodies[i].velocity, w = other.bodies[i].velocity;
      CHECK(norm(v - Vec3{w.x, -w.y, w.z}) < 1e-6);
    }
  }
}

}  // namespace topple::rigid

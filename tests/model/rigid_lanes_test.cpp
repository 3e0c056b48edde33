// The contact solver's kernels for each number of lanes that this processor has, against plain loops over doubles: bit for bit, in odd
// sizes.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include "model/lanes.h"
#include "topple/run.h"

namespace topple::rigid {
namespace {

using Six = std::array<double, 6>;

// Rows between any two of `bodies` bodies; every third one is between a body and the floor.
std::vector<ContactRow> some_rows(std::size_t count, int bodies, Numbers& numbers) {
  std::vector<ContactRow> rows(count);
  for (std::size_t i = 0; i < count; ++i) {
    ContactRow& row = rows[i];
    row.a = static_cast<int>(i) % bodies;
    row.b = i % 3 == 0 || bodies == 1 ? kFloor : (row.a + 1) % bodies;
    row.friction = 0.3;
    row.bias = {numbers.next(), numbers.next(), numbers.next()};
    row.impulse = {std::abs(numbers.next()), 0.1 * numbers.next(), 0.1 * numbers.next()};
    row.normal = numbers.vector();
    row.along = numbers.vector();
    row.across = numbers.vector();
    row.arm_a = numbers.vector();
    row.arm_b = numbers.vector();
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 12; ++c) {
        row.of[k][c] = numbers.next();
        row.gain[k][c] = numbers.next();
      }
    }
    row.k_nn = 2.0;
    row.k_aa = 1.9;
    row.k_cc = 1.8;
    row.k_na = 0.1 * numbers.next();
    row.k_nc = 0.1 * numbers.next();
    row.k_ac = 0.1 * numbers.next();
    row.normal_stiffness = 1e4;
    row.tangent_stiffness = 1e3;
    set_steps(row);
  }
  return rows;
}

std::vector<Velocity> some_velocities(std::size_t count, Numbers& numbers) {
  std::vector<Velocity> all(count);
  for (Velocity& v : all) {
    for (double& x : v) x = numbers.next();
  }
  return all;
}

// The order of the sum is part of the answer: even numbers of both bricks, then odd ones.
double plain_rate(const ContactRow& row, std::size_t direction, const double* a, const double* b) {
  double sum[2];
  for (std::size_t odd = 0; odd < 2; ++odd) {
    const auto of = [&](std::size_t brick, const double* v) {
      double part = row.of[direction][beside(brick, odd)] * v[odd];
      for (std::size_t k = 2 + odd; k < 6; k += 2) part += row.of[direction][beside(brick, k)] * v[k];
      return part;
    };
    sum[odd] = b == nullptr ? of(0, a) : of(0, a) + of(1, b);
  }
  return sum[0] + sum[1];
}

void plain_push(const ContactRow& row, std::size_t brick, const Framed& impulse, double* v) {
  for (std::size_t k = 0; k < 6; ++k) {
    const std::size_t at = beside(brick, k);
    v[k] += impulse[0] * row.gain[0][at] + impulse[1] * row.gain[1][at] + impulse[2] * row.gain[2][at];
  }
}

void plain_apply(const ContactRow& row, const Framed& impulse, std::vector<Velocity>& velocity) {
  plain_push(row, 0, impulse, velocity[static_cast<std::size_t>(row.a)].data());
  if (row.b != kFloor) plain_push(row, 1, impulse, velocity[static_cast<std::size_t>(row.b)].data());
}

// One point of a sweep, as Sweeps says.
double plain_solve(ContactRow& row, std::vector<Velocity>& velocity) {
  const double* a = velocity[static_cast<std::size_t>(row.a)].data();
  const double* b = row.b == kFloor ? nullptr : velocity[static_cast<std::size_t>(row.b)].data();
  Framed slip{};
  for (std::size_t k = 0; k < 3; ++k) slip[k] = row.bias[k] + plain_rate(row, k, a, b);
  const auto [old_n, old_s, old_t] = row.impulse;
  const double n = std::max(old_n - row.step_normal * (slip[0] + row.give_normal * old_n), 0.0), dn = n - old_n;
  const double vs = slip[1] + row.k_na * dn + row.give * old_s, vt = slip[2] + row.k_nc * dn + row.give * old_t;
  const double limit = row.friction * (row.base + n);
  double s = old_s - (row.step_aa * vs - row.step_ac * vt), t = old_t - (row.step_cc * vt - row.step_ac * vs);
  if (s * s + t * t > limit * limit) {
    s = old_s - row.step_sliding * vs;
    t = old_t - row.step_sliding * vt;
    const double size = std::sqrt(s * s + t * t);
    if (size > limit) {
      s *= limit / size;
      t *= limit / size;
    }
  }
  row.impulse = {n, s, t};
  plain_apply(row, {dn, s - old_s, t - old_t}, velocity);
  return std::max({row.k_nn * std::abs(dn), row.k_aa * std::abs(s - old_s), row.k_cc * std::abs(t - old_t)});
}

struct Swept {
  std::vector<ContactRow> rows;
  std::vector<Velocity> velocity;
  std::vector<double> changes;
};

bool same(const Swept& a, const Swept& b) {
  bool all = same_bits(a.changes.data(), b.changes.data(), a.changes.size());
  for (std::size_t i = 0; i < a.rows.size(); ++i) all = all && same_bits(a.rows[i].impulse.data(), b.rows[i].impulse.data(), 3);
  for (std::size_t i = 0; i < a.velocity.size(); ++i) all = all && same_bits(a.velocity[i].data(), b.velocity[i].data(), 6);
  return all;
}

using Plain6 = std::array<Six, 6>;

Plain6 plain_of(const BrickBlock& block) {
  Plain6 out{};
  for (std::size_t r = 0; r < 6; ++r) {
    for (std::size_t c = 0; c < 6; ++c) out[r][c] = c < 4 ? block.low[r][c] : block.high[r][c - 4];
  }
  return out;
}

bool same(const BrickBlock& block, const Plain6& plain) {
  const Plain6 own = plain_of(block);
  bool all = true;
  for (std::size_t r = 0; r < 6; ++r) all = all && same_bits(own[r].data(), plain[r].data(), 6);
  return all;
}

BrickBlock some_block(double diagonal, Numbers& numbers) {
  BrickBlock block;
  for (std::size_t r = 0; r < 6; ++r) {
    for (std::size_t c = 0; c < 6; ++c) block.at(r, c) = numbers.next() + (r == c ? diagonal : 0.0);
  }
  return block;
}

Six joined(const Vec3& a, const Vec3& b) { return {a.x, a.y, a.z, b.x, b.y, b.z}; }

// Adds `sign` times the rows of a brick whose point lies at `arm`, from those of the point.
void plain_put(Plain6& block, const std::array<Six, 3>& rows, const Vec3& arm, double sign) {
  for (std::size_t c = 0; c < 6; ++c) {
    const Vec3 column{rows[0][c], rows[1][c], rows[2][c]};
    const Six all = joined(column, cross(arm, column));
    for (std::size_t r = 0; r < 6; ++r) block[r][c] += sign * all[r];
  }
}

}  // namespace

TEST_CASE("rigid: slips and pushes have the same bits in any number of lanes") {
  for (const LaneKernels* kernels : all_lanes()) {
    for (const std::size_t count : std::initializer_list<std::size_t>{1, 2, 3, 5, 7, 11}) {
      Numbers numbers;
      const int bodies = 1 + static_cast<int>(count) / 2;
      const std::vector<ContactRow> rows = some_rows(count, bodies, numbers);
      std::vector<Velocity> velocity = some_velocities(static_cast<std::size_t>(bodies), numbers);
      std::vector<PointEnds> ends;
      for (const ContactRow& row : rows) ends.push_back({row.a, row.b});
      if (count > 3) ends[1].a = -1;  // Does not move.
      std::vector<Framed> slips(count);
      kernels->slips(rows.data(), ends.data(), count, velocity.front().data(), slips.front().data());
      const Six still{};
      for (std::size_t i = 0; i < count; ++i) {
        const double* a = ends[i].a < 0 ? still.data() : velocity[static_cast<std::size_t>(ends[i].a)].data();
        const double* b = ends[i].b < 0 ? nullptr : velocity[static_cast<std::size_t>(ends[i].b)].data();
        Framed plain{};
        for (std::size_t k = 0; k < 3; ++k) plain[k] = rows[i].bias[k] + plain_rate(rows[i], k, a, b);
        CHECK_MESSAGE(same_bits(slips[i].data(), plain.data(), 3), kernels->lanes, " lanes, row ", i, " of ", count);
      }
      std::vector<Velocity> plain = velocity;
      kernels->apply_all(rows.data(), count, velocity.front().data());
      for (const ContactRow& row : rows) plain_apply(row, row.impulse, plain);
      for (std::size_t i = 0; i < plain.size(); ++i)
        CHECK_MESSAGE(same_bits(velocity[i].data(), plain[i].data(), 6), kernels->lanes, " lanes");
    }
  }
}

TEST_CASE("rigid: sweeps have the same bits in any number of lanes") {
  for (const std::size_t count : std::initializer_list<std::size_t>{1, 2, 3, 5, 9}) {
    Numbers numbers;
    const int bodies = 1 + static_cast<int>(count) / 2;
    const Swept start{some_rows(count, bodies, numbers), some_velocities(static_cast<std::size_t>(bodies), numbers), {}};
    std::vector<int> order;
    for (std::size_t i = 0; i < count; ++i) order.push_back(static_cast<int>((i + 1) % count));
    Swept plain = start;
    for (int i = 0; i < 6; ++i) {
      double change = 0.0;
      for (std::size_t k = 0; k < count; ++k) {
        ContactRow& row = plain.rows[static_cast<std::size_t>(order[i % 2 == 1 ? count - 1 - k : k])];
        change = std::max(change, plain_solve(row, plain.velocity));
      }
      plain.changes.push_back(change);
    }
    std::vector<Swept> coned;
    for (const LaneKernels* kernels : all_lanes()) {
      Swept swept = start;
      std::vector<int> own_order = order;
      double* velocity = swept.velocity.front().data();
      for (int i = 0; i < 6; ++i) swept.changes.push_back(kernels->sweep(swept.rows.data(), order.data(), count, i % 2 == 1, velocity));
      CHECK_MESSAGE(same(swept, plain), kernels->lanes, " lanes, ", count, " rows");
      // The first sweep, which finds an order, and the sweeps of the other law of friction.
      swept.changes = {kernels->first_sweep(swept.rows.data(), own_order.data(), count, velocity),
                       kernels->sweep_cones(swept.rows.data(), count, false, velocity),
                       kernels->sweep_cones(swept.rows.data(), count, true, velocity)};
      coned.push_back(swept);
      CHECK_MESSAGE(same(swept, coned.front()), kernels->lanes, " lanes, ", count, " rows");
    }
  }
}

TEST_CASE("rigid: what couples a point to its bricks has the same bits in any number of lanes") {
  for (const LaneKernels* kernels : all_lanes()) {
    Numbers numbers;
    for (ContactRow& row : some_rows(7, 3, numbers)) {
      std::array<Body, 2> body;
      for (Body& one : body) {
        one.inverse_mass = 1.0 + std::abs(numbers.next());
        one.inverse_inertia = {numbers.vector(), numbers.vector(), numbers.vector()};
      }
      const bool pair = row.b != kFloor;
      kernels->couple(row, body[0], pair ? &body[1] : nullptr);
      std::array<std::array<std::array<Six, 3>, 2>, 2> plain{};  // Of either brick: of, then gain.
      for (std::size_t i = 0; i < (pair ? 2U : 1U); ++i) {
        const Vec3& arm = i == 0 ? row.arm_a : row.arm_b;
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3 push = (i == 0 ? 1.0 : -1.0) * (k == 0 ? row.normal : k == 1 ? row.along : row.across);
          const Vec3 twist = cross(arm, push);
          plain[i][0][k] = joined(push, twist);
          plain[i][1][k] = joined(body[i].inverse_mass * push, body[i].inverse_inertia * twist);
          for (std::size_t c = 0; c < 6; ++c) {
            CHECK(same_bits(&row.of[k][beside(i, c)], &plain[i][0][k][c], 1));
            CHECK(same_bits(&row.gain[k][beside(i, c)], &plain[i][1][k][c], 1));
          }
        }
      }
      const auto response = [&](std::size_t to, std::size_t from) {
        double sum = 0.0;
        for (std::size_t i = 0; i < (pair ? 2U : 1U); ++i) {
          const Six &of = plain[i][0][to], &gain = plain[i][1][from];
          const double own = (of[0] * gain[0] + of[2] * gain[2] + of[4] * gain[4]) + (of[1] * gain[1] + of[3] * gain[3] + of[5] * gain[5]);
          sum = i == 0 ? own : sum + own;
        }
        return sum;
      };
      const std::array<double, 6> own{row.k_nn, row.k_na, row.k_nc, row.k_aa, row.k_ac, row.k_cc};
      const std::array<double, 6> should{response(0, 0), response(1, 0), response(2, 0), response(1, 1), response(2, 1), response(2, 2)};
      CHECK_MESSAGE(same_bits(own.data(), should.data(), 6), kernels->lanes, " lanes");
    }
  }
}

TEST_CASE("rigid: what a point adds to the equations has the same bits in any number of lanes") {
  for (const LaneKernels* kernels : all_lanes()) {
    Numbers numbers;
    for (const ContactRow& row : some_rows(7, 3, numbers)) {
      PointLaw law{numbers.next(), numbers.next(), numbers.next(), numbers.next(),
                   numbers.next(), numbers.next(), numbers.next(), numbers.next()};
      std::array<BrickBlock, 4> blocks{some_block(0.0, numbers), some_block(0.0, numbers), some_block(0.0, numbers),
                                       some_block(0.0, numbers)};
      std::array<Plain6, 4> plain{plain_of(blocks[0]), plain_of(blocks[1]), plain_of(blocks[2]), plain_of(blocks[3])};
      std::vector<Velocity> right = some_velocities(2, numbers), plain_right = right;
      const bool pair = row.b != kFloor;
      PointEquations to{.own_a = blocks.data(), .right_a = right[0].data()};
      if (pair) to = {blocks.data(), &blocks[1], &blocks[2], &blocks[3], right[0].data(), right[1].data()};
      kernels->add_law(row, law, to);

      const Vec3 &n = row.normal, &s = row.along, &t = row.across;
      const Vec3 by_n = law.nn * n + law.an * s + law.cn * t, by_s = law.aa * s + law.ac * t, by_t = law.ac * s + law.cc * t;
      const std::array<Vec3, 3> stiffness{by_n.x * n + by_s.x * s + by_t.x * t, by_n.y * n + by_s.y * s + by_t.y * t,
                                          by_n.z * n + by_s.z * s + by_t.z * t};
      const Vec3 rest = row.bias[0] * by_n + row.bias[1] * by_s + row.bias[2] * by_t + law.rest_along * s + law.rest_across * t;
      std::array<Six, 3> of_a{}, of_b{};
      for (std::size_t i = 0; i < 3; ++i) {
        of_a[i] = joined(stiffness[i], cross(row.arm_a, stiffness[i]));
        of_b[i] = joined(stiffness[i], cross(row.arm_b, stiffness[i]));
      }
      plain_put(plain[0], of_a, row.arm_a, 1.0);
      const Six push_a = joined(-rest, cross(row.arm_a, -rest)), push_b = joined(rest, cross(row.arm_b, rest));
      for (std::size_t k = 0; k < 6; ++k) plain_right[0][k] += push_a[k];
      if (pair) {
        plain_put(plain[1], of_b, row.arm_b, 1.0);
        plain_put(plain[2], of_b, row.arm_a, -1.0);
        plain_put(plain[3], of_a, row.arm_b, -1.0);
        for (std::size_t k = 0; k < 6; ++k) plain_right[1][k] += push_b[k];
      }
      for (std::size_t i = 0; i < 4; ++i) CHECK_MESSAGE(same(blocks[i], plain[i]), kernels->lanes, " lanes, block ", i);
      for (std::size_t i = 0; i < 2; ++i) CHECK_MESSAGE(same_bits(right[i].data(), plain_right[i].data(), 6), kernels->lanes, " lanes");
    }
  }
}

TEST_CASE("rigid: the equations of bricks have one solution in any number of lanes, and it is one") {
  for (const std::size_t count : std::initializer_list<std::size_t>{1, 2, 3, 5, 7}) {
    // A row in which every third brick touches the one before the last one too.
    Numbers numbers;
    std::vector<BrickRow> rows(count);
    std::vector<BrickEntry> entries;
    std::vector<Velocity> right = some_velocities(count, numbers);
    for (std::size_t i = 0; i < count; ++i) {
      rows[i].diagonal = some_block(12.0, numbers);
      rows[i].begin = entries.size();
      for (std::size_t back = i % 3 == 2 ? 2 : 1; back > 0; --back) {
        if (back > i) continue;
        BrickEntry& entry = entries.emplace_back();
        entry.column = static_cast<int>(i - back);
        entry.lower = some_block(0.0, numbers);
        entry.upper = some_block(0.0, numbers);
      }
      rows[i].end = entries.size();
    }
    std::vector<Velocity> first;
    for (const LaneKernels* kernels : all_lanes()) {
      std::vector<BrickRow> own = rows;
      std::vector<BrickEntry> own_entries = entries;
      std::vector<Velocity> x(count);
      REQUIRE(kernels->solve(own.data(), count, own_entries.data(), right.front().data(), x.front().data()));
      if (first.empty()) first = x;
      for (std::size_t i = 0; i < count; ++i) CHECK_MESSAGE(same_bits(x[i].data(), first[i].data(), 6), kernels->lanes, " lanes, ", count);
      // What is left of the right-hand side, by all blocks as they were given.
      for (std::size_t i = 0; i < count; ++i) {
        Velocity left = right[i];
        const auto take = [&left, &x](const BrickBlock& block, std::size_t j) {
          const Plain6 plain = plain_of(block);
          for (std::size_t r = 0; r < 6; ++r) {
            for (std::size_t c = 0; c < 6; ++c) left[r] -= plain[r][c] * x[j][c];
          }
        };
        take(rows[i].diagonal, i);
        for (std::size_t other = 0; other < count; ++other) {
          for (std::size_t e = rows[other].begin; e < rows[other].end; ++e) {
            const auto column = static_cast<std::size_t>(entries[e].column);
            if (other == i) take(entries[e].lower, column);
            if (column == i) take(entries[e].upper, other);
          }
        }
        for (const double off : left) CHECK(std::abs(off) < 1e-12);
      }
    }
  }
}

TEST_CASE("rigid: a number of lanes that there is not is refused in words") {
  const Layout layout = *read_layout("[[row]]\ncount = 3\npitch_mm = 24\n", "row.toml");
  for (const int lanes : {-1, 3, 5, 8}) {
    const auto refused = make_model(layout, RigidConfig{.lanes = lanes});
    REQUIRE(!refused.has_value());
    CHECK(refused.error().message.starts_with("lanes: " + std::to_string(lanes) +
                                              " is not a number of lanes that this processor has; it must be"));
  }
  for (const LaneKernels* kernels : all_lanes()) CHECK(make_model(layout, RigidConfig{.lanes = kernels->lanes}).has_value());
  CHECK(lane_kernels(0)->lanes == all_lanes().back()->lanes);
  CHECK(most_lanes() == lane_kernels(0)->lanes);
}

TEST_CASE("rigid: a processor without AVX2 takes two lanes, and is told so where four are asked for") {
  CHECK(lane_kernels(0, false) == lane_kernels(2));
  CHECK(lane_kernels(4, false) == nullptr);
  CHECK(no_such_lanes(4, false) ==
        "lanes: 4 is not a number of lanes that this processor has; it must be 1 or 2, or be left out for as many as it has.");
  if (has_four_lanes()) {
    CHECK(lane_kernels(0) == lane_kernels(4));
    CHECK(no_such_lanes(3) ==
          "lanes: 3 is not a number of lanes that this processor has; it must be 1, 2 or 4, or be left out for as many as it has.");
  }
}

}  // namespace topple::rigid

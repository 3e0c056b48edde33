// The kernels of bricks in one plane for each number of lanes that this processor has, against plain loops over doubles.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "model/lanes.h"
#include "model/rigid/plane_solver.h"

namespace topple::rigid {
namespace {

using Plain3 = std::array<std::array<double, 3>, 3>;

Plain3 plain_of(const PlaneBlock& block) {
  Plain3 out{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) out[r][c] = block.row[r][c];
  }
  return out;
}

bool same(const PlaneBlock& block, const Plain3& plain) {
  const Plain3 own = plain_of(block);
  return same_bits(own[0].data(), plain[0].data(), 3) && same_bits(own[1].data(), plain[1].data(), 3) &&
         same_bits(own[2].data(), plain[2].data(), 3);
}

PlaneBlock some_plane_block(double diagonal, Numbers& numbers) {
  PlaneBlock block{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) block.row[r][c] = numbers.next() + (r == c ? diagonal : 0.0);
  }
  return block;
}

Column<3> some_column(Numbers& numbers) { return {numbers.next(), numbers.next(), numbers.next()}; }

// Rows of two bricks, and of one and the floor, in every state.
std::vector<PlaneRow> some_plane_rows(Numbers& numbers) {
  std::vector<PlaneRow> rows;
  for (const int b : {-1, 1, 0}) {
    for (const bool pressed : {true, false}) {
      for (const Grip grip : {Grip::stick, Grip::forward, Grip::backward}) {
        for (const double base : {0.0, 0.3}) {
          PlaneRow row;
          row.a = b == 0 ? 1 : 0;
          row.b = b;
          row.normal_a = some_column(numbers);
          row.normal_b = some_column(numbers);
          row.tangent_a = some_column(numbers);
          row.tangent_b = some_column(numbers);
          row.bias = numbers.next();
          row.tangent_bias = numbers.next();
          row.normal_stiffness = 2.0 + numbers.next();
          row.tangent_stiffness = 2.0 + numbers.next();
          row.edge_stiffness = 2.0 + numbers.next();
          row.friction = 0.3;
          row.base = base;
          row.lagged_slip = numbers.next();
          row.lagged_limit = numbers.next();
          row.state = {pressed, grip};
          rows.push_back(row);
        }
      }
    }
  }
  return rows;
}

// Two bricks in a plane: blocks (0, 0), (0, 1), (1, 0), (1, 1).
struct PlanePair {
  std::array<Plain3, 4> block{};
  std::array<Column<3>, 2> right{};
};

// Adds scale force (rate . v) of both bricks, and an impulse along the same force.
void plain_pull(const PlaneRow& row, double scale, double impulse, const std::array<Column<3>, 2>& force,
                const std::array<Column<3>, 2>* rate, PlanePair& to) {
  const std::array<int, 2> brick{row.a, row.b};
  for (std::size_t i = 0; i < 2; ++i) {
    if (brick[i] < 0) continue;
    for (std::size_t k = 0; k < 3; ++k) to.right[static_cast<std::size_t>(brick[i])][k] += impulse * force[i][k];
    for (std::size_t j = 0; j < 2 && rate != nullptr; ++j) {
      if (brick[j] < 0) continue;
      Plain3& block = to.block[static_cast<std::size_t>(2 * brick[i] + brick[j])];
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) block[r][c] += scale * force[i][r] * (*rate)[j][c];
      }
    }
  }
}

// What PlaneSolver says of a row in its state.
void plain_add(const PlaneRow& row, bool convex, double times, PlanePair& to) {
  if (!row.state.pressed && row.base == 0.0) return;
  const std::array<Column<3>, 2> normal{row.normal_a, row.normal_b}, tangent{row.tangent_a, row.tangent_b};
  const bool on_cone = convex && row.base == 0.0, given = convex && !on_cone;
  double bias = row.bias + (on_cone ? row.friction * row.lagged_slip : 0.0), stiffness = times * row.normal_stiffness;
  if (row.state.grip == Grip::stick) {
    const double along = times * row.tangent_stiffness;
    plain_pull(row, along, -along * row.tangent_bias, tangent, &tangent, to);
    if (row.state.pressed) plain_pull(row, stiffness, -stiffness * bias, normal, &normal, to);
    return;
  }
  const double sign = row.state.grip == Grip::forward ? 1.0 : -1.0, share = given ? 0.0 : -sign * row.friction;
  if (given) plain_pull(row, 0.0, -sign * times * row.lagged_limit, tangent, nullptr, to);
  if (!given && row.base > 0.0) plain_pull(row, 0.0, times * share * row.base, tangent, nullptr, to);
  if (!row.state.pressed && !on_cone) return;
  std::array<Column<3>, 2> force = normal;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 3; ++k) force[i][k] += share * tangent[i][k];
  }
  if (on_cone) {
    stiffness = times * row.edge_stiffness;
    bias += share * row.tangent_bias;
  }
  plain_pull(row, stiffness, -stiffness * bias, force, on_cone ? &force : &normal, to);
}

}  // namespace

TEST_CASE("rigid: what a point in a plane adds to the equations has the same bits in any number of lanes") {
  for (const LaneKernels* kernels : all_lanes()) {
    Numbers numbers;
    for (const bool convex : {false, true}) {
      for (const PlaneRow& row : some_plane_rows(numbers)) {
        // Of two bricks the second one's row begins at the first: its blocks left of and above the diagonal are the only ones.
        const std::array<std::size_t, 2> offset{0, 0};
        std::array<PlaneBlock, 2> diagonal{some_plane_block(0.0, numbers), some_plane_block(0.0, numbers)};
        PlaneBlock lower = some_plane_block(0.0, numbers), upper = some_plane_block(0.0, numbers);
        std::array<Column<3>, 2> right{some_column(numbers), some_column(numbers)};
        PlanePair plain{{plain_of(diagonal[0]), plain_of(upper), plain_of(lower), plain_of(diagonal[1])}, right};
        kernels->add_row(row, convex, 0.7, {offset.data(), &lower, &upper, diagonal.data(), right.front().data()});
        plain_add(row, convex, 0.7, plain);
        const bool blocks = same(diagonal[0], plain.block[0]) && same(upper, plain.block[1]) && same(lower, plain.block[2]) &&
                            same(diagonal[1], plain.block[3]);
        CHECK_MESSAGE(blocks, kernels->lanes, " lanes");
        CHECK_MESSAGE(same_bits(right[0].data(), plain.right[0].data(), 3), kernels->lanes, " lanes");
        CHECK_MESSAGE(same_bits(right[1].data(), plain.right[1].data(), 3), kernels->lanes, " lanes");
      }
    }
  }
}

TEST_CASE("rigid: the equations of bricks in a plane have one solution in any number of lanes, and it is one") {
  for (const std::size_t count : std::initializer_list<std::size_t>{1, 2, 3, 5, 8}) {
    // A row in which every third brick touches the one before the last one too.
    Numbers numbers;
    std::vector<int> first;
    std::vector<std::size_t> offset;
    std::vector<PlaneBlock> lower, upper, diagonal;
    std::vector<Column<3>> right;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t back = std::min(i, i % 3 == 2 ? std::size_t{2} : std::size_t{1});
      first.push_back(static_cast<int>(i - back));
      offset.push_back(lower.size() - (i - back));
      for (std::size_t k = 0; k < back; ++k) {
        lower.push_back(some_plane_block(0.0, numbers));
        upper.push_back(some_plane_block(0.0, numbers));
      }
      diagonal.push_back(some_plane_block(8.0, numbers));
      right.push_back(some_column(numbers));
    }
    std::vector<Column<3>> plain;
    for (const LaneKernels* kernels : all_lanes()) {
      std::vector<PlaneBlock> l(lower.size()), u(lower.size()), inverse(count);
      std::vector<Column<3>> forward(count), x(count);
      const PlaneFactors factors{count,           first.data(), offset.data(), lower.data(),   upper.data(),
                                 diagonal.data(), l.data(),     u.data(),      inverse.data(), forward.front().data()};
      REQUIRE(kernels->factorise_plane(factors, 0));
      kernels->solve_plane(factors, right.front().data(), 0, x.front().data());
      if (plain.empty()) plain = x;  // Of one lane.
      for (std::size_t i = 0; i < count; ++i) CHECK_MESSAGE(same_bits(x[i].data(), plain[i].data(), 3), kernels->lanes, " lanes, ", count);
      for (std::size_t i = 0; i < count; ++i) {
        Column<3> left = right[i];
        const auto take = [&left, &x](const PlaneBlock& block, std::size_t j) {
          for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t c = 0; c < 3; ++c) left[r] -= block.row[r][c] * x[j][c];
          }
        };
        take(diagonal[i], i);
        for (std::size_t j = 0; j < count; ++j) {
          if (j < i && j >= static_cast<std::size_t>(first[i])) take(lower[offset[i] + j], j);
          if (j > i && i >= static_cast<std::size_t>(first[j])) take(upper[offset[j] + i], j);
        }
        for (const double off : left) CHECK(std::abs(off) < 1e-12);
      }
    }
  }
}

}  // namespace topple::rigid

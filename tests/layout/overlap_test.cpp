#include "layout/overlap.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/random.h"

namespace topple {
namespace {

std::string problems_of(std::string_view text) {
  const auto layout = read_layout(text, "test.toml");
  return layout ? "" : layout.error().message;
}

Box box_of(const Layout& layout, BrickId id) { return {standing_pose(layout, id), half_extents(layout.kind_of(id))}; }

/// Every pair, from the definition.
std::vector<std::pair<BrickId, BrickId>> overlaps_by_trying_all(const Layout& layout) {
  std::vector<std::pair<BrickId, BrickId>> pairs;
  for (BrickId a = 0; a < layout.brick_count(); ++a) {
    for (BrickId b = a + 1; b < layout.brick_count(); ++b) {
      const double thinner = std::fmin(layout.kind_of(a).thickness, layout.kind_of(b).thickness);
      if (-separation(box_of(layout, a), box_of(layout, b)) > 1e-3 * thinner) pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

}  // namespace

TEST_CASE("of bricks of all sizes, poses and headings the same pairs overlap as when every pair is tried") {
  Random random(3);
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  std::size_t seen = 0;
  for (int round = 0; round < 60; ++round) {
    Layout layout;
    for (int k = 0; k < 6; ++k) {
      const double size = std::pow(10.0, between(-2.5, 0.3));  // 3 mm to 2 m
      BrickKind& kind = layout.kinds.emplace_back();
      kind.height = size;
      kind.width = size * between(0.1, 1.0);
      kind.thickness = size * between(0.05, 1.0);
    }
    const double spread = between(0.5, 6.0);
    const Vec3 origin{between(-1e4, 1e4), between(-1e4, 1e4), 0.0};
    for (int i = 0; i < 300; ++i) {
      const Vec3 foot = origin + Vec3{spread * random.uniform(), spread * random.uniform(), between(-1.0, 2.0)};
      layout.bricks.push_back({.foot = {foot.x, foot.y, std::fmax(foot.z, 0.0)},
                               .heading = round % 3 == 0 ? 0.5 : between(-4.0, 4.0),
                               .kind = static_cast<std::uint16_t>(random.bits() % 6),
                               .color = 0,
                               .stance = static_cast<Stance>(random.bits() % 3)});
    }
    const auto expected = overlaps_by_trying_all(layout);
    std::vector<std::pair<BrickId, BrickId>> found;
    for (const OverlappingPair& overlap : find_overlaps(layout, 1'000'000)) found.emplace_back(overlap.first, overlap.second);
    CHECK(found == expected);
    seen += expected.size();
  }
  CHECK(seen > 1000);
}

TEST_CASE("bricks that touch do not overlap, not even far from the origin") {
  CHECK(problems_of("[[row]]\ncount = 1000\ngap_mm = 0\n") == "");
  CHECK(problems_of("[[row]]\nfrom_mm = [9.9e7, -9.9e7]\nheading_deg = 33\ncount = 1000\ngap_mm = 0\n") == "");
  // A wall: flat bricks end to end, one course on the other.
  std::string wall;
  for (int course = 0; course < 5; ++course) {
    wall += "[[row]]\nfrom_mm = [" + std::to_string(course % 2 * 24) + ", 0, " + std::to_string(course * 7.5) +
            "]\ncount = 20\ngap_mm = 0\npose = \"flat\"\n";
  }
  CHECK(problems_of(wall) == "");
}

TEST_CASE("two bricks that overlap are both named, with their parts and by how much") {
  CHECK(problems_of("[[row]]\ncount = 5\npitch_mm = 24\n[[brick]]\nat_mm = [50, 3]\n") ==
        "test.toml:4:1: brick.0: brick 2 (row 1) and brick 5 (brick 1) overlap by 5.5 mm; bricks may touch, not overlap");
}

TEST_CASE("noise that pushes one brick into another is found") {
  const std::string text = problems_of("[[row]]\ncount = 1000\ngap_mm = 1\n[noise]\nseed = 1\nposition_mm = 0.5\n");
  CHECK(text.find("overlap by") != std::string::npos);
}

TEST_CASE("a million overlaps end after a thousand") {
  const std::string text = problems_of("[[row]]\ncount = 1000000\npitch_mm = 10\n[[row]]\ncount = 1000000\npitch_mm = 10\n");
  CHECK(std::count(text.begin(), text.end(), '\n') == 50);
  CHECK(text.ends_with("\nand at least 950 more problems"));
}

}  // namespace topple

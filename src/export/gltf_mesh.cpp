#include "export/gltf_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "export/gltf_axes.h"

namespace topple {
namespace {

// The same edges as the page draws (studio/src/view/brick_material.ts): those of a real domino, less where it is thin [m].
constexpr double kEdge = 0.0011;
constexpr double kMostOfSide = 0.3;

/// A line across a face: on which side of the middle, and the slope of the rounding there (0 on the flat, 1 at 45 degrees).
struct Stop {
  double side = 0.0;
  double slope = 0.0;
};

// A ball is a box that is all rounding: both sides of its flat are one.
std::vector<Stop> stops(Shape shape, int steps) {
  if (steps == 0) return {{-1.0, 0.0}, {1.0, 0.0}};
  std::vector<Stop> out;
  const auto slope = [&](int i) { return std::tan(std::numbers::pi / 4.0 * i / steps); };
  for (int i = -steps; i <= 0; ++i) out.push_back({-1.0, slope(i)});
  for (int i = shape == Shape::ball ? 1 : 0; i <= steps; ++i) out.push_back({1.0, slope(i)});
  return out;
}

struct Face {
  std::size_t axis = 0;
  double side = 1.0;  ///< Towards -1 or +1 of it.
};

void add_face(const Face& face, const std::vector<Stop>& line, const std::array<double, 3>& flat, double edge, BrickMesh& mesh) {
  const std::size_t u = (face.axis + 1) % 3;
  const std::size_t v = (face.axis + 2) % 3;
  const std::size_t first = mesh.places.size() / 3;
  for (const Stop& b : line) {
    for (const Stop& a : line) {
      std::array<double, 3> side{}, normal{};
      side[face.axis] = normal[face.axis] = face.side;
      side[u] = a.side;
      side[v] = b.side;
      normal[u] = a.slope;
      normal[v] = b.slope;
      const Vec3 way{normal[0], normal[1], normal[2]};
      const Vec3 unit = (1.0 / norm(way)) * way;
      add_y_up(unit, mesh.normals);
      add_y_up(Vec3{side[0] * flat[0], side[1] * flat[1], side[2] * flat[2]} + edge * unit, mesh.places);
    }
  }
  const std::size_t n = line.size();
  for (std::size_t j = 0; j + 1 < n; ++j) {
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const std::size_t p = first + j * n + i;
      std::array<std::size_t, 6> quad{p, p + 1, p + n + 1, p, p + n + 1, p + n};
      if (face.side < 0.0) std::reverse(quad.begin(), quad.end());
      for (const std::size_t corner : quad) mesh.corners.push_back(static_cast<std::uint16_t>(corner));
    }
  }
}

}  // namespace

BrickMesh brick_mesh(const BrickKind& kind, std::int64_t bricks) {
  const int rounding = bricks <= 3000 ? 3 : bricks <= 30000 ? 1 : 0;
  const bool ball = kind.shape == Shape::ball;
  const int steps = ball ? std::max(2, 2 * rounding) : rounding;
  const Vec3 half = half_extents(kind);
  const double least = std::min({half.x, half.y, half.z});
  const double edge = ball ? half.x : rounding == 0 ? 0.0 : std::min(kEdge, kMostOfSide * least);
  BrickMesh mesh;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      add_face({axis, side}, stops(kind.shape, steps), {half.x - edge, half.y - edge, half.z - edge}, edge, mesh);
    }
  }
  return mesh;
}

}  // namespace topple

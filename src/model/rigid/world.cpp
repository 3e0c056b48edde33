#include "model/rigid/world.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace topple::rigid {

World::World(const Layout& source) : layout(source), neighbours(source), gravity(source.gravity) {
  const std::size_t count = source.bricks.size();
  phase.assign(count, Phase::standing);
  arrived.assign(count, 0);
  front.assign(count, kNoFront);
  place.assign(count, 0);
  smallest = std::numeric_limits<double>::infinity();
  for (const BrickKind& kind : source.kinds) smallest = std::min(smallest, std::max({kind.height, kind.width, kind.thickness}));
  stacked = std::any_of(source.bricks.begin(), source.bricks.end(), [](const Brick& brick) { return brick.foot.z > 0.0; });
  balls = std::any_of(source.kinds.begin(), source.kinds.end(), [](const BrickKind& kind) { return kind.shape == Shape::ball; });
  pose.reserve(count);
  for (BrickId brick = 0; brick < source.brick_count(); ++brick) pose.push_back(standing_pose(source, brick));
}

double potential_energy(const World& world, BrickId brick, double height) {
  const Brick& put = world.layout.bricks[static_cast<std::size_t>(brick)];
  const BrickKind& kind = world.layout.kinds[put.kind];
  return world.gravity * kind.mass * (height - put.foot.z - 0.5 * extents(kind, put.stance).up);
}

BrickId next_of_part(const Layout& layout, BrickId brick) {
  const Part* part = layout.part_of(brick);
  return part != nullptr && part->line && brick + 1 < part->first + part->count ? brick + 1 : kNoBrick;
}

}  // namespace topple::rigid

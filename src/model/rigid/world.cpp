#include "model/rigid/world.h"

#include <algorithm>

namespace topple::rigid {

World::World(const Layout& source) : layout(source), units(source), neighbours(source, units) {
  const std::size_t count = source.bricks.size();
  phase.assign(count, Phase::standing);
  arrived.assign(count, 0);
  front.assign(count, kNoFront);
  place.assign(count, 0);
  for (const BrickKind& kind : source.kinds) kinds.push_back(units.kind(kind));
  for (const Push& push : source.pushes) pushes.push_back(units.push(push));
  stacked = std::any_of(source.bricks.begin(), source.bricks.end(), [](const Brick& brick) { return brick.foot.z > 0.0; });
  balls = std::any_of(source.kinds.begin(), source.kinds.end(), [](const BrickKind& kind) { return kind.shape == Shape::ball; });
  pose.reserve(count);
  for (BrickId brick = 0; brick < source.brick_count(); ++brick) pose.push_back(standing(brick));
}

Pose World::standing(BrickId brick) const {
  const Brick& put = given(brick);
  return standing_pose(kinds[put.kind], units.put_down(put));
}

void Ledger::meet(std::int32_t other) {
  if (other != front && std::find(met.begin(), met.end(), other) == met.end()) met.push_back(other);
}

void Ledger::take(BrickId brick) {
  if (std::erase(left, brick) == 0) taken.push_back(brick);
}

void Ledger::leave(BrickId brick) {
  if (std::erase(taken, brick) == 0) left.push_back(brick);
}

bool Ledger::took(BrickId brick) const { return std::find(taken.begin(), taken.end(), brick) != taken.end(); }
bool Ledger::gave_up(BrickId brick) const { return std::find(left.begin(), left.end(), brick) != left.end(); }

const Ledger::Rest* Ledger::rest_of(BrickId brick) const {
  const auto found = std::find_if(rested.begin(), rested.end(), [brick](const Rest& rest) { return rest.brick == brick; });
  return found == rested.end() ? nullptr : &*found;
}

void World::enter(Ledger& ledger) {
  for (const BrickId brick : ledger.woken) {
    const auto at = static_cast<std::size_t>(brick);
    if (phase[at] == Phase::resting) resting_energy -= potential_energy(*this, brick, pose[at].position.z);
    phase[at] = Phase::falling;
  }
  for (const Ledger::Rest& rest : ledger.rested) {
    const auto at = static_cast<std::size_t>(rest.brick);
    phase[at] = Phase::resting;
    pose[at] = rest.pose;
    resting_energy += potential_energy(*this, rest.brick, rest.pose.position.z);
  }
  for (const Ledger::Move& move : ledger.moves) {
    neighbours.moved(move.brick, move.from, move.to);
    pose[static_cast<std::size_t>(move.brick)].position = move.to;
  }
  push_work += ledger.push_work;
  ledger.woken.clear();
  ledger.rested.clear();
  ledger.moves.clear();
  ledger.push_work = 0.0;
}

Still still(const World& world, const Ledger& ledger, BrickId brick) {
  const auto at = static_cast<std::size_t>(brick);
  const Ledger::Rest* rest = ledger.rest_of(brick);
  if (rest != nullptr) return {rest->pose, true};
  return {world.pose[at], world.phase[at] == Phase::resting};
}

double potential_energy(const World& world, BrickId brick, double height) {
  const BrickKind& kind = world.kind_of(brick);
  return world.gravity * kind.mass * (height - world.foot(brick).z - 0.5 * extents(kind, world.given(brick).stance).up);
}

BrickId next_of_part(const Layout& layout, BrickId brick) {
  const Part* part = layout.part_of(brick);
  return part != nullptr && part->line && brick + 1 < part->first + part->count ? brick + 1 : kNoBrick;
}

}  // namespace topple::rigid

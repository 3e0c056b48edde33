#include "model/pivot/moving_set.h"

#include <algorithm>
#include <cmath>

namespace topple::pivot {

namespace {

// A leaning brick rests when, at its rate, it would move its upper edge by less than this fraction of its thickness in the time
// sqrt(H / g); it wakes when the brick ahead would let it move further than that. Four times finer than what a recording keeps.
constexpr double kRestTolerance = 5e-4;

std::size_t at(BrickId brick) { return static_cast<std::size_t>(brick); }

}  // namespace

MovingSet::MovingSet(const Layout& layout, const PivotConfig& config, Lines lines)
    : layout_(layout), lines_(std::move(lines)), still_(layout.bricks.size()), slot_(layout.bricks.size(), -1) {
  for (const BrickKind& kind : layout.kinds) {
    for (const Stance stance : {Stance::standing, Stance::flat, Stance::on_side}) {
      const Extents size = extents(kind, stance);
      bodies_.push_back({.size = size,
                         .mass = kind.mass,
                         .inertia = moment_of_inertia(size, kind.mass, config.inertia),
                         .settle = std::sqrt(size.up / layout.gravity),
                         .slack = kRestTolerance * size.along / size.up,
                         .turning = turning(size, kind.mass, layout.gravity, config.inertia)});
    }
  }
}

const Body& MovingSet::body_of(BrickId brick) const {
  const Brick& b = layout_.bricks[at(brick)];
  return bodies_[3 * std::size_t{b.kind} + static_cast<std::size_t>(b.stance)];
}

bool MovingSet::after(std::int32_t a, std::int32_t b) const {
  const Moving& one = (*this)[a];
  const Moving& other = (*this)[b];
  return one.depth > other.depth || (one.depth == other.depth && one.brick < other.brick);
}

Moving& MovingSet::wake(BrickId brick, double time) {
  if (free_.empty()) {
    free_.push_back(static_cast<std::int32_t>(pool_.size()));
    pool_.emplace_back();
  }
  const std::int32_t slot = free_.back();
  free_.pop_back();
  slot_[at(brick)] = slot;
  Moving& moving = (*this)[slot];
  // These keep their memory.
  std::vector<Pair> ahead = std::move(moving.ahead);
  std::vector<Kink> kinks = std::move(moving.kinks);
  ahead.clear();
  kinks.clear();
  const std::int8_t side = lines_.side[at(brick)];
  for (BrickId next = lines_.ahead[at(brick)]; next != kNoBrick; next = lines_.sibling[at(next)]) {
    ahead.emplace_back(layout_, brick, side, next, lines_.side[at(next)]);
  }
  const Body& body = body_of(brick);
  const double tilt = still(brick).tilt;
  moving = Moving{.brick = brick, .depth = lines_.depth[at(brick)], .side = side, .body = &body, .turning = body.turning};
  moving.fall = fall_at(time, tilt, 0.0);
  for (const Pair& pair : ahead) {
    if (Moving* leant_on = find(pair.ahead())) leant_on->follows = false;
  }
  moving.ahead = std::move(ahead);
  moving.kinks = std::move(kinks);
  const BrickId behind = lines_.behind[at(brick)];
  if (behind != kNoBrick && slot_[at(behind)] < 0 && still(behind).tilt > 0.0F) {
    moving.behind.emplace(layout_, behind, lines_.side[at(behind)], brick, side);
  }
  order_.insert(std::lower_bound(order_.begin(), order_.end(), slot, [this](auto a, auto b) { return after(a, b); }), slot);
  return moving;
}

void MovingSet::rest(std::int32_t slot) {
  Moving& moving = (*this)[slot];
  still(moving.brick).tilt = static_cast<float>(moving.fall.theta);
  slot_[at(moving.brick)] = -1;
  for (const Pair& pair : moving.ahead) {
    Moving* ahead = find(pair.ahead());
    if (ahead != nullptr) ahead->behind = pair;
  }
  moving.brick = kNoBrick;
  free_.push_back(slot);
}

void MovingSet::sweep() {
  std::erase_if(order_, [this](std::int32_t slot) { return (*this)[slot].brick == kNoBrick; });
}

}  // namespace topple::pivot

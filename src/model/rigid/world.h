/// What all fronts share: the layout, the tolerances, and where each brick is that does not move.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "model/rigid/lane_kernels.h"
#include "model/rigid/neighbours.h"
#include "model/rigid/run_units.h"
#include "topple/model.h"
#include "topple/profile.h"

namespace topple::rigid {

inline constexpr std::int32_t kNoFront = -1;

/// What one front does to the world in a step. Fronts are advanced side by side and see the world as it was when the step began; what they
/// did is entered when all are done, in the order of their numbers, so that no number of threads changes anything.
struct Ledger {
  struct Move {
    BrickId brick = kNoBrick;
    Vec3 from, to;
  };
  struct Rest {
    BrickId brick = kNoBrick;
    Pose pose;
  };
  std::int32_t front = kNoFront;  ///< Whose it is.
  std::vector<BrickId> taken;     ///< Belong to the front from now on.
  std::vector<BrickId> left;      ///< Do no longer.
  std::vector<BrickId> woken;
  std::vector<Rest> rested;
  std::vector<Move> moves;  ///< From cell to cell of the neighbours.
  double push_work = 0.0;
  std::vector<std::int32_t> met;  ///< Other fronts whose bricks are within reach, until they are joined.
  std::vector<Event> events;      ///< Of this step, for whom the model tells of it.

  void meet(std::int32_t other);
  void take(BrickId brick);
  void leave(BrickId brick);
  bool took(BrickId brick) const;
  bool gave_up(BrickId brick) const;
  const Rest* rest_of(BrickId brick) const;  ///< Null if it has not come to rest in this step.
};

/// Pure numbers that scale with a brick: lengths are fractions of the thinnest side, times of sqrt(height / gravity).
struct Tolerances {
  double touching = 1e-3;  ///< Closer than this two bricks touch.
  double located = 3e-6;   ///< Impacts are located to this.
  double bends = 1e-2;     ///< By so much the drift after a blow may miss what touches.
  double margin = 1e-2;    ///< A contact lasts while it is closer than this.
  double retire = 5e-3;    ///< A brick rests when it would move by no more than this from now on...
  double horizon = 1.0;    ///< ...within this time...
  double patience = 0.2;   ///< ...and has done so for this long.
  double stays = 10.0;     ///< It rests too when it has not moved by that for so long, however it trembles.
  double support = 1e-2;   ///< A resting brick wakes when what it leans on has moved by this.
  double in_plane = 5e-2;  ///< A row that has become straight may be out of its plane by this.
  double load = 0.02;      ///< A brick that stands or rests wakes under this share of its weight.
  double velocity = 1e-5;  ///< The solver stops when velocities change by less, as a fraction of sqrt(gravity x height).
  double lost = 3e-2;      ///< Sweeps that end with changes above this, as such a fraction, have lost their way.
  int sweeps = 60;
  int cuts = 16;  ///< Impacts a moving brick that are located in one step of one front; more are taken at its end.
};

struct World {
  explicit World(const Layout& source);

  const Layout& layout;  ///< For what has neither place nor unit: parts, surfaces, counts.
  RunUnits units;        ///< In which all that follows is.
  std::vector<BrickKind> kinds;
  std::vector<Push> pushes;
  Neighbours neighbours;
  std::vector<Phase> phase;
  std::vector<Pose> pose;             ///< Of each brick that does not move; of one that does, the place where it was listed last.
  std::vector<std::uint8_t> arrived;  ///< Whether the wave has been there.
  std::vector<std::int32_t> front;    ///< The front that a brick belongs to, moving or in its way.
  std::vector<std::int32_t> place;    ///< In the list of that front, as a hint: see note_place().
  double gravity = 1.0;
  double smallest = 1.0;  ///< Longest side of the smallest brick.
  double step = 0.0;
  Tolerances tolerances;
  double resting_energy = 0.0;  ///< Potential, of bricks that rest.
  double push_work = 0.0;
  bool stacked = false;  ///< Some bricks stand on others.
  bool balls = false;    ///< Some are balls.
  bool every_brick_moves = false;
  bool repeats = true;  ///< What an even row does again is not computed again.
  const LaneKernels* kernels = lane_kernels(0);
  Profile* profile = nullptr;

  /// As the layout has it, in the world.
  const Brick& given(BrickId brick) const { return layout.bricks[static_cast<std::size_t>(brick)]; }
  const BrickKind& kind_of(BrickId brick) const { return kinds[given(brick).kind]; }
  Vec3 foot(BrickId brick) const { return units.foot(given(brick)); }
  double heading(BrickId brick) const { return units.heading(given(brick)); }
  Pose standing(BrickId brick) const;  ///< As it was put down.

  /// Where a brick may be in its front's list. Two fronts may take one brick in one step, before it is known whose it is; so a hint is
  /// believed only where the list agrees with it.
  std::int32_t noted_place(BrickId brick) {
    return std::atomic_ref(place[static_cast<std::size_t>(brick)]).load(std::memory_order_relaxed);
  }
  void note_place(BrickId brick, std::int32_t at) {
    std::atomic_ref(place[static_cast<std::size_t>(brick)]).store(at, std::memory_order_relaxed);
  }

  /// Enters what a front did but for what it took; the ledger is empty afterwards but for that.
  void enter(Ledger& ledger);
};

/// Where a brick is that does not move: standing or, if it `rests`, fallen.
struct Still {
  Pose pose;
  bool rests = false;
};
/// What has come to rest in this step is in the ledger of its front before it is in the world.
Still still(const World& world, const Ledger& ledger, BrickId brick);

/// Whether a brick belongs to the front of this ledger, in this moment of its step.
inline bool owns(const World& world, const Ledger& ledger, BrickId brick) {
  if (world.front[static_cast<std::size_t>(brick)] == ledger.front) return ledger.left.empty() || !ledger.gave_up(brick);
  return !ledger.taken.empty() && ledger.took(brick);
}

/// Potential energy of a brick against how it was put down.
double potential_energy(const World& world, BrickId brick, double height);

/// The brick that should fall after this one, in its part of the layout, or none.
BrickId next_of_part(const Layout& layout, BrickId brick);

}  // namespace topple::rigid

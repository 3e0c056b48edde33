/// The specification of the contact solver: one contact point after the other.
#pragma once

#include <span>
#include <vector>

#include "model/rigid/lane_kernels.h"

namespace topple::rigid {

/// Projected Gauss-Seidel: every point in turn takes the impulse that the laws of contact ask for while all others keep theirs.
class Sweeps {
 public:
  explicit Sweeps(const LaneKernels& kernels) : kernels_(kernels) {}
  /// Velocities from those without contact and the impulses that the rows hold; these come pair by pair. In which order the points of a
  /// pair are taken does not depend on which hand they are at, so that the mirror image of a layout is solved as its mirror image.
  void begin(std::span<const ContactRow> rows, std::span<const Velocity> free);
  /// At most so many, forwards and backwards in turn; fewer if no point's velocity changed by more than `tolerance` [m/s] in one. Returns
  /// the largest change in the last one [m/s].
  double run(std::span<ContactRow> rows, int most, double tolerance);
  /// The same with another law of friction, under which sliding points part [Anitescu2006]: a little wrong, but there always is a solution,
  /// and no sweep makes energy from impulses that are zero.
  double run_cones(std::span<ContactRow> rows, int most, double tolerance);
  /// Sets the states that follow from the impulses.
  static void tell_states(std::span<ContactRow> rows);

  std::vector<Velocity> velocity;  ///< Of all bodies.

 private:
  const LaneKernels& kernels_;
  std::vector<int> order_;  // Of the rows; found in the first sweep.
  bool backwards_ = false;
};

}  // namespace topple::rigid

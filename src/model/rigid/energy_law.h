/// The law that contacts make no energy, for what the steps of a front leave of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace topple::rigid {

/// Kinetic and potential energy of all that moves in a front never rises but by a push. Steps are exact only to their order, and where many
/// points bounce or stick at once that may add up; so a front looks at its energy after each kick, and what is too much is taken out of its
/// velocities, all by the same share: what touches goes on to touch.
class EnergyLaw {
 public:
  /// A rise of so much of the weight of what moves, times its size, is let pass: where velocities are read between two kicks they are exact
  /// to the order of the step alone. Rows and curves of dominoes hardly reach it.
  static constexpr double kSpare = 1e-4;

  /// What a brick brings that begins to move; the opposite of what it takes with it when it comes to rest [J].
  void add(double energy) { known_ += energy; }
  /// What comes cannot be compared with what was: a push, a force, bricks that go to another front.
  void forget() { known_ = std::numeric_limits<double>::quiet_NaN(); }
  void join(const EnergyLaw& other) {
    known_ += other.known_;
    rise_ += other.rise_;
  }
  /// What is to be taken away of the energy `now` of all that moves, to keep its largest rise at `allowed`; it counts as taken [J].
  double excess(double now, double allowed) {
    if (std::isfinite(known_)) rise_ = std::max(0.0, rise_ + (now - known_));
    const double taken = std::max(0.0, rise_ - allowed);
    rise_ -= taken;
    known_ = now - taken;
    return taken;
  }

 private:
  double known_ = std::numeric_limits<double>::quiet_NaN();  // When it was looked at last, and of what has begun to move since [J].
  double rise_ = 0.0;                                        // Since it was least [J].
};

}  // namespace topple::rigid

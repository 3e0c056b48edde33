// How a plane front keeps from making energy by the inexactness of its steps.
#include <algorithm>
#include <cmath>

#include "model/rigid/plane_front.h"

namespace topple::rigid {

double PlaneFront::moving_energy() const {
  double sum = 0.0;
  for (const PlaneBrick& brick : bricks_) {
    if (brick.moving) sum += kinetic_energy(brick, brick.velocity);
  }
  return sum;
}

// What a rise of energy may be [J].
double PlaneFront::spare_energy() const {
  double sum = 0.0;
  for (const PlaneBrick& brick : bricks_) {
    if (brick.moving) sum += world_.gravity * brick.mass * brick.radius;
  }
  return EnergyLaw::kSpare * sum;
}

// After a kick or a bounce.
void PlaneFront::keep_energy() {
  const double kinetic = moving_energy();
  double energy = kinetic;
  for (const PlaneBrick& brick : bricks_) {
    if (brick.moving) energy += potential_energy(world_, brick.id, brick.box.place.z);
  }
  if (!forces_.empty()) energy_law_.forget();
  const double taken = energy_law_.excess(energy, spare_energy());
  if (taken <= 0.0) return;
  const double share = std::sqrt(std::max(1.0 - taken / kinetic, 0.0));
  for (PlaneBrick& brick : bricks_) {
    brick.velocity = share * brick.velocity;
    brick.middle = share * brick.middle;
  }
}

}  // namespace topple::rigid

// How a front keeps from making energy by the inexactness of its steps.
#include <algorithm>
#include <cmath>

#include "model/rigid/wavefront.h"

namespace topple::rigid {

namespace {

// What a drift may make of the kinetic energy there is, by its own inexactness.
constexpr double kSpare = 1e-3;

}  // namespace

double Front::moving_energy() const {
  double sum = 0.0;
  for (const Body& body : bodies_) {
    if (body.inverse_mass > 0.0) sum += kinetic_energy(body);
  }
  return sum;
}

// At an impact within a drift velocities are as far beyond the middle ones as those at its beginning were below them. Where the half kick
// at its beginning stopped something, that would throw it back: then they go only so far beyond that they have no more than this kinetic
// energy [J].
void Front::rein_in(double most) {
  const double beyond = moving_energy();
  if (beyond <= most * (1.0 + kSpare)) return;
  guess_.clear();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Twist found = twist_of(bodies_[i]);
    const Twist& middle = members_[i].middle;
    guess_.push_back(found);
    if (members_[i].moving) set_twist(bodies_[i], {found.velocity - middle.velocity, found.spin - middle.spin});
  }
  const double change = moving_energy();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (members_[i].moving) set_twist(bodies_[i], members_[i].middle);
  }
  // That of middle + share x change is at_middle + share x both + share^2 x change.
  const double at_middle = moving_energy(), both = beyond - at_middle - change, left = at_middle - most;
  const double root = both * both - 4.0 * change * left;
  const double share = left >= 0.0 || root < 0.0 || change <= 0.0 ? 0.0 : std::clamp((std::sqrt(root) - both) / (2.0 * change), 0.0, 1.0);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!members_[i].moving) continue;
    const Twist& middle = members_[i].middle;
    set_twist(bodies_[i],
              {middle.velocity + share * (guess_[i].velocity - middle.velocity), middle.spin + share * (guess_[i].spin - middle.spin)});
  }
}

// What a rise of energy may be [J].
double Front::spare_energy() const {
  double sum = 0.0;
  for (const Body& body : bodies_) {
    if (body.inverse_mass > 0.0) sum += world_.gravity * body.radius / body.inverse_mass;
  }
  return EnergyLaw::kSpare * sum;
}

// After a kick or a bounce.
void Front::keep_energy() {
  const double kinetic = moving_energy();
  double energy = kinetic;
  for (const Body& body : bodies_) {
    if (body.inverse_mass > 0.0) energy += potential_energy(world_, body.id, body.position.z);
  }
  if (!forces_.empty()) energy_law_.forget();
  const double taken = energy_law_.excess(energy, spare_energy());
  if (taken <= 0.0) return;
  const double share = std::sqrt(std::max(1.0 - taken / kinetic, 0.0));
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Member& member = members_[i];
    if (!member.moving) continue;
    const Twist now = twist_of(bodies_[i]);
    set_twist(bodies_[i], {share * now.velocity, share * now.spin});
    member.middle = {share * member.middle.velocity, share * member.middle.spin};
  }
}

}  // namespace topple::rigid

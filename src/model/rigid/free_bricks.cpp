#include "model/rigid/free_bricks.h"

#include <cmath>

#include "model/rigid/energy_law.h"

namespace topple::rigid {

void touch_body(const Body& a, const Body* b, double margin, Manifold& out) {
  if (b == nullptr) return touch_floor(a, margin, out);
  const Vec3 apart = a.position - b->position;
  const double reach = a.radius + b->radius, squared = dot(apart, apart);
  if (squared > (reach + margin) * (reach + margin)) {
    out.count = 0;
    out.parted = std::sqrt(squared) - reach;
    return;
  }
  touch_boxes(a, *b, margin, out);
}

int FreeBricks::place_of(BrickId brick) const {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].id == brick) return static_cast<int>(i);
  }
  return -1;
}

double FreeBricks::closing_speed(const Touch& touch, int point) const {
  const Vec3& at = touch.now.points[static_cast<std::size_t>(point)].position;
  const Body& a = body(touch.a);
  Vec3 slip = velocity_at(a, at - a.position);
  if (touch.b != kFloor) {
    const Body& b = body(touch.b);
    slip = slip - velocity_at(b, at - b.position);
  }
  return -dot(touch.now.normal, slip);
}

double FreeBricks::moving_energy() const {
  double sum = 0.0;
  for (const Body& body : bodies) {
    if (body.inverse_mass > 0.0) sum += kinetic_energy(body);
  }
  return sum;
}

double FreeBricks::spare_energy(double gravity) const {
  double sum = 0.0;
  for (const Body& body : bodies) {
    if (body.inverse_mass > 0.0) sum += gravity * body.radius / body.inverse_mass;
  }
  return EnergyLaw::kSpare * sum;
}

}  // namespace topple::rigid

#include "model/rigid/contact_row.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

namespace {

// The heading of the first brick's own x axis, what it slides along, without its part along the normal.
Vec3 tangent_of(const Vec3& normal, const Vec3& heading) {
  const Vec3 flat = heading - dot(heading, normal) * normal;
  const double length = norm(flat);
  if (length > 1e-9) return (1.0 / length) * flat;
  const Vec3 other = std::abs(normal.z) < 0.9 ? Vec3{0.0, 0.0, 1.0} : Vec3{1.0, 0.0, 0.0};
  const Vec3 side = cross(normal, other);
  return (1.0 / norm(side)) * cross(side, normal);
}

Wide wide_of(const Vec3& linear, const Vec3& spin) { return {Two{linear.x, linear.y}, Two{linear.z, spin.x}, Two{spin.y, spin.z}}; }

void couple(const Body& body, const Vec3& arm, const std::array<Vec3, 3>& directions, double sign, std::array<Wide, 3>& of,
            std::array<Wide, 3>& gain) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 push = sign * directions[k];
    const Vec3 twist = cross(arm, push);
    of[k] = wide_of(push, twist);
    gain[k] = wide_of(body.inverse_mass * push, body.inverse_inertia * twist);
  }
}

}  // namespace

void set_directions(ContactRow& row, const Body& a) {
  row.along = tangent_of(row.normal, column(a.axes, 0));
  row.across = cross(row.normal, row.along);
}

void set_couplings(ContactRow& row, const Body& a, const Body* b) {
  const std::array<Vec3, 3> directions{row.normal, row.along, row.across};
  couple(a, row.arm_a, directions, 1.0, row.of_a, row.gain_a);
  if (b != nullptr) couple(*b, row.arm_b, directions, -1.0, row.of_b, row.gain_b);
  const auto response = [&row, b](std::size_t to, std::size_t from) {
    const double own = product_of(row.of_a[to], row.gain_a[from]);
    return b == nullptr ? own : own + product_of(row.of_b[to], row.gain_b[from]);
  };
  row.k_nn = response(0, 0);
  row.k_na = response(1, 0);
  row.k_nc = response(2, 0);
  row.k_aa = response(1, 1);
  row.k_ac = response(2, 1);
  row.k_cc = response(2, 2);
  row.normal_mass = 1.0 / row.k_nn;
  row.mass = 2.0 / (row.k_aa + row.k_cc);
}

void set_steps(ContactRow& row) {
  row.give_normal = 1.0 / row.normal_stiffness;
  row.give = 1.0 / row.tangent_stiffness;
  row.step_normal = 1.0 / (row.k_nn + row.give_normal);
  const double k_aa = row.k_aa + row.give, k_cc = row.k_cc + row.give;
  const double inverse = 1.0 / (k_aa * k_cc - row.k_ac * row.k_ac);
  row.step_aa = inverse * k_cc;
  row.step_ac = inverse * row.k_ac;
  row.step_cc = inverse * k_aa;
  row.step_sliding = 1.0 / (std::max(k_aa, k_cc) + std::abs(row.k_ac));
}

}  // namespace topple::rigid

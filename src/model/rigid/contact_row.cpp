#include "model/rigid/contact_row.h"

#include <algorithm>
#include <cmath>

#include "model/rigid/lane_kernels.h"

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

}  // namespace

void set_directions(ContactRow& row, const Body& a) {
  row.along = tangent_of(row.normal, column(a.axes, 0));
  row.across = cross(row.normal, row.along);
}

void set_couplings(ContactRow& row, const Body& a, const Body* b, const LaneKernels& kernels) {
  kernels.couple(row, a, b);
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

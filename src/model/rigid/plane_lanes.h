/// The equations of bricks that move in one plane, in lanes.
#pragma once

#include "model/rigid/lanes.h"
#include "model/rigid/plane_law.h"
#include "model/rigid/plane_solver.h"

namespace topple::rigid {

/// A row of a PlaneBlock. What the fourth lane has is of no account.
template <int L>
struct PlaneRowOf {
  double x, y, z;
  static PlaneRowOf load(const double* from) { return {from[0], from[1], from[2]}; }
  static PlaneRowOf made(double x, double y, double z) { return {x, y, z}; }
  static PlaneRowOf of(const double* three) { return load(three); }
  static PlaneRowOf zero() { return {0.0, 0.0, 0.0}; }
  void store(double* to) const {
    to[0] = x;
    to[1] = y;
    to[2] = z;
  }
  friend PlaneRowOf operator+(const PlaneRowOf& a, const PlaneRowOf& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend PlaneRowOf operator-(const PlaneRowOf& a, const PlaneRowOf& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend PlaneRowOf operator*(double s, const PlaneRowOf& a) { return {s * a.x, s * a.y, s * a.z}; }
};

template <>
struct PlaneRowOf<2> {
  Two xy;
  double z;
  static PlaneRowOf load(const double* from) { return {load_aligned<2>(from), from[2]}; }
  static PlaneRowOf made(double x, double y, double z) { return {Two{x, y}, z}; }
  static PlaneRowOf of(const double* three) { return {rigid::load<2>(three), three[2]}; }
  static PlaneRowOf zero() { return {Two{}, 0.0}; }
  void store(double* to) const {
    store_aligned<2>(to, xy);
    to[2] = z;
  }
  friend PlaneRowOf operator+(const PlaneRowOf& a, const PlaneRowOf& b) { return {a.xy + b.xy, a.z + b.z}; }
  friend PlaneRowOf operator-(const PlaneRowOf& a, const PlaneRowOf& b) { return {a.xy - b.xy, a.z - b.z}; }
  friend PlaneRowOf operator*(double s, const PlaneRowOf& a) { return {Two{s, s} * a.xy, s * a.z}; }
};

#if defined(__AVX2__)
template <>
struct PlaneRowOf<4> {
  Four v;
  static PlaneRowOf load(const double* from) { return {load_aligned<4>(from)}; }
  static PlaneRowOf made(double x, double y, double z) { return {Four{x, y, z, z}}; }
  static PlaneRowOf of(const double* three) { return made(three[0], three[1], three[2]); }
  static PlaneRowOf zero() { return {Four{}}; }
  void store(double* to) const { store_aligned<4>(to, v); }
  friend PlaneRowOf operator+(const PlaneRowOf& a, const PlaneRowOf& b) { return {a.v + b.v}; }
  friend PlaneRowOf operator-(const PlaneRowOf& a, const PlaneRowOf& b) { return {a.v - b.v}; }
  friend PlaneRowOf operator*(double s, const PlaneRowOf& a) { return {Four{s, s, s, s} * a.v}; }
};
#endif

template <int L>
struct PlaneLanes {
  using Row = PlaneRowOf<L>;

  /// PlaneSolver: adds what a row does in its state, `times` over, to the equations of its bricks.
  static void add_row(const PlaneRow& row, bool convex, double times, const PlaneSystem& to) {
    if (!row.state.pressed && row.base == 0.0) return;
    const double *normal_a = numbers<L>(row.normal_a), *normal_b = numbers<L>(row.normal_b);
    const double *tangent_a = numbers<L>(row.tangent_a), *tangent_b = numbers<L>(row.tangent_b);
    const Place place(row, to);
    const bool on_cone = convex && row.base == 0.0;
    double bias = row.bias + (on_cone ? row.friction * row.lagged_slip : 0.0);
    double stiffness = times * row.normal_stiffness;
    if (row.state.grip == Grip::stick) {
      const double along = times * row.tangent_stiffness;
      place.add(along, tangent_a, tangent_b, tangent_a, tangent_b);
      place.push(-along * row.tangent_bias, tangent_a, tangent_b);
      if (!row.state.pressed) return;
      place.add(stiffness, normal_a, normal_b, normal_a, normal_b);
      place.push(-stiffness * bias, normal_a, normal_b);
      return;
    }
    // Sliding friction follows the normal impulse, but for a limit that is given.
    const bool given = convex && !on_cone;
    const double sign = row.state.grip == Grip::forward ? 1.0 : -1.0, share = given ? 0.0 : -sign * row.friction;
    if (given) place.push(-sign * times * row.lagged_limit, tangent_a, tangent_b);
    if (!given && row.base > 0.0) place.push(times * share * row.base, tangent_a, tangent_b);
    if (!row.state.pressed && !on_cone) return;
    double force_a[3], force_b[3];
    for (std::size_t i = 0; i < 3; ++i) {
      force_a[i] = normal_a[i] + share * tangent_a[i];
      force_b[i] = normal_b[i] + share * tangent_b[i];
    }
    if (on_cone) {
      stiffness = times * row.edge_stiffness;
      bias += share * row.tangent_bias;
    }
    place.push(-stiffness * bias, force_a, force_b);
    place.add(stiffness, force_a, force_b, on_cone ? force_a : normal_a, on_cone ? force_b : normal_b);
  }
  /// All of them, once over.
  static void add_rows(const PlaneRow* rows, std::size_t count, bool convex, const PlaneSystem& to) {
    for (std::size_t k = 0; k < count; ++k) add_row(rows[k], convex, 1.0, to);
  }

  /// BlockEnvelope::factorise().
  static bool factorise(const PlaneFactors& of, std::size_t from) {
    for (std::size_t i = from; i < of.count; ++i) {
      const auto first = static_cast<std::size_t>(of.first[i]);
      PlaneBlock pivot = of.diagonal[i];
      for (std::size_t j = first; j < i; ++j) {
        PlaneBlock &left = of.l[of.offset[i] + j], &above = of.u[of.offset[i] + j];
        left = of.lower[of.offset[i] + j];
        above = of.upper[of.offset[i] + j];
        const auto theirs = static_cast<std::size_t>(of.first[j]);
        for (std::size_t k = first < theirs ? theirs : first; k < j; ++k) {
          subtract(above, of.l[of.offset[j] + k], of.u[of.offset[i] + k]);
          subtract(left, of.l[of.offset[i] + k], of.u[of.offset[j] + k]);
        }
        multiply(left, of.inverse[j]);
        subtract(pivot, left, above);
      }
      if (!invert(pivot, of.inverse[i])) return false;
    }
    return true;
  }

  /// BlockEnvelope::solve(); three numbers a brick.
  static void solve(const PlaneFactors& of, const double* right, std::size_t from, double* x) {
    for (std::size_t i = from; i < of.count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) of.forward[3 * i + k] = right[3 * i + k];
      for (auto j = static_cast<std::size_t>(of.first[i]); j < i; ++j)
        subtract(of.forward + 3 * i, of.l[of.offset[i] + j], of.forward + 3 * j);
    }
    for (std::size_t k = 0; k < 3 * of.count; ++k) x[k] = of.forward[k];
    for (std::size_t i = of.count; i-- > 0;) {
      double y[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const double* row = of.inverse[i].row[k];
        y[k] = 0.0 + row[0] * x[3 * i] + row[1] * x[3 * i + 1] + row[2] * x[3 * i + 2];
      }
      for (std::size_t k = 0; k < 3; ++k) x[3 * i + k] = y[k];
      for (auto j = static_cast<std::size_t>(of.first[i]); j < i; ++j) subtract(x + 3 * j, of.u[of.offset[i] + j], y);
    }
  }

 private:
  // Where a point's bricks have their equations.
  struct Place {
    Place(const PlaneRow& row, const PlaneSystem& to) {
      const auto a = static_cast<std::size_t>(row.a);
      own_a = to.diagonal + a;
      right_a = to.right + 3 * a;
      if (row.b < 0) return;
      const auto b = static_cast<std::size_t>(row.b);
      own_b = to.diagonal + b;
      right_b = to.right + 3 * b;
      a_by_b = a < b ? to.upper + (to.offset[b] + a) : to.lower + (to.offset[a] + b);
      b_by_a = a < b ? to.lower + (to.offset[b] + a) : to.upper + (to.offset[a] + b);
    }
    // Adds scale force (rate . v).
    void add(double scale, const double* force_a, const double* force_b, const double* of_a, const double* of_b) const {
      const Row rate_a = Row::of(of_a);
      add_outer(*own_a, scale, force_a, rate_a);
      if (own_b == nullptr) return;
      const Row rate_b = Row::of(of_b);
      add_outer(*own_b, scale, force_b, rate_b);
      add_outer(*a_by_b, scale, force_a, rate_b);
      add_outer(*b_by_a, scale, force_b, rate_a);
    }
    void push(double impulse, const double* on_a, const double* on_b) const {
      for (std::size_t i = 0; i < 3; ++i) right_a[i] += impulse * on_a[i];
      if (own_b == nullptr) return;
      for (std::size_t i = 0; i < 3; ++i) right_b[i] += impulse * on_b[i];
    }
    static void add_outer(PlaneBlock& out, double scale, const double* force, const Row& rate) {
      for (std::size_t i = 0; i < 3; ++i) (Row::load(out.row[i]) + (scale * force[i]) * rate).store(out.row[i]);
    }

    PlaneBlock *own_a, *own_b = nullptr, *a_by_b = nullptr, *b_by_a = nullptr;
    double *right_a, *right_b = nullptr;
  };

  // c -= a b
  static void subtract(PlaneBlock& c, const PlaneBlock& a, const PlaneBlock& b) {
    const Row b0 = Row::load(b.row[0]), b1 = Row::load(b.row[1]), b2 = Row::load(b.row[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      const double* by = a.row[i];
      (Row::load(c.row[i]) - by[0] * b0 - by[1] * b1 - by[2] * b2).store(c.row[i]);
    }
  }

  // a becomes a b.
  static void multiply(PlaneBlock& a, const PlaneBlock& b) {
    const Row b0 = Row::load(b.row[0]), b1 = Row::load(b.row[1]), b2 = Row::load(b.row[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      const double* by = a.row[i];
      (Row::zero() + by[0] * b0 + by[1] * b1 + by[2] * b2).store(a.row[i]);
    }
  }

  // y -= a x
  static void subtract(double* y, const PlaneBlock& a, const double* x) {
    for (std::size_t k = 0; k < 3; ++k) y[k] = y[k] - a.row[k][0] * x[0] - a.row[k][1] * x[1] - a.row[k][2] * x[2];
  }

  // By cofactors. False if the determinant is zero or not a number.
  static bool invert(const PlaneBlock& of, PlaneBlock& out) {
    const double *a = of.row[0], *b = of.row[1], *c = of.row[2];
    const double c0 = b[1] * c[2] - b[2] * c[1], c1 = b[2] * c[0] - b[0] * c[2], c2 = b[0] * c[1] - b[1] * c[0];
    const double determinant = a[0] * c0 + a[1] * c1 + a[2] * c2;
    if (!(__builtin_fabs(determinant) > 0.0)) return false;
    const double s = 1.0 / determinant;
    // Whole rows at once: what follows loads them so, and would wait for single numbers.
    Row::made(s * c0, s * (a[2] * c[1] - a[1] * c[2]), s * (a[1] * b[2] - a[2] * b[1])).store(out.row[0]);
    Row::made(s * c1, s * (a[0] * c[2] - a[2] * c[0]), s * (a[2] * b[0] - a[0] * b[2])).store(out.row[1]);
    Row::made(s * c2, s * (a[1] * c[0] - a[0] * c[1]), s * (a[0] * b[1] - a[1] * b[0])).store(out.row[2]);
    return true;
  }
};

}  // namespace topple::rigid

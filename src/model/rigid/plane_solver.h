/// Contact impulses of bricks that move in one plane, all at once: Newton's method on the chain.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "model/rigid/block_envelope.h"
#include "model/rigid/plane_contact.h"

namespace topple::rigid {

/// J of the velocity along (x, z) of a point of a body, at an arm from its centre.
inline Column<3> rate(double x, double z, double arm_x, double arm_z) { return {x, z, x * arm_z - z * arm_x}; }
inline double product_of(const Column<3>& j, const PlaneVec& v) { return j[0] * v.x + j[1] * v.z + j[2] * v.turn; }

/// What a point's friction does.
enum class Grip : std::uint8_t { stick, forward, backward };  ///< Stick, or slide along or against the tangent.

/// Within one of these everything is linear.
struct PointState {
  bool pressed = true;  ///< Whether the normal impulse is above zero.
  Grip grip = Grip::stick;
};

/// One contact point. Velocities of the point are J v of its two bodies; an impulse acts on them by the transpose.
struct PlaneRow {
  int a = 0;
  int b = -1;  ///< -1: the floor or a brick that does not move.
  int touch = 0;
  int point = 0;
  Column<3> normal_a{}, normal_b{};    ///< J of the normal velocity.
  Column<3> tangent_a{}, tangent_b{};  ///< J of the tangential velocity.
  double bias = 0.0;                   ///< Added to the normal velocity before it is held at or above zero [m/s].
  double tangent_bias = 0.0;           ///< [m/s]
  double normal_stiffness = 0.0;       ///< Impulse per velocity that is left: 1 / compliance [kg].
  double tangent_stiffness = 0.0;      ///< [kg]
  double friction = 0.0;
  double base = 0.0;     ///< Normal impulse that has been applied already and counts for friction [N s].
  double normal = 0.0;   ///< Impulse found [N s].
  double tangent = 0.0;  ///< [N s]
  PointState state;      ///< The guess, then the truth.
  // Of one round of the convex problem.
  double lagged_slip = 0.0;     ///< Speed at which it slid before [m/s].
  double lagged_limit = 0.0;    ///< The limit of its friction, for rows with a base [N s].
  double edge_stiffness = 0.0;  ///< Along an edge of the cone [kg].
};

/// How fast its two surfaces part and slide, the bias included [m/s].
struct PlaneSlip {
  double normal = 0.0, tangent = 0.0;
};

/// A body that moves: its mass, and its velocity before and after.
struct PlaneUnknown {
  double mass = 0.0;     ///< [kg]
  double inertia = 0.0;  ///< [kg m^2]
  PlaneVec velocity;
  PlaneVec guess;  ///< Of the velocity after.
};

/// The law of Coulomb and Signorini, with so little compliance that it is felt only where there are more points than needed: those share
/// their load in one way. In a plane every point is in one of a few states within which all is linear, so Newton's method ends exactly
/// when the states that come out are those that went in: mostly after one solution. Where eight do not settle it, the states change one by
/// one along a path that leads from slips that agree with them to those that the equations give [Katzenelson1965]. Where that turns back,
/// a convex problem is solved whose friction lets sliding points part as fast as they slide, less what they slid before [Castro2022]: that
/// always succeeds, by Newton's method with an exact line search; where nothing slides it is the true law, and elsewhere it finds the
/// states.
class PlaneSolver {
 public:
  explicit PlaneSolver(const LaneKernels& kernels) : kernels_(kernels), matrix_(kernels) {}
  /// Of the states that the rows hold: from a poor guess all that are wrong change together at first, from a good one only the worst.
  enum class Guess : std::uint8_t { good, poor };
  /// Overwrites the velocities with those after all impulses, and the rows with the impulses.
  void solve(std::span<PlaneUnknown> bodies, std::span<PlaneRow> rows, Guess guess = Guess::good);

 private:
  enum class Law : std::uint8_t { true_law, convex };
  void shape(std::size_t count, std::span<const PlaneRow> rows);
  void assemble(std::span<const PlaneUnknown> bodies, std::span<const PlaneRow> rows, Law law);
  bool solve_system(std::size_t from);
  std::size_t change(PlaneRow& row, const PointState& state);
  bool find_wrong(std::span<PlaneRow> rows);
  std::size_t change_wrong(std::span<PlaneRow> rows, double share);
  bool settle_truly(std::span<const PlaneUnknown> bodies, std::span<PlaneRow> rows, Guess guess);
  void begin_path(std::span<PlaneRow> rows);
  bool follow_path(std::span<PlaneRow> rows);
  void solve_convex(std::span<const PlaneUnknown> bodies, std::span<PlaneRow> rows);
  double best_share(std::span<const PlaneUnknown> bodies, std::span<const PlaneRow> rows);

  const LaneKernels& kernels_;
  std::vector<int> first_;
  BlockEnvelope matrix_;
  std::vector<Column<3>> velocity_, right_, before_, change_, convex_;
  std::vector<PlaneRow> kept_;
  std::vector<PointState> should_;
  std::vector<double> wrong_, most_wrong_;
  std::vector<PlaneSlip> held_, wanted_;  // On the path, and where it leads.
  struct Way {
    double normal, tangent;                // Where a search begins [m/s]...
    double change_normal, change_tangent;  // ...and how that changes over its whole way.
  };
  std::vector<Way> ways_;
};

/// The part of a point's slip that velocities make.
inline PlaneSlip rate_of(const PlaneRow& row, std::span<const Column<3>> velocity) {
  const auto product = [](const Column<3>& j, const Column<3>& v) { return j[0] * v[0] + j[1] * v[1] + j[2] * v[2]; };
  const Column<3>& a = velocity[static_cast<std::size_t>(row.a)];
  PlaneSlip slip{product(row.normal_a, a), product(row.tangent_a, a)};
  if (row.b >= 0) {
    const Column<3>& b = velocity[static_cast<std::size_t>(row.b)];
    slip.normal += product(row.normal_b, b);
    slip.tangent += product(row.tangent_b, b);
  }
  return slip;
}

inline PlaneSlip slip_of(const PlaneRow& row, std::span<const Column<3>> velocity) {
  const PlaneSlip rate = rate_of(row, velocity);
  return {row.bias + rate.normal, row.tangent_bias + rate.tangent};
}

}  // namespace topple::rigid

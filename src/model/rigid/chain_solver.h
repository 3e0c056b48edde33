/// Contact impulses of bricks with six degrees of freedom, all at once: Newton's method on the graph of bricks that touch.
#pragma once

#include <span>
#include <vector>

#include "model/rigid/block_envelope.h"
#include "model/rigid/body_order.h"
#include "model/rigid/contact_row.h"

namespace topple::rigid {

/// Velocities of a body.
struct Twist {
  Vec3 velocity;  ///< [m/s]
  Vec3 spin;      ///< World axes [rad/s].
};

/// The law of Coulomb and Signorini in space, with so little compliance that it is felt only where there are more points than needed: those
/// share their load in one way. A point is open, sticks or slides; within these states all is linear but the way a point slides, which
/// is linearised about the last one [Alart1991]. Along a wave the states and ways of the last step are nearly those of this one, so some
/// six systems of equations are solved where sweeps would need hundreds of rounds. It may fail to settle: then it says so.
class ChainSolver {
 public:
  /// `bodies` come with the velocities that they would have without contact; `guess` is near what they will have. If it settles, to
  /// `tolerance` [m/s], bodies have their velocities and rows their impulses afterwards; if not, the
  /// bodies are as they were and the rows hold the best impulses found, a guess for another method.
  bool solve(std::span<Body> bodies, std::span<ContactRow> rows, std::span<const Twist> guess, double tolerance);

 private:
  /// A row's state and the way it slides, as the system of equations has it.
  struct Assumed {
    ContactState state;
    Vec3 way;             // Unit, the way it slides.
    bool coupled = true;  // Its friction follows its normal impulse; else it is...
    double limit = 0.0;   // ...this [N s].
    double drag = 0.0;    // Impulse per velocity across that way [kg].
    Vec3 impulse;         // That follows from the velocities found, by the true law [N s].
    double n = 0.0;
    ContactState should;
    Vec3 should_way;
    double should_limit = 0.0, should_drag = 0.0;
    double wrong = 0.0;   // By how much the state is wrong [m/s].
    bool turned = false;  // It slides another way than assumed.
  };
  void begin(std::span<const Body> bodies, std::span<const ContactRow> rows, std::span<const Twist> guess);
  void add(const ContactRow& row, const Assumed& as, double times);
  bool solve_system(std::size_t from);
  static void settle_row(const ContactRow& row, const Vec3& slip, double tolerance, Assumed& as);
  bool settle(std::span<const ContactRow> rows, double tolerance);
  std::size_t change(std::span<const ContactRow> rows);

  BodyOrder order_;
  BlockEnvelope<6> matrix_;
  std::vector<Column<6>> right_, velocity_;
  std::vector<Assumed> assumed_;
  struct Impulse {
    double n = 0.0;
    Vec3 friction;
  };
  std::vector<Impulse> best_;
  std::vector<double> most_wrong_;
};

}  // namespace topple::rigid

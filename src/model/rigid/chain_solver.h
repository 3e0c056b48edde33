/// Contact impulses of bricks with six degrees of freedom, all at once: Newton's method on the graph of bricks that touch.
#pragma once

#include <span>
#include <vector>

#include "model/rigid/body_order.h"
#include "model/rigid/brick_matrix.h"
#include "model/rigid/lane_kernels.h"

namespace topple::rigid {

/// The law of Coulomb and Signorini in space, with so little compliance that it is felt only where there are more points than needed: those
/// share their load in one way. A point is open, sticks or slides; within these states all is linear but the way a point slides, which
/// is linearised about the last one [Alart1991]. It may fail to settle: then it says so.
class ChainSolver {
 public:
  explicit ChainSolver(const LaneKernels& kernels) : kernels_(kernels) {}
  /// In which order bodies are eliminated follows from who touches whom; once for all solutions with the same rows.
  void begin(std::span<const ContactRow> rows, std::span<const Body> bodies);
  /// From the states that the rows hold; the way that a point slides follows from `guess`, what velocities will be near. If it settles, to
  /// `tolerance` [m/s], in `most` systems of equations, `velocity` (of all bodies, without contact before) and rows hold the
  /// solution; if not, the rows hold the best impulses found.
  bool solve(std::span<ContactRow> rows, std::span<const Velocity> guess, double tolerance, int most, std::span<Velocity> velocity);

  std::size_t body_count() const { return order_.bodies().size(); }
  const BodyOrder& order() const { return order_; }

 private:
  /// A row's state and the way it slides, as the system of equations has it.
  struct Assumed {
    std::size_t entry = 0;  // Of both its bricks, in the matrix.
    ContactState state;
    double way_along = 0.0, way_across = 0.0;  // Unit, the way it slides.
    bool coupled = true;                       // Its friction follows its normal impulse; else it is...
    double limit = 0.0;                        // ...this [N s].
    double drag = 0.0;                         // Impulse per velocity across that way [kg].
    PointLaw law;
    Framed impulse{};  // That follows from the velocities found, by the true law [N s].
    ContactState should;
    double should_along = 0.0, should_across = 0.0;
    double should_limit = 0.0, should_drag = 0.0;
    bool pulled = false;  // It stuck, and had to be pulled for that.
    double wrong = 0.0;   // By how much the state is wrong [m/s].
    bool turned = false;  // It slides another way than assumed.
  };
  void assume(std::span<const ContactRow> rows, std::span<const Velocity> guess);
  void assemble(std::span<const ContactRow> rows, std::span<const Velocity> free);
  static PointLaw law_of(const ContactRow& row, const Assumed& as);
  void add(std::size_t k, const ContactRow& row, const PointLaw& law);
  bool solve_system();
  static void settle_row(const ContactRow& row, const Framed& slip, double tolerance, Assumed& as);
  bool settle(std::span<const ContactRow> rows, double tolerance);
  void keep_best(std::span<const ContactRow> rows);
  void change(std::span<const ContactRow> rows);

  const LaneKernels& kernels_;
  BodyOrder order_;
  std::vector<double> mass_;   // Of each number [kg].
  std::vector<Mat3> inertia_;  // [kg m^2]
  BrickMatrix matrix_;
  std::vector<Velocity> right_, velocity_;
  std::vector<Assumed> assumed_;
  std::vector<PointEnds> ends_;  // Of each row.
  std::vector<Framed> slips_;    // By the velocities found [m/s].
  std::vector<Framed> best_;
  double least_wrong_ = 0.0;
  std::vector<double> most_wrong_;
};

}  // namespace topple::rigid

/// What a contact point does in its state, as the equations of its bricks have it.
#pragma once

#include "model/rigid/brick_matrix.h"

namespace topple::rigid {

/// Its impulse on a is -(k slip + rest), k by rows; the normal needs no more than its own slip.
struct PointLaw {
  double nn = 0.0, an = 0.0, cn = 0.0, aa = 0.0, ac = 0.0, cc = 0.0;  // n: normal, a: along, c: across [kg].
  double rest_along = 0.0, rest_across = 0.0;                         // [N s]
};

/// Its bricks' numbers; -1: none, or one that does not move.
struct PointEnds {
  int a = -1, b = -1;
};

/// Where the equations of its bricks are. Null: none, or a brick that does not move.
struct PointEquations {
  BrickBlock *own_a = nullptr, *own_b = nullptr;    ///< The coupling of a brick's impulses to its own velocities...
  BrickBlock *a_by_b = nullptr, *b_by_a = nullptr;  ///< ...and to the other one's.
  double *right_a = nullptr, *right_b = nullptr;    ///< Six numbers each.
};

}  // namespace topple::rigid

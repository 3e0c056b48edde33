/// What is solved for bricks that move in one plane, as the kernels have it.
#pragma once

#include <cstddef>

#include "model/rigid/small_block.h"

namespace topple::rigid {

/// A matrix of BlockEnvelope and its factors.
struct PlaneFactors {
  std::size_t count = 0;
  const int* first = nullptr;
  const std::size_t* offset = nullptr;
  const PlaneBlock *lower = nullptr, *upper = nullptr, *diagonal = nullptr;
  PlaneBlock *l = nullptr, *u = nullptr, *inverse = nullptr;
  double* forward = nullptr;  ///< Three numbers a brick.
};

/// The system of equations that contact points are added to.
struct PlaneSystem {
  const std::size_t* offset = nullptr;  ///< As of PlaneFactors.
  PlaneBlock *lower = nullptr, *upper = nullptr, *diagonal = nullptr;
  double* right = nullptr;  ///< Three numbers a brick.
};

}  // namespace topple::rigid

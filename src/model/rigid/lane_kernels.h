/// The inner loops of the contact solver for 1, 2 and 4 numbers side by side: the same bits, chosen when a run begins.
#pragma once

#include <cstddef>
#include <string>

#include "model/rigid/contact_row.h"
#include "model/rigid/plane_law.h"
#include "model/rigid/point_law.h"

namespace topple::rigid {

struct PlaneRow;

/// One entry a stage of a solution, so that what is chosen once is called seldom.
struct LaneKernels {
  int lanes = 0;
  // SweepLanes.
  void (*apply_all)(const ContactRow* rows, std::size_t count, double* velocity);
  double (*first_sweep)(ContactRow* rows, int* order, std::size_t count, double* velocity);
  double (*sweep)(ContactRow* rows, const int* order, std::size_t count, bool backwards, double* velocity);
  double (*sweep_cones)(ContactRow* rows, std::size_t count, bool backwards, double* velocity);
  // PointLanes.
  void (*slips)(const ContactRow* rows, const PointEnds* ends, std::size_t count, const double* velocity, double* slip);
  void (*add_law)(const ContactRow& row, const PointLaw& law, const PointEquations& to);
  // CouplingLanes.
  void (*couple)(ContactRow& row, const Body& a, const Body* b);
  // BrickLanes.
  bool (*solve)(BrickRow* rows, std::size_t count, BrickEntry* entries, const double* right, double* x);
  // PlaneLanes.
  void (*add_row)(const PlaneRow& row, bool convex, double times, const PlaneSystem& to);
  void (*add_rows)(const PlaneRow* rows, std::size_t count, bool convex, const PlaneSystem& to);
  bool (*factorise_plane)(const PlaneFactors& of, std::size_t from);
  void (*solve_plane)(const PlaneFactors& of, const double* right, std::size_t from, double* x);
};

/// Whether this processor has what four lanes need, and they are compiled for it.
bool has_four_lanes();

/// For so many lanes, 0: as many as the processor has. Null if it has not so many, or there is no such number.
/// Four: whether it has four; asked as an argument, so that a test can be a processor without them.
const LaneKernels* lane_kernels(int lanes, bool four = has_four_lanes());

/// Why there are no kernels for so many lanes.
std::string no_such_lanes(int lanes, bool four = has_four_lanes());

}  // namespace topple::rigid

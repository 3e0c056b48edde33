/// All kernels of one number of lanes; for the units lanes_*.cpp alone.
#pragma once

#include "model/rigid/lane_kernels.h"
#include "model/rigid/plane_lanes.h"
#include "model/rigid/point_lanes.h"
#include "model/rigid/sweep_lanes.h"

namespace topple::rigid {

template <int L>
inline constexpr LaneKernels kKernels = {.lanes = L,
                                         .apply_all = SweepLanes<L>::apply_all,
                                         .first_sweep = SweepLanes<L>::first_sweep,
                                         .sweep = SweepLanes<L>::sweep,
                                         .sweep_cones = SweepLanes<L>::sweep_cones,
                                         .slips = PointLanes<L>::slips,
                                         .add_law = PointLanes<L>::add_law,
                                         .couple = CouplingLanes<L>::couple,
                                         .solve = BrickLanes<L>::solve,
                                         .add_row = PlaneLanes<L>::add_row,
                                         .add_rows = PlaneLanes<L>::add_rows,
                                         .factorise_plane = PlaneLanes<L>::factorise,
                                         .solve_plane = PlaneLanes<L>::solve};

}  // namespace topple::rigid

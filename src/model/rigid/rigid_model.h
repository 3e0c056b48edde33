/// Level 3: six degrees of freedom, contact, friction, restitution, a wave front.
#pragma once

#include <memory>

#include "topple/model.h"

namespace topple::rigid {

/// Refuses a layout in words: a time step that is too long for its bricks.
Result<std::unique_ptr<Model>> make_rigid_model(const Layout& layout, const RigidConfig& config);

/// The default time step of a layout [s]: a share of sqrt(height / gravity) of its smallest brick.
double default_time_step(const Layout& layout);

}  // namespace topple::rigid

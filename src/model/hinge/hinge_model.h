/// Level 2: the cooperative chain. Every brick turns about its toe, leaning bricks push as a group.
#pragma once

#include <memory>

#include "topple/model.h"

namespace topple::hinge {

/// Refuses, in words, what a chain of hinges cannot do. The layout must outlive the model.
Result<std::unique_ptr<Model>> make_hinge_model(const Layout& layout, const HingeConfig& config);

/// HingeConfig's time step, for the smallest brick and the gravity of a layout [s].
double default_time_step(const Layout& layout);

}  // namespace topple::hinge

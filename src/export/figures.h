/// One function a figure.
#pragma once

#include <filesystem>
#include <span>

#include "topple/export.h"

namespace topple {

/// Angle, angular velocity and angular acceleration of bricks, one above the other on one time axis.
Result<void> plot_motion(const Recording& recording, std::span<const BrickId> bricks, const std::filesystem::path& path);

/// When the wave came to each brick of the trunk.
Result<void> plot_arrival(const Recording& recording, const std::filesystem::path& path);

/// How fast the wave was near each brick of the trunk.
Result<void> plot_speed(const Recording& recording, const std::filesystem::path& path);

/// Kinetic and potential energy, their sum, and the work of the pushes.
Result<void> plot_energy(const Recording& recording, const std::filesystem::path& path);

}  // namespace topple

// What every peer engine does here: the same bricks, pushed and timed the same way.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace peers {

/// Where a brick stands, in the units of the engine: lengths times `scale`, times its square root.
struct Brick {
  double x = 0.0, y = 0.0, z = 0.0;  ///< Centre of its foot.
  double heading = 0.0;              ///< [rad]
};

/// All lengths, masses and times as the engine gets them.
struct Scene {
  double height = 0.0, width = 0.0, thickness = 0.0;
  double gravity = 9.81;
  double time_step = 0.0;
  double brick_friction = 0.2, floor_friction = 0.5;  ///< Of the pairs brick-brick and brick-floor.
  bool sleeps = true;                                 ///< Whether an engine may let bodies sleep.
  std::vector<Brick> bricks;
  std::vector<std::size_t> rows;  ///< Index of the first brick of each row, and the number of all bricks: the wave runs along each.
};

/// An engine's world. Bricks are put in and taken out by their index in the scene.
class World {
 public:
  virtual ~World() = default;
  virtual void add(std::size_t index) = 0;
  virtual void remove(std::size_t index) = 0;
  virtual void turn_about_toe(std::size_t index, double angular_speed) = 0;  ///< Sets both velocities.
  virtual void step() = 0;
  virtual double upright(std::size_t index) const = 0;  ///< Cosine of its tilt.
  virtual std::array<double, 3> middle(std::size_t index) const = 0;
};

/// What an adapter is.
struct Engine {
  std::string name;
  std::string version;
  double scale = 1.0;  ///< Lengths in the engine over true lengths: most are made for metres.
  bool planar = false;
  std::unique_ptr<World> (*make)(const Scene& scene) = nullptr;
};

/// Reads the command line and the bricks, runs, prints one JSON object. See peer.cpp.
int run(int argc, char** argv, const Engine& engine);

}  // namespace peers

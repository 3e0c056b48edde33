/// A model: the one interface of all physics. Built from a Layout that it never changes; owns all that moves.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "topple/layout.h"

namespace topple {

enum class Phase : std::uint8_t { standing, falling, resting };
/// "standing": the word for it in tables and for programs.
constexpr std::string_view name_of(Phase phase) {
  return std::array<std::string_view, 3>{"standing", "falling", "resting"}[static_cast<std::size_t>(phase)];
}

/// A brick that turns about its toe or heel: one angle.
struct HingedState {
  double angle = 0.0;         ///< Tilt; > 0 about the toe, < 0 about the heel [rad].
  double rate = 0.0;          ///< [rad/s]
  double acceleration = 0.0;  ///< [rad/s^2]
};
struct HingedMotion {
  BrickId brick = kNoBrick;
  Phase phase = Phase::standing;
  HingedState state;
};
/// A brick that moves freely.
struct FreeMotion {
  BrickId brick = kNoBrick;
  Phase phase = Phase::standing;
  Pose pose;
  Vec3 velocity;          ///< Of the centre of mass [m/s].
  Vec3 angular_velocity;  ///< In world axes [rad/s].
};
/// A moment since a hinged brick was last in a frame at which its rate or its acceleration jumped (a hit, a landing, a push). In a frame
/// that is `curved` also a moment on its way at which nothing jumped.
struct Kink {
  BrickId brick = kNoBrick;
  double time = 0.0;  ///< [s]
  HingedState before, after;
};

/// A brick that came to rest after it moved as another one did, only at another time and elsewhere; none of it has been told.
struct Echo {
  BrickId brick = kNoBrick;
  BrickId like = kNoBrick;
  double start = 0.0;       ///< When it began to move [s].
  double like_start = 0.0;  ///< When the other one did [s].
};

/// Where a brick was that has moved for some steps without being in their frames. The first of a brick is the moment before it moved.
struct UnseenMotion {
  double time = 0.0;  ///< [s]
  FreeMotion motion;
};

struct Energy {
  double kinetic = 0.0;    ///< [J]
  double potential = 0.0;  ///< Against all bricks as put down [J].
  double push_work = 0.0;  ///< Put in by pushes so far [J].
};

/// The bricks that moved in the last step. One whose motion follows from others may be left out of some frames while it moves; one that
/// comes to rest is in the frame of that step, with its phase. A model fills `hinged` or `free`; the buffers are reused from step to step.
struct Frame {
  double time = 0.0;  ///< [s]
  std::vector<HingedMotion> hinged;
  std::vector<FreeMotion> free;
  std::vector<Kink> kinks;  ///< In the order of their times for each brick.
  std::vector<Echo> echoes;
  std::vector<BrickId> echoed;       ///< Bricks that later echoes will be like.
  std::vector<UnseenMotion> unseen;  ///< In the order of their times for each brick, all before `time`.
  Energy energy;
  /// Set by the model: the kinks tell the whole motion. From one kink of a hinged brick to its next, or to its state in `hinged`, its angle
  /// is the quintic Hermite polynomial of both ends, within a ten-thousandth of its thickness at any corner.
  bool curved = false;
  // Set by the reader.
  bool energy_wanted = true;  ///< Where it is false a model may leave `energy` as it was.
  bool last = false;  ///< Nothing is read after this: `kinks` are those that a model has not told yet since an echo might do for them.
  bool states_wanted = true;  ///< Where it is false and the frame is curved, `hinged` may have those alone that came to rest.
};

enum class EventKind : std::uint8_t {
  pushed,   ///< A push began.
  struck,   ///< `brick` was hit by `by` while it stood (or rested).
  arrived,  ///< Its tilt passed 10 degrees for the first time: the wave is here.
  landed,   ///< Its fall was stopped by the floor (`by` = none) or by brick `by`, on which it leans from then on.
  missed,   ///< It fell flat without reaching the next brick of its part.
  rested    ///< It came to rest.
};
/// "pushed": the word for it in tables and for programs.
constexpr std::string_view name_of(EventKind kind) {
  return std::array<std::string_view, 6>{"pushed", "struck", "arrived", "landed", "missed", "rested"}[static_cast<std::size_t>(kind)];
}
inline constexpr double kArrivalTilt = 0.17453292519943295;  ///< 10 degrees [rad].

/// Something that happened inside the last step, at its time.
struct Event {
  double time = 0.0;  ///< [s]
  EventKind kind = EventKind::pushed;
  BrickId brick = kNoBrick;
  BrickId by = kNoBrick;
  double force = 0.0;    ///< [N]; not a number where the model has none.
  double impulse = 0.0;  ///< [N s]; not a number where the model has none.
  Vec3 point;            ///< Where, in the world [m]; not a number where there is none.
};

/// A point where a brick that moves and another one, or the floor, press on each other at the end of the last step. What passes at once,
/// in a blow, is an Event.
struct Contact {
  BrickId a = kNoBrick;
  BrickId b = kNoBrick;  ///< kNoBrick: the floor.
  Vec3 point;            ///< [m]
  Vec3 force;            ///< On a, friction included [N].
};

enum class Progress : std::uint8_t { running, at_rest, not_finite };
struct Status {
  Progress progress = Progress::running;
  BrickId brick = kNoBrick;  ///< The brick whose numbers are not finite.
};

class Model {
 public:
  virtual ~Model() = default;
  virtual Status step() = 0;                          ///< Advances by exactly one time step.
  virtual std::int64_t step_count() const = 0;        ///< Time is step_count x time_step.
  virtual double time_step() const = 0;               ///< [s]
  virtual void read(Frame& out) const = 0;            ///< What moved in the last step, and the energy.
  virtual std::span<const Event> events() const = 0;  ///< Of the last step, in the order of their times.
  virtual std::span<const Contact> contacts()
      const = 0;  ///< At the end of the last step, of what was computed in it; none where the model has no forces.
  /// Chained over all steps: ids, poses, velocities. Those of `rigid` are in the frame and the units of the run, so that one layout has
  /// one hash wherever, however and however large it lies.
  virtual std::uint64_t hash() const = 0;
};

// ---- Level 1: the report's model ----

enum class Integrator : std::uint8_t { euler, semi_implicit, rk4 };
enum class InertiaRule : std::uint8_t {
  report,  ///< m (H^2 + T^2) / 12, as the report prints it (2.4): about the centre of mass.
  pivot    ///< m (H^2 + T^2) / 3: about the toe, which is what turns.
};
enum class HitRule : std::uint8_t {
  momentum,  ///< (1 + e) / 2 of the hitter's angular velocity goes over.
  report,    ///< (2.5): a force for `pulse` seconds.
  same       ///< The push of the first brick again, as in the report's animation.
};

struct PivotConfig {
  // affects results
  double time_step = 0.0005;  ///< [s]
  Integrator integrator = Integrator::euler;
  InertiaRule inertia = InertiaRule::report;
  HitRule hit = HitRule::momentum;
  double pulse = 0.010;  ///< How long the force of a `report` hit acts [s].
};

// ---- Level 2: the cooperative chain ----

struct HingeConfig {
  // affects results
  /// How often the motion is read; events are located inside it, and the wave does not depend on it. This is for bricks of 48 mm; in a
  /// layout file it follows the smallest brick, as the square root of height over gravity [s].
  double time_step = 0.016;
  /// What a brick may still move when it goes to rest, and what the wave may be wrong by for it: a fraction of its thickness.
  double rest_tolerance = 0.002;
  // affects speed only
  bool repeats = true;  ///< In an even row, a hit that leaves everything as the last one did is not computed again, nor is what follows.
};

// ---- Level 3: bricks that move freely ----

struct RigidConfig {
  // affects results
  double time_step = 0.0;  ///< 0: a share of sqrt(height / gravity) of the smallest brick [s].
  /// No brick stands or rests: every one is stepped from the beginning on, and the run never ends by itself. For tests of structures.
  bool every_brick_moves = false;
  // affects speed only
  bool repeats = true;         ///< In an even row, what follows a strike as it followed the one before is not computed again.
  int lanes = 0;               ///< Numbers side by side in the contact solver: 1, 2 or 4; 0: as many as the processor has.
  Crew* crew = nullptr;        ///< Null: the calling thread alone. A run sets it.
  Profile* profile = nullptr;  ///< Null: nobody asks. A run sets it.
};

/// Choosing the config chooses the model.
using ModelConfig = std::variant<PivotConfig, HingeConfig, RigidConfig>;

}  // namespace topple

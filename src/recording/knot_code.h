/// How knots are kept in memory: as whole multiples of a small step each, the differences from knot to knot in as few bytes
/// as they need. A million bricks have some thirty million knots; as floats alone they would take half a gigabyte.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "topple/recording.h"

namespace topple {

/// The steps of a rounded knot, powers of two so that a float has each multiple exactly. At the default tolerance they are less than
/// a hundredth of what a knot may be off; finer tolerances keep their floats as they are.
struct KnotSteps {
  static constexpr double kTime = 0x1p-22;          ///< [s]
  static constexpr double kAngle = 0x1p-20;         ///< [rad]
  static constexpr double kRate = 0x1p-9;           ///< [rad/s]
  static constexpr double kAcceleration = 0x1p-3;   ///< [rad/s^2]
  static constexpr double kFinestTolerance = 1e-4;  ///< Of an angle [rad].
};

/// The same for a free knot.
struct FreeSteps {
  static constexpr double kTime = 0x1p-22;             ///< [s]
  static constexpr double kPlace = 0x1p-24;            ///< [m]
  static constexpr double kTurn = 0x1p-21;             ///< Of a part of the quaternion.
  static constexpr double kVelocity = 0x1p-13;         ///< [m/s]
  static constexpr double kRate = 0x1p-9;              ///< [rad/s]
  static constexpr double kFinestTolerance = 0x1p-18;  ///< Of a corner's place [m].
  static constexpr double kFinestTurn = 0x1p-14;       ///< The same, over the distance of the corner from the centre of mass.
};

/// The nearest multiple of `step`, a power of two; for |value| < 2^51 steps.
inline double rounded(double value, double step) {
  constexpr double kShift = 0x1.8p52;  // Adding and subtracting it drops the digits behind the point.
  return (value / step + kShift - kShift) * step;
}

/// Appends the code of a track's knots. Exact: knots that are not multiples of the steps, or move too far, are kept as floats.
void encode(std::span<const HingedKnot> knots, std::vector<std::uint8_t>& out);
void encode(std::span<const FreeKnot> knots, std::vector<std::uint8_t>& out);

/// The last knot of a hinged track, which costs nothing to read: most questions are about where a brick rests. None of a free track.
std::optional<HingedKnot> last_hinged_knot(const std::uint8_t* code);
/// The last knot of a free track, which is read without the others too. None of a hinged track.
std::optional<FreeKnot> last_free_knot(const std::uint8_t* code);

/// Appends to one of the two what encode() made.
void decode(const std::uint8_t* code, std::vector<HingedKnot>& hinged, std::vector<FreeKnot>& free);

}  // namespace topple

/// Tracks as the keyframes of a glTF animation.
#pragma once

#include <span>
#include <vector>

#include "topple/recording.h"

namespace topple {

/// The knots of a hinged track as those of a free one: what lies between them is within `tolerance`, a fraction of the thickness, of the
/// quintic at any corner.
std::vector<FreeKnot> free_knots(const Layout& layout, const Track& hinged, double tolerance);

/// The keyframes of one brick. With tangents each has three values: how it comes in, where it is, how it goes on.
struct Keys {
  std::vector<float> times;   ///< Each after the one before [s].
  std::vector<float> places;  ///< [m], tangents [m/s].
  std::vector<float> turns;   ///< x, y, z, w; tangents [1/s].
};

/// The polynomials of the tracks themselves, for CUBICSPLINE. Between two tracks the brick rests; two knots at one time are one keyframe
/// whose tangents differ.
void curved_keys(const Layout& layout, std::span<const Track> tracks, Keys& out);

/// Where the brick is at every 1/`rate` of a second while it moves, for LINEAR.
void straight_keys(const Layout& layout, std::span<const Track> tracks, double rate, Keys& out);

}  // namespace topple

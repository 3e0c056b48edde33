#include "run/run_end.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/trigonometry.h"
#include "layout/text.h"

namespace topple {

namespace {

/// Tenths, as people read them.
std::string tenths(double value) { return number_text(static_cast<double>(static_cast<std::int64_t>(10.0 * value + 0.5)) / 10.0); }

/// Where a brick came to rest, against where it was put down.
struct Rest {
  double tilt = 0.0;       ///< [rad]
  double tip_angle = 0.0;  ///< [rad]
  double slide = 0.0;      ///< How far the edge on which it turned has moved on the floor [m].
  double along = 0.0;      ///< Its own length in the direction of its heading [m].
};

Rest rest_of(const Recording& recording, BrickId brick) {
  const Layout& layout = recording.layout();
  const Brick& put = layout.bricks[static_cast<std::size_t>(brick)];
  const Extents size = extents(layout.kinds[put.kind], put.stance);
  const Pose before = standing_pose(layout, brick);
  const Pose after = recording.at(brick, std::numeric_limits<double>::infinity()).pose;
  const auto slide_of = [&](double from_foot) {
    const SinCos heading = sin_cos(put.heading);
    const Vec3 edge = put.foot + from_foot * Vec3{heading.cos, heading.sin, 0.0} - before.position;
    const Vec3 moved = after.position + rotate(after.orientation, rotate(conjugate(before.orientation), edge)) - (before.position + edge);
    return norm({moved.x, moved.y, 0.0});
  };
  // It turned about its toe or its heel: the one that moved less.
  const double slide = std::min(slide_of(0.5 * size.along), slide_of(-0.5 * size.along));
  return {tilt(layout, brick, after.orientation), tip_angle(size), slide, size.along};
}

double tip_angle_of(const Layout& layout, BrickId brick) {
  return tip_angle(extents(layout.kind_of(brick), layout.bricks[static_cast<std::size_t>(brick)].stance));
}

/// Whether a brick that the wave has reached (10 degrees) is always past its tip angle, so that nobody need look.
bool all_tip_before_arrival(const Layout& layout) {
  return std::all_of(layout.bricks.begin(), layout.bricks.end(),
                     [&layout](const Brick& brick) { return tip_angle(extents(layout.kinds[brick.kind], brick.stance)) < kArrivalTilt; });
}

/// The last brick that was pushed or struck and rests short of its tip angle.
BrickId last_not_fallen(const Recording& recording) {
  const Layout& layout = recording.layout();
  for (std::int64_t i = recording.event_count() - 1; i >= 0; --i) {
    const Event event = recording.event(i);
    if (event.kind != EventKind::pushed && event.kind != EventKind::struck) continue;
    // What a ball or a structure does is no wave that could die.
    if (const Part* part = layout.part_of(event.brick); part != nullptr && !part->line) continue;
    const double tip = tip_angle_of(layout, event.brick);
    if (std::abs(recording.rest_angle(event.brick)) > tip) continue;  // Nearly all, and not a number is not.
    const Pose rests = recording.at(event.brick, std::numeric_limits<double>::infinity()).pose;
    if (tilt(layout, event.brick, rests.orientation) <= tip) return event.brick;
  }
  return kNoBrick;
}

/// "it slid 14.2 mm and " for a brick whose foot gave way by more than a tenth of its own length along its heading, else "it ".
std::string slide_words(const Rest& rest) {
  return rest.slide > 0.1 * rest.along ? "it slid " + tenths(1000.0 * rest.slide) + " mm and " : "it ";
}

std::string words_of_short_fall(const Rest& rest) {
  constexpr double kStandsAgain = 0.02;  // About a degree [rad].
  if (rest.tilt < kStandsAgain) return slide_words(rest) + "stands again: it was moved too slowly to pass its tip angle";
  constexpr double kDegree = kArrivalTilt / 10.0;
  return slide_words(rest) + "rests at " + tenths(rest.tilt / kDegree) + " degrees, short of its tip angle of " +
         tenths(rest.tip_angle / kDegree);
}

}  // namespace

RunEnd end_at_rest(const Recording& recording, const WaveStory& story) {
  RunEnd end{.reason = EndReason::at_rest, .words = "everything is at rest"};
  if (story.missed != kNoBrick) {
    end.words = slide_words(rest_of(recording, story.missed)) + "fell flat without reaching brick " + std::to_string(story.missed + 1);
    end.brick = story.missed;
  } else if (!(story.everyone_arrived && all_tip_before_arrival(recording.layout()))) {
    end.brick = last_not_fallen(recording);
    if (end.brick != kNoBrick) end.words = words_of_short_fall(rest_of(recording, end.brick));
  }
  if (end.brick == kNoBrick) return end;
  end.reason = EndReason::wave_died;
  end.words = "the wave died at brick " + std::to_string(end.brick) + ": " + end.words;
  return end;
}

}  // namespace topple

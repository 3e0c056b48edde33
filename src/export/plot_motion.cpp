#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "export/figures.h"
#include "export/gnuplot.h"

namespace topple {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kBricksByDefault = 5;  // As many as are told apart at a glance.
constexpr int kPiecesOfTrack = 400;          // A curve of as many straight pieces looks smooth in print.

/// The three curves of one brick, broken where they jump.
struct Motion {
  BrickId brick = kNoBrick;
  std::array<std::vector<Point>, 3> curves;
  std::array<std::vector<Point>, 3> hits;  ///< Just after the brick was struck.
  double end = 0.0;                        ///< When it came to rest [s].

  void add(double time, const HingedState& state) {
    curves[0].push_back({time, state.angle * kDegrees});
    curves[1].push_back({time, state.rate});
    curves[2].push_back({time, state.acceleration});
  }

  /// The rate and the acceleration jump; the angle never does.
  void tear(double time) {
    curves[1].push_back({time, kNan});
    curves[2].push_back({time, kNan});
  }
};

/// How many straight pieces to draw between two knots of a track.
template <typename Knot>
int pieces_between(const Knot& a, const Knot& b, const std::vector<Knot>& knots) {
  const double share = static_cast<double>(b.time - a.time) / static_cast<double>(knots.back().time - knots.front().time);
  return 2 + static_cast<int>(share * kPiecesOfTrack);
}

HingedState state_of(const HingedKnot& knot) { return {knot.angle, knot.rate, knot.acceleration}; }

bool jumps(const HingedState& a, const HingedState& b) {
  constexpr double kSmall = 1e-6;  // Knots are single precision.
  const auto differ = [](double x, double y) { return std::abs(x - y) > kSmall * (1.0 + std::max(std::abs(x), std::abs(y))); };
  return differ(a.rate, b.rate) || differ(a.acceleration, b.acceleration);
}

/// Rate and acceleration between two knots: the cubic that has the rate and the acceleration of both, and its derivative. (The
/// recording's own polynomial is made for the angle: its second derivative turns the small inconsistency of an Euler step, whose
/// angle does not know of the step's acceleration, into waves.) Within a few steps of the model there is nothing to bend.
HingedState between(const HingedKnot& a, const HingedKnot& b, double u, double angle, double time_step) {
  const double span = static_cast<double>(b.time) - static_cast<double>(a.time);
  const HingedState from = state_of(a);
  const HingedState to = state_of(b);
  if (span < 3.0 * time_step) {
    return {angle, std::lerp(from.rate, to.rate, u), std::lerp(from.acceleration, to.acceleration, u)};
  }
  const double c1 = from.acceleration * span;
  const double rise = to.rate - from.rate;
  const double c2 = 3.0 * rise - 2.0 * c1 - to.acceleration * span;
  const double c3 = c1 + to.acceleration * span - 2.0 * rise;
  return {angle, from.rate + u * (c1 + u * (c2 + u * c3)), (c1 + u * (2.0 * c2 + u * 3.0 * c3)) / span};
}

/// A hinged track: its knots say on which side of a jump they are.
void add_hinged(const Recording& recording, const Track& track, Motion& motion) {
  const double time_step = recording.recipe().time_step;
  for (std::size_t i = 0; i < track.hinged.size(); ++i) {
    const HingedKnot& knot = track.hinged[i];
    const double time = track.start + static_cast<double>(knot.time);
    if (i > 0) {
      const HingedKnot& last = track.hinged[i - 1];
      const double before = track.start + static_cast<double>(last.time);
      if (time > before) {
        const int pieces = pieces_between(last, knot, track.hinged);
        for (int piece = 1; piece < pieces; ++piece) {
          const double u = static_cast<double>(piece) / pieces;
          const double when = std::lerp(before, time, u);
          motion.add(when, between(last, knot, u, recording.at(track.brick, when).hinge.angle, time_step));
        }
      } else if (jumps(state_of(last), state_of(knot))) {
        motion.tear(time);
      }
    }
    motion.add(time, state_of(knot));
    motion.end = time;
  }
}

void add_free(const Recording& recording, const Track& track, Motion& motion) {
  for (std::size_t i = 0; i + 1 < track.free.size(); ++i) {
    const double from = track.start + static_cast<double>(track.free[i].time);
    const double to = track.start + static_cast<double>(track.free[i + 1].time);
    const int pieces = to > from ? pieces_between(track.free[i], track.free[i + 1], track.free) : 0;
    for (int piece = 0; piece < pieces; ++piece) {
      const double when = from + (to - from) * piece / pieces;
      motion.add(when, recording.at(track.brick, when).hinge);
    }
    motion.end = to;
  }
}

/// At rest at an angle from one time to another.
void add_rest(Motion& motion, double angle, double from, double to) {
  motion.tear(from);
  motion.add(from, {angle, 0.0, 0.0});
  motion.add(to, {angle, 0.0, 0.0});
}

Motion motion_of(const Recording& recording, BrickId brick) {
  Motion motion;
  motion.brick = brick;
  std::vector<Track> tracks;
  recording.tracks_of(brick, tracks);
  double angle = 0.0;
  for (const Track& track : tracks) {
    if (track.start > motion.end) {
      add_rest(motion, angle, motion.end, track.start);
    }
    motion.tear(track.start);
    track.hinged.empty() ? add_free(recording, track, motion) : add_hinged(recording, track, motion);
    angle = motion.curves[0].empty() ? 0.0 : motion.curves[0].back().y / kDegrees;
  }
  return motion;
}

/// The first bricks that moved, in the order in which they began to.
std::vector<BrickId> first_moved(const Recording& recording) {
  std::vector<BrickId> bricks;
  for (BrickId brick = 0; brick < recording.layout().brick_count() && bricks.size() < kBricksByDefault; ++brick) {
    std::vector<Track> tracks;
    recording.tracks_of(brick, tracks);
    if (!tracks.empty()) {
      bricks.push_back(brick);
    }
  }
  return bricks;
}

/// Where on its curves each brick was when it was struck.
void add_hits(const Recording& recording, std::vector<Motion>& motions, double end) {
  for (std::int64_t i = 0; i < recording.event_count(); ++i) {
    const Event event = recording.event(i);
    if (event.time > end) {
      return;
    }
    const auto of_brick = [&event](const Motion& motion) { return motion.brick == event.brick; };
    const auto motion = std::find_if(motions.begin(), motions.end(), of_brick);
    if (event.kind != EventKind::struck || motion == motions.end()) {
      continue;
    }
    for (std::size_t panel = 0; panel < motion->curves.size(); ++panel) {
      const auto after = std::find_if(motion->curves[panel].rbegin(), motion->curves[panel].rend(),
                                      [&event](const Point& point) { return std::isfinite(point.y) && point.x <= event.time + 1e-9; });
      if (after != motion->curves[panel].rend()) {
        motion->hits[panel].push_back({event.time, after->y});
      }
    }
  }
}

std::string block_name(const char* what, std::size_t curve, std::size_t panel) {
  return std::string("$") + what + std::to_string(curve) + "_" + std::to_string(panel);
}

/// One panel: a curve a brick, and a triangle where it was struck.
std::string plot_command(const std::vector<Motion>& motions, std::size_t panel) {
  std::string command;
  bool any_hit = false;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    command += (i == 0 ? "plot " : ", ") + block_name("curve", i, panel) + " with lines " + curve_style(i);
    command += panel == 0 ? " title 'brick " + std::to_string(motions[i].brick) + "'" : std::string(" notitle");
  }
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (motions[i].hits[panel].empty()) {
      continue;
    }
    command += ", " + block_name("hit", i, panel) + " with points pt 9 ps 0.8 lc rgb '" + curve_color(i) + "' notitle";
    any_hit = true;
  }
  if (any_hit && panel == 0) {
    command += ", NaN with points pt 9 ps 0.8 lc rgb '#555555' title 'struck'";
  }
  return command;
}

/// A round number (1, 2 or 5 times a power of ten) that divides a range into at most six.
double round_step(double range) {
  const double rough = range / 6.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) {
      return factor * power;
    }
  }
  return 10.0 * power;
}

/// Sets the vertical axis so that all curves fit and the zero is in it.
void set_vertical_axis(GnuplotScript& script, const std::vector<Motion>& motions, std::size_t panel) {
  double low = 0.0;
  double high = 0.0;
  for (const Motion& motion : motions) {
    for (const Point& point : motion.curves[panel]) {
      low = std::min(low, point.y);  // A point that breaks the curve is not a number and changes neither.
      high = std::max(high, point.y);
    }
  }
  const double range = high > low ? high - low : 1.0;
  const bool degrees = panel == 0 && high > 45.0;
  script.line("set yrange [" + decimal(low < 0.0 ? low - 0.05 * range : 0.0) + ":" + decimal((high > low ? high : 1.0) + 0.06 * range) +
              "]");
  script.line("set ytics " + decimal(degrees ? 30.0 : round_step(range)) + (degrees ? "\nset mytics 3" : "\nset mytics 1"));
}

/// The line that a brick must pass to fall.
void mark_tip_angle(GnuplotScript& script, double tip) {
  const std::string height = "first " + decimal(tip);
  script.line("set arrow 1 from graph 0," + height + " to graph 1," + height + " nohead back lc rgb '#777777' lw 0.8 dt (3,3)");
  script.line("set label 1 'tip angle " + rounded(tip, 3) + "°' at graph 0.995," + height +
              " right offset 0,0.5 font ',9' textcolor rgb '#666666'");
}

void add_panel(GnuplotScript& script, const std::vector<Motion>& motions, std::size_t panel) {
  constexpr std::array<const char*, 3> kNames = {"Angle [°]", "Angular velocity [rad/s]", "Angular acceleration [rad/s²]"};
  constexpr double kTop = 0.93;
  constexpr double kBottom = 0.085;
  constexpr double kSpace = 0.03;
  constexpr double kHeight = (kTop - kBottom - 2 * kSpace) / 3;
  const double top = kTop - static_cast<double>(panel) * (kHeight + kSpace);
  script.line("set tmargin at screen " + decimal(top)).line("set bmargin at screen " + decimal(top - kHeight));
  script.line(std::string("set label 2 '") + kNames[panel] + "' at screen 0.022,screen " + decimal(top - kHeight / 2) + " center rotate");
  script.line(panel == 0 ? "set key at screen 0.56,0.995 center top horizontal maxrows 2" : "unset key");
  script.line(panel == 2 ? "set format x '%g'\nset xlabel 'Time [s]' offset 0,0.3" : "set format x ''\nunset xlabel");
  set_vertical_axis(script, motions, panel);
  script.line(plot_command(motions, panel));
  script.line("unset arrow 1\nunset label 1");
}

}  // namespace

Result<void> plot_motion(const Recording& recording, std::span<const BrickId> bricks, const std::filesystem::path& path) {
  std::vector<BrickId> chosen(bricks.begin(), bricks.end());
  if (chosen.empty()) {
    chosen = first_moved(recording);
  }
  if (chosen.empty()) {
    return failure("No brick moved, so there is no motion to draw.");
  }
  std::vector<Motion> motions;
  double end = 0.0;
  for (const BrickId brick : chosen) {
    if (brick < 0 || brick >= recording.layout().brick_count()) {
      return failure("There is no brick " + std::to_string(brick) + "; the bricks are 0 to " +
                     std::to_string(recording.layout().brick_count() - 1) + ".");
    }
    motions.push_back(motion_of(recording, brick));
    end = std::max(end, motions.back().end);
  }
  add_hits(recording, motions, end);
  end = end > 0.0 ? 1.06 * end : std::max(recording.duration(), 1.0);
  for (Motion& motion : motions) {
    add_rest(motion, motion.curves[0].empty() ? 0.0 : motion.curves[0].back().y / kDegrees, motion.end, end);
  }

  Result<GnuplotScript> script = GnuplotScript::begin(path, 640, 660);
  if (!script) {
    return std::unexpected(script.error());
  }
  for (std::size_t i = 0; i < motions.size(); ++i) {
    for (std::size_t panel = 0; panel < 3; ++panel) {
      script->data(block_name("curve", i, panel), motions[i].curves[panel]);
      script->data(block_name("hit", i, panel), motions[i].hits[panel]);
    }
  }
  const Brick& first = recording.layout().bricks[static_cast<std::size_t>(chosen.front())];
  const double tip = tip_angle(extents(recording.layout().kind_of(chosen.front()), first.stance)) * kDegrees;
  script->line("set lmargin at screen 0.125\nset rmargin at screen 0.975\nset multiplot");
  script->line("set xrange [0:" + decimal(end) + "]");
  mark_tip_angle(*script, tip);
  for (std::size_t panel = 0; panel < 3; ++panel) {
    add_panel(*script, motions, panel);
  }
  script->line("unset multiplot");
  return draw(*script, path);
}

}  // namespace topple

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "export/figures.h"
#include "export/gnuplot.h"

namespace topple {
namespace {

constexpr std::size_t kMarkersUpTo = 60;  // Beyond this the points run into one another.

std::string with_style(std::size_t count, std::size_t curve) {
  return (count <= kMarkersUpTo ? "with linespoints pt 7 ps 0.5 " : "with lines ") + curve_style(curve);
}

/// Distances are read in mm on a table and in m in a hall.
struct LengthUnit {
  double scale = 1.0;
  const char* name = "m";
};
LengthUnit unit_for(double length) { return length < 1.0 ? LengthUnit{1000.0, "mm"} : LengthUnit{}; }

std::size_t arrived_count(const Wave& wave) {
  return static_cast<std::size_t>(std::count_if(wave.arrival.begin(), wave.arrival.end(), [](double time) { return std::isfinite(time); }));
}

Result<GnuplotScript> begin_wave_figure(const Wave& wave, const std::filesystem::path& path) {
  if (arrived_count(wave) < 2) {
    return failure("The wave reached fewer than two bricks, so there is nothing to draw along the run.");
  }
  Result<GnuplotScript> script = GnuplotScript::begin(path, 560, 340);
  if (script) {
    script->line(std::string("set xlabel 'Distance along the run [") + unit_for(wave.distance.back()).name + "]'");
  }
  return script;
}

}  // namespace

Result<void> plot_arrival(const Recording& recording, const std::filesystem::path& path) {
  const Wave wave = measure_wave(recording);
  Result<GnuplotScript> script = begin_wave_figure(wave, path);
  if (!script) {
    return std::unexpected(script.error());
  }
  const LengthUnit unit = unit_for(wave.distance.back());
  std::vector<Point> points;
  points.reserve(wave.bricks.size());
  for (std::size_t i = 0; i < wave.bricks.size(); ++i) {
    points.push_back({wave.distance[i] * unit.scale, wave.arrival[i]});
  }
  script->data("$arrival", points);
  script->line("set key top left\nset ylabel 'Arrival time [s]'\nset xrange [0:*]\nset yrange [0:*]");
  script->line("plot $arrival " + with_style(points.size(), 0) + " title 'tilt passes 10°'");
  return draw(*script, path);
}

Result<void> plot_speed(const Recording& recording, const std::filesystem::path& path) {
  const Wave wave = measure_wave(recording);
  Result<GnuplotScript> script = begin_wave_figure(wave, path);
  if (!script) {
    return std::unexpected(script.error());
  }
  const LengthUnit unit = unit_for(wave.distance.back());
  const std::size_t window = std::clamp<std::size_t>(wave.bricks.size() / 200, 1, 10);
  std::vector<Point> points;
  points.reserve(wave.bricks.size());
  for (std::size_t i = 0; i < wave.bricks.size(); ++i) {
    points.push_back({wave.distance[i] * unit.scale, wave.local_speed(i, window)});
  }
  script->data("$speed", points);
  script->line("set key bottom right\nset ylabel 'Front speed [m/s]'\nset xrange [0:*]\nset yrange [0:*]\nset offsets 0,0,graph 0.05,0");
  std::string command = "plot ";
  if (std::isfinite(wave.front_speed)) {
    const auto at_share = [&](double share) {
      return wave.distance[static_cast<std::size_t>(share * static_cast<double>(wave.bricks.size() - 1))] * unit.scale;
    };
    script->data("$mean", {{at_share(0.2), wave.front_speed}, {at_share(0.8), wave.front_speed}});
    command += "$mean with lines " + curve_style(1) + " title '20 % to 80 % of the run: " + rounded(wave.front_speed, 4) + " m/s', ";
  }
  command += "$speed " + with_style(points.size(), 0) + " title 'over " + std::to_string(window) + (window == 1 ? " brick" : " bricks") +
             " on either side'";
  script->line(command);
  return draw(*script, path);
}

}  // namespace topple

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "export/gnuplot.h"
#include "topple/export.h"

namespace topple {
namespace {

/// A line of a whole slope a little below the lowest curve of that order, to compare with; without points if an earlier curve has it.
std::vector<Point> guide(std::span<const ErrorCurve> curves, std::size_t index) {
  const ErrorCurve& curve = curves[index];
  const double order = std::round(curve.slope);
  double low = curve.errors.back();
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (std::round(curves[i].slope) == order) {
      if (i < index) {
        return {};
      }
      low = std::min(low, curves[i].errors.back());
    }
  }
  std::vector<Point> line;
  for (const double step : {curve.time_steps.back(), curve.time_steps.front()}) {
    line.push_back({step, 0.4 * low * std::pow(step / curve.time_steps.back(), order)});
  }
  return line;
}

bool can_be_drawn(const ErrorCurve& curve) { return curve.time_steps.size() >= 2 && curve.errors.size() == curve.time_steps.size(); }

}  // namespace

Result<void> plot_convergence(std::span<const ErrorCurve> curves, const std::filesystem::path& path) {
  Result<GnuplotScript> script = GnuplotScript::begin(path, 560, 420);
  if (!script) {
    return std::unexpected(script.error());
  }
  std::string lines;
  std::string guides;
  if (!std::all_of(curves.begin(), curves.end(), can_be_drawn)) {
    return failure("A convergence figure needs at least two steps a curve, with an error each.");
  }
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const ErrorCurve& curve = curves[i];
    std::vector<Point> points;
    points.reserve(curve.time_steps.size());
    for (std::size_t k = 0; k < curve.time_steps.size(); ++k) {
      points.push_back({curve.time_steps[k], curve.errors[k]});
    }
    const std::string number = std::to_string(i);
    script->data("$curve" + number, points);
    const std::string title = curve.name + ", slope " + rounded(curve.slope, 3);
    lines += i == 0 ? "$curve" : ", $curve";
    lines += number;
    lines += " with linespoints ps 0.7 pt ";
    lines += std::to_string(5 + 2 * i);
    lines += " ";
    lines += curve_style(i);
    lines += " title '";
    lines += title;
    lines += "'";
    if (const std::vector<Point> line = guide(curves, i); !line.empty()) {
      script->data("$guide" + number, line);
      guides += ", $guide";
      guides += number;
      guides += " with lines lc rgb '#888888' dt (3,3) lw 0.9 ";
      guides += (i == 0 ? "title 'whole slopes'" : "notitle");
    }
  }
  script->line("set logscale xy\nset format '10^{%L}'\nset mxtics 10\nset mytics 1\nset key outside top center horizontal maxrows 2");
  script->line("set xlabel 'Time step [s]'\nset ylabel 'Error of the angle [rad]'");
  script->line("plot " + lines + guides);
  return draw(*script, path);
}

}  // namespace topple

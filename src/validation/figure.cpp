#include "validation/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "export/gnuplot.h"

namespace topple::validation {
namespace {

constexpr int kWidth = 640, kHeight = 440;  // In steps of 1/40 cm: 16 by 11 cm, the width of a page's text.

/// In quotes for gnuplot, where none of its marks means anything.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char letter : text) {
    if (letter == '\'') {
      out += "''";
    } else if (letter == '_' || letter == '^' || letter == '{' || letter == '}' || letter == '@' || letter == '&' || letter == '~') {
      out += '\\';
      out += letter;
    } else if (static_cast<unsigned char>(letter) >= ' ') {
      out += letter;
    }
  }
  return out + "'";
}

std::string range(const char* axis, const std::vector<double>& bounds) {
  if (bounds.size() != 2) return {};
  return std::string("set ") + axis + "range [" + decimal(bounds[0]) + ":" + decimal(bounds[1]) + "]\n";
}

/// Builds one plot command, its data blocks numbered.
class Drawing {
 public:
  explicit Drawing(GnuplotScript& script) : script_(script) {}

  void add(const std::vector<std::vector<double>>& rows, const std::string& style, const std::string& title) {
    const std::string name = "$block" + std::to_string(count_++);
    script_.table(name, rows);
    command_ += (command_.empty() ? "plot " : ", ") + name + " " + style + (title.empty() ? " notitle" : " title " + quoted(title));
  }
  void finish() { script_.line(command_); }

 private:
  GnuplotScript& script_;
  std::string command_;
  int count_ = 0;
};

void draw_band(Drawing& drawing, const Series& series, const Prediction& prediction) {
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < prediction.x.size(); ++i) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const std::vector<double>& y : prediction.y) {
      if (std::isnan(y[i])) continue;
      low = std::min(low, y[i]);
      high = std::max(high, y[i]);
    }
    rows.push_back({prediction.x[i], low, high});
  }
  const std::string color = curve_color(static_cast<std::size_t>(series.color));
  drawing.add(rows, "with filledcurves fs transparent solid 0.16 noborder lc rgb '" + color + "'", series.label);
}

std::vector<std::vector<double>> rows_of(const Prediction& prediction, std::size_t setting, bool with_spread) {
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < prediction.x.size() && i < prediction.y[setting].size(); ++i) {
    rows.push_back({prediction.x[i], prediction.y[setting][i]});
    if (with_spread) rows.back().push_back(prediction.spread[setting][i]);
  }
  return rows;
}

void draw_series(Drawing& drawing, const Series& series, const Prediction& prediction) {
  const std::size_t standard = standard_setting(series);
  const auto color = static_cast<std::size_t>(series.color);
  const std::string title = series.look == Look::band && !series.label.empty() ? series.label + ", default surfaces" : series.label;
  if (series.look == Look::points) {
    constexpr std::array<int, 5> kMarks = {4, 6, 8, 12, 10};
    drawing.add(rows_of(prediction, standard, series.spread),
                std::string(series.spread ? "with yerrorbars" : "with points") + " ps 1.2 lw 1.5 pt " +
                    std::to_string(kMarks[color % kMarks.size()]) + " lc rgb '" + curve_color(color) + "'",
                title);
    return;
  }
  if (series.spread) {
    drawing.add(rows_of(prediction, standard, true), "with yerrorbars pt 7 ps 0.45 lw 1.0 lc rgb '" + curve_color(color) + "'", "");
  }
  const bool few = prediction.x.size() <= 24;
  drawing.add(rows_of(prediction, standard, false),
              std::string(few ? "with linespoints pt 7 ps 0.35 " : "with lines ") + curve_style(color), title);
}

void draw_points(Drawing& drawing, const Points& points, std::size_t number) {
  if (points.line) {
    std::vector<std::vector<double>> rows(points.x.size());
    for (std::size_t i = 0; i < points.x.size(); ++i) rows[i] = {points.x[i], points.y[i]};
    drawing.add(rows, "with lines lc rgb '#444444' lw 2.2 dt (2,3)", points.label);
    return;
  }
  constexpr std::array<int, 4> kFull = {7, 5, 9, 13};
  constexpr std::array<int, 4> kOpen = {6, 4, 8, 12};
  for (std::size_t r = 0; r < points.readings.size(); ++r) {
    const Reading& reading = points.readings[r];
    std::vector<std::vector<double>> rows;
    bool bars = false;
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      rows.push_back({points.x[i], reading.factor * points.y[i], reading.factor * points.error[i]});
      bars = bars || points.error[i] > 0.0;
    }
    const int mark = (r == 0 ? kFull : kOpen)[number % kFull.size()];
    drawing.add(rows,
                std::string(bars ? "with yerrorbars" : "with points") + " ps 0.8 lw 1.3 pt " + std::to_string(mark) + " lc rgb '#111111'",
                reading.name.empty() || points.label.empty() ? points.label : points.label + ", " + reading.name);
  }
}

}  // namespace

Result<void> draw_figure(const Judged& judged, const std::filesystem::path& path) {
  const Source& source = *judged.source;
  const Figure& figure = source.figure.front();
  Result<GnuplotScript> script = GnuplotScript::begin(path, kWidth, kHeight);
  if (!script) return std::unexpected(script.error());
  script->line("set xlabel " + quoted(figure.x_label) + "\nset ylabel " + quoted(figure.y_label));
  script->line(range("x", figure.x_range) + range("y", figure.y_range));
  if (figure.log_x) script->line("set logscale x");
  if (figure.log_y) script->line("set logscale y");
  script->line("set key bmargin center horizontal maxcols 3 samplen 2.4 spacing 1.2\nset bars 0.6\nset offsets graph 0.03,0.03,0.05,0.02");
  Drawing drawing(*script);
  const auto draw_all = [&](Look look) {
    for (std::size_t i = 0; i < source.series.size(); ++i) {
      if (!judged.predictions[i].there || source.series[i].look != look) continue;
      if (look == Look::band) draw_band(drawing, source.series[i], judged.predictions[i]);
      draw_series(drawing, source.series[i], judged.predictions[i]);
    }
  };
  draw_all(Look::band);
  draw_all(Look::line);
  for (std::size_t i = 0; i < source.points.size(); ++i) {
    if (!source.points[i].hidden) draw_points(drawing, source.points[i], i);
  }
  draw_all(Look::points);
  drawing.finish();
  return draw(*script, path);
}

}  // namespace topple::validation

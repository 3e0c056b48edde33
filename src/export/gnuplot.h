/// Figures are drawn by gnuplot: it gets a script on its standard input and gives the picture on its standard output.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "topple/base.h"

namespace topple {

struct Point {
  double x = 0.0;
  double y = 0.0;
};

/// A gnuplot script with the data in it. No text of a person's gets into it, only numbers and our own words.
class GnuplotScript {
 public:
  /// Terminal and style; `width` and `height` are in steps of 1/40 cm. Fails unless the extension is .svg, .png or .pdf.
  static Result<GnuplotScript> begin(const std::filesystem::path& path, int width, int height);

  GnuplotScript& line(std::string_view command);

  /// A named block of points; a point that is not a number breaks the curve. Long curves are thinned to their envelope.
  GnuplotScript& data(std::string_view name, const std::vector<Point>& points);

  /// A named block of rows of numbers, for bands and error bars; a row with something that is not a number breaks the curve.
  GnuplotScript& table(std::string_view name, const std::vector<std::vector<double>>& rows);

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// The shortest decimal text that gives the same number, with a dot.
std::string decimal(double value);

/// With at most `digits` significant digits, for legends.
std::string rounded(double value, int digits);

/// "lc rgb '#0072B2' dt 1 lw 1.6": the i-th curve in the colours of Okabe and Ito and with its own dashes, so that it is told
/// apart by the colour-blind and in grey print.
std::string curve_style(std::size_t index);
std::string curve_color(std::size_t index);

/// Runs gnuplot and puts the picture at `path` once it is whole.
Result<void> draw(const GnuplotScript& script, const std::filesystem::path& path);

}  // namespace topple

/// Which paper at which scale, and what is where on a sheet.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "export/plan/canvas.h"
#include "topple/export.h"

namespace topple::plan {

/// A sheet's parts [mm].
struct Sheet {
  Size paper;
  Rect field;                 ///< The drawing, with its band of coordinates.
  std::vector<Rect> columns;  ///< For tables.
  Rect title;

  Rect window() const;  ///< Inside the band.
};

inline constexpr double kBand = 4.6;  ///< Width of the band of coordinates [mm].

/// Everything that is drawn lies within this box, as put down [m].
struct Bounds {
  double x = 0.0, y = 0.0;  ///< Lower left corner.
  double width = 0.0, height = 0.0;
};

/// Where the world is on a page.
struct View {
  Rect window;         ///< What of the page shows it [mm].
  double scale = 1.0;  ///< N of 1:N.
  Point zero;          ///< Where the world's x = 0, y = 0 is [mm].

  Point on_page(double x, double y) const { return {zero.x + 1000.0 * x / scale, zero.y - 1000.0 * y / scale}; }
  double on_page(double metres) const { return 1000.0 * metres / scale; }
};

/// The layout in the middle of a window, as far as the room for dimensions allows.
View centred(const Rect& window, double scale, const Bounds& bounds);

struct Choice {
  double scale = 1.0;
  std::string paper;  ///< "A3"; empty: a size of its own.
  Sheet sheet;        ///< With the whole layout, at `overview` where it takes several sheets.
  double overview = 1.0;
  bool several = false;
};

/// Chooses paper and scale for a layout whose thinnest brick has `thinnest` [m].
Choice choose(const Bounds& bounds, double thinnest, const PlanConfig& config, bool any_size);

/// How a layout is cut into sheets of one paper.
struct Cut {
  Size paper;
  Rect clip;  ///< What of a page shows the layout: its cell, and half the overlap around it [mm].
  int columns = 1, rows = 1;
  double cell_width = 0.0, cell_height = 0.0;  ///< [mm]
  Point origin;                                ///< Upper left corner of the first cell, from the layout's upper left corner, on paper [mm].
};
inline constexpr double kOverlap = 10.0;  ///< What neighbouring sheets both show [mm].
Cut cut(const Size& layout, const std::string& paper);

/// "1:2.5".
std::string scale_text(double scale);

/// [m] as people write it on a plan: "480 mm", "12.35 m".
std::string length_text(double metres);

}  // namespace topple::plan

/// What stands beside the drawing: the title, the scale bar, tables of kinds, colours and parts, doubts, signs.
#pragma once

#include <string>
#include <vector>

#include "export/plan/canvas.h"
#include "export/plan/sheet.h"
#include "topple/layout.h"

namespace topple::plan {

/// The title block.
struct Title {
  std::string title;
  std::string file;
  std::string scale;   ///< "1:10".
  std::string paper;   ///< "A3"; empty: a size of its own.
  std::string sheets;  ///< "1 of 1".
  std::string bricks;
  std::string size;
  double bar_scale = 1.0;  ///< Of the scale bar: N of 1:N.
};
void draw_title(Canvas& canvas, const Rect& rect, const Title& title);

/// What the drawing has, so that its signs are explained.
struct Signs {
  bool pushes = false;
  bool balls = false;
  bool stacked = false;
  bool numbers = false;
  bool lines = false;   ///< Rows are lines.
  bool sheets = false;  ///< Rectangles of the sheets.
};

/// Tables, as much of each as there is room for; what is left out is counted. Returns how many of the doubts are told.
std::size_t draw_tables(Canvas& canvas, const std::vector<Rect>& columns, const Layout& layout, const std::vector<Doubt>& doubts,
                        const Signs& signs);

}  // namespace topple::plan

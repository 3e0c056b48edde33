/// A plan on several sheets: which of them are needed, and each of them.
#pragma once

#include <string>
#include <vector>

#include "export/plan/canvas.h"
#include "export/plan/labels.h"
#include "export/plan/sheet.h"
#include "topple/layout.h"

namespace topple::plan {

/// A sheet that has bricks on it.
struct Page {
  int column = 0, row = 0;
  std::vector<std::string> parts;  ///< Names of those that it shows.
};

class Pages {
 public:
  Pages(const Layout& layout, const Bounds& bounds, double scale, const std::string& paper);

  const Cut& cut() const { return cut_; }
  std::size_t count() const { return pages_.size(); }
  const std::vector<std::string>& parts_of(std::size_t page) const { return pages_[page].parts; }

  /// The cuts, with the sheets' numbers, over the layout as `view` shows it.
  void draw_overview(Canvas& canvas, const View& view, Room& room) const;
  /// One sheet, numbered from 0, on a page of its own.
  void draw(Canvas& canvas, std::size_t page, const std::vector<Doubt>& doubts, bool lines) const;

 private:
  View view_of(const Page& page) const;
  Rect cell() const { return cut_.clip.grown(-kOverlap / 2.0); }
  int number_at(int column, int row) const;  ///< Counted from 1; 0: no sheet.
  void draw_cuts(Canvas& canvas, const Page& page) const;
  void draw_footer(Canvas& canvas, std::size_t number) const;

  const Layout& layout_;
  Bounds bounds_;
  double scale_;
  Cut cut_;
  std::vector<Page> pages_;
};

}  // namespace topple::plan

/// Words and numbers beside the bricks, where there is room for them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "export/plan/canvas.h"
#include "export/plan/sheet.h"
#include "topple/layout.h"

namespace topple::plan {

/// What of a page is taken.
class Room {
 public:
  explicit Room(const Rect& window);
  /// Whoever takes it: kNobody is a word or a line, any other number the bricks of one part.
  static constexpr std::uint32_t kNobody = 1;
  void take(const Rect& rect, std::uint32_t owner = kNobody);
  void take_line(const Point& from, const Point& to, double width, std::uint32_t owner = kNobody);
  bool is_free(const Rect& rect) const;                          ///< And inside the window.
  bool has_others(const Rect& rect, std::uint32_t owner) const;  ///< Bricks of parts that are not the owner's.

 private:
  struct Span {
    std::int64_t left, right, top, bottom;
  };
  Span cells(const Rect& rect) const;

  Rect window_;
  double cell_;
  std::int64_t columns_, rows_;
  std::vector<std::uint32_t> taken_;  // By whom; 0: free.
};

/// Parts that have one name for people: the line and the rows of a field.
struct PartGroup {
  std::string name;       ///< "row 3", "field 1".
  std::size_t first = 0;  ///< Index into Layout::parts.
  std::size_t count = 1;  ///< Parts.
  std::int64_t bricks = 0;
  double height = 0.0;  ///< Of what is no line, above the floor; 0 of one [m].
};
std::vector<PartGroup> part_groups(const Layout& layout);

/// Marks pushes, doubts, parts and, where wanted, brick numbers, each where nothing else is. `bricks` are those in the window.
void draw_labels(Canvas& canvas, const Layout& layout, const View& view, const std::vector<BrickId>& bricks,
                 const std::vector<Doubt>& doubts, Room& room, bool numbers);

/// A circle with a number, as doubts have it in the drawing and in the legend.
void draw_doubt_mark(Canvas& canvas, const Point& middle, std::size_t number);

/// An arrow that ends at `tip`.
void draw_push_arrow(Canvas& canvas, const Point& tip, const Point& heading, double size);
inline constexpr double kPushArrow = 7.0;  ///< [mm]

}  // namespace topple::plan

/// The layout itself on a page: grid, bricks, rows as lines, pushes, dimensions.
#pragma once

#include <array>
#include <vector>

#include "export/plan/canvas.h"
#include "export/plan/sheet.h"
#include "topple/layout.h"

namespace topple::plan {

/// A brick from above: its corners from the left heel clockwise as it heads, on the page; of a ball the square around it.
std::array<Point, 4> footprint(const Layout& layout, BrickId brick, const View& view);

/// The way a brick heads, on the page.
Point heading_on_page(const Brick& brick);

/// Half of a footprint's longer diagonal [mm].
double reach_of(const Layout& layout, BrickId brick, const View& view);

/// Those of which anything may be in the window, in the order in which they are drawn: from the floor up.
std::vector<BrickId> bricks_in(const Layout& layout, const View& view);

/// Of the thinnest brick [m]; 0 where there is none.
double thinnest(const Layout& layout);

/// Lines of the grid, and where they cross the window's edges their coordinates: in a band around it, or just inside.
void draw_grid(Canvas& canvas, const View& view, bool band);

/// Each brick as its footprint in its colour; those on top of others over them, with dashes for what lies beneath.
void draw_bricks(Canvas& canvas, const Layout& layout, const View& view, const std::vector<BrickId>& bricks);

/// Rows as lines, as wide as their bricks; everything that is no line as footprints.
void draw_lines(Canvas& canvas, const Layout& layout, const View& view, const std::vector<BrickId>& bricks);

/// Whether bricks stand on others, so that not all are seen whole.
bool any_stacked(const Layout& layout);

/// Width and height of everything below it and on its right.
void draw_dimensions(Canvas& canvas, const View& view, const Bounds& bounds);
// From the layout to its dimension lines [mm]; on the right with room for the names of rows.
inline constexpr double kBelow = 11.0, kBeside = 16.0;

/// A bar of a round length, black and white, with its length.
void draw_scale_bar(Canvas& canvas, const Point& at, double room, double scale);

}  // namespace topple::plan

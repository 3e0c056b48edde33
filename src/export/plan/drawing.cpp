#include "export/plan/drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/trigonometry.h"
#include "layout/text.h"

namespace topple::plan {
namespace {

constexpr std::size_t kBatch = 400;  // Footprints of one colour in one path.

double edge_width(double thickness) { return std::clamp(0.11 * thickness, 0.05, 0.16); }

/// Hard to see on white paper.
bool is_light(const Color& color) {
  constexpr int kLight = 600;  // Of 765, red, green and blue together.
  return int{color.red} + color.green + color.blue > kLight;
}

Extents size_of(const Layout& layout, BrickId brick) {
  const Brick& put = layout.bricks[static_cast<std::size_t>(brick)];
  return extents(layout.kinds[put.kind], put.stance);
}

bool is_ball(const Layout& layout, BrickId brick) { return layout.kind_of(brick).shape == Shape::ball; }

void add_outline(Canvas& canvas, const Layout& layout, BrickId brick, const View& view) {
  if (is_ball(layout, brick)) {
    const Vec3& foot = layout.bricks[static_cast<std::size_t>(brick)].foot;
    canvas.circle(view.on_page(foot.x, foot.y), view.on_page(layout.kind_of(brick).width) / 2.0);
    return;
  }
  const auto corners = footprint(layout, brick, view);
  canvas.quad(corners[0], corners[1], corners[2], corners[3]);
}

/// The centre lines of a ball, a little beyond its edge.
void draw_centre_lines(Canvas& canvas, const Layout& layout, BrickId brick, const View& view) {
  constexpr std::array<double, 4> kDashDot = {2.0, 0.5, 0.4, 0.5};
  const Vec3& foot = layout.bricks[static_cast<std::size_t>(brick)].foot;
  const Point middle = view.on_page(foot.x, foot.y);
  const double reach = view.on_page(layout.kind_of(brick).width) / 2.0 + 1.2;
  canvas.move({middle.x - reach, middle.y});
  canvas.line({middle.x + reach, middle.y});
  canvas.move({middle.x, middle.y - reach});
  canvas.line({middle.x, middle.y + reach});
  canvas.stroke(kBlack, 0.1, kDashDot);
}

/// Parts in which bricks stand on others.
std::vector<const Part*> stacked_parts(const Layout& layout) {
  std::vector<const Part*> parts;
  for (const Part& part : layout.parts) {
    const auto begin = layout.bricks.begin() + part.first;
    if (std::any_of(begin, begin + part.count, [](const Brick& brick) { return brick.foot.z > 0.0; })) parts.push_back(&part);
  }
  return parts;
}

void draw_hidden_edges(Canvas& canvas, const Layout& layout, const View& view) {
  constexpr std::array<double, 2> kDashes = {0.8, 0.6};
  for (const Part* part : stacked_parts(layout)) {
    double top = 0.0;
    for (BrickId brick = part->first; brick < part->first + part->count; ++brick) {
      top = std::fmax(top, layout.bricks[static_cast<std::size_t>(brick)].foot.z);
    }
    bool any = false;
    for (BrickId brick = part->first; brick < part->first + part->count; ++brick) {
      const Vec3& foot = layout.bricks[static_cast<std::size_t>(brick)].foot;
      if (foot.z > 0.0 || !view.window.grown(reach_of(layout, brick, view)).has(view.on_page(foot.x, foot.y))) continue;
      // A little inside, so that they are told from edges of the bricks above.
      auto corners = footprint(layout, brick, view);
      const Point middle = 0.5 * (corners[0] + corners[2]);
      const double inside = 1.0 - std::fmin(0.5, 0.6 / std::fmax(length(corners[0] - corners[3]), length(corners[0] - corners[1])));
      for (Point& corner : corners) corner = middle + inside * (corner - middle);
      canvas.quad(corners[0], corners[1], corners[2], corners[3]);
      any = true;
    }
    if (any) canvas.stroke(kBlack, 0.08, kDashes);
  }
}

/// A part as a line: points no nearer to each other than can be seen, a straight stretch as two.
class Polyline {
 public:
  Polyline(Canvas& canvas, double width) : canvas_(canvas), width_(width) {}

  void add(const Point& point, const Color& color, bool visible) {
    if (!visible) {
      end();
      return;
    }
    if (!points_.empty() && !(color == color_) && length(point - points_.front()) + length(point - points_.back()) > kShortest) {
      const Point last = points_.back();
      end();
      points_.push_back(last);  // One colour begins where the last one ends.
    }
    if (points_.size() <= 1) color_ = color;
    if (points_.size() >= 2 && straight(point)) {
      points_.back() = point;
      return;
    }
    if (!points_.empty()) {
      begun_ = points_.back();
      const Point way = point - begun_;
      way_ = length(way) > 0.0 ? (1.0 / length(way)) * way : Point{};
    }
    points_.push_back(point);
  }

  void end() {
    // An edge of grey where a row would not be seen on white paper.
    if (is_light(color_)) draw(kOutline, width_ + 0.08);
    draw(color_, width_);
    points_.clear();
  }

 private:
  static constexpr double kShortest = 0.25;   // [mm]
  static constexpr double kStraight = 0.015;  // [mm]

  /// Whether a point goes on the way that the last stretch began.
  bool straight(const Point& point) const {
    const Point on = point - begun_;
    return std::abs(way_.x * on.y - way_.y * on.x) < kStraight && way_.x * on.x + way_.y * on.y > 0.0;
  }
  /// Each stretch by itself: viewers show a thin straight line and a thin bent one in different widths.
  void draw(const Color& ink, double width) {
    for (std::size_t i = 1; i < points_.size(); ++i) canvas_.segment(points_[i - 1], points_[i], ink, width);
  }

  Canvas& canvas_;
  double width_;
  std::vector<Point> points_;
  Point begun_, way_;  // Where the last stretch began, and its direction.
  Color color_;
};

/// The smallest of 1, 2, 5, 10 ... mm that is at least so long [m].
double round_length(double least) {
  double step = 0.001;
  for (int i = 0; i < 30 && step < least; ++i) step *= i % 3 == 1 ? 2.5 : 2.0;
  return step;
}

struct Grid {
  double step = 1.0;  // [m]
  bool in_cm = false;

  std::string words(std::int64_t line) const {
    const double value = step * static_cast<double>(line) * (in_cm ? 100.0 : 1.0);
    const auto whole = static_cast<std::int64_t>(std::llround(value));
    const std::string minus = value < -1e-6 ? "\u2212" : "";
    return minus + (std::abs(value - static_cast<double>(whole)) < 1e-6 ? std::to_string(std::abs(whole)) : number_text(std::abs(value)));
  }
};

Grid grid_for(const View& view) {
  constexpr double kClosest = 18.0;  // [mm]
  const double step = round_length(kClosest * view.scale / 1000.0);
  return {step, step < 0.995};
}

void draw_band(Canvas& canvas, const View& view, const Grid& grid) {
  const Rect& window = view.window;
  canvas.rect(window.grown(kBand));
  canvas.stroke(kBlack, 0.5);
  canvas.rect(window);
  canvas.stroke(kBlack, 0.2);
  canvas.text({window.x - kBand / 2.0, window.y - 1.4}, grid.in_cm ? "cm" : "m", {.size = kSmall, .ink = kGrey, .align = Align::middle});
}

}  // namespace

Point heading_on_page(const Brick& brick) {
  const SinCos turn = sin_cos(brick.heading);
  return {turn.cos, -turn.sin};
}

std::array<Point, 4> footprint(const Layout& layout, BrickId brick, const View& view) {
  const Brick& put = layout.bricks[static_cast<std::size_t>(brick)];
  const Extents size = size_of(layout, brick);
  const Point ahead = heading_on_page(put), left{ahead.y, -ahead.x};
  const Point along = (view.on_page(size.along) / 2.0) * ahead, across = (view.on_page(size.across) / 2.0) * left;
  const Point middle = view.on_page(put.foot.x, put.foot.y);
  return {middle - along + across, middle + along + across, middle + along - across, middle - along - across};
}

double reach_of(const Layout& layout, BrickId brick, const View& view) {
  const Extents size = size_of(layout, brick);
  return view.on_page(std::sqrt(size.along * size.along + size.across * size.across)) / 2.0;
}

std::vector<BrickId> bricks_in(const Layout& layout, const View& view) {
  std::vector<BrickId> bricks;
  bool flat = true;
  for (BrickId brick = 0; brick < layout.brick_count(); ++brick) {
    const Vec3& foot = layout.bricks[static_cast<std::size_t>(brick)].foot;
    if (!view.window.grown(reach_of(layout, brick, view)).has(view.on_page(foot.x, foot.y))) continue;
    bricks.push_back(brick);
    flat = flat && foot.z == 0.0;
  }
  if (flat) return bricks;
  std::stable_sort(bricks.begin(), bricks.end(), [&](BrickId a, BrickId b) {
    return layout.bricks[static_cast<std::size_t>(a)].foot.z < layout.bricks[static_cast<std::size_t>(b)].foot.z;
  });
  return bricks;
}

double thinnest(const Layout& layout) {
  std::vector<bool> used(layout.kinds.size());
  for (const Brick& brick : layout.bricks) used[brick.kind] = true;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) least = std::fmin(least, layout.kinds[i].thickness);
  }
  return std::isfinite(least) ? least : 0.0;
}

void draw_grid(Canvas& canvas, const View& view, bool band) {
  const Grid grid = grid_for(view);
  const Rect& window = view.window;
  const double step = view.on_page(grid.step);
  const Letters small{.size = kSmall, .ink = kGrey, .align = Align::middle};
  const auto ink_of = [](std::int64_t line) { return line == 0 ? Color{168, 173, 180} : kPale; };
  if (band) {
    draw_band(canvas, view, grid);
  } else {
    canvas.text({window.x + 0.8, window.y + 3.2}, grid.in_cm ? "cm" : "m", {.size = kSmall, .ink = kGrey});
  }
  const double up = band ? kBand - 3.3 : -3.2;  // From the window's edge to the baseline of what is above, or just inside.
  for (auto i = static_cast<std::int64_t>(std::ceil((window.x - view.zero.x) / step));
       view.zero.x + static_cast<double>(i) * step <= window.right(); ++i) {
    const double x = view.zero.x + static_cast<double>(i) * step;
    canvas.segment({x, window.y}, {x, window.bottom()}, ink_of(i), 0.13);
    const double half = canvas.width_of(grid.words(i), kSmall) / 2.0;
    if (x - half < window.x + (band ? 0.0 : 6.0) || x + half > window.right()) continue;
    canvas.text({band ? x : x + half + 0.6, window.y - up}, grid.words(i), small);
    if (band) canvas.text({x, window.bottom() + 3.3}, grid.words(i), small);
  }
  for (auto i = static_cast<std::int64_t>(std::ceil((view.zero.y - window.bottom()) / step));
       view.zero.y - static_cast<double>(i) * step >= window.y; ++i) {
    const double y = view.zero.y - static_cast<double>(i) * step;
    canvas.segment({window.x, y}, {window.right(), y}, ink_of(i), 0.13);
    const std::string words = grid.words(i);
    const double half = canvas.width_of(words, kSmall) / 2.0;
    if (y - half < window.y || y + half > window.bottom()) continue;
    Letters upright = small;
    upright.turn = 1.5707963267948966;
    if (band) {
      canvas.text({window.x - kBand + 3.3, y}, words, upright);
      canvas.text({window.right() + 3.3, y}, words, upright);
    } else if (y - 2.0 * half > window.y + 6.0) {
      canvas.text({window.x + 3.2, y - half - 0.6}, words, upright);
    }
  }
}

void draw_bricks(Canvas& canvas, const Layout& layout, const View& view, const std::vector<BrickId>& bricks) {
  for (std::size_t i = 0; i < bricks.size();) {
    const Brick& first = layout.bricks[static_cast<std::size_t>(bricks[i])];
    std::size_t end = i;
    while (end < bricks.size() && end - i < kBatch) {
      const Brick& put = layout.bricks[static_cast<std::size_t>(bricks[end])];
      if (put.color != first.color || put.foot.z != first.foot.z) break;
      add_outline(canvas, layout, bricks[end], view);
      ++end;
    }
    const Color& color = layout.colors[first.color];
    const double thickness = view.on_page(layout.kinds[first.kind].thickness);
    // Around thin bricks edges would be most of what is seen on a screen: only those have one that white paper would swallow.
    constexpr double kThin = 0.5;
    if (thickness < kThin && !is_light(color)) {
      canvas.fill(color);
    } else {
      canvas.fill_and_stroke(color, kOutline, edge_width(thickness));
    }
    i = end;
  }
  for (const BrickId brick : bricks) {
    if (is_ball(layout, brick)) draw_centre_lines(canvas, layout, brick, view);
  }
  draw_hidden_edges(canvas, layout, view);
}

void draw_lines(Canvas& canvas, const Layout& layout, const View& view, const std::vector<BrickId>& bricks) {
  std::vector<BrickId> others;
  for (const BrickId brick : bricks) {
    const Part* const part = layout.part_of(brick);
    if (part == nullptr || !part->line || part->count < 2) others.push_back(brick);
  }
  for (const Part& part : layout.parts) {
    if (!part.line || part.count < 2) continue;
    Polyline line(canvas, std::fmax(view.on_page(size_of(layout, part.first).across), 0.08));
    for (BrickId brick = part.first; brick < part.first + part.count; ++brick) {
      const Brick& put = layout.bricks[static_cast<std::size_t>(brick)];
      const Point at = view.on_page(put.foot.x, put.foot.y);
      line.add(at, layout.colors[put.color], view.window.grown(1.0).has(at));
    }
    line.end();
  }
  draw_bricks(canvas, layout, view, others);
}

bool any_stacked(const Layout& layout) { return !stacked_parts(layout).empty(); }

void draw_dimensions(Canvas& canvas, const View& view, const Bounds& bounds) {
  constexpr double kOver = 1.5, kHead = 2.4, kUp = 1.5707963267948966;
  const Point low = view.on_page(bounds.x, bounds.y), high = view.on_page(bounds.x + bounds.width, bounds.y + bounds.height);
  const auto draw = [&](const Point& from, const Point& to, const Point& away, double far, const std::string& words) {
    const Point a = from + far * away, b = to + far * away, middle = 0.5 * (a + b);
    canvas.segment(from + 1.0 * away, a + kOver * away, kBlack, 0.13);
    canvas.segment(to + 1.0 * away, b + kOver * away, kBlack, 0.13);
    const bool flat = away.x == 0.0;
    // Where there is no room between, heads and words come from outside.
    const bool tight = length(b - a) < 2.0 * kHead + canvas.width_of(words, kNormal);
    const Point way = flat ? Point{1.0, 0.0} : Point{0.0, -1.0};
    canvas.segment(tight ? a - 2.0 * kHead * way : a, tight ? b + 2.0 * kHead * way : b, kBlack, 0.18);
    canvas.arrow_head(a, tight ? a - way : b, kHead, kBlack);
    canvas.arrow_head(b, tight ? b + way : a, kHead, kBlack);
    if (tight) {
      canvas.text(flat ? Point{b.x + 2.0 * kHead + 1.0, b.y + 1.0} : Point{middle.x + 2.4, middle.y + 1.0}, words);
    } else {
      const Point above = flat ? Point{0.0, -0.8} : Point{-0.8, 0.0};
      canvas.text(middle + above, words, {.align = Align::middle, .turn = flat ? 0.0 : kUp});
    }
  };
  draw({low.x, low.y}, {high.x, low.y}, {0.0, 1.0}, kBelow, length_text(bounds.width));
  draw({high.x, low.y}, {high.x, high.y}, {1.0, 0.0}, kBeside, length_text(bounds.height));
}

void draw_scale_bar(Canvas& canvas, const Point& at, double room, double scale) {
  constexpr int kFields = 5;
  double step = 0.001;
  // The largest of 1, 2, 5, 10 ... mm of which five fit.
  for (int i = 0; i < 30; ++i) {
    const double next = step * (i % 3 == 1 ? 2.5 : 2.0);
    if (1000.0 * kFields * next / scale > room) break;
    step = next;
  }
  const double field = 1000.0 * step / scale;
  for (int i = 0; i < kFields; ++i) {
    canvas.rect({at.x + i * field, at.y, field, 1.4});
    canvas.fill_and_stroke(i % 2 == 0 ? kBlack : kWhite, kBlack, 0.15);
  }
  canvas.text({at.x, at.y + 4.4}, "0", {.size = kSmall});
  const std::string whole = length_text(kFields * step);
  canvas.text({at.x + kFields * field, at.y + 4.4}, whole, {.size = kSmall, .align = Align::right});
}

}  // namespace topple::plan

#include "export/plan/pages.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "export/plan/drawing.h"

namespace topple::plan {

Pages::Pages(const Layout& layout, const Bounds& bounds, double scale, const std::string& paper)
    : layout_(layout),
      bounds_(bounds),
      scale_(scale),
      cut_(plan::cut({1000.0 * bounds.width / scale, 1000.0 * bounds.height / scale}, paper)) {
  // What part comes where: of every cell the last part that was noted.
  std::vector<std::vector<std::string>> cells(static_cast<std::size_t>(cut_.columns) * static_cast<std::size_t>(cut_.rows));
  std::vector<const void*> noted(cells.size());
  const std::vector<PartGroup> groups = part_groups(layout);
  std::vector<const PartGroup*> group_of(layout.parts.size());
  for (const PartGroup& group : groups) {
    for (std::size_t part = group.first; part < group.first + group.count; ++part) group_of[part] = &group;
  }
  const View view{.window = {}, .scale = scale, .zero = {-1000.0 * bounds.x / scale, 1000.0 * (bounds.y + bounds.height) / scale}};
  for (BrickId brick = 0; brick < layout.brick_count(); ++brick) {
    const Vec3& foot = layout.bricks[static_cast<std::size_t>(brick)].foot;
    const Point at = view.on_page(foot.x, foot.y) - cut_.origin;
    const double reach = reach_of(layout, brick, view);
    const Part* const part = layout.part_of(brick);
    const PartGroup* const group = part == nullptr ? nullptr : group_of[static_cast<std::size_t>(part - layout.parts.data())];
    const auto cell = [](double place, double size, int count) {
      return std::clamp(static_cast<int>(std::floor(place / size)), 0, count - 1);
    };
    for (int row = cell(at.y - reach, cut_.cell_height, cut_.rows); row <= cell(at.y + reach, cut_.cell_height, cut_.rows); ++row) {
      for (int column = cell(at.x - reach, cut_.cell_width, cut_.columns); column <= cell(at.x + reach, cut_.cell_width, cut_.columns);
           ++column) {
        const std::size_t index = static_cast<std::size_t>(row) * static_cast<std::size_t>(cut_.columns) + static_cast<std::size_t>(column);
        const void* const mark = group == nullptr ? static_cast<const void*>(&layout) : group;
        if (noted[index] == mark) continue;
        noted[index] = mark;
        cells[index].push_back(group == nullptr ? "bricks" : group->name);
      }
    }
  }
  for (int row = 0; row < cut_.rows; ++row) {
    for (int column = 0; column < cut_.columns; ++column) {
      auto& parts = cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(cut_.columns) + static_cast<std::size_t>(column)];
      if (!parts.empty()) pages_.push_back({column, row, std::move(parts)});
    }
  }
}

int Pages::number_at(int column, int row) const {
  const auto found = std::find_if(pages_.begin(), pages_.end(), [&](const Page& page) { return page.column == column && page.row == row; });
  return found == pages_.end() ? 0 : static_cast<int>(found - pages_.begin()) + 1;
}

View Pages::view_of(const Page& page) const {
  const Point corner{cell().x - page.column * cut_.cell_width - cut_.origin.x, cell().y - page.row * cut_.cell_height - cut_.origin.y};
  View view{.window = cut_.clip, .scale = scale_};
  view.zero = {corner.x - 1000.0 * bounds_.x / scale_, corner.y + 1000.0 * (bounds_.y + bounds_.height) / scale_};
  return view;
}

void Pages::draw_overview(Canvas& canvas, const View& view, Room& room) const {
  const double shrink = scale_ / view.scale;
  const Point corner = view.on_page(bounds_.x, bounds_.y + bounds_.height) + shrink * cut_.origin;
  const double width = shrink * cut_.cell_width, height = shrink * cut_.cell_height;
  for (std::size_t i = 0; i < pages_.size(); ++i) {
    const Rect rect{corner.x + pages_[i].column * width, corner.y + pages_[i].row * height, width, height};
    canvas.rect(rect);
    canvas.stroke(kPushInk, 0.25);
    const std::string number = std::to_string(i + 1);
    const double size = std::clamp(0.4 * std::fmin(width, height), kSmall, 5.0);
    const Rect tag{rect.x, rect.y, canvas.width_of(number, size, true) + 1.4, size + 0.8};
    canvas.rect(tag);
    canvas.fill_and_stroke(kWhite, kPushInk, 0.25);
    room.take(tag);
    canvas.text({tag.x + 0.7, tag.y + 0.9 * size + 0.2}, number, {.size = size, .ink = kPushInk, .bold = true});
  }
}

void Pages::draw_cuts(Canvas& canvas, const Page& page) const {
  constexpr double kFrom = 1.0, kTo = 6.0;
  const Rect in = cell(), out = cut_.clip;
  for (const double x : {in.x, in.right()}) {
    canvas.segment({x, out.y - kTo}, {x, out.y - kFrom}, kBlack, 0.18);
    canvas.segment({x, out.bottom() + kFrom}, {x, out.bottom() + kTo}, kBlack, 0.18);
  }
  for (const double y : {in.y, in.bottom()}) {
    canvas.segment({out.x - kTo, y}, {out.x - kFrom, y}, kBlack, 0.18);
    canvas.segment({out.right() + kFrom, y}, {out.right() + kTo, y}, kBlack, 0.18);
  }
  // Who lies beyond each edge.
  const auto neighbour = [&](int column, int row, const Point& at, double turn) {
    if (const int number = number_at(column, row); number > 0) {
      canvas.text(at, "sheet " + std::to_string(number), {.size = kSmall, .ink = kGrey, .align = Align::middle, .turn = turn});
    }
  };
  constexpr double kUp = 1.5707963267948966;
  neighbour(page.column, page.row - 1, {in.middle().x, out.y - 1.6}, 0.0);
  neighbour(page.column, page.row + 1, {in.middle().x, out.bottom() + 3.6}, 0.0);
  neighbour(page.column - 1, page.row, {out.x - 1.6, in.middle().y}, kUp);
  neighbour(page.column + 1, page.row, {out.right() + 3.6, in.middle().y}, kUp);
}

void Pages::draw_footer(Canvas& canvas, std::size_t number) const {
  const Page& page = pages_[number];
  const double y = cut_.paper.height - 10.0, left = cut_.clip.x + 8.0, right = cut_.clip.right() - 8.0;
  const std::string place = "Sheet " + std::to_string(number + 1) + " of " + std::to_string(pages_.size()) + ", " + scale_text(scale_);
  canvas.text({left, y}, place, {.size = 3.4, .bold = true});
  const double after = left + canvas.width_of(place, 3.4, true) + 4.0;
  constexpr double kBar = 52.0;
  std::string words = layout_.title.empty() ? layout_.name : layout_.title;
  words += ": ";
  for (std::size_t i = 0; i < page.parts.size(); ++i) words += (i == 0 ? "" : ", ") + page.parts[i];
  canvas.text({after, y}, canvas.fitted(words, right - kBar - 6.0 - after, kSmall), {.size = kSmall});
  draw_scale_bar(canvas, {right - kBar, y - 3.6}, kBar, scale_);
}

void Pages::draw(Canvas& canvas, std::size_t page, const std::vector<Doubt>& doubts, bool lines) const {
  canvas.page(cut_.paper);
  const View view = view_of(pages_[page]);
  const std::vector<BrickId> bricks = bricks_in(layout_, view);
  canvas.clip(cut_.clip);
  draw_grid(canvas, view, false);
  if (lines) {
    draw_lines(canvas, layout_, view, bricks);
  } else {
    draw_bricks(canvas, layout_, view, bricks);
  }
  constexpr std::array<double, 2> kDashes = {2.0, 1.5};
  canvas.rect(cell());
  canvas.stroke(kGrey, 0.1, kDashes);
  // Words stay clear of the cuts, and of the coordinates at the edges.
  View inner = view;
  inner.window = cell().grown(-0.3);
  Room room(inner.window);
  room.take({view.window.x, view.window.y, view.window.width, kOverlap / 2.0 + 0.5});
  room.take({view.window.x, view.window.y, kOverlap / 2.0 + 0.5, view.window.height});
  draw_labels(canvas, layout_, inner, bricks, doubts, room, !lines);
  canvas.unclip();
  draw_cuts(canvas, pages_[page]);
  draw_footer(canvas, page);
}

}  // namespace topple::plan

// A plan of the whole layout, true to scale: paper and scale are chosen, then each sheet is drawn.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "export/plan/canvas.h"
#include "export/plan/drawing.h"
#include "export/plan/labels.h"
#include "export/plan/legend.h"
#include "export/plan/pages.h"
#include "export/plan/sheet.h"
#include "layout/text.h"
#include "topple/export.h"

namespace topple {
namespace {

using namespace plan;

constexpr double kThinnestDrawn = 0.3;   // Thinner bricks are not drawn one by one [mm].
constexpr std::size_t kMostDoubts = 20;  // Of each sort: more than a legend holds.
constexpr std::size_t kMostSheets = 500;

Result<void> check(const Layout& layout, const PlanConfig& config, bool pdf) {
  constexpr std::array<std::string_view, 7> kKnown = {"", "A4", "A3", "A2", "A1", "A0", "letter"};
  if (layout.bricks.empty()) return failure(layout.name + ": has no bricks to draw.");
  if (config.scale != 0.0 && !(config.scale >= 1.0 && config.scale <= 100000.0)) {
    return failure("The scale 1:" + number_text(config.scale) + " is not between 1:1 and 1:100000.");
  }
  if (std::find(kKnown.begin(), kKnown.end(), config.paper) == kKnown.end()) {
    return failure("The paper '" + config.paper + "' is not A4, A3, A2, A1, A0 or letter.");
  }
  if (!pdf && config.scale != 0.0 && !config.paper.empty()) {
    return failure("An SVG is one drawing: give its scale, and it is as large as it must be, or its paper, but not both.");
  }
  return {};
}

/// "1,240 x 560 x 48 mm", in m where it is large.
std::string size_text(const LayoutSummary& summary) {
  const Vec3 size = summary.high - summary.low;
  const bool large = std::fmax(size.x, size.y) >= 10.0;
  const auto words = [large](double metres) {
    return large ? number_text(std::round(metres * 100.0) / 100.0) : count_text(std::llround(std::round(metres * 1e4) / 10.0));
  };
  return words(size.x) + " \u00d7 " + words(size.y) + " \u00d7 " + words(size.z) + (large ? " m" : " mm");
}

/// Draws one plan; its parts share what was found about the layout.
class Draughtsman {
 public:
  Draughtsman(const Layout& layout, const PlanConfig& config, bool pdf)
      : layout_(layout), pdf_(pdf), summary_(summarize(layout)), doubts_(find_doubts(layout, kMostDoubts)) {
    const Vec3 size = summary_.high - summary_.low;
    bounds_ = {summary_.low.x, summary_.low.y, size.x, size.y};
    choice_ = choose(bounds_, thinnest(layout), config, !pdf);
  }

  Result<PlanSheets> draw(const std::filesystem::path& path) {
    PlanSheets made{.scale = choice_.scale, .paper = choice_.paper, .bricks = !lines_at(choice_.scale)};
    Canvas canvas(pdf_ ? Canvas::Format::pdf : Canvas::Format::svg, choice_.sheet.paper, title_words());
    if (choice_.several) {
      if (Result<int> sheets = draw_several(canvas); !sheets) {
        return std::unexpected(sheets.error());
      } else {
        made.sheets = *sheets;
      }
    } else {
      draw_whole(canvas, nullptr);
    }
    const Result<std::string> bytes = canvas.finish();
    if (!bytes) return std::unexpected(bytes.error());
    if (const Result<void> saved = save_bytes(*bytes, path); !saved) return std::unexpected(saved.error());
    return made;
  }

 private:
  std::string title_words() const { return layout_.title.empty() ? layout_.name : layout_.title; }
  bool lines_at(double scale) const { return 1000.0 * thinnest(layout_) / scale < kThinnestDrawn; }

  Result<int> draw_several(Canvas& canvas) {
    const Cut cut = plan::cut({1000.0 * bounds_.width / choice_.scale, 1000.0 * bounds_.height / choice_.scale}, choice_.paper);
    constexpr int kMostCells = 1'000'000;
    if (std::int64_t{cut.columns} * cut.rows > kMostCells) return too_many("more than a million");
    const Pages pages(layout_, bounds_, choice_.scale, choice_.paper);
    if (pages.count() > kMostSheets) return too_many(count_text(static_cast<long long>(pages.count())));
    draw_whole(canvas, &pages);
    for (std::size_t page = 0; page < pages.count(); ++page) pages.draw(canvas, page, doubts_, lines_at(choice_.scale));
    return static_cast<int>(pages.count());
  }

  std::unexpected<Error> too_many(const std::string& sheets) const {
    return failure("At " + scale_text(choice_.scale) + " the plan takes " + sheets + " sheets of " + choice_.paper +
                   "; at most 500 are drawn. One sheet of it holds all at " + scale_text(choice_.overview) + ".");
  }

  /// The whole layout on one sheet; with `pages`, which sheet of them is where.
  void draw_whole(Canvas& canvas, const Pages* pages) {
    const Sheet& sheet = choice_.sheet;
    const View view = centred(sheet.window(), choice_.overview, bounds_);
    const bool lines = lines_at(view.scale);
    // Marks in the drawing are of those doubts that the legend has room to tell.
    doubts_.resize(draw_tables(canvas, sheet.columns, layout_, doubts_, signs(lines, pages != nullptr)));
    const std::vector<BrickId> bricks = bricks_in(layout_, view);
    draw_grid(canvas, view, true);
    canvas.clip(sheet.window());
    if (lines) {
      draw_lines(canvas, layout_, view, bricks);
    } else {
      draw_bricks(canvas, layout_, view, bricks);
    }
    Room room(sheet.window());
    if (pages != nullptr) {
      pages->draw_overview(canvas, view, room);
    } else {
      draw_dimensions(canvas, view, bounds_);
      take_dimensions(view, room);
    }
    draw_labels(canvas, layout_, view, bricks, doubts_, room, !lines && pages == nullptr);
    canvas.unclip();
    draw_title(canvas, sheet.title, title(view.scale, pages));
  }

  void take_dimensions(const View& view, Room& room) const {
    const Point low = view.on_page(bounds_.x, bounds_.y), high = view.on_page(bounds_.x + bounds_.width, bounds_.y + bounds_.height);
    constexpr double kAround = 4.0;
    room.take({low.x - kAround, low.y + kBelow - kAround, high.x - low.x + 2.0 * kAround, kAround + 2.0});
    room.take({high.x + kBeside - kAround, high.y - kAround, kAround + 2.0, low.y - high.y + 2.0 * kAround});
  }

  Signs signs(bool lines, bool sheets) const {
    const bool balls = std::any_of(layout_.bricks.begin(), layout_.bricks.end(),
                                   [&](const Brick& brick) { return layout_.kinds[brick.kind].shape == Shape::ball; });
    return {.pushes = !layout_.pushes.empty(),
            .balls = balls,
            .stacked = any_stacked(layout_),
            .numbers = !lines && !sheets,
            .lines = lines,
            .sheets = sheets};
  }

  Title title(double scale, const Pages* pages) const {
    return {.title = layout_.title,
            .file = std::filesystem::path(layout_.name).filename().string(),
            .scale = scale_text(scale),
            .paper = choice_.paper,
            .sheets = pages == nullptr ? "1 of 1" : "all " + std::to_string(pages->count()) + ", of " + scale_text(choice_.scale),
            .bricks = count_text(summary_.bricks),
            .size = size_text(summary_),
            .bar_scale = scale};
  }

  const Layout& layout_;
  bool pdf_;
  LayoutSummary summary_;
  std::vector<Doubt> doubts_;
  Bounds bounds_;
  Choice choice_;
};

}  // namespace

Result<PlanSheets> draw_plan(const Layout& layout, const PlanConfig& config, const std::filesystem::path& path) {
  const bool pdf = path.extension() == ".pdf";
  if (!pdf && path.extension() != ".svg") return failure(path.string() + ": the name must end in .pdf or .svg.");
  if (const Result<void> good = check(layout, config, pdf); !good) return std::unexpected(good.error());
  return Draughtsman(layout, config, pdf).draw(path);
}

}  // namespace topple

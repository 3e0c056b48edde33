#include "export/plan/sheet.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "layout/text.h"

namespace topple::plan {
namespace {

constexpr double kMargin = 10.0;       // Of paper that printers leave white [mm].
constexpr double kColumn = 62.0;       // Width of a table [mm].
constexpr double kTitleHeight = 50.0;  // [mm]
// Around the layout, for dimensions and labels [mm].
constexpr double kLeft = 12.0, kRight = 20.0, kTop = 8.0, kBottom = 14.5;
constexpr double kSeen = 0.7;  // So thick a brick on paper is told from the next one [mm].
constexpr int kFewSheets = 60;

struct NamedPaper {
  const char* name;
  Size upright;
};
constexpr std::array<NamedPaper, 6> kPapers = {
    {{"A4", {210, 297}}, {"A3", {297, 420}}, {"A2", {420, 594}}, {"A1", {594, 841}}, {"A0", {841, 1189}}, {"letter", {215.9, 279.4}}}};
constexpr std::size_t kSeries = 5;  // A4 to A0.

Size across(const Size& upright) { return {upright.height, upright.width}; }

const NamedPaper& named(const std::string& name) {
  const auto* const found = std::find_if(kPapers.begin(), kPapers.end(), [&](const NamedPaper& paper) { return name == paper.name; });
  return found == kPapers.end() ? kPapers.front() : *found;
}

/// Tables in a strip below the drawing, or in a column on its right.
Sheet arranged(const Size& paper, bool strip) {
  const Rect frame{kMargin, kMargin, paper.width - 2.0 * kMargin, paper.height - 2.0 * kMargin};
  Sheet sheet{.paper = paper};
  if (strip) {
    const auto columns = std::max(2, static_cast<int>(frame.width / kColumn));
    const double width = frame.width / columns, top = frame.bottom() - kTitleHeight;
    sheet.field = {frame.x, frame.y, frame.width, frame.height - kTitleHeight};
    for (int i = 0; i + 1 < columns; ++i) sheet.columns.push_back({frame.x + i * width, top, width, kTitleHeight});
    sheet.title = {frame.right() - width, top, width, kTitleHeight};
    return sheet;
  }
  const double left = frame.right() - kColumn;
  sheet.field = {frame.x, frame.y, frame.width - kColumn, frame.height};
  sheet.columns.push_back({left, frame.y, kColumn, frame.height - kTitleHeight});
  sheet.title = {left, frame.bottom() - kTitleHeight, kColumn, kTitleHeight};
  return sheet;
}

Size needed(const Bounds& bounds, double scale) {
  return {1000.0 * bounds.width / scale + kLeft + kRight, 1000.0 * bounds.height / scale + kTop + kBottom};
}

/// The largest usual scale at which it fits; and how much room there is then, as a share of what is needed.
struct Fit {
  double scale = 0.0;
  double room = 0.0;
};

double usual(int step) {
  constexpr std::array<double, 4> kSteps = {1.0, 2.0, 2.5, 5.0};
  return kSteps[static_cast<std::size_t>(step % 4)] * std::pow(10.0, step / 4);
}

Fit fit(const Sheet& sheet, const Bounds& bounds) {
  const Rect window = sheet.window();
  for (int step = 0; step < 4 * 9; ++step) {
    const double scale = usual(step);
    const Size size = needed(bounds, scale);
    if (size.width <= window.width && size.height <= window.height) {
      return {scale, std::min(window.width / size.width, window.height / size.height)};
    }
  }
  return {1e9, 1.0};
}

/// The best way to lay a paper: the one with the largest scale, then with the most room.
std::pair<Sheet, Fit> best(const Size& upright, const Bounds& bounds) {
  std::pair<Sheet, Fit> found;
  for (const Size& paper : {across(upright), upright}) {
    for (const bool strip : {false, true}) {
      const Sheet sheet = arranged(paper, strip);
      const Fit here = fit(sheet, bounds);
      const bool better = found.second.scale == 0.0 || here.scale < found.second.scale ||
                          (here.scale == found.second.scale && here.room > found.second.room + 1e-9);
      if (better) found = {sheet, here};
    }
  }
  return found;
}

/// A sheet just as large as a scale needs.
Sheet made_for(const Bounds& bounds, double scale) {
  const Size field = needed(bounds, scale);
  const double width = std::max(field.width + 2.0 * kBand, 3.0 * kColumn);
  const double height = std::max(field.height + 2.0 * kBand, 60.0);
  return arranged({width + 2.0 * kMargin, height + kTitleHeight + 2.0 * kMargin}, true);
}

Choice chosen(const NamedPaper& paper, const Bounds& bounds, double scale) {
  const auto [sheet, largest] = best(paper.upright, bounds);
  const bool fits = scale == 0.0 || scale >= largest.scale;
  // A scale that is none of the usual ones may still fit; the sheet was laid for the usual one below it.
  return {.scale = scale == 0.0 ? largest.scale : scale,
          .paper = paper.name,
          .sheet = sheet,
          .overview = fits && scale != 0.0 ? scale : largest.scale,
          .several = !fits};
}

int sheets_of(const Bounds& bounds, double scale, const char* paper) {
  const Cut made = cut({1000.0 * bounds.width / scale, 1000.0 * bounds.height / scale}, paper);
  return made.columns * made.rows;
}

}  // namespace

Rect Sheet::window() const { return field.grown(-kBand); }

View centred(const Rect& window, double scale, const Bounds& bounds) {
  View view{.window = window, .scale = scale};
  const double width = 1000.0 * bounds.width / scale, height = 1000.0 * bounds.height / scale;
  const double left = window.x + kLeft + (window.width - kLeft - kRight - width) / 2.0;
  const double bottom = window.bottom() - kBottom - (window.height - kTop - kBottom - height) / 2.0;
  view.zero = {left - 1000.0 * bounds.x / scale, bottom + 1000.0 * bounds.y / scale};
  return view;
}

Choice choose(const Bounds& bounds, double thinnest, const PlanConfig& config, bool any_size) {
  if (any_size && config.scale > 0.0 && config.paper.empty()) {
    return {.scale = config.scale, .paper = "", .sheet = made_for(bounds, config.scale), .overview = config.scale};
  }
  if (!config.paper.empty()) return chosen(named(config.paper), bounds, config.scale);
  Choice choice;
  for (std::size_t i = 0; i < kSeries; ++i) {
    choice = chosen(kPapers[i], bounds, config.scale);
    if (config.scale > 0.0 ? !choice.several : 1000.0 * thinnest / choice.scale >= kSeen) return choice;
  }
  if (config.scale == 0.0) return choice;
  for (std::size_t i = 0; i < kSeries; ++i) {
    if (sheets_of(bounds, config.scale, kPapers[i].name) <= kFewSheets) return chosen(kPapers[i], bounds, config.scale);
  }
  return choice;
}

Cut cut(const Size& layout, const std::string& paper) {
  constexpr double kFooter = 10.0;
  Cut best_cut;
  int fewest = 0;
  const Size upright = named(paper).upright;
  for (const Size& size : {across(upright), upright}) {
    Cut made{.paper = size};
    made.clip = {kMargin, kMargin, size.width - 2.0 * kMargin, size.height - 2.0 * kMargin - kFooter};
    made.cell_width = made.clip.width - kOverlap;
    made.cell_height = made.clip.height - kOverlap;
    // A little white around the layout, so that no brick ends on a cut.
    constexpr double kBlank = 4.0;
    made.columns = static_cast<int>(std::fmin(std::ceil((layout.width + 2.0 * kBlank) / made.cell_width), 1e4));
    made.rows = static_cast<int>(std::fmin(std::ceil((layout.height + 2.0 * kBlank) / made.cell_height), 1e4));
    made.origin = {(layout.width - made.columns * made.cell_width) / 2.0, (layout.height - made.rows * made.cell_height) / 2.0};
    const int sheets = made.columns * made.rows;
    if (fewest == 0 || sheets < fewest) {
      fewest = sheets;
      best_cut = made;
    }
  }
  return best_cut;
}

std::string scale_text(double scale) { return "1:" + number_text(scale); }

std::string length_text(double metres) {
  if (metres >= 10.0) return number_text(std::round(metres * 100.0) / 100.0) + " m";
  const double mm = std::round(metres * 1e4) / 10.0;
  if (mm < 1000.0) return number_text(mm) + " mm";
  return count_text(static_cast<long long>(std::llround(mm))) + " mm";
}

}  // namespace topple::plan

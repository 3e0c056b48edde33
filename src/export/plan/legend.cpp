#include "export/plan/legend.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "export/plan/drawing.h"
#include "export/plan/labels.h"
#include "layout/text.h"
#include "topple/picture.h"

namespace topple::plan {
namespace {

constexpr double kLine = 3.7;  // From line to line of a table [mm].
constexpr double kPad = 2.2;   // Inside a box [mm].
constexpr double kSign = 8.0;  // Room for a sign before its words [mm].

/// A line of a table: something small on the left, words, and a number on the right.
struct Row {
  std::string words;
  std::string number;
  std::int64_t bricks = 0;  ///< That the number counts.
  bool heading = false;
  std::function<void(Canvas&, const Point&)> sign;  ///< Drawn around a point at the middle of the line's left end; may be empty.
  double indent = 0.0;                              ///< Of the words [mm].
  std::size_t stands_for = 1;                       ///< Rows, where it says how many are left out.
  bool goes_on = false;                             ///< The sentence of the row before.
};

/// Rows that may be cut off at any line but the first.
struct Table {
  std::vector<Row> rows;
  std::size_t least = 0;  ///< Rows that are kept where there is little room.
  std::string left_out;   ///< "and 12 more parts"; says the number of rows by "%".
};

/// Takes rows from a table's end; its last line then says what is missing.
void cut_to(Table& table, std::size_t rows) {
  if (table.rows.size() <= rows || rows < 2) return;
  while (rows > 2 && table.rows[rows - 1].goes_on) --rows;  // Whole sentences.
  Row last{.words = table.left_out, .indent = table.rows[rows - 2].indent, .stands_for = 0};
  for (std::size_t i = rows - 1; i < table.rows.size(); ++i) {
    last.bricks += table.rows[i].bricks;
    last.stands_for += table.rows[i].stands_for;
  }
  if (const std::size_t place = last.words.find('%'); place != std::string::npos)
    last.words.replace(place, 1, std::to_string(last.stands_for));
  if (last.bricks > 0) last.number = count_text(last.bricks);
  table.rows.resize(rows - 1);
  table.rows.push_back(std::move(last));
}

/// Words on as many lines as they need.
std::vector<std::string> wrapped(Canvas& canvas, const std::string& text, double width, double size, bool bold = false) {
  std::vector<std::string> lines(1);
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
    if (canvas.width_of(longer, size, bold) <= width || lines.back().empty()) {
      lines.back() = longer;
    } else {
      lines.push_back(word);
    }
    at = end + 1;
  }
  return lines;
}

std::string size_words(const BrickKind& kind) {
  const auto mm = [](double metres) { return number_text(std::round(metres * 1e5) / 100.0); };
  if (kind.shape == Shape::ball) return "diameter " + mm(kind.width) + " mm";
  return mm(kind.height) + " \u00d7 " + mm(kind.width) + " \u00d7 " + mm(kind.thickness) + " mm";
}

Row heading(std::string words, std::string number = "") {
  return {.words = std::move(words), .number = std::move(number), .heading = true};
}

Table kinds_table(const Layout& layout, const LayoutSummary& summary) {
  Table table{
      .rows = {heading("Height \u00d7 width \u00d7 thickness", count_text(summary.bricks))}, .least = 3, .left_out = "and % more kinds"};
  for (const LayoutSummary::Count& count : summary.kinds) {
    const auto kind = std::find_if(layout.kinds.begin(), layout.kinds.end(), [&](const BrickKind& one) { return one.name == count.name; });
    if (kind == layout.kinds.end()) continue;
    table.rows.push_back({.words = count.name + ", " + size_words(*kind), .number = count_text(count.bricks), .bricks = count.bricks});
  }
  return table;
}

Table colors_table(const Layout& layout) {
  std::vector<std::pair<std::int64_t, std::size_t>> counts(layout.colors.size());
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i].second = i;
  for (const Brick& brick : layout.bricks) --counts[brick.color].first;  // Negative, so that the most come first.
  std::sort(counts.begin(), counts.end());
  Table table{.rows = {heading("Colours", "bricks")}, .least = 3, .left_out = "and % more colours"};
  for (const auto& [count, index] : counts) {
    if (count == 0) continue;
    const Color color = layout.colors[index];
    const auto swatch = [color](Canvas& canvas, const Point& at) {
      canvas.rect({at.x + 0.2, at.y - 1.3, 5.6, 2.6});
      canvas.fill_and_stroke(color, kOutline, 0.13);
    };
    table.rows.push_back({.words = name_of(color), .number = count_text(-count), .bricks = -count, .sign = swatch, .indent = kSign});
  }
  // Of a run of shades the few most frequent.
  constexpr std::size_t kMany = 25, kFew = 12;
  if (table.rows.size() > kMany) cut_to(table, kFew);
  return table;
}

Table parts_table(const Layout& layout) {
  const std::vector<PartGroup> groups = part_groups(layout);
  Table table{.rows = {heading("Parts", "bricks")}, .least = 4, .left_out = "and % more parts"};
  const PartGroup* first = nullptr;  // Of single bricks that follow each other.
  for (const PartGroup& group : groups) {
    if (group.bricks == 1 && group.name.starts_with("brick ") && !table.rows.back().heading && first != nullptr) {
      Row& row = table.rows.back();
      row.words = first->name + " to " + group.name.substr(6);
      row.number = count_text(++row.bricks);
      continue;
    }
    first = group.bricks == 1 && group.name.starts_with("brick ") ? &group : nullptr;
    std::string words = group.name;
    if (group.count > 1) words += ", " + std::to_string(group.count) + " lines";
    if (group.height > 0.0) words += ", " + length_text(group.height) + " high";
    table.rows.push_back({.words = words, .number = count_text(group.bricks), .bricks = group.bricks});
  }
  return table;
}

Table doubts_table(Canvas& canvas, const std::vector<Doubt>& doubts, double width) {
  Table table{.least = 9, .left_out = "and more, as `topple layout` says"};
  if (doubts.empty()) return table;
  table.rows.push_back(heading("Where it may stop"));
  for (std::size_t i = 0; i < doubts.size(); ++i) {
    const auto mark = [number = i + 1](Canvas& on, const Point& at) { draw_doubt_mark(on, {at.x + 2.3, at.y + 0.1}, number); };
    bool first = true;
    for (const std::string& line : wrapped(canvas, doubts[i].words, width - kSign - 0.5, kSmall)) {
      table.rows.push_back({.words = line, .indent = kSign, .goes_on = !first});
      if (first) table.rows.back().sign = mark;
      first = false;
    }
  }
  return table;
}

Table signs_table(const Signs& signs) {
  Table table{.rows = {heading("Signs")}, .least = 8};
  const auto add = [&](const char* words, std::function<void(Canvas&, const Point&)> sign) {
    table.rows.push_back({.words = words, .sign = std::move(sign), .indent = kSign});
  };
  if (signs.pushes) {
    add("push, the way it goes", [](Canvas& canvas, const Point& at) { draw_push_arrow(canvas, {at.x + 6.4, at.y}, {1.0, 0.0}, 6.2); });
  }
  if (signs.balls) {
    add("ball, with its centre lines", [](Canvas& canvas, const Point& at) {
      canvas.circle({at.x + 3.0, at.y}, 1.3);
      canvas.fill_and_stroke(kPale, kOutline, 0.13);
      canvas.segment({at.x + 1.0, at.y}, {at.x + 5.0, at.y}, kBlack, 0.1);
      canvas.segment({at.x + 3.0, at.y - 1.8}, {at.x + 3.0, at.y + 1.8}, kBlack, 0.1);
    });
  }
  if (signs.stacked) {
    add("bricks on others are drawn over", [](Canvas& canvas, const Point& at) {
      canvas.rect({at.x + 0.6, at.y - 1.2, 5.0, 2.4});
      canvas.stroke(kBlack, 0.1, std::vector<double>{0.8, 0.6});
    });
    add("them; dashed: those on the floor", {});
  }
  if (signs.numbers) {
    add("number of a brick, from 0",
        [](Canvas& canvas, const Point& at) { canvas.text({at.x + 1.0, at.y + 0.9}, "40", {.size = kSmall, .ink = kGrey}); });
  }
  if (signs.lines) add("rows as lines: bricks are too small", {});
  if (signs.sheets) {
    add("sheet, along its cuts", [](Canvas& canvas, const Point& at) {
      canvas.rect({at.x + 0.6, at.y - 1.2, 5.0, 2.4});
      canvas.stroke(kPushInk, 0.25);
    });
  }
  if (table.rows.size() == 1) table.rows.clear();
  return table;
}

/// Cuts the longest tables until all fit in so many lines.
void shorten(std::vector<Table>& tables, std::size_t room) {
  std::vector<std::size_t> rows;
  rows.reserve(tables.size());
  for (const Table& table : tables) rows.push_back(table.rows.size());
  const auto needed = [&] { return std::accumulate(rows.begin(), rows.end(), rows.size()) - 1; };
  while (needed() > room) {
    std::size_t longest = rows.size();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i] > tables[i].least && (longest == rows.size() || rows[i] > rows[longest])) longest = i;
    }
    if (longest == rows.size()) break;
    --rows[longest];
  }
  for (std::size_t i = 0; i < rows.size(); ++i) cut_to(tables[i], rows[i]);
}

/// How many doubts a table tells.
std::size_t doubts_in(const Table& table) {
  return static_cast<std::size_t>(
      std::count_if(table.rows.begin(), table.rows.end(), [](const Row& row) { return static_cast<bool>(row.sign); }));
}

void draw_row(Canvas& canvas, const Row& row, const Rect& line) {
  const double base = line.y + 0.74 * line.height;
  const double size = kSmall;
  const double number = row.number.empty() ? 0.0 : canvas.width_of(row.number, size, row.heading) + 1.5;
  if (row.sign) row.sign(canvas, {line.x, line.y + line.height / 2.0});
  const std::string words = canvas.fitted(row.words, line.width - row.indent - number, size, row.heading);
  canvas.text({line.x + row.indent, base}, words, {.size = size, .bold = row.heading});
  if (!row.number.empty()) canvas.text({line.right(), base}, row.number, {.size = size, .bold = row.heading, .align = Align::right});
  if (row.heading) canvas.segment({line.x, line.bottom() - 0.1}, {line.right(), line.bottom() - 0.1}, kBlack, 0.18);
}

}  // namespace

void draw_title(Canvas& canvas, const Rect& rect, const Title& title) {
  canvas.rect(rect);
  canvas.stroke(kBlack, 0.5);
  const double left = rect.x + kPad, width = rect.width - 2.0 * kPad;
  constexpr double kLarge = 4.2, kLess = 3.4;
  const std::string& name = title.title.empty() ? title.file : title.title;
  double y = rect.y + 6.2;
  if (canvas.width_of(name, kLarge, true) <= width) {
    canvas.text({left, y}, name, {.size = kLarge, .bold = true});
  } else {
    const auto lines = wrapped(canvas, name, width, kLess, true);
    canvas.text({left, y -= 0.6}, canvas.fitted(lines[0], width, kLess, true), {.size = kLess, .bold = true});
    std::string rest;
    for (std::size_t i = 1; i < lines.size(); ++i) rest += (i == 1 ? "" : " ") + lines[i];
    if (!rest.empty()) canvas.text({left, y += 4.4}, canvas.fitted(rest, width, kLess, true), {.size = kLess, .bold = true});
  }
  canvas.text({left, y += 4.0}, canvas.fitted(title.file, width, kSmall), {.size = kSmall, .ink = kGrey});
  // Two lines of cells at the foot of the block, the scale bar above them.
  constexpr double kCell = 8.6;
  const double bar = rect.bottom() - 2.0 * kCell - 8.4;
  draw_scale_bar(canvas, {left, bar}, width, title.bar_scale);
  const auto cell = [&](int row, double from, double to, const char* what, const std::string& words) {
    const double x = rect.x + from * rect.width, top = rect.bottom() - (2 - row) * kCell;
    canvas.rect({x, top, (to - from) * rect.width, kCell});
    canvas.stroke(kBlack, 0.2);
    canvas.text({x + 1.2, top + 3.1}, what, {.size = kSmall, .ink = kGrey});
    const double room = (to - from) * rect.width - 2.0;
    const double size = canvas.width_of(words, 3.2, true) <= room ? 3.2 : kSmall;
    canvas.text({x + 1.2, top + 7.1}, canvas.fitted(words, room, size, true), {.size = size, .bold = true});
  };
  cell(0, 0.0, 0.32, "scale", title.scale);
  cell(0, 0.32, 0.62, "paper", title.paper.empty() ? "as needed" : title.paper);
  cell(0, 0.62, 1.0, "sheet", title.sheets);
  cell(1, 0.0, 0.32, "bricks", title.bricks);
  cell(1, 0.32, 1.0, "length \u00d7 width \u00d7 height", title.size);
}

std::size_t draw_tables(Canvas& canvas, const std::vector<Rect>& columns, const Layout& layout, const std::vector<Doubt>& doubts,
                        const Signs& signs) {
  constexpr std::size_t kDoubts = 3;  // Their place among the tables.
  std::vector<Table> tables = {kinds_table(layout, summarize(layout)), colors_table(layout), parts_table(layout),
                               doubts_table(canvas, doubts, columns.front().width - 2.0 * kPad), signs_table(signs)};
  const auto lines = static_cast<std::size_t>((columns.front().height - 2.0 * kPad) / kLine);
  shorten(tables, lines * columns.size() - columns.size());
  const std::size_t told = doubts_in(tables[kDoubts]);
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  const Rect& left = columns.front();
  canvas.rect({left.x, left.y, columns.back().right() - left.x, left.height});
  canvas.stroke(kBlack, 0.5);
  std::size_t apart = 0;  // Columns, if each table begins one.
  for (const Table& table : tables) apart += (table.rows.size() + lines - 1) / lines;
  std::size_t line = 0;
  for (const Table& table : tables) {
    const std::size_t in_column = line % lines;
    // A line between tables, and no heading alone at a column's foot.
    if (in_column > 0) line += apart <= columns.size() || in_column + 4 > lines ? lines - in_column : 1;
    for (const Row& row : table.rows) {
      const std::size_t column = line / lines;
      if (column >= columns.size()) return told;
      const Rect& in = columns[column];
      if (line % lines == 0 && column > 0) canvas.segment({in.x, in.y}, {in.x, in.bottom()}, kBlack, 0.2);
      draw_row(canvas, row, {in.x + kPad, in.y + kPad + static_cast<double>(line % lines) * kLine, in.width - 2.0 * kPad, kLine});
      ++line;
    }
  }
  return told;
}

}  // namespace topple::plan

#include "export/plan/labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "export/plan/drawing.h"
#include "layout/text.h"

namespace topple::plan {
namespace {

constexpr double kClear = 0.5;  // Around words [mm].

const Brick& put_of(const Layout& layout, BrickId brick) { return layout.bricks[static_cast<std::size_t>(brick)]; }

/// The box that words take, around its middle.
Rect box_of(const Point& middle, double width, double size) { return {middle.x - width / 2.0, middle.y - size / 2.0, width, size}; }

/// How far a box reaches from its middle in a direction.
double reach(const Rect& box, const Point& way) { return std::abs(way.x) * box.width / 2.0 + std::abs(way.y) * box.height / 2.0; }

/// The letters of a box sit a little above its lower edge.
Point baseline(const Rect& box) { return {box.x, box.y + 0.86 * box.height}; }

/// Where a mark goes from, and which way.
struct Anchor {
  Point at;   ///< On the edge of what it belongs to.
  Point way;  ///< Away from there; of length 1.
};

/// The first free place for a box beside its anchors, the nearest first.
struct Place {
  Rect box;
  Anchor from;
  double away = 0.0;  ///< [mm]
};
std::optional<Place> free_place(const Room& room, const std::vector<Anchor>& anchors, const Size& words, double farthest,
                                std::uint32_t owner = 0) {
  constexpr double kOthers = 3.0;  // A name so near to bricks of another part would seem to be theirs [mm].
  double away = 1.1;
  while (away <= farthest) {
    for (const Anchor& anchor : anchors) {
      const Rect wanted = box_of({0.0, 0.0}, words.width, words.height);
      const Point middle = anchor.at + (away + reach(wanted, anchor.way)) * anchor.way;
      const Rect box = box_of(middle, words.width, words.height);
      if (!room.is_free(box.grown(kClear)) || (owner != 0 && room.has_others(box.grown(kOthers), owner))) continue;
      return Place{box, anchor, away};
    }
    away += away < 4.0 ? 1.0 : 2.5;
  }
  return std::nullopt;
}

class Labeller {
 public:
  Labeller(Canvas& canvas, const Layout& layout, const View& view, const std::vector<BrickId>& bricks, Room& room)
      : canvas_(canvas), layout_(layout), view_(view), room_(room), groups_(part_groups(layout)) {
    for (const BrickId brick : bricks) {
      const Point at = middle(brick);
      if (const Part* part = layout_.part_of(brick); part != nullptr && view_.window.has(at)) {
        seen_[static_cast<std::size_t>(part - layout_.parts.data())].push_back(brick);
      }
    }
    for (auto& [part, seen] : seen_) std::sort(seen.begin(), seen.end());
    owners_.resize(layout_.parts.size());
    std::uint32_t owner = Room::kNobody;
    for (const PartGroup& group : groups_) {
      ++owner;
      for (std::size_t part = group.first; part < group.first + group.count; ++part) owners_[part] = owner;
    }
  }

  void take_bricks(const std::vector<BrickId>& bricks) {
    for (const BrickId brick : bricks) {
      const auto c = footprint(layout_, brick, view_);
      const Part* const part = layout_.part_of(brick);
      const std::uint32_t owner = part == nullptr ? Room::kNobody : owners_[static_cast<std::size_t>(part - layout_.parts.data())];
      room_.take_line(0.5 * (c[0] + c[3]), 0.5 * (c[1] + c[2]), length(c[0] - c[3]), owner);
    }
  }

  void mark_pushes() {
    std::vector<std::pair<Point, std::string>> words;
    for (const Push& push : layout_.pushes) {
      const Point heading = heading_on_page(put_of(layout_, push.brick));
      const Point tip = middle(push.brick) - (half_along(push.brick) + 0.7) * heading;
      if (!view_.window.has(tip)) continue;
      draw_push_arrow(canvas_, tip, heading, kPushArrow);
      room_.take_line(tip - kPushArrow * heading, tip, 2.2);
      words.emplace_back(tip - 0.55 * kPushArrow * heading, push.at > 0.0 ? "push, " + number_text(push.at) + " s" : "push");
      const Point across{heading.y, -heading.x};
      ways_.push_back(across);
    }
    for (std::size_t i = 0; i < words.size(); ++i) {
      const Point way = ways_[i].y > 0.0 ? -1.0 * ways_[i] : ways_[i];
      put_words(words[i].second, {{words[i].first + 0.8 * way, way}, {words[i].first - 0.8 * way, -1.0 * way}}, kPushInk, 3.0);
    }
  }

  void mark_doubts(const std::vector<Doubt>& doubts) {
    constexpr double kAcross = 4.4;
    for (std::size_t i = 0; i < doubts.size(); ++i) {
      if (doubts[i].brick == kNoBrick || !view_.window.has(middle(doubts[i].brick))) continue;
      const auto place = free_place(room_, around(doubts[i].brick), {kAcross, kAcross}, 30.0);
      if (!place) continue;
      leader(*place, kDoubtInk);
      draw_doubt_mark(canvas_, place->box.middle(), i + 1);
      room_.take(place->box);
    }
  }

  void name_groups() {
    std::uint32_t owner = Room::kNobody;
    for (const PartGroup& group : groups_) {
      ++owner;
      const bool many = group.count > 1;
      std::vector<BrickId> seen;
      for (std::size_t part = group.first; part < group.first + group.count; ++part) {
        if (const auto found = seen_.find(part); found != seen_.end()) seen.insert(seen.end(), found->second.begin(), found->second.end());
      }
      if (seen.empty()) continue;
      std::string words;
      if (group.bricks > 1) words = " \u00b7 " + count_text(group.bricks);
      if (group.height > 0.0) words += ", " + length_text(group.height) + " high";
      const bool line = !many && layout_.parts[group.first].line && seen.size() > 1;
      put_name(owner, group.name, words, line ? along(seen) : around_all(seen), line ? 26.0 : 18.0);
      if (many) name_rows(group);
    }
  }

  /// Rows of a field, at their far end, so many that their names stand clear of each other.
  void name_rows(const PartGroup& group) {
    constexpr std::array<std::size_t, 6> kEvery = {1, 2, 5, 10, 20, 50};
    constexpr double kLine = 1.4 * kSmall;
    const double apart = row_distance(group);
    const auto* const every =
        std::find_if(kEvery.begin(), kEvery.end(), [&](std::size_t n) { return static_cast<double>(n) * apart >= kLine; });
    if (every == kEvery.end()) return;
    std::size_t row = 0;
    for (std::size_t part = group.first; part < group.first + group.count; ++part) {
      const std::string& name = layout_.parts[part].name;
      if (!name.starts_with(group.name + " row ")) continue;
      ++row;
      const auto found = seen_.find(part);
      if ((row != 1 && row % *every != 0) || found == seen_.end() || found->second.size() < 2) continue;
      const BrickId last = found->second.back();
      const Point heading = heading_on_page(put_of(layout_, last));
      put_words(name.substr(group.name.size() + 1), {{middle(last) + half_along(last) * heading, heading}}, kGrey, 1.2);
    }
  }

  void number_bricks() {
    for (const auto& [part, seen] : seen_) {
      if (!layout_.parts[part].line || layout_.parts[part].count < 4 || seen.size() < 2) continue;
      double way = 0.0;
      for (std::size_t i = 1; i < seen.size(); ++i) way += length(middle(seen[i]) - middle(seen[i - 1]));
      const double pitch = way / static_cast<double>(seen.size() - 1);
      const double width = canvas_.width_of(std::to_string(seen.back()), kSmall);
      BrickId step = view_.scale <= 2.0 ? 5 : 10;
      while (step < 1'000'000 && step * pitch < width + 5.0) step = next_round(step);
      for (const BrickId brick : seen) {
        if (brick % step == 0) number(brick);
      }
    }
  }

 private:
  /// 10, 20, 50, 100 ...
  static BrickId next_round(BrickId step) { return std::to_string(step).front() == '2' ? step / 2 * 5 : 2 * step; }

  Point middle(BrickId brick) const {
    const Vec3& foot = put_of(layout_, brick).foot;
    return view_.on_page(foot.x, foot.y);
  }
  Extents size_of(BrickId brick) const { return extents(layout_.kind_of(brick), put_of(layout_, brick).stance); }
  double half_along(BrickId brick) const { return view_.on_page(size_of(brick).along) / 2.0; }
  double half_across(BrickId brick) const { return view_.on_page(size_of(brick).across) / 2.0; }

  /// To both sides of a brick, first to the one that is up on the page.
  std::array<Anchor, 2> sides(BrickId brick) const {
    const Point heading = heading_on_page(put_of(layout_, brick));
    Point up{heading.y, -heading.x};
    if (up.y > 1e-9 || (up.y > -1e-9 && up.x < 0.0)) up = -1.0 * up;
    const Point half = half_across(brick) * up;
    return {Anchor{middle(brick) + half, up}, Anchor{middle(brick) - half, -1.0 * up}};
  }

  /// All around one brick.
  std::vector<Anchor> around(BrickId brick) const {
    std::vector<Anchor> anchors;
    const auto both = sides(brick);
    anchors.assign(both.begin(), both.end());
    constexpr double kDiagonal = 0.70710678118654752;
    for (const Point& way :
         {Point{kDiagonal, -kDiagonal}, Point{-kDiagonal, -kDiagonal}, Point{kDiagonal, kDiagonal}, Point{-kDiagonal, kDiagonal}}) {
      anchors.push_back({middle(brick) + (reach_of(layout_, brick, view_) * 0.8) * way, way});
    }
    return anchors;
  }

  /// Beside a line: its middle first, then ever nearer to its ends.
  std::vector<Anchor> along(const std::vector<BrickId>& seen) const {
    std::vector<Anchor> anchors;
    for (const double share : {0.5, 0.42, 0.58, 0.33, 0.67, 0.22, 0.78, 0.1, 0.9}) {
      const auto both = sides(seen[static_cast<std::size_t>(share * static_cast<double>(seen.size() - 1))]);
      anchors.insert(anchors.end(), both.begin(), both.end());
    }
    return anchors;
  }

  /// Beside the box of what is no line.
  std::vector<Anchor> around_all(const std::vector<BrickId>& seen) const {
    Point low = middle(seen.front()), high = low;
    for (const BrickId brick : seen) {
      for (const Point& corner : footprint(layout_, brick, view_)) {
        low = {std::fmin(low.x, corner.x), std::fmin(low.y, corner.y)};
        high = {std::fmax(high.x, corner.x), std::fmax(high.y, corner.y)};
      }
    }
    std::vector<Anchor> anchors;
    for (const double share : {0.5, 0.25, 0.75, 0.05, 0.95}) {
      const double x = low.x + share * (high.x - low.x), y = low.y + share * (high.y - low.y);
      anchors.push_back({{x, low.y}, {0.0, -1.0}});
      anchors.push_back({{x, high.y}, {0.0, 1.0}});
      anchors.push_back({{high.x, y}, {1.0, 0.0}});
      anchors.push_back({{low.x, y}, {-1.0, 0.0}});
    }
    return anchors;
  }

  /// From a field's first row to its last, a row [mm].
  double row_distance(const PartGroup& group) const {
    std::vector<Point> ends;
    for (std::size_t part = group.first; part < group.first + group.count; ++part) {
      const Part& here = layout_.parts[part];
      if (here.name.starts_with(group.name + " row ") && here.count > 0) ends.push_back(middle(here.first + here.count - 1));
    }
    return ends.size() < 2 ? 0.0 : length(ends.back() - ends.front()) / static_cast<double>(ends.size() - 1);
  }

  void leader(const Place& place, const Color& ink) {
    if (place.away < 3.5) return;
    const Point end = place.box.middle() - reach(place.box, place.from.way) * place.from.way;
    canvas_.segment(place.from.at, end, ink, 0.13);
    canvas_.circle(place.from.at, 0.3);
    canvas_.fill(ink);
    room_.take_line(place.from.at, end, 0.3);
  }

  void put_words(const std::string& words, const std::vector<Anchor>& anchors, const Color& ink, double farthest) {
    const auto place = free_place(room_, anchors, {canvas_.width_of(words, kSmall), kSmall}, farthest);
    if (!place) return;
    blank(place->box);
    canvas_.text(baseline(place->box), words, {.size = kSmall, .ink = ink});
  }

  /// The name in bold letters, what there is to say of it behind.
  void put_name(std::uint32_t owner, const std::string& name, const std::string& more, const std::vector<Anchor>& anchors,
                double farthest) {
    const double bold = canvas_.width_of(name, kNormal, true);
    const Size words{bold + canvas_.width_of(more, kNormal), kNormal};
    auto place = free_place(room_, anchors, words, farthest, owner);
    if (!place) place = free_place(room_, anchors, words, farthest);
    if (!place) return;
    leader(*place, kGrey);
    blank(place->box);
    const Point begin = baseline(place->box);
    canvas_.text(begin, name, {.bold = true});
    canvas_.text({begin.x + bold, begin.y}, more);
  }

  /// No grid behind words.
  void blank(const Rect& box) {
    canvas_.rect(box.grown(0.15));
    canvas_.fill(kWhite);
    room_.take(box);
  }

  void number(BrickId brick) {
    const std::string words = std::to_string(brick);
    const auto both = sides(brick);
    const double width = canvas_.width_of(words, kSmall);
    const auto place = free_place(room_, {both.begin(), both.end()}, {width, kSmall}, 1.2);
    if (!place) return;
    canvas_.segment(place->from.at + 0.15 * place->from.way, place->from.at + 0.85 * place->from.way, kGrey, 0.13);
    canvas_.text(baseline(place->box), words, {.size = kSmall, .ink = kGrey});
    room_.take(place->box);
  }

  Canvas& canvas_;
  const Layout& layout_;
  const View& view_;
  Room& room_;
  std::vector<PartGroup> groups_;
  std::vector<std::uint32_t> owners_;                 // Of parts: what their bricks take is told apart by group.
  std::map<std::size_t, std::vector<BrickId>> seen_;  // Bricks in the window, by part.
  std::vector<Point> ways_;
};

/// "field 1" of "field 1 row 12" and of "field 1 line".
std::string group_name(const std::string& part) {
  if (!part.starts_with("field ")) return part;
  const std::size_t end = part.find(' ', 6);
  return part.substr(0, end);
}

}  // namespace

Room::Room(const Rect& window) : window_(window) {
  constexpr double kMostCells = 16e6;
  cell_ = std::fmax(0.4, std::sqrt(window.width * window.height / kMostCells));
  columns_ = static_cast<std::int64_t>(window.width / cell_) + 1;
  rows_ = static_cast<std::int64_t>(window.height / cell_) + 1;
  taken_.resize(static_cast<std::size_t>(columns_ * rows_));
}

Room::Span Room::cells(const Rect& rect) const {
  const auto cell = [this](double place, double from, std::int64_t count) {
    return std::clamp(static_cast<std::int64_t>(std::floor((place - from) / cell_)), std::int64_t{0}, count - 1);
  };
  return {cell(rect.x, window_.x, columns_), cell(rect.right(), window_.x, columns_), cell(rect.y, window_.y, rows_),
          cell(rect.bottom(), window_.y, rows_)};
}

void Room::take(const Rect& rect, std::uint32_t owner) {
  if (rect.right() < window_.x || rect.x > window_.right() || rect.bottom() < window_.y || rect.y > window_.bottom()) return;
  const Span span = cells(rect);
  for (std::int64_t y = span.top; y <= span.bottom; ++y) {
    std::fill_n(taken_.begin() + y * columns_ + span.left, span.right - span.left + 1, owner);
  }
}

void Room::take_line(const Point& from, const Point& to, double width, std::uint32_t owner) {
  const Point way = to - from;
  const double far = length(way);
  const Point along = far > 0.0 ? (1.0 / far) * way : Point{1.0, 0.0}, across{-along.y, along.x};
  const auto lanes = static_cast<int>(width / cell_) + 1, steps = static_cast<int>(far / cell_) + 1;
  for (int lane = 0; lane <= lanes; ++lane) {
    const Point begin = from + (width * (static_cast<double>(lane) / lanes - 0.5)) * across;
    for (int step = 0; step <= steps; ++step) {
      const Point at = begin + (far * step / steps) * along;
      take({at.x, at.y, 0.0, 0.0}, owner);
    }
  }
}

bool Room::is_free(const Rect& rect) const {
  if (!window_.has(rect)) return false;
  const Span span = cells(rect);
  for (std::int64_t y = span.top; y <= span.bottom; ++y) {
    const auto row = taken_.begin() + y * columns_;
    if (std::any_of(row + span.left, row + span.right + 1, [](std::uint32_t cell) { return cell != 0; })) return false;
  }
  return true;
}

bool Room::has_others(const Rect& rect, std::uint32_t owner) const {
  const Span span = cells(rect);
  for (std::int64_t y = span.top; y <= span.bottom; ++y) {
    const auto row = taken_.begin() + y * columns_;
    const auto other = [owner](std::uint32_t cell) { return cell > kNobody && cell != owner; };
    if (std::any_of(row + span.left, row + span.right + 1, other)) return true;
  }
  return false;
}

std::vector<PartGroup> part_groups(const Layout& layout) {
  std::vector<PartGroup> groups;
  for (std::size_t i = 0; i < layout.parts.size(); ++i) {
    const Part& part = layout.parts[i];
    if (part.count == 0) continue;
    const std::string name = group_name(part.name);
    if (groups.empty() || groups.back().name != name) {
      groups.push_back({.name = name, .first = i});
    } else {
      groups.back().count = i + 1 - groups.back().first;
    }
    groups.back().bricks += part.count;
    for (BrickId brick = part.first; !part.line && part.count > 1 && brick < part.first + part.count; ++brick) {
      const Brick& put = put_of(layout, brick);
      groups.back().height = std::fmax(groups.back().height, put.foot.z + extents(layout.kinds[put.kind], put.stance).up);
    }
  }
  return groups;
}

void draw_push_arrow(Canvas& canvas, const Point& tip, const Point& heading, double size) {
  canvas.segment(tip - size * heading, tip - 1.6 * heading, kPushInk, 0.55);
  canvas.arrow_head(tip, tip - heading, 2.6, kPushInk);
}

void draw_doubt_mark(Canvas& canvas, const Point& middle, std::size_t number) {
  canvas.circle(middle, 2.1);
  canvas.fill_and_stroke(kWhite, kDoubtInk, 0.35);
  canvas.text({middle.x, middle.y + 0.92}, std::to_string(number),
              {.size = kSmall, .ink = kDoubtInk, .bold = true, .align = Align::middle});
}

void draw_labels(Canvas& canvas, const Layout& layout, const View& view, const std::vector<BrickId>& bricks,
                 const std::vector<Doubt>& doubts, Room& room, bool numbers) {
  Labeller labeller(canvas, layout, view, bricks, room);
  labeller.take_bricks(bricks);
  labeller.mark_pushes();
  labeller.mark_doubts(doubts);
  labeller.name_groups();
  if (numbers) labeller.number_bricks();
}

}  // namespace topple::plan

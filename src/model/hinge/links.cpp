#include "model/hinge/links.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "base/trigonometry.h"

namespace topple::hinge {

namespace {

constexpr std::size_t kMostProblems = 10;
constexpr std::size_t kBlock = 16;  // Bricks that are boxed together in the search; affects speed only.

struct Axis {
  double x = 1.0;
  double y = 0.0;
};

std::string number(double value) {
  std::string text = std::to_string(value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}
std::string millimetres(double metres) { return number(std::round(metres * 1e5) / 100.0) + " mm"; }

struct Rectangle {
  double low_x, low_y, high_x, high_y;

  bool overlaps(const Rectangle& o) const { return low_x <= o.high_x && o.low_x <= high_x && low_y <= o.high_y && o.low_y <= high_y; }
  void cover(const Rectangle& o) {
    low_x = std::min(low_x, o.low_x);
    low_y = std::min(low_y, o.low_y);
    high_x = std::max(high_x, o.high_x);
    high_y = std::max(high_y, o.high_y);
  }
};

// A rectangle on the floor: middle, direction, half sizes along and across [m].
struct Patch {
  double x, y;
  Axis axis;
  double along, across;

  Rectangle bounds() const {
    const double dx = std::fabs(axis.x) * along + std::fabs(axis.y) * across;
    const double dy = std::fabs(axis.y) * along + std::fabs(axis.x) * across;
    return {x - dx, y - dy, x + dx, y + dy};
  }
};

bool separated_along(const Axis& axis, const Patch& a, const Patch& b) {
  const double distance = std::fabs((b.x - a.x) * axis.x + (b.y - a.y) * axis.y);
  const auto reach = [&](const Patch& p) {
    return std::fabs(p.axis.x * axis.x + p.axis.y * axis.y) * p.along + std::fabs(p.axis.x * axis.y - p.axis.y * axis.x) * p.across;
  };
  return distance >= reach(a) + reach(b);
}
bool overlap(const Patch& a, const Patch& b) {
  for (const Axis& axis : {a.axis, Axis{-a.axis.y, a.axis.x}, b.axis, Axis{-b.axis.y, b.axis.x}}) {
    if (separated_along(axis, a, b)) return false;
  }
  return true;
}

class Search {
 public:
  explicit Search(const Layout& layout) : layout_(layout), links_(layout.bricks.size()) {}

  Result<std::vector<Link>> run();

 private:
  const Brick& brick(BrickId id) const { return layout_.bricks[static_cast<std::size_t>(id)]; }
  Link& link(BrickId id) { return links_[static_cast<std::size_t>(id)]; }
  Axis axis_of(BrickId id) const {
    const double heading = brick(id).heading;
    if (heading != last_heading_) {  // A row has one heading.
      const SinCos turned = sin_cos(heading);
      last_heading_ = heading;
      last_axis_ = {turned.cos, turned.sin};
    }
    return last_axis_;
  }
  Patch footprint(BrickId id) const {
    const Brick& b = brick(id);
    const BrickKind& kind = layout_.kind_of(id);
    return {b.foot.x, b.foot.y, axis_of(id), 0.5 * kind.thickness, 0.5 * kind.width};
  }
  // Where it lies once it has fallen flat, seen from above.
  Patch reach(BrickId id) const {
    Patch patch = footprint(id);
    const double half = 0.5 * layout_.kind_of(id).height;
    patch.x += patch.axis.x * (patch.along + half);
    patch.y += patch.axis.y * (patch.along + half);
    patch.along = half;
    return patch;
  }
  Rectangle bounds(BrickId id) const {
    Rectangle box = footprint(id).bounds();
    box.cover(reach(id).bounds());
    return box;
  }
  double distance_ahead(BrickId id, BrickId other) const {
    const Axis axis = axis_of(id);
    return (brick(other).foot.x - brick(id).foot.x) * axis.x + (brick(other).foot.y - brick(id).foot.y) * axis.y;
  }
  bool full() const { return count_ >= kMostProblems; }
  void problem(std::string_view text) {
    if (count_++ < kMostProblems) problems_.append(problems_.empty() ? "" : "\n").append(text);
  }

  void check_stances();
  void pair_all();
  void pair_blocks(std::size_t a, std::size_t b);
  void consider(BrickId behind, BrickId ahead);
  void check_pairs();
  void check_pair(BrickId id);
  void check_sides();
  bool follows(BrickId from, BrickId to) const;

  const Layout& layout_;
  std::vector<Link> links_;
  struct Reach {
    BrickId behind, ahead;
  };
  std::vector<Reach> aside_;       // Bricks in reach that are not the nearest one.
  std::vector<Rectangle> bounds_;  // Of each brick, standing and fallen,
  std::vector<Rectangle> boxes_;   // and of each block of them.
  mutable double last_heading_ = 0.0;
  mutable Axis last_axis_;
  std::string problems_;
  std::size_t count_ = 0;
};

void Search::check_stances() {
  for (BrickId id = 0; id < layout_.brick_count() && !full(); ++id) {
    if (layout_.kind_of(id).shape == Shape::ball) {
      problem("hinge: brick " + std::to_string(id) + " is a ball; hinge turns standing bricks about their toes; rigid can");
    } else if (brick(id).stance != Stance::standing) {
      problem("hinge: brick " + std::to_string(id) +
              " does not stand on its smallest face; hinge turns standing bricks about their toes; rigid can");
    } else if (brick(id).foot.z != 0.0) {
      problem("hinge: brick " + std::to_string(id) + " stands " + millimetres(brick(id).foot.z) +
              " above the floor; hinge knows bricks on the floor only; rigid can");
    }
  }
}

void Search::consider(BrickId behind, BrickId ahead) {
  const double distance = distance_ahead(behind, ahead);
  if (distance <= 0.0 || !overlap(reach(behind), footprint(ahead))) return;
  Link& now = link(behind);
  if (now.next == kNoBrick) {
    now = {distance, ahead};
  } else if (distance < now.pitch) {  // The pitch holds the distance until check_pairs.
    aside_.push_back({behind, now.next});
    now = {distance, ahead};
  } else {
    aside_.push_back({behind, ahead});
  }
}

void Search::pair_blocks(std::size_t a, std::size_t b) {
  const BrickId count = layout_.brick_count();
  const auto first = [](std::size_t block) { return static_cast<BrickId>(block * kBlock); };
  const BrickId end_b = std::min(first(b + 1), count);
  for (BrickId i = first(a); i < std::min(first(a + 1), count); ++i) {
    const Rectangle& box = bounds_[static_cast<std::size_t>(i)];
    if (!box.overlaps(boxes_[b])) continue;
    for (BrickId j = a == b ? i + 1 : first(b); j < end_b; ++j) {
      if (!box.overlaps(bounds_[static_cast<std::size_t>(j)])) continue;
      consider(i, j);
      consider(j, i);
    }
  }
}

// Boxes of a few bricks each, swept along the longer side of the layout.
void Search::pair_all() {
  const std::size_t blocks = (links_.size() + kBlock - 1) / kBlock;
  boxes_.resize(blocks);
  bounds_.reserve(links_.size());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Rectangle& box = bounds_.emplace_back(bounds(static_cast<BrickId>(i)));
    if (i % kBlock == 0) boxes_[i / kBlock] = box;
    boxes_[i / kBlock].cover(box);
  }
  Rectangle all = boxes_[0];
  for (const Rectangle& box : boxes_) all.cover(box);
  const bool along_x = all.high_x - all.low_x >= all.high_y - all.low_y;
  const auto low = [&](std::size_t b) { return along_x ? boxes_[b].low_x : boxes_[b].low_y; };
  const auto high = [&](std::size_t b) { return along_x ? boxes_[b].high_x : boxes_[b].high_y; };
  std::vector<std::size_t> order(blocks);
  for (std::size_t b = 0; b < blocks; ++b) order[b] = b;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return low(a) != low(b) ? low(a) < low(b) : a < b; });
  std::vector<std::size_t> open;
  for (const std::size_t b : order) {
    std::erase_if(open, [&](std::size_t a) { return high(a) < low(b); });
    for (const std::size_t a : open) {
      if (boxes_[a].overlaps(boxes_[b])) pair_blocks(a, b);
    }
    pair_blocks(b, b);
    open.push_back(b);
  }
  boxes_ = {};
  bounds_ = {};
}

void Search::check_pair(BrickId id) {
  Link& l = link(id);
  const BrickKind& behind = layout_.kind_of(id);
  const BrickKind& ahead = layout_.kind_of(l.next);
  const Axis a = axis_of(id);
  const Axis b = axis_of(l.next);
  const auto who = [next = l.next, id] { return "hinge: brick " + std::to_string(next) + " ahead of brick " + std::to_string(id); };
  const bool alike = a.x == b.x && a.y == b.y;
  const double turn = alike ? 0.0 : arc_tangent(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
  if (std::fabs(turn) > kLargestTurn + 1e-9) {
    return problem(who() + " is turned by " + number(std::round(turn * 18000.0 / kPi) / 100.0) +
                   " deg against it; hinge follows at most 5 deg; rigid can");
  }
  const double length = std::sqrt((a.x + b.x) * (a.x + b.x) + (a.y + b.y) * (a.y + b.y));
  const Axis mean{(a.x + b.x) / length, (a.y + b.y) / length};
  const double dx = brick(l.next).foot.x + 0.5 * ahead.thickness * b.x - brick(id).foot.x - 0.5 * behind.thickness * a.x;
  const double dy = brick(l.next).foot.y + 0.5 * ahead.thickness * b.y - brick(id).foot.y - 0.5 * behind.thickness * a.y;
  l.pitch = dx * mean.x + dy * mean.y;
  const double offset = std::fabs(dy * mean.x - dx * mean.y);
  if (offset > kLargestOffset * std::min(behind.width, ahead.width)) {
    return problem(who() + " stands " + millimetres(offset) + " to one side; hinge follows at most a quarter of the width; rigid can");
  }
  const double gap = l.pitch - ahead.thickness;
  const double height = behind.height;
  if (gap >= height) {
    l.next = kNoBrick;
  } else if (gap < kLeastGap * height) {
    problem(who() + " stands " + millimetres(gap) +
            " from it; bricks that touch move as one block, hinge needs a gap of 0.5 % of the height; rigid can");
  } else if (std::sqrt(height * height - gap * gap) > ahead.height) {
    problem(who() + " is so low that it is hit above its top; rigid can");
  } else if (l.pitch * l.pitch >= height * height + ahead.thickness * ahead.thickness) {
    // [vanLeeuwen2010]: the top edge of the one behind would slide off the lower end of the rear face.
    problem(who() + " stands " + millimetres(gap) + " from it, so far that the faller slips under it; hinge follows gaps under " +
            millimetres(std::sqrt(height * height + ahead.thickness * ahead.thickness) - ahead.thickness) + "; rigid can");
  }
}

void Search::check_pairs() {
  for (BrickId id = 0; id < layout_.brick_count() && !full(); ++id) {
    if (link(id).next != kNoBrick) check_pair(id);
  }
}

// Whether `to` is among the next bricks of the row of `from`.
bool Search::follows(BrickId from, BrickId to) const {
  for (int hops = 0; hops < 256 && from != kNoBrick; ++hops) {
    if (from == to) return true;
    from = links_[static_cast<std::size_t>(from)].next;
  }
  return false;
}

// A brick that reaches two rows, or a brick that two bricks reach: a split, a merge or a crossing.
void Search::check_sides() {
  for (const Reach& r : aside_) {
    if (full()) return;
    if (follows(r.behind, r.ahead)) continue;
    problem("hinge: brick " + std::to_string(r.behind) + " reaches brick " + std::to_string(r.ahead) +
            " of another row; hinge follows single rows, not splits, merges or crossings; rigid can");
  }
  std::vector<bool> taken(links_.size());
  for (BrickId id = 0; id < layout_.brick_count() && !full(); ++id) {
    const BrickId next = link(id).next;
    if (next == kNoBrick) continue;
    if (taken[static_cast<std::size_t>(next)]) {
      problem("hinge: two bricks fall on brick " + std::to_string(next) + "; hinge follows single rows, not merges; rigid can");
    }
    taken[static_cast<std::size_t>(next)] = true;
  }
}

Result<std::vector<Link>> Search::run() {
  check_stances();
  if (count_ == 0 && !links_.empty()) {
    pair_all();
    check_pairs();
    if (count_ == 0) check_sides();
  }
  if (count_ > 0) return failure(problems_);
  return std::move(links_);
}

}  // namespace

Result<std::vector<Link>> find_links(const Layout& layout) { return Search(layout).run(); }

}  // namespace topple::hinge

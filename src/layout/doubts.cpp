// What geometry alone says against a layout: who overlaps, and where the wave has no way on.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "base/trigonometry.h"
#include "layout/overlap.h"
#include "layout/text.h"

namespace topple {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kSlack = 1e-3;  // of the thickness: bricks that touch are in reach

std::string brick_words(BrickId brick) { return "brick " + std::to_string(brick); }
std::string length_words(double metres) { return number_text(std::round(metres * 1e4) / 10.0) + " mm"; }

std::string sentence(std::string words) {
  words[0] = static_cast<char>(words[0] >= 'a' && words[0] <= 'z' ? words[0] - 'a' + 'A' : words[0]);
  return words + ".";
}

/// How one brick lies to another that may fall on it.
struct Way {
  double gap = kFar;   ///< Face to face along the fall; infinite: it falls past [m].
  double miss = kFar;  ///< Sideways distance to what it sweeps; 0: it hits [m].
  bool ahead = false;
};

/// Some bricks of a layout by where they stand: which of them are near a place.
class Cells {
 public:
  /// @param width Of a cell [m].
  Cells(const Layout& layout, double width, const std::vector<BrickId>& bricks) : layout_(layout), width_(width) {
    while ((std::size_t{1} << (64U - shift_)) < bricks.size()) --shift_;
    first_.resize((std::size_t{1} << (64U - shift_)) + 1);
    for (const BrickId id : bricks) ++first_[bucket_of(cell_of(id)) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    bricks_.resize(bricks.size());
    for (const BrickId id : bricks) bricks_[next[bucket_of(cell_of(id))]++] = id;
  }

  /// Visits those in the cell of a place and in the eight around it.
  template <typename Visit>
  void near(const Vec3& place, Visit visit) const {
    const Cell middle = cell_of(place);
    for (const std::int32_t x : {middle.x - 1, middle.x, middle.x + 1}) {
      for (const std::int32_t y : {middle.y - 1, middle.y, middle.y + 1}) {
        const Cell cell{x, y};
        const std::size_t bucket = bucket_of(cell);
        for (std::uint32_t i = first_[bucket]; i < first_[bucket + 1]; ++i) {
          if (cell_of(bricks_[i]) == cell) visit(bricks_[i]);
        }
      }
    }
  }

 private:
  struct Cell {
    std::int32_t x = 0;
    std::int32_t y = 0;
    bool operator==(const Cell&) const = default;
  };
  Cell cell_of(BrickId id) const { return cell_of(layout_.bricks[static_cast<std::size_t>(id)].foot); }
  Cell cell_of(const Vec3& place) const {
    return {static_cast<std::int32_t>(std::floor(place.x / width_)), static_cast<std::int32_t>(std::floor(place.y / width_))};
  }
  /// Fibonacci hashing: neighbours come to lie far apart.
  std::size_t bucket_of(const Cell& cell) const {
    const std::uint64_t key = (std::uint64_t{static_cast<std::uint32_t>(cell.x)} << 32U) | static_cast<std::uint32_t>(cell.y);
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15U) >> shift_);
  }

  const Layout& layout_;
  double width_;
  unsigned shift_ = 54;  // 2^(64 - shift) buckets
  std::vector<std::uint32_t> first_;
  std::vector<BrickId> bricks_;
};

/// Who can fall on whom.
class Reach {
 public:
  explicit Reach(const Layout& layout) : layout_(layout) {
    for (const BrickKind& kind : layout.kinds) {
      for (const Stance stance : {Stance::standing, Stance::flat, Stance::on_side}) sizes_.push_back(extents(kind, stance));
    }
    for (const Brick& brick : layout.bricks) {
      const Extents& size = size_of(brick);
      most_ = std::max(most_, size.up + 0.5 * size.along + std::sqrt(size.along * size.along + size.across * size.across));
    }
  }

  const Brick& brick(BrickId id) const { return layout_.bricks[static_cast<std::size_t>(id)]; }
  const Extents& size_of(const Brick& brick) const { return sizes_[std::size_t{brick.kind} * 3 + static_cast<std::size_t>(brick.stance)]; }

  /// No brick falls on one that stands farther away than this [m].
  double most() const { return most_; }

  /// What `other` is to `from` as it falls the way it heads.
  Way way(BrickId from, BrickId other) const;

  /// The widest gap over which `from` tips `other` [m]: it is hit where it would rather tip than slide. 0: nowhere.
  /// It is where `rigid` stops on the usual floor (usual bricks, friction 0.5: 47.4 mm; it crosses that and stops at 47.8). On a smoother
  /// one bricks slide on as they fall and may cross more, 50 mm at 0.3 and 0.4, 60 mm at 0.1: so a doubt says "likely".
  double widest_gap(BrickId from, BrickId other) const;

  bool hits(BrickId from, BrickId other) const {
    const Way found = way(from, other);
    return found.ahead && found.miss == 0.0 && found.gap <= widest_gap(from, other);
  }

 private:
  const Layout& layout_;
  std::vector<Extents> sizes_;  // three a kind, in the order of Stance
  double most_ = 1e-3;          // [m]
};

/// A corner of a brick's plan in another one's axes.
struct Corner {
  double x = 0.0;
  double y = 0.0;
};

/// The least x of a convex outline inside the strip |y| <= half; infinite if it does not come in.
double first_inside(const std::array<Corner, 4>& outline, double half) {
  double least = kFar;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Corner &a = outline[i], &b = outline[(i + 1) % outline.size()];
    if (std::abs(a.y) <= half) least = std::min(least, a.x);
    for (const double border : {-half, half}) {
      if ((a.y - border) * (b.y - border) < 0.0) least = std::min(least, a.x + (b.x - a.x) * (border - a.y) / (b.y - a.y));
    }
  }
  return least;
}

Way Reach::way(BrickId from, BrickId other) const {
  const Brick &a = brick(from), &b = brick(other);
  const Extents &mine = size_of(a), &its = size_of(b);
  const Vec3 d = b.foot - a.foot;
  if (d.z >= mine.up || -d.z >= its.up) return {};
  const SinCos turn = sin_cos(a.heading), rest = b.heading == a.heading ? SinCos{} : sin_cos(b.heading - a.heading);
  const Corner middle{d.x * turn.cos + d.y * turn.sin, d.y * turn.cos - d.x * turn.sin};
  std::array<Corner, 4> outline;
  double least = kFar, most = -kFar, front = kFar;
  constexpr std::array<Corner, 4> kSigns{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const double along = kSigns[i].x * its.along, across = kSigns[i].y * its.across;
    outline[i] = {middle.x + along * rest.cos - across * rest.sin, middle.y + along * rest.sin + across * rest.cos};
    least = std::min(least, outline[i].y);
    most = std::max(most, outline[i].y);
    front = std::min(front, outline[i].x);
  }
  const double half = 0.5 * mine.across, slack = kSlack * layout_.kinds[a.kind].thickness;
  Way found;
  found.ahead = middle.x > 0.0;
  found.miss = std::max(0.0, std::max(least - half, -half - most));
  found.gap = (found.miss == 0.0 ? first_inside(outline, half) : front) - 0.5 * mine.along;
  if (found.gap < -slack && found.miss == 0.0) found.ahead = false;  // it stands beside or behind
  found.gap = std::max(0.0, found.gap);
  return found;
}

double Reach::widest_gap(BrickId from, BrickId other) const {
  const Brick& b = brick(other);
  const double up = size_of(brick(from)).up;
  const Extents& its = size_of(b);
  const double friction = layout_.kinds[b.kind].surface.floor_friction;
  // A push at height z tips a brick if its moment z F beats the weight's, m g along / 2, before F beats the floor's friction, mu m g.
  const double least_height = friction > 0.0 ? 0.5 * its.along / friction : kFar;
  if (least_height > std::min(up, its.up)) return 0.0;
  return std::sqrt(up * up - least_height * least_height);
}

/// Walks the wave from the pushed bricks and says where it finds no way on.
class WaveWalk {
 public:
  WaveWalk(const Layout& layout, std::size_t most) : layout_(layout), reach_(layout), most_(most), reached_(layout.bricks.size(), false) {
    for (const Brick& brick : layout.bricks) {
      lowest_ = std::min(lowest_, brick.foot.z);
      ball_ |= layout.kinds[brick.kind].shape == Shape::ball;
    }
  }

  std::vector<Doubt> run() {
    for (const Push& push : layout_.pushes) start(push.brick);
    walk_parts();
    if (all_reached()) return {};
    walk_all();
    // First where a part is cut in two, then what nothing leads to; from each the walk goes on, so that one fault is told once.
    for (const bool inside : {true, false}) {
      for (BrickId i = 0; i < layout_.brick_count() && doubts_.size() < most_; ++i) {
        if (reached(i) || (inside && (i == part(i).first || !reached(i - 1)))) continue;
        if (told(i, inside)) doubts_.push_back(doubt_at(i));
        start(i);
        walk();
      }
    }
    return std::move(doubts_);
  }

 private:
  bool reached(BrickId brick) const { return reached_[static_cast<std::size_t>(brick)]; }
  const Part& part(BrickId brick) const { return *layout_.part_of(brick); }
  bool all_reached() const { return std::find(reached_.begin(), reached_.end(), false) == reached_.end(); }

  /// A structure has no order, what stands on it is its own affair, and where a ball rolls to this walk does not know.
  bool told(BrickId brick, bool inside) const {
    const bool on_floor = reach_.brick(brick).foot.z <= lowest_ && layout_.kind_of(brick).shape == Shape::box;
    return part(brick).line && on_floor && (inside || !ball_);
  }

  void start(BrickId brick) {
    if (reached(brick)) return;
    reached_[static_cast<std::size_t>(brick)] = true;
    queue_.push_back(brick);
  }

  /// Most layouts are whole lines, each begun by another one: so first from brick to brick of a part, and to the first of each.
  void walk_parts() {
    std::vector<BrickId> firsts;
    firsts.reserve(layout_.parts.size());
    for (const Part& part : layout_.parts) {
      if (part.count > 0) firsts.push_back(part.first);
    }
    among_.emplace(layout_, reach_.most(), firsts);
    walk();
  }

  /// From all that was reached to all that was not.
  void walk_all() {
    std::vector<BrickId> rest;
    for (BrickId i = 0; i < layout_.brick_count(); ++i) (reached(i) ? queue_ : rest).push_back(i);
    among_.emplace(layout_, reach_.most(), rest);
    walk();
  }

  void walk() {
    const auto try_next = [this](BrickId from, BrickId other) {
      if (!reached(other) && reach_.hits(from, other)) start(other);
    };
    while (!queue_.empty()) {
      const BrickId from = queue_.back();
      queue_.pop_back();
      if (from + 1 < layout_.brick_count()) try_next(from, from + 1);
      among_->near(reach_.brick(from).foot, [&](BrickId other) { try_next(from, other); });
    }
  }

  Doubt doubt_at(BrickId brick) {
    const bool inside = brick > part(brick).first;
    const BrickId from = inside ? brick - 1 : nearest(brick);
    if (from == kNoBrick) {
      return {Doubt::Kind::no_neighbour, brick, kNoBrick, 0.0,
              sentence("no brick near " + brick_words(brick) + " (part: " + part(brick).name + ") falls towards it")};
    }
    const Way way = reach_.way(from, brick);
    const std::string pair = "bricks " + std::to_string(from) + " and " + std::to_string(brick);
    if (!way.ahead)
      return {Doubt::Kind::no_neighbour, brick, from, 0.0, sentence(brick_words(from) + " falls away from " + std::to_string(brick))};
    if (way.miss > 0.0)
      return {Doubt::Kind::miss, brick, from, way.miss,
              sentence(turn_words(from, brick) + brick_words(from) + " misses " + std::to_string(brick) + " by " + length_words(way.miss))};
    const double friction = layout_.kind_of(brick).surface.floor_friction;
    return {Doubt::Kind::beyond_reach, brick, from, way.gap,
            sentence("gap " + length_words(way.gap) + " between " + pair + " is likely beyond reach with floor friction " +
                     number_text(friction))};
  }

  /// "turn of 4 bricks in 90°: ", where the part turns.
  std::string turn_words(BrickId from, BrickId brick) const {
    const Part& where = part(brick);
    const double step = turned(from, brick);
    if (&part(from) != &where || std::abs(step) < 0.05) return "";
    BrickId first = from, last = brick;
    double total = step;
    while (first > where.first && turned(first - 1, first) * step > 0.02 * step * step) total += turned(first - 1, first), --first;
    while (last + 1 < where.first + where.count && turned(last, last + 1) * step > 0.02 * step * step)
      total += turned(last, last + 1), ++last;
    return "turn of " + std::to_string(last - first + 1) + " bricks in " + number_text(std::round(std::abs(total) * 180.0 / kPi)) + "°: ";
  }

  double turned(BrickId a, BrickId b) const {
    double step = reach_.brick(b).heading - reach_.brick(a).heading;
    while (step > kPi) step -= 2.0 * kPi;
    while (step < -kPi) step += 2.0 * kPi;
    return step;
  }

  BrickId nearest(BrickId brick) {
    if (!all_) {
      std::vector<BrickId> bricks(layout_.bricks.size());
      std::iota(bricks.begin(), bricks.end(), BrickId{0});
      all_.emplace(layout_, reach_.most(), bricks);
    }
    BrickId best = kNoBrick;
    double least = kFar;
    all_->near(reach_.brick(brick).foot, [&](BrickId other) {
      const Way way = reach_.way(other, brick);
      const double distance = way.gap + way.miss;
      if (other == brick || !way.ahead || !(distance < least) || &part(other) == &part(brick)) return;
      least = distance;
      best = other;
    });
    return best;
  }

  const Layout& layout_;
  Reach reach_;
  std::size_t most_;
  std::vector<bool> reached_;
  std::vector<BrickId> queue_;
  std::optional<Cells> among_;  // that the walk goes to; the next of a part is tried besides
  std::optional<Cells> all_;
  std::vector<Doubt> doubts_;
  double lowest_ = 0.0;  // [m]
  bool ball_ = false;
};

}  // namespace

std::vector<Doubt> find_stops(const Layout& layout, std::size_t most) {
  if (layout.bricks.empty()) return {};
  if (layout.pushes.empty()) return {{Doubt::Kind::no_push, 0, kNoBrick, 0.0, "Nothing is pushed: no brick will fall."}};
  return WaveWalk(layout, most).run();
}

std::vector<Doubt> find_doubts(const Layout& layout, std::size_t most) {
  std::vector<Doubt> doubts;
  for (const OverlappingPair& pair : find_overlaps(layout, most)) {
    doubts.push_back({Doubt::Kind::overlap, pair.second, pair.first, pair.depth,
                      sentence("bricks " + std::to_string(pair.first) + " and " + std::to_string(pair.second) + " overlap by " +
                               length_words(pair.depth))});
  }
  const std::vector<Doubt> more = find_stops(layout, most);
  doubts.insert(doubts.end(), more.begin(), more.end());
  return doubts;
}

}  // namespace topple

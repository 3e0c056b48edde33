// What geometry alone says against a layout: who overlaps, and where the wave has no way on.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

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

/// Who can fall on whom.
class Reach {
 public:
  explicit Reach(const Layout& layout) : layout_(layout) {
    for (const Brick& brick : layout.bricks) {
      const Extents size = size_of(brick);
      cell_ = std::fmax(cell_, size.up + 0.5 * size.along + std::sqrt(size.along * size.along + size.across * size.across));
    }
    for (BrickId id = 0; id < layout.brick_count(); ++id) cells_[key_of(brick(id).foot, 0, 0)].push_back(id);
  }

  const Brick& brick(BrickId id) const { return layout_.bricks[static_cast<std::size_t>(id)]; }
  Extents size_of(const Brick& brick) const { return extents(layout_.kinds[brick.kind], brick.stance); }

  /// What `other` is to `from` as it falls the way it heads.
  Way way(BrickId from, BrickId other) const;

  /// The widest gap over which `from` tips `other` [m]: it is hit where it would rather tip than slide. 0: nowhere.
  double widest_gap(BrickId from, BrickId other) const;

  bool hits(BrickId from, BrickId other) const {
    const Way found = way(from, other);
    return found.ahead && found.miss == 0.0 && found.gap <= widest_gap(from, other);
  }

  template <typename Visit>
  void near(BrickId id, Visit visit) const {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        const auto found = cells_.find(key_of(brick(id).foot, x, y));
        if (found == cells_.end()) continue;
        for (const BrickId other : found->second) {
          if (other != id) visit(other);
        }
      }
    }
  }

 private:
  std::uint64_t key_of(const Vec3& foot, int x, int y) const {
    const auto index = [this](double place, int more) {
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(place / cell_)) + more);
    };
    return (std::uint64_t{index(foot.x, x)} << 32U) | index(foot.y, y);
  }

  const Layout& layout_;
  double cell_ = 1e-3;  // [m]
  std::unordered_map<std::uint64_t, std::vector<BrickId>> cells_;
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
    if (std::abs(a.y) <= half) least = std::fmin(least, a.x);
    for (const double border : {-half, half}) {
      if ((a.y - border) * (b.y - border) < 0.0) least = std::fmin(least, a.x + (b.x - a.x) * (border - a.y) / (b.y - a.y));
    }
  }
  return least;
}

Way Reach::way(BrickId from, BrickId other) const {
  const Brick &a = brick(from), &b = brick(other);
  const Extents mine = size_of(a), its = size_of(b);
  const Vec3 d = b.foot - a.foot;
  if (d.z >= mine.up || -d.z >= its.up) return {};
  const SinCos turn = sin_cos(a.heading), rest = sin_cos(b.heading - a.heading);
  const Corner middle{d.x * turn.cos + d.y * turn.sin, d.y * turn.cos - d.x * turn.sin};
  std::array<Corner, 4> outline;
  double least = kFar, most = -kFar, front = kFar;
  constexpr std::array<Corner, 4> kSigns{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const double along = kSigns[i].x * its.along, across = kSigns[i].y * its.across;
    outline[i] = {middle.x + along * rest.cos - across * rest.sin, middle.y + along * rest.sin + across * rest.cos};
    least = std::fmin(least, outline[i].y);
    most = std::fmax(most, outline[i].y);
    front = std::fmin(front, outline[i].x);
  }
  const double half = 0.5 * mine.across, slack = kSlack * layout_.kinds[a.kind].thickness;
  Way found;
  found.ahead = middle.x > 0.0;
  found.miss = std::fmax(0.0, std::fmax(least - half, -half - most));
  found.gap = (found.miss == 0.0 ? first_inside(outline, half) : front) - 0.5 * mine.along;
  if (found.gap < -slack && found.miss == 0.0) found.ahead = false;  // it stands beside or behind
  found.gap = std::fmax(0.0, found.gap);
  return found;
}

double Reach::widest_gap(BrickId from, BrickId other) const {
  const Brick& b = brick(other);
  const double up = size_of(brick(from)).up;
  const Extents its = size_of(b);
  const double friction = layout_.kinds[b.kind].surface.floor_friction;
  // A push at height z tips a brick if its moment z F beats the weight's, m g along / 2, before F beats the floor's friction, mu m g.
  const double least_height = friction > 0.0 ? 0.5 * its.along / friction : kFar;
  if (least_height > std::fmin(up, its.up)) return 0.0;
  return std::sqrt(up * up - least_height * least_height);
}

/// Walks the wave from the pushed bricks and says where it finds no way on.
class WaveWalk {
 public:
  WaveWalk(const Layout& layout, std::size_t most) : layout_(layout), reach_(layout), most_(most), reached_(layout.bricks.size(), false) {
    for (const Part& part : layout.parts) {
      for (BrickId i = part.first; i < part.first + part.count; ++i) part_of_.push_back(&part);
    }
    for (const Brick& brick : layout.bricks) {
      lowest_ = std::fmin(lowest_, brick.foot.z);
      ball_ |= layout.kinds[brick.kind].shape == Shape::ball;
    }
  }

  std::vector<Doubt> run() {
    for (const Push& push : layout_.pushes) start(push.brick);
    walk();
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
  const Part& part(BrickId brick) const { return *part_of_[static_cast<std::size_t>(brick)]; }

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

  void walk() {
    while (!queue_.empty()) {
      const BrickId from = queue_.back();
      queue_.pop_back();
      reach_.near(from, [&](BrickId other) {
        if (!reached(other) && reach_.hits(from, other)) start(other);
      });
    }
  }

  Doubt doubt_at(BrickId brick) const {
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
    return {
        Doubt::Kind::beyond_reach, brick, from, way.gap,
        sentence("gap " + length_words(way.gap) + " between " + pair + " is beyond reach with floor friction " + number_text(friction))};
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

  BrickId nearest(BrickId brick) const {
    BrickId best = kNoBrick;
    double least = kFar;
    reach_.near(brick, [&](BrickId other) {
      const Way way = reach_.way(other, brick);
      const double distance = way.gap + way.miss;
      if (!way.ahead || !(distance < least) || &part(other) == &part(brick)) return;
      least = distance;
      best = other;
    });
    return best;
  }

  const Layout& layout_;
  Reach reach_;
  std::size_t most_;
  std::vector<bool> reached_;
  std::vector<const Part*> part_of_;
  std::vector<BrickId> queue_;
  std::vector<Doubt> doubts_;
  double lowest_ = 0.0;  // [m]
  bool ball_ = false;
};

}  // namespace

std::vector<Doubt> find_doubts(const Layout& layout, std::size_t most) {
  std::vector<Doubt> doubts;
  for (const OverlappingPair& pair : find_overlaps(layout, most)) {
    doubts.push_back({Doubt::Kind::overlap, pair.second, pair.first, pair.depth,
                      sentence("bricks " + std::to_string(pair.first) + " and " + std::to_string(pair.second) + " overlap by " +
                               length_words(pair.depth))});
  }
  if (layout.bricks.empty()) return doubts;
  if (layout.pushes.empty()) {
    doubts.push_back({Doubt::Kind::no_push, 0, kNoBrick, 0.0, "Nothing is pushed: no brick will fall."});
    return doubts;
  }
  const std::vector<Doubt> more = WaveWalk(layout, most).run();
  doubts.insert(doubts.end(), more.begin(), more.end());
  return doubts;
}

}  // namespace topple

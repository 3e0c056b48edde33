// Walls, towers and pyramids: bricks on bricks.
#include <algorithm>
#include <array>
#include <cmath>

#include "layout/kinds.h"
#include "layout/style.h"
#include "layout/text.h"

namespace topple {
namespace {

constexpr double kLeastSize = 1e-4;  // [m]; as of a kind
constexpr double kLastDigits = 1e-9;
constexpr std::int64_t kMostLayers = 10'000;

/// Where the bricks of a structure are: along its heading, to its left and up, from the middle of its foot.
struct Site {
  Site(const Vec3& middle, double heading_deg) : at(middle), along(direction_of(heading_deg)), left{-along.y, along.x, 0.0} {}
  Vec3 place(double ahead, double aside, double up) const { return at + ahead * along + aside * left + Vec3{0.0, 0.0, up}; }
  Vec3 at, along, left;
};

std::string millimetres(double metres) { return number_text(std::round(metres * 1e9) / 1e6); }

Vec3 read_place(Section& section) {
  const auto at = section.point("at_mm", 3);
  if (!section.has("at_mm")) section.missing("at_mm must be there: the middle of its foot, [x, y] or [x, y, height of its foot]");
  return at.value_or(Vec3{});
}

/// A number of bricks or layers that must be there.
std::int64_t read_whole(Section& section, std::string_view key, std::int64_t most, std::string_view what) {
  if (!section.has(key)) section.missing(std::string(key) + " must be there: " + std::string(what));
  return section.whole(key, 1, most).value_or(1);
}

/// Between neighbours, at most half of `size`, so that every brick keeps what it stands on [m].
double read_gap(Section& section, double size) {
  const double most = 500.0 * size;  // [mm]
  return section.number("gap_mm", {0.0, most}).value_or(0.0) / 1000.0;
}

void check_total(Section& section, std::int64_t total) {
  if (total > kMaxBricks)
    section.missing("would take " + count_text(total) + " bricks; at most " + count_text(kMaxBricks) + " are allowed");
}

/// The kind that closes a course: as long across as the space there is, of the same material.
std::optional<std::uint16_t> add_half_kind(Section& section, const PartPlan& plan, double across, std::vector<BrickKind>& kinds) {
  const BrickKind& whole = kinds[plan.kind];
  BrickKind half = whole;
  half.name = whole.name + " half";
  double& size = plan.stance == Stance::on_side ? half.height : half.width;
  half.mass = whole.mass * across / size;
  size = across;
  const double least = std::min({half.height, half.width, half.thickness}), most = std::max({half.height, half.width, half.thickness});
  if (across < kLeastSize || least < 1e-3 * most) {
    section.missing("half a brick would be " + millimetres(across) +
                    " mm across, too small for a kind; ends may be \"toothed\" or \"stepped\"");
    return std::nullopt;
  }
  const auto same = std::find_if(kinds.begin(), kinds.end(), [&](const BrickKind& kind) {
    return kind.name == half.name && kind.height == half.height && kind.width == half.width && kind.thickness == half.thickness &&
           kind.mass == half.mass;
  });
  const auto number = static_cast<std::uint16_t>(same - kinds.begin());
  if (same != kinds.end()) return number;
  if (kinds.size() == kMaxKinds) {
    section.missing("one kind more than the " + count_text(static_cast<long long>(kMaxKinds)) + " that a layout may have");
    return std::nullopt;
  }
  kinds.push_back(half);
  return number;
}

std::int64_t bricks_of(const WallPlan& wall) {
  if (wall.ends == WallPlan::Ends::stepped) return wall.courses * wall.count - wall.courses * (wall.courses - 1) / 2;
  const std::int64_t odd = wall.courses / 2;
  return wall.courses * wall.count + (wall.ends == WallPlan::Ends::half ? odd : -odd);
}

}  // namespace

std::optional<PartPlan> read_wall(Section& section, std::vector<BrickKind>& kinds) {
  PartPlan plan = read_style(section, kinds, Stance::on_side);
  const double across = extents(kinds[plan.kind], plan.stance).across;
  WallPlan wall;
  wall.at = read_place(section);
  wall.heading_deg = section.number("heading_deg", kHeading).value_or(0.0);
  wall.count = read_whole(section, "count", kMaxBricks, "the bricks of its lowest course");
  wall.courses = read_whole(section, "courses", kMostLayers, "how many bricks it is high");
  wall.gap = read_gap(section, across);
  wall.pitch = across + wall.gap;
  constexpr std::array<std::string_view, 3> kEnds{"half", "toothed", "stepped"};
  wall.ends = static_cast<WallPlan::Ends>(section.word("ends", kEnds).value_or(0));
  if (!section.good()) return std::nullopt;
  if (wall.ends == WallPlan::Ends::toothed && wall.courses > 1 && wall.count < 2) {
    section.problem("count", "must be at least 2 where the ends are \"toothed\"; is 1");
  }
  if (wall.ends == WallPlan::Ends::stepped && wall.courses > wall.count) {
    section.problem("courses", "must be a whole number from 1 to " + count_text(wall.count) + ", the bricks of the lowest course; is " +
                                   count_text(wall.courses));
  }
  plan.count = bricks_of(wall);
  check_total(section, plan.count);
  if (!section.good()) return std::nullopt;
  if (wall.ends == WallPlan::Ends::half && wall.courses > 1) {
    const auto half = add_half_kind(section, plan, 0.5 * (across - wall.gap), kinds);
    if (!half) return std::nullopt;
    wall.half_kind = *half;
  }
  plan.shape = wall;
  return plan;
}

void put_wall(const PartPlan& plan, const WallPlan& wall, BrickLayer& layer) {
  const Extents size = extents(layer.layout().kinds[plan.kind], plan.stance);
  const Site site(wall.at, wall.heading_deg);
  const double heading = radians(wall.heading_deg);
  const auto course_of = [&](std::int64_t bricks, double up) {
    const double first = -0.5 * static_cast<double>(bricks - 1) * wall.pitch;
    for (std::int64_t i = 0; i < bricks; ++i) layer.put(site.place(0.0, first + static_cast<double>(i) * wall.pitch, up), heading);
  };
  // From the middle to that of a half brick at an end.
  const double end = 0.5 * (static_cast<double>(wall.count) * wall.pitch - wall.gap) - 0.25 * (size.across - wall.gap);
  for (std::int64_t course = 0; course < wall.courses; ++course) {
    const double up = static_cast<double>(course) * size.up;
    const bool odd = course % 2 == 1;
    if (wall.ends == WallPlan::Ends::stepped) {
      course_of(wall.count - course, up);
    } else if (!odd || wall.ends == WallPlan::Ends::toothed) {
      course_of(odd ? wall.count - 1 : wall.count, up);
    } else {
      layer.put(site.place(0.0, -end, up), heading, wall.half_kind);
      course_of(wall.count - 1, up);
      layer.put(site.place(0.0, end, up), heading, wall.half_kind);
    }
  }
  layer.close_part(plan.name, false);
}

std::optional<PartPlan> read_tower(Section& section, std::vector<BrickKind>& kinds) {
  PartPlan plan = read_style(section, kinds, Stance::flat);
  const Extents size = extents(kinds[plan.kind], plan.stance);
  const double wide = std::fmax(size.along, size.across), narrow = std::fmin(size.along, size.across);
  TowerPlan tower;
  tower.at = read_place(section);
  tower.heading_deg = section.number("heading_deg", kHeading).value_or(0.0);
  tower.layers = read_whole(section, "layers", kMostLayers, "how many bricks it is high");
  tower.count = section.whole("count", 1, kMaxBricks).value_or(2);
  if (!section.good()) return std::nullopt;
  const auto most = static_cast<std::int64_t>(std::floor(wide / narrow + kLastDigits));
  if (tower.count > most) {
    section.problem("count", "must be a whole number from 1 to " + count_text(most) +
                                 ", as many as lie side by side on the layer below; is " + count_text(tower.count));
  }
  plan.count = tower.layers * tower.count;
  check_total(section, plan.count);
  if (!section.good()) return std::nullopt;
  plan.shape = tower;
  return plan;
}

void put_tower(const PartPlan& plan, const TowerPlan& tower, BrickLayer& layer) {
  const Extents size = extents(layer.layout().kinds[plan.kind], plan.stance);
  const bool long_along = size.along >= size.across;
  const double room = std::abs(size.along - size.across);
  // The outer faces of a layer are flush with the ends of the next.
  const double pitch = tower.count > 1 ? room / static_cast<double>(tower.count - 1) : 0.0;
  for (std::int64_t i = 0; i < tower.layers; ++i) {
    const double heading_deg = tower.heading_deg + (i % 2 == 1 ? 90.0 : 0.0);
    const Site site(tower.at, heading_deg);
    for (std::int64_t k = 0; k < tower.count; ++k) {
      const double aside = (static_cast<double>(k) - 0.5 * static_cast<double>(tower.count - 1)) * pitch;
      const double up = static_cast<double>(i) * size.up;
      layer.put(long_along ? site.place(0.0, aside, up) : site.place(aside, 0.0, up), radians(heading_deg));
    }
  }
  layer.close_part(plan.name, false);
}

std::optional<PartPlan> read_pyramid(Section& section, std::vector<BrickKind>& kinds) {
  PartPlan plan = read_style(section, kinds, Stance::flat);
  const Extents size = extents(kinds[plan.kind], plan.stance);
  constexpr std::int64_t kMostSide = 10'000;
  PyramidPlan pyramid;
  pyramid.at = read_place(section);
  pyramid.heading_deg = section.number("heading_deg", kHeading).value_or(0.0);
  pyramid.along = read_whole(section, "count_along", kMostSide, "the bricks of its lowest layer along its heading");
  pyramid.across = read_whole(section, "count_across", kMostSide, "the bricks of its lowest layer across its heading");
  const std::int64_t most = std::min(pyramid.along, pyramid.across);
  pyramid.layers = section.whole("layers", 1, most).value_or(most);
  pyramid.gap = read_gap(section, std::fmin(size.along, size.across));
  if (!section.good()) return std::nullopt;
  for (std::int64_t i = 0; i < pyramid.layers; ++i) plan.count += (pyramid.along - i) * (pyramid.across - i);
  check_total(section, plan.count);
  if (!section.good()) return std::nullopt;
  plan.shape = pyramid;
  return plan;
}

void put_pyramid(const PartPlan& plan, const PyramidPlan& pyramid, BrickLayer& layer) {
  const Extents size = extents(layer.layout().kinds[plan.kind], plan.stance);
  const Site site(pyramid.at, pyramid.heading_deg);
  const auto offset = [](std::int64_t i, std::int64_t count, double pitch) {
    return (static_cast<double>(i) - 0.5 * static_cast<double>(count - 1)) * pitch;
  };
  for (std::int64_t i = 0; i < pyramid.layers; ++i) {
    for (std::int64_t row = 0; row < pyramid.along - i; ++row) {
      for (std::int64_t k = 0; k < pyramid.across - i; ++k) {
        layer.put(site.place(offset(row, pyramid.along - i, size.along + pyramid.gap),
                             offset(k, pyramid.across - i, size.across + pyramid.gap), static_cast<double>(i) * size.up),
                  radians(pyramid.heading_deg));
      }
    }
  }
  layer.close_part(plan.name, false);
}

}  // namespace topple

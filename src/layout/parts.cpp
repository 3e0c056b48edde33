#include "layout/parts.h"

#include <algorithm>
#include <cmath>

#include "base/trigonometry.h"
#include "layout/text.h"

namespace topple {
namespace {

constexpr Range kHeading{-3600.0, 3600.0};   // [deg]
constexpr Range kGap{0.0, 20000.0};          // [mm]
constexpr Range kPitch{0.0, 40000.0, true};  // [mm]
constexpr Range kLength{0.0, 1e8};           // [mm]
constexpr double kSnap = 1e-9;               // of a pitch: 100 pitches are 100 pitches, whatever the last digit says

/// Kind, pose and colours, which rows, curves and bricks share.
PartPlan read_style(Section& section, std::span<const BrickKind> kinds) {
  PartPlan plan;
  plan.place = section.place();
  plan.path = section.path();
  if (const auto name = section.text("kind", 1000)) {
    const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const BrickKind& kind) { return kind.name == *name; });
    if (found != kinds.end()) {
      plan.kind = static_cast<std::uint16_t>(found - kinds.begin());
    } else {
      std::vector<std::string_view> names;
      for (const BrickKind& kind : kinds) names.push_back(kind.name);
      section.problem("kind",
                      "there is no kind \"" + printable(*name) + "\"; the nearest is \"" + printable(nearest_key(*name, names)) + "\"");
    }
  }
  plan.stance = section.stance("pose").value_or(Stance::standing);
  plan.color = section.color("color").value_or(kinds[plan.kind].color);
  plan.color_to = section.color("color_to").value_or(plan.color);
  return plan;
}

/// Foot to foot, from exactly one of pitch_mm and gap_mm [m]; empty after a problem.
std::optional<double> read_pitch(Section& section, const PartPlan& plan, std::span<const BrickKind> kinds) {
  const double along = extents(kinds[plan.kind], plan.stance).along;
  const auto pitch = section.number("pitch_mm", kPitch);
  const auto gap = section.number("gap_mm", kGap);
  if (section.has("pitch_mm") == section.has("gap_mm")) {
    section.missing(section.has("gap_mm") ? "pitch_mm and gap_mm are both there; exactly one must be"
                                          : "exactly one of pitch_mm and gap_mm must be there");
    return std::nullopt;
  }
  if (gap) return *gap / 1000.0 + along;
  if (!pitch || !section.good()) return std::nullopt;
  if (*pitch / 1000.0 < along * (1.0 - kSnap)) {
    section.problem("pitch_mm", "must be at least the brick's " + number_text(along * 1000.0) +
                                    " along its heading, or the bricks overlap; is " + number_text(*pitch));
    return std::nullopt;
  }
  return *pitch / 1000.0;
}

/// Bricks on a length when one stands at its start. Empty after a problem.
std::optional<std::int64_t> count_along(Section& section, std::string_view key, double length, double pitch) {
  const double pitches = std::floor(length / pitch + kSnap);
  if (pitches < static_cast<double>(kMaxBricks)) return static_cast<std::int64_t>(pitches) + 1;
  section.problem(
      key, "would take " + count_text(static_cast<long long>(pitches) + 1) + " bricks; at most " + count_text(kMaxBricks) + " are allowed");
  return std::nullopt;
}

struct Placed {
  Vec3 foot;
  double heading = 0.0;  // [rad]
};

double radians(double degrees) { return degrees / 180.0 * kPi; }

/// A unit vector; quarter turns are exact, so that a row along y has all its x in one place.
Vec3 direction_of(double degrees) {
  const double turn = std::fmod(degrees, 360.0);  // exact
  if (turn == 0.0) return {1.0, 0.0, 0.0};
  if (turn == 90.0 || turn == -270.0) return {0.0, 1.0, 0.0};
  if (turn == 180.0 || turn == -180.0) return {-1.0, 0.0, 0.0};
  if (turn == 270.0 || turn == -90.0) return {0.0, -1.0, 0.0};
  const SinCos angle = sin_cos(radians(turn));
  return {angle.cos, angle.sin, 0.0};
}

constexpr std::size_t kShades = 256;

/// The numbers of the colours from the first to the last, one for each shade that `count` bricks use; empty when there is no room.
std::vector<std::uint16_t> shades_of(const PartPlan& plan, Palette& palette) {
  const std::size_t shades = plan.color == plan.color_to ? 1 : std::min(kShades, static_cast<std::size_t>(plan.count));
  std::vector<std::uint16_t> numbers;
  for (std::size_t i = 0; i < shades; ++i) {
    const double share = shades > 1 ? static_cast<double>(i) / static_cast<double>(shades - 1) : 0.0;
    const auto mix = [&](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(std::floor(a + (b - a) * share + 0.5)); };
    const Color &from = plan.color, &to = plan.color_to;
    const auto number = palette.number({mix(from.red, to.red), mix(from.green, to.green), mix(from.blue, to.blue)});
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

/// Brick i of a part.
Placed place_of(PartPlan& plan, std::int64_t i) {
  if (const auto* row = std::get_if<RowPlan>(&plan.shape)) {
    return {row->from + (static_cast<double>(i) * row->pitch) * direction_of(row->heading_deg), radians(row->heading_deg)};
  }
  if (auto* curve = std::get_if<CurvePlan>(&plan.shape)) {
    const Spline::At at = curve->spline.at(std::min(static_cast<double>(i) * curve->pitch, curve->spline.length()));
    return {at.point, arc_tangent(at.tangent.y, at.tangent.x)};
  }
  const auto& brick = std::get<BrickPlan>(plan.shape);
  return {brick.at, radians(brick.heading_deg)};
}

}  // namespace

std::optional<PartPlan> read_row(Section& section, std::span<const BrickKind> kinds) {
  PartPlan plan = read_style(section, kinds);
  RowPlan row;
  row.from = section.point("from_mm", 3).value_or(Vec3{});
  row.heading_deg = section.number("heading_deg", kHeading).value_or(0.0);
  const auto count = section.whole("count", 1, kMaxBricks);
  const auto length = section.number("length_mm", kLength);
  if (section.has("count") == section.has("length_mm")) {
    section.missing(section.has("count") ? "count and length_mm are both there; exactly one must be"
                                         : "exactly one of count and length_mm must be there");
  }
  const auto pitch = read_pitch(section, plan, kinds);
  if (!section.good() || !pitch) return std::nullopt;
  row.pitch = *pitch;
  const auto counted = count ? count : count_along(section, "length_mm", *length / 1000.0, row.pitch);
  if (!counted) return std::nullopt;
  plan.count = *counted;
  plan.shape = row;
  return plan;
}

std::optional<PartPlan> read_curve(Section& section, std::span<const BrickKind> kinds) {
  PartPlan plan = read_style(section, kinds);
  const auto points = section.points("points_mm");
  if (!section.has("points_mm")) section.missing("points_mm must be there: the points [x, y] that the curve passes through");
  const auto pitch = read_pitch(section, plan, kinds);
  if (points) {
    constexpr double kApart = 1e-6;  // [m]; a thousandth of a millimetre, for a person the same place
    constexpr std::size_t kMostPoints = 100'000;
    if (points->size() > kMostPoints)
      section.problem("points_mm", "must have at most 100,000 points, has " + count_text(static_cast<long long>(points->size())));
    for (std::size_t i = 1; i < points->size(); ++i) {
      if (norm((*points)[i] - (*points)[i - 1]) >= kApart) continue;
      section.problem("points_mm", "points " + std::to_string(i - 1) + " and " + std::to_string(i) + " are in one place");
    }
  }
  if (!section.good() || !points || !pitch) return std::nullopt;
  CurvePlan curve{Spline(*points), *pitch};
  const auto counted = count_along(section, "points_mm", curve.spline.length(), *pitch);
  if (!counted) return std::nullopt;
  plan.count = *counted;
  plan.shape = std::move(curve);
  return plan;
}

std::optional<PartPlan> read_brick(Section& section, std::span<const BrickKind> kinds) {
  PartPlan plan = read_style(section, kinds);
  const auto at = section.point("at_mm", 3);
  if (!section.has("at_mm")) section.missing("at_mm must be there: where the brick stands, [x, y] or [x, y, height of its foot]");
  const double heading = section.number("heading_deg", kHeading).value_or(0.0);
  if (!section.good() || !at) return std::nullopt;
  plan.count = 1;
  plan.shape = BrickPlan{*at, heading};
  return plan;
}

std::optional<std::uint16_t> Palette::number(const Color& color) {
  const std::uint32_t code = (std::uint32_t{color.red} << 16U) | (std::uint32_t{color.green} << 8U) | color.blue;
  const auto known = numbers_.find(code);
  if (known != numbers_.end()) return known->second;
  constexpr std::size_t kMostColors = 65536;
  if (colors_->size() == kMostColors) return std::nullopt;
  const auto number = static_cast<std::uint16_t>(colors_->size());
  colors_->push_back(color);
  numbers_.emplace(code, number);
  return number;
}

bool put_down(PartPlan& plan, Palette& palette, Layout& layout) {
  const std::vector<std::uint16_t> shades = shades_of(plan, palette);
  if (shades.empty()) return false;
  const BrickId first = layout.brick_count();
  const auto count = static_cast<std::size_t>(plan.count);
  for (std::size_t i = 0; i < count; ++i) {
    // Equal shares of the part for every shade, the first and the last brick in the colours asked for.
    const std::uint16_t color = shades[count > shades.size() ? i * shades.size() / count : i % shades.size()];
    const Placed placed = place_of(plan, static_cast<std::int64_t>(i));
    layout.bricks.push_back({placed.foot, placed.heading, plan.kind, color, plan.stance});
  }
  layout.parts.push_back({plan.name, first, static_cast<BrickId>(plan.count)});
  return true;
}

}  // namespace topple

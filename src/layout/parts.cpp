#include "layout/parts.h"

#include <algorithm>
#include <cmath>

#include "base/trigonometry.h"
#include "layout/style.h"
#include "layout/surfaces.h"
#include "layout/text.h"

namespace topple {
namespace {

constexpr double kSnap = 1e-9;  // of a pitch: 100 pitches are 100 pitches, whatever the last digit says

/// [first, last, "#rrggbb"], bricks counted from 0 within the part.
std::optional<PaintStroke> stroke_of(const Node& node) {
  const auto* array = std::get_if<Array>(&node.value);
  if (!array || array->size() != 3) return std::nullopt;
  const auto* first = std::get_if<std::int64_t>(&(*array)[0].value);
  const auto* last = std::get_if<std::int64_t>(&(*array)[1].value);
  const auto* text = std::get_if<std::string>(&(*array)[2].value);
  const std::optional<Color> color = text ? color_of(*text) : std::nullopt;
  if (!first || !last || !color || *first < 0 || *last < *first || *last >= kMaxBricks) return std::nullopt;
  return PaintStroke{*first, *last, *color};
}

std::vector<PaintStroke> read_paint(Section& section) {
  constexpr std::size_t kMostStrokes = 100'000;
  std::vector<PaintStroke> strokes;
  const std::span<const Node> entries = section.list("paint", kMostStrokes, "strokes");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (const auto stroke = stroke_of(entries[i])) {
      strokes.push_back(*stroke);
    } else {
      section.problem_at(
          "paint", i,
          "must be [first brick, last brick, \"#rrggbb\"], counted from 0 within the part, the last not before the first; is " +
              value_text(entries[i]));
    }
  }
  return strokes;
}

}  // namespace

PartPlan read_style(Section& section, std::span<const BrickKind> kinds, Stance usual) {
  PartPlan plan;
  plan.place = section.place();
  plan.path = section.path();
  if (const auto name = section.text("kind", 1000)) plan.kind = find_kind(section, "kind", *name, kinds).value_or(0);
  plan.stance = section.stance("pose").value_or(usual);
  plan.color = section.color("color").value_or(kinds[plan.kind].color);
  plan.color_to = section.color("color_to").value_or(plan.color);
  plan.paint = read_paint(section);
  return plan;
}

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

std::optional<std::int64_t> count_along(Section& section, std::string_view key, double length, double pitch) {
  const double pitches = std::floor(length / pitch + kSnap);
  if (pitches < static_cast<double>(kMaxBricks)) return static_cast<std::int64_t>(pitches) + 1;
  section.problem(
      key, "would take " + count_text(static_cast<long long>(pitches) + 1) + " bricks; at most " + count_text(kMaxBricks) + " are allowed");
  return std::nullopt;
}

double radians(double degrees) { return degrees / 180.0 * kPi; }

Vec3 direction_of(double degrees) {
  const double turn = std::fmod(degrees, 360.0);  // exact
  if (turn == 0.0) return {1.0, 0.0, 0.0};
  if (turn == 90.0 || turn == -270.0) return {0.0, 1.0, 0.0};
  if (turn == 180.0 || turn == -180.0) return {-1.0, 0.0, 0.0};
  if (turn == 270.0 || turn == -90.0) return {0.0, -1.0, 0.0};
  const SinCos angle = sin_cos(radians(turn));
  return {angle.cos, angle.sin, 0.0};
}

std::optional<Line> read_line(Section& section, const PartPlan& plan, std::span<const BrickKind> kinds, std::optional<std::int64_t> usual) {
  const auto count = section.whole("count", 1, kMaxBricks);
  const auto length = section.number("length_mm", kLength);
  const bool neither = !section.has("count") && !section.has("length_mm");
  if (section.has("count") == section.has("length_mm") && !(neither && usual)) {
    section.missing(neither ? "exactly one of count and length_mm must be there"
                            : "count and length_mm are both there; exactly one must be");
  }
  const auto pitch = read_pitch(section, plan, kinds);
  if (!section.good() || !pitch) return std::nullopt;
  const auto counted = count ? count : length ? count_along(section, "length_mm", *length / 1000.0, *pitch) : usual;
  if (!counted) return std::nullopt;
  return Line{*pitch, *counted};
}

namespace {

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

/// One overload a shape.
void put(const PartPlan& plan, const RowPlan& row, BrickLayer& layer) {
  const Vec3 direction = direction_of(row.heading_deg);
  for (std::int64_t i = 0; i < plan.count; ++i)
    layer.put(row.from + (static_cast<double>(i) * row.pitch) * direction, radians(row.heading_deg));
  layer.close_part(plan.name, true);
}
void put(const PartPlan& plan, CurvePlan& curve, BrickLayer& layer) {
  for (std::int64_t i = 0; i < plan.count; ++i) {
    const Spline::At at = curve.spline.at(std::min(static_cast<double>(i) * curve.pitch, curve.spline.length()));
    layer.put(at.point, arc_tangent(at.tangent.y, at.tangent.x));
  }
  layer.close_part(plan.name, true);
}
void put(const PartPlan& plan, const BrickPlan& brick, BrickLayer& layer) {
  layer.put(brick.at, radians(brick.heading_deg));
  layer.close_part(plan.name, true);
}
void put(const PartPlan& plan, const WallPlan& wall, BrickLayer& layer) { put_wall(plan, wall, layer); }
void put(const PartPlan& plan, const TowerPlan& tower, BrickLayer& layer) { put_tower(plan, tower, layer); }
void put(const PartPlan& plan, const PyramidPlan& pyramid, BrickLayer& layer) { put_pyramid(plan, pyramid, layer); }
void put(const PartPlan& plan, const FieldPlan& field, BrickLayer& layer) { put_field(plan, field, layer); }
void put(const PartPlan& plan, const BallPlan& ball, BrickLayer& layer) { put_ball(plan, ball, layer); }

}  // namespace

std::optional<PartPlan> read_row(Section& section, std::vector<BrickKind>& kinds) {
  PartPlan plan = read_style(section, kinds);
  RowPlan row;
  row.from = section.point("from_mm", 3).value_or(Vec3{});
  row.heading_deg = section.number("heading_deg", kHeading).value_or(0.0);
  const auto line = read_line(section, plan, kinds);
  if (!line) return std::nullopt;
  row.pitch = line->pitch;
  plan.count = line->count;
  plan.shape = row;
  return plan;
}

std::optional<PartPlan> read_curve(Section& section, std::vector<BrickKind>& kinds) {
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

std::optional<PartPlan> read_brick(Section& section, std::vector<BrickKind>& kinds) {
  PartPlan plan = read_style(section, kinds);
  const auto at = section.point("at_mm", 3);
  if (!section.has("at_mm")) section.missing("at_mm must be there: where the brick stands, [x, y] or [x, y, height of its foot]");
  const double heading = section.number("heading_deg", kHeading).value_or(0.0);
  if (!section.good() || !at) return std::nullopt;
  plan.count = 1;
  plan.shape = BrickPlan{*at, heading};
  return plan;
}

std::vector<BrickId> first_bricks(const std::vector<PartPlan>& plans) {
  std::vector<BrickId> firsts;
  firsts.reserve(plans.size());
  std::int64_t first = 0;
  for (const PartPlan& plan : plans) {
    firsts.push_back(static_cast<BrickId>(first));
    first += plan.count;
  }
  return firsts;
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

void BrickLayer::put(const Vec3& foot, double heading, std::uint16_t kind) {
  // Equal shares of the part for every shade, the first and the last brick in the colours asked for.
  const auto count = static_cast<std::size_t>(plan_.count);
  const std::uint16_t color = shades_[count > shades_.size() ? next_ * shades_.size() / count : next_ % shades_.size()];
  ++next_;
  layout_.bricks.push_back({foot, heading, kind, color, plan_.stance});
}

void BrickLayer::close_part(const std::string& name, bool line) {
  layout_.parts.push_back({name, first_, layout_.brick_count() - first_, line});
  first_ = layout_.brick_count();
}

namespace {

/// The strokes over the bricks from `first` on, a later one over an earlier one. False: too many colours.
bool paint(const PartPlan& plan, std::size_t first, Palette& palette, Layout& layout) {
  for (const PaintStroke& stroke : plan.paint) {
    const auto number = palette.number(stroke.color);
    if (!number) return false;
    const std::size_t end = std::min(layout.bricks.size(), first + static_cast<std::size_t>(stroke.last) + 1);
    for (std::size_t i = first + static_cast<std::size_t>(stroke.first); i < end; ++i) layout.bricks[i].color = *number;
  }
  return true;
}

}  // namespace

bool put_down(PartPlan& plan, Palette& palette, Layout& layout) {
  std::vector<std::uint16_t> shades = shades_of(plan, palette);
  if (shades.empty()) return false;
  const auto first = layout.bricks.size();
  BrickLayer layer(plan, std::move(shades), layout);
  std::visit([&](auto& shape) { put(plan, shape, layer); }, plan.shape);
  return paint(plan, first, palette, layout);
}

}  // namespace topple

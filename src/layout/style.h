/// What the readers of parts share: kinds, pitches, directions, and bricks put down one after the other in their colours.
#pragma once

#include <optional>
#include <vector>

#include "layout/parts.h"

namespace topple {

inline constexpr Range kHeading{-3600.0, 3600.0};   // [deg]
inline constexpr Range kGap{0.0, 20000.0};          // [mm]
inline constexpr Range kPitch{0.0, 40000.0, true};  // [mm]
inline constexpr Range kLength{0.0, 1e8};           // [mm]

/// Kind, pose and colours, which all parts share.
PartPlan read_style(Section& section, std::span<const BrickKind> kinds, Stance usual = Stance::standing);

/// Foot to foot, from exactly one of pitch_mm and gap_mm [m]; empty after a problem.
std::optional<double> read_pitch(Section& section, const PartPlan& plan, std::span<const BrickKind> kinds);

/// A straight line: its pitch, and its bricks from exactly one of count and length_mm; neither need be there where something else says
/// how many are `usual`. Empty after a problem.
struct Line {
  double pitch = 0.0;  ///< [m]
  std::int64_t count = 0;
};
std::optional<Line> read_line(Section& section, const PartPlan& plan, std::span<const BrickKind> kinds,
                              std::optional<std::int64_t> usual = std::nullopt);

/// The colours of a field's bricks, row by row.
struct FieldPicture {
  std::int64_t rows = 0, count = 0;
  std::vector<std::optional<Color>> palette;  ///< By letter.
  std::vector<std::string_view> lines;        ///< As it is seen from above: the last row first.
};
/// `picture` with its `palette`; empty where neither is there, and after a problem.
std::optional<FieldPicture> read_picture(Section& section);
/// A row's colours as strokes of paint over its bricks, the first of which has this number within the part.
void paint_row(const FieldPicture& picture, std::int64_t row, std::int64_t first, std::vector<PaintStroke>& paint);

/// Bricks on a length when one stands at its start. Empty after a problem.
std::optional<std::int64_t> count_along(Section& section, std::string_view key, double length, double pitch);

double radians(double degrees);

/// A unit vector; quarter turns are exact, so that a row along y has all its x in one place.
Vec3 direction_of(double degrees);

/// Adds the bricks of one part to a layout, each in its shade.
class BrickLayer {
 public:
  BrickLayer(const PartPlan& plan, std::vector<std::uint16_t> shades, Layout& layout)
      : plan_(plan), shades_(std::move(shades)), layout_(layout), first_(layout.brick_count()) {}

  void put(const Vec3& foot, double heading) { put(foot, heading, plan_.kind); }
  void put(const Vec3& foot, double heading, std::uint16_t kind);
  /// What was put down since the last call becomes a part of this name.
  void close_part(const std::string& name, bool line);
  Layout& layout() { return layout_; }

 private:
  const PartPlan& plan_;
  std::vector<std::uint16_t> shades_;
  Layout& layout_;
  BrickId first_ = 0;
  std::size_t next_ = 0;
};

void put_wall(const PartPlan& plan, const WallPlan& wall, BrickLayer& layer);
void put_tower(const PartPlan& plan, const TowerPlan& tower, BrickLayer& layer);
void put_pyramid(const PartPlan& plan, const PyramidPlan& pyramid, BrickLayer& layer);
void put_field(const PartPlan& plan, const FieldPlan& field, BrickLayer& layer);
void put_ball(const PartPlan& plan, const BallPlan& ball, BrickLayer& layer);

}  // namespace topple

/// Rows, curves and single bricks: read from their tables, counted, then put down.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "layout/section.h"
#include "layout/spline.h"
#include "topple/layout.h"

namespace topple {

#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
inline constexpr std::int64_t kMaxBricks = 2'000;  // a fuzzer learns nothing from the next million
#else
inline constexpr std::int64_t kMaxBricks = 10'000'000;
#endif

struct RowPlan {
  Vec3 from;  ///< [m]
  double heading_deg = 0.0;
  double pitch = 0.0;  ///< [m]
};
struct CurvePlan {
  Spline spline;
  double pitch = 0.0;  ///< Along the curve [m].
};
struct BrickPlan {
  Vec3 at;  ///< [m]
  double heading_deg = 0.0;
};
/// Courses in running bond, one on the other.
struct WallPlan {
  enum class Ends : std::uint8_t { half, toothed, stepped };
  Vec3 at;  ///< Middle of its foot [m].
  double heading_deg = 0.0;
  std::int64_t count = 0;  ///< Bricks of the lowest course.
  std::int64_t courses = 0;
  double pitch = 0.0;  ///< Along a course [m].
  double gap = 0.0;    ///< [m]
  Ends ends = Ends::half;
  std::uint16_t half_kind = 0;  ///< Of the bricks that close every second course.
};
/// Layers of bricks side by side, each across the one below.
struct TowerPlan {
  Vec3 at;  ///< Middle of its foot [m].
  double heading_deg = 0.0;
  std::int64_t layers = 0;
  std::int64_t count = 0;  ///< Bricks of a layer.
};
/// Layers of a rectangle of bricks, each on the middles of four below.
struct PyramidPlan {
  Vec3 at;  ///< Middle of its foot [m].
  double heading_deg = 0.0;
  std::int64_t along = 0, across = 0;  ///< Bricks of the lowest layer.
  std::int64_t layers = 0;
  double gap = 0.0;  ///< [m]
};
/// Rows side by side.
struct FieldPlan {
  enum class Starter : std::uint8_t { none, line, pushes };
  Vec3 from;  ///< [m]
  double heading_deg = 0.0;
  std::int64_t rows = 0;
  std::int64_t count = 0;  ///< Bricks of a row, its turn from the line not counted.
  double pitch = 0.0;      ///< [m]
  double row_pitch = 0.0;  ///< [m]
  Starter starter = Starter::none;
  double angular_speed = 0.0;  ///< Of each row's first brick [rad/s].
  std::int64_t steps = 0;      ///< Bricks of the line from row to row.
  std::int64_t turn = 0;       ///< Bricks of each row that turn off the line.
};
struct BallPlan {
  Vec3 at;  ///< Its lowest point [m].
  double heading_deg = 0.0;
  double speed = 0.0;  ///< [m/s]
  double start = 0.0;  ///< [s]
};

/// Bricks of a part in a colour of their own, whatever the part's colours say.
struct PaintStroke {
  std::int64_t first = 0, last = 0;  ///< Within the part; what lies beyond its end waits until there are so many bricks.
  Color color;
};

/// One entry of the file that makes bricks, understood and counted.
struct PartPlan {
  Place place;
  std::string path;  ///< "row.0"
  std::string name;  ///< "row 1"
  std::uint16_t kind = 0;
  Stance stance = Stance::standing;
  Color color, color_to;  ///< Of the first brick and of the last.
  std::vector<PaintStroke> paint;
  std::int64_t count = 0;
  std::variant<RowPlan, CurvePlan, BrickPlan, WallPlan, TowerPlan, PyramidPlan, FieldPlan, BallPlan> shape;
};

// Each is empty after a problem. A wall that needs halves of its bricks, and a ball, add kinds of their own.
std::optional<PartPlan> read_row(Section& section, std::vector<BrickKind>& kinds);
std::optional<PartPlan> read_curve(Section& section, std::vector<BrickKind>& kinds);
std::optional<PartPlan> read_brick(Section& section, std::vector<BrickKind>& kinds);
std::optional<PartPlan> read_field(Section& section, std::vector<BrickKind>& kinds);
std::optional<PartPlan> read_wall(Section& section, std::vector<BrickKind>& kinds);
std::optional<PartPlan> read_tower(Section& section, std::vector<BrickKind>& kinds);
std::optional<PartPlan> read_pyramid(Section& section, std::vector<BrickKind>& kinds);
std::optional<PartPlan> read_ball(Section& section, std::vector<BrickKind>& kinds, const Surface& surface);

/// The number of the first brick of each plan.
std::vector<BrickId> first_bricks(const std::vector<PartPlan>& plans);

/// Gives each distinct colour of a layout one number.
class Palette {
 public:
  explicit Palette(std::vector<Color>& colors) : colors_(&colors) {}
  /// Empty when there is no room for another.
  std::optional<std::uint16_t> number(const Color& color);

 private:
  std::vector<Color>* colors_;
  std::map<std::uint32_t, std::uint16_t> numbers_;
};

/// Appends the bricks of a part, their colours, and the pushes that it brings. False: more colours than a layout may have.
bool put_down(PartPlan& plan, Palette& palette, Layout& layout);

}  // namespace topple

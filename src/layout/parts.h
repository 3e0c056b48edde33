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

/// One entry of the file that makes bricks, understood and counted.
struct PartPlan {
  Place place;
  std::string path;  ///< "row.0"
  std::string name;  ///< "row 1"
  std::uint16_t kind = 0;
  Stance stance = Stance::standing;
  Color color, color_to;  ///< Of the first brick and of the last.
  std::int64_t count = 0;
  std::variant<RowPlan, CurvePlan, BrickPlan> shape;
};

/// Each is empty after a problem.
std::optional<PartPlan> read_row(Section& section, std::span<const BrickKind> kinds);
std::optional<PartPlan> read_curve(Section& section, std::span<const BrickKind> kinds);
std::optional<PartPlan> read_brick(Section& section, std::span<const BrickKind> kinds);

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

/// Appends the bricks of a part and their colours. False: more colours than a layout may have.
bool put_down(PartPlan& plan, Palette& palette, Layout& layout);

}  // namespace topple

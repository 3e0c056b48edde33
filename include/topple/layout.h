/// A layout: every brick at its true size and place, the floor, the pushes. Checked once while reading, then constant.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "topple/base.h"

namespace topple {

/// Friction (Coulomb) and restitution of a pair in contact, as the papers state them; pure numbers.
struct Surface {
  double brick_friction = 0.2;     ///< Brick on brick.
  double floor_friction = 0.5;     ///< Brick on floor.
  double brick_restitution = 0.0;  ///< Brick on brick, 0 to 1.
  double floor_restitution = 0.0;  ///< Brick on floor, 0 to 1.
};

struct Color {
  std::uint8_t red = 192;
  std::uint8_t green = 57;
  std::uint8_t blue = 43;

  friend constexpr bool operator==(const Color&, const Color&) = default;
};

enum class Shape : std::uint8_t { box, ball };

/// What many bricks share. The default is a real toppling domino. A ball is a brick too: height, width and thickness are its diameter.
struct BrickKind {
  std::string name = "domino";
  double height = 0.048;      ///< [m]
  double width = 0.024;       ///< [m]
  double thickness = 0.0075;  ///< In the direction it falls [m].
  double mass = 0.0085;       ///< [kg]
  Surface surface;
  Color color;
  Shape shape = Shape::box;
  double rolling_friction = 0.0;  ///< Of a ball on the floor: a pure number.
};

/// What two kinds do to each other, whichever touches the other.
struct SurfacePair {
  std::uint16_t one = 0;  ///< Index into Layout::kinds.
  std::uint16_t other = 0;
  double friction = 0.0;     ///< Coulomb.
  double restitution = 0.0;  ///< 0 to 1.
};

/// How a brick is put down. Whatever the stance, it falls the way it heads.
enum class Stance : std::uint8_t {
  standing,  ///< On its smallest face: thickness along the heading, height up.
  flat,      ///< On its largest face: height along the heading, thickness up.
  on_side    ///< On its long narrow face: thickness along the heading, width up, height across.
};

/// One brick where it was put.
struct Brick {
  Vec3 foot;                ///< Centre of the face it stands on [m]; z = 0 on the floor.
  double heading = 0.0;     ///< The way it falls, from +x, counter-clockwise seen from above [rad].
  std::uint16_t kind = 0;   ///< Index into Layout::kinds.
  std::uint16_t color = 0;  ///< Index into Layout::colors.
  Stance stance = Stance::standing;
};

/// Sets the angular velocity of a brick about its toe, the way it heads.
struct AngularSpeedPush {
  double angular_speed = 0.0;  ///< [rad/s]
};
/// A horizontal force along the heading, for a time.
struct ForcePush {
  double force = 0.0;     ///< [N]
  double height = 0.0;    ///< Above the brick's foot [m].
  double duration = 0.0;  ///< [s]
};
/// A horizontal blow along the heading.
struct ImpulsePush {
  double impulse = 0.0;  ///< [N s]
  double height = 0.0;   ///< Above the brick's foot [m].
};

struct Push {
  BrickId brick = 0;
  double at = 0.0;  ///< When it begins [s].
  std::variant<AngularSpeedPush, ForcePush, ImpulsePush> how;
};

/// A run of consecutive bricks that one entry of the layout file made.
struct Part {
  std::string name;  ///< As a person would say it: "row 1", "curve 2", "brick 3".
  BrickId first = 0;
  BrickId count = 0;
  bool line = true;  ///< In the order in which they should fall; those of a wall, a tower or a pyramid have none.
};

/// One `key = value` of the file's [model] table (or of the command line), not yet understood: the run chapter does that.
struct Setting {
  std::string key;
  std::variant<bool, double, std::string> value;
  std::string where;  ///< "file:line:column", or "--set key".
};

struct Layout {
  std::string title;
  double gravity = 9.81;  ///< [m/s^2], downwards.
  std::vector<BrickKind> kinds;
  std::vector<SurfacePair> pairs;  ///< Those that were given outright.
  std::vector<Color> colors;
  std::vector<Brick> bricks;
  std::vector<Part> parts;
  std::vector<Push> pushes;
  std::vector<Setting> model;  ///< What the file's [model] table and the overrides say.

  // What it was read from: enough to read it again.
  std::string name;                    ///< File name or another name for messages.
  std::string text;                    ///< The TOML source.
  std::vector<std::string> overrides;  ///< `key=value`, applied to the source before reading.

  BrickId brick_count() const { return static_cast<BrickId>(bricks.size()); }
  const BrickKind& kind_of(BrickId brick) const { return kinds[bricks[static_cast<std::size_t>(brick)].kind]; }
  const Part* part_of(BrickId brick) const;  ///< Null where parts do not cover it.
};

/// Of two kinds in contact: as given outright, or the geometric mean of what each states for itself (the value
/// itself where they are alike). Every model looks it up here and nowhere else.
SurfacePair surface_pair(const Layout& layout, std::uint16_t one, std::uint16_t other);

/// Reads a layout. `name` is used in messages; each of `overrides` is `key=value` with the key a dotted path in the file
/// ("contact.brick_friction=0.3", "row.0.count=50"); a key without a dot is one of [model]. On failure the error lists every problem
/// found, a line each: "name:line:column: key: what is wrong, the value, the allowed range".
Result<Layout> read_layout(std::string_view text, std::string_view name, std::span<const std::string> overrides = {});

/// The same of a layout that is still being drawn: bricks may overlap; find_doubts() tells which.
Result<Layout> read_draft(std::string_view text, std::string_view name, std::span<const std::string> overrides = {});

/// A place where a run may stop, or cannot be.
struct Doubt {
  enum class Kind : std::uint8_t {
    overlap,       ///< `brick` and `other` are in one place: no model takes the layout.
    miss,          ///< `other`, the nearest that should, falls beside `brick`.
    beyond_reach,  ///< The gap from `other` to `brick` is too wide.
    no_neighbour,  ///< Nothing near `brick` falls towards it.
    no_push        ///< Nothing is pushed.
  };
  Kind kind = Kind::overlap;
  BrickId brick = kNoBrick;
  BrickId other = kNoBrick;
  double amount = 0.0;  ///< By how much [m].
  std::string words;    ///< As a sentence.
};
/// "beyond_reach": the word for it in tables and for programs.
constexpr std::string_view name_of(Doubt::Kind kind) {
  return std::array<std::string_view, 5>{"overlap", "miss", "beyond_reach", "no_neighbour", "no_push"}[static_cast<std::size_t>(kind)];
}

/// What geometry alone says against a layout: overlaps, and the first brick of each part or stretch that no falling brick reaches.
/// The most serious first, no more than `most` of each sort.
std::vector<Doubt> find_doubts(const Layout& layout, std::size_t most = 50);

/// The same but for overlaps, of a layout that has none: read_layout() refuses those that do.
std::vector<Doubt> find_stops(const Layout& layout, std::size_t most = 50);

/// What `topple layout` prints, from the layout alone.
struct LayoutSummary {
  struct Count {
    std::string name;
    std::int64_t bricks = 0;
  };
  std::int64_t bricks = 0;
  double length = 0.0;  ///< Along all lines, foot to foot [m].
  Vec3 low, high;       ///< Bounding box of all bricks [m].
  std::vector<Count> kinds;
  std::vector<Count> colors;  ///< Named "#rrggbb".
};
LayoutSummary summarize(const Layout& layout);

// ---- Geometry of one brick, as free functions ----

/// Size of a brick as it is put down [m].
struct Extents {
  double along = 0.0;   ///< Along its heading: the thickness of a standing brick.
  double across = 0.0;  ///< To its left: the width of a standing brick.
  double up = 0.0;      ///< The height of a standing brick.
};
Extents extents(const BrickKind& kind, Stance stance);

/// The tilt at which the centre of mass stands above the toe [rad]: atan(along / up).
double tip_angle(const Extents& size);

/// Where a brick stands as it was put down.
Pose standing_pose(const Layout& layout, BrickId brick);
Pose standing_pose(const BrickKind& kind, const Brick& put);

/// The same brick turned by `angle` [rad] about its toe (angle > 0, the way it heads) or about its heel (angle < 0).
Pose hinged_pose(const Layout& layout, BrickId brick, double angle);

/// The brick's own box, half of its height, width and thickness: x = thickness / 2, y = width / 2, z = height / 2 [m].
Vec3 half_extents(const BrickKind& kind);

/// How far a brick has turned away from the vertical axis of its stance, 0 = as put down [rad].
double tilt(const Layout& layout, BrickId brick, const Quat& orientation);

/// An oriented box, or a ball.
struct Box {
  Pose pose;
  Vec3 half;  ///< Half extents along its own axes; a ball's radius [m].
  Shape shape = Shape::box;
};
/// Signed distance of two boxes by the separating axis theorem [m]: > 0 is a lower bound of the gap between them,
/// < 0 is minus the least translation that parts them.
double separation(const Box& a, const Box& b);

}  // namespace topple

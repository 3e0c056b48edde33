// A ball that rolls into the first brick.
#include <cmath>

#include "base/trigonometry.h"
#include "layout/kinds.h"
#include "layout/style.h"

namespace topple {
namespace {

constexpr Range kSpeed{0.0, 100.0};  // [m/s]
constexpr Range kStart{0.0, 1e6};    // [s]
constexpr Range kRolling{0.0, 1.0};
constexpr double kMarble = 0.016;  // a common glass marble [m]
constexpr double kGlass = 2500.0;  // [kg/m^3]

}  // namespace

std::optional<PartPlan> read_ball(Section& section, std::vector<BrickKind>& kinds, const Surface& surface) {
  PartPlan plan;
  plan.place = section.place();
  plan.path = section.path();
  plan.count = 1;
  BallPlan ball;
  const auto at = section.point("at_mm", 3);
  if (!section.has("at_mm")) section.missing("at_mm must be there: its lowest point, [x, y] or [x, y, height]");
  ball.at = at.value_or(Vec3{});
  ball.heading_deg = section.number("heading_deg", kHeading).value_or(0.0);
  ball.speed = section.number("speed_m_s", kSpeed).value_or(0.0);
  ball.start = section.number("at_s", kStart).value_or(0.0);
  if (section.has("at_s") && !section.has("speed_m_s")) section.problem("at_s", "goes with speed_m_s alone: when the ball begins to roll");
  BrickKind kind;
  kind.shape = Shape::ball;
  const auto name = section.text("name", 200);
  if (name && name->empty()) section.problem("name", "must not be empty");
  // "ball.3" is the fourth.
  kind.name = name.value_or("ball " + std::to_string(std::stoll(section.path().substr(section.path().rfind('.') + 1)) + 1));
  const auto diameter = section.number("diameter_mm", kSize);
  kind.height = kind.width = kind.thickness = diameter ? *diameter / 1000.0 : kMarble;
  const double volume = kPi / 6.0 * kind.height * kind.height * kind.height;
  kind.mass = read_mass(section, volume, kGlass * volume);
  kind.surface = read_surface(section, surface);
  constexpr double kGlassOnWood = 0.005;  // the order of magnitude of hard balls on hard floors
  kind.rolling_friction = section.number("rolling_friction", kRolling).value_or(kGlassOnWood);
  kind.color = section.color("color").value_or(Color{120, 130, 140});
  for (const BrickKind& other : kinds) {
    if (other.name == kind.name) section.problem("name", "two kinds are called \"" + kind.name + "\"");
  }
  if (kinds.size() == kMaxKinds) section.missing("one kind more than the 1,000 that a layout may have");
  if (!section.good()) return std::nullopt;
  plan.kind = static_cast<std::uint16_t>(kinds.size());
  plan.color = plan.color_to = kind.color;
  plan.shape = ball;
  kinds.push_back(kind);
  return plan;
}

void put_ball(const PartPlan& plan, const BallPlan& ball, BrickLayer& layer) {
  Layout& layout = layer.layout();
  const BrickId id = layout.brick_count();
  layer.put(ball.at, radians(ball.heading_deg));
  layer.close_part(plan.name, false);
  if (ball.speed == 0.0) return;
  // A blow at 7/5 of its radius sets a ball rolling without sliding: turning as fast as it moves.
  const BrickKind& kind = layout.kinds[plan.kind];
  layout.pushes.push_back({id, ball.start, ImpulsePush{kind.mass * ball.speed, 0.7 * kind.height}});
}

}  // namespace topple

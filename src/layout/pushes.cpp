#include "layout/pushes.h"

#include <limits>

#include "layout/keys.h"
#include "layout/kinds.h"
#include "layout/text.h"

namespace topple {
namespace {

constexpr Range kDelay{0.0, 1e6};             // [s]
constexpr Range kAngularSpeed{0.0, 10000.0};  // [rad/s]
constexpr Range kForce{0.0, 1e6};             // [N]
constexpr Range kImpulse{0.0, 1e6};           // [N s]
constexpr Range kHeight{0.0, 20000.0};        // [mm]
constexpr Range kDuration{0.0, 1e6, true};    // [ms]

/// The three ways, of which a push has exactly one.
void read_way(Section& section, Push& push) {
  const auto speed = section.number("angular_speed_rad_s", kAngularSpeed);
  const auto force = section.number("force_n", kForce);
  const auto impulse = section.number("impulse_n_s", kImpulse);
  const auto height = section.number("height_mm", kHeight);
  const auto duration = section.number("duration_ms", kDuration);
  const bool by_speed = section.has("angular_speed_rad_s"), by_force = section.has("force_n"), by_impulse = section.has("impulse_n_s");
  if (int{by_speed} + int{by_force} + int{by_impulse} != 1) {
    section.missing("exactly one of angular_speed_rad_s, force_n and impulse_n_s must be there");
    return;
  }
  if (!by_speed && !section.has("height_mm")) section.missing("height_mm must be there: how far above the brick's foot it is pushed");
  if (by_speed && section.has("height_mm")) section.problem("height_mm", "goes with force_n or impulse_n_s, not with angular_speed_rad_s");
  if (by_force && !section.has("duration_ms")) section.missing("duration_ms must be there: how long the force acts");
  if (!by_force && section.has("duration_ms")) section.problem("duration_ms", "goes with force_n alone");
  if (speed) push.how = AngularSpeedPush{*speed};
  if (force) push.how = ForcePush{*force, height.value_or(0.0) / 1000.0, duration.value_or(0.0) / 1000.0};
  if (impulse) push.how = ImpulsePush{*impulse, height.value_or(0.0) / 1000.0};
}

double height_of(const Push& push) {
  if (const auto* force = std::get_if<ForcePush>(&push.how)) return force->height;
  if (const auto* impulse = std::get_if<ImpulsePush>(&push.how)) return impulse->height;
  return 0.0;
}

}  // namespace

std::vector<PushPlan> read_pushes(const Section& top, Problems& problems) {
  std::vector<PushPlan> plans;
  for (Section& section : sections_of(top, "push", keys::kPush, problems)) {
    PushPlan plan{{}, section.place_of("brick"), section.place_of("height_mm"), section.path()};
    plan.push.brick = static_cast<BrickId>(section.whole("brick", 0, std::numeric_limits<BrickId>::max()).value_or(0));
    plan.push.at = section.number("at_s", kDelay).value_or(0.0);
    read_way(section, plan.push);
    if (section.good()) plans.push_back(std::move(plan));
  }
  return plans;
}

std::vector<Push> place_pushes(const std::vector<PushPlan>& plans, const Layout& layout, Problems& problems) {
  std::vector<Push> pushes;
  if (layout.bricks.empty()) return pushes;
  for (const PushPlan& plan : plans) {
    const Push& push = plan.push;
    pushes.push_back(push);
    if (push.brick >= layout.brick_count()) {
      problems.add(plan.brick_place, plan.path + ".brick",
                   "there is no brick " + std::to_string(push.brick) + "; the bricks are 0 to " + std::to_string(layout.brick_count() - 1));
      continue;
    }
    if (std::holds_alternative<AngularSpeedPush>(push.how) && layout.kind_of(push.brick).shape == Shape::ball) {
      problems.add(plan.brick_place, plan.path + ".brick",
                   "brick " + std::to_string(push.brick) + " is a ball and has no toe to turn about; push it with force_n or impulse_n_s");
      continue;
    }
    const double up = extents(layout.kind_of(push.brick), layout.bricks[static_cast<std::size_t>(push.brick)].stance).up;
    constexpr double kLastDigits = 1e-12;
    if (height_of(push) > up * (1.0 + kLastDigits)) {
      problems.add(plan.height_place, plan.path + ".height_mm",
                   "must be a number from 0 to " + number_text(up * 1000.0) + ", the height of brick " + std::to_string(push.brick) +
                       "; is " + number_text(height_of(push) * 1000.0));
    }
  }
  return pushes;
}

}  // namespace topple

// From text to a layout: the file is understood section by section, every problem is kept, and bricks are put down only when all is well.
#include <algorithm>
#include <tuple>

#include "base/random.h"
#include "base/trigonometry.h"
#include "layout/keys.h"
#include "layout/kinds.h"
#include "layout/overlap.h"
#include "layout/overrides.h"
#include "layout/parts.h"
#include "layout/pushes.h"
#include "layout/supports.h"
#include "layout/surfaces.h"
#include "layout/text.h"

namespace topple {
namespace {

constexpr Range kGravity{0.0, 1000.0, true};  // [m/s^2]
constexpr Range kPlaceNoise{0.0, 1000.0};     // [mm]
constexpr Range kHeadingNoise{0.0, 180.0};    // [deg]

struct NoisePlan {
  std::uint64_t seed = 1;
  double position = 0.0;  // standard deviation [m]
  double heading = 0.0;   // [rad]
};

/// Reads one file. Each stage leaves its problems behind and goes on with what is good.
class Reader {
 public:
  Reader(std::string_view text, std::string_view name, std::span<const std::string> overrides, bool draft)
      : problems_(name, overrides), draft_(draft) {
    layout_.name = name;
    layout_.text = text;
    layout_.overrides.assign(overrides.begin(), overrides.end());
  }

  Result<Layout> read(Node root) {
    apply_overrides(root, layout_.overrides, problems_);
    Section top(root, "", keys::kTop, problems_);
    read_top(top);
    const Surface surface = read_contact(top, problems_);
    layout_.kinds = read_kinds(top, surface, problems_);
    read_parts(top, surface);
    layout_.pairs = read_pairs(top, layout_, problems_);
    std::vector<PushPlan> pushes = read_pushes(top, problems_);
    read_noise(top);
    read_model(top);
    root = {};
    if (parts_good_) {
      put_all_down();
      std::vector<Push> placed = place_pushes(pushes, layout_, problems_);
      layout_.pushes.insert(layout_.pushes.begin(), placed.begin(), placed.end());
    }
    if (problems_.count() > 0) return std::unexpected(problems_.error());
    return std::move(layout_);
  }

 private:
  void read_top(Section& top) {
    layout_.title = top.text("title", 1000).value_or("");
    layout_.gravity = top.number("gravity_m_s2", kGravity).value_or(layout_.gravity);
  }

  void read_parts(const Section& top, const Surface& surface) {
    std::vector<std::optional<PartPlan>> plans;
    const std::size_t problems_before = problems_.count();
    const auto read_all = [&](std::string_view key, std::span<const std::string_view> known, auto read_one) {
      int number = 0;
      for (Section& section : sections_of(top, key, known, problems_)) {
        plans.push_back(read_one(section, layout_.kinds));
        if (plans.back()) plans.back()->name = std::string(key) + " " + std::to_string(++number);
      }
    };
    read_all("row", keys::kRow, read_row);
    read_all("curve", keys::kCurve, read_curve);
    read_all("brick", keys::kBrick, read_brick);
    read_all("field", keys::kField, read_field);
    read_all("wall", keys::kWall, read_wall);
    read_all("tower", keys::kTower, read_tower);
    read_all("pyramid", keys::kPyramid, read_pyramid);
    read_all("ball", keys::kBall, [&](Section& section, std::vector<BrickKind>& kinds) { return read_ball(section, kinds, surface); });
    parts_good_ = std::all_of(plans.begin(), plans.end(), [](const auto& plan) { return plan.has_value(); });
    if (plans.empty() && problems_.count() == problems_before) {
      problems_.add({1, 1, -1}, "", "the layout is empty; it needs at least one [[row]], [[curve]] or [[brick]]");
    }
    if (plans.empty()) parts_good_ = false;
    for (auto& plan : plans) {
      if (plan) plans_.push_back(std::move(*plan));
    }
    const auto order = [](const PartPlan& plan) { return std::tie(plan.place.line, plan.place.column, plan.path); };
    const auto before = [&](const PartPlan& a, const PartPlan& b) { return order(a) < order(b); };
    if (!std::is_sorted(plans_.begin(), plans_.end(), before)) std::sort(plans_.begin(), plans_.end(), before);
  }

  void read_noise(const Section& top) {
    const auto section = section_of(top, "noise", keys::kNoise, problems_);
    if (!section) return;
    Section noise = *section;
    noise_.seed = static_cast<std::uint64_t>(noise.whole("seed", 0, std::numeric_limits<std::int64_t>::max()).value_or(1));
    noise_.position = noise.number("position_mm", kPlaceNoise).value_or(0.0) / 1000.0;
    noise_.heading = noise.number("heading_deg", kHeadingNoise).value_or(0.0) / 180.0 * kPi;
  }

  void read_model(const Section& top) {
    const Node* node = top.find("model");
    if (!node) return;
    const auto* table = std::get_if<Table>(&node->value);
    if (!table) {
      problems_.add(node->place, "model", "must be a table, [model]; is " + value_text(*node));
      return;
    }
    for (const KeyedNode& member : *table) {
      Setting setting{member.key, false, problems_.where(member.node.place)};
      if (const auto* truth = std::get_if<bool>(&member.node.value)) {
        setting.value = *truth;
      } else if (const auto* whole = std::get_if<std::int64_t>(&member.node.value)) {
        setting.value = static_cast<double>(*whole);
      } else if (const auto* number = std::get_if<double>(&member.node.value)) {
        setting.value = *number;
      } else if (const auto* text = std::get_if<std::string>(&member.node.value)) {
        setting.value = *text;
      } else {
        problems_.add(member.node.place, "model." + member.key, "must be a number, text, true or false; is " + value_text(member.node));
        continue;
      }
      layout_.model.push_back(std::move(setting));
    }
  }

  void put_all_down() {
    std::int64_t total = 0;
    for (const PartPlan& plan : plans_) {
      total += plan.count;
      if (total <= kMaxBricks) continue;
      problems_.add(plan.place, plan.path,
                    "up to here the layout has " + count_text(total) + " bricks; at most " + count_text(kMaxBricks) + " are allowed");
      return;
    }
    layout_.bricks.reserve(static_cast<std::size_t>(total));
    Palette palette(layout_.colors);
    for (PartPlan& plan : plans_) {
      if (put_down(plan, palette, layout_)) continue;
      problems_.add(plan.place, plan.path, "one colour more than the 65,536 that a layout may have");
      return;
    }
    add_noise();
    if (draft_) return;
    const std::size_t before = problems_.count();
    report_overlaps(layout_, plans_, problems_);
    if (problems_.count() == before) report_unsupported(layout_, plans_, problems_);
  }

  /// Three deviates a brick in the order of BrickId, whichever of them are used.
  void add_noise() {
    if (noise_.position == 0.0 && noise_.heading == 0.0) return;
    Random random(noise_.seed);
    for (Brick& brick : layout_.bricks) {
      brick.foot.x += noise_.position * random.normal();
      brick.foot.y += noise_.position * random.normal();
      brick.heading += noise_.heading * random.normal();
    }
  }

  Problems problems_;
  Layout layout_;
  std::vector<PartPlan> plans_;
  NoisePlan noise_;
  bool parts_good_ = true;
  bool draft_;  // Bricks may overlap or hang in the air.
};

Result<Layout> read(std::string_view text, std::string_view name, std::span<const std::string> overrides, bool draft) {
  if (const auto bad = unreadable(text)) {
    return failure(std::string(name) + ":" + std::to_string(bad->line) + ":" + std::to_string(bad->column) + ": " + bad->why);
  }
  Result<Node> root = parse_document(text, name);
  if (!root) return std::unexpected(root.error());
  return Reader(text, name, overrides, draft).read(std::move(*root));
}

}  // namespace

Result<Layout> read_layout(std::string_view text, std::string_view name, std::span<const std::string> overrides) {
  return read(text, name, overrides, false);
}

Result<Layout> read_draft(std::string_view text, std::string_view name, std::span<const std::string> overrides) {
  return read(text, name, overrides, true);
}

}  // namespace topple

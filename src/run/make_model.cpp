// The only place that knows every model: it understands their settings and builds them.
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "layout/text.h"
#include "model/hinge/hinge_model.h"
#include "model/pivot/pivot_model.h"
#include "model/rigid/lane_kernels.h"
#include "model/rigid/rigid_model.h"
#include "topple/run.h"

namespace topple {

namespace {

/// Reads the settings of one model and collects everything that is wrong with them.
class Settings {
 public:
  explicit Settings(std::span<const Setting> settings) : settings_(settings), used_(settings.size(), false) {}

  void number(std::string_view key, double scale, double low, double high, double& out) {
    const Setting* setting = find(key);
    if (setting == nullptr) return;
    const auto* value = std::get_if<double>(&setting->value);
    if (value == nullptr) return wrong(*setting, "must be a number");
    if (!(*value >= low && *value <= high)) return wrong(*setting, "must be from " + number_text(low) + " to " + number_text(high));
    out = *value * scale;
  }

  void flag(std::string_view key, bool& out) {
    const Setting* setting = find(key);
    if (setting == nullptr) return;
    const auto* value = std::get_if<bool>(&setting->value);
    if (value == nullptr) return wrong(*setting, "must be true or false");
    out = *value;
  }

  template <typename Value, std::size_t N>
  void choice(std::string_view key, const std::array<std::pair<std::string_view, Value>, N>& choices, Value& out) {
    const Setting* setting = find(key);
    if (setting == nullptr) return;
    std::string allowed;
    for (const auto& [name, value] : choices) {
      const auto* given = std::get_if<std::string>(&setting->value);
      if (given != nullptr && *given == name) {
        out = value;
        return;
      }
      allowed += (allowed.empty() ? "\"" : ", \"") + std::string(name) + "\"";
    }
    wrong(*setting, "must be one of " + allowed);
  }

  /// Every key that nobody asked for is wrong too.
  Result<void> finish(std::string_view model) {
    for (std::size_t i = 0; i < settings_.size(); ++i) {
      if (used_[i] || settings_[i].key == "name") continue;
      add(settings_[i].where + ": model." + settings_[i].key + ": model \"" + std::string(model) + "\" has no such setting; it has " +
          known_);
    }
    if (problems_.empty()) return {};
    return failure(problems_);
  }

 private:
  const Setting* find(std::string_view key) {
    known_ += (known_.empty() ? "" : ", ") + std::string(key);
    const Setting* found = nullptr;
    for (std::size_t i = 0; i < settings_.size(); ++i) {
      if (settings_[i].key != key) continue;
      used_[i] = true;
      found = &settings_[i];
    }
    return found;
  }

  static std::string text(const Setting& setting) {
    if (const auto* number = std::get_if<double>(&setting.value)) return number_text(*number);
    if (const auto* flag = std::get_if<bool>(&setting.value)) return *flag ? "true" : "false";
    return "\"" + std::get<std::string>(setting.value) + "\"";
  }

  void wrong(const Setting& setting, const std::string& why) {
    add(setting.where + ": model." + setting.key + ": " + why + ", not " + text(setting));
  }

  void add(const std::string& problem) { problems_ += (problems_.empty() ? "" : "\n") + problem; }

  std::span<const Setting> settings_;
  std::vector<bool> used_;
  std::string known_;
  std::string problems_;
};

Result<ModelConfig> pivot_config(const Layout& layout) {
  using namespace std::string_view_literals;
  PivotConfig config;
  Settings settings(layout.model);
  settings.number("time_step_s", 1.0, 1e-6, 0.01, config.time_step);
  settings.choice("integrator",
                  std::array{std::pair{"euler"sv, Integrator::euler}, std::pair{"semi_implicit"sv, Integrator::semi_implicit},
                             std::pair{"rk4"sv, Integrator::rk4}},
                  config.integrator);
  settings.choice("inertia", std::array{std::pair{"report"sv, InertiaRule::report}, std::pair{"pivot"sv, InertiaRule::pivot}},
                  config.inertia);
  settings.choice(
      "hit",
      std::array{std::pair{"momentum"sv, HitRule::momentum}, std::pair{"report"sv, HitRule::report}, std::pair{"same"sv, HitRule::same}},
      config.hit);
  settings.number("pulse_ms", 0.001, 0.001, 10000.0, config.pulse);
  if (auto checked = settings.finish("pivot"); !checked) return std::unexpected(checked.error());
  return config;
}

Result<ModelConfig> hinge_config(const Layout& layout) {
  HingeConfig config{.time_step = hinge::default_time_step(layout)};
  Settings settings(layout.model);
  settings.number("time_step_s", 1.0, 1e-6, 1.0, config.time_step);
  settings.number("rest_tolerance", 1.0, 1e-9, 0.1, config.rest_tolerance);
  if (auto checked = settings.finish("hinge"); !checked) return std::unexpected(checked.error());
  return config;
}

Result<ModelConfig> rigid_config(const Layout& layout) {
  RigidConfig config{.time_step = rigid::default_time_step(layout)};
  Settings settings(layout.model);
  settings.number("time_step_s", 1.0, 1e-6, 0.05, config.time_step);
  settings.flag("every_brick_moves", config.every_brick_moves);
  if (auto checked = settings.finish("rigid"); !checked) return std::unexpected(checked.error());
  return config;
}

/// A model as the layout file and the command line know it.
struct KnownModel {
  std::string_view name;
  Result<ModelConfig> (*read_config)(const Layout&);
};
constexpr std::array kKnownModels = {KnownModel{"pivot", pivot_config}, KnownModel{"hinge", hinge_config},
                                     KnownModel{"rigid", rigid_config}};
constexpr std::string_view kDefaultModel = "rigid";  // Of a layout that names none.

// One overload a model.
std::string_view name_of(const PivotConfig&) { return "pivot"; }
std::string_view name_of(const HingeConfig&) { return "hinge"; }
std::string_view name_of(const RigidConfig&) { return "rigid"; }
Result<std::unique_ptr<Model>> make(const Layout& layout, const PivotConfig& config) { return pivot::make_pivot_model(layout, config); }
Result<std::unique_ptr<Model>> make(const Layout& layout, const HingeConfig& config) { return hinge::make_hinge_model(layout, config); }
Result<std::unique_ptr<Model>> make(const Layout& layout, const RigidConfig& config) { return rigid::make_rigid_model(layout, config); }

}  // namespace

Result<ModelConfig> model_config(const Layout& layout) {
  std::string_view name = kDefaultModel;
  std::string where = layout.name;
  for (const Setting& setting : layout.model) {
    if (setting.key != "name") continue;
    const auto* given = std::get_if<std::string>(&setting.value);
    name = given == nullptr ? std::string_view{} : *given;
    where = setting.where;
  }
  std::string allowed;
  for (const KnownModel& known : kKnownModels) {
    if (known.name == name) return known.read_config(layout);
    allowed += (allowed.empty() ? "\"" : ", \"") + std::string(known.name) + "\"";
  }
  return failure(where + ": model.name: must be one of " + allowed + ", not \"" + std::string(name) + "\"");
}

Result<std::unique_ptr<Model>> make_model(const Layout& layout, const ModelConfig& config) {
  return std::visit([&layout](const auto& chosen) { return make(layout, chosen); }, config);
}

std::string model_name(const ModelConfig& config) {
  return std::string(std::visit([](const auto& chosen) { return name_of(chosen); }, config));
}

int most_lanes() { return rigid::lane_kernels(0)->lanes; }

}  // namespace topple

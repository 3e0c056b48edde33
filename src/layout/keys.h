/// Every key that a layout file may have. docs/layout.md explains each; a test holds the two together.
#pragma once

#include <array>
#include <string_view>

namespace topple::keys {

using Key = std::string_view;

inline constexpr std::array<Key, 16> kTop{"title", "gravity_m_s2", "contact", "kind",  "pair",    "push", "row",   "curve",
                                          "brick", "field",        "wall",    "tower", "pyramid", "ball", "noise", "model"};
inline constexpr std::array<Key, 4> kContact{"brick_friction", "floor_friction", "brick_restitution", "floor_restitution"};
inline constexpr std::array<Key, 11> kKind{
    "name",  "height_mm",      "width_mm",       "thickness_mm",      "mass_g",           "density_kg_m3",
    "color", "brick_friction", "floor_friction", "brick_restitution", "floor_restitution"};
inline constexpr std::array<Key, 4> kPair{"kind", "with", "friction", "restitution"};
inline constexpr std::array<Key, 7> kPush{"brick", "at_s", "angular_speed_rad_s", "force_n", "height_mm", "duration_ms", "impulse_n_s"};
inline constexpr std::array<Key, 11> kRow{"from_mm", "heading_deg", "count",    "length_mm", "pitch_mm", "gap_mm",
                                          "kind",    "color",       "color_to", "pose",      "paint"};
inline constexpr std::array<Key, 8> kCurve{"points_mm", "pitch_mm", "gap_mm", "kind", "color", "color_to", "pose", "paint"};
inline constexpr std::array<Key, 5> kBrick{"at_mm", "heading_deg", "kind", "color", "pose"};
inline constexpr std::array<Key, 17> kField{"from_mm",  "heading_deg", "rows",     "count",   "length_mm", "row_pitch_mm",
                                            "pitch_mm", "gap_mm",      "palette",  "picture", "starter",   "angular_speed_rad_s",
                                            "kind",     "color",       "color_to", "pose",    "paint"};
inline constexpr std::array<Key, 11> kWall{"at_mm", "heading_deg", "count",    "courses", "gap_mm", "ends",
                                           "kind",  "color",       "color_to", "pose",    "paint"};
inline constexpr std::array<Key, 9> kTower{"at_mm", "heading_deg", "layers", "count", "kind", "color", "color_to", "pose", "paint"};
inline constexpr std::array<Key, 11> kPyramid{"at_mm", "heading_deg", "count_along", "count_across", "layers", "gap_mm",
                                              "kind",  "color",       "color_to",    "pose",         "paint"};
inline constexpr std::array<Key, 14> kBall{
    "at_mm", "heading_deg",      "speed_m_s",      "at_s",           "diameter_mm",       "mass_g",           "density_kg_m3", "name",
    "color", "rolling_friction", "brick_friction", "floor_friction", "brick_restitution", "floor_restitution"};
inline constexpr std::array<Key, 3> kNoise{"seed", "position_mm", "heading_deg"};

}  // namespace topple::keys

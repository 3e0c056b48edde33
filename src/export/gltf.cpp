// What is in the file is told in docs/gltf.md.
#include <cmath>
#include <map>
#include <utility>

#include "export/glb.h"
#include "export/gltf_axes.h"
#include "export/gltf_mesh.h"
#include "export/gltf_motion.h"
#include "layout/text.h"
#include "topple/export.h"

namespace topple {
namespace {

// Of the bricks in the page.
constexpr float kRoughness = 0.36F;

// The sRGB transfer function of IEC 61966-2-1, backwards.
float linear(std::uint8_t part) {
  const double x = part / 255.0;
  return static_cast<float>(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
}

GltfJson recipe(const Recording& recording, const std::string& title) {
  const Recipe& recipe = recording.recipe();
  const Layout& layout = recording.layout();
  GltfJson extras = {{"title", title},
                     {"topple_version", recipe.version},
                     {"model", recipe.model},
                     {"time_step_s", recipe.time_step},
                     {"layout_name", layout.name},
                     {"layout_toml", layout.text},
                     {"overrides", layout.overrides},
                     {"duration_s", recording.duration()}};
  if (recording.end().reason != EndReason::running) extras["hash"] = hash_digits(recording.end().hash);
  return extras;
}

/// Puts a recording into a Glb, brick by brick.
class Scene {
 public:
  Scene(const Recording& recording, const GltfConfig& config) : recording_(recording), layout_(recording.layout()), config_(config) {}

  Result<void> write(const std::filesystem::path& path) {
    // Node i is brick i.
    for (BrickId brick = 0; brick < layout_.brick_count() && !glb_.is_full(); ++brick) {
      add_brick(brick);
      add_motion(brick);
    }
    const std::string title = !layout_.title.empty() ? layout_.title : !layout_.name.empty() ? layout_.name : "Topple";
    const int root = add_groups(title);
    return glb_.write({.animation = title, .root = root, .extras = recipe(recording_, title)}, path);
  }

 private:
  // A part of one brick is that brick.
  const Part* group_of(BrickId brick) const {
    const Part* part = layout_.part_of(brick);
    return part != nullptr && part->count > 1 ? part : nullptr;
  }

  std::string name_of(BrickId brick) const {
    const Part* part = layout_.part_of(brick);
    if (part != nullptr && part->count == 1) return part->name;
    return (part == nullptr ? "" : part->name + " ") + "brick " + std::to_string(brick);
  }

  void add_brick(BrickId brick) {
    const Brick& put = layout_.bricks[static_cast<std::size_t>(brick)];
    const Pose pose = standing_pose(layout_, brick);
    std::vector<float> place, turn;
    add_y_up(pose.position, place);
    add_y_up(pose.orientation, turn);
    glb_.nodes.add({{"name", name_of(brick)},
                    {"mesh", mesh_of(put.kind, put.color)},
                    {"translation", place},
                    {"rotation", turn},
                    {"extras", {{"brick", brick}}}});
  }

  int mesh_of(std::uint16_t kind, std::uint16_t color) {
    const auto [mesh, fresh] = meshes_.try_emplace({kind, color}, glb_.meshes.size());
    if (fresh) {
      const auto [shape, material] = std::pair(shape_of(kind), material_of(color));
      const GltfJson primitive = {
          {"attributes", {{"POSITION", shape.places}, {"NORMAL", shape.normals}}}, {"indices", shape.corners}, {"material", material}};
      glb_.meshes.add(
          {{"name", layout_.kinds[kind].name + " " + color_text(layout_.colors[color])}, {"primitives", GltfJson::array({primitive})}});
    }
    return mesh->second;
  }

  int material_of(std::uint16_t color) {
    const auto [material, fresh] = materials_.try_emplace(color, glb_.materials.size());
    if (fresh) {
      const Color& c = layout_.colors[color];
      const GltfJson paint = {{"baseColorFactor", {linear(c.red), linear(c.green), linear(c.blue), 1.0F}},
                              {"metallicFactor", 0.0F},
                              {"roughnessFactor", kRoughness}};
      glb_.materials.add({{"name", color_text(c)}, {"pbrMetallicRoughness", paint}});
    }
    return material->second;
  }

  struct ShapeAt {
    int places, normals, corners;  // Accessors.
  };
  ShapeAt shape_of(std::uint16_t kind) {
    const auto [shape, fresh] = shapes_.try_emplace(kind);
    if (fresh) {
      const BrickMesh mesh = brick_mesh(layout_.kinds[kind], layout_.brick_count());
      shape->second = {glb_.add_vertices(mesh.places, true), glb_.add_vertices(mesh.normals, false), glb_.add_corners(mesh.corners)};
    }
    return shape->second;
  }

  void add_motion(BrickId brick) {
    recording_.tracks_of(brick, tracks_);
    for (Track& track : tracks_) {
      if (!track.hinged.empty()) track.free = free_knots(layout_, track, recording_.tolerance());
      track.hinged.clear();
    }
    const bool straight = config_.frames > 0.0;
    if (straight) {
      straight_keys(layout_, tracks_, config_.frames, keys_);
    } else {
      curved_keys(layout_, tracks_, keys_);
    }
    if (keys_.times.size() < 2) return;  // Where a track was let go of there is no way to where it ends.
    const int times = glb_.add_times(keys_.times);
    const auto add_channel = [&](const char* path, int values) {
      const int sampler = glb_.samplers.add({{"input", times}, {"output", values}, {"interpolation", straight ? "LINEAR" : "CUBICSPLINE"}});
      glb_.channels.add({{"sampler", sampler}, {"target", {{"node", brick}, {"path", path}}}});
    };
    add_channel("translation", glb_.add_keys("VEC3", 3, keys_.places));
    add_channel("rotation", glb_.add_keys("VEC4", 4, keys_.turns));
  }

  // Below one node that moves or scales all, one for each part.
  int add_groups(const std::string& title) {
    GltfJson top = GltfJson::array();
    for (BrickId brick = 0; brick < layout_.brick_count();) {
      const Part* part = group_of(brick);
      if (part == nullptr) {
        top.push_back(brick++);
        continue;
      }
      GltfJson children = GltfJson::array();
      while (brick < part->first + part->count) children.push_back(brick++);
      top.push_back(glb_.nodes.add({{"name", part->name}, {"children", children}}));
    }
    return glb_.nodes.add({{"name", title}, {"children", top}});
  }

  const Recording& recording_;
  const Layout& layout_;
  const GltfConfig config_;
  Glb glb_;
  std::map<std::pair<std::uint16_t, std::uint16_t>, int> meshes_;
  std::map<std::uint16_t, int> materials_;
  std::map<std::uint16_t, ShapeAt> shapes_;
  std::vector<Track> tracks_;
  Keys keys_;
};

}  // namespace

Result<void> export_gltf(const Recording& recording, const GltfConfig& config, const std::filesystem::path& path) {
  if (!(config.frames >= 0.0) || !std::isfinite(config.frames)) {
    return failure("frames: must be a number of keyframes a second, or 0 for the recording's own curves");
  }
  return Scene(recording, config).write(path);
}

}  // namespace topple

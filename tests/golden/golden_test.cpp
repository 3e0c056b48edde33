// A golden hash per scene and model, chained over every step's poses and velocities: any change of a motion shows here, on any compiler,
// build type or machine. tests/golden/hashes.txt is the list; a hash that changes on purpose gets a line under "Results changed" in
// CHANGELOG.md, and its new value from `topple run scenes/SCENE --model MODEL --json`.
#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "topple/export.h"
#include "topple/run.h"

namespace topple {
namespace {

struct Golden {
  std::string scene, model, hash;
};

std::vector<Golden> golden_hashes() {
  std::ifstream file(TOPPLE_SOURCE_DIR "/tests/golden/hashes.txt");
  std::vector<Golden> all;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    Golden golden;
    words >> golden.scene >> golden.model >> golden.hash;
    all.push_back(golden);
  }
  return all;
}

Layout scene_of(const std::string& scene, const std::vector<std::string>& overrides) {
  auto layout = load_layout(TOPPLE_SOURCE_DIR "/scenes/" + scene, overrides);
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  return *std::move(layout);
}

std::string hash_of(const Layout& layout, const RunConfig& run = {}) {
  const auto config = model_config(layout);
  REQUIRE_MESSAGE(config.has_value(), config.error().message);
  const auto recording = simulate(layout, *config, run);
  REQUIRE_MESSAGE(recording.has_value(), recording.error().message);
  std::ostringstream text;
  text << std::hex << std::setw(16) << std::setfill('0') << recording->end().hash;
  return text.str();
}

// Of 1, 2 and 4.
std::vector<int> lanes_of_this_processor() {
  const Layout three = *read_layout("[[row]]\ncount = 3\npitch_mm = 24\n", "three.toml");
  std::vector<int> all;
  for (const int lanes : {1, 2, 4}) {
    if (make_model(three, RigidConfig{.lanes = lanes}).has_value()) all.push_back(lanes);
  }
  return all;
}

}  // namespace

TEST_CASE("every scene moves exactly as it did") {
  for (const Golden& golden : golden_hashes()) {
    const std::string hash = hash_of(scene_of(golden.scene, {"model.name=\"" + golden.model + "\""}));
    CHECK_MESSAGE(hash == golden.hash, golden.scene, " by ", golden.model);
  }
}

TEST_CASE("no hash depends on the number of lanes") {
  const std::vector<int> lanes = lanes_of_this_processor();
  REQUIRE(lanes.size() > 1);
  for (const Golden& golden : golden_hashes()) {
    if (golden.model != "rigid") continue;
    const Layout layout = scene_of(golden.scene, {"model.name=\"rigid\""});
    // The last one, the most, is what runs by itself.
    for (std::size_t i = 0; i + 1 < lanes.size(); ++i) {
      CHECK_MESSAGE(hash_of(layout, {.lanes = lanes[i]}) == golden.hash, golden.scene, " with ", lanes[i], " lanes");
    }
  }
}

TEST_CASE("every scene of the list is there, and every scene is on the list") {
  std::set<std::string> listed;
  for (const Golden& golden : golden_hashes()) listed.insert(golden.scene);
  std::set<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(TOPPLE_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() == ".toml") found.insert(entry.path().filename().string());
  }
  for (const std::string& scene : found) CHECK_MESSAGE(listed.contains(scene), scene);
  for (const std::string& scene : listed) CHECK_MESSAGE(found.contains(scene), scene);
}

TEST_CASE("a friction that differs by 1e-12 gives another hash") {
  // pivot has no friction: restitution is what it reads of a contact.
  struct Case {
    std::string scene, model, before, after;
  };
  for (const Case& one : {Case{"report_row.toml", "pivot", "contact.brick_restitution=0.9", "contact.brick_restitution=0.900000000001"},
                          Case{"row_default.toml", "hinge", "contact.brick_friction=0.2", "contact.brick_friction=0.200000000001"},
                          Case{"row_default.toml", "rigid", "contact.brick_friction=0.2", "contact.brick_friction=0.200000000001"},
                          Case{"row_default.toml", "rigid", "contact.floor_friction=0.5", "contact.floor_friction=0.500000000001"}}) {
    const std::vector<std::string> common = {"model.name=\"" + one.model + "\"", "row.0.count=12"};
    std::vector<std::string> first = common;
    std::vector<std::string> second = common;
    first.push_back(one.before);
    second.push_back(one.after);
    CHECK_MESSAGE(hash_of(scene_of(one.scene, first)) != hash_of(scene_of(one.scene, second)), one.model);
  }
}

TEST_CASE("the hash does not depend on the number of threads") {
  const Layout fronts = scene_of("fronts.toml", {"model.name=\"rigid\""});
  const std::string alone = hash_of(fronts);
  CHECK(hash_of(fronts, {.threads = 2}) == alone);
  CHECK(hash_of(fronts, {.threads = 4}) == alone);
}

}  // namespace topple

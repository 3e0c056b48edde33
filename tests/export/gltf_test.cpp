// What a program that opens a .glb shows, against the recording that it was made of. The file is read by the few lines below, which follow
// the specification of glTF 2.0 (3.6, 3.11 and its appendix C) and nothing of ours.
#include <doctest/doctest.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "export/folder.h"
#include "export/glb.h"
#include "export/gltf_motion.h"
#include "recording/scripted_model.h"
#include "topple/export.h"
#include "topple/run.h"

using namespace topple;
using namespace topple::scripted;
using nlohmann::json;

namespace {

class GlbFile {
 public:
  explicit GlbFile(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    REQUIRE(bytes.size() > 20);
    const auto word = [&](std::size_t at) {
      std::uint32_t value = 0;
      std::memcpy(&value, bytes.data() + at, sizeof value);
      return std::size_t{value};
    };
    REQUIRE(bytes.starts_with("glTF"));
    CHECK(word(4) == 2);
    REQUIRE(word(8) == bytes.size());
    const std::size_t text = word(12);
    REQUIRE(bytes.substr(16, 4) == "JSON");
    REQUIRE(bytes.substr(24 + text, 4) == std::string("BIN\0", 4));
    REQUIRE(28 + text + word(20 + text) == bytes.size());
    document = json::parse(bytes.substr(20, text));
    binary_ = bytes.substr(28 + text);
    for (const json& channel : channels()) {
      channel_[{channel["target"]["node"], channel["target"]["path"]}] =
          document["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
    }
  }

  json document;

  json channels() const { return document.contains("animations") ? document["animations"][0]["channels"] : json::array(); }
  bool moves(BrickId brick) const { return channel_.contains({brick, "translation"}) && channel_.contains({brick, "rotation"}); }
  json sampler(BrickId brick, const std::string& path) const { return channel_.at({brick, path}); }

  std::vector<float> numbers(const json& accessor_index) const {
    const json& accessor = document["accessors"][accessor_index.get<std::size_t>()];
    const json& view = document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t parts = accessor["type"] == "SCALAR" ? 1 : accessor["type"] == "VEC3" ? 3 : 4;
    std::vector<float> out(accessor["count"].get<std::size_t>() * parts);
    const std::size_t begin = view["byteOffset"].get<std::size_t>() + accessor["byteOffset"].get<std::size_t>();
    REQUIRE(begin + 4 * out.size() <= binary_.size());
    std::memcpy(out.data(), binary_.data() + begin, 4 * out.size());
    return out;
  }

  /// Of a brick at a moment, z up again.
  Pose pose(BrickId brick, double time) const {
    const std::vector<double> p = value(brick, "translation", time);
    std::vector<double> q = value(brick, "rotation", time);
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (double& part : q) part /= length;
    return {{p[0], -p[2], p[1]}, {q[3], q[0], -q[2], q[1]}};
  }

 private:
  std::vector<double> value(BrickId brick, const std::string& path, double time) const {
    if (!channel_.contains({brick, path})) return document["nodes"][static_cast<std::size_t>(brick)][path].get<std::vector<double>>();
    const json& sampler = channel_.at({brick, path});
    const std::vector<float> times = numbers(sampler["input"]), values = numbers(sampler["output"]);
    const std::size_t parts = path == "rotation" ? 4 : 3;
    const bool curved = sampler["interpolation"] == "CUBICSPLINE";
    REQUIRE(values.size() == times.size() * parts * (curved ? 3 : 1));
    const auto after = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
    const std::size_t last = times.size() - 1, k = after == 0 ? 0 : std::min(after - 1, last), n = std::min(k + 1, last);
    // Which third of a keyframe of a spline: 0 in-tangent, 1 value, 2 out-tangent.
    const auto number = [&](std::size_t key, std::size_t third, std::size_t part) {
      return double{curved ? values[(3 * key + third) * parts + part] : values[key * parts + part]};
    };
    const double span = n == k ? 1.0 : double{times[n]} - double{times[k]};
    const double t = n == k || after == 0 ? 0.0 : (time - double{times[k]}) / span;
    std::vector<double> out;
    for (std::size_t i = 0; i < parts; ++i) {
      const double from = number(k, 1, i), to = number(n, 1, i);
      if (curved) {
        const double t2 = t * t, t3 = t2 * t;
        out.push_back((2 * t3 - 3 * t2 + 1) * from + span * (t3 - 2 * t2 + t) * number(k, 2, i) + (3 * t2 - 2 * t3) * to +
                      span * (t3 - t2) * number(n, 0, i));
      } else {
        out.push_back((1 - t) * from + t * to);
      }
    }
    return out;
  }

  std::string binary_;
  std::map<std::pair<BrickId, std::string>, json> channel_;
};

GlbFile exported(const Recording& recording, const GltfConfig& config = {}) {
  const Folder folder("gltf");
  const auto written = export_gltf(recording, config, folder / "run.glb");
  REQUIRE_MESSAGE(written.has_value(), written.error().message);
  return GlbFile(folder / "run.glb");
}

Recording run(const std::string& layout_text) {
  auto layout = read_layout(layout_text, "test.toml");
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  const auto config = model_config(*layout);
  REQUIRE(config.has_value());
  auto recording = simulate(std::move(*layout), *config);
  REQUIRE_MESSAGE(recording.has_value(), recording.error().message);
  return std::move(*recording);
}

/// How far a corner is from where the recording has it at the worst of many moments, those of the keyframes too, as a fraction of the
/// thickness.
double worst(const GlbFile& file, const Recording& recording, BrickId brick) {
  const BrickKind& kind = recording.layout().kind_of(brick);
  std::vector<double> moments;
  for (int i = 0; i <= 1500; ++i) moments.push_back((recording.duration() + 0.1) * i / 1500);
  if (file.moves(brick)) {
    for (const float time : file.numbers(file.sampler(brick, "translation")["input"])) moments.push_back(double{time});
  }
  double most = 0.0;
  for (const double time : moments) {
    most = std::max(most, corner_distance(half_extents(kind), file.pose(brick, time), recording.at(brick, time).pose) / kind.thickness);
  }
  return most;
}

// A place a metre away is rounded by 3e-8 m, a second by 6e-8 s, in which a corner moves as many metres: of a thickness of 7.5 mm that is
// 1e-5.
constexpr double kSingle = 3e-5;

const std::string kStruckByBall =
    "title = \"A ball\"\n[[kind]]\nname = \"slim\"\nheight_mm = 40\nwidth_mm = 20\nthickness_mm = 6\ncolor = \"#336699\"\n"
    "[[row]]\nkind = \"slim\"\ncount = 8\ngap_mm = 14\nfrom_mm = [40, 10]\nheading_deg = 25\n"
    "[[brick]]\nat_mm = [-200, 300]\ncolor = \"#aa2211\"\n[[ball]]\nat_mm = [4, -7]\ndiameter_mm = 24\nmass_g = 50\nheading_deg = "
    "25\nspeed_m_s = 0.7\n[model]\nname = \"rigid\"\n";

}  // namespace

TEST_CASE("glTF: a free brick and a ball are where the recording has them, to what single numbers hold") {
  const Recording recording = run(kStruckByBall);
  const GlbFile file = exported(recording);
  const BrickId ball = recording.layout().brick_count() - 1;
  REQUIRE(recording.layout().kind_of(ball).shape == Shape::ball);
  for (const BrickId brick : {0, 1, 4, 7, ball}) {
    CAPTURE(brick);
    REQUIRE(file.moves(brick));
    CHECK(file.sampler(brick, "rotation")["interpolation"] == "CUBICSPLINE");
    CHECK(norm(recording.at(brick, recording.duration()).pose.position - recording.at(brick, 0.0).pose.position) > 0.005);
    CHECK(worst(file, recording, brick) < kSingle);
  }
}

TEST_CASE("glTF: bricks that turn about an edge are within the recording's tolerance, which has their angle alone") {
  for (const std::string model : {"hinge", "pivot"}) {
    CAPTURE(model);
    const Recording recording =
        run("[[push]]\nangular_speed_rad_s = 6\n[contact]\nbrick_restitution = 0.5\n[[row]]\ncount = 9\ngap_mm = 8\nheading_deg = "
            "-130\n[model]\nname = \"" +
            model + "\"\n");
    const GlbFile file = exported(recording);
    // Not every model brings this row down.
    CHECK((file.moves(0) && file.moves(1)));
    for (BrickId brick = 0; brick < 9; ++brick) {
      CHECK(file.moves(brick) == std::isfinite(recording.rest_angle(brick)));
      CHECK(worst(file, recording, brick) < recording.tolerance());
    }
  }
}

TEST_CASE("glTF: a brick that comes back through upright, rests, and is struck again holds between") {
  // Pushed, then hit back so hard that it goes over its heel, where it is stopped; a second later it falls.
  Motion first{1, {{0.1, 0.0, 2.0, 0.0, 0.0, 0.0, 10.0}}, 0.0};
  then(first, 0.2, {0.0, 0.0, -4.0, 0.0, 0.0, 0.0, 10.0});
  first.end = 0.28;
  Motion again{1, {{1.3, first.at(0.28).angle, 3.0, 10.0, 0.0, 0.0, 10.0}}, 1.5};
  HingedScript script({first, again}, 0.0005);
  const Recording recording = record(row(3), script);
  REQUIRE(recording.at(1, 0.7).hinge.angle < -0.1);
  const GlbFile file = exported(recording);
  CHECK(worst(file, recording, 1) < recording.tolerance());
  // As it rests it does not even creep.
  CHECK(file.pose(1, 0.5).position == file.pose(1, 1.1).position);
  CHECK(file.pose(1, 0.5).orientation == file.pose(1, 1.1).orientation);
}

TEST_CASE(
    "glTF: of one orientation's two quaternions the nearer one follows; between two tracks a brick holds even if the first left it "
    "moving") {
  FreeKnot moving{.qw = 1.0F, .vx = 2.0F, .wy = 3.0F};
  FreeKnot later{.time = 0.5F, .x = 0.4F, .qw = -0.8F, .qy = -0.6F, .vx = 2.0F, .wy = 3.0F};
  FreeKnot again = later;
  again.time = 0.0F;
  const std::vector<Track> tracks = {{.brick = 0, .start = 1.0, .free = {moving, later}},
                                     {.brick = 0, .start = 4.0, .free = {again, later}}};
  Keys keys;
  curved_keys(row(1), tracks, keys);
  REQUIRE(keys.times == std::vector<float>{1.0F, 1.5F, 4.0F, 4.5F});
  // Three values a keyframe: in-tangent, value, out-tangent. x is the first part of a place, w the last of a turn, and y of ours is -z
  // there.
  const auto speed_in = [&](std::size_t key) { return keys.places[9 * key]; };
  const auto speed_out = [&](std::size_t key) { return keys.places[9 * key + 6]; };
  const auto turn = [&](std::size_t key, std::size_t part) { return keys.turns[12 * key + 4 + part]; };
  const auto turn_out = [&](std::size_t key) { return keys.turns[12 * key + 8 + 2]; };
  CHECK((speed_out(0) == 2.0F && speed_in(1) == 2.0F && speed_out(2) == 2.0F && speed_in(3) == 2.0F));
  CHECK((speed_out(1) == 0.0F && speed_in(2) == 0.0F && turn_out(1) == 0.0F && speed_out(3) == 0.0F));
  CHECK(turn_out(0) == doctest::Approx(-0.5 * 3.0));
  for (std::size_t key = 1; key < 4; ++key) {
    CHECK(turn(key, 3) == 0.8F);
    CHECK(turn(key, 2) == -0.6F);
  }
}

TEST_CASE("glTF: a hit is a jump of velocity: the curve goes on another way than it came") {
  Motion motion{0, {{0.1, 0.0, 1.0, 0.0, 0.0, 0.0, 10.0}}, 0.4};
  then(motion, 0.25, {0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 10.0});
  HingedScript script({motion}, 0.0005);
  const GlbFile file = exported(record(row(1), script));
  const std::vector<float> times = file.numbers(file.sampler(0, "rotation")["input"]);
  const std::vector<float> turns = file.numbers(file.sampler(0, "rotation")["output"]);
  CHECK(std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end());
  const auto hit = static_cast<std::size_t>(std::find_if(times.begin(), times.end(), [](float t) { return std::abs(t - 0.25F) < 1e-5F; }) -
                                            times.begin());
  REQUIRE(hit < times.size());
  // It turns at half its angular speed: the derivative of a unit quaternion is half as long as the angular velocity.
  const auto speed = [&](std::size_t third) {
    const float* rate = &turns[(3 * hit + third) * 4];
    return 2.0 * std::sqrt(double{rate[0] * rate[0] + rate[1] * rate[1] + rate[2] * rate[2] + rate[3] * rate[3]});
  };
  CHECK(speed(0) == doctest::Approx(1.0).epsilon(0.01));
  CHECK(speed(2) == doctest::Approx(5.0).epsilon(0.01));
}

TEST_CASE("glTF: straight keyframes are at whole frames, and exact there") {
  const Recording recording = run(kStruckByBall);
  const GlbFile file = exported(recording, {.frames = 24.0});
  REQUIRE(file.moves(3));
  CHECK(file.sampler(3, "rotation")["interpolation"] == "LINEAR");
  const std::vector<float> times = file.numbers(file.sampler(3, "rotation")["input"]);
  REQUIRE(times.size() > 4);
  const double thickness = recording.layout().kind_of(3).thickness;
  for (const float time : times) {
    const double frame = std::round(24.0 * double{time});
    CHECK(double{time} == doctest::Approx(frame / 24.0).epsilon(1e-7));
    const Pose truth = recording.at(3, frame / 24.0).pose;
    CHECK(corner_distance(half_extents(recording.layout().kind_of(3)), file.pose(3, double{time}), truth) < kSingle * thickness);
  }
  CHECK(recording.at(3, double{times.front()}).phase == Phase::standing);
  CHECK(recording.at(3, double{times.back()} + 0.01).phase == Phase::resting);
  const Folder folder("gltf_frames");
  CHECK_FALSE(export_gltf(recording, {.frames = -1.0}, folder / "a.glb").has_value());
}

TEST_CASE("glTF: a node a brick below its part, in metres and linear colours; what stands still has no channel") {
  const Recording recording = run(kStruckByBall);
  const json document = exported(recording).document;
  const json& nodes = document["nodes"];
  CHECK(nodes[3]["name"] == "row 1 brick 3");
  CHECK(nodes[3]["extras"]["brick"] == 3);
  CHECK(nodes[8]["name"] == "brick 1");
  CHECK(nodes[9]["name"] == "ball 1");
  const json& root = nodes[document["scenes"][0]["nodes"][0].get<std::size_t>()];
  CHECK(root["name"] == "A ball");
  REQUIRE(root["children"].size() == 3);
  const json& part = nodes[root["children"][0].get<std::size_t>()];
  CHECK(part["name"] == "row 1");
  CHECK(part["children"] == json({0, 1, 2, 3, 4, 5, 6, 7}));
  CHECK(nodes[0]["mesh"] == nodes[7]["mesh"]);
  CHECK(nodes[0]["mesh"] != nodes[8]["mesh"]);

  // A brick's own x, z and -y: thickness, height, width, to a single number.
  const json& primitive = document["meshes"][nodes[0]["mesh"].get<std::size_t>()]["primitives"][0];
  const json& places = document["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(places["max"][i].get<double>() == doctest::Approx(std::array{0.003, 0.020, 0.010}[i]).epsilon(1e-6));
  // #336699 in light: (0x33 / 255 + 0.055) / 1.055 to the power of 2.4 is 0.0331, and so on.
  const json& paint = document["materials"][primitive["material"].get<std::size_t>()]["pbrMetallicRoughness"]["baseColorFactor"];
  for (std::size_t i = 0; i < 3; ++i) CHECK(paint[i].get<double>() == doctest::Approx(std::array{0.0331, 0.1329, 0.3185}[i]).epsilon(1e-3));

  CHECK(document["animations"].size() == 1);
  CHECK(document["animations"][0]["name"] == "A ball");
  for (const json& channel : document["animations"][0]["channels"]) CHECK(channel["target"]["node"] != 8);
  const json& extras = document["asset"]["extras"];
  CHECK(document["asset"]["generator"].get<std::string>().starts_with("Topple "));
  CHECK(extras["layout_toml"] == kStruckByBall);
  CHECK(std::stoull(extras["hash"].get<std::string>(), nullptr, 16) == recording.end().hash);
}

TEST_CASE("glTF: bricks of an even row that turn alike share their turns") {
  const Recording recording = run("[[push]]\nangular_speed_rad_s = 3\n[[row]]\ncount = 100\ngap_mm = 16\n[model]\nname = \"hinge\"\n");
  const GlbFile file = exported(recording);
  std::set<int> turns, places;
  for (BrickId brick = 0; brick < 100; ++brick) {
    turns.insert(file.sampler(brick, "rotation")["output"].get<int>());
    places.insert(file.sampler(brick, "translation")["output"].get<int>());
  }
  CHECK(places.size() == 100);
  CHECK(turns.size() < 50);
}

TEST_CASE("glTF: a run in which nothing moves is a scene without an animation") {
  const GlbFile file = exported(run("[[row]]\ncount = 2\ngap_mm = 16\n"));
  CHECK_FALSE(file.document.contains("animations"));
  CHECK(file.document["bufferViews"].size() == 2);
}

TEST_CASE("glTF: what does not fit is an error, and leaves no file") {
  const Folder folder("gltf_full");
  Glb glb(300);
  CHECK_FALSE(glb.is_full());
  glb.nodes.add({{"name", "a brick"}});
  const std::vector<float> times(60, 1.0F);
  glb.add_times(times);
  CHECK(glb.is_full());
  const auto written = glb.write({}, folder / "full.glb");
  REQUIRE_FALSE(written.has_value());
  CHECK(written.error().message.find("at most 4 GiB") != std::string::npos);
  CHECK(std::filesystem::is_empty(folder / ""));
}

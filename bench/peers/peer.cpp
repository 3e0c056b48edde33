// usage: <engine> BRICKS RATE_HZ WINDOW LIMIT_S
// BRICKS: a text file, first "height width thickness" [m], then a line "x y heading" a brick. RATE_HZ: steps a second of true time.
// WINDOW: 0, or how many fallen bricks stay in the world behind the front; ahead of it kAhead stand. LIMIT_S: of CPU time.
// The run ends half a second after the last brick was reached; `arrived` is how many were.
#include "peer.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>

namespace peers {

namespace {

constexpr double kArrivalTilt = 0.17453292519943295;  // 10 degrees [rad].
constexpr double kPush = 4.0;                         // [rad/s]
constexpr double kAfter = 0.5;                        // [s]
constexpr std::size_t kAhead = 8;

double tilt(const World& world, std::size_t brick) { return std::acos(std::fmin(1.0, std::fmax(-1.0, world.upright(brick)))); }

double cpu_now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Scene read_scene(const char* path, double scale, double rate) {
  std::ifstream in(path);
  Scene scene;
  in >> scene.height >> scene.width >> scene.thickness;
  scene.height *= scale;
  scene.width *= scale;
  scene.thickness *= scale;
  // Gravity stays, so times grow as the root of lengths.
  scene.time_step = std::sqrt(scale) / rate;
  for (Brick brick; in >> brick.x >> brick.y >> brick.heading;) scene.bricks.push_back({brick.x * scale, brick.y * scale, brick.heading});
  return scene;
}

struct Wave {
  std::vector<double> arrivals;  // True times [s].
  double last_tilt = 0.0;        // Of the next brick, a step ago [rad].
  double cpu = 0.0;
  bool cut = false;
};

// The wave runs from brick to brick in the order of the file.
Wave follow(World& world, const Scene& scene, double rate, std::size_t window, double limit) {
  const std::size_t count = scene.bricks.size();
  Wave wave;
  std::size_t added = 0;
  std::size_t removed = 0;
  const auto add_up_to = [&](std::size_t end) {
    for (; added < std::min(count, end); ++added) world.add(added);
  };
  add_up_to(window == 0 ? count : kAhead);
  world.turn_about_toe(0, kPush / (scene.time_step * rate));
  double last = 0.0;
  const double begin = cpu_now();
  for (std::int64_t step = 1;; ++step) {
    world.step();
    const double time = static_cast<double>(step) / rate;
    while (wave.arrivals.size() < count) {
      const double now = tilt(world, wave.arrivals.size());
      if (now < kArrivalTilt) {
        wave.last_tilt = now;
        break;
      }
      const double share = now > wave.last_tilt ? (now - kArrivalTilt) / (now - wave.last_tilt) : 0.0;
      wave.arrivals.push_back(time - share / rate);
      wave.last_tilt = 0.0;
      last = time;
      if (window == 0) continue;
      add_up_to(wave.arrivals.size() + kAhead);
      for (; removed + window < wave.arrivals.size(); ++removed) world.remove(removed);
    }
    wave.cpu = cpu_now() - begin;
    wave.cut = wave.cpu > limit;
    // A wave that stops for 2 s is dead.
    const double patience = wave.arrivals.size() == count ? kAfter : 2.0;
    if (wave.cut || time > last + patience) return wave;
  }
}

double path_length(const Scene& scene, std::size_t from, std::size_t to) {
  double length = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    length += std::hypot(scene.bricks[i + 1].x - scene.bricks[i].x, scene.bricks[i + 1].y - scene.bricks[i].y);
  }
  return length;
}

}  // namespace

int run(int argc, char** argv, const Engine& engine) {
  if (argc != 5) {
    std::cerr << "usage: " << engine.name << " BRICKS RATE_HZ WINDOW LIMIT_S\n";
    return 2;
  }
  const double rate = std::atof(argv[2]);
  const Scene scene = read_scene(argv[1], engine.scale, rate);
  const double begin = cpu_now();
  const std::unique_ptr<World> world = engine.make(scene);
  const Wave wave = follow(*world, scene, rate, static_cast<std::size_t>(std::atoi(argv[3])), std::atof(argv[4]));
  const double cpu = cpu_now() - begin;
  const std::size_t count = scene.bricks.size();
  // Of those that were reached, since a run may be cut.
  const std::size_t from = wave.arrivals.size() / 5;
  const std::size_t to = wave.arrivals.size() * 4 / 5;
  double speed = 0.0;
  if (to > from) {
    speed = path_length(scene, from, to) / engine.scale / (wave.arrivals[to] - wave.arrivals[from]);
  }
  std::uint64_t hash = 0x243F6A8885A308D3ULL;
  for (const double arrival : wave.arrivals) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(arrival)) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 29;
  }
  std::printf(
      "{\"engine\": \"%s\", \"version\": \"%s\", \"bricks\": %zu, \"arrived\": %zu, \"cpu_s\": %.6f, \"front_speed_m_s\": %.6f, "
      "\"cut\": %s, \"hash\": \"%016llx\"}\n",
      engine.name.c_str(), engine.version.c_str(), count, wave.arrivals.size(), cpu, speed, wave.cut ? "true" : "false",
      static_cast<unsigned long long>(hash));
  return 0;
}

}  // namespace peers

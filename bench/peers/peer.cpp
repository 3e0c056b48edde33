// usage: <engine> BRICKS RATE_HZ WINDOW LIMIT_S [STAND_S]
// BRICKS: a text file, first "height width thickness" [m], then a line "x y z heading row" a brick: the first of each row is pushed, and
// the wave runs along the row. RATE_HZ: steps a second of true time. WINDOW: 0, or how many fallen bricks stay in the world behind each
// front; ahead of it kAhead stand. LIMIT_S: of CPU time. STAND_S: no push, nobody sleeps, and the run lasts so long in true time; `drift`
// is the largest way of a brick's middle over the thickness. Otherwise the run ends half a second after the last brick was reached;
// `arrived` is how many were.
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
  long last = -1;
  long row = 0;
  for (Brick brick; in >> brick.x >> brick.y >> brick.z >> brick.heading >> row;) {
    if (row != last) scene.rows.push_back(scene.bricks.size());
    last = row;
    scene.bricks.push_back({brick.x * scale, brick.y * scale, brick.z * scale, brick.heading});
  }
  scene.rows.push_back(scene.bricks.size());
  return scene;
}

// The wave along one row, from brick to brick in the order of the file.
class Wave {
 public:
  Wave(World& world, std::size_t first, std::size_t end, std::size_t window)
      : world_(world), first_(first), end_(end), window_(window), added_(first), removed_(first) {
    add_up_to(window == 0 ? end : first + kAhead);
  }

  std::size_t first() const { return first_; }
  bool done() const { return next() == end_; }
  const std::vector<double>& arrivals() const { return arrivals_; }  // True times [s].

  // After a step that ended at a time; whether a brick was reached in it.
  bool look(double time, double rate) {
    const std::size_t before = arrivals_.size();
    while (!done()) {
      const double now = tilt(world_, next());
      if (now < kArrivalTilt) {
        last_tilt_ = now;
        break;
      }
      const double share = now > last_tilt_ ? (now - kArrivalTilt) / (now - last_tilt_) : 0.0;
      arrivals_.push_back(time - share / rate);
      last_tilt_ = 0.0;
      if (window_ == 0) continue;
      add_up_to(next() + kAhead);
      for (; removed_ + window_ < next(); ++removed_) world_.remove(removed_);
    }
    return arrivals_.size() > before;
  }

 private:
  std::size_t next() const { return first_ + arrivals_.size(); }
  void add_up_to(std::size_t end) {
    for (; added_ < std::min(end_, end); ++added_) world_.add(added_);
  }

  World& world_;
  std::size_t first_, end_, window_, added_, removed_;
  std::vector<double> arrivals_;
  double last_tilt_ = 0.0;  // Of the next brick, a step ago [rad].
};

struct Outcome {
  std::vector<Wave> waves;
  bool cut = false;
  double drift = 0.0;
  double stood = 0.0;  // [s]
};

Outcome follow(World& world, const Scene& scene, double rate, std::size_t window, double limit) {
  Outcome outcome;
  for (std::size_t row = 0; row + 1 < scene.rows.size(); ++row) {
    outcome.waves.emplace_back(world, scene.rows[row], scene.rows[row + 1], window);
    world.turn_about_toe(scene.rows[row], kPush / (scene.time_step * rate));
  }
  double last = 0.0;
  const double begin = cpu_now();
  for (std::int64_t step = 1;; ++step) {
    world.step();
    const double time = static_cast<double>(step) / rate;
    bool done = true;
    for (Wave& wave : outcome.waves) {
      if (wave.look(time, rate)) last = time;
      done = done && wave.done();
    }
    outcome.cut = cpu_now() - begin > limit;
    // A wave that stops for 2 s is dead.
    if (outcome.cut || time > last + (done ? kAfter : 2.0)) return outcome;
  }
}

Outcome stand(World& world, const Scene& scene, double rate, double seconds, double limit) {
  Outcome outcome;
  std::vector<std::array<double, 3>> places;
  for (std::size_t i = 0; i < scene.bricks.size(); ++i) {
    world.add(i);
    places.push_back(world.middle(i));
  }
  const double begin = cpu_now();
  for (std::int64_t step = 1; static_cast<double>(step) <= seconds * rate && !outcome.cut; ++step) {
    world.step();
    outcome.stood = static_cast<double>(step) / rate;
    outcome.cut = cpu_now() - begin > limit;
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::array<double, 3> now = world.middle(i);
    const double way = std::hypot(now[0] - places[i][0], now[1] - places[i][1], now[2] - places[i][2]);
    outcome.drift = std::fmax(outcome.drift, way / scene.thickness);
  }
  return outcome;
}

double path_length(const Scene& scene, std::size_t from, std::size_t to) {
  double length = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    length += std::hypot(scene.bricks[i + 1].x - scene.bricks[i].x, scene.bricks[i + 1].y - scene.bricks[i].y);
  }
  return length;
}

// Mean over the rows of the speed between 20 % and 80 % of the bricks that were reached, since a run may be cut [m/s].
double front_speed(const Scene& scene, const std::vector<Wave>& waves, double scale) {
  double sum = 0.0;
  double rows = 0.0;
  for (const Wave& wave : waves) {
    const std::vector<double>& arrivals = wave.arrivals();
    const std::size_t from = arrivals.size() / 5;
    const std::size_t to = arrivals.size() * 4 / 5;
    if (to <= from) continue;
    sum += path_length(scene, wave.first() + from, wave.first() + to) / scale / (arrivals[to] - arrivals[from]);
    rows += 1.0;
  }
  return rows > 0.0 ? sum / rows : 0.0;
}

}  // namespace

int run(int argc, char** argv, const Engine& engine) {
  if (argc != 5 && argc != 6) {
    std::cerr << "usage: " << engine.name << " BRICKS RATE_HZ WINDOW LIMIT_S [STAND_S]\n";
    return 2;
  }
  const double rate = std::atof(argv[2]);
  const double limit = std::atof(argv[4]);
  Scene scene = read_scene(argv[1], engine.scale, rate);
  scene.sleeps = argc == 5;
  const double begin = cpu_now();
  const std::unique_ptr<World> world = engine.make(scene);
  const Outcome outcome = argc == 6 ? stand(*world, scene, rate, std::atof(argv[5]), limit)
                                    : follow(*world, scene, rate, static_cast<std::size_t>(std::atoi(argv[3])), limit);
  const double cpu = cpu_now() - begin;
  std::size_t arrived = 0;
  std::uint64_t hash = 0x243F6A8885A308D3ULL;
  const auto add = [&hash](double number) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(number)) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 29;
  };
  for (const Wave& wave : outcome.waves) {
    arrived += wave.arrivals().size();
    for (const double arrival : wave.arrivals()) add(arrival);
  }
  if (argc == 6) add(outcome.drift);
  std::printf(
      "{\"engine\": \"%s\", \"version\": \"%s\", \"bricks\": %zu, \"arrived\": %zu, \"cpu_s\": %.6f, \"front_speed_m_s\": %.6f, "
      "\"drift\": %.6f, \"stood_s\": %.6f, \"cut\": %s, \"hash\": \"%016llx\"}\n",
      engine.name.c_str(), engine.version.c_str(), scene.bricks.size(), arrived, cpu, front_speed(scene, outcome.waves, engine.scale),
      outcome.drift, outcome.stood, outcome.cut ? "true" : "false", static_cast<unsigned long long>(hash));
  return 0;
}

}  // namespace peers

/// A model whose bricks follow formulas, so that a recording can be held against the truth at any time.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "topple/recording.h"

namespace topple::scripted {

/// angle = a + b s + c s^2 / 2 + d (cosh(k s) - 1) + e sinh(k s), s = time - start: falls, thrusts and settling.
struct Part {
  double start = 0.0;
  double a = 0.0, b = 0.0, c = 0.0, d = 0.0, e = 0.0, k = 10.0;

  HingedState at(double time) const {
    const double s = time - start;
    const double ch = std::cosh(k * s);
    const double sh = std::sinh(k * s);
    return {a + b * s + 0.5 * c * s * s + d * (ch - 1.0) + e * sh, b + c * s + k * (d * sh + e * ch), c + k * k * (d * ch + e * sh)};
  }
};

/// One brick's motion from waking to rest; a script may have several for one brick, one after the other.
struct Motion {
  BrickId brick = 0;
  std::vector<Part> parts;
  double end = 0.0;  ///< It rests from here [s].

  const Part& part_at(double time) const {
    std::size_t i = 0;
    while (i + 1 < parts.size() && parts[i + 1].start <= time) ++i;
    return parts[i];
  }
  HingedState at(double time) const { return part_at(time).at(std::min(time, end)); }
};

/// The next part starts where the last one is at `time`, with what `part` says of its rates.
inline void then(Motion& motion, double time, Part part) {
  part.start = time;
  part.a = motion.parts.back().at(time).angle;
  motion.parts.push_back(part);
}

class HingedScript : public Model {
 public:
  HingedScript(std::vector<Motion> motions, double time_step) : motions_(std::move(motions)), time_step_(time_step) {
    std::sort(motions_.begin(), motions_.end(), [](const Motion& a, const Motion& b) { return a.parts[0].start < b.parts[0].start; });
  }

  Status step() override {
    ++steps_;
    while (awake_ < motions_.size() && motions_[awake_].parts[0].start <= time()) moving_.push_back(awake_++);
    std::erase_if(moving_, [&](std::size_t i) { return motions_[i].end <= before(); });
    return {moving_.empty() && awake_ == motions_.size() ? Progress::at_rest : Progress::running, kNoBrick};
  }
  std::int64_t step_count() const override { return steps_; }
  double time_step() const override { return time_step_; }
  void read(Frame& out) const override {
    out.time = time();
    out.hinged.clear();
    out.kinks.clear();
    out.energy = {static_cast<double>(steps_), -1.0, 2.0};
    for (const std::size_t i : moving_) read_motion(motions_[i], out);
  }
  std::span<const Event> events() const override { return {}; }
  std::span<const Contact> contacts() const override { return {}; }
  std::uint64_t hash() const override { return static_cast<std::uint64_t>(steps_) * 7919; }

  double time() const { return static_cast<double>(steps_) * time_step_; }
  const std::vector<Motion>& motions() const { return motions_; }

 private:
  double before() const { return static_cast<double>(steps_ - 1) * time_step_; }
  void read_motion(const Motion& motion, Frame& out) const {
    for (std::size_t p = 0; p < motion.parts.size(); ++p) {
      const double start = motion.parts[p].start;
      if (start <= before() || start > time()) continue;
      const HingedState old = p == 0 ? HingedState{motion.parts[0].a, 0.0, 0.0} : motion.parts[p - 1].at(start);
      out.kinks.push_back({motion.brick, start, old, motion.parts[p].at(start)});
    }
    if (motion.end <= time()) {
      const HingedState last = motion.parts.back().at(motion.end);
      out.kinks.push_back({motion.brick, motion.end, last, {last.angle, 0.0, 0.0}});
      out.hinged.push_back({motion.brick, Phase::resting, {last.angle, 0.0, 0.0}});
    } else {
      out.hinged.push_back({motion.brick, Phase::falling, motion.at(time())});
    }
  }

  std::vector<Motion> motions_;
  std::vector<std::size_t> moving_;
  std::size_t awake_ = 0;
  std::int64_t steps_ = 0;
  double time_step_;
};

/// A row of `count` bricks of the default kind, 24 mm apart, heading along x.
inline Layout row(BrickId count) {
  Layout layout;
  layout.kinds.emplace_back();
  layout.colors.emplace_back();
  for (BrickId i = 0; i < count; ++i) layout.bricks.push_back({{0.024 * i, 0.0, 0.0}, 0.0, 0, 0, Stance::standing});
  return layout;
}

/// How a brick of a row moves when it is hit at `start`: falls, hits the next, falls on, leans, and is jerked at every hit ahead.
inline Motion wave_motion(BrickId brick, double start, double period) {
  Motion motion{brick, {{start, 0.0, 1.0, 0.0, -0.05, 0.2, 14.0}}, 0.0};
  double time = start + period;
  then(motion, time, {0.0, 0.0, 0.0, 0.0, 0.3, 0.0, 14.0});
  double jerk = 1.0;
  for (int hit = 0; hit < 11; ++hit) {
    time += hit == 0 ? 0.37 * period : period;
    const double rate = motion.parts.back().at(time).rate;
    then(motion, time, {0.0, 0.55 * rate + 0.2 * jerk, 8.0 * jerk, 0.0, 0.0, 0.0, 10.0});
    jerk *= -0.6;
  }
  motion.end = time + period;
  return motion;
}

inline std::vector<Motion> wave(BrickId count, double period = 0.0254) {
  std::vector<Motion> motions;
  for (BrickId i = 0; i < count; ++i) motions.push_back(wave_motion(i, 0.0101 + period * i, period));
  return motions;
}

/// Runs a script to its end.
template <typename Script>
Recording record(Layout layout, Script& script, const RecorderConfig& config = {}) {
  Recording recording(std::move(layout), Recipe{"0.1.0", "scripted", script.time_step()});
  Recorder recorder(recording, config);
  while (true) {
    const Status status = script.step();
    recorder.take(script);
    if (status.progress != Progress::running) break;
  }
  recorder.finish({EndReason::at_rest, kNoBrick, script.step_count(), script.time(), script.hash(), "at rest"});
  return recording;
}

/// Largest distance between the corners of two poses of a box.
inline double corner_distance(const Vec3& half, const Pose& a, const Pose& b) {
  double most = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 v{(corner & 1) != 0 ? half.x : -half.x, (corner & 2) != 0 ? half.y : -half.y, (corner & 4) != 0 ? half.z : -half.z};
    most = std::max(most, norm(a.position + rotate(a.orientation, v) - b.position - rotate(b.orientation, v)));
  }
  return most;
}

}  // namespace topple::scripted

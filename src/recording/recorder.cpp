#include <cmath>

#include "recording/hinged_fit.h"
#include "recording/store.h"

namespace topple {
namespace {

constexpr std::size_t kMostEnergySamples = 16384;
constexpr std::size_t kMostHashes = 65536;
constexpr std::int32_t kClosed = -1;

// The largest error of an angle [rad] that moves no corner further than `length` [m]: the farthest one is across the box from its hinge.
double angle_tolerance(const Extents& size, double length) { return length / std::sqrt(size.along * size.along + size.up * size.up); }

bool is_finite(const HingedState& state) { return std::isfinite(state.angle + state.rate + state.acceleration); }

}  // namespace

/// The tracks that are not finished. Those of bricks that rest again leave their buffers to the next.
struct Recorder::Open {
  explicit Open(Recording::Store& the_store) : store(the_store), slot(the_store.layout.bricks.size(), kClosed) {}

  HingedState last_state(BrickId brick) const;
  HingedFit& hinged_fit(BrickId brick, double time, const HingedState& state);
  void take_kinks();
  void take_hinged();
  void close_absent();
  void close(std::size_t index, bool still);
  void take_energy(std::int64_t step_count);
  void take_hash(const Model& model);

  Recording::Store& store;
  Frame frame;
  double time_step = 0.0;
  std::int64_t step = 0;
  std::int64_t energy_stride = 1;
  std::vector<std::int32_t> slot;  // Of each brick, its place in `hinged`, or kClosed.
  std::vector<HingedFit> hinged;   // The first `moving` of them are open.
  std::size_t moving = 0;
};

HingedState Recorder::Open::last_state(BrickId brick) const {
  const std::int32_t piece = store.tracks.last_of(brick);
  if (piece == TrackStore::kNone) return {};
  const Track track = store.tracks.track(static_cast<std::size_t>(piece));
  return {track.hinged.empty() ? 0.0 : double{track.hinged.back().angle}, 0.0, 0.0};
}

// The open track of a brick; one that has none begins with `state`.
HingedFit& Recorder::Open::hinged_fit(BrickId brick, double time, const HingedState& state) {
  std::int32_t& index = slot[static_cast<std::size_t>(brick)];
  if (index == kClosed) {
    if (moving == hinged.size()) hinged.emplace_back();
    index = static_cast<std::int32_t>(moving);
    const BrickKind& kind = store.layout.kind_of(brick);
    const Extents size = extents(kind, store.layout.bricks[static_cast<std::size_t>(brick)].stance);
    hinged[moving].open(brick, time, state, angle_tolerance(size, store.tolerance * kind.thickness));
    ++moving;
  }
  return hinged[static_cast<std::size_t>(index)];
}

void Recorder::Open::take_kinks() {
  for (const Kink& kink : frame.kinks) {
    if (!is_finite(kink.before) || !is_finite(kink.after)) continue;
    const bool moved = slot[static_cast<std::size_t>(kink.brick)] != kClosed;
    HingedFit& fit = hinged_fit(kink.brick, kink.time, kink.after);
    if (moved) fit.add_kink(kink, store.tracks);
    fit.kinked = fit.seen = step;
  }
}

void Recorder::Open::take_hinged() {
  for (const HingedMotion& motion : frame.hinged) {
    if (!is_finite(motion.state)) continue;
    const std::int32_t index = slot[static_cast<std::size_t>(motion.brick)];
    if (index == kClosed) {
      const HingedState before = last_state(motion.brick);
      if (motion.phase != Phase::falling && std::abs(motion.state.angle - before.angle) < 1e-7) continue;
      // It woke without a jump of its own: at the step's beginning, and as it is accelerated now.
      hinged_fit(motion.brick, frame.time - time_step, {before.angle, 0.0, motion.state.acceleration});
    }
    HingedFit& fit = hinged_fit(motion.brick, frame.time, motion.state);
    if (fit.kinked != step || !fit.at(frame.time)) fit.add(frame.time, motion.state, store.tracks);
    // One that rests now is closed as one that was not seen.
    fit.seen = motion.phase == Phase::falling ? step : step - 1;
  }
}

void Recorder::Open::close_absent() {
  for (std::size_t i = 0; i < moving;) {
    if (hinged[i].seen == step) {
      ++i;
    } else {
      close(i, true);
    }
  }
}

void Recorder::Open::close(std::size_t index, bool still) {
  slot[static_cast<std::size_t>(hinged[index].brick())] = kClosed;
  hinged[index].close(still, store.tracks);
  --moving;
  if (index == moving) return;
  std::swap(hinged[index], hinged[moving]);
  slot[static_cast<std::size_t>(hinged[index].brick())] = static_cast<std::int32_t>(index);
}

// Every stride-th step; when there are too many, every second one goes.
void Recorder::Open::take_energy(std::int64_t step_count) {
  if (step_count % energy_stride != 0) return;
  std::vector<EnergySample>& samples = store.energy;
  if (samples.size() == kMostEnergySamples) {
    for (std::size_t i = 1; i < samples.size(); i += 2) samples[i / 2] = samples[i];
    samples.resize(samples.size() / 2);
    energy_stride *= 2;
    if (step_count % energy_stride != 0) return;
  }
  samples.push_back({frame.time, frame.energy});
}

void Recorder::Open::take_hash(const Model& model) {
  HashTrail& trail = store.hashes;
  if (model.step_count() % trail.stride != 0) return;
  if (trail.values.size() == kMostHashes) {
    for (std::size_t i = 1; i < trail.values.size(); i += 2) trail.values[i / 2] = trail.values[i];
    trail.values.resize(trail.values.size() / 2);
    trail.stride *= 2;
    if (model.step_count() % trail.stride != 0) return;
  }
  trail.values.push_back(model.hash());
}

Recorder::Recorder(Recording& recording, const RecorderConfig& config)
    : recording_(recording), open_(std::make_unique<Open>(*recording.store_)) {
  recording.store_->tolerance = config.tolerance;
}

Recorder::~Recorder() = default;

void Recorder::take(const Model& model) {
  Open& open = *open_;
  model.read(open.frame);
  open.time_step = model.time_step();
  ++open.step;
  open.take_kinks();
  open.take_hinged();
  open.close_absent();
  for (const Event& event : model.events()) open.store.add_event(event);
  open.take_energy(model.step_count());
  open.take_hash(model);
  open.store.time = open.frame.time;
}

void Recorder::finish(RunEnd end) {
  while (open_->moving > 0) open_->close(open_->moving - 1, false);
  recording_.store_->time = std::max(recording_.store_->time, end.time);
  recording_.store_->end = std::move(end);
}

}  // namespace topple

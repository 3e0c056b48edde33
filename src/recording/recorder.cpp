#include <cmath>

#include "recording/free_tracks.h"
#include "recording/hinged_fit.h"
#include "recording/store.h"
#include "topple/profile.h"

namespace topple {
namespace {

constexpr std::size_t kMostEnergySamples = 16384;
constexpr std::size_t kMostHashes = 65536;
constexpr std::int32_t kClosed = -1;
// A brick that rests for so long has a new track when it moves again [s]; a wave passes a few bricks meanwhile.
constexpr double kPatience = 0.25;
constexpr std::int64_t kStepsBetweenCloses = 64;

// The largest error of an angle [rad] that moves no corner further than `length` [m]: the farthest one is across the box from its hinge.
double angle_tolerance(const Extents& size, double length) { return length / std::sqrt(size.along * size.along + size.up * size.up); }

bool is_finite(const HingedState& state) { return std::isfinite(state.angle + state.rate + state.acceleration); }

}  // namespace

/// The tracks that are not finished. Those that are closed leave their buffers to the next.
struct Recorder::Open {
  Open(Recording::Store& the_store, const RecorderConfig& config)
      : store(the_store),
        crew(config.crew != nullptr ? *config.crew : alone),
        profile(config.profile),
        slot(the_store.layout.bricks.size(), kClosed) {}

  HingedFit& begin(BrickId brick, double time, HingedState state);
  void wake(const HingedMotion& motion);
  void take_tracks();
  void take_kinks();
  void take_hinged();
  void take_echoes();
  void take_last_states(const Model& model);
  void close_long_paused();
  void close(HingedFit& fit, bool still);
  void take_energy(std::int64_t step_count);
  void take_hash(const Model& model);

  Recording::Store& store;
  Crew alone{1};
  Crew& crew;
  Profile* profile;
  Frame frame;
  double time_step = 0.0;
  std::int64_t step = 0;
  std::int64_t energy_stride = 1;
  std::int64_t next_energy = 1;    // The next step of which the energy is kept.
  std::int64_t next_hash = 1;      // The same for the hash.
  std::vector<std::int32_t> slot;  // Of each brick, its place in `fits`, or kClosed.
  std::vector<HingedFit> fits;
  std::vector<std::int32_t> unused;  // Places in `fits`.
  FreeTracks free;
};

// Opens the track of a brick. One that moved before goes on from its last knot, if it is as near as it should be.
HingedFit& Recorder::Open::begin(BrickId brick, double time, HingedState state) {
  if (unused.empty()) {
    unused.push_back(static_cast<std::int32_t>(fits.size()));
    fits.emplace_back();
  }
  const std::int32_t index = unused.back();
  unused.pop_back();
  slot[static_cast<std::size_t>(brick)] = index;

  const BrickKind& kind = store.layout.kind_of(brick);
  const Extents size = extents(kind, store.layout.bricks[static_cast<std::size_t>(brick)].stance);
  const double tolerance = angle_tolerance(size, store.tolerance * kind.thickness);
  const std::int32_t before = store.tracks.last_of(brick);
  bool again = false;
  if (before != TrackStore::kNone) {
    const auto last = store.tracks.last_knot(before);
    again = last && std::abs(double{last->angle} - state.angle) < tolerance;
    if (again) state.angle = double{last->angle};
  }
  HingedFit& fit = fits[static_cast<std::size_t>(index)];
  fit.open(brick, time, state, tolerance, again);
  return fit;
}

void Recorder::Open::take_tracks() {
  const Timed timed(profile, Stage::tracks);
  take_kinks();
  take_hinged();
  for (const BrickId brick : frame.echoed) store.tracks.will_be_echoed(brick);
  free.take_unseen(frame, store.layout, store.tolerance, store.tracks);
  free.take(frame, time_step, store.layout, store.tolerance, store.tracks, crew);
  take_echoes();
  if (step % kStepsBetweenCloses == 0) close_long_paused();
}

void Recorder::Open::take_kinks() {
  for (const Kink& kink : frame.kinks) {
    if (!is_finite(kink.before) || !is_finite(kink.after)) continue;
    const std::int32_t index = slot[static_cast<std::size_t>(kink.brick)];
    if (index == kClosed) {
      HingedFit& fit = begin(kink.brick, kink.time, kink.after);
      fit.kinked = step;
      continue;
    }
    HingedFit& fit = fits[static_cast<std::size_t>(index)];
    if (fit.paused()) {
      fit.resume(kink.time, store.tracks);
    }
    if (frame.curved) {
      fit.follow(kink, store.tracks);
    } else {
      fit.add_kink(kink, time_step, store.tracks);
      fit.kinked = step;
    }
  }
}

// A brick that moves again without a jump of its own began at the step's beginning, accelerated as it is now.
void Recorder::Open::wake(const HingedMotion& motion) {
  const double time = frame.time - time_step;
  const std::int32_t index = slot[static_cast<std::size_t>(motion.brick)];
  if (index == kClosed) {
    double angle = 0.0;
    const std::int32_t before = store.tracks.last_of(motion.brick);
    if (before != TrackStore::kNone) {
      const auto last = store.tracks.last_knot(before);
      angle = last ? double{last->angle} : 0.0;
    }
    begin(motion.brick, time, {angle, 0.0, motion.state.acceleration});
  } else {
    fits[static_cast<std::size_t>(index)].resume(time, store.tracks);
  }
}

void Recorder::Open::take_hinged() {
  for (const HingedMotion& motion : frame.hinged) {
    if (!is_finite(motion.state)) continue;
    std::int32_t index = slot[static_cast<std::size_t>(motion.brick)];
    if (index == kClosed || fits[static_cast<std::size_t>(index)].paused()) {
      if (motion.phase != Phase::falling) continue;
      wake(motion);
      index = slot[static_cast<std::size_t>(motion.brick)];
    }
    HingedFit& fit = fits[static_cast<std::size_t>(index)];
    if (motion.phase != Phase::falling) {
      if (frame.curved) {
        fit.pause();
      } else {
        fit.pause(frame.time, motion.state, store.tracks);
      }
    } else {
      if (fit.kinked != step || !fit.at(frame.time)) fit.add(frame.time, motion.state, store.tracks);
    }
  }
}

// What is echoed may still be open: it rests by now, but not for long.
void Recorder::Open::take_echoes() {
  for (const Echo& echo : frame.echoes) {
    const std::int32_t index = slot[static_cast<std::size_t>(echo.like)];
    if (index != kClosed) close(fits[static_cast<std::size_t>(index)], true);
    store.tracks.add_echo(echo.brick, echo.like, echo.start, echo.like_start);
  }
}

// Of a curved motion the last kink is the last that is known.
void Recorder::Open::take_last_states(const Model& model) {
  frame.states_wanted = frame.last = true;
  model.read(frame);
  frame.states_wanted = frame.last = false;
  free.take_unseen(frame, store.layout, store.tolerance, store.tracks);
  if (!frame.curved) return;
  take_kinks();
  for (const HingedMotion& motion : frame.hinged) {
    const std::int32_t index = slot[static_cast<std::size_t>(motion.brick)];
    if (index == kClosed || motion.phase != Phase::falling || !is_finite(motion.state)) continue;
    HingedFit& fit = fits[static_cast<std::size_t>(index)];
    if (!fit.paused() && !fit.at(frame.time)) fit.add(frame.time, motion.state, store.tracks);
  }
}

void Recorder::Open::close_long_paused() {
  for (HingedFit& fit : fits) {
    if (fit.is_open() && fit.paused() && fit.paused_at() < frame.time - kPatience) close(fit, true);
  }
}

void Recorder::Open::close(HingedFit& fit, bool still) {
  std::int32_t& index = slot[static_cast<std::size_t>(fit.brick())];
  unused.push_back(index);
  index = kClosed;
  fit.close(still, store.tracks);
}

// Every stride-th step; when there are too many, every second one goes.
void Recorder::Open::take_energy(std::int64_t step_count) {
  if (!frame.energy_wanted) return;
  std::vector<EnergySample>& samples = store.energy;
  if (samples.size() == kMostEnergySamples) {
    for (std::size_t i = 1; i < samples.size(); i += 2) samples[i / 2] = samples[i];
    samples.resize(samples.size() / 2);
    energy_stride *= 2;
  }
  next_energy = (step_count / energy_stride + 1) * energy_stride;
  if (step_count % energy_stride == 0) samples.push_back({frame.time, frame.energy});
}

void Recorder::Open::take_hash(const Model& model) {
  const std::int64_t step_count = model.step_count();
  if (step_count < next_hash) return;
  HashTrail& trail = store.hashes;
  if (trail.values.size() == kMostHashes) {
    for (std::size_t i = 1; i < trail.values.size(); i += 2) trail.values[i / 2] = trail.values[i];
    trail.values.resize(trail.values.size() / 2);
    trail.stride *= 2;
  }
  next_hash = (step_count / trail.stride + 1) * trail.stride;
  if (step_count % trail.stride == 0) trail.values.push_back(model.hash());
}

Recorder::Recorder(Recording& recording, const RecorderConfig& config)
    : recording_(recording), open_(std::make_unique<Open>(*recording.store_, config)) {
  recording.store_->tolerance = config.tolerance;
}

Recorder::~Recorder() = default;

void Recorder::take(const Model& model) {
  Open& open = *open_;
  open.frame.states_wanted = false;
  open.frame.energy_wanted = model.step_count() >= open.next_energy;
  {
    const Timed timed(open.profile, Stage::read);
    model.read(open.frame);
  }
  open.time_step = model.time_step();
  ++open.step;
  open.take_tracks();
  const Timed timed(open.profile, Stage::events);
  for (const Event& event : model.events()) open.store.add_event(event);
  open.take_energy(model.step_count());
  open.take_hash(model);
  open.store.time = open.frame.time;
}

void Recorder::take_last(const Model& model) { open_->take_last_states(model); }

void Recorder::close_tracks() {
  for (HingedFit& fit : open_->fits) {
    if (fit.is_open()) open_->close(fit, fit.paused());
  }
  open_->free.close_all(open_->store.tracks);
}

void Recorder::finish(RunEnd end) {
  close_tracks();
  recording_.store_->time = std::max(recording_.store_->time, end.time);
  recording_.store_->end = std::move(end);
}

}  // namespace topple

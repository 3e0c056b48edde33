/// Turns the steps of one hinged brick into the fewest knots that keep every one of them within tolerance.
#pragma once

#include <memory>

#include "recording/track_store.h"

namespace topple {

/// One open track. Samples wait in a buffer, as floats relative to the last knot, until a segment from that knot cannot be stretched
/// over them any more; then the longest one that fits ends in a knot. Whether it fits is asked at 64, 128 ... samples and at jumps only,
/// so that a sample costs one or two polynomials whatever the length of its segment. A brick that rests is paused for a while before its
/// track ends: in a leaning row many move on a little at every hit ahead, and one track for all of that is shorter than one for each.
class HingedFit {
 public:
  /// `tolerance`: how far an angle may be off [rad]. `again`: it moved before, and `state` has the angle of its last knot.
  void open(BrickId brick, double time, const HingedState& state, double tolerance, bool again);
  bool is_open() const { return brick_ != kNoBrick; }
  BrickId brick() const { return brick_; }

  void add(double time, const HingedState& state, TrackStore& out) {
    append(time, state);
    if (count_ >= next_test_) stretch(out);
  }
  void add_kink(const Kink& kink, double step, TrackStore& out);  ///< `step`: time between samples [s].
  /// A kink of a frame that is curved: the quintic from the last one to this is the motion. Nothing is fitted.
  void follow(const Kink& kink, TrackStore& out);
  bool at(double time) const;  ///< Whether the last thing taken happened at this time.

  void pause(double time, const HingedState& state, TrackStore& out);  ///< It rests from now on.
  void pause();                                                        ///< It rests since the last thing taken.
  void resume(double time, TrackStore& out);                           ///< It rested until now.
  bool paused() const { return paused_; }
  double paused_at() const { return paused_at_; }

  /// `still`: it rests, so its last knot moves no more.
  void close(bool still, TrackStore& out);

  std::int64_t kinked = -1;  ///< The last step in which it had a jump.

 private:
  void append(double time, const HingedState& state) {
    if (count_ == room_) grow();
    float* const sample = samples_.get() + count_;
    sample[0] = static_cast<float>(time - base_clock_);
    sample[room_] = static_cast<float>(state.angle - base_angle_);
    sample[2 * room_] = static_cast<float>(state.rate);
    sample[3 * room_] = static_cast<float>(state.acceleration);
    ++count_;
  }
  void grow();
  float* times() const { return samples_.get(); }
  float* angles() const { return samples_.get() + room_; }
  float* rates() const { return samples_.get() + 2 * room_; }
  float* accelerations() const { return samples_.get() + 3 * room_; }
  void stop();
  bool fits(std::size_t count) const;
  bool is_dense(std::size_t count) const;
  bool never_left() const;
  void refine_start();
  HingedKnot knot(double time, double angle, double rate, double acceleration) const;
  HingedKnot knot_at(std::size_t index) const;
  std::size_t longest(std::size_t good, std::size_t bad) const;
  void stretch(TrackStore& out);
  void flush(TrackStore& out);
  void cut(std::size_t count, TrackStore& out);
  void push_knot(HingedKnot knot);
  void push_after(const HingedState& state);
  void end_long_piece(TrackStore& out);
  void store(TrackStore& out);
  bool matters(const Kink& kink);

  /// A small jump that may yet be smoothed over: what came after the sample `index`.
  struct PendingKink {
    std::size_t index;
    double rate, acceleration;
  };

  // What every sample needs comes first.
  BrickId brick_ = kNoBrick;
  bool paused_ = false;
  bool round_ = true;  // Knots are multiples of KnotSteps.
  bool again_ = false;
  bool followed_ = false;  // It has kinks of a curved frame.
  bool fresh_ = false;     // The last knot is what came after a jump.
  std::size_t count_ = 0;
  std::size_t room_ = 0;
  std::size_t next_test_ = 0;
  double base_clock_ = 0.0;           // Of the last knot [s].
  double base_angle_ = 0.0;           // Of the last knot, as it has it [rad].
  std::unique_ptr<float[]> samples_;  // Four times room_: times and angles against the last knot, rates, accelerations.

  std::size_t good_ = 0;  // So many samples are known to fit.
  float tolerance_ = 0.0F;
  double paused_at_ = 0.0;   // [s]
  double turn_angle_ = 0.0;  // At the last jump or rest [rad].
  double step_ = 0.0;        // Between two samples [s].
  double start_ = 0.0;       // Of this piece [s].
  double base_time_ = 0.0;   // base_clock_ - start_, as the knot has it [s].
  double top_rate_ = 0.0;    // Largest at a knot or jump so far [rad/s].
  std::vector<HingedKnot> knots_;
  std::vector<PendingKink> kinks_;
};

}  // namespace topple

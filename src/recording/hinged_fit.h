/// Turns the steps of one hinged brick into the fewest knots that keep every one of them within tolerance.
#pragma once

#include "recording/track_store.h"

namespace topple {

/// One open track. Samples wait in a buffer, as floats relative to the last knot, until a segment from that knot cannot be stretched
/// over them any more; then the longest one that fits ends in a knot. Whether it fits is asked at 8, 16, 32 ... samples only, so that
/// a sample costs a few polynomials whatever the length of its segment.
class HingedFit {
 public:
  /// `tolerance`: how far an angle may be off [rad].
  void open(BrickId brick, double time, const HingedState& state, double tolerance);

  BrickId brick() const { return brick_; }
  bool at(double time) const;  ///< Whether the last thing taken happened at this time.

  void add(double time, const HingedState& state, TrackStore& out) {
    append(time, state);
    if (count_ >= next_test_) stretch(out);
  }
  void add_kink(const Kink& kink, TrackStore& out);
  /// `still`: it rests, so its last knot moves no more.
  void close(bool still, TrackStore& out);

  std::int64_t seen = -1;    ///< The last step in which it moved.
  std::int64_t kinked = -1;  ///< The last step in which it had a jump.

 private:
  void append(double time, const HingedState& state);
  bool fits(std::size_t count) const;
  HingedKnot knot(double time, const HingedState& state) const;
  HingedKnot knot_at(std::size_t index) const;
  std::size_t longest(std::size_t good, std::size_t bad) const;
  void stretch(TrackStore& out);
  void flush(TrackStore& out);
  void cut(std::size_t count, TrackStore& out);
  void push_knot(const HingedKnot& knot);
  void store(TrackStore& out);
  bool matters(const Kink& kink) const;

  /// A small jump that may yet be smoothed over: what came after the sample `index`.
  struct PendingKink {
    std::size_t index;
    float rate, acceleration;
  };

  BrickId brick_ = kNoBrick;
  float tolerance_ = 0.0F;
  bool round_ = true;              // Knots are multiples of KnotSteps.
  double start_ = 0.0;             // Of this piece [s].
  double base_time_ = 0.0;         // Of the last knot, since the start, as the knot has it [s].
  double base_angle_ = 0.0;        // Of the last knot, as it has it [rad].
  double base_clock_ = 0.0;        // start_ + base_time_ [s].
  float top_rate_ = 0.0F;          // Largest so far [rad/s].
  float top_acceleration_ = 0.0F;  // [rad/s^2]
  std::size_t count_ = 0;
  std::size_t good_ = 0;  // So many samples are known to fit.
  std::size_t next_test_ = 0;
  std::vector<HingedKnot> knots_;
  std::vector<PendingKink> kinks_;
  std::vector<float> time_, angle_, rate_, acceleration_;  // Time and angle against the last knot.
};

}  // namespace topple

/// Turns the steps of one brick that moves freely into the fewest knots that keep every corner within tolerance at every one of them.
#pragma once

#include <vector>

#include "recording/track_store.h"

namespace topple {

/// One open track. Steps wait in a buffer until a segment from the last knot cannot be stretched over them any more; then the longest one
/// that fits ends in a knot. Whether it fits is asked at 4, 8, 16 ... steps, so that a step costs a few polynomials in all.
class FreeFit {
 public:
  /// How exact a track has to be.
  struct Accuracy {
    double length = 0.0;  ///< How far a corner may be off [m].
    double reach = 0.0;   ///< From the centre of mass to a corner [m].
  };

  /// From a knot at time 0 of the track, which starts at `time` [s]; `put` is where the brick was put down.
  void open(BrickId brick, double time, const FreeKnot& first, const Vec3& put, const Accuracy& accuracy);
  BrickId brick() const { return brick_; }

  void add(double time, const FreeMotion& motion);
  void close(bool still);  ///< `still`: it rests where it is.

  /// Pieces that are finished wait here: one track is fitted beside others, but they are stored one after the other.
  bool has_finished() const { return !finished_.empty(); }
  void store_finished(TrackStore& out);
  void end() { brick_ = kNoBrick; }

 private:
  using Four = float __attribute__((vector_size(16)));
  using Two = double __attribute__((vector_size(16)));
  /// A time [s] and a place [m], in the order of FreeKnot.
  struct Moment {
    Two time_x{};
    Two yz{};
  };
  /// A step against the last knot. Its numbers are in the order of FreeKnot, so that they are read and kept four at a time.
  struct Sample {
    Four place{};     ///< Its time [s], and x, y, z [m].
    Four turn{};      ///< w, x, y, z.
    Four velocity{};  ///< The first part of the angular velocity, and then x, y, z [m/s].
    Four spin{};      ///< The derivative of `turn` by time [1/s].
    Two rate_yz{};    ///< The rest of the angular velocity [rad/s],
    double rate_x{};  ///< and its first part in full.
  };

  FreeKnot knot_of(const Sample& sample) const;
  void test();
  bool fits(std::size_t count) const;
  std::size_t longest(std::size_t good, std::size_t bad) const;
  void cut(std::size_t count);
  void push_knot(const FreeKnot& knot);
  double start() const { return put_.time_x[0]; }  // Of this piece [s].
  void finish_piece();

  BrickId brick_ = kNoBrick;
  bool round_ = true;         // Knots are multiples of FreeSteps.
  float most_square_ = 0.0F;  // Of what fits() sums up [m^2].
  float reach_square_ = 0.0F;
  Moment put_;            // The start of this piece, and where the brick was put down.
  Moment last_;           // The last knot against that, as it has it.
  std::size_t good_ = 0;  // So many samples are known to fit.
  std::size_t next_test_ = 0;
  Sample base_;  // The last knot, at place and time 0.
  std::vector<Sample> samples_;
  std::vector<FreeKnot> knots_;
  struct Finished {
    double start;
    std::size_t bytes;
  };
  std::vector<Finished> finished_;
  std::vector<std::uint8_t> code_;  // Of them, one after the other.
};

}  // namespace topple

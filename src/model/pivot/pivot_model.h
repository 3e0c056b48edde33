/// The report's model [Arnesson2020], well defined for many bricks: each turns about its lower edge, hits hand on angular velocity or a
/// force, and no brick turns past what the one ahead of it allows.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "model/pivot/moving_set.h"
#include "topple/model.h"

namespace topple::pivot {

/// May refuse a layout: bricks above the floor, merges, crossings, loops. The layout must outlive the model.
Result<std::unique_ptr<Model>> make_pivot_model(const Layout& layout, const PivotConfig& config);

class PivotModel final : public Model {
 public:
  PivotModel(const Layout& layout, const PivotConfig& config, Lines lines);

  Status step() override;
  std::int64_t step_count() const override { return step_count_; }
  double time_step() const override { return config_.time_step; }
  void read(Frame& out) const override;
  std::span<const Event> events() const override { return events_; }
  std::span<const Contact> contacts() const override { return {}; }
  std::uint64_t hash() const override { return hash_.value(); }

 private:
  /// A hit inside the step.
  struct Hit {
    double time = 0.0;
    BrickId hitter = kNoBrick;
    BrickId struck = kNoBrick;
  };

  /// The tightest bound on a brick's tilt, and whose; null if nothing holds it.
  struct Hold {
    Bound bound;
    double rate = 0.0;  ///< Of the bound [rad/s].
    const Pair* pair = nullptr;
  };

  // The stages of a step.
  void wake_unsupported();
  void start_pushes();
  void find_watched();
  void hand_on_hits();
  void turn_bricks();
  Status check_and_hash();
  void rest_bricks();

  // Pushes and hits.
  void push(BrickId brick, std::size_t index, double time);
  void find_hit(Moving& hitter);
  void hand_on(const Hit& hit);
  double report_force(const Moving& hitter, double time) const;
  void strike(const Hit& hit, const Pair& pair, double omega, double force);

  // One brick.
  Moving& wake_or_find(BrickId brick, double time);
  bool fall_freely(Moving& moving);
  bool out_of_reach(const Pair& pair, const Fall& behind) const;
  void turn(Moving& moving);
  void note_end_of_push(Moving& moving, const Fall& from);
  void come_back_to_foot(Moving& moving, const Fall& from, Fall& to);
  bool stop_on_brick_behind(const Moving& moving, const Fall& from, Fall& to) const;
  Hold tightest_hold(const Moving& moving, double to) const;
  bool stay_leaning(Moving& moving);
  void lean(Moving& moving, const Fall& from, const Hold& hold, double omega_alone);
  void catch_up(Moving& moving, const Fall& from, const Fall& to, const Hold& hold);
  void slip_over_edge(Moving& moving, const Hold& hold);
  void follow_kinks(Moving& moving, const Pair& pair);
  void land(Moving& moving, const Fall& from, Fall& to);
  void note_arrival(const Moving& moving, const Fall& from, double to);
  bool follows(const Moving& moving) const;
  bool falls_on(const Moving& moving) const;
  bool at_rest(const Moving& moving) const;
  void find_unsupported(const Moving& moving);

  void kink(Moving& moving, double time, const HingedState& before, const HingedState& after);
  void note(EventKind kind, double time, BrickId brick, BrickId by = kNoBrick);
  HingedState state(const Moving& moving) const;
  Energy energy() const;
  double potential(const Body& body, const SinCos& turned) const;

  const Layout& layout_;
  PivotConfig config_;
  MovingSet moving_;
  std::vector<std::size_t> pushes_;  ///< Indices into Layout::pushes in the order of their times.
  std::size_t next_push_ = 0;

  std::int64_t step_count_ = 0;
  double begin_ = 0.0;  ///< Of the step [s].
  double end_ = 0.0;    ///< Of the step [s].
  Hash hash_;
  double push_work_ = 0.0;        ///< [J]
  double still_potential_ = 0.0;  ///< Of the bricks that do not move [J].

  std::vector<Hit> hits_;
  /// Slots, in the moving set's order, of the bricks that a step must look at: all but those that follow.
  std::vector<std::int32_t> watched_;
  bool watch_anew_ = true;            ///< watched_ is out of date.
  std::vector<std::int32_t> turned_;  ///< Slots of the bricks that were looked at in this step.
  std::vector<Event> events_;
  std::vector<Kink> kinks_;
  std::vector<HingedMotion> retired_;  ///< Bricks that came to rest in this step.
  std::vector<BrickId> unsupported_;   ///< Resting bricks whose support moved on: they wake in the next step.
};

}  // namespace topple::pivot

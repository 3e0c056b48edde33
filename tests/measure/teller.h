/// Recordings of events as a test tells them.
#pragma once

#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "recording/scripted_model.h"

namespace topple::scripted {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

inline Event event(double time, EventKind kind, BrickId brick, BrickId by = kNoBrick) {
  return {time, kind, brick, by, kNone, kNone, {kNone, kNone, kNone}};
}

/// Nothing moves; it only says what happened.
class Teller : public Model {
 public:
  explicit Teller(std::vector<Event> events) : events_(std::move(events)) {}
  Status step() override { return {++steps_ < 2 ? Progress::running : Progress::at_rest, kNoBrick}; }
  std::int64_t step_count() const override { return steps_; }
  double time_step() const override { return 100.0; }
  void read(Frame& out) const override {
    out = {};
    out.time = time();
  }
  std::span<const Event> events() const override { return steps_ == 1 ? std::span<const Event>(events_) : std::span<const Event>(); }
  std::span<const Contact> contacts() const override { return {}; }
  std::uint64_t hash() const override { return 0; }
  double time() const { return 100.0 * static_cast<double>(steps_); }

 private:
  std::vector<Event> events_;
  std::int64_t steps_ = 0;
};

inline Recording told(Layout layout, std::vector<Event> events) {
  Teller teller(std::move(events));
  return record(std::move(layout), teller);
}

}  // namespace topple::scripted

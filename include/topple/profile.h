/// Where the time of a run goes: the named stages of its steps.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace topple {

/// In the order of the table. Those inside another one are parts of its time; what several threads do at once counts for each of them.
enum class Stage : std::uint8_t {
  pushes,
  join,
  part,
  advance,
  plane_fronts,  // inside advance
  plane_lists,   // inside plane_fronts
  plane_rest,    // inside plane_fronts
  free_fronts,   // inside advance
  enter,
  gather,
  model,  // The whole step of a model that names no stages of its own.
  read,
  tracks,
  events,
  watch,
  kCount
};

class Profile {
 public:
  struct Row {
    std::string_view stage;
    int depth = 0;           ///< 0: one of those that the whole is made of; 1: inside the one before, and so on.
    std::int64_t calls = 0;  ///< From all threads.
    double time = 0.0;       ///< [s]
  };
  /// Those that were called, in the order of their names.
  std::vector<Row> rows() const;
  /// Of the stages that the whole is made of [s].
  double time() const;

  /// Numbers that the model works on side by side; 0: it has no choice of them.
  int lanes() const { return lanes_; }
  void name_lanes(int lanes) { lanes_ = lanes; }

  /// May be called by several threads at once.
  void add(Stage stage, std::chrono::steady_clock::duration time) {
    Sum& sum = sums_[static_cast<std::size_t>(stage)];
    sum.calls.fetch_add(1, std::memory_order_relaxed);
    sum.nanoseconds.fetch_add(std::chrono::duration_cast<std::chrono::nanoseconds>(time).count(), std::memory_order_relaxed);
  }

 private:
  struct Sum {
    std::atomic<std::int64_t> calls = 0;
    std::atomic<std::int64_t> nanoseconds = 0;
  };
  std::array<Sum, static_cast<std::size_t>(Stage::kCount)> sums_;
  int lanes_ = 0;
};

/// Adds the time from here to the end of its block to a stage; without a profile it costs a comparison.
class Timed {
 public:
  Timed(Profile* profile, Stage stage) : profile_(profile), stage_(stage) {
    if (profile_ != nullptr) begin_ = std::chrono::steady_clock::now();
  }
  ~Timed() {
    if (profile_ != nullptr) profile_->add(stage_, std::chrono::steady_clock::now() - begin_);
  }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  Profile* profile_;
  Stage stage_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace topple

#include "topple/profile.h"

namespace topple {

namespace {

struct Name {
  std::string_view words;
  int depth = 0;
};

constexpr std::array<Name, static_cast<std::size_t>(Stage::kCount)> kNames = {{
    {"begin pushes", 0},
    {"join fronts", 0},
    {"part fronts", 0},
    {"advance fronts", 0},
    {"in a plane", 1},
    {"list neighbours", 2},
    {"go to rest", 2},
    {"six degrees of freedom", 1},
    {"enter changes", 0},
    {"gather events and hash", 0},
    {"step the model", 0},
    {"read the frame", 0},
    {"fit tracks", 0},
    {"store events and energy", 0},
    {"watch and write", 0},
}};

}  // namespace

std::vector<Profile::Row> Profile::rows() const {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const std::int64_t calls = sums_[i].calls.load(std::memory_order_relaxed);
    if (calls == 0) continue;
    rows.push_back(
        {kNames[i].words, kNames[i].depth, calls, 1e-9 * static_cast<double>(sums_[i].nanoseconds.load(std::memory_order_relaxed))});
  }
  return rows;
}

double Profile::time() const {
  double sum = 0.0;
  for (const Row& row : rows()) sum += row.depth == 0 ? row.time : 0.0;
  return sum;
}

}  // namespace topple

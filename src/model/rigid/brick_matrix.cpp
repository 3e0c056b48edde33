#include "model/rigid/brick_matrix.h"

#include <algorithm>

#include "model/rigid/lane_kernels.h"

namespace topple::rigid {

// A row is coupled to all that it touches and, through these, to whatever they are coupled to that is eliminated later.
void BrickMatrix::shape(const BodyOrder& order) {
  const std::size_t count = order.bodies().size();
  rows_.resize(count);
  columns_.clear();
  parent_.assign(count, -1);
  mark_.assign(count, -1);
  for (std::size_t i = 0; i < count; ++i) {
    const int number = static_cast<int>(i);
    BrickRow& row = rows_[i];
    row.diagonal = {};
    row.changed = true;
    row.begin = columns_.size();
    mark_[i] = number;
    for (const int body : order.near(order.bodies()[i])) {
      const int other = order.number(body);
      if (other > number) continue;
      for (int k = other; mark_[static_cast<std::size_t>(k)] != number; k = parent_[static_cast<std::size_t>(k)]) {
        int& parent = parent_[static_cast<std::size_t>(k)];
        if (parent < 0) parent = number;
        mark_[static_cast<std::size_t>(k)] = number;
        columns_.push_back(k);
      }
    }
    row.end = columns_.size();
    std::sort(columns_.begin() + static_cast<std::ptrdiff_t>(row.begin), columns_.end());
  }
  entries_.resize(columns_.size());
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    entries_[e].column = columns_[e];
    entries_[e].lower = {};
    entries_[e].upper = {};
  }
}

std::size_t BrickMatrix::entry(int i, int j) const {
  std::size_t e = rows_[static_cast<std::size_t>(i)].begin;
  while (entries_[e].column != j) ++e;
  return e;
}

bool BrickMatrix::solve(const LaneKernels& kernels, std::span<const Column<6>> right, std::span<Column<6>> x) {
  if (rows_.empty()) return true;
  return kernels.solve(rows_.data(), rows_.size(), entries_.data(), right.front().data(), x.front().data());
}

}  // namespace topple::rigid

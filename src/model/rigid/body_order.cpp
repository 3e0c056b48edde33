#include "model/rigid/body_order.h"

#include <algorithm>

namespace topple::rigid {

namespace {
constexpr int kIdle = -1, kWaiting = -2;
// What is no wider than this is a row: its last block is that of the brick so far from the tail, as a share of all.
constexpr int kNarrow = 2;
constexpr double kRoot = 0.7;
}  // namespace

std::span<const int> BodyOrder::near(int body) const {
  const auto at = static_cast<std::size_t>(body);
  return std::span(near_).subspan(static_cast<std::size_t>(begin_[at]), static_cast<std::size_t>(begin_[at + 1] - begin_[at]));
}

// Pairs of bodies that move and share a point; marks all that have a point as waiting for their number.
void BodyOrder::list_pairs(std::span<const ContactRow> rows, std::span<const Body> bodies) {
  const auto moves = [&](int body) { return body != kFloor && bodies[static_cast<std::size_t>(body)].inverse_mass > 0.0; };
  pairs_.clear();
  number_.assign(bodies.size(), kIdle);
  begin_.assign(bodies.size() + 1, 0);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& row = rows[k];
    if (k > 0 && rows[k - 1].touch == row.touch) continue;
    const bool a = moves(row.a), b = moves(row.b);
    if (a) number_[static_cast<std::size_t>(row.a)] = kWaiting;
    if (b) number_[static_cast<std::size_t>(row.b)] = kWaiting;
    if (!a || !b) continue;
    pairs_.push_back({row.a, row.b});
    ++begin_[static_cast<std::size_t>(row.a) + 1];
    ++begin_[static_cast<std::size_t>(row.b) + 1];
  }
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  near_.resize(2 * pairs_.size());
  next_.assign(begin_.begin(), begin_.end() - 1);
  const auto list = [this](int body, int other) { near_[static_cast<std::size_t>(next_[static_cast<std::size_t>(body)]++)] = other; };
  for (const Pair& pair : pairs_) {
    list(pair.a, pair.b);
    list(pair.b, pair.a);
  }
}

void BodyOrder::find(std::span<const ContactRow> rows, std::span<const Body> bodies) {
  list_pairs(rows, bodies);
  order_.clear();
  const auto take = [this](int body) {
    number_[static_cast<std::size_t>(body)] = 0;
    order_.push_back(body);
  };
  std::size_t done = 0;
  while (true) {
    // Each heap from the brick with the fewest neighbours, the oldest of them.
    int from = kIdle;
    for (int body = 0; body < static_cast<int>(bodies.size()); ++body) {
      if (number_[static_cast<std::size_t>(body)] != kWaiting) continue;
      if (from == kIdle || near(body).size() <= near(from).size()) from = body;
    }
    if (from == kIdle) break;
    take(from);
    for (; done < order_.size(); ++done) {
      const auto begin = static_cast<std::ptrdiff_t>(order_.size());
      for (const int other : near(order_[done])) {
        if (number_[static_cast<std::size_t>(other)] == kWaiting) take(other);
      }
      const auto fewer = [this](int l, int r) { return near(l).size() < near(r).size(); };
      for (auto i = order_.begin() + begin; i != order_.end(); ++i)
        std::rotate(std::upper_bound(order_.begin() + begin, i, *i, fewer), i, i + 1);
    }
  }
  std::reverse(order_.begin(), order_.end());
  if (give_numbers() > kNarrow) return;
  // Head and tail are eliminated from either end: what changes at one leaves the other as it was.
  const auto root = static_cast<std::ptrdiff_t>(kRoot * static_cast<double>(order_.size()));
  std::reverse(order_.begin() + root, order_.end());
  give_numbers();
}

// Returns how far before itself any body is coupled to another.
int BodyOrder::give_numbers() {
  for (std::size_t i = 0; i < order_.size(); ++i) number_[static_cast<std::size_t>(order_[i])] = static_cast<int>(i);
  first_.resize(order_.size());
  int farthest = 0;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const int own = static_cast<int>(i);
    first_[i] = own;
    for (const int other : near(order_[i])) first_[i] = std::min(first_[i], number(other));
    farthest = std::max(farthest, own - first_[i]);
  }
  return farthest;
}

}  // namespace topple::rigid

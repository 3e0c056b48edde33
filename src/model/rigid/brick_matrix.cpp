#include "model/rigid/brick_matrix.h"

#include <algorithm>

namespace topple::rigid {

namespace {

// c -= a b
void subtract(BrickBlock& c, const BrickBlock& a, const BrickBlock& b) {
  for (std::size_t i = 0; i < 6; ++i) {
    Two c0 = c.row[i][0], c1 = c.row[i][1], c2 = c.row[i][2];
    for (std::size_t k = 0; k < 6; ++k) {
      const Two value = both(a.at(i, k));
      c0 -= value * b.row[k][0];
      c1 -= value * b.row[k][1];
      c2 -= value * b.row[k][2];
    }
    c.row[i] = {c0, c1, c2};
  }
}

// y -= a x
void subtract(Column<6>& y, const BrickBlock& a, const Column<6>& x) {
  const Two x0{x[0], x[1]}, x1{x[2], x[3]}, x2{x[4], x[5]};
  for (std::size_t i = 0; i < 6; ++i) {
    const Two sum = a.row[i][0] * x0 + a.row[i][1] * x1 + a.row[i][2] * x2;
    y[i] -= sum[0] + sum[1];
  }
}

// Row i of a small matrix times three wide rows.
Wide row_times(const Block<3>& a, std::size_t i, const Wide* of) {
  Wide out;
  const Two a0 = both(a.m[3 * i]), a1 = both(a.m[3 * i + 1]), a2 = both(a.m[3 * i + 2]);
  for (std::size_t k = 0; k < 3; ++k) out[k] = a0 * of[0][k] + a1 * of[1][k] + a2 * of[2][k];
  return out;
}

}  // namespace

// A row is coupled to all that it touches and, through these, to whatever they are coupled to that is eliminated later.
void BrickMatrix::shape(const BodyOrder& order) {
  const std::size_t count = order.bodies().size();
  rows_.resize(count);
  columns_.clear();
  parent_.assign(count, -1);
  mark_.assign(count, -1);
  for (std::size_t i = 0; i < count; ++i) {
    const int number = static_cast<int>(i);
    Row& row = rows_[i];
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

// What bricks before both have left between them; the entries of the row from `begin` to `at` are done.
void BrickMatrix::fill(Entry& entry, std::size_t begin, std::size_t at, BrickBlock& above) {
  const Row& other = rows_[static_cast<std::size_t>(entry.column)];
  entry.filled = false;
  std::size_t theirs = other.begin;
  for (std::size_t own = begin; own < at; ++own) {
    while (theirs < other.end && entries_[theirs].column < entries_[own].column) ++theirs;
    if (theirs == other.end) break;
    if (entries_[theirs].column != entries_[own].column) continue;
    if (!entry.filled) entry.left = entry.lower;
    entry.filled = true;
    subtract(entry.left, entries_[own].factor(), entries_[theirs].above);
    subtract(above, entries_[theirs].factor(), entries_[own].above);
  }
}

bool BrickMatrix::factorise(std::size_t i) {
  Row& row = rows_[i];
  BrickBlock pivot = row.diagonal;
  for (std::size_t e = row.begin; e < row.end; ++e) {
    Entry& entry = entries_[e];
    BrickBlock above = entry.upper;
    fill(entry, row.begin, e, above);
    divide(rows_[static_cast<std::size_t>(entry.column)].inverse, above, entry.above);
    subtract(pivot, entry.factor(), entry.above);
  }
  return invert(pivot, row.inverse);
}

bool BrickMatrix::invert(const BrickBlock& of, Inverse& out) {
  Block<3> q;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      out.p.m[3 * i + j] = of.at(i, j);
      q.m[3 * i + j] = of.at(i, j + 3);
      out.r.m[3 * i + j] = of.at(i + 3, j);
      out.s.m[3 * i + j] = of.at(i + 3, j + 3);
    }
  }
  if (!rigid::invert(out.p)) return false;
  out.x = product(out.p, q);
  subtract_product(out.s, out.r, out.x);
  return rigid::invert(out.s);
}

void BrickMatrix::divide(const Inverse& by, const BrickBlock& block, BrickBlock& out) {
  std::array<Wide, 3> top, bottom;
  for (std::size_t i = 0; i < 3; ++i) top[i] = row_times(by.p, i, block.row.data());
  for (std::size_t i = 0; i < 3; ++i) {
    const Wide off = row_times(by.r, i, top.data());
    for (std::size_t k = 0; k < 3; ++k) bottom[i][k] = block.row[i + 3][k] - off[k];
  }
  for (std::size_t i = 0; i < 3; ++i) out.row[i + 3] = row_times(by.s, i, bottom.data());
  for (std::size_t i = 0; i < 3; ++i) {
    const Wide off = row_times(by.x, i, out.row.data() + 3);
    for (std::size_t k = 0; k < 3; ++k) out.row[i][k] = top[i][k] - off[k];
  }
}

Column<6> BrickMatrix::divide(const Inverse& by, const Column<6>& y) {
  const auto times = [](const Block<3>& a, std::size_t i, const double* v) {
    return a.m[3 * i] * v[0] + a.m[3 * i + 1] * v[1] + a.m[3 * i + 2] * v[2];
  };
  Column<6> out;
  std::array<double, 3> top, bottom;
  for (std::size_t i = 0; i < 3; ++i) top[i] = times(by.p, i, y.data());
  for (std::size_t i = 0; i < 3; ++i) bottom[i] = y[i + 3] - times(by.r, i, top.data());
  for (std::size_t i = 0; i < 3; ++i) out[i + 3] = times(by.s, i, bottom.data());
  for (std::size_t i = 0; i < 3; ++i) out[i] = top[i] - times(by.x, i, out.data() + 3);
  return out;
}

bool BrickMatrix::solve(std::span<const Column<6>> right, std::span<Column<6>> x) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Row& row = rows_[i];
    for (std::size_t e = row.begin; e < row.end; ++e)
      row.changed = row.changed || rows_[static_cast<std::size_t>(entries_[e].column)].changed;
    if (!row.changed) continue;
    if (!factorise(i)) return false;
    Column<6> y = right[i];
    for (std::size_t e = row.begin; e < row.end; ++e)
      subtract(y, entries_[e].factor(), rows_[static_cast<std::size_t>(entries_[e].column)].forward);
    row.forward = divide(row.inverse, y);
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    x[i] = rows_[i].forward;
    rows_[i].changed = false;
  }
  for (std::size_t i = rows_.size(); i-- > 0;) {
    for (std::size_t e = rows_[i].begin; e < rows_[i].end; ++e)
      subtract(x[static_cast<std::size_t>(entries_[e].column)], entries_[e].above, x[i]);
  }
  return true;
}

}  // namespace topple::rigid

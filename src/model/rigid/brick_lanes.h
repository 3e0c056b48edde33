/// The solution of a sparse matrix of bricks, in lanes.
#pragma once

#include "model/rigid/brick_matrix.h"
#include "model/rigid/lanes.h"

namespace topple::rigid {

/// A row of a block.
template <int L>
inline Six<L> row_of(const BrickBlock& block, std::size_t row) {
  if constexpr (L == 4) {
    return {load_aligned<L>(block.low[row]), load_aligned<L, Two>(block.high[row])};
  } else {
    Six<L> of;
    for (std::size_t i = 0; i < 4 / L; ++i) of.v[i] = load_aligned<L>(block.low[row] + L * i);
    for (std::size_t i = 0; i < 2 / L; ++i) of.v[4 / L + i] = load_aligned<L>(block.high[row] + L * i);
    return of;
  }
}
template <int L>
inline void set_row(BrickBlock& block, std::size_t row, const Six<L>& to) {
  if constexpr (L == 4) {
    store_aligned<L>(block.low[row], to.low);
    store_aligned<L>(block.high[row], to.high);
  } else {
    for (std::size_t i = 0; i < 4 / L; ++i) store_aligned<L>(block.low[row] + L * i, to.v[i]);
    for (std::size_t i = 0; i < 2 / L; ++i) store_aligned<L>(block.high[row] + L * i, to.v[4 / L + i]);
  }
}

template <int L>
struct BrickLanes {
  /// BrickMatrix::solve(): all rows and entries, right-hand sides and unknowns, six numbers a brick.
  static bool solve(BrickRow* rows, std::size_t count, BrickEntry* entries, const double* right, double* x) {
    for (std::size_t i = 0; i < count; ++i) {
      BrickRow& row = rows[i];
      for (std::size_t e = row.begin; e < row.end; ++e) row.changed = row.changed || rows[entries[e].column].changed;
      if (!row.changed) continue;
      if (!factorise(rows, row, entries)) return false;
      double y[6];
      for (std::size_t k = 0; k < 6; ++k) y[k] = right[6 * i + k];
      for (std::size_t e = row.begin; e < row.end; ++e) subtract(y, factor(entries[e]), rows[entries[e].column].forward);
      divide(row.inverse, y, row.forward);
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < 6; ++k) x[6 * i + k] = rows[i].forward[k];
      rows[i].changed = false;
    }
    for (std::size_t i = count; i-- > 0;) {
      for (std::size_t e = rows[i].begin; e < rows[i].end; ++e)
        subtract(x + std::ptrdiff_t{6} * entries[e].column, entries[e].above, x + 6 * i);
    }
    return true;
  }

 private:
  // c -= a b
  static void subtract(BrickBlock& c, const BrickBlock& a, const BrickBlock& b) {
    for (std::size_t i = 0; i < 6; ++i) {
      Six<L> of_c = row_of<L>(c, i);
      for (std::size_t k = 0; k < 4; ++k) of_c = of_c - all<L>(a.low[i][k]) * row_of<L>(b, k);
      for (std::size_t k = 0; k < 2; ++k) of_c = of_c - all<L>(a.high[i][k]) * row_of<L>(b, 4 + k);
      set_row<L>(c, i, of_c);
    }
  }

  // y -= a x
  static void subtract(double* y, const BrickBlock& a, const double* x) {
    const Six<L> of_x = Six<L>::load(x);
    for (std::size_t i = 0; i < 6; ++i) y[i] -= (row_of<L>(a, i) * of_x).sum();
  }

  // What bricks before both have left between them; the entries of the row from `begin` to `at` are done.
  static void fill(const BrickRow* rows, BrickEntry* entries, std::size_t begin, std::size_t at, BrickBlock& above) {
    BrickEntry& entry = entries[at];
    const BrickRow& other = rows[entry.column];
    entry.filled = false;
    std::size_t theirs = other.begin;
    for (std::size_t own = begin; own < at; ++own) {
      while (theirs < other.end && entries[theirs].column < entries[own].column) ++theirs;
      if (theirs == other.end) break;
      if (entries[theirs].column != entries[own].column) continue;
      if (!entry.filled) entry.left = entry.lower;
      entry.filled = true;
      subtract(entry.left, factor(entries[own]), entries[theirs].above);
      subtract(above, factor(entries[theirs]), entries[own].above);
    }
  }

  static const BrickBlock& factor(const BrickEntry& entry) { return entry.filled ? entry.left : entry.lower; }

  static bool factorise(const BrickRow* rows, BrickRow& row, BrickEntry* entries) {
    BrickBlock pivot = row.diagonal;
    for (std::size_t e = row.begin; e < row.end; ++e) {
      BrickEntry& entry = entries[e];
      BrickBlock above = entry.upper;
      fill(rows, entries, row.begin, e, above);
      divide(rows[entry.column].inverse, above, entry.above);
      subtract(pivot, factor(entry), entry.above);
    }
    return invert(pivot, row.inverse);
  }

  // By its four quarters.
  static bool invert(const BrickBlock& of, BlockInverse& out) {
    double q[9];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        out.p[3 * i + j] = of.low[i][j];
        q[3 * i + j] = j == 0 ? of.low[i][3] : of.high[i][j - 1];
        out.r[3 * i + j] = of.low[i + 3][j];
        out.s[3 * i + j] = j == 0 ? of.low[i + 3][3] : of.high[i + 3][j - 1];
      }
    }
    if (!invert(out.p)) return false;
    for (std::size_t i = 0; i < 9; ++i) out.x[i] = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t j = 0; j < 3; ++j) out.x[3 * i + j] += out.p[3 * i + k] * q[3 * k + j];
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t j = 0; j < 3; ++j) out.s[3 * i + j] -= out.r[3 * i + k] * out.x[3 * k + j];
      }
    }
    return invert(out.s);
  }

  // Three by three, by cofactors. False if the determinant is zero or not a number.
  static bool invert(double* m) {
    const double c0 = m[4] * m[8] - m[5] * m[7];
    const double c1 = m[5] * m[6] - m[3] * m[8];
    const double c2 = m[3] * m[7] - m[4] * m[6];
    const double determinant = m[0] * c0 + m[1] * c1 + m[2] * c2;
    if (!(__builtin_fabs(determinant) > 0.0)) return false;
    const double s = 1.0 / determinant;
    const double out[9] = {s * c0, s * (m[2] * m[7] - m[1] * m[8]), s * (m[1] * m[5] - m[2] * m[4]),
                           s * c1, s * (m[0] * m[8] - m[2] * m[6]), s * (m[2] * m[3] - m[0] * m[5]),
                           s * c2, s * (m[1] * m[6] - m[0] * m[7]), s * (m[0] * m[4] - m[1] * m[3])};
    for (std::size_t i = 0; i < 9; ++i) m[i] = out[i];
    return true;
  }

  // Row i of a small matrix times three rows.
  static Six<L> row_times(const double* a, std::size_t i, const Six<L>* of) {
    return all<L>(a[3 * i]) * of[0] + all<L>(a[3 * i + 1]) * of[1] + all<L>(a[3 * i + 2]) * of[2];
  }

  static void divide(const BlockInverse& by, const BrickBlock& block, BrickBlock& out) {
    Six<L> given[3], top[3], bottom[3], below[3];
    for (std::size_t i = 0; i < 3; ++i) given[i] = row_of<L>(block, i);
    for (std::size_t i = 0; i < 3; ++i) top[i] = row_times(by.p, i, given);
    for (std::size_t i = 0; i < 3; ++i) bottom[i] = row_of<L>(block, i + 3) - row_times(by.r, i, top);
    for (std::size_t i = 0; i < 3; ++i) below[i] = row_times(by.s, i, bottom);
    for (std::size_t i = 0; i < 3; ++i) set_row<L>(out, i + 3, below[i]);
    for (std::size_t i = 0; i < 3; ++i) set_row<L>(out, i, top[i] - row_times(by.x, i, below));
  }

  static double times(const double* a, std::size_t i, const double* v) {
    return a[3 * i] * v[0] + a[3 * i + 1] * v[1] + a[3 * i + 2] * v[2];
  }

  static void divide(const BlockInverse& by, const double* y, double* out) {
    double top[3], bottom[3];
    for (std::size_t i = 0; i < 3; ++i) top[i] = times(by.p, i, y);
    for (std::size_t i = 0; i < 3; ++i) bottom[i] = y[i + 3] - times(by.r, i, top);
    for (std::size_t i = 0; i < 3; ++i) out[i + 3] = times(by.s, i, bottom);
    for (std::size_t i = 0; i < 3; ++i) out[i] = top[i] - times(by.x, i, out + 3);
  }
};

}  // namespace topple::rigid

#include "model/rigid/block_cholesky.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

namespace {

constexpr std::size_t kSize = 6;

// s -= a b^T
void subtract_product(Block6& s, const Block6& a, const Block6& b) {
  for (std::size_t k = 0; k < kSize; ++k) {
    for (std::size_t c = 0; c < kSize; ++c) {
      const double factor = b[kSize * k + c];
      for (std::size_t r = 0; r < kSize; ++r) s[kSize * c + r] -= a[kSize * k + r] * factor;
    }
  }
}

// s becomes s l^-T.
void divide(Block6& s, const Block6& l) {
  for (std::size_t c = 0; c < kSize; ++c) {
    for (std::size_t k = 0; k < c; ++k) {
      for (std::size_t r = 0; r < kSize; ++r) s[kSize * c + r] -= s[kSize * k + r] * l[kSize * k + c];
    }
    const double scale = 1.0 / l[kSize * c + c];
    for (std::size_t r = 0; r < kSize; ++r) s[kSize * c + r] *= scale;
  }
}

// One block by itself; its upper triangle is not used.
bool factor_block(Block6& s) {
  for (std::size_t c = 0; c < kSize; ++c) {
    for (std::size_t k = 0; k < c; ++k) {
      for (std::size_t r = c; r < kSize; ++r) s[kSize * c + r] -= s[kSize * k + r] * s[kSize * k + c];
    }
    if (!(s[kSize * c + c] > 0.0)) return false;
    const double root = std::sqrt(s[kSize * c + c]);
    s[kSize * c + c] = root;
    for (std::size_t r = c + 1; r < kSize; ++r) s[kSize * c + r] /= root;
  }
  return true;
}

}  // namespace

void BlockCholesky::shape(std::span<const int> first) {
  first_.assign(first.begin(), first.end());
  start_.clear();
  std::size_t count = 0;
  for (std::size_t i = 0; i < first_.size(); ++i) {
    start_.push_back(count);
    count += i + 1 - static_cast<std::size_t>(first_[i]);
  }
  blocks_.assign(count, Block6{});
}

bool BlockCholesky::factor() {
  const int rows = static_cast<int>(first_.size());
  for (int i = 0; i < rows; ++i) {
    const int from = first_[static_cast<std::size_t>(i)];
    for (int j = from; j <= i; ++j) {
      Block6& s = at(i, j);
      for (int k = std::max(from, first_[static_cast<std::size_t>(j)]); k < j; ++k) subtract_product(s, factor_at(i, k), factor_at(j, k));
      if (j < i) {
        divide(s, factor_at(j, j));
      } else if (!factor_block(s)) {
        return false;
      }
    }
  }
  return true;
}

void BlockCholesky::solve(std::span<double> x) const {
  const int rows = static_cast<int>(first_.size());
  const auto part = [&x](int row) { return x.subspan(kSize * static_cast<std::size_t>(row), kSize); };
  for (int i = 0; i < rows; ++i) {
    const auto xi = part(i);
    for (int k = first_[static_cast<std::size_t>(i)]; k < i; ++k) {
      const Block6& l = factor_at(i, k);
      const auto xk = part(k);
      for (std::size_t c = 0; c < kSize; ++c) {
        for (std::size_t r = 0; r < kSize; ++r) xi[r] -= l[kSize * c + r] * xk[c];
      }
    }
    const Block6& l = factor_at(i, i);
    for (std::size_t c = 0; c < kSize; ++c) {
      xi[c] /= l[kSize * c + c];
      for (std::size_t r = c + 1; r < kSize; ++r) xi[r] -= l[kSize * c + r] * xi[c];
    }
  }
  for (int i = rows; i-- > 0;) {
    const auto xi = part(i);
    const Block6& l = factor_at(i, i);
    for (std::size_t c = kSize; c-- > 0;) {
      for (std::size_t r = c + 1; r < kSize; ++r) xi[c] -= l[kSize * c + r] * xi[r];
      xi[c] /= l[kSize * c + c];
    }
    for (int k = first_[static_cast<std::size_t>(i)]; k < i; ++k) {
      const Block6& l_ik = factor_at(i, k);
      const auto xk = part(k);
      for (std::size_t c = 0; c < kSize; ++c) {
        for (std::size_t r = 0; r < kSize; ++r) xk[c] -= l_ik[kSize * c + r] * xi[r];
      }
    }
  }
}

}  // namespace topple::rigid

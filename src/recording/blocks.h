/// Storage that grows by whole blocks and never moves what it holds: no copy and no doubled peak, however long the run.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace topple {

/// A list of many small things, one after the other.
template <typename T>
class Blocks {
 public:
  void push_back(const T& value) {
    if ((size_ & kMask) == 0) blocks_.push_back(std::make_unique_for_overwrite<T[]>(kMask + 1));
    blocks_.back()[size_ & kMask] = value;
    ++size_;
  }
  const T& operator[](std::size_t index) const { return blocks_[index >> kShift][index & kMask]; }
  T& operator[](std::size_t index) { return blocks_[index >> kShift][index & kMask]; }
  T& back() { return (*this)[size_ - 1]; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return blocks_.size() * ((kMask + 1) * sizeof(T) + sizeof(void*)); }

 private:
  static constexpr std::size_t kShift = 11;
  static constexpr std::size_t kMask = (std::size_t{1} << kShift) - 1;
  std::vector<std::unique_ptr<T[]>> blocks_;
  std::size_t size_ = 0;
};

/// A list of runs of things; each run stays together.
template <typename T>
class Runs {
 public:
  /// Copies `run` and says where it is from now on.
  const T* append(std::span<const T> run) {
    if (blocks_.empty() || capacity_ - used_ < run.size()) {
      capacity_ = std::max(kBlock, run.size());
      blocks_.push_back({std::make_unique_for_overwrite<T[]>(capacity_), capacity_});
      total_ += capacity_;
      used_ = 0;
    }
    T* place = blocks_.back().items.get() + used_;
    std::copy(run.begin(), run.end(), place);
    used_ += run.size();
    return place;
  }
  std::size_t bytes() const { return total_ * sizeof(T) + blocks_.size() * sizeof(Block); }

  /// Gives back the memory of runs that were appended before the one at `place`; null: of all. As far as whole blocks go.
  void drop_before(const T* place) {
    for (; gone_ < blocks_.size(); ++gone_) {
      Block& block = blocks_[gone_];
      const bool last = gone_ + 1 == blocks_.size();
      if (last || (place != nullptr && !std::less<const T*>{}(place, block.items.get()) &&
                   std::less<const T*>{}(place, block.items.get() + block.size))) {
        return;
      }
      total_ -= block.size;
      block = {};
    }
  }

 private:
  static constexpr std::size_t kBlock = 65536;
  struct Block {
    std::unique_ptr<T[]> items;
    std::size_t size = 0;
  };
  std::vector<Block> blocks_;
  std::size_t gone_ = 0;  // So many blocks are given back.
  std::size_t capacity_ = 0;
  std::size_t used_ = 0;
  std::size_t total_ = 0;
};

}  // namespace topple

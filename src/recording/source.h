/// The bytes of a payload, read with every step checked; and words about where they are wrong.
#pragma once

#include <cstring>
#include <string>

#include "recording/format.h"

namespace topple::format {

/// An array inside the file; the numbers in it are copied out one by one, so that it may begin anywhere.
template <typename T>
class Column {
 public:
  Column() = default;
  explicit Column(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::size_t size() const { return bytes_.size() / sizeof(T); }
  T operator[](std::size_t index) const {
    T value;
    std::memcpy(&value, bytes_.data() + index * sizeof(T), sizeof value);
    return value;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

/// Reads a payload from its beginning. After the first step beyond its end everything is zero or empty and ok() is false.
class Source {
 public:
  Source(std::span<const std::uint8_t> payload, std::size_t offset) : payload_(payload), offset_(offset) {}

  bool ok() const { return ok_; }
  bool at_end() const { return at_ == payload_.size(); }
  std::size_t position() const { return offset_ + at_; }  ///< In the file [bytes].

  template <typename T>
  T get() {
    T value{};
    const auto bytes = take(sizeof value);
    if (!bytes.empty()) std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  std::string text() {
    const auto bytes = take(get<std::uint32_t>());
    return {bytes.begin(), bytes.end()};
  }
  /// The next array of so many numbers.
  template <typename T>
  Column<T> column(std::size_t count) {
    take(round_up(at_) - at_);
    if (count > payload_.size()) ok_ = false;  // Before a product that could be too large for its type.
    return ok_ ? Column<T>(take(count * sizeof(T))) : Column<T>();
  }

 private:
  std::span<const std::uint8_t> take(std::size_t count) {
    if (!ok_ || count > payload_.size() - at_) {
      ok_ = false;
      return {};
    }
    at_ += count;
    return payload_.subspan(at_ - count, count);
  }

  std::span<const std::uint8_t> payload_;
  std::size_t offset_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace topple::format

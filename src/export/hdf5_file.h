/// The HDF5 C interface, closed by itself and with words for what goes wrong.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "topple/base.h"

namespace topple::hdf5 {

inline constexpr std::size_t kRowsInChunk = 4096;  ///< Written and compressed at once.

/// What HDF5 knows by a number, closed when it goes.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close closer) : id_(id), close_(closer) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t id() const { return id_; }
  bool ok() const { return id_ >= 0; }
  bool close() { return close_(std::exchange(id_, H5I_INVALID_HID)) >= 0; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

// The type of a number in memory; files hold the same.
inline hid_t type_of(double) { return H5T_NATIVE_DOUBLE; }
inline hid_t type_of(float) { return H5T_NATIVE_FLOAT; }
inline hid_t type_of(std::int32_t) { return H5T_NATIVE_INT32; }
inline hid_t type_of(std::int64_t) { return H5T_NATIVE_INT64; }
inline hid_t type_of(std::uint64_t) { return H5T_NATIVE_UINT64; }
inline hid_t type_of(std::uint16_t) { return H5T_NATIVE_UINT16; }
inline hid_t type_of(std::uint8_t) { return H5T_NATIVE_UINT8; }

/// A file or a group, in which things have names. The first failure is remembered; what comes after it does nothing.
class Writer {
 public:
  static Result<Writer> create(const std::filesystem::path& path);

  /// A table that grows: `columns` numbers a row, or one number where it is 1; `unit` may be empty.
  Handle table(const std::string& name, hid_t type, std::size_t columns, std::string_view unit, std::string_view meaning);
  template <typename T>
  void append(const Handle& table, std::span<const T> numbers) {
    if (!numbers.empty()) append_raw(table, type_of(T{}), numbers.data(), numbers.size());
  }
  /// A table that is whole at once.
  template <typename T>
  void write(const std::string& name, std::span<const T> numbers, std::size_t columns, std::string_view unit, std::string_view meaning) {
    append(table(name, type_of(T{}), columns, unit, meaning), numbers);
  }
  void group(const std::string& name, std::string_view meaning);
  /// A text of any length, as bytes of UTF-8.
  void text(const std::string& name, std::string_view text, std::string_view meaning) {
    write(name, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), 1, "", meaning);
  }
  void attribute(const std::string& object, const std::string& name, std::string_view whole);  ///< Cut at 60,000 bytes: HDF5 takes 64 KiB.
  template <typename T>
    requires std::is_arithmetic_v<T>
  void attribute(const std::string& object, const std::string& name, T number) {
    attribute_raw(object, name, type_of(number), &number);
  }
  Result<void> finish();

 private:
  explicit Writer(Handle file) : file_(std::move(file)) {}
  void append_raw(const Handle& table, hid_t type, const void* numbers, std::size_t count);
  void attribute_raw(const std::string& object, const std::string& name, hid_t type, const void* number);
  void expect(bool done, const std::string& what);
  int* descriptor() const;
  void drain() const;
  bool flush() const;

  Handle file_;
  std::string failed_;  // What could not be written first.
};

}  // namespace topple::hdf5

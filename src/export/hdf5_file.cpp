#include "export/hdf5_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace topple::hdf5 {
namespace {

/// Room for what the library has yet to find a place for when it writes its last bytes: heads of tables and groups.
constexpr hsize_t kSlack = 65536;

Handle text_type(std::string_view text) {
  Handle type(H5Tcopy(H5T_C_S1), &H5Tclose);
  H5Tset_size(type.id(), std::max<std::size_t>(text.size(), 1));
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

/// The library says no more than that it failed; what the system said last is why.
std::string reason() { return errno == 0 ? std::string() : ": " + std::string(std::strerror(errno)); }

}  // namespace

Result<Writer> Writer::create(const std::filesystem::path& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // A library never prints.
  errno = 0;
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), &H5Fclose);
  if (!file.ok()) return failure("cannot be written as HDF5" + reason());
  return Writer(std::move(file));
}

void Writer::expect(bool done, const std::string& what) {
  if (done || !failed_.empty()) return;
  failed_ = what + reason();
  drain();
}

int* Writer::descriptor() const {
  void* place = nullptr;
  return H5Fget_vfd_handle(file_.id(), H5P_DEFAULT, &place) < 0 ? nullptr : static_cast<int*>(place);
}

/// HDF5 1.10 cannot close a file that it cannot write, and runs into it when the program ends. So what it still wants to write goes to
/// memory, and everything can be closed.
void Writer::drain() const {
  int* const file = descriptor();
  const int memory = memfd_create("unwritten", 0);
  if (file != nullptr && memory >= 0) dup2(memory, *file);
  if (memory >= 0) close(memory);
}

/// Writes what the library still holds. It does not get over a disk that is full then; so the room is asked for first.
bool Writer::flush() const {
  const int* const file = descriptor();
  hsize_t size = 0;
  if (file == nullptr || H5Fget_filesize(file_.id(), &size) < 0) return false;
  errno = posix_fallocate(*file, 0, static_cast<off_t>(size + kSlack));
  if (errno != 0 || H5Fflush(file_.id(), H5F_SCOPE_LOCAL) < 0) return false;
  return H5Fget_filesize(file_.id(), &size) >= 0 && ftruncate(*file, static_cast<off_t>(size)) == 0;
}

void Writer::group(const std::string& name, std::string_view meaning) {
  const Handle group(H5Gcreate2(file_.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), &H5Gclose);
  expect(group.ok(), name);
  attribute(name, "meaning", meaning);
}

Handle Writer::table(const std::string& name, hid_t type, std::size_t columns, std::string_view unit, std::string_view meaning) {
  const int rank = columns == 1 ? 1 : 2;
  const std::array<hsize_t, 2> none = {0, columns};
  const std::array<hsize_t, 2> any = {H5S_UNLIMITED, columns};
  const std::array<hsize_t, 2> chunk = {kRowsInChunk, columns};
  const Handle space(H5Screate_simple(rank, none.data(), any.data()), &H5Sclose);
  const Handle settings(H5Pcreate(H5P_DATASET_CREATE), &H5Pclose);
  H5Pset_chunk(settings.id(), rank, chunk.data());
  H5Pset_shuffle(settings.id());
  H5Pset_deflate(settings.id(), 4);
  // Without a cache, since the library cannot tell of what fails when it is emptied as the table is closed.
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), &H5Pclose);
  H5Pset_chunk_cache(access.id(), 0, 0, 1.0);
  Handle table(H5Dcreate2(file_.id(), name.c_str(), type, space.id(), H5P_DEFAULT, settings.id(), access.id()), &H5Dclose);
  expect(table.ok(), name);
  if (!unit.empty()) attribute(name, "unit", unit);
  attribute(name, "meaning", meaning);
  return table;
}

void Writer::append_raw(const Handle& table, hid_t type, const void* numbers, std::size_t count) {
  if (!failed_.empty()) return;
  errno = 0;
  std::array<hsize_t, 2> size = {0, 1};
  const Handle before(H5Dget_space(table.id()), &H5Sclose);
  const int rank = H5Sget_simple_extent_dims(before.id(), size.data(), nullptr);
  const std::array<hsize_t, 2> start = {size[0], 0};
  const std::array<hsize_t, 2> added = {count / size[1], size[1]};
  size[0] += added[0];
  bool done = rank > 0 && H5Dset_extent(table.id(), size.data()) >= 0;
  const Handle after(H5Dget_space(table.id()), &H5Sclose);
  done = done && H5Sselect_hyperslab(after.id(), H5S_SELECT_SET, start.data(), nullptr, added.data(), nullptr) >= 0;
  const Handle memory(H5Screate_simple(rank, added.data(), nullptr), &H5Sclose);
  done = done && H5Dwrite(table.id(), type, memory.id(), after.id(), H5P_DEFAULT, numbers) >= 0;
  expect(done, "a table");
}

void Writer::attribute(const std::string& object, const std::string& name, std::string_view whole) {
  const std::string_view text = whole.substr(0, 60000);
  const Handle type = text_type(text);
  const std::string bytes = text.empty() ? std::string(1, '\0') : std::string(text);
  attribute_raw(object, name, type.id(), bytes.data());
}

void Writer::attribute_raw(const std::string& object, const std::string& name, hid_t type, const void* number) {
  if (!failed_.empty()) return;
  const Handle space(H5Screate(H5S_SCALAR), &H5Sclose);
  const Handle attribute(
      H5Acreate_by_name(file_.id(), object.c_str(), name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), &H5Aclose);
  expect(attribute.ok() && H5Awrite(attribute.id(), type, number) >= 0, object + ": " + name);
}

Result<void> Writer::finish() {
  expect(!failed_.empty() || flush(), "its last bytes");
  errno = 0;
  expect(file_.close(), "its end");
  if (!failed_.empty()) return failure("HDF5 cannot write " + failed_);
  return {};
}

}  // namespace topple::hdf5

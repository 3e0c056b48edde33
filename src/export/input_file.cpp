#include "export/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

namespace topple {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

Result<std::string> read_bytes(const std::filesystem::path& path, std::size_t most, const std::string& what) {
  const std::string name = path.string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) return failure(name + ": there is no such file");
  if (std::filesystem::is_directory(status)) return failure(name + ": is a directory, not " + what);
  const std::unique_ptr<std::FILE, Close> file(std::fopen(name.c_str(), "rb"));
  if (!file) return failure(name + ": cannot be opened: " + std::strerror(errno));
  const std::size_t limit = most + 1;
  std::string bytes;
  // In pieces until the end, for a pipe has no size.
  for (std::size_t piece = std::size_t{64} << 10U; bytes.size() < limit; piece *= 2) {
    const std::size_t before = bytes.size();
    bytes.resize(std::min(before + piece, limit));
    const std::size_t got = std::fread(bytes.data() + before, 1, bytes.size() - before, file.get());
    const bool ended = before + got < bytes.size();
    bytes.resize(before + got);
    if (std::ferror(file.get())) return failure(name + ": cannot be read: " + std::strerror(errno));
    if (ended) break;
  }
  return bytes;
}

}  // namespace topple

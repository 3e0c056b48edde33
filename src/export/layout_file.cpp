// From a path to a layout: what the reader itself, which knows only text, cannot say.
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include "topple/export.h"

namespace topple {
namespace {

constexpr std::size_t kMostBytes = (std::size_t{64} << 20U) + 1;  // one more than the reader takes, so that it can say so

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

Result<std::string> read_text(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) return failure(name + ": there is no such file");
  if (std::filesystem::is_directory(status)) return failure(name + ": is a directory, not a layout file");
  const std::unique_ptr<std::FILE, Close> file(std::fopen(name.c_str(), "rb"));
  if (!file) return failure(name + ": cannot be opened: " + std::strerror(errno));
  std::string text;
  // In pieces until the end, for a pipe has no size.
  for (std::size_t piece = std::size_t{64} << 10U; text.size() < kMostBytes; piece *= 2) {
    const std::size_t before = text.size();
    text.resize(std::min(before + piece, kMostBytes));
    const std::size_t got = std::fread(text.data() + before, 1, text.size() - before, file.get());
    const bool ended = before + got < text.size();
    text.resize(before + got);
    if (std::ferror(file.get())) return failure(name + ": cannot be read: " + std::strerror(errno));
    if (ended) break;
  }
  return text;
}

}  // namespace

Result<Layout> load_layout(const std::filesystem::path& path, std::span<const std::string> overrides) {
  const Result<std::string> text = read_text(path);
  if (!text) return std::unexpected(text.error());
  return read_layout(*text, path.string(), overrides);
}

}  // namespace topple

// From a path to a layout: what the reader itself, which knows only text, cannot say.
#include "export/input_file.h"
#include "topple/export.h"

namespace topple {

Result<Layout> load_layout(const std::filesystem::path& path, std::span<const std::string> overrides) {
  constexpr std::size_t kMostBytes = std::size_t{64} << 20U;  // the reader says that it takes no more
  const Result<std::string> text = read_bytes(path, kMostBytes, "a layout file");
  if (!text) return std::unexpected(text.error());
  return read_layout(*text, path.string(), overrides);
}

}  // namespace topple

#include "output.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "text.h"

namespace topple::app {

namespace fs = std::filesystem;

std::string no_place_for(const fs::path& path) {
  std::error_code unknown;
  if (fs::is_directory(path, unknown)) return path.string() + ": is a directory, not a file to write";
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, unknown)) return path.string() + ": cannot be written: there is no folder " + folder.string();
  if (access(folder.c_str(), W_OK) != 0) return path.string() + ": cannot be written: " + std::strerror(errno);
  return {};
}

bool output_is_whole() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return true;
  const int problem = errno;
  complain(std::string("Standard output cannot be written: ") + std::strerror(problem), 1);
  return false;
}

}  // namespace topple::app

#include <cerrno>
#include <cstring>
#include <fstream>

#include "topple/export.h"

namespace topple {

namespace {

std::string cannot_be_kept(const std::filesystem::path& path, const std::string& why) {
  return "Finished runs cannot be kept in " + path.string() + ": " + why + ".";
}

}  // namespace

Result<KeptLines> KeptLines::open(const std::filesystem::path& path, bool fresh) {
  KeptLines kept;
  if (path.empty()) return kept;
  kept.path_ = path;
  std::error_code problem;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), problem);
  // Whatever else somebody names here by mistake is not written into.
  if (const int first = std::ifstream(path).get(); first != std::char_traits<char>::eof() && first != '{')
    return failure(cannot_be_kept(path, "it holds something else"));
  bool whole = true;
  if (!fresh) {
    std::ifstream stream(path);
    for (std::string line; std::getline(stream, line);) {
      whole = !stream.eof();
      if (whole) kept.lines_.push_back(line);
    }
  }
  kept.file_.reset(std::fopen(path.c_str(), fresh ? "wb" : "ab"));
  if (kept.file_ == nullptr) return failure(cannot_be_kept(path, std::strerror(errno)));
  if (!whole) std::fputc('\n', kept.file_.get());
  return kept;
}

void KeptLines::add(const std::string& line) {
  if (file_ == nullptr) return;
  if (std::fputs((line + "\n").c_str(), file_.get()) >= 0 && std::fflush(file_.get()) == 0) return;
  problem_ = cannot_be_kept(path_, std::strerror(errno));
}

}  // namespace topple

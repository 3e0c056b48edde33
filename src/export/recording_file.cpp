#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "export/output_file.h"
#include "topple/export.h"

namespace topple {

struct RecordingFile::State {
  OutputFile file;
  RecordingWriter writer;
};

RecordingFile::RecordingFile() = default;
RecordingFile::~RecordingFile() = default;
RecordingFile::RecordingFile(RecordingFile&&) noexcept = default;
RecordingFile& RecordingFile::operator=(RecordingFile&&) noexcept = default;

Result<RecordingFile> RecordingFile::create(const Recording& recording, const std::filesystem::path& path) {
  auto output = OutputFile::create(path, OutputFile::Unfinished::kept);
  if (!output) return std::unexpected(output.error());
  RecordingFile file;
  file.state_ = std::make_unique<State>(std::move(*output), RecordingWriter(recording));
  if (auto begun = file.state_->file.write(file.state_->writer.begin()); !begun) return std::unexpected(begun.error());
  return file;
}

Result<void> RecordingFile::append() {
  while (true) {
    const std::vector<std::uint8_t> bytes = state_->writer.more();
    if (bytes.empty()) return state_->file.flush();
    if (auto written = state_->file.write(bytes); !written) return written;
  }
}

void RecordingFile::let_go() { state_->writer.let_go(); }

Result<void> RecordingFile::finish() {
  if (auto appended = append(); !appended) return appended;
  if (auto ended = state_->file.write(state_->writer.end()); !ended) return ended;
  return state_->file.finish();
}

Result<void> save_recording(const Recording& recording, const std::filesystem::path& path) {
  auto file = RecordingFile::create(recording, path);
  if (!file) return std::unexpected(file.error());
  return file->finish();
}

Result<Recording> load_recording(const std::filesystem::path& path) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) return failure(path.string() + ": is a directory, not a recording");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) return failure(path.string() + ": cannot be read: " + std::strerror(errno));
  std::vector<std::uint8_t> bytes;
  const auto size = std::filesystem::file_size(path, code);
  if (!code) bytes.reserve(static_cast<std::size_t>(size));
  std::vector<std::uint8_t> chunk(std::size_t{1} << 18);
  while (const std::size_t read = std::fread(chunk.data(), 1, chunk.size(), file.get())) {
    bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + static_cast<std::ptrdiff_t>(read));
  }
  if (std::ferror(file.get()) != 0) return failure(path.string() + ": cannot be read: " + std::strerror(errno));
  return read_recording(bytes, path.string());
}

}  // namespace topple

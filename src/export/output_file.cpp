#include "export/output_file.h"

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "topple/export.h"

namespace topple {

std::filesystem::path part_of(const std::filesystem::path& path) {
  std::filesystem::path part = path;
  part += ".part";
  return part;
}

OutputFile::OutputFile(std::FILE* file, std::filesystem::path path, Unfinished unfinished)
    : file_(file), path_(std::move(path)), part_(part_of(path_)), unfinished_(unfinished) {}

OutputFile::~OutputFile() {
  if (!file_) return;
  file_.reset();
  std::error_code ignored;
  if (unfinished_ == Unfinished::removed) std::filesystem::remove(part_, ignored);
}

Result<OutputFile> OutputFile::create(const std::filesystem::path& path, Unfinished unfinished) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) return failure(path.string() + ": is a directory, not a file to write");
  std::FILE* file = std::fopen(part_of(path).c_str(), "wb");
  if (file == nullptr) return failure(path.string() + ": cannot be written: " + std::strerror(errno));
  return OutputFile(file, path, unfinished);
}

std::unexpected<Error> OutputFile::cannot(std::string_view what) const {
  return failure(part_.string() + ": " + std::string(what) + ": " + std::strerror(errno));
}

Result<void> OutputFile::write(std::span<const std::uint8_t> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) return cannot("cannot be written");
  return {};
}

Result<void> OutputFile::write(std::string_view text) { return write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}); }

Result<void> OutputFile::flush() {
  if (std::fflush(file_.get()) != 0) return cannot("cannot be written");
  return {};
}

Result<void> OutputFile::finish() {
  if (!file_) return {};
  if (auto flushed = flush(); !flushed) return flushed;
  if (std::fclose(file_.release()) != 0) return cannot("cannot be closed");
  std::error_code code;
  std::filesystem::rename(part_, path_, code);
  if (code) return failure(path_.string() + ": cannot be given its name: " + code.message());
  return {};
}

Result<void> save_bytes(std::string_view bytes, const std::filesystem::path& path) {
  Result<OutputFile> file = OutputFile::create(path, OutputFile::Unfinished::removed);
  if (!file) return std::unexpected(file.error());
  if (Result<void> written = file->write(bytes); !written) return written;
  return file->finish();
}

}  // namespace topple

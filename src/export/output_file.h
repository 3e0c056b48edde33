/// A file that has its name only when it is whole.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "topple/base.h"

namespace topple {

/// Writes `path`.part; finish() gives it its name. What is not finished is removed, unless it is worth keeping.
class OutputFile {
 public:
  enum class Unfinished : std::uint8_t { removed, kept };
  static Result<OutputFile> create(const std::filesystem::path& path, Unfinished unfinished);
  OutputFile(OutputFile&&) noexcept = default;
  OutputFile& operator=(OutputFile&&) noexcept = delete;
  ~OutputFile();

  Result<void> write(std::span<const std::uint8_t> bytes);
  Result<void> write(std::string_view text);
  Result<void> flush();
  Result<void> finish();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  OutputFile(std::FILE* file, std::filesystem::path path, Unfinished unfinished);
  std::unexpected<Error> cannot(std::string_view what) const;

  std::unique_ptr<std::FILE, Close> file_;
  std::filesystem::path path_;
  std::filesystem::path part_;
  Unfinished unfinished_;
};

/// The name under which an unfinished file is written.
std::filesystem::path part_of(const std::filesystem::path& path);

}  // namespace topple

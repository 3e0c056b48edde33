#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "topple/export.h"

namespace topple {
namespace {

/// A folder of its own, gone at the end.
class Folder {
 public:
  Folder() { std::filesystem::create_directories(path_); }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path_ / name;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_ = std::filesystem::temp_directory_path() / "topple layout file test";
};

std::string wrong(const std::filesystem::path& path) {
  const auto layout = load_layout(path);
  return layout ? "nothing is wrong" : layout.error().message;
}

}  // namespace

TEST_CASE("a missing file, a directory and bytes that are not text are refused in words") {
  const Folder folder;
  const std::string at = folder.path().string();
  CHECK(wrong(folder.path() / "none.toml") == at + "/none.toml: there is no such file");
  CHECK(wrong("") == ": there is no such file");
  CHECK(wrong(folder.path()) == at + ": is a directory, not a layout file");
  CHECK(wrong(folder.write("latin1.toml", "title = \"caf\xe9\"\n")) ==
        at + "/latin1.toml:1:13: not UTF-8: byte 12 (counted from 0) is 0xe9");
  CHECK(wrong(folder.write("empty.toml", "")) ==
        at + "/empty.toml:1:1: the layout is empty; it needs at least one [[row]], [[curve]] or [[brick]]");
}

TEST_CASE("a file is read whole, and messages name it as it was named") {
  const Folder folder;
  const std::string text = "# " + std::string(300'000, 'x') + "\n[[row]]\ncount = 3\ngap_mm = 5\n";
  const auto layout = load_layout(folder.write("a row.toml", text), std::vector<std::string>{"row.0.count=4"});
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  CHECK(layout->brick_count() == 4);
  CHECK(layout->text == text);
  CHECK(layout->name == (folder.path() / "a row.toml").string());
}

TEST_CASE("an endless file is refused") {
  if (!std::filesystem::exists("/dev/zero")) return;
  CHECK(wrong("/dev/zero") == "/dev/zero:1:1: the file has 67,108,865 bytes, at most 67,108,864 are read");
}

}  // namespace topple

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <span>
#include <sstream>
#include <string>

#include "layout/keys.h"
#include "topple/layout.h"

namespace topple {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE_MESSAGE(file, path.string());
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The chapter of docs/layout.md under the heading that begins so.
std::string chapter(const std::string& document, const std::string& heading) {
  const std::size_t from = document.find("\n## " + heading);
  REQUIRE_MESSAGE(from != std::string::npos, heading);
  return document.substr(from, document.find("\n## ", from + 4) - from);
}

}  // namespace

TEST_CASE("docs/layout.md has every key of every table") {
  const std::string document = text_of(TOPPLE_SOURCE_DIR "/docs/layout.md");
  const std::map<std::string, std::span<const std::string_view>> tables{
      {"Top level", keys::kTop},         {"`[contact]`", keys::kContact}, {"`[[kind]]`", keys::kKind},   {"`[[push]]`", keys::kPush},
      {"`[[row]]`", keys::kRow},         {"`[[curve]]`", keys::kCurve},   {"`[[brick]]`", keys::kBrick}, {"`[noise]`", keys::kNoise},
      {"`[[pair]]`", keys::kPair},       {"`[[field]]`", keys::kField},   {"`[[wall]]`", keys::kWall},   {"`[[tower]]`", keys::kTower},
      {"`[[pyramid]]`", keys::kPyramid}, {"`[[ball]]`", keys::kBall},
  };
  for (const auto& [heading, known] : tables) {
    const std::string text = chapter(document, heading);
    std::size_t rows_keys = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("| `")) continue;
      const std::string first = line.substr(0, line.find(" | ", 2));
      for (const std::string_view key : known) rows_keys += first.find("`" + std::string(key) + "`") != std::string::npos ? 1U : 0U;
    }
    CHECK_MESSAGE(rows_keys == known.size(), heading);
  }
}

TEST_CASE("the examples of docs/layout.md are layouts") {
  const std::string document = text_of(TOPPLE_SOURCE_DIR "/docs/layout.md");
  int examples = 0;
  for (std::size_t at = document.find("```toml\n"); at != std::string::npos; at = document.find("```toml\n", at + 1), ++examples) {
    const std::size_t from = at + 8;
    const auto layout = read_layout(document.substr(from, document.find("```", from) - from), "docs/layout.md");
    REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  }
  CHECK(examples == 2);
}

TEST_CASE("every scene is a layout with a title and a push") {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TOPPLE_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    ++scenes;
    const auto layout = read_layout(text_of(entry.path()), entry.path().filename().string());
    REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
    CHECK_MESSAGE(!layout->title.empty(), entry.path().string());
    CHECK_MESSAGE(!layout->pushes.empty(), entry.path().string());
  }
  CHECK(scenes >= 5);
}

TEST_CASE("the record of 2009 has 4,491,863 bricks") {
  // Read with rows of one brick, which takes no time; what the rows have beyond that is added: 100 rows a field.
  const std::string text = text_of(TOPPLE_SOURCE_DIR "/scenes/large/record_2009.toml");
  std::vector<std::string> shorter;
  std::int64_t beyond = 0;
  for (std::size_t at = text.find("[[field]]"); at != std::string::npos; at = text.find("[[field]]", at + 1)) {
    const std::size_t count = text.find("\ncount = ", at) + 9;
    beyond += 100 * (std::stoll(text.substr(count)) - 1);
    shorter.push_back("field." + std::to_string(shorter.size()) + ".count=1");
  }
  CHECK(shorter.size() == 5);
  const auto layout = read_layout(text, "record_2009.toml", shorter);
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  CHECK(layout->brick_count() + beyond == 4'491'863);
}

TEST_CASE("the S-curve has 200 bricks") {
  const auto layout = read_layout(text_of(TOPPLE_SOURCE_DIR "/scenes/s_curve.toml"), "s_curve.toml");
  REQUIRE(layout.has_value());
  CHECK(layout->brick_count() == 200);
}

}  // namespace topple

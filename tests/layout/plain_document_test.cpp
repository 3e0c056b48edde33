#include "layout/plain_document.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "base/random.h"

namespace topple {
namespace {

/// Whether the reader of all of TOML says the same, if the text is plain.
bool agrees(std::string_view text) {
  const std::optional<Node> plain = parse_plain(text);
  if (!plain) return true;
  const Result<Node> any = parse_any(text, "any");
  return any && *plain == *any;
}

constexpr std::string_view kPlain = R"(# A row, and more
title = "Rows, # and [all]"
gravity_m_s2 = 9.81
[[push]]
brick = 0   # the first
angular_speed_rad_s = 4.0
[contact]
	brick_friction=0.2
floor_friction	= 1
[[brick]]
at_mm = [0.0000, -24.125]
[[brick]]
at_mm = [ +25.5 , 0,
  3 ]
[[curve]]
points_mm = [[0, 0], [1000.12345678901, -0.0],
 [-0, 12]
]
flags = [true, false, [], ["a", "b"]]
name = ""
)";

}  // namespace

TEST_CASE("a plain document is read as the reader of all of TOML reads it") {
  REQUIRE(parse_plain(kPlain).has_value());
  CHECK(agrees(kPlain));
  const Result<Node> zero = parse_document("a = -0.0", "zero");
  CHECK(std::signbit(std::get<double>(std::get<Table>(zero->value)[0].node.value)));
  CHECK(agrees(""));
  CHECK(agrees("a = 1"));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TOPPLE_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    std::ifstream file(entry.path(), std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    CHECK_MESSAGE(agrees(text.str()), entry.path().string());
  }
}

TEST_CASE("what is not plain, or not TOML, is left to the reader of all of TOML") {
  for (const char* text : {"a = 1\na = 2",
                           "[a]\n[a]",
                           "[a]\n[[a]]",
                           "[[a]]\n[a]",
                           "a = 1\n[a]",
                           "a = []\n[[a]]",
                           "a = [1]\n[[a]]",
                           "a.b = 1",
                           "\"a\" = 1",
                           "[a.b]",
                           "[ a ]",
                           "a = 'x'",
                           "a = \"\\n\"",
                           "a = \"\"\"x\"\"\"",
                           "a = 1_000",
                           "a = 0x10",
                           "a = 1e3",
                           "a = 01",
                           "a = 00.5",
                           "a = .5",
                           "a = 1.",
                           "a = 1.2345678901234567",
                           "a = 9999999999999999",
                           "a = 1979-05-27",
                           "a = 12:30:00",
                           "a = inf",
                           "a = +nan",
                           "a = {b = 1}",
                           "a = [1,]",
                           "a = [1 2]",
                           "a = [1, # x\n2]",
                           "a = 1 b = 2",
                           "a =",
                           "a",
                           "= 1",
                           "a = truer",
                           "a = tru",
                           "a = \"x",
                           "a = \"x\"y",
                           "a = \"\xC3\xA4\"",
                           "# \xC3\xA4",
                           "a = 1\r\n",
                           "# \x01",
                           "a = \x7F",
                           "[a] b = 1",
                           "[[a]",
                           "[a",
                           "[]",
                           "a = 1\n\f",
                           "a = [\n\n",
                           "a = -",
                           "a = +-1",
                           "a = 1.-5",
                           "a = --1",
                           "\xEF\xBB\xBF[a]"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_plain(text).has_value());
  }
}

TEST_CASE("however a plain document is changed, both readers agree or the plain one declines") {
  Random random(5);
  const auto below = [&random](std::size_t count) { return static_cast<std::size_t>(random.bits() % count); };
  const std::string some = "[]=#\"\\,.+-_ \n\t0123456789aeftrubick'{}:\r\x01\x7F\xC3\xA4";
  std::size_t plain = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text(kPlain);
    for (std::size_t changes = 1 + below(3); changes-- > 0;) {
      const std::size_t at = below(text.size());
      const std::size_t way = below(4);
      if (way == 0) text.erase(at, 1 + below(4));
      if (way == 1) text.insert(at, 1, some[below(some.size())]);
      if (way == 2) text[at] = some[below(some.size())];
      if (way == 3) text.insert(at, text.substr(below(text.size()), below(24)));
    }
    plain += parse_plain(text).has_value() ? 1 : 0;
    CHECK_MESSAGE(agrees(text), text);
  }
  CHECK(plain > 400);  // Else this would say nothing.
}

TEST_CASE("a plain decimal number is the double nearest to it") {
  Random random(6);
  for (int round = 0; round < 2000; ++round) {
    const std::string digits = std::to_string(random.bits() % 1'000'000'000'000'000ULL);
    const std::size_t point = 1 + static_cast<std::size_t>(random.bits() % digits.size());
    const std::string text = "a = -" + digits.substr(0, point) + "." + (point < digits.size() ? digits.substr(point) : "0");
    CHECK_MESSAGE(agrees(text), text);
  }
}

}  // namespace topple

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "topple/layout.h"

namespace topple {
namespace {

using namespace std::string_view_literals;

std::string wrong(std::string_view text) {
  const auto layout = read_layout(text, "t.toml");
  return layout ? "nothing is wrong" : layout.error().message;
}

}  // namespace

TEST_CASE("an empty layout is refused") {
  CHECK(wrong("") == "t.toml:1:1: the layout is empty; it needs at least one [[row]], [[curve]] or [[brick]]");
  CHECK(wrong("# only a comment\n") == "t.toml:1:1: the layout is empty; it needs at least one [[row]], [[curve]] or [[brick]]");
  CHECK(wrong("title = \"x\"\n") == "t.toml:1:1: the layout is empty; it needs at least one [[row]], [[curve]] or [[brick]]");
  CHECK(wrong("kind = []\nrow = []\n") == "t.toml:1:1: the layout is empty; it needs at least one [[row]], [[curve]] or [[brick]]");
}

TEST_CASE("what is not TOML is refused where it stops being TOML") {
  CHECK(wrong("hello") == "t.toml:1:6: not TOML: while parsing key-value pair: encountered end-of-file");
  CHECK(wrong("= 3") == "t.toml:1:1: not TOML: while parsing root table: expected keys, tables, whitespace or comments, saw '='");
  CHECK(wrong("[[row]\ncount = 3\n") == "t.toml:1:7: not TOML: while parsing table header: expected ']', saw '\\n'");
  CHECK(wrong("title = \"unfinished\n") ==
        "t.toml:1:20: not TOML: while parsing string: unescaped control characters other than TAB (U+0009) are explicitly prohibited");
  CHECK(wrong("title = \"\"\"unfinished\n") == "t.toml:1:23: not TOML: while parsing string: encountered end-of-file");
  CHECK(wrong("title = \"a\"\ntitle = \"b\"\n") ==
        "t.toml:2:9: not TOML: while parsing key-value pair: cannot redefine existing string 'title'");
  CHECK(wrong("[contact]\n[contact]\n") == "t.toml:2:1: not TOML: while parsing table header: cannot redefine existing table 'contact'");
  CHECK(wrong("[[row]]\ncount = 3\ncount = 4\n") ==
        "t.toml:3:9: not TOML: while parsing key-value pair: cannot redefine existing integer 'count'");
  CHECK(wrong("count = 3 4\n") == "t.toml:1:11: not TOML: while parsing key-value pair: expected a comment or whitespace, saw '4'");
  CHECK(wrong("x = 0x\n") == "t.toml:1:7: not TOML: while parsing hexadecimal integer: expected digit, saw '\\n'");
  CHECK(wrong("x = 2020-13-45\n") == "t.toml:1:12: not TOML: while parsing date: expected month between 1 and 12 (inclusive), saw 13");
  CHECK(wrong("title = \"a\000b\"\n"sv) ==
        "t.toml:1:11: not TOML: while parsing string: unescaped control characters other than TAB (U+0009) are explicitly prohibited");
  CHECK(wrong("\000"sv) == "t.toml:1:1: not TOML: while parsing root table: expected keys, tables, whitespace or comments, saw '\\u0000'");
  CHECK(wrong("[row]\n[[row]]\n") ==
        "t.toml:2:1: not TOML: while parsing table header: cannot redefine existing table 'row' as array-of-tables");
}

TEST_CASE("text that is not UTF-8 is refused at its byte") {
  CHECK(wrong("title = \"\377\"\n") == "t.toml:1:10: not UTF-8: byte 9 (counted from 0) is 0xff");
  CHECK(wrong("title = \"x\"\n# caf\351\n") == "t.toml:2:6: not UTF-8: byte 17 (counted from 0) is 0xe9");
  CHECK(wrong("abc\303") == "t.toml:1:4: not UTF-8: byte 3 (counted from 0) is 0xc3");
  CHECK(wrong("\377\376t\000i\000") == "t.toml:1:1: not UTF-8: byte 0 (counted from 0) is 0xff");
  CHECK(wrong("\355\240\200") == "t.toml:1:1: not UTF-8: byte 0 (counted from 0) is 0xed");
  CHECK(wrong("\300\257") == "t.toml:1:1: not UTF-8: byte 0 (counted from 0) is 0xc0");
  CHECK(wrong("\364\220\200\200") == "t.toml:1:1: not UTF-8: byte 0 (counted from 0) is 0xf4");
  CHECK(wrong("\340\200\257") == "t.toml:1:1: not UTF-8: byte 0 (counted from 0) is 0xe0");
}

TEST_CASE("deep nesting is refused before anything recurses") {
  CHECK(wrong("a = [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]") ==
        "t.toml:1:37: nested more than 32 brackets deep");
  CHECK(wrong("a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = "
              "{a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = {a = ") ==
        "t.toml:1:165: nested more than 32 brackets deep");
  CHECK(wrong("a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a = 1\n") ==
        "t.toml:1:66: a key with more than 32 dots");
  CHECK(
      wrong("[\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\"."
            "\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\".\"a\"]\n") ==
      "t.toml:1:133: a key with more than 32 dots");
}

TEST_CASE("control characters do not reach the terminal") {
  CHECK(wrong("\"a\\nb\" = 3\n[[row]]\ncount = 3\npitch_mm = 24\n") == "t.toml:1:1: a\\nb: unknown key; the nearest known one is pair");
  CHECK(wrong("\"\\u001b[31m\" = 3\n[[row]]\ncount = 3\npitch_mm = 24\n") ==
        "t.toml:1:1: \\x1b[31m: unknown key; the nearest known one is title");
  CHECK(wrong("[[row]]\nkind = \"\\u001b[31m\\n\\u0085\"\ncount = 1\ngap_mm = 1\n") ==
        "t.toml:2:8: row.0.kind: there is no kind \"\\x1b[31m\\n\\xc2\\x85\"; the nearest is \"domino\"");
  CHECK(wrong("title = "
              "\"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
              "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
              "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
              "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
              "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
              "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
              "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
              "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
              "xxxxxxxxxxx\"\n[[row]]\ncount = 3\npitch_mm = 24\n") == "t.toml:1:9: title: must have at most 1000 bytes, has 1001");
}

TEST_CASE("a table header without a key is refused in every kind of build") {
  CHECK(wrong("[=]\n") == "t.toml:1:2: not TOML: while parsing key: expected bare key starting character or string delimiter, saw '='");
  CHECK(wrong("[\x19[push]]\n") ==
        "t.toml:1:2: not TOML: while parsing key: expected bare key starting character or string delimiter, saw '\\u0019'");
  CHECK(wrong("[[.a]]\n") == "t.toml:1:3: not TOML: while parsing key: expected bare key starting character or string delimiter, saw '.'");
}

TEST_CASE("letters of any script are text in strings and comments, and no part of a bare key") {
  CHECK(wrong("\xEF\xBB\xBB = 1\n") ==
        "t.toml:1:1: not TOML: while parsing root table: expected keys, tables, whitespace or comments, saw '\xEF\xBB\xBB'");
  CHECK(wrong("# \xEF\xBB\xBB\ntitle = \"\xEF\xBB\xBB \xEF\xB8\x8F\"\n[[row]]\ncount = 1\ngap_mm = 0 \xEF\xB8\x8F\n") ==
        "t.toml:5:12: not TOML: while parsing key-value pair: expected a comment or whitespace, saw '\xEF\xB8\x8F'");
}

TEST_CASE("a list of a hundred thousand open brackets is refused") {
  CHECK(wrong("a = " + std::string(100'000, '[')) == "t.toml:1:37: nested more than 32 brackets deep");
}

TEST_CASE("dots and brackets in comments and strings are only text") {
  const std::string dots(200, '.'), brackets(200, '[');
  const std::string good = "# " + dots + brackets + "\ntitle = \"\"\"\n\\\"" + dots + brackets + "\n\"\"\"\n[model]\na = '" + dots +
                           "'\nb = '''" + brackets + "'''\nc = \"\\\"" + brackets + "\"\n[[row]]\ncount = 3\ngap_mm = 1 # '" + brackets +
                           "\n";
  CHECK(wrong(good) == "nothing is wrong");
}

TEST_CASE("a file of more values than a layout needs is refused before it fills the memory") {
  std::string text = "x = [";
  for (int i = 0; i < 8'000'010; ++i) text += "1,";
  CHECK(wrong(text) == "t.toml:1:16000003: more than 8,000,000 values");
  CHECK(wrong(std::string((std::size_t{64} << 20U) + 1, '\n')) == "t.toml:1:1: the file has 67,108,865 bytes, at most 67,108,864 are read");
}

TEST_CASE("of many problems fifty are listed and the rest counted") {
  std::string text = "[[row]]\ncount = 3\ngap_mm = 1\n[contact]\n";
  for (int i = 0; i < 5000; ++i) text += "key" + std::to_string(i) + " = 1\n";
  const std::string message = wrong(text);
  CHECK(std::count(message.begin(), message.end(), '\n') == 50);
  CHECK(message.starts_with("t.toml:5:1: contact.key0: unknown key; the nearest known one is brick_friction\n"));
  CHECK(message.ends_with("\nand 4,950 more problems"));
}

}  // namespace topple

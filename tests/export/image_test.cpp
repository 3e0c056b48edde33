// Which way up a photograph is.
#include <doctest/doctest.h>

#include <string>

#include "export/image_turn.h"

namespace topple {
namespace {

using namespace std::string_literals;

/// A JPEG's beginning with an Exif part of one entry: the orientation.
std::string jpeg(char orientation, bool big_first) {
  const std::string tiff = big_first ? "MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0"s + orientation + "\0\0"s
                                     : "II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0"s + orientation + "\0\0\0"s;
  const std::string exif = "Exif\0\0"s + tiff;
  return "\xFF\xD8\xFF\xE0\0\x04xx\xFF\xE1\0"s + static_cast<char>(exif.size() + 2) + exif + "\xFF\xDA\0\x02rest"s;
}

/// Three pixels by two, a b c over d e f, each named by its red.
std::string letters(int orientation) {
  Image image{3, 2, {}};
  for (const char letter : "abcdef"s) image.pixels.insert(image.pixels.end(), {static_cast<std::uint8_t>(letter), 0, 0, 255});
  const Image out = turned(image, orientation);
  std::string text;
  for (std::size_t i = 0; i < out.pixels.size(); i += 4) {
    text += static_cast<char>(out.pixels[i]);
    if ((i / 4 + 1) % static_cast<std::size_t>(out.width) == 0) text += ' ';
  }
  return text;
}

}  // namespace

TEST_CASE("an image is turned and mirrored as Exif's eight orientations say") {
  // Exif 2.3, tag 0x0112: which corner of what is seen the first stored line and column are. 6: the first line is the right side.
  CHECK(letters(1) == "abc def ");
  CHECK(letters(2) == "cba fed ");
  CHECK(letters(3) == "fed cba ");
  CHECK(letters(4) == "def abc ");
  CHECK(letters(5) == "ad be cf ");
  CHECK(letters(6) == "da eb fc ");
  CHECK(letters(7) == "fc eb da ");
  CHECK(letters(8) == "cf be ad ");
}

TEST_CASE("the orientation is found in either order of bytes, and is as stored where it is not there, cut off or nonsense") {
  for (const bool big_first : {true, false}) {
    const std::string whole = jpeg(6, big_first);
    CHECK(orientation_of(whole) == 6);
    CHECK(orientation_of(jpeg(9, big_first)) == 1);
    CHECK(orientation_of(jpeg(0, big_first)) == 1);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const int cut = orientation_of(std::string_view(whole).substr(0, i));
      CHECK((cut == 1 || cut == 6));
    }
  }
  CHECK(orientation_of("") == 1);
  CHECK(orientation_of("\xFF\xD8\xFF\xE1\xFF\xFF"
                       "Exif") == 1);
  CHECK(orientation_of("\x89PNG") == 1);
}

}  // namespace topple
